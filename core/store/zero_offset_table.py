"""Settable offsets, G54 to G59: what is valid now, and every change that made it so."""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping
from math import isfinite
from typing import NamedTuple

from core.store.offset_tables import Reason
from core.store.store_errors import StoreError
from core.store.store_rows import utc_now

ZERO_CODES = range(54, 60)
LENGTH_REACH = 5000.0  # mm, more than any such lathe travels
ANGLE_REACH = 360.0  # degrees: further is the same place
ZERO_FIELDS = ("x", "z", "c")


class ZeroRow(NamedTuple):
    """Machine position of the program's zero: mm, X a radius, C in degrees."""

    x: float = 0.0
    z: float = 0.0
    c: float = 0.0


class ZeroChange(NamedTuple):
    """One offset's change: its row before and after, None where it was not set. Ids give the order."""

    id: int
    step: int
    undoes: int | None
    at: str
    code: int
    old: ZeroRow | None
    new: ZeroRow | None
    why: str
    who: str


Changes = Mapping[int, tuple[ZeroRow | None, ZeroRow | None]]


def current(connection: sqlite3.Connection) -> dict[int, ZeroRow]:
    """The settable offsets that have been set, by code."""
    rows = connection.execute("SELECT code, x, z, c FROM zero_offsets ORDER BY code")
    return {code: ZeroRow(*values) for code, *values in rows}


def reach(field: str) -> float:
    """How large a value of this field may be: mm, or degrees for ``c``."""
    return ANGLE_REACH if field == "c" else LENGTH_REACH


def change(connection: sqlite3.Connection, code: int, reason: Reason, wanted: Mapping[str, float]) -> ZeroRow:
    """Sets what ``wanted`` names of x, z and c and keeps the rest; answers the new offset.

    Raises StoreError for a code or a value that is not kept.
    """
    if code not in ZERO_CODES:
        raise StoreError(f"G{code} does not exist; settable offsets are G54…G59")
    for name, value in wanted.items():
        if name not in ZERO_FIELDS or not (isfinite(value) and abs(value) <= reach(name)):
            unit = "degrees" if name == "c" else "mm"
            raise StoreError(
                f"G{code} {name.upper()} {value:g} is out of range;"
                f" enter -{reach(name):g}…{reach(name):g} {unit}"
            )
    old = current(connection).get(code)
    new = (old or ZeroRow())._replace(**wanted)
    if new != old:
        _apply(connection, {code: (old, new)}, reason)
    return new


def clear(connection: sqlite3.Connection, reason: Reason) -> int:
    """Removes all of them as one step; answers how many there were."""
    rows = current(connection)
    if rows:
        _apply(connection, {code: (old, None) for code, old in rows.items()}, reason)
    return len(rows)


def undo(connection: sqlite3.Connection, reason: Reason) -> tuple[ZeroChange, ...]:
    """Takes the last step back that is not undone yet; answers the changes this made.

    Undoing is a step of the history itself; asking again goes further back. Raises StoreError when there is
    nothing left to undo.
    """
    step = connection.execute(
        "SELECT max(step) FROM zero_offset_changes WHERE undoes IS NULL"
        " AND step NOT IN (SELECT undoes FROM zero_offset_changes WHERE undoes IS NOT NULL)"
    ).fetchone()[0]
    if step is None:
        raise StoreError("there is no change of G54…G59 to undo")
    backward = {row.code: (row.new, row.old) for row in _select(connection, "WHERE step = ?", (step,))}
    done = _apply(connection, backward, reason, undoes=step)
    return _select(connection, "WHERE step = ? ORDER BY id", (done,))


def history(connection: sqlite3.Connection, limit: int) -> tuple[ZeroChange, ...]:
    """The last changes, newest first."""
    return _select(connection, "ORDER BY id DESC LIMIT ?", (limit,))


def _apply(
    connection: sqlite3.Connection, changes: Changes, reason: Reason, undoes: int | None = None
) -> int:
    """Writes offsets and their history as one step; answers the step's number."""
    last = connection.execute("SELECT coalesce(max(step), 0) + 1 FROM zero_offset_changes").fetchone()[0]
    step, at, nothing = int(last), utc_now(), (None, None, None)
    for code, (old, new) in changes.items():
        connection.execute("DELETE FROM zero_offsets WHERE code = ?", (code,))
        if new is not None:
            connection.execute("INSERT INTO zero_offsets VALUES (?, ?, ?, ?)", (code, *new))
        connection.execute(
            "INSERT INTO zero_offset_changes (step, undoes, at, code, old_x, old_z, old_c,"
            " new_x, new_z, new_c, why, who) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            (step, undoes, at, code, *(old or nothing), *(new or nothing), *reason),
        )
    return step


def _select(connection: sqlite3.Connection, tail: str, values: tuple[int, ...]) -> tuple[ZeroChange, ...]:
    rows = connection.execute(
        "SELECT id, step, undoes, at, code, why, who, old_x, old_z, old_c, new_x, new_z, new_c"
        f" FROM zero_offset_changes {tail}",
        values,
    )
    return tuple(
        ZeroChange(i, step, undoes, at, code, _row(both[:3]), _row(both[3:]), why, who)
        for i, step, undoes, at, code, why, who, *both in rows
    )


def _row(values: list[float | None]) -> ZeroRow | None:
    x, z, c = values
    return None if x is None or z is None or c is None else ZeroRow(x, z, c)
