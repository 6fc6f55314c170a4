"""Command ``turndesk tour``, which shows the tour on a simulated lathe."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.command_errors import CommandError

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers

# The caller has checked that its machine is simulated and that no program is active.
FROM_SCREEN_OPTION = "--from-screen"


def add_parser(subparsers: SubParsers) -> None:
    """Declare the command. Its only option is for the special function TOUR and is not in the help."""
    parser = subparsers.add_parser("tour")
    parser.add_argument(FROM_SCREEN_OPTION, action="store_true", help=argparse.SUPPRESS)


def run(args: argparse.Namespace) -> int:
    """Show the tour until it has ended, and return the exit status.

    Raises CommandError without a display. CommandError is also raised if a screen or a control of this data
    folder is running, because the window of the tour takes the keyboard from that screen.
    """
    from app.cli.main import run_opening_show
    from app.compose.optional_features import extras
    from app.desk.data_folder import find_data_folder

    if not args.from_screen:
        check_no_machine_running(find_data_folder())
    return run_opening_show(extras()["tour"].opening_show_class)


def check_no_machine_running(folder: Path) -> None:
    """Raise CommandError if a screen or a control of this data folder is running."""
    from app.compose.control.control_start import is_control_running
    from core.store.store_connection import is_open_for_writing

    if is_open_for_writing(folder) or is_control_running(folder):
        raise CommandError(
            "first close the screen of the machine; the tour takes its keyboard", "screen-open"
        )
