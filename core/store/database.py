"""The database file of the store: identification, creation, checks and migrations."""

from __future__ import annotations

import re
import sqlite3
import stat
from collections.abc import Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path

from core import file_replacement
from core.file_lock import create_unfinished_file, remove_abandoned_files
from core.file_replacement import PRIVATE_FILE_MODE, replace_atomically, restrict_folder_access
from core.input_file import open_input_file
from core.message import Message
from core.store import row_checksums
from core.store.log_damage import check_log_is_readable, save_damaged_log
from core.store.store_connection import (
    FOLDERS_OPEN_FOR_WRITING,
    WriterLock,
    configure_connection,
    connect_store,
    get_log_and_index_paths,
    has_write_ahead_log,
    read_store_version,
)
from core.store.store_errors import StoreError, StoreErrorCause, find_store_error_cause, why
from core.store.store_file import STORE_FILE_NAME, has_store

APPLICATION_ID = 0x5475724E  # "TurN": identifies a SQLite file as a TurnDesk store
_MIGRATIONS = Path(__file__).with_name("migrations")
_MAGIC = b"SQLite format 3\0"
_PRIVATE = ("logs", "backups")  # subfolders that only the owner of the store may read
INDEX_REBUILT_MESSAGE = (
    "an index of the stored data was damaged; TurnDesk rebuilt the index from its table, and no data was lost"
)
_MAX_MESSAGES = 1000  # SQLite reports damaged pages first
# matches "row 3 missing from index …" and "wrong # of entries in index …"
_INDEX = re.compile(r"\bindex \S+$")
_VALUE = rf"(?:value in|constraint failed in) (?:{'|'.join(row_checksums.KEY_COLUMNS)})\b"
_REPAIRABLE_PATTERN = re.compile(rf"{_INDEX.pattern}|{_VALUE}")
"""Pattern of damage that opening a store repairs.

An index is rebuilt from its table, and a value of the wrong type has no valid checksum.
"""


def load_migrations() -> tuple[str, ...]:
    """Return the SQL script of each store version, starting with the first version."""
    scripts = sorted(_MIGRATIONS.glob("*.sql"))
    numbers = [int(script.name.partition("_")[0]) for script in scripts]
    # a store counts them, so it would skip a script inserted later
    if numbers != list(range(1, len(numbers) + 1)):
        raise RuntimeError(f"migrations are numbered from 1 on, each once and without a gap: {numbers}")
    return tuple(script.read_text(encoding="utf-8") for script in scripts)


def check_store_header(path: Path) -> None:
    """Raise StoreError if the file ``path`` does not start with the header of a TurnDesk store.

    The function reads 100 bytes and does not open the database. It skips a store that this process has open
    for writing: when a process closes any handle of the file, it releases all locks that SQLite holds on
    the file in this process. The next program that reads the store would then remove its log.
    """
    if path.name == STORE_FILE_NAME and path.parent.resolve() in FOLDERS_OPEN_FOR_WRITING:
        return
    check_is_file(path)
    try:
        with open_input_file(path) as file:
            header = file.read(100)
    except OSError as error:
        raise why(path, error) from error
    if len(header) < 100 or not header.startswith(_MAGIC):
        raise StoreError(
            Message(
                "{path} is not a database and was not changed. Restore a backup: turndesk store restore FILE",
                path=path,
            ),
            "not-a-database",
        )
    if int.from_bytes(header[68:72], "big") != APPLICATION_ID:
        raise StoreError(
            Message(
                "{path} is a database of another program and was not changed. Specify another file", path=path
            ),
            "foreign-database",
        )


def check_is_file(path: Path) -> None:
    """Raise StoreError if ``path`` is not a file or a link to a file.

    A pipe is not opened, because opening it could block the process.
    """
    try:
        mode = path.stat().st_mode
    except OSError as error:
        if not (isinstance(error, FileNotFoundError) and path.is_symlink()):
            raise why(path, error) from error
        raise StoreError(
            Message(
                "{path} is a link to {readlink}, which does not exist; mount its disk, then try again",
                path=path,
                readlink=path.readlink(),
            ),
            "link-without-target",
        ) from error
    except ValueError as error:  # the name contains a zero byte
        raise StoreError(
            Message("{path} is not a valid file name; enter another name", path=f"{str(path)!r}"),
            "not-a-file",
        ) from error
    if not stat.S_ISREG(mode):
        raise StoreError(
            Message(
                "{path} is a folder, a pipe or a device, not a file, and was not changed. Move it to "
                "another location",
                path=path,
            ),
            "not-a-file",
        )


def check_store_file(path: Path, *, is_thorough: bool) -> int:
    """Return the version of the store in ``path``, without writing to the file.

    If ``is_thorough`` is True, every page is checked. Raises StoreError if the file cannot be opened, is
    not a TurnDesk store, has a newer version or is damaged. Damage that opening the store repairs is not an
    error.
    """
    return _checked(path, thorough=is_thorough)[0]


