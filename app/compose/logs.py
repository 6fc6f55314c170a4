"""The log of TurnDesk's own failures: a file in the product's folder, written by a queue."""

from __future__ import annotations

import logging
import logging.handlers
import queue

from app.desk.home import home

_SIZE = 1_000_000  # bytes, three files of it


class Log:
    """Every logger writes to ``logs/turndesk.log`` until this is closed; nowhere, where no file can be made.

    No thread of the machine may wait for a disk, so records go through a queue.
    """

    def __init__(self) -> None:
        records: queue.SimpleQueue[logging.LogRecord] = queue.SimpleQueue()
        self._handler = logging.handlers.QueueHandler(records)
        self._listener = logging.handlers.QueueListener(records, *_file())
        logging.getLogger().addHandler(self._handler)
        self._listener.start()

    def close(self) -> None:
        """Write what is queued."""
        logging.getLogger().removeHandler(self._handler)
        self._listener.stop()
        for handler in self._listener.handlers:
            handler.close()


def _file() -> list[logging.Handler]:
    folder = home() / "logs"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = logging.handlers.RotatingFileHandler(
            folder / "turndesk.log", maxBytes=_SIZE, backupCount=2, encoding="utf-8", delay=True
        )
    except OSError:
        return []
    file.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
    return [file]
