"""The command ``turndesk report-bug``, which writes a bug report without names, paths and addresses."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.command_errors import EXIT_OK, CommandError, make_write_error
from core.message import Message

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers

DEFAULT_FILE_NAME = "turndesk-report.txt"


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``report-bug``."""
    parser = subparsers.add_parser("report-bug")
    parser.add_argument(
        "file", nargs="?", metavar="FILE", help="program to include (default: the one that was started last)"
    )
    parser.add_argument("--machine", metavar="FILE", help="machine file to include (default: the one in use)")
    parser.add_argument(
        "--out",
        metavar="FILE",
        default=DEFAULT_FILE_NAME,
        help=f"file to write (default: {DEFAULT_FILE_NAME})",
    )
    parser.add_argument("--yes", action="store_true", help="write the file without asking")


def run(args: argparse.Namespace) -> int:
    """Print the report, ask for confirmation, and write the report to a new file.

    Raises CommandError if the file exists or cannot be written, or if a named program or machine file
    cannot be read.
    """
    from app.cli.bug_report.bug_report import generate_bug_report

    target = Path(args.out)
    if target.exists():
        raise CommandError(
            Message("{file} exists already; name another file with --out", file=target), "file-exists"
        )
    text = generate_bug_report(args.machine, Path(args.file) if args.file else None)
    sys.stdout.write(text)
    if not args.yes and not _is_confirmed(target):
        sys.stdout.write("nothing was written\n")
        return EXIT_OK
    try:
        number = os.open(target, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with open(number, "w", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise make_write_error(target, error) from error
    sys.stdout.write(f"written: {target}\n")
    return EXIT_OK


def _is_confirmed(target: Path) -> bool:
    """Return whether the user agrees to write the displayed report to the file ``target``."""
    sys.stdout.write(f"\nRead the text above. Write it to {target}? [y/N] ")
    sys.stdout.flush()
    return sys.stdin.readline().strip().lower() in {"y", "yes"}
