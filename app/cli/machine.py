"""``turndesk machine``: is a machine file good, does everything in it answer, and what is told of it?"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.cli.options import SubParsers


def add_parser(subparsers: SubParsers) -> None:
    """The subcommand with its actions."""
    parser = subparsers.add_parser("machine", help="check a machine file")
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    check = actions.add_parser("check", help="validate a machine file, connect, report each drive and input")
    check.add_argument("file", metavar="FILE", nargs="?", help="default: the shipped simulated lathe")
    check.add_argument("--json", action="store_true", help="machine-readable output alone on stdout")
    peer = actions.add_parser(
        "peer",
        help="play what a CANopen or grblHAL machine file connects to, for trying it without hardware",
        description="Plays simulated drives and terminals on the bus of a CANopen machine file, or a grblHAL"
        " controller on its TCP port or on a pseudo terminal, whose name is printed. It goes on until Ctrl-C;"
        " start the control beside it: turndesk --machine FILE",
    )
    peer.add_argument("file", metavar="FILE", help="such as gt75-bench.toml")
    accept = actions.add_parser("accept", help="show what has changed in a machine file, and accept it")
    accept.add_argument("file", metavar="FILE")
    model = actions.add_parser(
        "mtconnect", help="print the device model (Devices.xml) for an MTConnect agent"
    )
    model.add_argument("file", metavar="FILE")


def run(args: argparse.Namespace) -> int:
    """Checks the file and what it connects to: 0 all is well, 1 something does not answer, 2 bad file."""
    if args.action == "peer":
        from app.cli.machine_peer import play

        return play(args.file)
    if args.action == "mtconnect":
        from app.cli.machine_mtconnect import write_model

        return write_model(args.file)
    if args.action == "accept":
        from app.cli.machine_accept import accept

        return accept(args.file)
    from app.cli.machine_check import check

    return check(args.file, json_wanted=args.json)
