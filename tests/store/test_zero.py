"""G54 to G59 in the store: set, kept, undone, cleared, and every change remembered."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.store.store import Store, StoreError
from core.store.store_rows import ZeroOffsetRow
from tests.coded import raises_code


def test_saved_zero_offsets_exist_after_reopening(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.offsets.zero_offsets.change_row(54, "touched", {"x": 1.5, "z": -20.0}).result()
        store.offsets.zero_offsets.change_row(54, "turned", {"c": -15.0}).result()
        store.offsets.zero_offsets.change_row(59, "other", {"z": 3.0}).result()
    with Store.open(tmp_path, read_only=True) as store:
        assert store.offsets.zero_offsets.read_rows() == {
            54: ZeroOffsetRow(1.5, -20.0, -15.0),
            59: ZeroOffsetRow(z=3.0),
        }


def test_history_is_newest_first_and_identical_value_is_no_change(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.offsets.zero_offsets.change_row(55, "one", {"z": 1.0}).result()
        store.offsets.zero_offsets.change_row(55, "again", {"z": 1.0}).result()
        store.offsets.zero_offsets.change_row(55, "two", {"z": 2.0}, who="somebody").result()
        two, one = store.offsets.zero_offsets.read_history()
        assert (two.old, two.new, two.why, two.who) == (
            ZeroOffsetRow(z=1.0),
            ZeroOffsetRow(z=2.0),
            "two",
            "somebody",
        )
        assert (one.old, one.new) == (None, ZeroOffsetRow(z=1.0))


def test_undo_goes_back_step_by_step_until_nothing_is_left(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.offsets.zero_offsets.change_row(54, "a", {"x": 1.0}).result()
        store.offsets.zero_offsets.change_row(56, "b", {"c": 90.0}).result()
        assert store.offsets.zero_offsets.remove_all_rows("all").result() == 2
        assert store.offsets.zero_offsets.read_rows() == {}
        assert {change.number for change in store.offsets.zero_offsets.undo_last_step().result()} == {54, 56}
        assert store.offsets.zero_offsets.read_rows() == {54: ZeroOffsetRow(x=1.0), 56: ZeroOffsetRow(c=90.0)}
        store.offsets.zero_offsets.undo_last_step().result()
        store.offsets.zero_offsets.undo_last_step().result()
        assert store.offsets.zero_offsets.read_rows() == {}
        with raises_code(StoreError, "nothing-to-undo"):
            store.offsets.zero_offsets.undo_last_step().result()


@pytest.mark.parametrize(
    ("code", "values", "fault"),
    [
        (53, {"x": 1.0}, "unknown-number"),
        (60, {"x": 1.0}, "unknown-number"),
        (54, {"x": 5001.0}, "out-of-range"),
        (54, {"c": 361.0}, "out-of-range"),
        (54, {"z": float("nan")}, "out-of-range"),
        (54, {"y": 1.0}, "out-of-range"),
    ],
)
def test_invalid_zero_offsets_are_rejected(
    tmp_path: Path, code: int, values: dict[str, float], fault: str
) -> None:
    with Store.open(tmp_path) as store:
        with raises_code(StoreError, fault, f"G{code}"):
            store.offsets.zero_offsets.change_row(code, "x", values).result()
        assert store.offsets.zero_offsets.read_rows() == {}
        assert store.offsets.zero_offsets.read_history() == ()


def test_tool_and_zero_offsets_are_undone_separately(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.offsets.tool_offsets.change_row(1, "t", {"x": 1.0}).result()
        store.offsets.zero_offsets.change_row(54, "z", {"x": 1.0}).result()
        store.offsets.tool_offsets.undo_last_step().result()
        assert store.offsets.zero_offsets.read_rows() == {54: ZeroOffsetRow(x=1.0)}
