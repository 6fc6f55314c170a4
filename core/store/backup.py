"""Backup, restore and verification of the data store."""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing, suppress
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import NamedTuple

from core.file_lock import create_unfinished_file
from core.file_replacement import replace_atomically
from core.message import Message
from core.store import damaged_rows, database, log_damage, program_records, row_checksums, user_records
from core.store.database import create_store_folder
from core.store.store_connection import WriterLock, connect_store, get_log_and_index_paths, read_store_version
from core.store.store_errors import (
    StoreError,
    StoreErrorCause,
    find_store_error_cause,
    get_system_error_text,
    why,
)
from core.store.store_file import STORE_FILE_NAME, has_store, resolve_link
from core.store.user_records import UserRow

_NAMES = {
    "tool_offsets": "tool offsets",
    "secondary_offsets": "secondary offsets",
    "zero_offsets": "zero offsets",
    "tool_shapes": "tool shapes",
    "mill_tools": "tools",
    "datum_presets": "presets",
    "tool_lives": "tool lives",
    "mill_tool_lives": "tool lives",
    "part_counts": "part counts",
    "settings": "settings",
    "jobs": "jobs",
}
_CHECKSUM_QUERY = "SELECT tbl, key, sha256 FROM row_sums"
_NEWEST_VERSION_QUERY = (
    "SELECT name, sha256 FROM programs JOIN program_versions ON program = programs.id"
    " WHERE number = (SELECT max(number) FROM program_versions WHERE program = programs.id)"
)
Found = dict[tuple[str, object], str]
ReportPages = Callable[[int, int], None]
"""Function that is called with the number of copied pages and the total number of pages."""
ReportChecks = Callable[[int, int], None]
"""Function that is called with the number of finished checks and the total number of checks."""
_PAGES_PER_STEP = 256  # pages of 4 KB that are copied between two progress reports


class _CheckCounter:
    """Counter of the finished checks of a store: pages, references, program texts and each table."""

    def __init__(self, report_checks: ReportChecks | None) -> None:
        self._report_checks = report_checks
        self._total = 3 + len(row_checksums.CHECKSUMMED_TABLES)
        self._finished = 0

    def count_check(self) -> None:
        """Count a finished check and report it."""
        self._finished += 1
        if self._report_checks is not None:
            self._report_checks(self._finished, self._total)


def find_store_problems(path: Path) -> tuple[str, ...]:
    """Return the problems that are found in the store file ``path``, without writing to the file.

    The check includes database pages, references between tables, program texts and row checksums. Raises
    StoreError if the file cannot be opened, is not a TurnDesk store or has a newer version. Also raises
    StoreError if changes in its write-ahead log are lost.
    """
    return _looked_through(path, partial(_found, counter=_CheckCounter(None)))


def find_all_store_problems(path: Path, report_checks: ReportChecks | None = None) -> tuple[str, ...]:
    """Return the problems of a store file, including damaged history entries.

    History entries are checked only if ``find_store_problems`` finds no problem. A backup with damaged
    history entries is still usable.
    """
    counter = _CheckCounter(report_checks)
    return _looked_through(path, partial(_found, counter=counter)) or _looked_through(
        path, partial(_of_histories, counter=counter)
    )


def _looked_through(path: Path, look: Callable[[sqlite3.Connection], tuple[str, ...]]) -> tuple[str, ...]:
    database.check_store_file(path, is_thorough=False)
    try:
        with closing(connect_store(path, is_read_only=True)) as connection:
            log_damage.check_log_is_readable(path, connection)
            return look(connection)
    except sqlite3.Error as error:
        return (Message("the file is damaged: {text}", text=error),)


def _of_histories(connection: sqlite3.Connection, counter: _CheckCounter) -> tuple[str, ...]:
    newest = read_store_version(connection) == len(database.load_migrations())
    return damaged_rows.find_damaged_history(connection, counter.count_check) if newest else ()


def _found(connection: sqlite3.Connection, counter: _CheckCounter) -> tuple[str, ...]:
    pages = [str(row[0]) for row in connection.execute("PRAGMA integrity_check")]
    counter.count_check()
    found: list[str] = [
        Message("the file is damaged: {text}", text=" ".join(text.split())) for text in pages if text != "ok"
    ]
    found += [
        Message(
            "a row in table {table} refers to a missing row in table {parent}", table=table, parent=parent
        )
        for table, _, parent, _ in connection.execute("PRAGMA foreign_key_check")
    ]
    counter.count_check()
    found += [
        Message("{which} does not match its checksum", which=which)
        for which in program_records.find_damaged_versions(connection)
    ]
    counter.count_check()
    tables = row_checksums.list_tables_with_checksums(read_store_version(connection))
    found += damaged_rows.find_damaged_rows(connection, tables, report_table=counter.count_check)
    return tuple(found)


