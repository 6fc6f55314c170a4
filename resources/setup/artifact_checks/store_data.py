"""Comparison of the data of TurnDesk before and after an upgrade."""

from __future__ import annotations

import hashlib
import re
import shutil
import sqlite3
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import NamedTuple

from core.store.store_file import STORE_FILE_NAME
from resources.setup.bundle import BundleError

_OWN_STATE = re.compile(rf"(?:logs/.*|records/.*|{re.escape(STORE_FILE_NAME)}.*|.*\.(?:lock|sock))")
"""Files of the data folder that every start of TurnDesk may change. The rows of the store are compared."""
Row = Mapping[str, object]


class StoredData(NamedTuple):
    """Rows of each table of the store, and the SHA-256 of each other file of the data folder."""

    tables: Mapping[str, Sequence[Row]]
    files: Mapping[str, str]


def read_stored_data(folder: Path) -> StoredData:
    """Return all data in a data folder. Raises BundleError if the folder has no store."""
    if not (folder / STORE_FILE_NAME).is_file():
        raise BundleError(f"{folder} contains no store")
    with tempfile.TemporaryDirectory() as work:
        for path in folder.glob(f"{STORE_FILE_NAME}*"):  # with the write-ahead log
            shutil.copy(path, work)
        with closing(sqlite3.connect(Path(work) / STORE_FILE_NAME)) as connection:
            tables = dict(_read_tables(connection))
    files = {
        name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in folder.rglob("*")
        if path.is_file() and not _OWN_STATE.fullmatch(name := path.relative_to(folder).as_posix())
    }
    return StoredData(tables, files)


def _read_tables(connection: sqlite3.Connection) -> Iterator[tuple[str, list[Row]]]:
    connection.row_factory = sqlite3.Row
    query = "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%'"
    for name in [str(row["name"]) for row in connection.execute(query)]:
        yield name, [dict(row) for row in connection.execute(f'SELECT * FROM "{name}"')]


def list_losses(before: StoredData, after: StoredData) -> list[str]:
    """Return a line for each table, column, row or file that an upgrade has lost or changed.

    New tables, columns, rows and files are not losses.
    """
    losses = [f"file {name}" for name, digest in before.files.items() if after.files.get(name) != digest]
    for table, rows in before.tables.items():
        if table not in after.tables:
            losses += [f"table {table}"] if rows else []
            continue
        columns = sorted({column for row in rows for column in row})
        remaining = after.tables[table]
        if remaining and (gone := [each for each in columns if each not in remaining[0]]):
            losses += [f"table {table}, column {each}" for each in gone]
            continue
        lost = Counter(_key(row, columns) for row in rows) - Counter(_key(row, columns) for row in remaining)
        losses += [f"table {table}, row {dict(zip(columns, row, strict=True))}" for row in lost.elements()]
    return losses


def count_rows(data: StoredData) -> int:
    """Return the number of rows in all tables of the store."""
    return sum(len(rows) for rows in data.tables.values())


def _key(row: Row, columns: Sequence[str]) -> tuple[object, ...]:
    return tuple(row[column] for column in columns)
