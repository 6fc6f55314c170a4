"""The command ``turndesk machine``, which checks and accepts a machine file, its devices and its HAL file."""

from __future__ import annotations

import argparse
import json
import signal
import sys
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from app.cli.change_author import COMMAND_LINE_USER, add_author_option, get_change_author
from app.cli.program_options import parse_output_path
from app.compose.optional_features import map_action_modules
from app.desk.command_errors import (
    EXIT_ERRORS,
    EXIT_OK,
    EXIT_USAGE,
    CommandError,
    convert_to_command_error,
    make_write_error,
)
from core.access.access_table import ProtectedChange
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.compose.backends.hal_file_writer import GeneratedHalFiles
    from core.machine.machine_file import KeyChange
    from core.machine.machine_model import Machine


def add_hal_parser(actions: SubParsers) -> None:
    """Add the parser of the action ``hal``."""
    parser = actions.add_parser(
        "hal",
        help="write the HAL file for LinuxCNC and list the required wiring",
        description="Writes the HAL file for the board that [board] in the machine file names: "
        "simulation, parallel port, Mesa 7I76E or 7I97, EtherCAT. The comments at the top of "
        "the file list the wiring and the values to measure.",
    )
    parser.add_argument("file", metavar="FILE", help="machine file with the [hal] and [board] tables")
    parser.add_argument(
        "--out",
        type=parse_output_path,
        metavar="FILE.hal",
        help="output file, which must not exist yet (default: stdout)",
    )
    parser.add_argument("--json", action="store_true", help="print only JSON on stdout")


def write_hal_file(args: argparse.Namespace) -> int:
    """Write the HAL file, and return 2 if the names in the machine file do not fit the board.

    Without --out, the HAL file is written to stdout. Raises CommandError in these cases:

    - The machine file is invalid, or has no [hal] or [board] table.
    - The backend of the machine file is not hal.
    - An output file already exists or cannot be written.
    """
    from app.compose.backends.hal_file_writer import generate_hal_files
    from app.compose.machine.machine_setup import read_machine
    from core.table_schema import MachineFileError

    machine = read_machine(args.file)
    try:
        hal = generate_hal_files(machine)
    except MachineFileError as error:
        sys.stderr.write("".join(f"turndesk: {error.source}: {finding}\n" for finding in error.findings))
        return EXIT_USAGE
    if args.out:
        _save_hal(Path(args.out), hal.hal_text, hal.extra_files)
    if args.json:
        _report_file(machine.source, args.out, hal)
    elif args.out:
        sys.stdout.write("".join(f"{line}\n" for line in hal.wiring_table))
        sys.stdout.write("".join(f"measure: {note}\n" for note in hal.measurement_lines))
    else:
        sys.stdout.write(hal.hal_text)
        sys.stderr.write(
            "".join(
                f"turndesk: {name} must be in the same folder; --out writes both\n"
                for name in hal.extra_files
            )
        )
    if args.out and Path(args.out).name != hal.file_name:
        sys.stderr.write(
            f"turndesk: {machine.source}: [hal] file is {hal.file_name}, so TurnDesk loads that file\n"
        )
    return EXIT_OK


def _report_file(source: str, out: str | None, hal: GeneratedHalFiles) -> None:
    report = {
        "file": source,
        "board": hal.board_kind,
        "out": out,
        "hal": hal.hal_text,
        "beside": hal.extra_files,
        "wires": [{**wire._asdict(), "names": list(wire.names)} for wire in hal.wiring_rows],
        "measure": hal.measurement_lines,
    }
    sys.stdout.write(json.dumps(report) + "\n")