def _checked(path: Path, *, thorough: bool) -> tuple[int, list[str]]:
    """Return the store's version, and SQLite's messages about repairable damage.

    Opening the store repairs this damage.
    """
    check_store_header(path)
    newest = len(load_migrations())
    try:
        with closing(connect_store(path, is_read_only=True)) as connection:
            version = read_store_version(connection)
            wrong = _find_damage(connection) if thorough else []
    except sqlite3.Error as error:
        raise why(path, error) from error
    if version > newest:
        raise StoreError(
            Message(
                "{path} was written by a newer TurnDesk (store version {version}, this one supports "
                "{newest}) and was not changed. Use the newer TurnDesk",
                path=path,
                version=version,
                newest=newest,
            ),
            "newer-version",
        )
    damage = [text for text in wrong if not _REPAIRABLE_PATTERN.search(text)]
    if damage:
        raise StoreErrorCause.DAMAGED.make_error(path, damage[0])
    return version, wrong


def _find_damage(connection: sqlite3.Connection) -> list[str]:
    """Return SQLite's messages about damaged pages, inconsistent indexes and values of the wrong type."""
    found = connection.execute(f"PRAGMA integrity_check({_MAX_MESSAGES})")
    return [str(text) for (text,) in found if text != "ok"]


def _rebuild_indexes(
    connection: sqlite3.Connection, path: Path, damage_messages: list[str]
) -> tuple[str, ...]:
    """Rebuild the indexes if one does not match its table, and return a message about the repair.

    Raises StoreError if two rows have the same key, so that the indexes cannot be rebuilt. Raises
    sqlite3.Error for any other failure.
    """
    if not any(_INDEX.search(text) for text in damage_messages):
        return ()
    try:
        connection.execute("REINDEX")
    except sqlite3.IntegrityError as error:  # two rows have the same key, so the correct row is unknown
        raise StoreErrorCause.DAMAGED.make_error(path, error) from error
    return (INDEX_REBUILT_MESSAGE,)


def upgrade_tables(connection: sqlite3.Connection, scripts: Sequence[str]) -> None:
    """Upgrade the tables to the newest version, with one transaction for each version.

    After the upgrade, this connection writes a checksum for every row that it changes. Raises StoreError if
    a migration fails; the store then remains at the previous version.
    """
    for number, script in enumerate(scripts, start=1):
        if number <= read_store_version(connection):
            continue
        try:
            _run_migration(connection, number, script)
        except sqlite3.Error as error:
            if connection.in_transaction:
                connection.rollback()
            raise StoreError(
                Message(
                    "the data store cannot be upgraded to version {number} and stays at the previous "
                    "version: {connection}",
                    number=number,
                    connection=why(_find_database_path(connection), error),
                ),
                "migration-failed",
            ) from error
    if len(scripts) >= row_checksums.FIRST_CHECKSUM_VERSION:
        row_checksums.create_checksum_triggers(connection)


def _run_migration(connection: sqlite3.Connection, number: int, script: str) -> None:
    """Run one migration and recalculate the checksums of all rows that were intact before.

    The checksums depend on the columns, and a migration can change the columns.
    """
    damaged = row_checksums.find_all_broken_rows(
        connection, row_checksums.list_tables_with_checksums(number - 1)
    )
    connection.executescript(f"BEGIN IMMEDIATE;\n{script}\nPRAGMA user_version = {number};")
    if number >= row_checksums.FIRST_CHECKSUM_VERSION:
        row_checksums.write_all_checksums(connection, damaged)
    connection.execute("COMMIT")


def _find_database_path(connection: sqlite3.Connection) -> Path:
    """Return the path of the database file of a connection."""
    return Path(str(connection.execute("PRAGMA database_list").fetchone()[2]))


def create_store_file(path: Path) -> None:
    """Create an empty store, which appears under its name only when it is complete.

    Raises StoreError if the store cannot be created.
    """
    unfinished = path.with_name(path.name + ".new")
    try:
        for leftover in (unfinished, *get_log_and_index_paths(unfinished)):
            leftover.unlink(missing_ok=True)
        unfinished.touch(PRIVATE_FILE_MODE)
        with closing(sqlite3.connect(unfinished, isolation_level=None)) as connection:
            configure_connection(connection)
            # The file gets its final name only when it is complete and on the disk, so the single steps need
            # no syncing.
            connection.execute("PRAGMA synchronous = OFF")
            connection.execute("PRAGMA journal_mode = MEMORY")
            connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
            upgrade_tables(connection, load_migrations())
            connection.execute("PRAGMA journal_mode = WAL")
        replace_atomically(unfinished, path)
    except (OSError, sqlite3.Error) as error:
        raise why(path, error) from error


def create_empty_store() -> sqlite3.Connection:
    """Return an empty store in memory, for reading as long as the store file does not exist."""
    connection = configure_connection(
        sqlite3.connect(":memory:", isolation_level=None, check_same_thread=False)
    )
    upgrade_tables(connection, load_migrations())
    return connection


