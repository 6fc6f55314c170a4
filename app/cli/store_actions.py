"""What ``turndesk store`` does."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path

from app.cli.errors import EXIT_ERRORS, EXIT_OK
from app.cli.offset_file import read_rows
from app.cli.opened_store import opened_store, told
from app.cli.zero_file import read_zero
from app.desk.data_folder import data_folder
from core.store import backup, checking, database, export


def _backup(args: argparse.Namespace) -> int:
    with told():
        backup.backup(data_folder(), Path(args.path))
    sys.stdout.write(f"{args.path} holds the store of {data_folder()}\n")
    return EXIT_OK


def _restore(args: argparse.Namespace) -> int:
    with told():
        kept = backup.restore(data_folder(), Path(args.path))
    beside = f"; the replaced store is kept as {kept}" if kept else ""
    sys.stdout.write(f"{data_folder()} is as {args.path} has it{beside}\n")
    return EXIT_OK


def _export(args: argparse.Namespace) -> int:
    with opened_store(read_only=True) as store:
        count = export.export(store, Path(args.path))
    sys.stdout.write(f"{args.path} holds programs: {count}, the offsets, the events and the runs\n")
    return EXIT_OK


def _import(args: argparse.Namespace) -> int:
    folder = Path(args.path)
    offsets_file = folder / export.OFFSETS
    tools, secondary = read_rows(offsets_file) if offsets_file.exists() else ({}, {})
    zero = read_zero(offsets_file) if offsets_file.exists() else {}
    with opened_store() as store:
        programs = export.program_files(folder)
        store.import_all(programs, tools, secondary, f"import of {folder.name}", zero).result()
    counts = f"{len(programs)}, tool offsets: {len(tools)}, secondary offsets: {len(secondary)}"
    sys.stdout.write(f"taken from {folder}: programs: {counts}\n")
    return EXIT_OK


def _verify(args: argparse.Namespace) -> int:
    path = data_folder() / database.FILE_NAME
    with told():
        problems = checking.problems(path) if path.exists() else ()
    if args.json:
        sys.stdout.write(json.dumps({"store": str(path), "problems": problems}) + "\n")
    elif not problems:
        sys.stdout.write(
            f"{path} is whole\n" if path.exists() else f"there is no store in {data_folder()} yet\n"
        )
    sys.stderr.write("".join(f"turndesk: {path}: {problem}\n" for problem in problems))
    return EXIT_ERRORS if problems else EXIT_OK


ACTIONS: dict[str, Callable[[argparse.Namespace], int]] = {
    "backup": _backup,
    "restore": _restore,
    "export": _export,
    "import": _import,
    "verify": _verify,
}
