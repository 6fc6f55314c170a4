"""The ``turndesk`` command, which loads only the modules of the selected subcommand.

Errors are reported in one line.
"""

from __future__ import annotations

import argparse
import errno
import gc
import importlib
import io
import os
import sys
import threading
from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import TYPE_CHECKING

from app import VERSION
from app.cli.bug_report.crash_report import (
    catch_interrupts,
    raise_dropped_interrupt,
    report_crash,
    report_thread_exception,
)
from app.cli.command_parser import (
    CommandParser,
    SubcommandsAction,
    add_screen_options,
    copy_screen_options,
    has_only_screen_options,
    insert_program_option,
    move_demo_option_first,
)
from app.compose.optional_features import Subcommand, extras, insert_items_after, map_command_modules
from app.desk import command_errors
from app.desk.command_errors import EXIT_INTERRUPTED, EXIT_OK, EXIT_USAGE, CommandError
from app.desk.standard_input import reset_standard_input
from core.message import CodedError, Message

if TYPE_CHECKING:
    from app.screen.opening_show import OpeningShow

CORE_COMMANDS: Mapping[str, str] = {
    "prove": "prove programs (errors, limits, cycle time) without moving the machine",
    "expand": "show each single motion and action that the control would execute",
    "trace": "write the time-stamped setpoints that the drives would receive",
    "run": "run a program with the executor and the drivers",
    "offsets": "show and change offsets, tool shapes, and the tools and presets of a mill",
    "store": "back up, restore, export, import or verify the stored data",
    "machine": "check a machine file",
    "serial": "send and receive programs over RS-232",
    "alarms": "list all alarms with number, meaning, causes and remedies",
    "scope": "show scope data from a saved record or from the last few minutes",
    "setup": "copy a machine's setup, add a desktop entry, or print a shell completion script",
    "report-bug": "collect data for a fault report, without names, paths and addresses",
    "where": "list the folders and files that TurnDesk uses",
    "help": "explain a command and its options",
}
"""Core subcommands with their help texts.

Each subcommand has a module with add_parser(subparsers) and run(args), which returns the exit status.
Listing the help imports none of these modules.
"""

NO_DISPLAY_TEXT = """\
turndesk: no display here (neither DISPLAY nor WAYLAND_DISPLAY is set), so no operator screen. Without one:
  turndesk prove FILE…             proves programs: errors, limits, cycle time
  turndesk expand FILE             the elementary blocks that the control would execute
  turndesk trace FILE --out CSV    the setpoints that the drives would get
  turndesk run FILE --headless     runs it on the simulated lathe
"""
_DISK_FULL_ERRORS = (errno.ENOSPC, errno.EDQUOT)
SCREENLESS_COMMANDS_TEXT = "prove, expand, trace and run --headless do not need a screen"


def list_commands() -> Sequence[str]:
    """Return all subcommands in the order of the help, including the subcommands of optional features."""
    added = [(name, each.preceding_subcommand) for name, each in _feature_commands().items()]
    return insert_items_after(CORE_COMMANDS, str, added)


def _feature_commands() -> Mapping[str, Subcommand]:
    """Return the subcommands of the optional features by name."""
    return {name: each for extra in extras().values() for name, each in extra.subcommands.items()}


def _help_of(command: str) -> str:
    return CORE_COMMANDS[command] if command in CORE_COMMANDS else _feature_commands()[command].help_line


def _load_module(command: str) -> ModuleType:
    """Import the module of a subcommand."""
    own = command in CORE_COMMANDS
    return importlib.import_module(
        f"app.cli.{command.replace('-', '_')}_command" if own else map_command_modules()[command]
    )


def build_parser(
    commands: Sequence[str] | None = None, *, without_options: bool = False
) -> argparse.ArgumentParser:
    """Return the parser for the named subcommands, or for all subcommands if ``commands`` is None.

    If ``without_options`` is true, subcommands have no options, so that their modules are not imported.
    """
    parser = CommandParser(
        prog="turndesk",
        description="Operator screen for OmniTurn-style lathes. Run turndesk without a command to open "
        "the screen.",
    )
    add_screen_options(parser)
    subparsers = parser.add_subparsers(
        title="commands",
        metavar="COMMAND",
        dest="command",
        parser_class=CommandParser,
        action=SubcommandsAction,
    )
    assert isinstance(subparsers, SubcommandsAction)
    for name in list_commands() if commands is None else commands:
        if without_options:
            subparsers.add_parser(name, help=_help_of(name))
        else:
            subparsers.help_texts[name] = _help_of(name)
            _load_module(name).add_parser(subparsers)
    return parser


def _commands_for(argv: Sequence[str]) -> Sequence[str]:
    """Return only the requested command, or all commands if the requested command is invalid."""
    first = next((word for word in argv if word != "--demo"), "")
    if first in CORE_COMMANDS:
        return (first,)
    commands = list_commands()
    return (first,) if first in commands else commands