# --- Opening a store. Nothing is written before the file is known to be an intact TurnDesk store.


@dataclass(frozen=True, slots=True)
class StoreConnections:
    """The connections of an open store.

    ``writer`` is None if the store is open read-only.
    """

    path: Path
    reader: sqlite3.Connection
    writer: sqlite3.Connection | None = None
    writer_lock: WriterLock | None = None
    repair_messages: tuple[str, ...] = ()  # messages about repaired damage of the file itself

    def close(self) -> None:
        """Close the connections, and then release the lock.

        Further calls have no effect.
        """
        self.reader.close()
        if self.writer:
            self.writer.close()
        if self.writer_lock:
            self.writer_lock.close()


def open_store_read_only(folder: Path) -> StoreConnections:
    """Open the store read-only, or an empty store in memory if the file does not exist.

    Raises StoreError if the file is damaged or has another version. Also raises StoreError if changes in
    the write-ahead log are lost, because the store would be read in its state before these changes.
    """
    path = folder / STORE_FILE_NAME
    if not has_store(folder):
        return StoreConnections(path, create_empty_store())
    version = check_store_file(path, is_thorough=False)
    if version < len(load_migrations()):
        raise StoreError(
            Message("{path} is from an older TurnDesk; upgrade it: turndesk store upgrade", path=path),
            "older-version",
        )
    reader = connect_store(path, is_read_only=True)
    try:
        check_log_is_readable(path, reader)
    except StoreError:
        reader.close()
        raise
    return StoreConnections(path, reader)


def open_store_for_writing(folder: Path) -> StoreConnections:
    """Lock the store and open it for writing, and create or upgrade it if necessary.

    Raises StoreError if the store is in use, damaged or of a newer version, if its file is missing but its
    log exists, or if it cannot be created, upgraded or written.
    """
    path = folder / STORE_FILE_NAME
    create_store_folder(folder)
    with ExitStack() as undo:
        lock = WriterLock(folder)
        undo.callback(lock.close)
        remove_abandoned_files(folder)
        if not has_store(folder):
            _refuse_lost_file(path)
            create_store_file(path)
        version, wrong = _checked(path, thorough=True)
        put_aside = save_damaged_log(path)
        lock.mark_file_open()
        writer, mended = _writing(path, version, wrong)
        undo.callback(writer.close)
        reader = connect_store(path, is_read_only=True)
        undo.pop_all()
        return StoreConnections(path, reader, writer, lock, put_aside + mended)


def create_store_folder(folder: Path) -> None:
    """Create the folder of the store, and protect its contents from other users.

    Other users cannot read the folder, its logs and its backups. Raises StoreError if the folder cannot be
    created.
    """
    try:
        file_replacement.create_synced_folder(folder)
    except OSError as error:
        if find_store_error_cause(folder, error) is StoreErrorCause.FULL:
            raise why(folder, error) from error
        raise StoreError(
            Message(
                "the folder {folder} cannot be created ({cause}); set TURNDESK_HOME to a folder that you own",
                folder=folder,
                cause=error.strerror,
            ),
            "cannot-make-folder",
        ) from error
    for each in (folder, *(folder / name for name in _PRIVATE)):
        restrict_folder_access(each)


def _refuse_lost_file(path: Path) -> None:
    """Raise StoreError if the database file is missing although its write-ahead log exists.

    SQLite would otherwise apply the log to the new, empty database.
    """
    if has_write_ahead_log(path):
        log, _ = get_log_and_index_paths(path)
        raise StoreError(
            Message(
                "{path} is missing, but its log {log} still exists; put the file back, or move "
                "the log to another folder",
                path=path,
                log=log.name,
            ),
            "database-gone",
        )


def _writing(path: Path, version: int, wrong: list[str]) -> tuple[sqlite3.Connection, tuple[str, ...]]:
    connection = connect_store(path, is_read_only=False)
    try:
        if 0 < version < len(load_migrations()):
            _save_copy(connection, path.with_name(f"{path.stem}-version-{version}.db"))
        connection.execute("PRAGMA journal_mode = WAL")
        mended = _rebuild_indexes(connection, path, wrong)
        upgrade_tables(connection, load_migrations())
    except (OSError, sqlite3.Error) as error:
        connection.close()
        raise why(path, error) from error
    except StoreError:
        connection.close()
        raise
    return connection, mended


def _save_copy(connection: sqlite3.Connection, target: Path) -> None:
    """Save a copy of the store in its folder before the store is upgraded.

    Raises OSError or sqlite3.Error if the copy cannot be written.
    """
    with create_unfinished_file(target) as unfinished:
        with closing(sqlite3.connect(unfinished)) as copy:
            connection.backup(copy)
            copy.execute("PRAGMA journal_mode = DELETE")
        replace_atomically(unfinished, target)
