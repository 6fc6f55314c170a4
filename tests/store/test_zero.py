"""G54 to G59 in the store: set, kept, undone, cleared, and every change remembered."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.store.store import Store, StoreError
from core.store.store_rows import ZeroRow


def test_what_is_set_is_there_again(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.set_zero(54, "touched", {"x": 1.5, "z": -20.0}).result()
        store.set_zero(54, "turned", {"c": -15.0}).result()
        store.set_zero(59, "other", {"z": 3.0}).result()
    with Store.open(tmp_path, read_only=True) as store:
        assert store.zero_offsets() == {54: ZeroRow(1.5, -20.0, -15.0), 59: ZeroRow(z=3.0)}


def test_history_newest_first_and_the_same_again_is_no_change(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.set_zero(55, "one", {"z": 1.0}).result()
        store.set_zero(55, "again", {"z": 1.0}).result()
        store.set_zero(55, "two", {"z": 2.0}, who="somebody").result()
        two, one = store.zero_history()
        assert (two.old, two.new, two.why, two.who) == (ZeroRow(z=1.0), ZeroRow(z=2.0), "two", "somebody")
        assert (one.old, one.new) == (None, ZeroRow(z=1.0))


def test_undo_goes_back_step_by_step(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.set_zero(54, "a", {"x": 1.0}).result()
        store.set_zero(56, "b", {"c": 90.0}).result()
        assert store.clear_zero("all").result() == 2
        assert store.zero_offsets() == {}
        assert {change.code for change in store.undo_zero().result()} == {54, 56}
        assert store.zero_offsets() == {54: ZeroRow(x=1.0), 56: ZeroRow(c=90.0)}
        store.undo_zero().result()
        store.undo_zero().result()
        assert store.zero_offsets() == {}
        with pytest.raises(StoreError, match="no change"):
            store.undo_zero().result()


@pytest.mark.parametrize(
    ("code", "values", "told"),
    [
        (53, {"x": 1.0}, "G53 does not exist"),
        (60, {"x": 1.0}, "G54…G59"),
        (54, {"x": 5001.0}, "out of range"),
        (54, {"c": 361.0}, "degrees"),
        (54, {"z": float("nan")}, "out of range"),
        (54, {"y": 1.0}, "out of range"),
    ],
)
def test_refused(tmp_path: Path, code: int, values: dict[str, float], told: str) -> None:
    with Store.open(tmp_path) as store:
        with pytest.raises(StoreError, match=told):
            store.set_zero(code, "x", values).result()
        assert store.zero_offsets() == {}
        assert store.zero_history() == ()


def test_tools_and_settable_offsets_do_not_undo_each_other(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.set_tool(1, "t", x=1.0).result()
        store.set_zero(54, "z", {"x": 1.0}).result()
        store.undo_offset().result()
        assert store.zero_offsets() == {54: ZeroRow(x=1.0)}