def back_up_store(folder: Path, target: Path, report_pages: ReportPages | None = None) -> None:
    """Copy the store of ``folder`` to ``target`` in its current state.

    This is possible even while the store is being written. The copy contains the names and levels of the
    users, but no PINs, because anyone with the file could try all PINs. Raises StoreError if the folder has
    no intact store, if ``target`` is the store itself, if ``target`` exists and is not a backup of a store,
    or if ``target`` cannot be written.
    """
    path = folder / STORE_FILE_NAME
    if not has_store(folder):
        raise StoreError(
            Message("no data store exists in {folder} yet, so there is nothing to back up", folder=folder),
            "no-store",
        )
    if _is_there(target):
        database.check_is_file(target)
        if _is_same_file(target, path):
            raise StoreError(
                Message(
                    "{target} is the data store itself; specify another file for the backup", target=target
                ),
                "store-itself",
            )
        database.check_store_header(target)
    found = find_store_problems(path)
    if found:
        raise StoreError(
            Message(
                "{path}: {value}; a backup of this file would be useless. Restore an older backup",
                path=path,
                value=found[0],
            ),
            "damaged",
        )
    _copy(path, target, user_records.erase_pins, report_pages)


def restore_store(folder: Path, source: Path, report_pages: ReportPages | None = None) -> Path | None:
    """Replace the store of ``folder`` by a backup, and return the path of the copy of the old store.

    The result is None if the folder had no store. The backup is checked first. The users and PINs of this
    machine remain. A machine without a store gets the users of the backup. If the old store cannot be read,
    the restored store has no users, so the caller must require a service reset first. Raises StoreError if
    the backup is damaged or is the store itself, if the store is in use, or if a file cannot be written.
    """
    found = find_store_problems(source)
    if found:
        raise StoreError(
            Message(
                "{source} cannot be restored: {value}; nothing was changed. Use another backup",
                source=source,
                value=found[0],
            ),
            "damaged-backup",
        )
    create_store_folder(folder)
    path = folder / STORE_FILE_NAME
    with closing(WriterLock(folder)):
        there = has_store(folder)
        if there:
            database.check_is_file(path)
        if there and _is_same_file(path, source):
            raise StoreError(
                Message(
                    "{source} is the data store itself, not a backup; specify a backup file", source=source
                ),
                "store-itself",
            )
        here = _read_users(path) if there else None
        kept = _save_old_store(path) if there else None
        _remove_log(path)
        _copy(source, resolve_link(path), partial(_replace_users, here), report_pages)
        return kept


def _read_users(path: Path) -> tuple[UserRow, ...]:
    """Return the users of the store that is about to be replaced, or () if they cannot be read."""
    try:
        database.check_store_header(path)
        with closing(connect_store(path, is_read_only=True)) as connection:
            return user_records.read_user_list(connection).rows
    except (StoreError, sqlite3.Error):
        return ()


def _replace_users(rows: tuple[UserRow, ...] | None, copy: sqlite3.Connection) -> None:
    """Replace the users in a restored copy of the store by ``rows``, the users of this machine.

    If ``rows`` is None, this machine had no store, so the copy retains the users of the backup.
    """
    if rows or (rows is not None and row_checksums.list_checksummed_columns(copy, "people")):
        database.upgrade_tables(copy, database.load_migrations())
        user_records.replace_all_users(copy, rows)


def _is_same_file(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except OSError as error:  # a disk may have been removed since the check
        raise why(one, error) from error


def _remove_log(path: Path) -> None:
    """Remove the write-ahead log of the old store, so that SQLite does not apply it to the new store."""
    for leftover in get_log_and_index_paths(path):
        try:
            leftover.unlink(missing_ok=True)
        except OSError as error:
            raise _unwritable(leftover, error) from error


def _is_there(target: Path) -> bool:
    try:
        return target.exists() or target.is_symlink()
    except OSError as error:  # the user may not read the folder
        raise _unwritable(target, error) from error


def _save_old_store(path: Path) -> Path:
    """Copy the store that will be replaced, even if it is damaged, and return the path of the copy.

    If the store has a write-ahead log, the log is copied too.
    """
    _empty_log(path)
    stamp = datetime.now(UTC).strftime("%Y%m%dT%H%M%S%fZ")
    kept = path.with_name(f"{path.stem}-replaced-{stamp}.db")
    log, _ = get_log_and_index_paths(path)
    kept_log, _ = get_log_and_index_paths(kept)
    try:
        if log.exists() and log.stat().st_size:
            shutil.copy2(log, kept_log)
        with create_unfinished_file(kept) as unfinished:
            shutil.copy2(path, unfinished)
            replace_atomically(unfinished, kept)
    except OSError as error:
        with suppress(OSError):  # the error above is the cause
            kept_log.unlink(missing_ok=True)
        raise _unwritable(kept, error) from error
    return kept


def _empty_log(path: Path) -> None:
    """Write all changes that are in the write-ahead log to the store file.

    The log of a damaged store is retained. Raises StoreError if another process is reading the store.
    """
    busy = 0
    with (
        suppress(sqlite3.Error, StoreError),
        closing(connect_store(path, is_read_only=False)) as connection,
    ):
        busy = connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0]
    if busy:
        raise StoreError(
            Message(
                "{path} is being read by another program; close that program, then restore again", path=path
            ),
            "in-use",
        )


