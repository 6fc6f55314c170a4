"""The file itself: how it is recognised, connected to and brought up to this version's tables."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Sequence
from contextlib import closing
from importlib.resources import files
from pathlib import Path

from core.store.causes import Cause, why
from core.store.errors import StoreError

FILE_NAME = "turndesk.db"
APPLICATION_ID = 0x5475724E  # "TurN": tells a store of ours from any other SQLite file
_MAGIC = b"SQLite format 3\0"
_BUSY_SECONDS = 5.0


def migrations() -> tuple[str, ...]:
    """The SQL of every version, the first one first."""
    folder = files(__package__).joinpath("migrations")
    scripts = sorted(
        (entry for entry in folder.iterdir() if entry.name.endswith(".sql")), key=lambda e: e.name
    )
    return tuple(script.read_text(encoding="utf-8") for script in scripts)


def check_header(path: Path) -> None:
    """Raises StoreError unless ``path`` begins like a store of ours. Reads 100 bytes, opens no database."""
    try:
        with path.open("rb") as file:
            header = file.read(100)
    except OSError as error:
        raise why(path, error) from error
    if len(header) < 100 or not header.startswith(_MAGIC):
        raise StoreError(
            f"{path} is not a database; it is left as it is. Restore a backup: turndesk store restore FILE"
        )
    if int.from_bytes(header[68:72], "big") != APPLICATION_ID:
        raise StoreError(f"{path} is a database of another program; it is left as it is. Name another file")


def connect(path: Path, *, read_only: bool) -> sqlite3.Connection:
    """A connection with our settings. Transactions are begun by hand. Raises StoreError."""
    mode = "ro" if read_only else "rw"
    try:
        connection = sqlite3.connect(
            f"{path.resolve().as_uri()}?mode={mode}",
            uri=True,
            isolation_level=None,
            check_same_thread=False,
            timeout=_BUSY_SECONDS,
        )
        return configured(connection)
    except sqlite3.Error as error:
        raise why(path, error) from error


def configured(connection: sqlite3.Connection) -> sqlite3.Connection:
    """Every commit reaches the disk; references are kept whole."""
    connection.execute("PRAGMA synchronous = FULL")
    connection.execute("PRAGMA foreign_keys = ON")
    return connection


def version_of(connection: sqlite3.Connection) -> int:
    return int(connection.execute("PRAGMA user_version").fetchone()[0])


def check_file(path: Path, *, thorough: bool) -> int:
    """The version of the store in ``path``, which is not written to.

    Raises StoreError for no database of ours, a newer version, or damage; ``thorough`` looks at every page.
    """
    check_header(path)
    newest = len(migrations())
    connection = connect(path, read_only=True)
    try:
        version = version_of(connection)
        told = connection.execute("PRAGMA quick_check(1)").fetchone()[0] if thorough else "ok"
    except sqlite3.Error as error:
        raise why(path, error) from error
    finally:
        connection.close()
    if version > newest:
        raise StoreError(
            f"{path} was written by a newer TurnDesk (store version {version}, this one knows {newest}); "
            "it is left as it is. Use the newer TurnDesk"
        )
    if told != "ok":
        raise Cause.DAMAGED.told(path, told)
    return version


def migrate(connection: sqlite3.Connection, scripts: Sequence[str]) -> None:
    """Brings the tables up to the newest version; each version is one transaction, done or not done."""
    for number, script in enumerate(scripts, start=1):
        if number <= version_of(connection):
            continue
        try:
            connection.executescript(f"BEGIN IMMEDIATE;\n{script}\nPRAGMA user_version = {number};\nCOMMIT;")
        except sqlite3.Error as error:
            if connection.in_transaction:
                connection.rollback()
            raise StoreError(
                f"the store cannot be brought to version {number}, and stays at the one before: "
                f"{why(_path_of(connection), error)}"
            ) from error


def _path_of(connection: sqlite3.Connection) -> Path:
    """The file that a connection is to."""
    return Path(str(connection.execute("PRAGMA database_list").fetchone()[2]))


def create(path: Path) -> None:
    """A new, empty store; it appears under its name only when it is whole. Raises StoreError."""
    unfinished = path.with_name(path.name + ".new")
    try:
        for leftover in (unfinished, *companions(unfinished)):
            leftover.unlink(missing_ok=True)
        with closing(sqlite3.connect(unfinished, isolation_level=None)) as connection:
            configured(connection)
            connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
            connection.execute("PRAGMA journal_mode = WAL")
            migrate(connection, migrations())
        put_in_place(unfinished, path)
    except (OSError, sqlite3.Error) as error:
        raise why(path, error) from error


def put_in_place(finished: Path, path: Path) -> None:
    """``finished`` gets the name ``path`` in one step that survives a power cut."""
    with finished.open("rb") as file:
        os.fsync(file.fileno())
    finished.replace(path)
    folder = os.open(path.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def empty() -> sqlite3.Connection:
    """A store in memory with nothing in it: what a reader sees before the first entry."""
    connection = configured(sqlite3.connect(":memory:", isolation_level=None, check_same_thread=False))
    migrate(connection, migrations())
    return connection


def companions(path: Path) -> tuple[Path, Path]:
    """SQLite's write-ahead log and its index beside a database."""
    return path.with_name(path.name + "-wal"), path.with_name(path.name + "-shm")