def _arguments(argv: Sequence[str]) -> Sequence[str]:
    """Return the arguments, with ``--demo`` and a program file moved to where the parser expects them."""
    argv = move_demo_option_first(argv)
    if has_only_screen_options(argv) or (argv and argv[0] in CORE_COMMANDS):
        return argv
    return insert_program_option(argv, list_commands())


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit status.

    As docs/json.md specifies, the status is 0 if successful, 1 if the program has errors, and 2 for a usage
    error.
    """
    argv = _arguments(sys.argv[1:] if argv is None else argv)
    gc.set_threshold(200_000)  # imports alone would cause a hundred useless collections
    try:
        reset_standard_input()
        bare = has_only_screen_options(argv)
        args = build_parser(None if bare else _commands_for(argv), without_options=bare).parse_args(argv)
        from app.desk.data_folder import check_data_folder

        with catch_interrupts():
            check_data_folder()
            status = _flush_output(_dispatch(copy_screen_options(args)))
            raise_dropped_interrupt()
            return status
    except SystemExit:  # raised after the help, which needs no error handling
        raise
    except _rejection_types() as error:
        return command_errors.report_command_error(error)
    except ImportError as error:
        if not _is_library_missing(error):
            raise
        sys.stderr.write(f"turndesk: {error}; install the system packages that README.md names\n")
        return EXIT_USAGE
    except KeyboardInterrupt:
        sys.stderr.write("turndesk: interrupted\n")
        _clear_interrupt()
        return EXIT_INTERRUPTED
    except BrokenPipeError:
        # The reader of the output has closed the pipe, as `| head` does, and expects a quiet end.
        _discard_output()
        return EXIT_OK
    except OSError as error:
        # errors of a file are reported where it is written
        if error.errno not in _DISK_FULL_ERRORS or error.filename is not None:
            raise
        sys.stderr.write(f"turndesk: stdout cannot be written: {error.strerror}\n")
        _discard_output()
        return EXIT_USAGE


def _rejection_types() -> tuple[type[CodedError], ...]:
    """Return the types of expected exceptions, which a command reports in one line."""
    from app.desk.data_folder import DataFolderError

    return CommandError, DataFolderError


def _is_library_missing(error: ImportError) -> bool:
    """Return whether the error is due to a missing system library, such as a library that Qt needs.

    The name of such a library contains ``.so``.
    """
    return ".so" in str(error) and "cannot open shared object file" in str(error)


def _flush_output(status: int) -> int:
    """Flush stdout and return the exit status, so that an error such as a full disk is reported."""
    sys.stdout.flush()
    return status


def _discard_output() -> None:
    """Discard buffered output, which Python would otherwise write at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _clear_interrupt() -> None:
    """Clear the interpreter's interrupt flag, so that Python uses the exit status of TurnDesk.

    If Ctrl+C interrupts the creation of a dataclass (``exec`` of a string), Python exits as if a signal had
    ended it, even if the exception is caught. Executing another string clears the flag.
    """
    exec("")


def _dispatch(args: argparse.Namespace) -> int:
    if args.version:
        sys.stdout.write(f"turndesk {VERSION}\n")
        return EXIT_OK
    if args.demo:
        _open_demo(args)
    if args.command:
        status: int = _load_module(args.command).run(args)
        return status
    return _screen(args)


def _open_demo(args: argparse.Namespace) -> None:
    """Use the data folder of the demo, and load its program if the user specified no program.

    If the user specified nothing else, the screen may begin with the show of an optional feature.
    """
    from app.compose.demo_store import find_demo_program, open_demo_data_folder

    machine = getattr(args, "machine", None)
    folder = open_demo_data_folder(machine)
    if args.command:
        return
    if not (args.program or machine or args.offsets or args.kiosk):
        shown = (each.opening_show_class for each in extras().values() if each.begins_with_show(folder))
        args.opening_show_class = next(shown, "")
    args.program = args.program or find_demo_program(machine)


def _has_display() -> bool:
    if sys.platform != "linux":
        return True
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"))


def _screen(args: argparse.Namespace) -> int:
    if not _has_display():
        sys.stderr.write(NO_DISPLAY_TEXT)
        return EXIT_USAGE
    _check_display()
    if args.program and not (args.machine or args.offsets or args.kiosk):
        from app.screen.window.running_screen import hand_over_program

        if hand_over_program(args.program):
            sys.stdout.write(f"{args.program}: opened in the TurnDesk that is already running\n")
            return EXIT_OK
    from app.screen.screen_startup import run_screen

    return run_screen(
        machine=args.machine,
        program_file=args.program,
        offsets_file=args.offsets,
        is_kiosk=args.kiosk,
        opening_show=_create_opening_show(getattr(args, "opening_show_class", ""), opens_desk=True),
    )


def run_opening_show(class_name: str) -> int:
    """Show only an opening show, without the operator screen, and return the exit status.

    ``class_name`` is the dotted name of its class. Raises CommandError if no window can be opened.
    """
    _check_display()
    from app.screen.screen_startup import run_screen

    return run_screen(opening_show=_create_opening_show(class_name, opens_desk=False))


def _create_opening_show(class_name: str, *, opens_desk: bool) -> OpeningShow | None:
    """Return the opening show of this class for the current data folder, or None for an empty name."""
    from app.desk.data_folder import find_data_folder

    module_name, _, name = class_name.rpartition(".")
    if not module_name:
        return None
    show: OpeningShow = getattr(importlib.import_module(module_name), name)(
        find_data_folder(), opens_desk=opens_desk
    )
    return show


def _check_display() -> None:
    """Raise CommandError with the reason if no window can be opened."""
    from app.screen.display import find_display_error

    if why := find_display_error():
        raise CommandError(
            Message(
                "the screen cannot be opened: {why}. {without}", why=why, without=SCREENLESS_COMMANDS_TEXT
            ),
            "no-screen",
        )


def _make_streams_tolerant() -> None:
    """Make the output streams write a question mark for each character that they cannot encode.

    A stream that the parent process has closed is replaced with the null device.
    """
    if sys.stdout is None:
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  for as long as the process lives
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def run_console() -> int:
    """Run the installed ``turndesk`` command, and report crashes instead of printing tracebacks."""
    _make_streams_tolerant()
    sys.excepthook = report_crash
    threading.excepthook = report_thread_exception
    # numpy would start a thread pool for linear algebra that is not used here, which takes a fifth of a short
    # command's time.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        return main()
    finally:
        gc.freeze()  # the final garbage collection would take a sixth of a short command's time


if __name__ == "__main__":
    sys.exit(run_console())