def _copy(
    source: Path,
    target: Path,
    change: Callable[[sqlite3.Connection], None],
    report_pages: ReportPages | None = None,
) -> None:
    """Copy a store with SQLite's backup function, so that ``target`` is always complete.

    ``change`` modifies the copy before the copy receives its final name. Raises StoreError if the copy
    cannot be written.
    """
    try:
        with create_unfinished_file(target) as unfinished:
            with (
                closing(connect_store(source, is_read_only=True)) as reading,
                closing(sqlite3.connect(unfinished, isolation_level=None)) as writing,
            ):
                if report_pages is None:
                    reading.backup(writing)
                else:
                    _copy_in_steps(reading, writing, report_pages)
                writing.execute("PRAGMA journal_mode = DELETE")
                change(writing)
            replace_atomically(unfinished, target)
    except (OSError, sqlite3.Error) as error:
        raise _unwritable(target, error) from error


def _copy_in_steps(
    reading: sqlite3.Connection, writing: sqlite3.Connection, report_pages: ReportPages
) -> None:
    """Copy a store in steps, and report the progress after each step.

    The open read transaction prevents that a change of the store restarts the copy.
    """
    reading.execute("BEGIN")
    reading.execute("SELECT count(*) FROM sqlite_master").fetchone()
    reading.backup(
        writing,
        pages=_PAGES_PER_STEP,
        progress=lambda _status, remaining, total: report_pages(total - remaining, total),
    )
    reading.rollback()


def _unwritable(target: Path, error: Exception) -> StoreError:
    if isinstance(error, OSError | sqlite3.Error) and find_store_error_cause(target, error) in {
        StoreErrorCause.FULL,
        StoreErrorCause.LOCKED,
    }:
        return why(target, error)
    return StoreError(
        Message(
            "{target} cannot be written ({error}); check the folder, its free space and its permissions",
            target=target,
            error=get_system_error_text(error),
        ),
        "cannot-write",
    )


class BackupCheckResult(NamedTuple):
    """The result of checking a backup: its first problem, and its differences from the store.

    ``first_problem`` is an empty string if the backup is intact. ``difference_counts`` contains the number
    of changed, missing or new items for each table. ``has_older_version`` means that the backup has an older
    store version without comparable checksums, so only its programs are compared.
    """

    first_problem: str = ""
    difference_counts: tuple[tuple[str, int], ...] = ()
    has_older_version: bool = False


def check_backup(connection: sqlite3.Connection, path: Path) -> BackupCheckResult:
    """Check a backup page by page and compare it with the open store.

    Neither the backup nor the store is changed. Reading the whole file may take some time.
    """
    try:
        found = find_store_problems(path)
        if found:
            return BackupCheckResult(found[0])
        with closing(connect_store(path, is_read_only=True)) as then:
            older = read_store_version(then) != read_store_version(connection)
            return BackupCheckResult("", _count_differences(connection, then, has_checksums=not older), older)
    except StoreError as error:
        return BackupCheckResult(str(error))
    except sqlite3.Error as error:
        return BackupCheckResult(str(why(path, error)))


def _count_differences(
    now: sqlite3.Connection, then: sqlite3.Connection, *, has_checksums: bool
) -> tuple[tuple[str, int], ...]:
    """Return, for each table, the number of items that differ between the store and the backup.

    Items are compared by checksum and text, and not by time.
    """
    counts: dict[str, int] = {}
    here, there = _by_row(now, sums=has_checksums), _by_row(then, sums=has_checksums)
    for row in here.keys() | there.keys():
        if here.get(row) != there.get(row):
            counts[row[0]] = counts.get(row[0], 0) + 1
    order = ["programs", *dict.fromkeys(_NAMES.values())]
    return tuple((name, counts[name]) for name in order if name in counts)


def _by_row(connection: sqlite3.Connection, *, sums: bool) -> Found:
    found: Found = {("programs", name): digest for name, digest in connection.execute(_NEWEST_VERSION_QUERY)}
    if sums:
        rows = connection.execute(_CHECKSUM_QUERY).fetchall()
        found |= {(_NAMES[table], (table, key)): digest for table, key, digest in rows if table in _NAMES}
    return found
