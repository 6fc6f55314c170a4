"""The command ``turndesk where``, which prints the folders and files that TurnDesk uses."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING

from app.desk.command_errors import EXIT_OK

if TYPE_CHECKING:
    from app.cli.program_options import SubParsers


def add_parser(subparsers: SubParsers) -> None:
    """Add the parser of the command ``where``."""
    parser = subparsers.add_parser("where")
    parser.add_argument(
        "--machine", metavar="FILE", help="machine file (default: the shipped simulated lathe)"
    )
    parser.add_argument("--json", action="store_true", help="print a JSON object on stdout")


def run(args: argparse.Namespace) -> int:
    """Print one location per line, and mark each location that does not exist yet.

    Raises CommandError if the machine file is invalid.
    """
    places = find_file_locations(args.machine)
    if args.json:
        sys.stdout.write(json.dumps(places, indent=1) + "\n")
        return EXIT_OK
    from pathlib import Path

    width = max(map(len, places))
    for name, path in places.items():
        missing = "" if Path(path).exists() else "   (does not exist yet)"
        sys.stdout.write(f"{name:{width}}  {path}{missing}\n")
    return EXIT_OK


def find_file_locations(machine_file: str | None) -> Mapping[str, str]:
    """Return the path of each file and folder by name. Raises CommandError if the machine file is invalid."""
    from app import __file__ as package
    from app.compose.machine.machine_files import find_machine_path
    from app.compose.machine.machine_setup import read_machine
    from app.desk.data_folder import BACKUPS_FOLDER_NAME, RECORDS_FOLDER_NAME, find_data_folder
    from core.store.store_file import STORE_FILE_NAME
    from resources import get_documents_folder, get_posts_folder

    read_machine(machine_file)
    data = find_data_folder()
    return {
        "data_folder": str(data),
        "store": str(data / STORE_FILE_NAME),
        "programs": str(data / "programs"),
        "logs": str(data / "logs"),
        "backups": str(data / BACKUPS_FOLDER_NAME),
        "scope_records": str(data / RECORDS_FOLDER_NAME),
        "machine_file": str(find_machine_path(machine_file)),
        "posts": str(get_posts_folder()),
        "documents": str(get_documents_folder()),
        "code": str(package),
    }
