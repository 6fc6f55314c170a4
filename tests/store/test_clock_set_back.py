"""The order of changes is that in which they were made, whatever the clock says."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from core.store import backup, database
from core.store.offsets import offset_tables
from core.store.store import Store, StoreError
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import OffsetKind
from tests.coded import raises_code


def clock(monkeypatch: pytest.MonkeyPatch, *hours: int) -> None:
    times: Iterator[str] = iter(f"2026-11-29T{hour:02}:00:00.000000Z" for hour in hours)
    monkeypatch.setattr(offset_tables, "get_utc_now_text", lambda: next(times))


def test_newest_change_is_listed_and_undone_first_after_clock_change(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The clock is set back between a tool and a zero offset: the tool was taken for the newer one."""
    clock(monkeypatch, 9, 12, 11, 10, 8)
    store.offsets.tool_offsets.change_row(3, "touched", {"x": 1.0}).result()
    store.offsets.tool_offsets.change_row(3, "worn", {"wear_x": 0.1}).result()
    store.offsets.zero_offsets.change_row(54, "set", {"z": -1.0}).result()
    assert [row.kind for row in store.offsets.read_history()] == [
        OffsetKind.ZERO,
        OffsetKind.TOOL,
        OffsetKind.TOOL,
    ]
    [undone] = store.offsets.undo_last_step().result()
    assert (undone.kind, undone.new) == (OffsetKind.ZERO, None)
    assert [row.number for row in store.offsets.undo_last_step().result()] == [3]
    assert [row.number for row in store.offsets.read_history(2)] == [3, 54]


def older(folder: Path) -> None:
    """As the version before numbered steps: each history by itself."""
    with closing(sqlite3.connect(folder / STORE_FILE_NAME)) as connection:
        for table in ("zero_offset_changes", "tool_shape_changes"):
            connection.execute(f"UPDATE {table} SET step = step - (SELECT min(step) FROM {table}) + 1")
        connection.execute("DELETE FROM row_sums WHERE tbl IN ('zero_offset_changes', 'events')")
        connection.execute("ALTER TABLE events DROP COLUMN message")
        connection.execute("PRAGMA user_version = 14")  # histories have no sums then
        connection.commit()


def test_changes_of_older_store_are_numbered_by_time(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    clock(monkeypatch, 8, 9, 10, 11, 12, 7, 7, 7, 7)
    with Store.open(folder) as store:
        store.offsets.tool_offsets.change_row(3, "touched", {"x": 1.0}).result()
        store.offsets.zero_offsets.change_row(54, "set", {"z": -1.0}).result()
        store.offsets.tool_offsets.change_row(3, "worn", {"wear_x": 0.1}).result()
        store.offsets.tool_offsets.undo_last_step().result()
        store.offsets.zero_offsets.change_row(55, "set", {"z": -2.0}).result()
        before = [(row.kind, row.number, row.new) for row in store.offsets.read_history()]
    older(folder)
    with Store.open(folder) as store:
        assert [(row.kind, row.number, row.new) for row in store.offsets.read_history()] == before
        assert [row.step for row in store.offsets.read_history()] == [5, 4, 3, 2, 1]
        assert [row.number for row in store.offsets.undo_last_step().result()] == [55]
        with raises_code(StoreError, "nothing-to-undo"):
            for _ in range(3):
                store.offsets.tool_offsets.undo_last_step().result()
        assert store.offsets.tool_offsets.read_rows() == {}
    assert backup.find_all_store_problems(folder / STORE_FILE_NAME) == ()
    assert database.check_store_file(folder / STORE_FILE_NAME, is_thorough=True) == len(
        database.load_migrations()
    )
