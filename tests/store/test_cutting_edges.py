"""Cutting edges of a tool in the one table: kept, undone, exported, read again; and what is refused."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from app.offsets.offsets_file import read_offset_rows
from core.store import database
from core.store.offsets import offset_tables
from core.store.offsets.offset_tables import ChangeReason
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_export import export_store
from core.store.store_rows import OffsetKind, ToolRow
from core.tool_edges import format_edge_name, get_edge_number, get_tool_number, make_row_number
from tests.coded import raises_code

WHY = {"why": "test", "who": "test"}
T3_D2 = make_row_number(3, 2)


def test_row_number_encodes_tool_and_edge() -> None:
    assert (make_row_number(3, 1), T3_D2) == (3, 200_003)
    assert (get_tool_number(T3_D2), get_edge_number(T3_D2), format_edge_name(T3_D2)) == (3, 2, "T3 D2")
    assert (get_tool_number(3), get_edge_number(3), format_edge_name(3)) == (3, 1, "T3")


def test_edge_is_saved_undone_and_exported(tmp_path: Path) -> None:
    with Store.open(tmp_path / "data") as store:
        store.offsets.tool_offsets.change_row(3, values={"x": 10.0, "z": 20.0}, **WHY).result()
        row = store.offsets.tool_offsets.change_row(
            T3_D2, values={"x": 10.0, "z": 17.0, "quadrant": 4}, **WHY
        ).result()
        assert row == ToolRow(10.0, 17.0, quadrant=4)
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
        (make_row_number(33, 2), {"x": 1.0}, "unknown-number", make_row_number(33, 2)),
        (make_row_number(3, 10), {"x": 1.0}, "unknown-number", make_row_number(3, 10)),
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
        assert offset_tables.read_tool_offsets(connection)[7] == ToolRow(
            1.5, -2.5, 0.4, 0.01, -0.02, 3, "FINISHER", True
        )
        (shape,) = offset_tables.read_current_rows(connection, OffsetKind.SHAPE).values()
        assert shape[:3] == ("turning", "right", "DNMG")
        offset_tables.change_row(
            connection, OffsetKind.TOOL, 200_007, ChangeReason("t", "t"), {"x": 1.0, "z": 2.0}
        )
        with pytest.raises(sqlite3.IntegrityError):
            connection.execute("INSERT INTO tool_offsets (number, x, z, r) VALUES (100007, 0, 0, 0)")
