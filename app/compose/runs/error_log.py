"""Log of TurnDesk's internal errors, saved through a queue to a file in the data folder."""

from __future__ import annotations

import contextlib
import io
import logging
import logging.handlers
import queue
import sys
import time
from pathlib import Path

from app.desk.data_folder import find_data_folder
from core.file_replacement import PRIVATE_FILE_MODE
from core.message import Message

_MAX_BYTES = 1_000_000  # bytes of each of three files
_RETRY_INTERVAL_S = 2.0  # s between two attempts to write again
_MISSING_RECORD = {
    "levelno": logging.WARNING,
    "levelname": "WARNING",
    "name": __name__,
    "msg": "the log could not be written for a while; lines before this one are missing",
}
_FORMAT = "%(asctime)s %(levelname)s %(threadName)s %(name)s: %(message)s"


class ErrorLog:
    """Log file in the folder ``logs`` to which all loggers write until the log is closed.

    If the file cannot be created, no records are written. Records are queued, because the machine's
    software threads must not wait for the disk.
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
    def error_text(self) -> str:
        """Return the reason why the error log cannot be written, or an empty string if it can be written.

        If the last retry was long enough ago, reading this property also retries the write.
        """
        found = self._file.error_text if self._file else ""
        if found and time.monotonic() >= self._next:
            self._next = time.monotonic() + _RETRY_INTERVAL_S
            self._handler.handle(logging.makeLogRecord(_MISSING_RECORD))
        return self._unmade or found

    def close(self) -> None:
        """Write the queued records and close the file."""
        logging.getLogger().removeHandler(self._handler)
        self._listener.stop()
        for handler in self._listener.handlers:
            with contextlib.suppress(OSError):  # a full disk has already been reported
                handler.close()

    def _opened(self, name: str) -> _ErrorLogFile | None:
        folder = find_data_folder() / "logs"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            file = _ErrorLogFile(folder / name, maxBytes=_MAX_BYTES, backupCount=2, encoding="utf-8")
        except OSError as error:
            self._unmade = Message(
                "the log cannot be written to {file}: {what}",
                file=folder,
                what=error.strerror or error,
            )
            return None
        file.setFormatter(logging.Formatter(_FORMAT))
        return file


class _ErrorLogFile(logging.handlers.RotatingFileHandler):
    """A log file that stores the text of a write error instead of printing a traceback."""

    error_text = ""

    def _open(self) -> io.TextIOWrapper:
        Path(self.baseFilename).touch(PRIVATE_FILE_MODE)
        return super()._open()

    def emit(self, record: logging.LogRecord) -> None:
        """Write a log record, and clear the stored error if the write succeeds."""
        self.has_failed = False
        super().emit(record)
        if not self.has_failed:
            self.error_text = ""

    def handleError(self, _record: logging.LogRecord) -> None:  # noqa: N802  logging's own name
        """Store the reason for a write error."""
        error = sys.exc_info()[1]
        what = error.strerror if isinstance(error, OSError) else error
        self.has_failed, self.error_text = (
            True,
            Message(
                "the log cannot be written to {file}: {what}",
                file=self.baseFilename,
                what=what,
            ),
        )

    has_failed = False
