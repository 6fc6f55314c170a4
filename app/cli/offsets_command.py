"""The command ``turndesk offsets`` for stored offsets and tool shapes, in inches."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from app.cli.change_author import add_author_option, add_confirmation_options
from core.message import Message
from core.store.store_rows import OffsetKind

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``offsets`` and its actions."""
    parser = subparsers.add_parser("offsets")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    show = actions.add_parser("show", help="show all offsets that are set")
    show.add_argument("--json", action="store_true", help="print only JSON on stdout")
    change = actions.add_parser(
        "set",
        help="set offsets or tool shapes, such as T3 x=1.25 wear_x=-.0005 quadrant=3, T3 "
        "kind=turning insert=CNMG432, or D4 x=-.0005 (X of D is stored as a radius value)",
    )
    change.add_argument("offset", metavar="T3|D4|G54|TOOL20|PRESET3")
    change.add_argument(
        "values",
        metavar="KEY=VALUE",
        nargs="+",
        help="lengths are in inches unless another unit is listed; expressions such as x=.5-.002 "
        "are allowed. Keys for T: x z nose_radius wear_x wear_z quadrant remark master. Keys "
        "for the tool shape of T: kind hand insert holder width diameter point stick_out "
        "length pitch flutes entry rear profile (kind=none removes the shape). Keys for D: x "
        "z r. Keys for G54 to G59, in mm and degrees: x z c. Keys on a mill, in mm, degrees "
        "and minutes: for TOOL, name L R R2 DL DR DR2 cut t-angle time2 stop; for PRESET, x "
        "y z a b c rot doc",
    )
    add_confirmation_options(change)
    clear = actions.add_parser(
        "clear", help="clear one offset (T3, D4 or G54) or all offsets of one type (T, D or G)"
    )
    clear.add_argument("offset", metavar="T|T3|D|D4|G|G54")
    history = actions.add_parser("history", help="show all changes, newest first")
    history.add_argument("--limit", type=int, default=100, metavar="N", help="default: 100")
    _add_table(history)
    history.add_argument("--json", action="store_true", help="print only JSON on stdout")
    undo = actions.add_parser("undo", help="undo the last change; repeat to undo earlier changes")
    _add_table(undo)
    for action, why in ((change, "entered"), (clear, "cleared"), (undo, "undo")):
        add_author_option(action)
        action.add_argument(
            "--why",
            default=why,
            help=Message("reason for the change, saved in the history (default: {why})", why=why),
        )


def _add_table(parser: argparse.ArgumentParser) -> None:
    """Add the argument that selects the table."""
    parser.add_argument(
        "table",
        nargs="?",
        choices=[kind.value for kind in OffsetKind],
        help="show only this table (default: all tables)",
    )


def run(args: argparse.Namespace) -> int:
    """Run an action of ``turndesk offsets``. Raises CommandError if the action fails."""
    from app.cli.actions.offset_actions import OFFSET_ACTIONS

    return OFFSET_ACTIONS[args.action](args)
