"""The command ``turndesk help``, which prints the help of TurnDesk, of a command or of one of its actions."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``help``."""
    parser = subparsers.add_parser("help")
    parser.add_argument("words", nargs="*", metavar="COMMAND", help="a command, and an action of the command")


def run(args: argparse.Namespace) -> int:
    """Print the help of the command. The exit status is 2 if the command is unknown."""
    from app.cli.main import main

    return main([*args.words, "--help"])
