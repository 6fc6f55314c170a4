"""The one thread that writes. Whoever wants something stored posts it and need not wait for the disk."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from queue import SimpleQueue
from types import TracebackType
from typing import TypeVar

from core.store.errors import StoreError

T = TypeVar("T")
Operation = Callable[[sqlite3.Connection], T]


class _Answering:
    """Whatever an operation raises becomes its future's answer; the thread itself goes on."""

    def __init__(self, fail: Callable[[Exception], None]) -> None:
        self._fail = fail

    def __enter__(self) -> None:
        return None

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        if not isinstance(error, Exception):
            return False
        self._fail(error)
        return True


class StoreWriter:
    """Runs operations one after the other, each in a transaction of its own.

    A future is answered only when its transaction is on the disk. It answers with StoreError when it is not;
    the store is then as before. ``trouble`` keeps the last such sentence for those who ask no future.
    """

    def __init__(self, connection: sqlite3.Connection) -> None:
        self.trouble = ""
        self._connection = connection
        self._queue: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._closing = threading.Lock()
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="store-writer", daemon=True)
        self._thread.start()

    def post(self, operation: Operation[T]) -> Future[T]:
        """Queue ``operation``; it gets the connection inside a transaction. Raises StoreError once closed."""
        future: Future[T] = Future()
        with self._closing:
            if self._closed:
                raise StoreError("the store is closed; nothing can be written any more")
            self._queue.put(lambda: self._answer(operation, future))
        return future

    def close(self) -> None:
        """Writes what is queued, then ends the thread."""
        with self._closing:
            if not self._closed:
                self._closed = True
                self._queue.put(None)
        self._thread.join()

    def _work(self) -> None:
        while (task := self._queue.get()) is not None:
            task()

    def _answer(self, operation: Operation[T], future: Future[T]) -> None:
        if not future.set_running_or_notify_cancel():
            return

        def fail(error: Exception) -> None:
            with suppress(sqlite3.Error):
                self._connection.rollback()
            if isinstance(error, sqlite3.Error):
                self.trouble = str(_told(error))
            future.set_exception(_told(error))

        with _Answering(fail):
            self._connection.execute("BEGIN IMMEDIATE")
            answer = operation(self._connection)
            self._connection.execute("COMMIT")
            future.set_result(answer)


def _told(error: Exception) -> Exception:
    if isinstance(error, sqlite3.Error):
        return StoreError(
            f"nothing was stored ({error}); check the disk's space and rights, then enter it again"
        )
    return error
