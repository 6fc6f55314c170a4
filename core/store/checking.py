"""Is everything in a store as it was stored?"""

from __future__ import annotations

import sqlite3
from pathlib import Path

from core.store import database, programs


def problems(path: Path) -> tuple[str, ...]:
    """What is wrong inside ``path``, which is not written to: pages, references, program texts.

    Raises StoreError when it is no store of ours or of a newer version.
    """
    database.check_file(path, thorough=False)
    connection = database.connect(path, read_only=True)
    try:
        return _found(connection)
    except sqlite3.Error as error:
        return (f"the file is damaged: {error}",)
    finally:
        connection.close()


def _found(connection: sqlite3.Connection) -> tuple[str, ...]:
    pages = [str(row[0]) for row in connection.execute("PRAGMA integrity_check")]
    found = [f"the file is damaged: {text}" for text in pages if text != "ok"]
    found += [
        f"a row of {table} points to a row of {parent} that is not there"
        for table, _, parent, _ in connection.execute("PRAGMA foreign_key_check")
    ]
    found += [f"{which} is not what was saved" for which in programs.spoilt(connection)]
    return tuple(found)
