"""Which files of a folder are programs: those that the desk's list shows, in the folder and below it."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from app.desk.command_errors import CommandError
from core.message import Message


@dataclass(frozen=True, slots=True)
class ProgramFiles:
    """The programs in the order of their names, and how many files of the folders are none."""

    paths: tuple[Path, ...]
    others: int


def program_files(names: Iterable[str]) -> ProgramFiles:
    """The programs that files and folders name; a file that is named counts whatever its ending is.

    Raises CommandError for a folder that cannot be read or holds no program.
    """
    found: set[Path] = set()
    others = 0
    for path in map(Path, _named(names)):
        if not path.is_dir():
            found.add(path)
            continue
        there = list(_files(path))
        programs = {each for each in there if _is_program(each)}
        if not programs:
            raise CommandError(
                Message(
                    "{path} does not contain any programs{there_count}; use a different folder",
                    path=path,
                    there_count=_among(len(there)),
                ),
                "no-programs",
            )
        found |= programs
        others += len(there) - len(programs)
    return ProgramFiles(tuple(sorted(found, key=_by_name)), others)


def _named(names: Iterable[str]) -> Iterator[str]:
    """They, unless one is empty, as a script's variable may be: that would be the folder one stands in."""
    for name in names:
        if not name:
            raise CommandError("the file name is empty; use . for the programs in this folder", "empty-name")
        yield name


def _among(count: int) -> str:
    return Message(", only {count} other file{value}", count=count, value="s" * (count > 1)) if count else ""


def _by_name(path: Path) -> tuple[list[str], str]:
    return [part.lower() for part in path.parts], str(path)


def _files(folder: Path) -> Iterator[Path]:
    """All files in and below a folder but those of hidden folders; links to folders lead nowhere."""
    for where, folders, names in os.walk(folder, onerror=_unreadable):
        folders[:] = [name for name in folders if not name.startswith(".")]
        yield from (Path(where) / name for name in names)


def _unreadable(error: OSError) -> None:
    raise CommandError(
        Message(
            "{file} cannot be read ({cause}); check its permissions",
            file=error.filename,
            cause=error.strerror,
        ),
        "unreadable",
    ) from error


def _is_program(path: Path) -> bool:
    from app.desk.program_folder import ENDINGS

    return path.suffix.lower() in ENDINGS and not path.name.startswith(".") and path.is_file()
