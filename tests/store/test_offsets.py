"""Offsets: what is set, what is kept, what is refused, and the way back."""

from __future__ import annotations

from math import inf, nan

import pytest

from core.store.store import Store, StoreError
from core.store.store_rows import OffsetKind, SecondaryOffsetRow, ToolOffsetRow, convert_to_inches
from tests.coded import raises_code


def test_new_store_has_no_offsets(store: Store) -> None:
    assert store.offsets.tool_offsets.read_rows() == {}
    assert store.offsets.secondary_offsets.read_rows() == {}
    assert store.offsets.read_history() == ()


def test_setting_one_value_leaves_the_others_unchanged(store: Store) -> None:
    store.offsets.tool_offsets.change_row(
        3, "touched off", {"x": 31.75, "z": -12.7, "nose_radius": 0.381}
    ).result()
    assert store.offsets.tool_offsets.change_row(3, "again", {"z": -12.5}).result() == ToolOffsetRow(
        31.75, -12.5, 0.381
    )
    assert store.offsets.tool_offsets.read_rows() == {3: ToolOffsetRow(31.75, -12.5, 0.381)}


def test_tool_and_secondary_offsets_are_separate(store: Store) -> None:
    store.offsets.tool_offsets.change_row(4, "tool", {"x": 1.0})
    store.offsets.secondary_offsets.change_row(4, "wear", {"x": -0.0127}).result()
    assert store.offsets.tool_offsets.read_rows() == {4: ToolOffsetRow(1.0, 0.0, 0.0)}
    assert store.offsets.secondary_offsets.read_rows() == {4: SecondaryOffsetRow(-0.0127, 0.0, 0.0)}


def test_history_lists_old_and_new_value_reason_and_user(store: Store) -> None:
    store.offsets.secondary_offsets.change_row(1, "size too big", {"x": -0.01}, who="night shift")
    store.offsets.secondary_offsets.change_row(1, "and again", {"x": -0.02}).result()
    newest, oldest = store.offsets.read_history()
    assert (oldest.old, oldest.new) == (None, (-0.01, 0.0, 0.0))
    assert (oldest.why, oldest.who) == ("size too big", "night shift")
    assert (newest.old, newest.new, newest.kind) == (
        (-0.01, 0.0, 0.0),
        (-0.02, 0.0, 0.0),
        OffsetKind.SECONDARY,
    )
    assert newest.id > oldest.id
    assert newest.at.endswith("Z")


def test_history_is_filtered_by_table_and_limited(store: Store) -> None:
    for number in (1, 2, 3):
        store.offsets.tool_offsets.change_row(number, "t", {"x": 1.0})
    store.offsets.secondary_offsets.change_row(7, "d", {"x": 1.0}).result()
    assert [change.number for change in store.offsets.tool_offsets.read_history(limit=2)] == [3, 2]


def test_identical_value_is_not_a_change(store: Store) -> None:
    store.offsets.tool_offsets.change_row(1, "first", {"x": 2.0})
    store.offsets.tool_offsets.change_row(1, "same", {"x": 2.0}).result()
    assert len(store.offsets.read_history()) == 1


def test_clear_is_one_step_and_undo_restores_all(store: Store) -> None:
    store.offsets.tool_offsets.change_row(1, "stays", {"x": 9.0})
    store.offsets.secondary_offsets.change_row(1, "a", {"x": 1.0})
    store.offsets.secondary_offsets.change_row(2, "b", {"r": 0.5})
    assert store.offsets.secondary_offsets.remove_all_rows("new job").result() == 2
    assert store.offsets.secondary_offsets.read_rows() == {}
    assert len(store.offsets.undo_last_step().result()) == 2
    assert store.offsets.secondary_offsets.read_rows() == {
        1: SecondaryOffsetRow(1.0, 0.0, 0.0),
        2: SecondaryOffsetRow(0.0, 0.0, 0.5),
    }
    assert store.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(9.0, 0.0, 0.0)}


def test_undo_goes_back_one_more_step_each_time(store: Store) -> None:
    for x in (1.0, 2.0, 3.0):
        store.offsets.tool_offsets.change_row(5, "wear", {"x": x})
    store.offsets.undo_last_step().result()
    assert store.offsets.tool_offsets.read_rows()[5].x == 2.0
    store.offsets.tool_offsets.change_row(5, "other", {"x": 7.0})
    store.offsets.undo_last_step()
    store.offsets.undo_last_step().result()
    assert store.offsets.tool_offsets.read_rows()[5].x == 1.0
    store.offsets.undo_last_step().result()
    assert store.offsets.tool_offsets.read_rows() == {}
    with raises_code(StoreError, "nothing-to-undo"):
        store.offsets.undo_last_step().result()


@pytest.mark.parametrize("number", [0, 33, -1])
def test_number_outside_the_table_is_refused(store: Store, number: int) -> None:
    with raises_code(StoreError, "unknown-number", "T1…32"):
        store.offsets.tool_offsets.change_row(number, "no", {"x": 1.0}).result()
    with raises_code(StoreError, "unknown-number", "D1…32"):
        store.offsets.secondary_offsets.change_row(number, "no", {"x": 1.0}).result()
    assert store.offsets.read_history() == ()


@pytest.mark.parametrize(
    ("x", "z", "r"), [(1270.1, 0, 0), (0, -1270.1, 0), (nan, 0, 0), (0, inf, 0), (0, 0, -0.001), (0, 0, 51)]
)
def test_value_out_of_range_changes_nothing(store: Store, x: float, z: float, r: float) -> None:
    with raises_code(StoreError, "out-of-range"):
        store.offsets.tool_offsets.change_row(1, "no", {"x": x, "z": z, "nose_radius": r}).result()
    assert store.offsets.tool_offsets.read_rows() == {}
    assert store.write_error == ""  # a refusal is no trouble of the disk


def test_secondary_offset_has_narrower_range(store: Store) -> None:
    with raises_code(StoreError, "out-of-range", "-10…10 in"):
        store.offsets.secondary_offsets.change_row(1, "no", {"x": 254.1}).result()


@pytest.mark.parametrize("entered", [1.25, -0.0005, 0.00005, 3.99995, 0.015])
def test_inch_values_are_returned_as_entered(entered: float) -> None:
    assert convert_to_inches(entered * 25.4) == entered


def test_history_without_limit_includes_oldest_change_of_all_tables(store: Store) -> None:
    store.offsets.tool_offsets.change_row(3, "first", {"x": 1.0})
    store.offsets.secondary_offsets.change_row(1, "second", {"x": -0.01})
    store.offsets.zero_offsets.change_row(54, "third", {"z": -120.0}).result()
    assert {change.why for change in store.offsets.read_history(limit=-1)} == {"first", "second", "third"}
    assert [change.why for change in store.offsets.read_history(limit=2)] == [
        change.why for change in store.offsets.read_history(limit=-1)[:2]
    ]
    assert store.offsets.read_history(limit=0) == ()
