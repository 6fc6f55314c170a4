"""Undo of one step of a chosen row: what it takes back, and when it refuses."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from core.store.offsets.touch_off import TouchPosition
from core.store.store import Store
from core.store.store_errors import StoreError
from core.tool_edges import make_edge_row_number
from tests.coded import raises_code


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store.open(tmp_path) as opened:
        opened.offsets.tool_offsets.change_row(1, "set", {"x": 1.0, "z": 1.0})
        opened.offsets.tool_offsets.change_row(2, "set", {"x": 2.0, "z": 2.0}).result()
        yield opened


def undo(store: Store, number: int) -> None:
    step = store.offsets.tool_offsets.find_undoable_changes(number)[0].step
    store.offsets.tool_offsets.undo_step(number, step).result()


def test_master_touch_is_undone_as_a_whole(store: Store) -> None:
    store.offsets.tool_offsets.set_master_tool(1, "master").result()
    store.offsets.tool_offsets.set_touched_offset(1, TouchPosition(x=1.5), "touch").result()
    assert store.offsets.tool_offsets.read_rows()[2].x == 2.5
    undo(store, 2)
    assert (store.offsets.tool_offsets.read_rows()[1].x, store.offsets.tool_offsets.read_rows()[2].x) == (
        1.0,
        2.0,
    )


def test_undo_is_rejected_if_another_tool_of_the_step_has_changed(store: Store) -> None:
    store.offsets.tool_offsets.set_master_tool(1, "master").result()
    store.offsets.tool_offsets.set_touched_offset(1, TouchPosition(x=1.5), "touch").result()
    store.offsets.tool_offsets.change_row(2, "wear", {"wear_x": 0.01}).result()
    before = store.offsets.tool_offsets.read_rows()
    with raises_code(StoreError, "changed-since"):
        undo(store, 1)
    assert store.offsets.tool_offsets.read_rows() == before


def test_undo_that_would_make_a_second_master_is_rejected(store: Store) -> None:
    store.offsets.tool_offsets.set_master_tool(1, "master").result()
    store.offsets.tool_offsets.set_master_tool(0, "none").result()
    store.offsets.tool_offsets.set_master_tool(2, "master").result()
    with raises_code(StoreError, "two-masters"):
        undo(store, 1)


def test_undo_of_step_that_is_not_the_last_is_rejected(store: Store) -> None:
    asked = store.offsets.tool_offsets.find_undoable_changes(1)[0].step
    store.offsets.tool_offsets.change_row(1, "elsewhere", {"x": 5.0}).result()
    with raises_code(StoreError, "changed-since"):
        store.offsets.tool_offsets.undo_step(1, asked).result()
    assert store.offsets.tool_offsets.read_rows()[1].x == 5.0


def test_undo_does_not_remove_tool_with_another_edge(store: Store) -> None:
    store.offsets.tool_offsets.change_row(make_edge_row_number(2, 2), "edge", {"x": 1.0, "z": 1.0}).result()
    with raises_code(StoreError, "has-further-edges"):
        undo(store, 2)
    assert 2 in store.offsets.tool_offsets.read_rows()
