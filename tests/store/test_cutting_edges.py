"""Cutting edges of a tool in the one table: kept, undone, exported, read again; and what is refused."""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping
from contextlib import closing
from pathlib import Path

import pytest

from app.offsets.offsets_file import read_offset_rows
from core.store import database
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import ChangeReason
from core.store.offsets.touch_off import TouchPosition
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_export import export_store
from core.store.store_rows import FieldValue, OffsetKind, ToolOffsetRow, replace_fields
from core.tool_edges import format_edge_name, get_edge_number, get_tool_number, make_edge_row_number
from tests.coded import raises_code

WHY = {"why": "test", "who": "test"}
T3_D2 = make_edge_row_number(3, 2)


def test_row_number_encodes_tool_and_edge() -> None:
    assert (make_edge_row_number(3, 1), T3_D2) == (3, 200_003)
    assert (get_tool_number(T3_D2), get_edge_number(T3_D2), format_edge_name(T3_D2)) == (3, 2, "T3 D2")
    assert (get_tool_number(3), get_edge_number(3), format_edge_name(3)) == (3, 1, "T3")


def test_edge_is_saved_undone_and_exported(tmp_path: Path) -> None:
    with Store.open(tmp_path / "data") as store:
        store.offsets.tool_offsets.change_row(3, values={"x": 10.0, "z": 20.0}, **WHY).result()
        row = store.offsets.tool_offsets.change_row(
            T3_D2, values={"x": 10.0, "z": 17.0, "quadrant": 4}, **WHY
        ).result()
        assert row == ToolOffsetRow(10.0, 17.0, quadrant=4)
        assert set(store.offsets.tool_offsets.read_rows()) == {3, T3_D2}
        export_store(store, tmp_path / "out")
        tools, _, _ = read_offset_rows(tmp_path / "out" / "offsets.toml")
        assert tools[T3_D2] == pytest.approx(row[:6] + row[6:])
        store.offsets.tool_offsets.undo_last_step(**WHY).result()
        assert set(store.offsets.tool_offsets.read_rows()) == {3}


@pytest.mark.parametrize(
    ("number", "values", "code", "value"),
    [
        (T3_D2, {"x": 1.0, "z": 1.0}, "never-set", "T3 D2"),
        (make_edge_row_number(33, 2), {"x": 1.0}, "unknown-number", make_edge_row_number(33, 2)),
        (make_edge_row_number(3, 10), {"x": 1.0}, "unknown-number", make_edge_row_number(3, 10)),
        (100_003, {"x": 1.0}, "unknown-number", 100_003),
    ],
)
def test_invalid_edge_values_are_rejected(
    tmp_path: Path, number: int, values: dict[str, float], code: str, value: str | int
) -> None:
    with Store.open(tmp_path) as store, raises_code(StoreError, code, value):
        store.offsets.tool_offsets.change_row(number, values=values, **WHY).result()


