"""The command ``turndesk setup`` for setup files, the desktop entry, autostart and shell completion."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.change_author import add_author_option, get_permitted_user, log_user_change
from app.cli.store_command import open_store
from app.desk.command_errors import EXIT_OK, CommandError
from core.access.access_table import ProtectedChange
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers

SHELL_NAMES = ("bash", "zsh", "fish")


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``setup`` and its actions."""
    parser = subparsers.add_parser("setup")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    save = actions.add_parser(
        "save", help="save the stored data, settings, programs and machine file in one FILE"
    )
    save.add_argument("file", metavar="FILE")
    save.add_argument("--machine", metavar="FILE", help="machine file to include in the saved setup")
    load = actions.add_parser(
        "load", help="load the setup from FILE; the replaced data is saved next to the new data"
    )
    load.add_argument("file", metavar="FILE")
    add_author_option(load)
    load.add_argument("--check", action="store_true", help="check the file without changing anything")
    desktop = actions.add_parser("desktop", help="add an entry with an icon to the desktop menu")
    desktop.add_argument(
        "--autostart", action="store_true", help="start the screen as a kiosk when the desktop session starts"
    )
    desktop.add_argument("--remove", action="store_true", help="remove the menu entry and the autostart")
    completion = actions.add_parser(
        "completion", help="print the shell script that completes commands with the Tab key"
    )
    completion.add_argument("shell", metavar="SHELL", choices=SHELL_NAMES, help=", ".join(SHELL_NAMES))


def run(args: argparse.Namespace) -> int:
    """Run the action of ``turndesk setup``. Raises CommandError if the action fails."""
    return SETUP_ACTIONS[args.action](args)


def _save(args: argparse.Namespace) -> int:
    from app.compose.machine.setup_file import save_setup

    setup = save_setup(Path(args.file), args.machine)
    sys.stdout.write(
        f"setup saved to {args.file}: data store, programs: {setup.program_count}, {setup.machine_name}\n"
    )
    if setup.omitted_files:
        sys.stdout.write(f"skipped, because they are not programs: {', '.join(setup.omitted_files)}\n")
    return EXIT_OK


def _load(args: argparse.Namespace) -> int:
    from app.compose.machine.setup_file import check_setup, load_setup

    if args.check:
        setup = check_setup(Path(args.file))
        sys.stdout.write(
            f"{args.file} is undamaged: data store, programs: {setup.program_count}, {setup.machine_name}\n"
        )
        return EXIT_OK
    who = get_permitted_user(open_store, args, ProtectedChange.RESTORE)
    setup, kept = load_setup(Path(args.file))
    log_user_change(
        open_store,
        who,
        Message(
            "setup loaded from {file}; the previous data was saved as {saved}", file=args.file, saved=kept
        ),
    )
    backup_text = Message("; the previous data was saved as {saved}", saved=kept) if kept else ""
    sys.stdout.write(
        f"setup loaded from {args.file}: data store, programs: {setup.program_count}, "
        f"{setup.machine_name}{backup_text}\n"
    )
    if setup.machine_path is not None:
        sys.stdout.write(f"start with: turndesk --machine {setup.machine_path}\n")
    return EXIT_OK


def _desktop(args: argparse.Namespace) -> int:
    from app.cli.actions.desktop_entry import install_desktop_entries, remove_desktop_entries

    if args.remove and args.autostart:
        raise CommandError(
            "--remove removes the menu entry and the autostart; use it without --autostart",
            "remove-and-autostart",
        )
    paths = remove_desktop_entries() if args.remove else install_desktop_entries(autostart=args.autostart)
    verb = "removed" if args.remove else "written"
    sys.stdout.write("".join(f"{verb}: {path}\n" for path in paths) or "there is no entry to remove\n")
    return EXIT_OK


def _completion(args: argparse.Namespace) -> int:
    import shtab

    from app.cli.main import build_parser

    parser = build_parser()
    _complete_files(parser, shtab.FILE)
    script = shtab.complete(parser, args.shell)
    if args.shell == "zsh":
        # The script of shtab works only within eval, and completes only the first of several files.
        script = "eval " + shlex.quote(script.replace('"(*):', '"*:'))
    sys.stdout.write(script + "\n")
    return EXIT_OK


def _complete_files(parser: argparse.ArgumentParser, files: object) -> None:
    """Make shell completion offer ``files`` for every argument that has no fixed choices.

    Most of these arguments are file names.
    """
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for each in action.choices.values():
                _complete_files(each, files)
        elif not action.choices and action.nargs != 0:
            action.complete = files  # type: ignore[attr-defined]  # where shtab looks for it


SETUP_ACTIONS: dict[str, Callable[[argparse.Namespace], int]] = {
    "save": _save,
    "load": _load,
    "desktop": _desktop,
    "completion": _completion,
}
