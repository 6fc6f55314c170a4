"""The thread that writes the store, so that callers need not wait for the disk."""

from __future__ import annotations

import queue
import sqlite3
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, TypeVar

from core.message import Message
from core.store import event_log, program_records
from core.store.production import job_queue
from core.store.store_access import EntryWriter, Operation, PendingEntries
from core.store.store_errors import StoreError, StoreErrorCause, find_store_error_cause, why
from core.store.store_rows import EventRow, get_utc_now_text

# --- Entries to be written: events, part counts, runs and settings, buffered until the disk accepts them.


# more than a week of events; beyond this number the oldest are dropped and their number is reported
MAX_PENDING_EVENTS = 20_000


class _PendingParts(NamedTuple):
    """A pending change of a program's part count: an optional reset, followed by the parts to add."""

    resets_count: bool = False
    added_part_count: int = 0
    last_part_time: str = ""


class _PendingCycles(NamedTuple):
    """The complete cycles of a program that are not written to disk yet, with their times in seconds."""

    cycle_count: int
    best_time_s: float
    latest_time_s: float


class UnwrittenEntries:
    """Entries that have not been written to disk yet; only the writer's thread uses them.

    All entries are written in one transaction. Part counts are added up and only the last value of a
    setting is stored, so the memory use does not grow with time.
    """

    def __init__(self) -> None:
        self._events: deque[EventRow] = deque()
        self._dropped = 0
        self._parts: dict[str, _PendingParts] = {}
        self._cycles: dict[str, _PendingCycles] = {}
        self._latest: dict[tuple[str, str], Operation[object]] = {}

    def __bool__(self) -> bool:
        return bool(self._events or self._parts or self._cycles or self._latest or self._dropped)

    def add_event(self, row: EventRow) -> None:
        """Add an event, and drop the oldest event if there are too many."""
        if len(self._events) >= MAX_PENDING_EVENTS:
            self._events.popleft()
            self._dropped += 1
        self._events.append(row)

    def add_parts(self, program: str, count: int) -> None:
        """Add parts to a part count, or subtract them if ``count`` is negative."""
        before = self._parts.get(program, _PendingParts())
        self._parts[program] = before._replace(
            added_part_count=before.added_part_count + count, last_part_time=get_utc_now_text()
        )

    def reset_parts(self, program: str) -> None:
        """Set a part count to zero."""
        self._parts[program] = _PendingParts(resets_count=True, last_part_time=get_utc_now_text())

    def add_cycle(self, program: str, seconds: float) -> None:
        """Add a complete cycle and its time in seconds."""
        before = self._cycles.get(program, _PendingCycles(0, seconds, seconds))
        self._cycles[program] = _PendingCycles(
            before.cycle_count + 1, min(before.best_time_s, seconds), seconds
        )

    def replace_operation(self, name: tuple[str, str], operation: Operation[object]) -> None:
        """Add an operation, replacing a pending operation with the same name."""
        self._latest.pop(name, None)  # moves the operation to the end, so that it is written last
        self._latest[name] = operation

    def count_entries(self, reason: str) -> PendingEntries:
        """Return the numbers of the pending entries, with the reason ``reason`` for the delay."""
        parts = sum(abs(each.added_part_count) for each in self._parts.values())
        others = (
            len(self._latest) + len(self._cycles) + sum(each.resets_count for each in self._parts.values())
        )
        counts = {
            program: (each.resets_count, each.added_part_count) for program, each in self._parts.items()
        }
        return PendingEntries(reason, len(self._events), parts, others, self._dropped, counts)

    def write_all(self, connection: sqlite3.Connection) -> None:
        """Write all entries inside the caller's transaction.

        Entries that the store rejects are recorded in the event log.
        """
        refused = [why for why in (_done(each, connection) for each in self._operations()) if why]
        if self._dropped:
            refused.append(
                Message(
                    "{dropped} events were lost because memory was full while no data could be saved",
                    dropped=self._dropped,
                )
            )
        now = get_utc_now_text()
        event_log.add_events(connection, (*self._events, *(EventRow(now, "warning", why) for why in refused)))

    def clear_entries(self) -> None:
        """Remove all entries after they have been written to disk."""
        self._events.clear()
        self._dropped = 0
        self._parts.clear()
        self._cycles.clear()
        self._latest.clear()

    def _operations(self) -> list[Operation[object]]:
        return [
            *(_writing_parts(program, each) for program, each in self._parts.items()),
            *(_writing_cycles(program, each) for program, each in self._cycles.items()),
            *self._latest.values(),
        ]