def test_second_edge_cannot_be_master(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.offsets.tool_offsets.change_row(3, values={"x": 1.0, "z": 1.0}, **WHY).result()
        with raises_code(StoreError, "not-first-edge"):
            store.offsets.tool_offsets.change_row(
                T3_D2, values={"x": 1.0, "z": 1.0, "master": True}, **WHY
            ).result()


def test_migration_retains_every_field() -> None:
    """A store of the version before keeps every field, its master and its shapes."""
    scripts = database.load_migrations()
    before = next(at for at, text in enumerate(scripts) if "with_edges" in text)
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as connection:
        database.upgrade_tables(connection, scripts[:before])
        connection.execute(
            "INSERT INTO tool_offsets (number, x, z, r, wear_x, wear_z, quadrant, remark, master)"
            " VALUES (7, 1.5, -2.5, 0.4, 0.01, -0.02, 3, 'FINISHER', 1)"
        )
        connection.execute(
            "INSERT INTO tool_shapes VALUES"
            " (7, 'turning', 'right', 'DNMG', '', 0, 0, 0, 0, 0, 0, 0, 93, 0, '')"
        )
        database.upgrade_tables(connection, scripts)
        assert offset_tables.read_tool_offsets(connection)[7] == ToolOffsetRow(
            1.5, -2.5, 0.4, 0.01, -0.02, 3, "FINISHER", True
        )
        (shape,) = offset_tables.read_current_rows(connection, OffsetKind.SHAPE).values()
        assert shape[:3] == ("turning", "right", "DNMG")
        offset_tables.change_row(
            connection, OffsetKind.TOOL, 200_007, ChangeReason("t", "t"), {"x": 1.0, "z": 2.0}
        )
        with pytest.raises(sqlite3.IntegrityError):
            connection.execute("INSERT INTO tool_offsets (number, x, z, r) VALUES (100007, 0, 0, 0)")


# --- the same rules for a touch-off and for several rows --------------------------------------------------


def test_touch_off_of_an_edge_needs_its_tool(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        with raises_code(StoreError, "never-set", "T3 D2"):
            store.offsets.tool_offsets.set_touched_offset(T3_D2, TouchPosition(1.0, 2.0), "touched").result()
        assert store.offsets.tool_offsets.read_rows() == {}
        store.offsets.tool_offsets.change_row(3, values={"x": 1.0, "z": 1.0}, **WHY).result()
        store.offsets.tool_offsets.set_touched_offset(T3_D2, TouchPosition(1.0, 2.0), "touched").result()
        assert store.offsets.tool_offsets.read_rows()[T3_D2] == ToolOffsetRow(1.0, 2.0)


def change_rows(store: Store, kind: OffsetKind, rows: Mapping[int, Mapping[str, FieldValue]]) -> int:
    reason = ChangeReason("import", "test")
    return store.write(
        lambda connection: offset_tables.change_rows(connection, {kind: rows}, reason)
    ).result()


@pytest.mark.parametrize(
    ("kind", "rows", "code"),
    [
        (OffsetKind.TOOL, {T3_D2: {"x": 1.0, "z": 1.0}}, "never-set"),
        (OffsetKind.TOOL, {5: {"x": 1.0, "z": 1.0}, T3_D2: {"x": 1.0, "z": 1.0}}, "never-set"),
        (OffsetKind.TOOL, {4: {"master": True}}, "never-set"),
        (
            OffsetKind.TOOL,
            {3: {"x": 1.0, "z": 1.0}, T3_D2: {"x": 1.0, "z": 1.0, "master": True}},
            "not-first-edge",
        ),
        (OffsetKind.TOOL, {4: {"x": 1.0, "z": 1.0}, 33: {"x": 1.0, "z": 1.0}}, "unknown-number"),
        (OffsetKind.SHAPE, {4: {"width": 1.0}}, "no-shape"),
    ],
)
def test_invalid_rows_are_rejected_together(
    tmp_path: Path, kind: OffsetKind, rows: Mapping[int, Mapping[str, FieldValue]], code: str
) -> None:
    with Store.open(tmp_path) as store:
        with raises_code(StoreError, code):
            change_rows(store, kind, rows)
        assert store.offsets.tool_offsets.read_rows() == {}
        assert store.offsets.tool_shapes.read_rows() == {}


@pytest.mark.parametrize("numbers", [(3, T3_D2), (T3_D2, 3)])
def test_tool_and_its_edge_are_set_in_one_step(tmp_path: Path, numbers: tuple[int, int]) -> None:
    with Store.open(tmp_path) as store:
        assert change_rows(store, OffsetKind.TOOL, {number: {"x": 1.0, "z": 2.0} for number in numbers}) == 2
        store.offsets.tool_offsets.undo_last_step(**WHY).result()
        assert store.offsets.tool_offsets.read_rows() == {}


def test_new_master_of_several_rows_replaces_the_old_one(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.offsets.tool_offsets.change_row(1, values={"x": 1.0, "z": 1.0, "master": True}, **WHY).result()
        new = {"x": 1.0, "z": 1.0, "master": True}
        assert change_rows(store, OffsetKind.TOOL, {4: new, 5: {"x": 3.0, "z": 1.0}}) == 3
        rows = store.offsets.tool_offsets.read_rows()
        assert {number: row.master for number, row in rows.items()} == {1: False, 4: True, 5: False}


def test_unknown_field_of_a_row_is_rejected_in_every_python() -> None:
    assert replace_fields(ToolOffsetRow(1.0, 2.0), {"z": 3.0}) == ToolOffsetRow(1.0, 3.0)
    with pytest.raises(ValueError, match="ToolOffsetRow has no field width"):
        replace_fields(ToolOffsetRow(1.0, 2.0), {"z": 3.0, "width": 1.0})
