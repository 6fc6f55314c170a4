"""``turndesk serial ports|send|receive``: programs over RS-232."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from app.cli.store_command import opened_store
from app.cli.who_changes import add_as_option, note_change, who_may
from app.desk.command_errors import EXIT_ERRORS, EXIT_OK, CommandError
from core.access.access_table import Act
from core.coded_error import error_code
from core.input_file import open_input

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from app.transfer.line_transfer import Received, Transfer, TransferProgress
    from core.machine.machine_model import Machine
    from core.machine.serial_table import DncModel

_EOL = {"crlf": "\r\n", "lf": "\n", "cr": "\r"}


_ABOUT = """\
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
    """The subcommand with its actions."""
    raw = argparse.RawDescriptionHelpFormatter
    parser = subparsers.add_parser(
        "serial", help="send and receive programs over RS-232", description=_ABOUT, formatter_class=raw
    )
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    actions.add_parser("ports", help="the serial ports of this computer")
    send = actions.add_parser("send", help="send a program", description=_ABOUT, formatter_class=raw)
    send.add_argument("file", metavar="FILE", help="program; a %% around it is added where it has none")
    receive = actions.add_parser(
        "receive",
        help="receive a program; it is stored as a new one, never started",
        description=_ABOUT,
        formatter_class=raw,
    )
    receive.add_argument(
        "--out",
        metavar="NAME",
        help="file for it, which must not exist; default: its own name, with the programs",
    )
    for each in (send, receive):
        _add_line(each)
    add_as_option(receive)
    _add_sending(send)


def _add_line(parser: argparse.ArgumentParser) -> None:
    """What both directions have; not said, it is that of the machine file's [dnc]."""
    parser.add_argument("--machine", metavar="FILE", help="machine file whose [dnc] gives the settings")
    parser.add_argument("--port", metavar="DEVICE", help="/dev/ttyUSB0, COM3; see: turndesk serial ports")
    parser.add_argument("--baud", type=int, metavar="RATE", help="bits per second, usually 110 to 115200")
    parser.add_argument("--bits", type=int, choices=(7, 8), help="data bits; older controls: 7, --parity E")
    parser.add_argument("--parity", choices=("N", "E", "O"), help="none, even or odd")
    parser.add_argument("--stop", type=int, choices=(1, 2), help="stop bits")
    parser.add_argument(
        "--flow", choices=("xonxoff", "rtscts", "none"), help="how a side that is not ready holds the other"
    )
    parser.add_argument(
        "--wrap", choices=("%", ""), metavar="SIGN", help="line around a program: %% or '' for none"
    )
    parser.add_argument(
        "--dc-codes",
        action="store_true",
        default=None,
        help="tape codes: DC2 and DC4 around what is sent, DC1 and DC3 around what is received",
    )


def _add_sending(parser: argparse.ArgumentParser) -> None:
    """What concerns only what is sent."""
    parser.add_argument("--eol", choices=tuple(_EOL), help="line end of what is sent")
    parser.add_argument(
        "--wait", action="store_true", default=None, help="send when the other side asks for it (DC1)"
    )
    parser.add_argument(
        "--leader", type=int, metavar="COUNT", help="so many NULs before and behind what is sent"
    )


def run(args: argparse.Namespace) -> int:
    """0 done; 1 not transferred, or stored with errors; 2 usage."""
    if args.action == "ports":
        return _ports()
    from app.compose.machine_setup import read_machine

    machine = read_machine(args.machine)
    settings = _settings(args, machine)
    return _send(args, settings) if args.action == "send" else _receive(args, machine, settings)


def _ports() -> int:
    from app.compose.serial_ports import serial_ports
    from core.ports import DriverError

    try:
        found = serial_ports()
    except DriverError as error:
        raise CommandError(str(error), error_code(error)) from error
    sys.stdout.write("".join(f"{device}  {what}".rstrip() + "\n" for device, what in found))
    if not found:
        sys.stderr.write("turndesk: this computer has no serial port; plug the adapter in\n")
    return EXIT_OK


def _settings(args: argparse.Namespace, machine: Machine) -> DncModel:
    from dataclasses import replace

    from app.compose.program_transfer import PLAIN
    from core.machine.serial_table import DncModel

    model = machine.hardware.table(DncModel) or PLAIN
    names = ("port", "baud", "bits", "parity", "stop", "flow", "wrap", "dc_codes", "wait", "leader")
    said = {name: value for name in names if (value := getattr(args, name, None)) is not None}
    if getattr(args, "eol", None):
        said["eol"] = _EOL[args.eol]
    model = replace(model, **said)
    if not model.port:
        raise CommandError("no port: say --port, or give the machine file a [dnc] table", "no-port")
    if not 110 <= model.baud <= 1_000_000:
        raise CommandError(f"--baud {model.baud}: expected 110 to 1000000", "baud")
    if not 0 <= model.leader <= 2000:
        raise CommandError(f"--leader {model.leader}: expected 0 to 2000", "leader")
    return model


