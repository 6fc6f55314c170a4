"""Undo of one step of a chosen row: what it takes back, and when it refuses."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from core.store.offsets.touch_off import Touch
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_rows import Kind
from core.tool_edges import edge_key
from tests.coded import raises_code


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    with Store.open(tmp_path) as opened:
        opened.set_tool(1, "set", x=1.0, z=1.0)
        opened.set_tool(2, "set", x=2.0, z=2.0).result()
        yield opened


def undo(store: Store, number: int) -> None:
    step = store.undoable(Kind.TOOL, number)[0].step
    store.undo_step(Kind.TOOL, number, step).result()


def test_a_touch_of_the_master_goes_back_as_a_whole(store: Store) -> None:
    store.choose_master(1, "master").result()
    store.touch_off(1, Touch(x=1.5), "touch").result()
    assert store.tools()[2].x == 2.5
    undo(store, 2)
    assert (store.tools()[1].x, store.tools()[2].x) == (1.0, 2.0)


def test_a_step_of_which_another_tool_has_changed_since_is_refused(store: Store) -> None:
    store.choose_master(1, "master").result()
    store.touch_off(1, Touch(x=1.5), "touch").result()
    store.set_tool(2, "wear", wear_x=0.01).result()
    before = store.tools()
    with raises_code(StoreError, "changed-since"):
        undo(store, 1)
    assert store.tools() == before


def test_a_second_master_is_refused(store: Store) -> None:
    store.choose_master(1, "master").result()
    store.choose_master(0, "none").result()
    store.choose_master(2, "master").result()
    with raises_code(StoreError, "two-masters"):
        undo(store, 1)


def test_a_step_that_is_no_longer_the_last_is_refused(store: Store) -> None:
    asked = store.undoable(Kind.TOOL, 1)[0].step
    store.set_tool(1, "elsewhere", x=5.0).result()
    with raises_code(StoreError, "changed-since"):
        store.undo_step(Kind.TOOL, 1, asked).result()
    assert store.tools()[1].x == 5.0


def test_a_tool_with_a_further_edge_is_not_removed_by_undo(store: Store) -> None:
    store.set_tool(edge_key(2, 2), "edge", x=1.0, z=1.0).result()
    with raises_code(StoreError, "has-further-edges"):
        undo(store, 2)
    assert 2 in store.tools()
