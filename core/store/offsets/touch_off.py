"""Tools together: touching one off, and the master tool that the others are relative to.

The store keeps for every tool the machine position at which its tip stands on part zero. Relative to the
master is the difference of two of these. Touching the master off moves part zero, so every tool follows by
the same way and no difference changes; choosing another master changes no position at all.
"""

from __future__ import annotations

import sqlite3
from typing import NamedTuple

from core.message import Message
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import Reason
from core.store.store_errors import StoreError
from core.store.store_rows import Change, Kind, Row, ToolRow
from core.tool_edges import edge_name


class Touch(NamedTuple):
    """Where a tip stands on part zero, machine mm and X a radius; None: that axis was not touched.

    ``alone``: also the master is set for itself, because its tip has changed and part zero has not.
    """

    x: float | None = None
    z: float | None = None
    alone: bool = False


def touch_off(
    connection: sqlite3.Connection, number: int, touch: Touch, reason: Reason
) -> tuple[Change, ...]:
    """Sets what was touched; the wear of that axis is in the new geometry and begins again at nought.

    The master takes all others along, as one step of the history. Raises StoreError outside the ranges, and
    for half of a tool that was never set; then nothing has changed.
    """
    offset_tables.check_number(Kind.TOOL, number)
    rows = offset_tables.tools(connection)
    old = rows.get(number)
    if old is None and (touch.x is None or touch.z is None):
        raise StoreError(
            Message(
                "the offset of {number} has never been set; touch off both X and Z",
                number=edge_name(number),
            ),
            "needs-both-axes",
        )
    geometry = {name: value for name, value in (("x", touch.x), ("z", touch.z)) if value is not None}
    new = _tool(number, old, {**geometry, **{f"wear_{name}": 0.0 for name in geometry}})
    changes: dict[int, tuple[Row | None, Row | None]] = {number: (old, new)}
    if old is not None and old.master and not touch.alone:
        changes |= _followers(rows, number, new.offset[0] - old.offset[0], new.offset[1] - old.offset[1])
    changes = {n: pair for n, pair in changes.items() if pair[0] != pair[1]}
    if not changes:
        return ()
    return offset_tables.apply(connection, Kind.TOOL, changes, reason)


def _tool(number: int, old: ToolRow | None, wanted: dict[str, float]) -> ToolRow:
    row = offset_tables.changed(Kind.TOOL, number, old, wanted)
    assert isinstance(row, ToolRow)  # of the table of tools
    return row


def _followers(
    rows: dict[int, ToolRow], master: int, x: float, z: float
) -> dict[int, tuple[Row | None, Row | None]]:
    """Every other tool moved along with part zero."""
    return {
        n: (row, _tool(n, row, {"x": row.x + x, "z": row.z + z})) for n, row in rows.items() if n != master
    }


def choose_master(connection: sqlite3.Connection, number: int, reason: Reason) -> tuple[Change, ...]:
    """Makes a tool the master, 0: none; no offset changes. Raises StoreError for one never set."""
    rows = offset_tables.tools(connection)
    if number and number not in rows:
        raise StoreError(offset_tables.never_set(number), "never-set")
    changes: dict[int, tuple[Row | None, Row | None]] = {
        n: (row, row._replace(master=n == number))
        for n, row in rows.items()
        if row.master is not (n == number)
    }
    if not changes:
        return ()
    return offset_tables.apply(connection, Kind.TOOL, changes, reason)