def _send(args: argparse.Namespace, settings: DncModel) -> int:
    from app.compose.program_transfer import SerialLines

    path = Path(args.file)
    _check_readable(path)
    lines = SerialLines(lambda _source: ((), 0.0))
    sent = carry(lines.send(settings, path), f"sending {path.name}")
    if sent is None:
        return EXIT_ERRORS
    sys.stdout.write(f"{path.name}: {sent} bytes sent to {settings.port}\n")
    return EXIT_OK


def _check_readable(path: Path) -> None:
    """Before the line is opened, and with the status of a file that cannot be read. Raises CommandError."""
    try:
        with open_input(path) as file:
            file.read(1)
    except OSError as error:
        raise CommandError(f"{path} cannot be read: {error.strerror}", "unreadable") from error


def _receive(args: argparse.Namespace, machine: Machine, settings: DncModel) -> int:
    from app.compose.program_transfer import SerialLines, proving
    from app.compose.stored_offsets import chosen_offsets
    from app.compose.workshop import workshop
    from core.language.source import Dialect, usual_ending

    if args.out and Path(args.out).exists():  # before anything is waited for: it could not be stored
        sys.stderr.write(f"turndesk: {args.out} is there already and is never replaced; take another name\n")
        return EXIT_ERRORS
    who = who_may(opened_store, args, Act.PROGRAMS)  # before anything is waited for
    ending = usual_ending(Dialect(machine.language))
    lines = SerialLines(proving(workshop(machine, chosen_offsets(None), pictures=False)), ending)
    received = carry(lines.receive(settings), f"receiving from {settings.port}")
    if received is None:
        return EXIT_ERRORS
    return _store(args, received, who)


def _store(args: argparse.Namespace, received: Received, who: str) -> int:
    from app.desk.data_folder import data_folder
    from app.programs.whole_file import FileError
    from app.transfer.line_transfer import free_name, store_new

    out = Path(args.out) if args.out else None
    folder = out.parent if out else data_folder() / "programs"
    try:
        path = store_new(received, folder, out.name if out else free_name(folder, received.name))
    except FileError as error:
        sys.stderr.write(f"turndesk: {error}\n")
        return EXIT_ERRORS
    note_change(opened_store, who, f"program {path.name} received")
    seven = ", seven bits with even parity" if received.seven else ""
    lines = "1 line" if received.lines == 1 else f"{received.lines} lines"
    sys.stdout.write(f"{path}: {lines}, whole{seven}\n  SHA-256 {received.digest}\n  {_found(received)}\n")
    sys.stderr.write("".join(f"{text}\n" for text in received.findings))
    return EXIT_ERRORS if received.findings else EXIT_OK


def _found(received: Received) -> str:
    if received.findings:
        count = len(received.findings)
        return f"{count} error{'s' * (count != 1)}; it is stored to be mended"
    return f"proved without an error, cycle {received.cycle:.1f} s; nothing was started"


# --- a transfer on the command line: progress on stderr, Ctrl-C gives it up -----------------------------

T = TypeVar("T")
_LOOK = 0.1  # s


def _heard(reach: TransferProgress) -> str:
    """Why what comes is not taken for a program."""
    if reach.what == "noise":
        return f"what comes is no text ({reach.heard}): look at --baud, --bits and --parity, and at the cable"
    return f"text comes, but no %: {reach.heard!r}; --wrap '' takes programs without it"


def _tell(told: str, reach: TransferProgress) -> str:
    """Say once of which kind it is; what has been said by now."""
    if not reach.heard or told == reach.what:
        return told
    sys.stderr.write(f"turndesk: {_heard(reach)}\n")
    return reach.what


def carry(transfer: Transfer[T], what: str) -> T | None:
    """What it answers; None when it came to nothing, which has then been said in one sentence."""
    from concurrent.futures import ThreadPoolExecutor, wait

    from app.cli.progress_bar import Progress
    from app.programs.whole_file import FileError
    from core.ports import DriverError

    with ThreadPoolExecutor(1, thread_name_prefix="serial") as pool, Progress(what) as progress:
        future, told = pool.submit(transfer.run), ""
        try:
            while not wait([future], _LOOK).done:
                progress.total = transfer.reach.total
                progress.reach(transfer.reach.done)
                told = _tell(told, transfer.reach)
            return future.result()
        except (DriverError, FileError) as error:
            sys.stderr.write(f"turndesk: {error}\n")
            return None
        except KeyboardInterrupt:
            transfer.cancel()
            raise
