"""Listing, saving, opening and exporting of scope recordings on the disk.

All functions run on a worker. A full disk and an invalid file raise an error with a message for the
operator.
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

from app.desk.status.formats import format_file_size
from core.file_replacement import replace_atomically
from core.message import CodedError, Message
from core.records.record import ScopeRecord
from core.records.record_file import RECORD_SUFFIX

ALARM_TIME_KEY = "alarm time"  # key of an alarm record: the alarm's time on the clock of the samples
ZERO_INSTANT_KEY = "instant"  # key of a record: seconds from its first sample to the trigger or the alarm
MAX_FILES = 500
_RESERVED_BYTES = 20_000_000  # bytes of disk space reserved for the store and the log


class RecordingFileError(CodedError):
    """Failed file operation, with a message that states the reason and the remedy."""


class RecordingFile(NamedTuple):
    """File of a scope recording, with its path, modification time and size in bytes."""

    path: Path
    modified_time_s: float
    size: int

    @property
    def modified_time_text(self) -> str:
        """Return the month, day and time of the last modification.

        The year is in the file name.
        """
        return time.strftime("%m-%d %H:%M:%S", time.localtime(self.modified_time_s))

    @property
    def size_text(self) -> str:
        """Return the size of the file as text with a unit."""
        return format_file_size(self.size)


T = TypeVar("T")
SaveRecording = Callable[[ScopeRecord, Path], None]
OpenRecording = Callable[[Path], ScopeRecord]
WriteCsvTable = Callable[[ScopeRecord, Callable[[str], object]], None]


@dataclass(slots=True)
class RecordingStore:
    """Folder of scope recordings, with functions that read and write them.

    Errors are raised as RecordingFileError, or as an error whose text is a message for the operator.
    """

    folder: Path
    save_recording: SaveRecording
    open_recording: OpenRecording
    write_csv_table: WriteCsvTable
    read_time_s: Callable[[], float] = time.time
    recording_files: tuple[RecordingFile, ...] = field(default=())

    def list_files(self) -> tuple[RecordingFile, ...]:
        """Return the record files, newest first, at most ``MAX_FILES`` of them.

        This runs on a worker.
        """
        found = []
        with suppress(FileNotFoundError):
            for entry in os.scandir(self.folder):
                with suppress(OSError):
                    if entry.name.endswith(RECORD_SUFFIX) and entry.is_file():
                        file_stat = entry.stat()
                        found.append(RecordingFile(Path(entry.path), file_stat.st_mtime, file_stat.st_size))
        return tuple(sorted(found, key=lambda each: -each.modified_time_s)[:MAX_FILES])

    def save_dated_record(self, record: ScopeRecord, name_stem: str = "scope") -> Path:
        """Save a record under a name with date and time, and return its path.

        Raise RecordingFileError if there is not enough disk space or the folder cannot be used. Errors of
        ``save_recording``, such as RecordError, are raised unchanged unless they are OSError.
        """
        path = self._make_path(name_stem, RECORD_SUFFIX)
        self._write_guarded(path, lambda: self.save_recording(record, path))
        return path

    def write_csv(self, record: ScopeRecord) -> Path:
        """Write a record as a CSV table and return its path.

        Raise RecordingFileError on failure.
        """
        path = self._make_path("scope", ".csv")

        def replace_csv_file() -> None:
            with _draft(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
                self.write_csv_table(record, file.write)
            replace_atomically(draft, path)

        self._write_guarded(path, replace_csv_file)
        return path

    def write_picture(self, png: bytes) -> Path:
        """Save a PNG picture of the scope page and return its path.

        Raise RecordingFileError on failure.
        """
        path = self._make_path("scope", ".png")

        def replace_picture_file() -> None:
            with _draft(path) as draft:
                draft.write_bytes(png)
            replace_atomically(draft, path)

        self._write_guarded(path, replace_picture_file)
        return path

    def read_recording(self, path: Path) -> ScopeRecord:
        """Open a stored record.

        Errors of ``open_recording``, such as RecordError for a damaged file, are raised unchanged. Raise
        RecordingFileError instead of an OSError.
        """
        return self._run_reporting(path, lambda: self.open_recording(path))

    def delete_recording(self, path: Path) -> None:
        """Delete a record file.

        Raise RecordingFileError on failure.
        """
        self._run_reporting(path, path.unlink)

    def _make_path(self, stem: str, extension: str) -> Path:
        """Return a path that contains the date and time, and at which no file exists."""
        named = f"{stem} {time.strftime('%Y-%m-%d %H-%M-%S', time.localtime(self.read_time_s()))}"
        names = (f"{named}{more}{extension}" for more in ("", *(f" {n}" for n in range(2, 100))))
        return next(self.folder / name for name in names if not (self.folder / name).exists())

    def _write_guarded(self, path: Path, write: Callable[[], None]) -> None:
        """Check that there is enough disk space, then write a file."""

        def write_with_space_check() -> None:
            self.folder.mkdir(parents=True, exist_ok=True)
            if shutil.disk_usage(self.folder).free < _RESERVED_BYTES:
                raise RecordingFileError(
                    Message("{path} NOT SAVED: DISK FULL. DELETE RECORDS OR PROGRAMS", path=path.name),
                    "disk-full",
                )
            write()

        self._run_reporting(path, write_with_space_check)

    def _run_reporting(self, path: Path, work: Callable[[], T]) -> T:
        """Run a file operation, and convert an OSError into a RecordingFileError with the file name."""
        try:
            return work()
        except RecordingFileError:
            raise
        except OSError as error:
            raise RecordingFileError(
                Message("{path}: {cause}", path=path.name, cause=error.strerror or error), "unusable"
            ) from error


def _draft(path: Path) -> _DraftFile:
    return _DraftFile(path.with_name(path.name + ".part"))


class _DraftFile:
    """Temporary file in the folder of the target file. It is deleted if writing fails."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __enter__(self) -> Path:
        return self._path

    def __exit__(self, kind: object, *_rest: object) -> None:
        if kind is not None:
            with suppress(OSError):
                self._path.unlink()


def find_zero_time(record: ScopeRecord) -> float:
    """Return the zero time of a record (its trigger or alarm), in seconds of the record's clock.

    Without a trigger or alarm, the zero time is the last sample.
    """
    instant_text = record.about.get(ZERO_INSTANT_KEY, "")
    if not len(record.times_s):
        return 0.0
    try:
        if not instant_text and ALARM_TIME_KEY in record.about:
            return float(record.about[ALARM_TIME_KEY])
        return float(record.times_s[0]) + float(instant_text)
    except ValueError:
        return float(record.times_s[-1])
