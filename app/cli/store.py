"""``turndesk store``: backup, restore, export, import and verify of the store."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.cli.options import SubParsers


def add_parser(subparsers: SubParsers) -> None:
    """The subcommand with its actions."""
    parser = subparsers.add_parser("store", help="back up, restore, export, import, verify the store")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    for name, what, text in (
        ("backup", "FILE", "copy the whole store to FILE, also while it is in use"),
        ("restore", "FILE", "put a backup in the store's place; the replaced store is kept beside it"),
        ("export", "DIR", "write programs, offsets.toml, events.csv and runs.csv as plain files"),
        ("import", "DIR", "take the programs and offsets of an exported folder"),
    ):
        actions.add_parser(name, help=text).add_argument("path", metavar=what)
    verify = actions.add_parser("verify", help="look at every page, reference and program text")
    verify.add_argument("--json", action="store_true", help="machine-readable output alone on stdout")


def run(args: argparse.Namespace) -> int:
    """Does what ``args`` asks; raises CommandError with one sentence."""
    from app.cli.store_actions import ACTIONS

    return ACTIONS[args.action](args)
