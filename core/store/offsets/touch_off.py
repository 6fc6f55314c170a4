"""Functions that affect several tools: touch-off, and the choice of the master tool.

For every tool, the store contains the machine position at which its tip is at part zero. The difference of
two of these positions is the offset of a tool relative to the master tool. Touching off the master tool
moves part zero, so every tool moves by the same distance and no difference changes. Choosing another master
tool does not change any position.
"""

from __future__ import annotations

import sqlite3
from typing import NamedTuple

from core.message import Message
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import ChangeReason
from core.store.store_errors import StoreError
from core.store.store_rows import OffsetChange, OffsetKind, OffsetRow, ToolOffsetRow
from core.tool_edges import format_edge_name


class TouchPosition(NamedTuple):
    """The machine position in mm, with X as a radius, at which a tip is at part zero.

    An axis is None if it was not touched off. ``applies_to_this_tool_only`` means that only the offset of
    this tool changes, even if it is the master tool. This applies if its tip has changed, but part zero has
    not.
    """

    x: float | None = None
    z: float | None = None
    applies_to_this_tool_only: bool = False


def store_touch_off(
    connection: sqlite3.Connection, number: int, touch: TouchPosition, reason: ChangeReason
) -> tuple[OffsetChange, ...]:
    """Store a touched-off position and set the wear of the touched-off axes to zero.

    The new geometry already includes the wear. Touching off the master tool moves all other tools by the
    same distance, as one step of the history, unless ``touch.moves_only_this_tool`` is True. Raises
    StoreError if the number is unknown, a value is out of range, or a new tool was not touched off in both
    axes. Also raises StoreError for an additional cutting edge whose tool has no offset yet. After an
    error, the store is unchanged.
    """
    offset_tables.check_row_number(OffsetKind.TOOL, number)
    rows = offset_tables.read_tool_offsets(connection)
    offset_tables.check_edge(OffsetKind.TOOL, number, rows, {})
    old = rows.get(number)
    if old is None and (touch.x is None or touch.z is None):
        raise StoreError(
            Message(
                "the offset of {number} has never been set; touch off both X and Z",
                number=format_edge_name(number),
            ),
            "needs-both-axes",
        )
    geometry = {name: value for name, value in (("x", touch.x), ("z", touch.z)) if value is not None}
    new = _tool(number, old, {**geometry, **{f"wear_{name}": 0.0 for name in geometry}})
    changes: dict[int, tuple[OffsetRow | None, OffsetRow | None]] = {number: (old, new)}
    if old is not None and old.master and not touch.applies_to_this_tool_only:
        changes |= _make_follower_changes(
            rows, number, new.offset[0] - old.offset[0], new.offset[1] - old.offset[1]
        )
    changes = {n: pair for n, pair in changes.items() if pair[0] != pair[1]}
    if not changes:
        return ()
    return offset_tables.apply_changes(connection, OffsetKind.TOOL, changes, reason)


def _tool(number: int, old: ToolOffsetRow | None, wanted: dict[str, float]) -> ToolOffsetRow:
    row = offset_tables.apply_field_changes(OffsetKind.TOOL, number, old, wanted)
    assert isinstance(row, ToolOffsetRow)  # always true for the table of tools
    return row


def _make_follower_changes(
    rows: dict[int, ToolOffsetRow], master: int, x: float, z: float
) -> dict[int, tuple[OffsetRow | None, OffsetRow | None]]:
    """Return the changes that move all other tools together with part zero, by ``x`` and ``z`` in mm."""
    return {
        n: (row, _tool(n, row, {"x": row.x + x, "z": row.z + z})) for n, row in rows.items() if n != master
    }


def set_master_tool(
    connection: sqlite3.Connection, number: int, reason: ChangeReason
) -> tuple[OffsetChange, ...]:
    """Make a tool the master tool, or clear the master tool if ``number`` is 0.

    No position changes. Raises StoreError if the tool has never been set.
    """
    rows = offset_tables.read_tool_offsets(connection)
    if number and number not in rows:
        raise StoreError(offset_tables.make_no_offset_message(number), "never-set")
    changes: dict[int, tuple[OffsetRow | None, OffsetRow | None]] = {
        n: (row, row._replace(master=n == number))
        for n, row in rows.items()
        if row.master is not (n == number)
    }
    if not changes:
        return ()
    return offset_tables.apply_changes(connection, OffsetKind.TOOL, changes, reason)
