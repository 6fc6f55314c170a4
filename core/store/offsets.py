"""Tool and secondary offsets: what is valid now, and every change that made it so."""

from __future__ import annotations

import sqlite3
from math import isfinite
from typing import NamedTuple

from core.store.errors import StoreError
from core.store.rows import OFFSETS, RADIUS_MAX, SECONDARY_REACH, TOOL_REACH, Change, Kind, inches, utc_now

Triple = tuple[float, float, float]
Wanted = tuple[float | None, float | None, float | None]
_TABLE = {Kind.TOOL: "tool_offsets", Kind.SECONDARY: "secondary_offsets"}
_LETTER = {Kind.TOOL: "T", Kind.SECONDARY: "D"}
_REACH = {Kind.TOOL: TOOL_REACH, Kind.SECONDARY: SECONDARY_REACH}


class Reason(NamedTuple):
    """Why an offset is changed and by whom."""

    why: str
    who: str


def current(connection: sqlite3.Connection, kind: Kind) -> dict[int, Triple]:
    """All offsets of one table by number."""
    rows = connection.execute(f"SELECT number, x, z, r FROM {_TABLE[kind]} ORDER BY number")
    return {number: (x, z, r) for number, x, z, r in rows}


def change(
    connection: sqlite3.Connection,
    kind: Kind,
    number: int,
    reason: Reason,
    wanted: Wanted,
) -> Triple:
    """Sets what ``wanted`` gives of (x, z, r) and keeps the rest; answers the new offset.

    Raises StoreError outside the ranges.
    """
    if number not in OFFSETS:
        raise StoreError(f"{_LETTER[kind]}{number} does not exist; offsets are {_LETTER[kind]}1…32")
    old = current(connection, kind).get(number)
    x, z, r = (
        before if value is None else value
        for value, before in zip(wanted, old or (0.0, 0.0, 0.0), strict=True)
    )
    new = (float(x), float(z), float(r))
    _check(kind, number, new)
    if new != old:
        _apply(connection, kind, {number: (old, new)}, reason)
    return new


def _check(kind: Kind, number: int, new: Triple) -> None:
    reach = _REACH[kind]
    for word, value in zip("XZ", new, strict=False):
        if not (isfinite(value) and abs(value) <= reach):
            raise StoreError(
                f"{_LETTER[kind]}{number} {word} {inches(value):g} in is out of range; "
                f"enter -{inches(reach):g}…{inches(reach):g} in"
            )
    if not (isfinite(new[2]) and 0.0 <= new[2] <= RADIUS_MAX):
        raise StoreError(
            f"{_LETTER[kind]}{number} nose radius {inches(new[2]):g} in is out of range; "
            f"enter 0…{inches(RADIUS_MAX):g} in"
        )


def clear(connection: sqlite3.Connection, kind: Kind, reason: Reason) -> int:
    """Removes every offset of a table as one step; answers how many there were."""
    rows = current(connection, kind)
    if rows:
        _apply(connection, kind, {number: (old, None) for number, old in rows.items()}, reason)
    return len(rows)


def _apply(
    connection: sqlite3.Connection,
    kind: Kind,
    changes: dict[int, tuple[Triple | None, Triple | None]],
    reason: Reason,
    undoes: int | None = None,
) -> int:
    """Writes offsets and their history as one step; answers the step's number."""
    step = int(connection.execute("SELECT coalesce(max(step), 0) + 1 FROM offset_changes").fetchone()[0])
    at = utc_now()
    for number, (old, new) in changes.items():
        connection.execute(f"DELETE FROM {_TABLE[kind]} WHERE number = ?", (number,))
        if new is not None:
            connection.execute(f"INSERT INTO {_TABLE[kind]} VALUES (?, ?, ?, ?)", (number, *new))
        nothing = (None, None, None)
        connection.execute(
            "INSERT INTO offset_changes (step, undoes, at, kind, number, old_x, old_z, old_r,"
            " new_x, new_z, new_r, why, who) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            (step, undoes, at, kind.value, number, *(old or nothing), *(new or nothing), *reason),
        )
    return step


def undo(connection: sqlite3.Connection, reason: Reason, kind: Kind | None = None) -> tuple[Change, ...]:
    """Takes the last step back that is not undone yet; answers the changes this made.

    With ``kind`` the last step of that table. Undoing is itself a step of the history; asking again goes
    further back. Raises StoreError when there is nothing left to undo.
    """
    step = connection.execute(
        "SELECT max(step) FROM offset_changes WHERE undoes IS NULL AND kind = coalesce(?, kind)"
        " AND step NOT IN (SELECT undoes FROM offset_changes WHERE undoes IS NOT NULL)",
        (kind.value if kind else None,),
    ).fetchone()[0]
    if step is None:
        raise StoreError("there is no offset change to undo")
    rows = _select(connection, "WHERE step = ? ORDER BY id", (step,))
    backward = {row.number: (row.new, row.old) for row in rows}
    done = _apply(connection, rows[0].kind, backward, reason, undoes=step)
    return _select(connection, "WHERE step = ? ORDER BY id", (done,))


def history(connection: sqlite3.Connection, kind: Kind | None, limit: int) -> tuple[Change, ...]:
    """The last changes, newest first."""
    if kind is None:
        return _select(connection, "ORDER BY id DESC LIMIT ?", (limit,))
    return _select(connection, "WHERE kind = ? ORDER BY id DESC LIMIT ?", (kind.value, limit))


def _select(connection: sqlite3.Connection, tail: str, values: tuple[int | str, ...]) -> tuple[Change, ...]:
    rows = connection.execute(
        "SELECT id, step, undoes, at, kind, number, old_x, old_z, old_r, new_x, new_z, new_r, why, who"
        f" FROM offset_changes {tail}",
        values,
    )
    return tuple(
        Change(i, step, undoes, at, Kind(kind), number, _triple(old), _triple(new), why, who)
        for i, step, undoes, at, kind, number, *old, a, b, c, why, who in rows
        for new in ((a, b, c),)
    )


def _triple(values: list[float] | tuple[float, float, float]) -> Triple | None:
    x, z, r = values
    return None if x is None else (x, z, r)
