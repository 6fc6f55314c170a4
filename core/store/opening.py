"""Opening a store: nothing is written before the file has been found to be a whole one of ours."""

from __future__ import annotations

import sqlite3
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from core.store import database
from core.store.causes import Cause, cause_of, why
from core.store.errors import StoreError
from core.store.lock import WriterLock


@dataclass(frozen=True, slots=True)
class Opened:
    """The connections of an open store; no ``writer``: for reading only."""

    path: Path
    reader: sqlite3.Connection
    writer: sqlite3.Connection | None = None
    lock: WriterLock | None = None

    def close(self) -> None:
        """Ends the connections, then gives the lock back. Calling it again does nothing."""
        self.reader.close()
        if self.writer:
            self.writer.close()
        if self.lock:
            self.lock.close()


def open_to_read(folder: Path) -> Opened:
    """The store as it is; an empty one where there is no file. Raises StoreError for a bad file."""
    path = folder / database.FILE_NAME
    if not path.exists():
        return Opened(path, database.empty())
    version = database.check_file(path, thorough=False)
    if version < len(database.migrations()):
        raise StoreError(f"{path} is from an older TurnDesk; start turndesk once to bring it up to date")
    return Opened(path, database.connect(path, read_only=True))


def open_to_write(folder: Path) -> Opened:
    """The store under our lock, brought up to date; made where there is none. Raises StoreError."""
    path = folder / database.FILE_NAME
    make_folder(folder)
    with ExitStack() as undo:
        lock = WriterLock(folder)
        undo.callback(lock.close)
        if not path.exists():
            _refuse_lost_file(path)
            database.create(path)
        version = database.check_file(path, thorough=True)
        writer = _writing(path, version)
        undo.callback(writer.close)
        reader = database.connect(path, read_only=True)
        undo.pop_all()
        return Opened(path, reader, writer, lock)


def make_folder(folder: Path) -> None:
    """The store's folder. Raises StoreError where it cannot be made."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        if cause_of(folder, error) is Cause.FULL:
            raise why(folder, error) from error
        raise StoreError(
            f"the folder {folder} cannot be made ({error.strerror}); set TURNDESK_HOME to a folder of yours"
        ) from error


def _refuse_lost_file(path: Path) -> None:
    """A log without its database would be poured into the new, empty one."""
    log, _ = database.companions(path)
    if log.exists() and log.stat().st_size:
        raise StoreError(
            f"{path} has gone but its log {log.name} is still there; put the file back, or move the log away"
        )


def _writing(path: Path, version: int) -> sqlite3.Connection:
    connection = database.connect(path, read_only=False)
    try:
        if 0 < version < len(database.migrations()):
            _keep_copy(connection, path.with_name(f"{path.stem}-version-{version}.db"))
        connection.execute("PRAGMA journal_mode = WAL")
        database.migrate(connection, database.migrations())
    except sqlite3.Error as error:
        connection.close()
        raise why(path, error) from error
    except StoreError:
        connection.close()
        raise
    return connection


def _keep_copy(connection: sqlite3.Connection, target: Path) -> None:
    """The store as the older version had it, kept beside the one that is about to change."""
    copy = sqlite3.connect(target)
    try:
        connection.backup(copy)
    finally:
        copy.close()
