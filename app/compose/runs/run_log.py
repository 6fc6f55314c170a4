"""Event log file of one program run, and limits on the files in the log folder."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple, TextIO

from app.desk.command_errors import CommandError
from app.desk.data_folder import find_data_folder
from core.executor.snapshot import LogEvent
from core.file_replacement import PRIVATE_FILE_MODE
from core.message import Message

MAX_FILES = 500  # largest number of run and crash files
MAX_TOTAL_BYTES = 64_000_000  # total bytes of these files
MAX_AGE_S = 366 * 86_400.0  # s


class _LogFile(NamedTuple):
    """A file in the log folder with its age in seconds and its size in bytes."""

    path: Path
    age_s: float
    size_bytes: int


class EventLog:
    """Event log of one program run, with one JSON object per line.

    A disk error never stops the machine.
    """

    def __init__(self, path: Path, file: TextIO) -> None:
        self.path = path
        self.error_text = ""  # reason why the log is incomplete; empty if it is complete
        self._file = file

    @classmethod
    @contextmanager
    def create(cls, program: str) -> Iterator[EventLog]:
        """Yield a log in the data folder, whose file is named after the time and the program.

        Raises CommandError if the file cannot be created.
        """
        folder = find_data_folder() / "logs"
        stamp = datetime.now(UTC).strftime("%Y%m%dT%H%M%S%f")
        path = folder / f"{stamp}-{Path(program).stem}.jsonl"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            path.touch(PRIVATE_FILE_MODE, exist_ok=False)
            file = path.open("w", encoding="utf-8")
        except OSError as error:
            raise CommandError(
                Message("{path}: the event log cannot be written: {cause}", path=path, cause=error.strerror),
                "cannot-write",
            ) from error
        delete_old_log_files(folder, path)
        log = cls(path, file)
        try:
            yield log
        finally:
            log._kept(file.close)

    def write_event(self, event: LogEvent) -> None:
        """Write an event as one line of the log."""
        line = {
            "t": round(event.time_s, 4),
            "kind": event.kind,
            "text": event.text,
            "line": event.line_number,
        }
        if event.record_name:
            line["record"] = event.record_name
        self._kept(lambda: self._file.write(json.dumps(line) + "\n"))

    def _kept(self, write: Callable[[], object]) -> None:
        try:
            write()
        except OSError as error:
            self.error_text = Message(
                "{path}: the event log cannot be written: {cause}", path=self.path, cause=error.strerror
            )


def delete_old_log_files(folder: Path, newest_path: Path) -> None:
    """Delete the oldest run and crash files until the log folder is within its limits.

    The limits are ``MAX_FILES``, ``MAX_TOTAL_BYTES`` and ``MAX_AGE_S``. The file ``newest_path``, which is
    being written, is not deleted. Files that cannot be deleted are ignored.
    """
    with suppress(OSError):
        kept = [_kept(path) for what in ("*.jsonl", "crash-*.txt") for path in folder.glob(what)]
        for each in _list_excess([one for one in kept if one.path != newest_path]):
            with suppress(OSError):
                each.path.unlink()


def _kept(path: Path) -> _LogFile:
    found = path.stat()
    return _LogFile(path, time.time() - found.st_mtime, found.st_size)


def _list_excess(files: Sequence[_LogFile]) -> list[_LogFile]:
    """Return the log files to delete so that the rest are within the limits.

    ``files`` excludes the file that is being written.
    """
    gone, size = [], 0
    for place, each in enumerate(sorted(files, key=lambda one: (one.age_s, one.path.name)), start=1):
        size += each.size_bytes
        if place >= MAX_FILES or size > MAX_TOTAL_BYTES or each.age_s > MAX_AGE_S:
            gone.append(each)
    return gone
