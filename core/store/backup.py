"""Backup and restore. A backup is one file; neither ever leaves half a file under its name."""

from __future__ import annotations

import os
import shutil
import sqlite3
import tempfile
from contextlib import closing, suppress
from datetime import UTC, datetime
from pathlib import Path

from core.file_placing import put_in_place
from core.store import damaged_rows, database, program_records
from core.store.database import WriterLock, make_folder
from core.store.store_errors import Cause, StoreError, cause_of, why
from core.store.store_file import FILE_NAME


def problems(path: Path) -> tuple[str, ...]:
    """What is wrong inside ``path``, which is not written to: pages, references, program texts.

    Raises StoreError when it is no store of ours or of a newer version.
    """
    database.check_file(path, thorough=False)
    try:
        with closing(database.connect(path, read_only=True)) as connection:
            return _found(connection)
    except sqlite3.Error as error:
        return (f"the file is damaged: {error}",)


def _found(connection: sqlite3.Connection) -> tuple[str, ...]:
    pages = [str(row[0]) for row in connection.execute("PRAGMA integrity_check")]
    found = [f"the file is damaged: {text}" for text in pages if text != "ok"]
    found += [
        f"a row of {table} points to a row of {parent} that is not there"
        for table, _, parent, _ in connection.execute("PRAGMA foreign_key_check")
    ]
    found += [f"{which} is not what was saved" for which in program_records.spoilt(connection)]
    if database.version_of(connection) == len(database.migrations()):  # an older one has no sums
        found += damaged_rows.damaged(connection)
    return tuple(found)


def backup(folder: Path, target: Path) -> None:
    """Copies the store of ``folder`` as it is at this moment, also while it is being written.

    Raises StoreError when there is no good store, or ``target`` is a file that is no backup of ours.
    """
    path = folder / FILE_NAME
    if not path.exists():
        raise StoreError(f"there is no store in {folder} yet, so there is nothing to back up")
    if target.exists():
        if target.samefile(path):
            raise StoreError(f"{target} is the store itself; name another file for the backup")
        database.check_header(target)
    found = problems(path)
    if found:
        raise StoreError(f"{path}: {found[0]}; a backup of it would be no use. Restore an older backup")
    _copy(path, target)


def restore(folder: Path, source: Path) -> Path | None:
    """Puts a backup in the store's place; answers where the replaced store is kept, None: there was none.

    The backup is checked through first. Raises StoreError when it is no good or the store is in use.
    """
    found = problems(source)
    if found:
        raise StoreError(f"{source} cannot be restored: {found[0]}; nothing was changed. Take another backup")
    make_folder(folder)
    path = folder / FILE_NAME
    with closing(WriterLock(folder)):
        if path.exists() and path.samefile(source):
            raise StoreError(f"{source} is the store itself; name a backup")
        kept = _keep(path) if path.exists() else None
        for leftover in database.companions(path):
            leftover.unlink(missing_ok=True)
        _copy(source, path)
        return kept


def _keep(path: Path) -> Path:
    """A copy of the store that is about to be replaced, good or damaged, with its log when it has one."""
    _empty_log(path)
    stamp = datetime.now(UTC).strftime("%Y%m%dT%H%M%S%fZ")
    kept = path.with_name(f"{path.stem}-replaced-{stamp}.db")
    log, _ = database.companions(path)
    unfinished = kept.with_name(kept.name + ".new")
    try:
        if log.exists() and log.stat().st_size:
            shutil.copy2(log, database.companions(kept)[0])
        shutil.copy2(path, unfinished)
        put_in_place(unfinished, kept)
    except OSError as error:
        raise _unwritable(kept, error) from error
    return kept


def _empty_log(path: Path) -> None:
    """Pours the log into the store. A damaged store keeps its log; a busy one raises StoreError."""
    busy = 0
    with suppress(sqlite3.Error, StoreError), closing(database.connect(path, read_only=False)) as connection:
        busy = connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0]
    if busy:
        raise StoreError(f"{path} is being read by another program; close that one, then restore again")


def _copy(source: Path, target: Path) -> None:
    """A whole copy by SQLite's own means; ``target`` is the old file or the new one, never a mixture."""
    try:
        handle, name = tempfile.mkstemp(prefix=f".{target.name}.", dir=target.parent)
    except OSError as error:
        raise _unwritable(target, error) from error
    os.close(handle)
    unfinished = Path(name)
    try:
        with (
            closing(database.connect(source, read_only=True)) as reading,
            closing(sqlite3.connect(unfinished)) as writing,
        ):
            reading.backup(writing)
            writing.execute("PRAGMA journal_mode = DELETE")
        put_in_place(unfinished, target)
    except (OSError, sqlite3.Error) as error:
        raise _unwritable(target, error) from error
    finally:
        unfinished.unlink(missing_ok=True)


def _unwritable(target: Path, error: Exception) -> StoreError:
    if isinstance(error, OSError | sqlite3.Error) and cause_of(target, error) in {Cause.FULL, Cause.LOCKED}:
        return why(target, error)
    return StoreError(f"{target} cannot be written ({error}); check the folder, its space and rights")
