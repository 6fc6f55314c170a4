"""The command ``turndesk alarms``, which lists all alarms, feed holds and stops.

Each entry has a number, the likely causes and the remedy.
"""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING

from app.desk.command_errors import EXIT_OK, CommandError
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers
    from core.alarms import AlarmCode, AlarmEntry


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``alarms``."""
    parser = subparsers.add_parser("alarms")
    parser.add_argument(
        "number", nargs="*", type=int, metavar="NUMBER", help="numbers of the alarms to list (default: all)"
    )
    parser.add_argument("--json", action="store_true", help="print a JSON list of objects on stdout")


def run(args: argparse.Namespace) -> int:
    """Print the whole alarm catalog, or only the entries with the given numbers."""
    from core.alarms import CATALOG

    chosen = sorted(CATALOG.items(), key=lambda each: each[1].number)
    if args.number:
        known = {entry.number for entry in CATALOG.values()}
        missing = [str(number) for number in args.number if number not in known]
        if missing:
            raise CommandError(
                Message(
                    "no such alarm: {missing}; 'turndesk alarms' lists all alarms",
                    missing=", ".join(missing),
                ),
                "unknown-alarm",
            )
        chosen = [(code, entry) for code, entry in chosen if entry.number in args.number]
    if args.json:
        sys.stdout.write(json.dumps([_object(*each) for each in chosen], indent=1) + "\n")
    else:
        sys.stdout.write("\n".join(_text(entry) for _, entry in chosen))
    return EXIT_OK


def _object(code: AlarmCode, entry: AlarmEntry) -> dict[str, object]:
    from core.alarms.alarms_page import get_alarm_kind

    return {
        "number": entry.number,
        "code": code,
        "kind": get_alarm_kind(entry.reaction),
        "text": entry.text.upper(),
        "causes": list(entry.causes),
        "remedy": entry.remedy,
    }


def _text(entry: AlarmEntry) -> str:
    from core.alarms.alarms_page import get_alarm_kind

    causes = "".join(f"     why: {cause}\n" for cause in entry.causes)
    head = f"{entry.number}  {entry.text.upper()}  ({get_alarm_kind(entry.reaction)})"
    return f"{head}\n{causes}      do: {entry.remedy}\n"
