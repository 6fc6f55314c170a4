"""Wear, quadrant, remark and master; touching off; and a store from before any of them."""

from __future__ import annotations

import sqlite3
from math import nan
from pathlib import Path
from typing import Any

import pytest

from core.store import database
from core.store.offsets.touch_off import TouchPosition
from core.store.store import Store, StoreError
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import SecondaryOffsetRow, ToolOffsetRow
from tests.coded import raises_code


def old_store(folder: Path) -> None:
    """What the first version wrote, by its own tables and statements."""
    folder.mkdir()
    connection = sqlite3.connect(folder / STORE_FILE_NAME, isolation_level=None)
    connection.execute(f"PRAGMA application_id = {database.APPLICATION_ID}")
    connection.execute("PRAGMA journal_mode = WAL")
    database.upgrade_tables(connection, database.load_migrations()[:1])
    connection.execute("INSERT INTO tool_offsets VALUES (3, 31.75, -12.7, 0.381)")
    connection.execute("INSERT INTO secondary_offsets VALUES (4, -0.0127, 0, 0)")
    changes = (
        "INSERT INTO offset_changes"
        " (step, at, kind, number, old_x, old_z, old_r, new_x, new_z, new_r, why, who)"
    )
    for step, row in enumerate(
        (
            ("tool", 3, None, None, None, 30.0, -12.7, 0.381, "touched off", "operator"),
            ("tool", 3, 30.0, -12.7, 0.381, 31.75, -12.7, 0.381, "new insert", "operator"),
            ("secondary", 4, None, None, None, -0.0127, 0.0, 0.0, "X -.001", "operator"),
        ),
        1,
    ):
        marks = ", ".join("?" * 12)
        connection.execute(f"{changes} VALUES ({marks})", (step, "2026-01-02T03:04:05.000Z", *row))
    connection.close()


def test_old_store_opens_with_all_its_data(folder: Path) -> None:
    old_store(folder)
    with Store.open(folder) as store:
        assert store.offsets.tool_offsets.read_rows() == {
            3: ToolOffsetRow(31.75, -12.7, 0.381, 0.0, 0.0, 0, "", False)
        }
        assert store.offsets.secondary_offsets.read_rows() == {4: SecondaryOffsetRow(-0.0127, 0.0, 0.0)}
        second, first = store.offsets.tool_offsets.read_history()
        assert (first.old, first.new) == (None, ToolOffsetRow(30.0, -12.7, 0.381))
        assert second.old == ToolOffsetRow(30.0, -12.7, 0.381)
        store.offsets.tool_offsets.change_row(3, "worn", {"wear_x": -0.0127, "remark": "rough"}).result()
        store.offsets.tool_offsets.undo_last_step().result()
        store.offsets.tool_offsets.undo_last_step().result()
        assert store.offsets.tool_offsets.read_rows() == {3: ToolOffsetRow(30.0, -12.7, 0.381)}
    kept = folder / "turndesk-version-1.db"
    assert database.check_store_file(kept, is_thorough=True) == 1


def test_every_field_is_saved_with_its_history(store: Store) -> None:
    store.offsets.tool_offsets.change_row(
        2, "set", {"x": 1.0, "z": 2.0, "nose_radius": 0.4, "quadrant": 3, "remark": "DNMG finish"}
    ).result()
    store.offsets.tool_offsets.change_row(2, "worn", {"wear_x": -0.01, "wear_z": 0.02}).result()
    row = ToolOffsetRow(1.0, 2.0, 0.4, -0.01, 0.02, 3, "DNMG finish")
    assert store.offsets.tool_offsets.read_rows() == {2: row}
    assert row.offset == pytest.approx((0.99, 2.02))
    newest = store.offsets.read_history()[0]
    assert newest.new == row
    assert newest.old == row._replace(wear_x=0.0, wear_z=0.0)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"wear_x": 2.55}, ("T1 wear X 0.100394 in", "-0.1…0.1 in")),
        ({"wear_z": nan}, ("T1 wear Z nan in",)),
        ({"quadrant": 10}, ("T1 tip quadrant 10", "0…9")),
        ({"quadrant": 2.5}, ("T1 tip quadrant 2.5",)),
        ({"remark": "x" * 41}, ("T1 remark", "x" * 41, "40")),
        ({"remark": "two\nlines"}, ("T1 remark", repr("two\nlines"))),
        ({"remark": 7}, ("T1 remark 7",)),
        ({"x": "1"}, ("T1 X '1'",)),
    ],
)
def test_invalid_field_value_is_rejected(store: Store, values: dict[str, Any], told: tuple[str, ...]) -> None:
    with raises_code(StoreError, "out-of-range", *told):
        store.offsets.tool_offsets.change_row(1, "no", values).result()
    assert store.offsets.tool_offsets.read_rows() == {}
    assert store.offsets.read_history() == ()


