"""The command ``turndesk serial ports|send|receive``, which transfers programs over RS-232."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from app.cli.change_author import add_author_option, get_permitted_user, log_user_change
from app.cli.store_command import open_store
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError, convert_to_command_error
from core.access.access_table import ProtectedChange
from core.input_file import open_input_file
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.transfer.line_transfer import ReceivedProgram, SerialLineTransfer, TransferProgress
    from core.machine.machine_model import Machine
    from core.machine.serial_and_backup_tables import SerialLineModel

_EOL = {"crlf": "\r\n", "lf": "\n", "cr": "\r"}


_DESCRIPTION = """\
Programs over a serial line (RS-232), between % lines as other controls and DNC programs send them.
A program that is received is checked to its last character, proved, and stored as a new file: it
never takes the place of another, and nothing starts. Ctrl-C gives a transfer up, and nothing is kept.

  turndesk serial ports
  turndesk serial send PIN.nc --port /dev/ttyUSB0 --baud 4800 --bits 7 --parity E
  turndesk serial receive --port /dev/ttyUSB0 --out NEW.nc

Settings that are not given are those of [dnc] in the machine file, else 9600 8N1, xonxoff, % and crlf.
Both sides have to be set alike. Receive first, then send from the other side.
"""


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``serial`` and its actions."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = subparsers.add_parser("serial", description=_DESCRIPTION, formatter_class=raw)
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    actions.add_parser("ports", help="list the serial ports of this computer")
    send = actions.add_parser("send", help="send a program", description=_DESCRIPTION, formatter_class=raw)
    send.add_argument(
        "file",
        metavar="FILE",
        help="program file; %% is added before and after the program if missing",
    )
    receive = actions.add_parser(
        "receive",
        help="receive a program and save it as a new file; it is never started",
        description=_DESCRIPTION,
        formatter_class=raw,
    )
    receive.add_argument(
        "--out",
        metavar="NAME",
        help="output file, which must not exist yet (default: the program's own name, in the program folder)",
    )
    for each in (send, receive):
        _add_line_options(each)
    add_author_option(receive)
    _add_send_options(send)


def _add_line_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the serial line, which apply to sending and receiving.

    Their default values are in [dnc] of the machine file.
    """
    parser.add_argument("--machine", metavar="FILE", help="machine file with the settings in [dnc]")
    parser.add_argument(
        "--port",
        metavar="DEVICE",
        help="serial port, such as /dev/ttyUSB0 or COM3; to list the ports: turndesk serial ports",
    )
    parser.add_argument(
        "--baud", type=int, metavar="RATE", help="baud rate in bits per second, usually 110 to 115200"
    )
    parser.add_argument(
        "--bits", type=int, choices=(7, 8), help="data bits; older controls use 7 with --parity E"
    )
    parser.add_argument("--parity", choices=("N", "E", "O"), help="parity: none, even or odd")
    parser.add_argument("--stop", type=int, choices=(1, 2), help="stop bits")
    parser.add_argument(
        "--flow",
        choices=("xonxoff", "rtscts", "none"),
        help="flow control, which makes the sender wait while the receiver is not ready",
    )
    parser.add_argument(
        "--wrap",
        choices=("%", ""),
        metavar="SIGN",
        help="marker line before and after a program: %%, or '' for no marker line",
    )
    parser.add_argument(
        "--dc-codes",
        action="store_true",
        default=None,
        help="use tape codes: DC2 and DC4 around sent data, DC1 and DC3 around received data",
    )


