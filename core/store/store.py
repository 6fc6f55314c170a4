"""The data store: one SQLite file that any thread can read and a separate thread writes."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Concatenate, ParamSpec, TypeVar

from core.message import Message
from core.store import damaged_rows, event_log
from core.store.database import StoreConnections, open_store_for_writing, open_store_read_only
from core.store.event_log import EventLog
from core.store.offsets.offset_repository import OffsetTables
from core.store.production.job_queue import JobQueue
from core.store.production.part_cycles import CycleRecords
from core.store.production.run_records import LoadedProgramTexts, RunRecords
from core.store.program_archive import ProgramArchive
from core.store.row_checksums import KEY_COLUMNS
from core.store.settings import Settings
from core.store.store_errors import StoreError, StoreErrorCause, why
from core.store.store_rows import EventRow, get_utc_now_text
from core.store.user_records import UserRecords

if TYPE_CHECKING:
    from concurrent.futures import Future

    from core.store.store_access import EntryWriter, Operation, PendingEntries
    from core.store.store_writer import StoreWriter

__all__ = ["Store", "StoreError"]

T = TypeVar("T")
P = ParamSpec("P")


class Store:
    """An open store with its repositories, such as the settings and the event log.

    Use ``open`` to get a store. Methods can be called from any thread. ``repair_messages`` contains a
    message for each damaged row that was restored when the store was opened.
    """

    def __init__(self, opened: StoreConnections) -> None:
        self.path = opened.path
        self._reader = opened.reader
        self._reading = threading.Lock()
        self._opened = opened
        self.repair_messages = _repair_damage(opened.writer, opened.repair_messages) if opened.writer else ()
        self._writer = _writer(opened.writer, opened.path) if opened.writer else None
        loaded = LoadedProgramTexts()
        self.offsets = OffsetTables(self)
        self.programs = ProgramArchive(self, loaded)
        self.runs = RunRecords(self, loaded)
        self.cycles = CycleRecords(self)
        self.jobs = JobQueue(self)
        self.events = EventLog(self)
        self.settings = Settings(self)
        self.people = UserRecords(self)

    @classmethod
    def open(cls, folder: Path, *, read_only: bool = False) -> Store:
        """Open the store in ``folder``, and create it if it does not exist.

        A read-only store can be opened while another process writes to it. It is empty if the file does not
        exist. Raises StoreError in these cases:

        - The file is damaged, from another program or of a newer version. Such a file is not changed.
        - The folder or the file cannot be accessed.
        - For writing: another process has the store open for writing, or the file is missing although its
          write-ahead log exists.
        - For reading only: the file is of an older version, or changes in its write-ahead log are lost.
        """
        return cls(open_store_read_only(folder) if read_only else open_store_for_writing(folder))

    def close(self) -> None:
        """Write all queued changes, and then release the store.

        Further calls have no effect. If the disk does not respond, the store remains open; its lock and
        connections end with the process.
        """
        if self._writer and not self._writer.close():
            return
        with self._reading:
            self._opened.close()

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def write_error(self) -> str:
        """Return the reason why the last write failed, or an empty string if it succeeded."""
        return self._writer.last_error if self._writer else ""

    @property
    def pending_entries(self) -> PendingEntries | None:
        """Return the entries that have not been written to disk yet, or None if all entries are on disk."""
        return self._writer.pending_entries if self._writer else None

    @contextmanager
    def read(self) -> Iterator[sqlite3.Connection]:
        """Open a read transaction for one thread at a time, and yield its connection.

        A single transaction is necessary because a change that is saved between reading a row and reading
        its checksum would make the row appear damaged. Raises StoreError for SQLite errors.
        """
        with self._reading:
            try:
                with _read_transaction(self._reader) as connection:
                    yield connection
            except sqlite3.ProgrammingError as error:
                raise StoreError(
                    Message("{path} is closed; nothing more can be read from it", path=self.path), "closed"
                ) from error
            except sqlite3.Error as error:
                raise why(self.path, error) from error
            except UnicodeDecodeError as error:  # a column name is damaged
                raise StoreErrorCause.DAMAGED.make_error(self.path, error) from error

    def run_query(
        self, function: Callable[Concatenate[sqlite3.Connection, P], T], *args: P.args, **named: P.kwargs
    ) -> T:
        """Call ``function`` with the read connection and the given arguments, and return its result."""
        with self.read() as connection:
            return function(connection, *args, **named)

    def find_damaged_rows(
        self, tables: Collection[str] = KEY_COLUMNS, settings: Collection[str] = ()
    ) -> tuple[str, ...]:
        """Return a message for each row that does not match its checksum.

        ``tables`` are the tables to check. ``settings`` are the setting keys to check if ``tables`` does
        not include the settings table.
        """
        return self.run_query(damaged_rows.find_damaged_rows, tables, settings)

    def write(self, operation: Operation[T]) -> Future[T]:
        """Run ``operation`` in its own transaction on the writer's thread.

        The future returns the result of ``operation`` when the change is on disk. The future raises
        StoreError if the change is rejected or fails; the store is then unchanged. This method raises
        StoreError immediately for a read-only store.
        """
        return self._open_writer().queue_operation(operation)

    def keep(self, add_entry: EntryWriter) -> Future[None]:
        """Store an entry that must not be lost.

        If the disk is full, the entry remains in memory (``pending_entries``) and is written when the disk
        has space. Meanwhile, the future raises StoreError. This method raises StoreError immediately for a
        read-only store.
        """
        return self._open_writer().queue_entry(add_entry)

    def _open_writer(self) -> StoreWriter:
        if self._writer is None:
            raise StoreError(
                Message("{path} is open read-only; nothing can be stored", path=self.path), "read-only"
            )
        return self._writer

    def store_latest_operation(self, key: tuple[str, str], operation: Operation[object]) -> Future[None]:
        """Store an operation as ``keep`` does, replacing a pending operation with the same ``key``."""
        return self.keep(lambda unwritten: unwritten.replace_operation(key, operation))


@contextmanager
def _read_transaction(connection: sqlite3.Connection) -> Iterator[sqlite3.Connection]:
    """Open a read-only transaction that neither waits for a writer nor blocks one."""
    connection.execute("BEGIN")
    try:
        yield connection
    finally:
        if connection.in_transaction:  # SQLite itself ends a transaction that fails because of a damaged file
            connection.execute("ROLLBACK")


def _writer(connection: sqlite3.Connection, path: Path) -> StoreWriter:
    from core.store.store_writer import StoreWriter  # noqa: PLC0415  who only reads needs no thread, no queue

    return StoreWriter(connection, path)


def _repair_damage(connection: sqlite3.Connection, repair_messages: tuple[str, ...]) -> tuple[str, ...]:
    """Repair damaged rows, log the repairs, and return the repair messages.

    If the disk cannot be written, the repair is done at the next start.
    """
    try:
        connection.execute("BEGIN IMMEDIATE")
        messages = (*repair_messages, *damaged_rows.repair_damaged_rows(connection))
        event_log.add_events(connection, (EventRow(get_utc_now_text(), "warning", text) for text in messages))
        connection.execute("COMMIT")
    except sqlite3.Error:
        with suppress(sqlite3.Error):
            connection.rollback()
        return repair_messages
    return messages
