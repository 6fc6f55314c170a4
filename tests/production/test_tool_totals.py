"""Tool life of a part that was cut or finished while no screen was connected: counted once."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.compose.runs.journal import Journal
from app.production.parts_book import read_production_data
from app.production.tool_life_watch import ToolLifeMonitor
from app.production.tool_totals import TOTALS_SETTING, ToolUseTotals
from core.executor.snapshot import MachineState, Snapshot
from core.store.store import Store
from core.store.store_rows import OffsetKind

CUT = Snapshot(state=MachineState.RUN)


class Screen:
    """A screen on this data folder that is connected to a control."""

    def __init__(self, folder: Path, control: str = "control") -> None:
        self.journal = Journal(folder, control_running=True)
        self.control = control
        book = self.journal.create_parts_book(OffsetKind.TOOL)
        book.user_access.persistence = self.journal
        assert book.store is not None
        book.current_data, book.load_count = read_production_data(book.store, "", OffsetKind.TOOL, {}), 1
        self.watch = ToolLifeMonitor(book, lambda: self.control)

    def see(self, ends: int, state: MachineState = MachineState.RUN, **seconds: float) -> None:
        """A frame in which the tools have cut for so many seconds."""
        cutting = {int(name[1:]): value for name, value in seconds.items()}
        self.watch.process_snapshot(replace(CUT, state=state, ends=ends, cutting=cutting), lambda _: None)

    def end(self) -> None:
        """As a killed screen: what was posted is written, and nothing more."""
        self.journal.close()


def lives(folder: Path) -> dict[int, tuple[int, float]]:
    """Parts and seconds of each tool, as the disk has them."""
    with Store.open(folder, read_only=True) as store:
        rows = read_production_data(store, "", OffsetKind.TOOL, {}).tool_lives
    return {number: (row.parts, row.seconds) for number, row in rows.items()}


def test_a_part_that_was_finished_without_a_screen_is_counted_once(tmp_path: Path) -> None:
    first = Screen(tmp_path)
    first.see(0)
    first.see(0, T1=12.0)  # stored, because it is more than 10 s
    first.see(0, T1=14.0, T2=3.0)  # not stored
    first.end()
    assert lives(tmp_path) == {1: (0, 12.0)}
    second = Screen(tmp_path)
    second.see(1, MachineState.IDLE, T1=20.0, T2=9.0)  # it was finished meanwhile
    second.end()
    assert lives(tmp_path) == {1: (1, 20.0), 2: (1, 9.0)}
    third = Screen(tmp_path)
    third.see(1, MachineState.IDLE, T1=20.0, T2=9.0)
    third.see(1, MachineState.IDLE, T1=20.0, T2=9.0)
    third.end()
    assert lives(tmp_path) == {1: (1, 20.0), 2: (1, 9.0)}


def test_cutting_time_before_screen_loss_belongs_to_part(tmp_path: Path) -> None:
    first = Screen(tmp_path)
    first.see(0)
    first.see(0, T1=11.0)
    first.end()
    second = Screen(tmp_path)
    second.see(0, T1=11.0, T2=12.0)
    second.see(1, MachineState.IDLE, T1=11.0, T2=12.0)
    second.end()
    assert lives(tmp_path) == {1: (1, 11.0), 2: (1, 12.0)}


@pytest.mark.parametrize("control", ["another", ""])
def test_totals_of_another_control_are_not_used(tmp_path: Path, control: str) -> None:
    first = Screen(tmp_path)
    first.see(0)
    first.see(1, T1=30.0)
    first.end()
    second = Screen(tmp_path, control)
    second.see(0, T1=0.0)
    second.see(1, MachineState.IDLE, T1=5.0)
    second.end()
    assert lives(tmp_path) == {1: (2, 35.0)}


def test_replacement_control_starts_with_its_own_totals(tmp_path: Path) -> None:
    screen = Screen(tmp_path)
    screen.see(0)
    screen.see(3, T1=30.0)
    screen.control = "another"
    screen.see(0, MachineState.DISABLED)
    screen.see(1, MachineState.IDLE, T1=5.0)
    screen.end()
    assert lives(tmp_path) == {1: (4, 35.0)}


def test_control_in_screen_process_stores_no_totals(tmp_path: Path) -> None:
    screen = Screen(tmp_path, "")
    screen.see(0)
    screen.see(1, MachineState.IDLE, T1=5.0)
    assert screen.journal.read_setting(TOTALS_SETTING) is None
    screen.end()
    assert lives(tmp_path) == {1: (1, 5.0)}


def test_totals_are_the_same_after_they_were_stored() -> None:
    totals = ToolUseTotals("control", 4, {1: 2.5, 12: 0.0}, frozenset({12}))
    assert ToolUseTotals.from_setting(totals.setting_value) == totals


@pytest.mark.parametrize(
    "change",
    [
        {"control": 3},
        {"ends": "4"},
        {"cut": {"x": 1.0}},
        {"cut": {"1": "x"}},
        {"cut": []},
        {"in_part": ["x"]},
    ],
)
def test_damaged_totals_are_ignored(change: dict[str, object]) -> None:
    plain = ToolUseTotals("control", 4, {1: 2.5}, frozenset({1})).setting_value
    assert ToolUseTotals.from_setting(plain | change) is None
    assert ToolUseTotals.from_setting(None) is None