def _done(operation: Operation[object], connection: sqlite3.Connection) -> str:
    """Run an operation; return why the store rejects it permanently, or an empty string.

    Only StoreError and a violated constraint are permanent. Any other SQLite error, such as that of a full
    disk, is raised, so that all entries are tried again later.
    """
    try:
        operation(connection)
    except (StoreError, sqlite3.IntegrityError) as error:
        return Message("not saved: {error}", error=error)
    return ""


def _writing_parts(program: str, parts: _PendingParts) -> Operation[object]:
    def write_parts(connection: sqlite3.Connection) -> None:
        if parts.resets_count:
            job_queue.save_count_before_reset(connection, program)
            program_records.reset_parts(connection, program)
        if parts.added_part_count:
            program_records.add_parts(connection, program, parts.added_part_count, parts.last_part_time)

    return write_parts


def _writing_cycles(program: str, cycles: _PendingCycles) -> Operation[object]:
    return lambda connection: program_records.record_complete_cycles(
        connection, program, cycles.latest_time_s, cycles.cycle_count, cycles.best_time_s
    )


T = TypeVar("T")
_Task = Callable[[UnwrittenEntries], None]
SLOW_WRITE_S = 2.0  # s, a change that waits longer is reported
CLOSE_TIMEOUT_S = 10.0  # s that ``close`` waits for the disk
RETRY_INTERVAL_S = 2.0  # s until a failed write is tried again