def _add_send_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that apply only to sending."""
    parser.add_argument("--eol", choices=tuple(_EOL), help="line ending to use for sent data")
    parser.add_argument(
        "--wait",
        action="store_true",
        default=None,
        help="wait until the other side requests data (DC1) before sending",
    )
    parser.add_argument(
        "--leader",
        type=int,
        metavar="COUNT",
        help="number of NUL characters to send before and after the program",
    )


def run(args: argparse.Namespace) -> int:
    """Run an action of ``turndesk serial``, and return the exit status.

    The exit status is 1 if nothing was transferred or if the received program has errors.
    """
    if args.action == "ports":
        return _ports()
    from app.compose.machine.machine_setup import read_machine

    machine = read_machine(args.machine)
    settings = _settings(args, machine)
    return _send(args, settings) if args.action == "send" else _receive(args, machine, settings)


def _ports() -> int:
    from app.compose.backends.serial_ports import list_serial_ports
    from core.ports import DriverError

    with convert_to_command_error(DriverError):
        found = list_serial_ports()
    sys.stdout.write("".join(f"{device}  {what}".rstrip() + "\n" for device, what in found))
    if not found:
        sys.stderr.write("turndesk: this computer has no serial port; plug the adapter in\n")
    return EXIT_OK


def _settings(args: argparse.Namespace, machine: Machine) -> SerialLineModel:
    from dataclasses import replace

    from app.compose.program_transfer import DEFAULT_SETTINGS
    from core.machine.serial_and_backup_tables import SerialLineModel

    model = machine.hardware.find_driver_table(SerialLineModel) or DEFAULT_SETTINGS
    names = ("port", "baud", "bits", "parity", "stop", "flow", "wrap", "dc_codes", "wait", "leader")
    said = {name: value for name in names if (value := getattr(args, name, None)) is not None}
    if getattr(args, "eol", None):
        said["eol"] = _EOL[args.eol]
    model = replace(model, **said)
    if not model.port:
        raise CommandError(
            "no serial port specified; use --port, or add a [dnc] table to the machine file", "no-port"
        )
    if not 110 <= model.baud <= 1_000_000:
        raise CommandError(
            Message("--baud {baud} is out of range; use 110 to 1000000", baud=model.baud), "baud"
        )
    if not 0 <= model.leader <= 2000:
        raise CommandError(
            Message("--leader {leader} is out of range; use 0 to 2000", leader=model.leader), "leader"
        )
    return model


def _send(args: argparse.Namespace, settings: SerialLineModel) -> int:
    from app.compose.program_transfer import SerialPortLines

    path = Path(args.file)
    _check_readable(path)
    lines = SerialPortLines(lambda _source: ((), 0.0))
    sent = run_transfer(lines.make_send_transfer(settings, path), f"sending {path.name}")
    if sent is None:
        return EXIT_ERRORS
    sys.stdout.write(f"{path.name}: {sent} bytes sent to {settings.port}\n")
    return EXIT_OK


def _check_readable(path: Path) -> None:
    """Raise CommandError if the file cannot be read. Call this before opening the serial line."""
    try:
        with open_input_file(path) as file:
            file.read(1)
    except OSError as error:
        raise CommandError(
            Message("{path} cannot be read: {cause}", path=path, cause=error.strerror), "unreadable"
        ) from error


def _receive(args: argparse.Namespace, machine: Machine, settings: SerialLineModel) -> int:
    from app.compose.program_proving import create_loading_steps
    from app.compose.program_transfer import SerialPortLines, create_program_checker
    from app.compose.stored_offsets import make_offsets_reader
    from core.language.source import Dialect, get_default_extension

    if args.out and Path(args.out).exists():  # checked before waiting, because the program could not be saved
        sys.stderr.write(
            f"turndesk: {args.out} already exists and is not overwritten; use a different name\n"
        )
        return EXIT_ERRORS
    who = get_permitted_user(open_store, args, ProtectedChange.PROGRAMS)  # checked before waiting
    ending = get_default_extension(Dialect(machine.mdi_language))
    lines = SerialPortLines(
        create_program_checker(create_loading_steps(machine, make_offsets_reader(None), draw_pictures=False)),
        ending,
    )
    received = run_transfer(
        lines.make_receive_transfer(settings), Message("receiving from {port}", port=settings.port)
    )
    if received is None:
        return EXIT_ERRORS
    return _store(args, received, who)


def _store(args: argparse.Namespace, received: ReceivedProgram, who: str) -> int:
    from app.desk.data_folder import find_data_folder
    from app.programs.atomic_files import FileOperationError
    from app.transfer.line_transfer import find_unused_name, store_received_program

    out = Path(args.out) if args.out else None
    folder = out.parent if out else find_data_folder() / "programs"
    try:
        path = store_received_program(
            received, folder, out.name if out else find_unused_name(folder, received.file_name)
        )
    except FileOperationError as error:
        sys.stderr.write(f"turndesk: {error}\n")
        return EXIT_ERRORS
    log_user_change(open_store, who, Message("program {path} received", path=path.name))
    seven = ", received with 7 data bits and even parity" if received.is_seven_bit else ""
    lines = "1 line" if received.line_count == 1 else f"{received.line_count} lines"
    sys.stdout.write(f"{path}: {lines}, complete{seven}\n  SHA-256 {received.sha256}\n  {_found(received)}\n")
    sys.stderr.write("".join(f"{text}\n" for text in received.finding_texts))
    return EXIT_ERRORS if received.finding_texts else EXIT_OK


def _found(received: ReceivedProgram) -> str:
    if received.finding_texts:
        count = len(received.finding_texts)
        return Message(
            "{count} error{value}; the program is saved so that you can correct it",
            count=count,
            value="s" * (count != 1),
        )
    return Message(
        "proved without errors, cycle time {cycle} s; nothing was started",
        cycle=f"{received.cycle_time_s:.1f}",
    )


# --- Transfer on the command line: progress on stderr, canceled by Ctrl-C -------------------------------

T = TypeVar("T")
_POLL_INTERVAL_S = 0.1  # s


def _format_received(progress: TransferProgress) -> str:
    """Return a message that explains why the received data is not a program."""
    if progress.wait_reason == "noise":
        return Message(
            "the received data is not text ({received}); check --baud, --bits, --parity and the cable",
            received=progress.leading_text,
        )
    return Message(
        "text was received without %: {received}; to receive programs without %, use --wrap ''",
        received=f"{progress.leading_text!r}",
    )


def _tell(last_reason: str, progress: TransferProgress) -> str:
    """Print why the received data is not a program, unless this reason equals ``last_reason``.

    Returns the reason that was printed last.
    """
    if not progress.leading_text or last_reason == progress.wait_reason:
        return last_reason
    sys.stderr.write(f"turndesk: {_format_received(progress)}\n")
    return progress.wait_reason


def run_transfer(transfer: SerialLineTransfer[T], description: str) -> T | None:
    """Run a transfer and return its result, or print the error and return None if the transfer fails."""
    from concurrent.futures import ThreadPoolExecutor, wait

    from app.cli.proofs.progress_bar import ProgressBar
    from app.programs.atomic_files import FileOperationError
    from core.ports import DriverError

    with ThreadPoolExecutor(1, thread_name_prefix="serial") as pool, ProgressBar(description) as progress:
        future, printed_text = pool.submit(transfer.run_transfer), ""
        try:
            while not wait([future], _POLL_INTERVAL_S).done:
                progress.total = transfer.progress.total_byte_count
                progress.report_progress(transfer.progress.transferred_byte_count)
                printed_text = _tell(printed_text, transfer.progress)
            return future.result()
        except (DriverError, FileOperationError) as error:
            sys.stderr.write(f"turndesk: {error}\n")
            return None
        except KeyboardInterrupt:
            transfer.cancel()
            raise
