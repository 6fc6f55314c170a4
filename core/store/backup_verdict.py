"""What a backup is worth: whether it is whole, and how it differs from what is kept now."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import NamedTuple

from core.store import backup, database
from core.store.store_errors import StoreError, why

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
_SUMS = "SELECT tbl, key, sha256 FROM row_sums"
_NEWEST = (
    "SELECT name, sha256 FROM programs JOIN program_versions ON program = programs.id"
    " WHERE number = (SELECT max(number) FROM program_versions WHERE program = programs.id)"
)
Found = dict[tuple[str, object], str]


class Verdict(NamedTuple):
    """``problem`` is empty where it is whole; ``differs`` counts what is other, missing or new, by its name.

    ``older``: it is of a version that has no sums to compare by, and only programs are.
    """

    problem: str = ""
    differs: tuple[tuple[str, int], ...] = ()
    older: bool = False


def verdict(now: sqlite3.Connection, path: Path) -> Verdict:
    """Look through a backup, page by page, and hold it against the store. Takes its time; writes nothing."""
    try:
        problems = backup.problems(path)
        if problems:
            return Verdict(problems[0])
        with closing(database.connect(path, read_only=True)) as then:
            older = database.version_of(then) != database.version_of(now)
            return Verdict("", _differing(now, then, sums=not older), older)
    except StoreError as error:
        return Verdict(str(error))
    except sqlite3.Error as error:
        return Verdict(str(why(path, error)))


def _differing(
    now: sqlite3.Connection, then: sqlite3.Connection, *, sums: bool
) -> tuple[tuple[str, int], ...]:
    """By sums and texts, never by times: what is the same again is no difference."""
    counts: dict[str, int] = {}
    here, there = _found(now, sums=sums), _found(then, sums=sums)
    for row in here.keys() | there.keys():
        if here.get(row) != there.get(row):
            counts[row[0]] = counts.get(row[0], 0) + 1
    order = ["programs", *dict.fromkeys(_NAMES.values())]
    return tuple((name, counts[name]) for name in order if name in counts)


def _found(connection: sqlite3.Connection, *, sums: bool) -> Found:
    found: Found = {("programs", name): digest for name, digest in connection.execute(_NEWEST)}
    if sums:
        rows = connection.execute(_SUMS).fetchall()
        found |= {(_NAMES[table], (table, key)): digest for table, key, digest in rows if table in _NAMES}
    return found
