"""The programs that can be chosen, with all that is known of each; how they are sorted."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from pathlib import Path

from app.desk.persistence import Persistence
from app.desk.programs.program_folder import LISTED, ProgramFolders
from app.desk.status import formats
from core.language.source import SourceError, load_source
from core.store.program_records import key_of_text
from core.store.store_rows import RunRow


@dataclass(frozen=True, slots=True)
class Program:
    """One file: bytes, seconds since 1970; ``sample`` ones are not the operator's and stay as they are."""

    name: str
    path: Path
    size: int
    changed: float
    sample: bool
    run: RunRow
    drawing: bool = False  # of which a program can be made

    @property
    def key(self) -> tuple[str, float, int]:
        """Another text is another key: what was drawn of it stays good as long as this is the same."""
        return str(self.path), self.changed, self.size


def list_programs(
    program_folders: ProgramFolders, own: Path, persistence: Persistence
) -> tuple[Program, ...]:
    """Return all programs of the folders and their drawings, each with the record of the text in the file.

    It reads every file whose text is not known yet: call it on a worker. Raises StoreError when the store
    cannot be read.
    """
    runs = persistence.runs_by_text()
    found = []
    for entry in (*program_folders.entries(), *program_folders.drawings()):
        if (status := _status(entry.path)) is not None:
            path, drawing = entry.path, program_folders.is_drawing(entry.name)
            key = "" if drawing else _key_in(path, status.st_mtime_ns, status.st_size)
            run = runs.get(key, RunRow(entry.name))
            sample = path.parent != own
            found.append(Program(entry.name, path, status.st_size, status.st_mtime, sample, run, drawing))
    return tuple(found)


@lru_cache(maxsize=2 * LISTED)
def _key_in(path: Path, _changed: int, _size: int) -> str:
    """Return the record key of the text in a file; empty for what is not program text."""
    try:
        return key_of_text(load_source(path).text)
    except SourceError:
        return ""


def _status(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except OSError:
        return None  # it has gone between two looks


Rank = tuple[float, str]
Order = Callable[[Program], Rank]
# Newest and most on top; the name decides between equals.
ORDERS: Mapping[str, Order] = {
    "NAME": lambda p: (0.0, p.name.lower()),
    "DATE": lambda p: (-p.changed, p.name.lower()),
    "LAST RUN": lambda p: (_backwards(p.run.started), p.name.lower()),
    "PARTS": lambda p: (-p.run.parts, p.name.lower()),
    "SIZE": lambda p: (-p.size, p.name.lower()),
}


def _backwards(at: str | None) -> float:
    return -datetime.fromisoformat(at).timestamp() if at else 0.0


def sorted_by(order: str, found: Sequence[Program]) -> tuple[Program, ...]:
    """In the order of this name."""
    return tuple(sorted(found, key=ORDERS[order]))


def minute_of(at: str | None) -> str:
    """A time of the store as a clock on the wall shows it; a dash where there is none."""
    return formats.local_time(at, seconds=False) if at else formats.NOTHING


def minute_of_file(seconds: float) -> str:
    """The time of a file in the same way."""
    return datetime.fromtimestamp(seconds).strftime("%Y-%m-%d %H:%M")