def three_tools(store: Store) -> None:
    store.offsets.tool_offsets.change_row(1, "a", {"x": 10.0, "z": -100.0, "wear_x": 0.5})
    store.offsets.tool_offsets.change_row(2, "b", {"x": -20.0, "z": -90.0, "wear_z": 0.25})
    store.offsets.tool_offsets.change_row(3, "c", {"x": 5.0, "z": -95.0}).result()


def test_touch_sets_geometry_and_clears_wear_of_that_axis(store: Store) -> None:
    three_tools(store)
    store.offsets.tool_offsets.change_row(2, "worn", {"wear_x": 0.1}).result()
    changes = store.offsets.tool_offsets.set_touched_offset(2, TouchPosition(x=-21.0), "touched").result()
    assert [change.number for change in changes] == [2]
    assert store.offsets.tool_offsets.read_rows()[2] == ToolOffsetRow(-21.0, -90.0, wear_x=0.0, wear_z=0.25)
    assert store.offsets.tool_offsets.set_touched_offset(2, TouchPosition(x=-21.0), "again").result() == ()


def test_first_touch_sets_tool_with_both_axes(store: Store) -> None:
    with raises_code(StoreError, "needs-both-axes"):
        store.offsets.tool_offsets.set_touched_offset(7, TouchPosition(x=3.0), "half").result()
    assert store.offsets.tool_offsets.read_rows() == {}
    store.offsets.tool_offsets.set_touched_offset(7, TouchPosition(x=3.0, z=-50.0), "first").result()
    assert store.offsets.tool_offsets.read_rows() == {7: ToolOffsetRow(3.0, -50.0)}


def test_master_touch_moves_every_tool(store: Store) -> None:
    three_tools(store)
    store.offsets.tool_offsets.set_master_tool(1, "reference").result()
    store.offsets.tool_offsets.set_touched_offset(1, TouchPosition(x=12.0, z=-101.0), "new bar").result()
    # T1 stood at 10.5 and -100 with its wear: part zero has moved by 1.5 and -1
    tools = store.offsets.tool_offsets.read_rows()
    assert tools[1] == ToolOffsetRow(12.0, -101.0, master=True)
    assert tools[2] == ToolOffsetRow(-18.5, -91.0, wear_z=0.25)
    assert tools[3] == ToolOffsetRow(6.5, -96.0)
    assert len({change.step for change in store.offsets.read_history(limit=3)}) == 1
    store.offsets.undo_last_step().result()
    assert store.offsets.tool_offsets.read_rows()[2] == ToolOffsetRow(-20.0, -90.0, wear_z=0.25)
    assert store.offsets.tool_offsets.read_rows()[1] == ToolOffsetRow(10.0, -100.0, wear_x=0.5, master=True)


def test_master_can_be_set_alone_when_only_its_tip_changed(store: Store) -> None:
    three_tools(store)
    store.offsets.tool_offsets.set_master_tool(1, "reference").result()
    store.offsets.tool_offsets.set_touched_offset(
        1, TouchPosition(z=-99.0, applies_to_this_tool_only=True), "new insert"
    ).result()
    assert store.offsets.tool_offsets.read_rows()[1].z == -99.0
    assert store.offsets.tool_offsets.read_rows()[3] == ToolOffsetRow(5.0, -95.0)


def test_change_of_master_moves_no_tip_and_leaves_one_master(store: Store) -> None:
    three_tools(store)
    before = {number: row.offset for number, row in store.offsets.tool_offsets.read_rows().items()}
    for master in (1, 3):
        store.offsets.tool_offsets.set_master_tool(master, "reference").result()
        tools = store.offsets.tool_offsets.read_rows()
        assert [number for number, row in tools.items() if row.master] == [master]
        assert {number: row.offset for number, row in tools.items()} == before
    store.offsets.tool_offsets.change_row(2, "by hand", {"master": True}).result()
    assert [number for number, row in store.offsets.tool_offsets.read_rows().items() if row.master] == [2]
    store.offsets.undo_last_step().result()
    assert [number for number, row in store.offsets.tool_offsets.read_rows().items() if row.master] == [3]
    store.offsets.tool_offsets.set_master_tool(0, "none").result()
    assert not any(row.master for row in store.offsets.tool_offsets.read_rows().values())


def test_master_without_offset_is_rejected(store: Store) -> None:
    with raises_code(StoreError, "never-set", "T9"):
        store.offsets.tool_offsets.set_master_tool(9, "no").result()
    with raises_code(StoreError, "never-set", "T9"):
        store.offsets.tool_offsets.change_row(9, "no", {"master": True}).result()
    assert store.offsets.tool_offsets.read_rows() == {}


def test_follower_out_of_range_rejects_whole_touch(store: Store) -> None:
    three_tools(store)
    store.offsets.tool_offsets.change_row(4, "far", {"x": 1269.5, "z": 0.0})
    store.offsets.tool_offsets.set_master_tool(1, "reference").result()
    before = store.offsets.tool_offsets.read_rows()
    with raises_code(StoreError, "out-of-range", "T4 X"):
        store.offsets.tool_offsets.set_touched_offset(1, TouchPosition(x=12.0), "no").result()
    assert store.offsets.tool_offsets.read_rows() == before
