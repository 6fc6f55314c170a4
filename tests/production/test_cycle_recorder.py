"""Cycles and stops from runs of the executor: times by hand, and what is no part."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.production.cycle_recorder import (
    BETWEEN_CYCLES,
    COMPLETE,
    GIVEN_UP,
    RESTARTED,
    UNCOUNTED,
    CycleRecorder,
)
from core.executor.commands import ChangeOffsets, CycleStart, FeedHold, Reset, SetPartCount, SetSwitch
from core.executor.job import Proof
from core.executor.snapshot import LogEvent, MachineState
from core.store.production import part_cycles
from core.store.production.part_cycles import CycleRow, ProductionStopRow
from core.store.store import Store
from tests.executor.rig import Rig
from tests.executor.test_changed_offsets import corrected, running
from tests.executor.test_restart import broken_off, restart

SHORT = "G90G94F300\nX.5\nX0\nM30\n"


class Recorded:
    """A rig, and what its events have left in a store."""

    def __init__(self, folder: Path) -> None:
        self.store = Store.open(folder)
        self.rig = Rig()
        self.recorder = CycleRecorder()
        self._heard = 0

    def hear(self, event: LogEvent) -> None:
        for row in self.recorder.hear(event):
            self.store.cycles.record_row(row)

    def settle(self) -> None:
        for event in self.rig.events[self._heard :]:
            self.hear(event)
        self._heard = len(self.rig.events)
        self.store.settings.save_setting("settled", True).result(60)

    @property
    def cycles(self) -> tuple[CycleRow, ...]:
        self.settle()
        with self.store.read() as connection:
            return part_cycles.read_cycles(connection, None, 100)

    @property
    def stops(self) -> tuple[ProductionStopRow, ...]:
        self.settle()
        with self.store.read() as connection:
            return part_cycles.read_stops(connection, None, 100)

    def outcomes(self) -> list[tuple[int, str]]:
        return [(row.part, row.outcome) for row in self.cycles]


@pytest.fixture
def recorded(tmp_path: Path) -> Iterator[Recorded]:
    recorded = Recorded(tmp_path)
    yield recorded
    recorded.store.close()


def test_part_is_recorded_with_time_and_number(recorded: Recorded) -> None:
    recorded.rig.post(SetPartCount(41))
    recorded.rig.start(SHORT)
    recorded.rig.until(MachineState.IDLE)
    (row,) = recorded.cycles
    assert (row.program, row.part, row.outcome) == ("PART", 42, COMPLETE)
    assert row.seconds == pytest.approx(recorded.rig.shot.last_cycle, abs=0.021)
    assert row.ended is not None


def test_each_part_of_cycle_repeat_is_recorded(recorded: Recorded) -> None:
    rig = recorded.rig
    rig.post(SetSwitch("cycle_repeat", True))
    rig.start(SHORT)
    rig.until_true(lambda shot: shot.parts == 2)
    assert recorded.cycles[-1].ended is None, "the third is under way, and a kill would find it begun"
    rig.post(SetSwitch("cycle_repeat", False))
    rig.until(MachineState.IDLE)
    assert recorded.outcomes() == [(1, COMPLETE), (2, COMPLETE), (3, COMPLETE)]
    assert recorded.cycles[1].seconds == pytest.approx(rig.shot.last_cycle, abs=0.03)


def test_feed_hold_is_recorded_as_stop_and_not_as_cycle_time(recorded: Recorded) -> None:
    rig = recorded.rig
    rig.start(SHORT)
    rig.run(0.1)
    rig.post(FeedHold("the test"))
    rig.until(MachineState.HOLD)
    rig.run(7.0)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    (row,), (stop,) = recorded.cycles, recorded.stops
    assert (stop.reason, stop.cycle) == ("FEED HOLD", row.key)
    assert stop.seconds == pytest.approx(7.0, abs=0.05)
    assert row.seconds == pytest.approx(rig.shot.last_cycle, abs=0.05)


def test_a_program_stop_has_its_name(recorded: Recorded) -> None:
    rig = recorded.rig
    rig.start("G90G94F300\nX.5\nM00\nX0\nM30\n")
    rig.until(MachineState.PROGRAM_STOP)
    rig.run(3.0)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    (stop,) = recorded.stops
    assert stop.reason.startswith("PROGRAM STOP")
    assert stop.seconds == pytest.approx(3.0, abs=0.05)


def test_time_between_starts_is_recorded_as_stop(recorded: Recorded) -> None:
    rig = recorded.rig
    rig.start(SHORT)
    rig.until(MachineState.IDLE)
    rig.run(20.0)
    rig.start(SHORT)
    rig.until(MachineState.IDLE)
    (stop,) = recorded.stops
    assert (stop.reason, stop.cycle) == (BETWEEN_CYCLES, "")
    assert stop.seconds == pytest.approx(20.3, abs=0.1)


def test_estop_is_recorded_until_next_start(recorded: Recorded) -> None:
    rig = recorded.rig
    rig.start(SHORT)
    rig.run(0.1)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.run(4.0)
    rig.sim.machine.release_estop()
    rig.until(MachineState.DISABLED)
    rig.run(2.0)
    rig.ready()
    rig.start(SHORT)
    rig.until(MachineState.IDLE)
    assert recorded.outcomes() == [(0, MachineState.ESTOP.value), (1, COMPLETE)]
    (stop,) = recorded.stops
    assert "E-STOP" in stop.reason
    assert stop.seconds == pytest.approx(7.3, abs=0.3)


def test_canceled_and_dry_runs_are_not_counted_as_parts(recorded: Recorded) -> None:
    rig = recorded.rig
    rig.start(SHORT)
    rig.run(0.1)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    rig.post(SetSwitch("no_count", True))
    rig.start(SHORT)
    rig.until(MachineState.IDLE)
    assert recorded.outcomes() == [(0, GIVEN_UP), (0, UNCOUNTED)]


def test_part_finished_after_restart_is_marked(recorded: Recorded) -> None:
    """Its time is that of the rest of it."""
    broken_off(recorded.rig)
    restart(recorded.rig, 8)
    recorded.rig.until(MachineState.IDLE)
    assert recorded.outcomes() == [(0, MachineState.ESTOP.value), (1, RESTARTED)]


def test_wait_for_proof_is_not_cycle_time(recorded: Recorded) -> None:
    rig = recorded.rig
    job = running(rig)
    rig.post(ChangeOffsets())
    rig.until(MachineState.WAIT)
    rig.run(5.0)
    new = corrected(job, -0.0254)
    rig.post(ChangeOffsets(new, Proof(new.digest, ())))
    rig.until(MachineState.RUN)
    rig.post(SetSwitch("cycle_repeat", False))
    rig.until(MachineState.IDLE)
    assert [part for part, _ in recorded.outcomes()] == [1, 2]
    assert recorded.cycles[1].seconds == pytest.approx(rig.shot.last_cycle, abs=0.05)


def test_program_without_repeat_records_no_further_part(recorded: Recorded) -> None:
    rig = recorded.rig
    job = running(rig)
    new = corrected(job, 99.0)
    rig.post(ChangeOffsets())
    rig.until(MachineState.WAIT)
    rig.run(1.0)
    rig.post(ChangeOffsets(new, Proof(new.digest, ("line 4: X leaves its travel",))))
    rig.until(MachineState.IDLE)
    assert recorded.outcomes() == [(1, COMPLETE)]


def test_events_without_cycle_record_nothing(recorded: Recorded) -> None:
    for kind, text in (
        ("state", "RUNNING"),
        ("state", "FEED HOLD"),
        ("mdi", "G90"),
        ("restart", "from line 3"),
    ):
        recorded.hear(LogEvent(0.0, kind, text))
    assert recorded.cycles == ()
    assert recorded.stops == ()


def test_spindle_load_of_part_is_recorded_with_its_cycle(recorded: Recorded) -> None:
    for kind, text in (("load", "peg.nc"), ("start", "peg.nc")):
        recorded.hear(LogEvent(0.0, kind, text))
    recorded.hear(LogEvent(9.0, "part", "part 1", part_number=1, mean_load_percent=31.5))
    recorded.hear(LogEvent(10.0, "start", "peg.nc"))
    recorded.hear(LogEvent(19.0, "part", "part 2", part_number=2))
    assert [row.load for row in recorded.cycles] == [31.5, None]
