"""A program that a command has made from a file: written to a new file, with a line in the log."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.cli.store_command import opened_store
from app.cli.who_changes import note_change, who_may
from app.desk.command_errors import CommandError, as_command_error
from core.access.access_table import Act
from core.message import Message


def may_write(args: argparse.Namespace) -> str:
    """Return who may write ``--out``, empty without one. Raises CommandError."""
    if args.out is None:
        return ""
    if Path(args.out).exists():
        raise CommandError(
            Message("{file} already exists and will not be overwritten; use a different name", file=args.out),
            "file-exists",
        )
    if not Path(args.out).parent.is_dir():
        raise CommandError(
            Message("{file} cannot be written: its folder does not exist", file=args.out), "no-folder"
        )
    return who_may(opened_store, args, Act.PROGRAMS)


def write_made(args: argparse.Namespace, text: str, who: str) -> None:
    """Write ``--out``, which must not exist yet. Raises CommandError."""
    from app.programs.whole_file import FileError, write_new

    with as_command_error(FileError):
        write_new(Path(args.out), text.encode("ascii"))
    note_change(
        opened_store,
        who,
        Message("program {out} made from {file}", out=Path(args.out).name, file=Path(args.file).name),
    )
