"""``turndesk serial ports|send|receive``: programs over RS-232."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.errors import EXIT_ERRORS, EXIT_OK, CommandError

if TYPE_CHECKING:
    from app.cli.options import SubParsers
    from app.desk.transfer.service import Received
    from core.machine.hardware.model import DncModel
    from core.machine.model import Machine

_EOL = {"crlf": "\r\n", "lf": "\n", "cr": "\r"}


def add_parser(subparsers: SubParsers) -> None:
    """The subcommand with its actions."""
    parser = subparsers.add_parser("serial", help="send and receive programs over RS-232")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    actions.add_parser("ports", help="the serial ports of this computer")
    send = actions.add_parser("send", help="send a program")
    send.add_argument("file", metavar="FILE")
    receive = actions.add_parser(
        "receive", help="receive a program; it is stored as a new one, never started"
    )
    receive.add_argument(
        "--out", metavar="NAME", help="file for it; default: its own name, with the programs"
    )
    for each in (send, receive):
        _add_line(each)


def _add_line(parser: argparse.ArgumentParser) -> None:
    """What is not said is that of the machine file's [dnc], else 9600 8N1, XON/XOFF, % and CR LF."""
    parser.add_argument("--machine", metavar="FILE", help="machine file whose [dnc] gives the settings")
    parser.add_argument("--port", metavar="DEVICE")
    parser.add_argument("--baud", type=int)
    parser.add_argument("--bits", type=int, choices=(7, 8))
    parser.add_argument("--parity", choices=("N", "E", "O"))
    parser.add_argument("--stop", type=int, choices=(1, 2))
    parser.add_argument("--flow", choices=("xonxoff", "rtscts", "none"))
    parser.add_argument("--wrap", choices=("%", ""), help="the line around a program; '' for none")
    parser.add_argument("--eol", choices=tuple(_EOL))
    parser.add_argument(
        "--dc-codes", action="store_true", default=None, help="DC2 and DC4 around what is sent"
    )
    parser.add_argument("--wait", action="store_true", default=None, help="send when DC1 has come")
    parser.add_argument("--leader", type=int, metavar="COUNT", help="NULs before and behind what is sent")


def run(args: argparse.Namespace) -> int:
    """0 done; 1 not transferred, or stored with errors; 2 usage."""
    if args.action == "ports":
        return _ports()
    from app.compose.machine import read_machine

    machine = read_machine(args.machine)
    settings = _settings(args, machine)
    return _send(args, settings) if args.action == "send" else _receive(args, machine, settings)


def _ports() -> int:
    from app.compose.serial_line import serial_ports
    from core.ports import DriverError

    try:
        found = serial_ports()
    except DriverError as error:
        raise CommandError(str(error)) from error
    sys.stdout.write("".join(f"{device}  {what}".rstrip() + "\n" for device, what in found))
    if not found:
        sys.stderr.write("turndesk: this computer has no serial port; plug the adapter in\n")
    return EXIT_OK


def _settings(args: argparse.Namespace, machine: Machine) -> DncModel:
    from dataclasses import replace

    from app.compose.transfer import PLAIN

    model = machine.hardware.dnc or PLAIN
    names = ("port", "baud", "bits", "parity", "stop", "flow", "wrap", "dc_codes", "wait", "leader")
    said = {name: value for name in names if (value := getattr(args, name)) is not None}
    if args.eol:
        said["eol"] = _EOL[args.eol]
    model = replace(model, **said)
    if not model.port:
        raise CommandError("no port: say --port, or give the machine file a [dnc] table")
    if model.baud < 1 or model.leader < 0:
        raise CommandError("--baud and --leader: expected a number that a line can have")
    return model


def _send(args: argparse.Namespace, settings: DncModel) -> int:
    from app.cli.carrying import carry
    from app.compose.transfer import SerialLines

    path = Path(args.file)
    lines = SerialLines(lambda _source: ((), 0.0))
    sent = carry(lines.send(settings, path), f"sending {path.name}")
    if sent is None:
        return EXIT_ERRORS
    sys.stdout.write(f"{path.name}: {sent} bytes sent to {settings.port}\n")
    return EXIT_OK


def _receive(args: argparse.Namespace, machine: Machine, settings: DncModel) -> int:
    from app.cli.carrying import carry
    from app.compose.offsets import chosen_offsets
    from app.compose.screen import workshop
    from app.compose.transfer import SerialLines, proving

    lines = SerialLines(proving(workshop(machine, chosen_offsets(None))))
    received = carry(lines.receive(settings), f"receiving from {settings.port}")
    if received is None:
        return EXIT_ERRORS
    return _store(args, received)


def _store(args: argparse.Namespace, received: Received) -> int:
    from app.desk.files.changes import FileError
    from app.desk.home import home
    from app.desk.transfer.storing import free_name, stored

    out = Path(args.out) if args.out else None
    folder = out.parent if out else home() / "programs"
    try:
        path = stored(received.text, folder, out.name if out else free_name(folder, received.name))
    except FileError as error:
        sys.stderr.write(f"turndesk: {error}\n")
        return EXIT_ERRORS
    seven = ", seven bits with even parity" if received.seven else ""
    sys.stdout.write(
        f"{path}: {received.lines} lines, whole{seven}\n  SHA-256 {received.digest}\n  {_found(received)}\n"
    )
    sys.stderr.write("".join(f"{text}\n" for text in received.findings))
    return EXIT_ERRORS if received.findings else EXIT_OK


def _found(received: Received) -> str:
    if received.findings:
        return f"{len(received.findings)} errors; it is stored to be mended"
    return f"proved without an error, cycle {received.cycle:.1f} s; nothing was started"
