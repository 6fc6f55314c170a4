"""Whatever is touched in whatever order: tips keep their distance, there is one master, undo leads back."""

from __future__ import annotations

import sqlite3
from contextlib import closing

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.store import database
from core.store.offsets import offset_history, offset_tables, touch_off
from core.store.offsets.offset_tables import ChangeReason
from core.store.offsets.touch_off import TouchPosition
from core.store.store_rows import OffsetKind, ToolOffsetRow

WHY = ChangeReason("try", "test")
START = {
    1: ToolOffsetRow(-12.7, -76.2, wear_x=0.05),
    2: ToolOffsetRow(6.35, -63.5, wear_z=-0.1),
    3: ToolOffsetRow(-25.4, -81.28),
    4: ToolOffsetRow(0.0, 0.0),
}
place = st.floats(-200.0, 200.0).map(lambda mm: round(mm, 4))
touches = st.tuples(st.integers(1, 4), st.none() | place, st.none() | place, st.booleans())
STEPS = st.lists(
    st.one_of(
        st.tuples(st.just("touch"), touches),
        st.tuples(st.just("master"), st.integers(0, 4)),
        st.tuples(st.just("wear"), st.tuples(st.integers(1, 4), st.floats(-2.0, 2.0))),
    ),
    max_size=12,
)


def distances(rows: dict[int, ToolOffsetRow]) -> dict[tuple[int, int], tuple[float, float]]:
    """How far every tip stands from every other."""
    return {
        (a, b): (rows[a].offset[0] - rows[b].offset[0], rows[a].offset[1] - rows[b].offset[1])
        for a in rows
        for b in rows
        if a != b
    }


def step(connection: sqlite3.Connection, what: str, values: object) -> None:
    """One change, and what must hold of it."""
    before = offset_tables.read_tool_offsets(connection)
    if what == "master":
        assert isinstance(values, int)
        touch_off.set_master_tool(connection, values, WHY)
        after = offset_tables.read_tool_offsets(connection)
        assert {n: row.offset for n, row in after.items()} == {n: row.offset for n, row in before.items()}
        assert [n for n, row in after.items() if row.master] == ([values] if values else [])
    elif what == "wear":
        assert isinstance(values, tuple)
        offset_tables.change_row(connection, OffsetKind.TOOL, values[0], WHY, {"wear_x": values[1]})
    else:
        assert isinstance(values, tuple)
        number, x, z, alone = values
        touch_off.store_touch_off(connection, number, TouchPosition(x, z, alone), WHY)
        touched(before, offset_tables.read_tool_offsets(connection), number, TouchPosition(x, z, alone))


def touched(
    before: dict[int, ToolOffsetRow], after: dict[int, ToolOffsetRow], number: int, touch: TouchPosition
) -> None:
    """The tip stands where it was touched; who follows, and who stays."""
    for place_, value in zip((touch.x, touch.z), after[number].offset, strict=True):
        assert place_ is None or value == pytest.approx(place_)
    if before[number].master and not touch.applies_to_this_tool_only:
        for pair, apart in distances(before).items():
            assert distances(after)[pair] == pytest.approx(apart, abs=1e-9)
    else:
        others = {n: row for n, row in before.items() if n != number}
        assert {n: row for n, row in after.items() if n != number} == others


@given(STEPS)
@settings(max_examples=60, deadline=None)
def test_random_touches_and_masters_are_undone_completely(steps: list[tuple[str, object]]) -> None:
    with closing(database.create_empty_store()) as connection:
        for number, row in START.items():
            offset_tables.change_row(connection, OffsetKind.TOOL, number, WHY, row._asdict())
        for what, values in steps:
            step(connection, what, values)
            assert sum(row.master for row in offset_tables.read_tool_offsets(connection).values()) <= 1
        made = connection.execute("SELECT max(step) FROM offset_changes").fetchone()[0] - len(START)
        for _ in range(made):
            offset_history.undo(connection, WHY, OffsetKind.TOOL)
        assert offset_tables.read_tool_offsets(connection) == START
