"""Records of the scope on the disk: what is there, saved, opened, and written as a table for others.

All of it is a worker's; a full disk and a file that is none are told in a sentence.
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

ALARM_TIME = "alarm time"  # of the words of an alarm's record: on the clock of its samples
INSTANT = "instant"  # of a record's words: seconds from its first sample to the trigger or the alarm
MOST = 500
_ROOM = 20_000_000  # bytes that are left free: the store and the log need the disk more


class ShelfError(CodedError):
    """It was not done; the sentence says why and what to do."""


class Kept(NamedTuple):
    """One file: its name, when it was written, how large it is."""

    path: Path
    written: float
    size: int

    @property
    def when(self) -> str:
        """Day and time at which it was written; the year stands in its name."""
        return time.strftime("%m-%d %H:%M:%S", time.localtime(self.written))

    @property
    def size_words(self) -> str:
        """How large, in words."""
        return file_size(self.size)


T = TypeVar("T")
Save = Callable[[Record, Path], None]
Open = Callable[[Path], Record]
WriteTable = Callable[[Record, Callable[[str], object]], None]


@dataclass(slots=True)
class RecordShelf:
    """``folder`` holds the records; ``save``, ``open_file`` and ``table`` know the format.

    What they raise is a sentence: ShelfError, or an error whose text is one.
    """

    folder: Path
    save: Save
    open_file: Open
    table: WriteTable
    clock: Callable[[], float] = time.time
    files: tuple[Kept, ...] = field(default=())

    def look(self) -> tuple[Kept, ...]:
        """What is there now, newest first. On a worker."""
        found = []
        with suppress(FileNotFoundError):
            for entry in os.scandir(self.folder):
                with suppress(OSError):
                    if entry.name.endswith(ENDING) and entry.is_file():
                        told = entry.stat()
                        found.append(Kept(Path(entry.path), told.st_mtime, told.st_size))
        return tuple(sorted(found, key=lambda each: -each.written)[:MOST])

    def keep(self, record: Record, stem: str = "scope") -> Path:
        """Save a record under the time of day. Raises ShelfError."""
        path = self._new(stem, ENDING)
        self._guarded(path, lambda: self.save(record, path))
        return path

    def write_csv(self, record: Record) -> Path:
        """The same as a table of figures. Raises ShelfError."""
        path = self._new("scope", ".csv")

        def write() -> None:
            with _draft(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
                self.table(record, file.write)
            put_in_place(draft, path)

        self._guarded(path, write)
        return path

    def write_picture(self, png: bytes) -> Path:
        """A picture of the page. Raises ShelfError."""
        path = self._new("scope", ".png")

        def write() -> None:
            with _draft(path) as draft:
                draft.write_bytes(png)
            put_in_place(draft, path)

        self._guarded(path, write)
        return path

    def open(self, path: Path) -> Record:
        """A record that was kept. Raises ShelfError."""
        return self._told(path, lambda: self.open_file(path))

    def delete(self, path: Path) -> None:
        """Take a file away. Raises ShelfError."""
        self._told(path, path.unlink)

    def _new(self, stem: str, ending: str) -> Path:
        """A name that is free, by the time of day."""
        named = f"{stem} {time.strftime('%Y-%m-%d %H-%M-%S', time.localtime(self.clock()))}"
        names = (f"{named}{more}{ending}" for more in ("", *(f" {n}" for n in range(2, 100))))
        return next(self.folder / name for name in names if not (self.folder / name).exists())

    def _guarded(self, path: Path, write: Callable[[], None]) -> None:
        """Write where there is room."""

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
        """Do it; what goes wrong is told with the file's name."""
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
    """A file beside its place; gone again where it was not finished."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __enter__(self) -> Path:
        return self._path

    def __exit__(self, kind: object, *_rest: object) -> None:
        if kind is not None:
            with suppress(OSError):
                self._path.unlink()


def instant_of(record: Record) -> float:
    """The record's instant 0, of its clock: the trigger or the alarm, else its last sample."""
    told = record.about.get(INSTANT, "")
    if not len(record.times):
        return 0.0
    try:
        if not told and ALARM_TIME in record.about:
            return float(record.about[ALARM_TIME])
        return float(record.times[0]) + float(told)
    except ValueError:
        return float(record.times[-1])
