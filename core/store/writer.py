"""The one thread that writes. Whoever wants something stored posts it and need not wait for the disk."""

from __future__ import annotations

import queue
import sqlite3
import threading
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TypeVar

from core.store.causes import Cause, cause_of, why
from core.store.errors import StoreError
from core.store.unwritten import Held, Unwritten

T = TypeVar("T")
Operation = Callable[[sqlite3.Connection], T]
Keeping = Callable[[Unwritten], None]
AGAIN = 2.0  # s after which what the disk did not take is tried again


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

    The future of ``post`` is answered only when its transaction is on the disk. It answers with StoreError
    when it is not; the store is then as before. What is given to ``keep`` nobody waits for: what the disk
    does not take stays in memory and is written as soon as it does. ``trouble`` is the sentence of the last
    write that failed, until one succeeds; ``held`` what waits, None while nothing has to.
    """

    def __init__(self, connection: sqlite3.Connection, path: Path) -> None:
        self.trouble = ""
        self.held: Held | None = None
        self._connection, self._path = connection, path
        self._unwritten = Unwritten()
        self._waiting: list[Future[None]] = []  # for what is not on the disk yet
        self._queue: queue.SimpleQueue[Keeping | None] = queue.SimpleQueue()
        self._closing = threading.Lock()
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="store-writer", daemon=True)
        self._thread.start()

    def post(self, operation: Operation[T]) -> Future[T]:
        """Queue ``operation``; it gets the connection inside a transaction. Raises StoreError once closed."""
        future: Future[T] = Future()
        self._put(lambda _unwritten: self._answer(operation, future))
        return future

    def keep(self, keeping: Keeping) -> Future[None]:
        """Queue something that must be written, sooner or later. Raises StoreError once closed.

        The future is answered when it is on the disk, and with StoreError when it is held for later.
        """
        future: Future[None] = Future()

        def take(unwritten: Unwritten) -> None:
            keeping(unwritten)
            self._waiting.append(future)
            if self._queue.empty():
                self._write_held()

        self._put(take)
        return future

    def _put(self, task: Keeping) -> None:
        with self._closing:
            if self._closed:
                raise StoreError("the store is closed; nothing can be written any more")
            self._queue.put(task)

    def close(self) -> None:
        """Writes what is queued, then ends the thread; ``held`` tells what could not be written."""
        with self._closing:
            if not self._closed:
                self._closed = True
                self._queue.put(None)
        self._thread.join()

    def _work(self) -> None:
        while True:
            try:
                task = self._queue.get(timeout=AGAIN if self._unwritten else None)
            except queue.Empty:
                self._write_held()
                continue
            if task is None:
                break
            task(self._unwritten)
        self._write_held()

    def _write_held(self) -> None:
        """All that waits, in one transaction: on the disk, or held as before."""
        if not self._unwritten:
            return

        def fail(error: Exception) -> None:
            told = self._failed(error)
            self.held = self._unwritten.held(self.trouble or str(told))
            self._tell(lambda future: future.set_exception(told))

        with _Answering(fail):
            self._connection.execute("BEGIN IMMEDIATE")
            self._unwritten.write(self._connection)
            self._connection.execute("COMMIT")
            self._unwritten.clear()
            self.trouble, self.held = "", None
            self._tell(lambda future: future.set_result(None))

    def _tell(self, answer: Callable[[Future[None]], None]) -> None:
        waiting, self._waiting = self._waiting, []
        for future in waiting:
            if future.set_running_or_notify_cancel():
                answer(future)

    def _answer(self, operation: Operation[T], future: Future[T]) -> None:
        self._write_held()  # what happened before it stands before it
        if not future.set_running_or_notify_cancel():
            return

        def fail(error: Exception) -> None:
            future.set_exception(self._failed(error))

        with _Answering(fail):
            self._connection.execute("BEGIN IMMEDIATE")
            answer = operation(self._connection)
            self._connection.execute("COMMIT")
            self.trouble = self.trouble if self._unwritten else ""
            future.set_result(answer)

    def _failed(self, error: Exception) -> Exception:
        """The transaction is taken back; a failure of the store becomes its sentence."""
        with suppress(sqlite3.Error):
            self._connection.rollback()
        if not isinstance(error, sqlite3.Error):
            return error
        if isinstance(error, sqlite3.IntegrityError):
            return StoreError(f"nothing was stored ({error})")  # nothing is wrong with the disk
        self.trouble = str(why(self._path, error))
        told = StoreError(f"nothing was stored: {self.trouble}, then enter it again")
        return StoreError(self.trouble) if cause_of(self._path, error) is Cause.DAMAGED else told
