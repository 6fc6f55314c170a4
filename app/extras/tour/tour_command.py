"""Command ``turndesk tour``, which shows the tour on a simulated lathe."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers


def add_parser(subparsers: SubParsers) -> None:
    """Declare the command, which has no options."""
    subparsers.add_parser("tour")


def run(_args: argparse.Namespace) -> int:
    """Show the tour until it has ended, and return the exit status. Raises CommandError without a display."""
    from app.cli.main import run_opening_show
    from app.extras.tour.extra import EXTRA

    return run_opening_show(EXTRA.opening_show_class)