def _save_hal(output_path: Path, text: str, extra_files: Mapping[str, str]) -> None:
    """Write the HAL file and its additional files, which are in the same folder.

    Raises CommandError if a file already exists or cannot be written.
    """
    files = {output_path: text, **{output_path.parent / name: more for name, more in extra_files.items()}}
    for path in files:
        if path.exists():
            raise CommandError(
                Message(
                    "{path} already exists and will not be overwritten; use a different name or folder",
                    path=path,
                ),
                "file-exists",
            )
    for path, content in files.items():
        try:
            with path.open("x", encoding="utf-8") as opened:
                opened.write(content)
        except OSError as error:
            raise make_write_error(path, error) from error


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``machine`` and its actions."""
    parser = subparsers.add_parser("machine")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    check = actions.add_parser(
        "check", help="validate a machine file, connect, and report each drive and input"
    )
    check.add_argument("file", metavar="FILE", nargs="?", help="default: the shipped simulated lathe")
    check.add_argument("--json", action="store_true", help="print only JSON on stdout")
    peer = actions.add_parser(
        "peer",
        help="simulate the devices that a CANopen or grblHAL machine file connects to, for tests "
        "without hardware",
        description="Simulates drives and terminals on the bus of a CANopen machine file, or a grblHAL "
        "controller on its TCP port or on a pseudo terminal, whose name is printed. The "
        "simulation runs until you press Ctrl-C. Start the control in parallel: turndesk "
        "--machine FILE",
    )
    peer.add_argument("file", metavar="FILE", help="machine file, such as gt75-bench.toml")
    accept = actions.add_parser("accept", help="show the changes in a machine file and accept the file")
    accept.add_argument("file", metavar="FILE")
    add_author_option(accept)
    add_hal_parser(actions)
    for module in map_action_modules().values():
        import_module(module).add_parser(actions)


def run(args: argparse.Namespace) -> int:
    """Run an action of ``turndesk machine``.

    The exit status is 0 if successful, 1 for faults, and 2 for an invalid machine file.
    """
    if args.action == "check":
        return check(args.file, json_output=args.json)
    if args.action == "hal":
        return write_hal_file(args)
    if args.action == "accept":
        return accept_machine_file(args.file, args)
    if args.action == "peer":
        return simulate_devices(args.file)
    status: int = import_module(map_action_modules()[args.action]).run(args)
    return status


# =

TABLE_WIDTH = 80
TableRows = Sequence[tuple[str, str, str, str]]  # name, address, state, details


def check(file: str | None, *, json_output: bool) -> int:
    """Check the machine file, connect to the machine, print a report, and return the exit status."""
    from app.compose.backends.backend_entry import NOT_CHECKED
    from app.compose.backends.machine_check import check_machine
    from app.compose.machine.machine_files import load_named_machine
    from core.table_schema import MachineFileError

    try:
        machine = load_named_machine(file)
    except MachineFileError as error:
        errors = [
            {"path": each.path, "value": each.value, "expected": each.expected_value}
            for each in error.findings
        ]
        _report(json_output, {"file": error.source, "errors": errors, "ports": []})
        sys.stderr.write("".join(f"turndesk: {error.source}: {finding}\n" for finding in error.findings))
        return EXIT_USAGE
    answers, changes = check_machine(machine), _unaccepted_changes(machine)
    _report(
        json_output,
        {
            "file": machine.source,
            "machine": machine.name,
            "backend": machine.backend,
            "errors": [],
            "changes": [change._asdict() for change in changes],
            "ports": [{**row._asdict(), "verdict": row.result_text} for row in answers.rows],
            "rights": [right._asdict() for right in answers.process_rights],
            "warnings": answers.warnings,
            "trouble": answers.faults,
        },
    )
    if not json_output:
        sys.stdout.write(f"{machine.source} is valid: {machine.name}, backend {machine.backend}\n")
        judged = [
            (f"{row.result_text:<4}  {row.name}", *row[1:])
            for row in answers.rows
            if row.result_text != NOT_CHECKED
        ]
        sys.stdout.write("".join(f"{line}\n" for line in format_check_table(judged)))
        unchecked = [row.name for row in answers.rows if row.result_text == NOT_CHECKED]
        if unchecked:
            sys.stdout.write(
                f"  not checked, because no hardware reports them: {summarize_names(unchecked)}\n"
            )
        for right in answers.process_rights:
            sys.stdout.write(f"  computer: {right.name}: {right.granted}\n")
            sys.stdout.write(f"    {right.missing}\n" if right.missing else "")
        sys.stdout.write("".join(f"  changed since it was accepted: {change}\n" for change in changes))
    said = (*answers.warnings, *answers.faults)
    sys.stderr.write("".join(f"turndesk: {machine.source}: {text}\n" for text in said))
    return EXIT_ERRORS if answers.faults else EXIT_OK


def _unaccepted_changes(machine: Machine) -> Sequence[KeyChange]:
    """Return the changes since the machine file was accepted, or () if the store cannot be read."""
    try:
        return list_machine_file_changes(machine)
    except CommandError as error:
        sys.stderr.write(f"turndesk: {error}\n")
        return ()


def format_check_table(rows: TableRows) -> Iterator[str]:
    """Yield the lines of the check table, at most 80 characters long. Long details are wrapped."""
    widths = [max((len(row[column]) for row in rows), default=0) for column in range(3)]
    start = " " * (2 + sum(width + 2 for width in widths))
    for *cells, detail in rows:
        head = "  " + "".join(f"{cell:<{width}}  " for cell, width in zip(cells, widths, strict=True))
        text = textwrap.wrap(detail, max(TABLE_WIDTH - len(start), 30)) or [""]
        yield (head + text[0]).rstrip()
        yield from (start + more for more in text[1:])


def summarize_names(names: Sequence[str]) -> str:
    """Return the names as one line of text. Several inputs or outputs are replaced by their count."""
    parts = [name for name in names if not name.startswith(("input ", "output "))]
    for kind in ("input", "output"):
        terminals = [name for name in names if name.startswith(f"{kind} ")]
        parts += terminals if len(terminals) < 2 else [f"{len(terminals)} {kind}s"]
    return ", ".join(parts)


def _report(json_wanted: bool, report: dict[str, object]) -> None:
    if json_wanted:
        sys.stdout.write(json.dumps(report) + "\n")


# --- accept: a real machine does not run until a changed file is accepted --------------------------------

MAX_PRINTED_CHANGES = 5  # changes that a run prints; a check prints all


def list_machine_file_changes(machine: Machine) -> tuple[KeyChange, ...]:
    """Return the changes since the machine file was last accepted, or () if it never was accepted.

    Raises CommandError if the store cannot be read.
    """
    from app.cli.store_command import open_store
    from app.compose.machine.accepted_machine import list_file_differences

    with open_store(read_only=True) as store:
        return list_file_differences(machine, store.settings) or ()


def require_accepted_file(machine: Machine) -> None:
    """Print the changes of the machine file before a run.

    Raises CommandError if the file of a real machine has changed since it was last accepted, or if the
    store cannot be read. For a simulated machine, the changes are only printed, and a store error is
    ignored.
    """
    from app.compose.backends.connection import needs_real_time

    try:
        changes = list_machine_file_changes(machine)
    except CommandError:
        if needs_real_time(machine):
            raise
        return  # a simulated machine does not need a store
    if not changes:
        return
    lines = [str(change) for change in changes[:MAX_PRINTED_CHANGES]]
    if len(changes) > MAX_PRINTED_CHANGES:
        lines.append(
            Message(
                "… and {told_count} more; to see all changes, run: turndesk machine check {source}",
                told_count=len(changes) - MAX_PRINTED_CHANGES,
                source=machine.source,
            )
        )
    if needs_real_time(machine):
        why = Message(
            "{source} has changed since it was accepted ({lines})",
            source=machine.source,
            lines="; ".join(lines),
        )
        raise CommandError(
            Message(
                "{why}; to accept the file, run turndesk machine accept {source}, or press F10 on the screen",
                why=why,
                source=machine.source,
            ),
            "not-accepted",
        )
    sys.stderr.write("".join(f"{machine.source} has changed: {line}\n" for line in lines))


def accept_machine_file(file: str, args: argparse.Namespace) -> int:
    """Print the changes of the machine file and accept the file.

    Raises CommandError if the file is invalid, if the user may not accept it, or if the store cannot be
    written.
    """
    from app.cli.store_command import open_store
    from app.compose.machine.accepted_machine import (
        create_acceptance_record,
        get_settings_key,
        list_file_differences,
    )
    from app.compose.machine.machine_setup import read_machine

    machine = read_machine(file)
    with open_store() as store:
        changes, who = (
            list_file_differences(machine, store.settings),
            get_change_author(store, args, ProtectedChange.MACHINE_FILE),
        )
        store.settings.save_setting(get_settings_key(machine), create_acceptance_record(machine)).result()
        said = "; ".join(str(change) for change in changes or ())
        by = "" if who == COMMAND_LINE_USER else f" by {who}"
        store.events.log_event(
            "machine",
            Message(
                "machine file {source} accepted{name}{ending}{text}",
                source=machine.source,
                name=by,
                ending=": " if said else "",
                text=said,
            ),
        )
    sys.stdout.write("".join(f"  {change}\n" for change in changes or ()))
    how = "this file was never accepted before" if changes is None else _counted(len(changes))
    sys.stdout.write(f"{machine.source} is accepted: {how}\n")
    return EXIT_OK


def _counted(changes: int) -> str:
    if not changes:
        return "no changes"
    return "1 change" if changes == 1 else f"{changes} changes"


# --- peer: simulated devices for a bus without hardware --------------------------------------------------


def simulate_devices(file: str) -> int:
    """Simulate the devices of the machine file until Ctrl+C or SIGTERM.

    Raises CommandError if the devices cannot be simulated.
    """
    from app.compose.backends.backend_entry import find_backend, list_simulatable_backend_names
    from app.compose.machine.machine_setup import read_machine
    from core.ports import DriverError

    machine = read_machine(file)
    play_it = find_backend(machine).simulate_devices
    if play_it is None:
        there = " and ".join(list_simulatable_backend_names())
        why = Message(
            "machine.backend is {backend}, which does not have a simulator; simulators are "
            "available for {present}",
            backend=machine.backend,
            present=there,
        )
        raise CommandError(f"{file}: {why}", "no-peer")
    ended = False

    def request_end(_signal: int, _frame: FrameType | None) -> None:
        nonlocal ended
        ended = True

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, request_end)
    with convert_to_command_error(DriverError):
        play_it(machine, lambda: not ended, _say, _line_reader())
    return EXIT_OK


def _line_reader() -> Callable[[], Iterable[str]]:
    """Return a function that returns the new lines from standard input.

    If standard input is not available, the function always returns an empty sequence.
    """
    from app.compose.backends.simulated_devices import LineReader

    try:
        return LineReader(sys.stdin.fileno()).read_lines
    except (OSError, ValueError, AttributeError):
        return tuple


def _say(what: str) -> None:
    sys.stdout.write(f"{what}\n")
    sys.stdout.flush()