class StoreWriter:
    """Thread that runs store operations one after the other, each in its own transaction.

    The future of ``queue_operation`` is done when its transaction is on disk. The future raises StoreError
    if the operation fails; the store is then unchanged. If an entry of ``queue_entry`` cannot be written,
    it remains in memory and is written later. A disk that hangs reports no error, so the age of the oldest
    unfinished change is checked. ``clock`` returns a time in seconds.
    """

    def __init__(
        self, connection: sqlite3.Connection, path: Path, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._trouble = ""
        self._backlog: PendingEntries | None = None
        self._clock = clock
        self._posted: deque[float] = deque()  # times at which the queued and current tasks were submitted
        self._connection, self._path = connection, path
        self._unwritten = UnwrittenEntries()
        self._waiting: list[Future[None]] = []  # futures of entries that are not on the disk yet
        self._queue: queue.SimpleQueue[_Task | None] = queue.SimpleQueue()
        self._closing = threading.Lock()
        self._closed = False
        self._thread = threading.Thread(target=self._work, name="store-writer", daemon=True)
        self._thread.start()

    @property
    def last_error(self) -> str:
        """Return the reason why changes are not stored, or an empty string if all changes are stored."""
        return self._trouble or self._hanging

    @property
    def pending_entries(self) -> PendingEntries | None:
        """Return the entries that have not been written to disk yet, or None if all entries are on disk."""
        why, waiting = self._hanging, len(self._posted)
        if self._backlog is None:
            return PendingEntries(why, other_count=waiting) if why else None
        return (
            replace(self._backlog, other_count=self._backlog.other_count + waiting) if why else self._backlog
        )

    @property
    def _hanging(self) -> str:
        """Return the error text if the disk does not respond, or an empty string otherwise.

        The disk is assumed to respond while the oldest change is younger than ``SLOW_WRITE_S``.
        """
        try:
            waited = self._clock() - self._posted[0]
        except IndexError:
            return ""
        return str(StoreErrorCause.NOT_RESPONDING.make_error(self._path, "")) if waited > SLOW_WRITE_S else ""

    def queue_operation(self, operation: Operation[T]) -> Future[T]:
        """Queue ``operation`` to run in its own transaction.

        Raises StoreError if the store is closed.
        """
        future: Future[T] = Future()
        self._put(lambda _unwritten: self._answer(operation, future))
        return future

    def queue_entry(self, add_entry: EntryWriter) -> Future[None]:
        """Queue an entry that must not be lost.

        The future is done when the entry is on disk. The future raises StoreError if the entry cannot be
        written immediately. This method raises StoreError if the store is closed.
        """
        future: Future[None] = Future()

        def add_entry_and_future(unwritten: UnwrittenEntries) -> None:
            add_entry(unwritten)
            self._waiting.append(future)
            if self._queue.empty():
                self._write_waiting()

        self._put(add_entry_and_future)
        return future

    def _put(self, task: _Task) -> None:
        with self._closing:
            if self._closed:
                raise StoreError("the data store is closed; nothing more can be written", "closed")
            self._posted.append(self._clock())
            self._queue.put(task)

    def close(self, timeout_s: float = CLOSE_TIMEOUT_S) -> bool:
        """Write the queued changes, end the thread, and return whether the thread has ended.

        The result is False if the disk takes longer than ``timeout_s`` seconds; the thread then still uses
        the connection. ``pending_entries`` contains the entries that could not be written.
        """
        with self._closing:
            if not self._closed:
                self._closed = True
                self._queue.put(None)
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def _work(self) -> None:
        while True:
            try:
                task = self._queue.get(timeout=RETRY_INTERVAL_S if self._unwritten else None)
            except queue.Empty:
                self._write_waiting()
                continue
            if task is None:
                break
            task(self._unwritten)
            self._posted.popleft()
        self._write_waiting()

    def _write_waiting(self) -> None:
        """Write all pending entries in one transaction, and retain them if the write fails."""
        if not self._unwritten:
            return
        try:
            self._in_transaction(self._unwritten.write_all)
        except Exception as error:  # noqa: BLE001 - any error becomes the result; the thread continues
            failure = self._failed(error)
            self._backlog = self._unwritten.count_entries(self._trouble or str(failure))
            self._tell(lambda future: future.set_exception(failure))
            return
        self._unwritten.clear_entries()
        self._trouble, self._backlog = "", None
        self._tell(lambda future: future.set_result(None))

    def _in_transaction(self, operation: Operation[T]) -> T:
        self._connection.execute("BEGIN IMMEDIATE")
        answer = operation(self._connection)
        self._connection.execute("COMMIT")
        return answer

    def _tell(self, answer: Callable[[Future[None]], None]) -> None:
        waiting, self._waiting = self._waiting, []
        for future in waiting:
            if future.set_running_or_notify_cancel():
                answer(future)

    def _answer(self, operation: Operation[T], future: Future[T]) -> None:
        self._write_waiting()  # earlier entries must be written first
        if not future.set_running_or_notify_cancel():
            return
        try:
            answer = self._in_transaction(operation)
        except Exception as error:  # noqa: BLE001 - any error becomes the result; the thread continues
            future.set_exception(self._failed(error))
            return
        self._trouble = self._trouble if self._unwritten else ""
        future.set_result(answer)

    def _failed(self, error: Exception) -> Exception:
        """Roll back the transaction and return the error.

        An SQLite error is converted to StoreError.
        """
        with suppress(sqlite3.Error):
            self._connection.rollback()
        if not isinstance(error, sqlite3.Error):
            return error
        if isinstance(error, sqlite3.IntegrityError):
            return StoreError(
                Message("nothing was stored ({error})", error=error), "constraint"
            )  # the disk has no fault
        self._trouble = str(why(self._path, error))
        cause = find_store_error_cause(self._path, error)
        failure = StoreError(
            Message("nothing was stored: {problem}. Then make the entry again", problem=self._trouble),
            cause.error_code,
        )
        return StoreError(self._trouble, cause.error_code) if cause is StoreErrorCause.DAMAGED else failure
