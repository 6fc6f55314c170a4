"""Event log file of one run, and limits for the files in the log folder."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple, TextIO

from app.desk.command_errors import CommandError
from app.desk.data_folder import data_folder
from core.executor.snapshot import Event
from core.file_placing import NEW_FILE
from core.message import Message

MOST = 500  # largest number of run and crash files
MOST_BYTES = 64_000_000  # total bytes of these files
OLDEST = 366 * 86_400.0  # s


class _Kept(NamedTuple):
    """A file in the log folder, with its age in seconds and its size in bytes."""

    path: Path
    age: float
    size: int


class EventLog:
    """Events of one run as JSON objects, one per line. A disk error never stops the machine."""

    def __init__(self, path: Path, file: TextIO) -> None:
        self.path = path
        self.trouble = ""  # reason why the log is incomplete; empty if it is complete
        self._file = file

    @classmethod
    @contextmanager
    def new(cls, program: str) -> Iterator[EventLog]:
        """Yield a log in the data folder, named after the time and the program. Raises CommandError."""
        folder = data_folder() / "logs"
        stamp = datetime.now(UTC).strftime("%Y%m%dT%H%M%S%f")
        path = folder / f"{stamp}-{Path(program).stem}.jsonl"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            path.touch(NEW_FILE, exist_ok=False)
            file = path.open("w", encoding="utf-8")
        except OSError as error:
            raise CommandError(
                Message("{path}: the event log cannot be written: {cause}", path=path, cause=error.strerror),
                "cannot-write",
            ) from error
        forget_oldest(folder, path)
        log = cls(path, file)
        try:
            yield log
        finally:
            log._kept(file.close)

    def add(self, event: Event) -> None:
        """Write an event."""
        line = {"t": round(event.t, 4), "kind": event.kind, "text": event.text, "line": event.line}
        if event.record:
            line["record"] = event.record
        self._kept(lambda: self._file.write(json.dumps(line) + "\n"))

    def _kept(self, write: Callable[[], object]) -> None:
        try:
            write()
        except OSError as error:
            self.trouble = Message(
                "{path}: the event log cannot be written: {cause}", path=self.path, cause=error.strerror
            )


def forget_oldest(folder: Path, newest: Path) -> None:
    """Delete the oldest run and crash files beyond ``MOST``, ``MOST_BYTES`` and ``OLDEST``.

    ``newest`` is being written and remains. Files that cannot be deleted are ignored.
    """
    with suppress(OSError):
        kept = [_kept(path) for what in ("*.jsonl", "crash-*.txt") for path in folder.glob(what)]
        for each in _superfluous([one for one in kept if one.path != newest]):
            with suppress(OSError):
                each.path.unlink()


def _kept(path: Path) -> _Kept:
    found = path.stat()
    return _Kept(path, time.time() - found.st_mtime, found.st_size)


def _superfluous(files: Sequence[_Kept]) -> list[_Kept]:
    """Return the files to delete, from the files other than the one being written."""
    gone, size = [], 0
    for place, each in enumerate(sorted(files, key=lambda one: (one.age, one.path.name)), start=1):
        size += each.size
        if place >= MOST or size > MOST_BYTES or each.age > OLDEST:
            gone.append(each)
    return gone
