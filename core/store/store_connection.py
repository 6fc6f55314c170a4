"""Connections to the store file, and the lock of the only process that may write it."""

from __future__ import annotations

import os
import sqlite3
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from core.file_lock import is_locked, lock_file, mark_locked
from core.file_replacement import PRIVATE_FILE_MODE
from core.message import Message
from core.store.store_errors import StoreError, StoreErrorCause, find_store_error_cause, why
from core.store.store_file import resolve_link

_BUSY_SECONDS = 5.0
_LOCK = "turndesk.lock"
_TRIES, _BETWEEN = 10, 0.01  # attempts to get the writer lock, seconds between two attempts
FOLDERS_OPEN_FOR_WRITING = set[Path]()  # folders whose store this process has open for writing
_UNWRITABLE_CAUSES = frozenset({StoreErrorCause.FULL, StoreErrorCause.FORBIDDEN})


def connect_store(path: Path, *, is_read_only: bool) -> sqlite3.Connection:
    """Open a connection to the store; the caller begins transactions explicitly.

    Reading needs a little disk space in the folder of the file for SQLite's index. If the disk is full or
    the folder is not writable, and the store has no log, a read-only connection opens the file as
    immutable. Raises StoreError if the file cannot be opened.
    """
    try:
        return _connection(path, "mode=ro" if is_read_only else "mode=rw")
    except sqlite3.Error as error:
        if (
            not is_read_only
            or find_store_error_cause(path, error) not in _UNWRITABLE_CAUSES
            or has_write_ahead_log(path)
        ):
            raise why(path, error) from error
    try:
        return _connection(path, "mode=ro&immutable=1")
    except sqlite3.Error as error:
        raise why(path, error) from error


def _connection(path: Path, how: str) -> sqlite3.Connection:
    connection = sqlite3.connect(
        f"{path.resolve().as_uri()}?{how}",
        uri=True,
        isolation_level=None,
        check_same_thread=False,
        timeout=_BUSY_SECONDS,
    )
    try:
        return configure_connection(connection)
    except UnicodeDecodeError as error:  # SQLite's message quotes the damaged text
        connection.close()
        raise _damaged() from error
    except sqlite3.Error:
        connection.close()
        raise


def _damaged() -> sqlite3.DatabaseError:
    """Return the error that SQLite would raise for a store file with an unreadable schema."""
    error = sqlite3.DatabaseError("malformed database schema")
    error.sqlite_errorcode = sqlite3.SQLITE_CORRUPT
    return error


def has_write_ahead_log(path: Path) -> bool:
    """Return whether the write-ahead log of the store exists and is not empty.

    Raises StoreError if the system reports another error than a missing file.
    """
    log, _ = get_log_and_index_paths(path)
    try:
        return log.stat().st_size > 0
    except FileNotFoundError:
        return False
    except OSError as error:
        raise why(log, error) from error


def configure_connection(connection: sqlite3.Connection) -> sqlite3.Connection:
    """Set a connection to sync every commit and to enforce foreign keys, and return the connection."""
    connection.execute("PRAGMA synchronous = FULL")
    connection.execute("PRAGMA foreign_keys = ON")
    return connection


def read_store_version(connection: sqlite3.Connection) -> int:
    """Return the number of the store's last migration, or 0 for an empty database."""
    return int(connection.execute("PRAGMA user_version").fetchone()[0])


def get_log_and_index_paths(path: Path) -> tuple[Path, Path]:
    """Return the paths of SQLite's write-ahead log and of its index, with links resolved."""
    path = resolve_link(path)
    return path.with_name(path.name + "-wal"), path.with_name(path.name + "-shm")


# --- Only one process may write a store. The kernel releases the lock when that process ends for any reason.


class WriterLock:
    """The lock file of the store, locked from construction until ``close``.

    Another process may briefly hold the lock while it checks which process has the store open. Locking is
    therefore retried for 0.1 s. ``pause`` is the function that waits a number of seconds between two
    attempts. Raises StoreError if the store is already locked or the lock file cannot be opened.
    """

    def __init__(self, folder: Path, pause: Callable[[float], object] = time.sleep) -> None:
        self._path = folder / _LOCK
        try:
            self._file = os.open(self._path, os.O_RDWR | os.O_CREAT, PRIVATE_FILE_MODE)
        except OSError as error:
            raise why(self._path, error) from error
        try:
            self._lock_file(pause)
        except OSError as error:
            owner = os.read(self._file, 32).decode("ascii", "replace").strip()
            os.close(self._file)
            who = Message(" (process {owner})", owner=owner) if owner else ""
            raise StoreError(
                Message(
                    "the data store in {folder} is in use by another TurnDesk{who}; close that TurnDesk, "
                    "or make the entry there",
                    folder=folder,
                    who=who,
                ),
                "in-use",
            ) from error
        mark_locked(self._file)
        self._folder = folder.resolve()
        # the process id helps the user to find the owner; a full disk may prevent writing it
        with suppress(OSError):
            os.ftruncate(self._file, 0)
            os.lseek(self._file, 0, os.SEEK_SET)
            os.write(self._file, f"{os.getpid()}\n".encode("ascii"))

    def _lock_file(self, pause: Callable[[float], object]) -> None:
        """Lock the file, with several attempts.

        Raises OSError if the lock remains unavailable.
        """
        for _ in range(_TRIES):
            with suppress(OSError):
                lock_file(self._file)
                return
            pause(_BETWEEN)
        lock_file(self._file)

    def mark_file_open(self) -> None:
        """Record that SQLite now has the store file open for writing in this process."""
        FOLDERS_OPEN_FOR_WRITING.add(self._folder)

    def close(self) -> None:
        """Release the store.

        Further calls have no effect.
        """
        if self._file >= 0:
            FOLDERS_OPEN_FOR_WRITING.discard(self._folder)
            os.close(self._file)
            self._file = -1


def is_open_for_writing(folder: Path) -> bool:
    """Return, without locking, whether a process has the store of this folder open for writing."""
    try:
        file = os.open(folder / _LOCK, os.O_RDONLY)
    except OSError:
        return False
    try:
        return is_locked(file)
    finally:
        os.close(file)
