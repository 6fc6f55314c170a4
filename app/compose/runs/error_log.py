"""The log of TurnDesk's own failures: a file in the product's folder, written by a queue."""

from __future__ import annotations

import contextlib
import io
import logging
import logging.handlers
import queue
import sys
import time
from pathlib import Path

from app.desk.data_folder import data_folder
from core.file_placing import NEW_FILE
from core.message import Message

_SIZE = 1_000_000  # bytes, three files of it
_AGAIN = 2.0  # s between two tries to write again
_MISSING = {
    "levelno": logging.WARNING,
    "levelname": "WARNING",
    "name": __name__,
    "msg": "the log could not be written for a while; lines before this one are missing",
}
_FORM = "%(asctime)s %(levelname)s %(threadName)s %(name)s: %(message)s"


class Log:
    """Every logger writes to this file in the folder ``logs`` until this is closed.

    Nothing is written where no file can be made.

    No thread of the machine may wait for a disk, so records go through a queue. ``trouble`` says why nothing
    is written; empty while all is well.
    """

    def __init__(self, name: str = "turndesk.log") -> None:
        records: queue.SimpleQueue[logging.LogRecord] = queue.SimpleQueue()
        self._unmade, self._next = "", 0.0
        self._file = self._opened(name)
        self._handler = logging.handlers.QueueHandler(records)
        self._listener = logging.handlers.QueueListener(records, *([self._file] if self._file else []))
        logging.getLogger().addHandler(self._handler)
        self._listener.start()

    @property
    def trouble(self) -> str:
        """Why the log is not written. While it is not, a line that says so is tried again and again."""
        found = self._file.trouble if self._file else ""
        if found and time.monotonic() >= self._next:
            self._next = time.monotonic() + _AGAIN
            self._handler.handle(logging.makeLogRecord(_MISSING))
        return self._unmade or found

    def close(self) -> None:
        """Write what is queued."""
        logging.getLogger().removeHandler(self._handler)
        self._listener.stop()
        for handler in self._listener.handlers:
            with contextlib.suppress(OSError):  # of a full disk: told already
                handler.close()

    def _opened(self, name: str) -> _File | None:
        folder = data_folder() / "logs"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            file = _File(folder / name, maxBytes=_SIZE, backupCount=2, encoding="utf-8")
        except OSError as error:
            self._unmade = Message(
                "the log cannot be written to {file}: {what}",
                file=folder,
                what=error.strerror or error,
            )
            return None
        file.setFormatter(logging.Formatter(_FORM))
        return file


class _File(logging.handlers.RotatingFileHandler):
    """A file whose disk may fail: that is told, and no traceback goes to the console."""

    trouble = ""

    def _open(self) -> io.TextIOWrapper:
        Path(self.baseFilename).touch(NEW_FILE)
        return super()._open()

    def emit(self, record: logging.LogRecord) -> None:
        """Write it; one that can be written again ends the trouble."""
        self.failed = False
        super().emit(record)
        if not self.failed:
            self.trouble = ""

    def handleError(self, _record: logging.LogRecord) -> None:  # noqa: N802  logging's own name
        """Keep why."""
        error = sys.exc_info()[1]
        what = error.strerror if isinstance(error, OSError) else error
        self.failed, self.trouble = (
            True,
            Message(
                "the log cannot be written to {file}: {what}",
                file=self.baseFilename,
                what=what,
            ),
        )

    failed = False
