"""Shapes of tools in the store: their rows, their own history, and a store from before there were any."""

from __future__ import annotations

import sqlite3
from math import inf
from pathlib import Path

import pytest

from core.store import database
from core.store.store import Store, StoreError
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import ToolOffsetRow, ToolShapeRow
from tests.coded import raises_code

DRILL = ToolShapeRow("drill", diameter=6.35, point=118.0, flutes=2)


def set_shape(store: Store, number: int, **values: float | str) -> None:
    store.offsets.tool_shapes.change_row(number, "entered", values).result()


def test_shape_is_saved_with_offset_of_its_tool(store: Store) -> None:
    set_shape(store, 5, kind="drill", diameter=6.35, point=118.0, flutes=2)
    assert store.offsets.tool_shapes.read_rows() == {5: DRILL}
    assert store.offsets.tool_offsets.read_rows() == {}, "the tool was never touched off"
    set_shape(store, 5, rear=True)
    assert store.offsets.tool_shapes.read_rows() == {5: DRILL._replace(rear=True)}


def test_shapes_have_a_history_of_their_own(store: Store) -> None:
    store.offsets.tool_offsets.change_row(5, "set", {"x": 1.0, "z": 2.0}).result()
    set_shape(store, 5, kind="drill", diameter=6.35, point=118.0, flutes=2)
    set_shape(store, 5, diameter=6.4)
    newest, first = store.offsets.tool_shapes.read_history()
    assert (newest.old, newest.new) == (DRILL, DRILL._replace(diameter=6.4))
    assert (first.old, first.new) == (None, DRILL)
    assert len(store.offsets.tool_offsets.read_history()) == 1
    store.offsets.tool_shapes.undo_last_step().result()
    assert store.offsets.tool_shapes.read_rows() == {5: DRILL}
    store.offsets.tool_shapes.undo_last_step().result()
    assert store.offsets.tool_shapes.read_rows() == {}
    assert store.offsets.tool_offsets.read_rows() == {5: ToolOffsetRow(1.0, 2.0)}


def test_removed_shape_is_restored_by_undo(store: Store) -> None:
    set_shape(store, 5, kind="drill", diameter=6.35, point=118.0, flutes=2)
    assert store.offsets.tool_shapes.remove_row(5, "sold").result() is True
    assert store.offsets.tool_shapes.read_rows() == {}
    assert store.offsets.tool_shapes.remove_row(5, "again").result() is False
    store.offsets.tool_shapes.undo_last_step().result()
    assert store.offsets.tool_shapes.read_rows() == {5: DRILL}


def test_repeated_entry_is_not_a_change(store: Store) -> None:
    set_shape(store, 5, kind="drill")
    set_shape(store, 5, kind="drill")
    assert len(store.offsets.tool_shapes.read_history()) == 1


@pytest.mark.parametrize(
    ("values", "code", "told"),
    [
        ({"diameter": 6.0}, "no-shape", "turning, boring"),
        ({"kind": "hammer"}, "out-of-range", "T5 kind 'hammer'"),
        ({"kind": ""}, "out-of-range", "T5 kind ''"),
        ({"kind": "drill", "hand": "both"}, "out-of-range", "right, left, neutral"),
        ({"kind": "drill", "diameter": -0.1}, "out-of-range", "T5 diameter"),
        ({"kind": "drill", "diameter": inf}, "out-of-range", "T5 diameter inf in"),
        ({"kind": "drill", "point": 180.5}, "out-of-range", "T5 point angle 180.5"),
        ({"kind": "drill", "flutes": 1.5}, "out-of-range", "T5 flutes 1.5"),
        ({"kind": "drill", "insert": "x" * 41}, "out-of-range", "40"),
        ({"kind": "drill", "holder": "a\nb"}, "out-of-range", "T5 holder"),
        ({"kind": "drill", "colour": 3}, "out-of-range", "T5 colour 3"),
    ],
)
def test_impossible_value_is_rejected(
    store: Store, values: dict[str, float | str], code: str, told: str
) -> None:
    with raises_code(StoreError, code, told):
        set_shape(store, 5, **values)
    assert store.offsets.tool_shapes.read_rows() == {}


def test_unknown_tool_is_rejected(store: Store) -> None:
    with raises_code(StoreError, "unknown-number", "T33"):
        set_shape(store, 33, kind="drill")
    with raises_code(StoreError, "unknown-number", "T0"):
        store.offsets.tool_shapes.remove_row(0, "no").result()


def test_undo_without_shape_change_is_rejected(store: Store) -> None:
    store.offsets.tool_offsets.change_row(5, "set", {"x": 1.0, "z": 2.0}).result()
    with raises_code(StoreError, "nothing-to-undo"):
        store.offsets.tool_shapes.undo_last_step().result()


def test_older_store_has_no_shapes_and_accepts_new_ones(folder: Path) -> None:
    folder.mkdir()
    connection = sqlite3.connect(folder / STORE_FILE_NAME, isolation_level=None)
    connection.execute(f"PRAGMA application_id = {database.APPLICATION_ID}")
    connection.execute("PRAGMA journal_mode = WAL")
    database.upgrade_tables(connection, database.load_migrations()[:4])
    connection.execute("INSERT INTO tool_offsets (number, x, z, r) VALUES (3, 1.0, 2.0, 0.4)")
    connection.close()
    with Store.open(folder) as store:
        assert store.offsets.tool_shapes.read_rows() == {}
        assert store.offsets.tool_offsets.read_rows() == {3: ToolOffsetRow(1.0, 2.0, 0.4)}
        set_shape(store, 3, kind="turning", insert="CNMG432")
        assert store.offsets.tool_shapes.read_rows() == {3: ToolShapeRow("turning", insert="CNMG432")}
