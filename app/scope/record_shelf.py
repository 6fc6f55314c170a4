"""Scope records on the disk: listing, saving, opening and exporting.

All functions run on a worker. A full disk and an invalid file raise an error with a message for the operator.
"""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple, TypeVar

from app.desk.status.formats import file_size
from core.file_placing import put_in_place
from core.message import CodedError, Message
from core.records.record import Record
from core.records.record_file import ENDING

ALARM_TIME = "alarm time"  # key of an alarm record: the alarm's time on the clock of the samples
INSTANT = "instant"  # key of a record: seconds from its first sample to the trigger or the alarm
MOST = 500
_ROOM = 20_000_000  # bytes of disk space reserved for the store and the log


class ShelfError(CodedError):
    """Failed file operation. The message states the reason and the remedy."""


class Kept(NamedTuple):
    """Record file with its path, modification time and size in bytes."""

    path: Path
    written: float
    size: int

    @property
    def when(self) -> str:
        """Month, day and time of the last modification. The name contains the year."""
        return time.strftime("%m-%d %H:%M:%S", time.localtime(self.written))

    @property
    def size_words(self) -> str:
        """Size of the file as text with a unit."""
        return file_size(self.size)


T = TypeVar("T")
Save = Callable[[Record, Path], None]
Open = Callable[[Path], Record]
WriteTable = Callable[[Record, Callable[[str], object]], None]


@dataclass(slots=True)
class RecordShelf:
    """Folder of scope records, with the functions that know the file format.

    Errors are raised as ShelfError or as an error whose text is a message for the operator.
    """

    folder: Path
    save: Save
    open_file: Open
    table: WriteTable
    clock: Callable[[], float] = time.time
    files: tuple[Kept, ...] = field(default=())

    def look(self) -> tuple[Kept, ...]:
        """Return the record files, newest first, at most ``MOST``; runs on a worker."""
        found = []
        with suppress(FileNotFoundError):
            for entry in os.scandir(self.folder):
                with suppress(OSError):
                    if entry.name.endswith(ENDING) and entry.is_file():
                        told = entry.stat()
                        found.append(Kept(Path(entry.path), told.st_mtime, told.st_size))
        return tuple(sorted(found, key=lambda each: -each.written)[:MOST])

    def keep(self, record: Record, stem: str = "scope") -> Path:
        """Save a record under a name with date and time, and return its path. Raises ShelfError."""
        path = self._new(stem, ENDING)
        self._guarded(path, lambda: self.save(record, path))
        return path

    def write_csv(self, record: Record) -> Path:
        """Write a record as a CSV table and return its path. Raises ShelfError."""
        path = self._new("scope", ".csv")

        def write() -> None:
            with _draft(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
                self.table(record, file.write)
            put_in_place(draft, path)

        self._guarded(path, write)
        return path

    def write_picture(self, png: bytes) -> Path:
        """Save a picture of the page and return its path. Raises ShelfError."""
        path = self._new("scope", ".png")

        def write() -> None:
            with _draft(path) as draft:
                draft.write_bytes(png)
            put_in_place(draft, path)

        self._guarded(path, write)
        return path

    def open(self, path: Path) -> Record:
        """Open a stored record. Raises ShelfError."""
        return self._told(path, lambda: self.open_file(path))

    def delete(self, path: Path) -> None:
        """Delete a record file. Raises ShelfError."""
        self._told(path, path.unlink)

    def _new(self, stem: str, ending: str) -> Path:
        """Return an unused path with the date and time."""
        named = f"{stem} {time.strftime('%Y-%m-%d %H-%M-%S', time.localtime(self.clock()))}"
        names = (f"{named}{more}{ending}" for more in ("", *(f" {n}" for n in range(2, 100))))
        return next(self.folder / name for name in names if not (self.folder / name).exists())

    def _guarded(self, path: Path, write: Callable[[], None]) -> None:
        """Write a file if there is enough disk space."""

        def carefully() -> None:
            self.folder.mkdir(parents=True, exist_ok=True)
            if shutil.disk_usage(self.folder).free < _ROOM:
                raise ShelfError(
                    Message("{path} NOT SAVED: DISK FULL. DELETE RECORDS OR PROGRAMS", path=path.name),
                    "disk-full",
                )
            write()

        self._told(path, carefully)

    def _told(self, path: Path, work: Callable[[], T]) -> T:
        """Run a file operation and convert an OSError into a ShelfError with the file name."""
        try:
            return work()
        except ShelfError:
            raise
        except OSError as error:
            raise ShelfError(
                Message("{path}: {cause}", path=path.name, cause=error.strerror or error), "unusable"
            ) from error


def _draft(path: Path) -> _Draft:
    return _Draft(path.with_name(path.name + ".part"))


class _Draft:
    """Temporary file next to its target, deleted if writing fails."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __enter__(self) -> Path:
        return self._path

    def __exit__(self, kind: object, *_rest: object) -> None:
        if kind is not None:
            with suppress(OSError):
                self._path.unlink()


def instant_of(record: Record) -> float:
    """Return the instant 0 of a record on its clock: the trigger or alarm, or else the last sample."""
    told = record.about.get(INSTANT, "")
    if not len(record.times):
        return 0.0
    try:
        if not told and ALARM_TIME in record.about:
            return float(record.about[ALARM_TIME])
        return float(record.times[0]) + float(told)
    except ValueError:
        return float(record.times[-1])
