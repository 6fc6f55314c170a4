"""What the record makes of snapshots: runs that end well, badly, or again and again."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from app.desk.persistence import NullRunRecords, Persistence
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase
from app.programs.run_history import RunHistory
from core.executor.job import Proof
from core.executor.snapshot import Alarm, MachineState, Snapshot
from core.language.source import ProgramSource
from core.store.store_errors import StoreError

READY = Snapshot(state=MachineState.IDLE, program="/programs/pin.nc")
RUNNING = replace(READY, state=MachineState.RUN, block=3)
NO_PROGRAM = LoadedProgram()


@dataclass(frozen=True)
class WrittenDown(NullRunRecords):
    """Writes down what is recorded."""

    told: list[tuple[object, ...]] = field(default_factory=list)

    def record_run_start(self, program: str) -> None:
        self.told.append(("started", program))

    def record_run_end(self, program: str, outcome: str) -> None:
        self.told.append(("ended", program, outcome))

    def record_cycle(self, program: str, seconds: float) -> None:
        self.told.append(("cycle", program, seconds))

    def record_proof(self, program: str, result: str, planned: float | None, text: str | None = None) -> None:
        self.told.append(("proved", program, result, planned, text))


@dataclass
class Kept(Persistence):
    """A store whose run records are written down."""

    records: WrittenDown = field(default_factory=WrittenDown)

    @property
    def runs(self) -> NullRunRecords:
        return self.records

    @property
    def told(self) -> list[tuple[object, ...]]:
        return self.records.told


def told(*snapshots: Snapshot) -> list[tuple[object, ...]]:
    keep = Kept()
    record = RunHistory(keep)
    for snapshot in snapshots:
        record.process_snapshot(snapshot, NO_PROGRAM)
    return keep.told


def test_whole_cycle_is_recorded() -> None:
    done = replace(READY, parts=1, timed_cycle_count=1, last_cycle=12.5)
    assert told(READY, RUNNING, RUNNING, done, done) == [
        ("started", "pin.nc"),
        ("cycle", "pin.nc", 12.5),
        ("ended", "pin.nc", "COMPLETE"),
    ]


@pytest.mark.parametrize("before", [0.0, 12.5])
def test_a_part_that_a_restart_has_finished_has_no_cycle_time(before: float) -> None:
    """Behind a power cut it was kept as 0 s, the best of all for ever; else as that of the part before."""
    ready, running = (replace(each, timed_cycle_count=4, last_cycle=before) for each in (READY, RUNNING))
    assert told(ready, running, replace(ready, parts=1)) == [
        ("started", "pin.nc"),
        ("ended", "pin.nc", "COMPLETE"),
    ]


def test_cycle_repeat_records_each_run() -> None:
    again = replace(RUNNING, parts=1, timed_cycle_count=1, last_cycle=12.5)
    assert told(READY, RUNNING, again, again) == [
        ("started", "pin.nc"),
        ("cycle", "pin.nc", 12.5),
        ("ended", "pin.nc", "COMPLETE"),
        ("started", "pin.nc"),
    ]


@pytest.mark.parametrize(
    ("last", "outcome"),
    [
        (READY, "GIVEN UP"),
        (replace(READY, state=MachineState.ESTOP), "E-STOP"),
        (
            replace(READY, state=MachineState.FAULT, alarms=(Alarm(102, "following", "", "", ""),)),
            "ALARM 102",
        ),
    ],
)
def test_run_that_ends_abnormally_is_recorded_with_outcome(last: Snapshot, outcome: str) -> None:
    held = replace(RUNNING, state=MachineState.HOLD)
    assert told(READY, RUNNING, held, last)[-1] == ("ended", "pin.nc", outcome)


def test_parts_made_before_screen_started_are_not_recorded() -> None:
    assert told(replace(READY, parts=7), replace(READY, parts=7)) == []


def test_jogging_is_not_recorded_as_run() -> None:
    assert told(READY, replace(READY, state=MachineState.JOG), READY) == []


def test_mdi_line_is_not_recorded_as_program_run() -> None:
    line = replace(RUNNING, lines=1)
    after = replace(READY, lines=1)
    assert told(READY, line, line, after) == []
    assert told(READY, line, after, replace(RUNNING, lines=1)) == [("started", "pin.nc")]


def test_proof_is_recorded_once() -> None:
    keep = Kept()
    record = RunHistory(keep)
    proof = Proof(digest="x", errors=(), block_count=3, cycle_time_s=9.5, tool_numbers=())
    loaded = LoadedProgram(
        LoadingPhase.READY, Path("pin.nc"), source=ProgramSource("pin.nc", "M30\n"), proof=proof
    )
    for _ in range(3):
        record.process_snapshot(READY, loaded)
    record.process_snapshot(
        READY, LoadedProgram(LoadingPhase.UNREADABLE, Path("pin.nc"), error_text="gone")
    )  # has no text to belong to
    assert keep.told == [("proved", "pin.nc", "PROVED", 9.5, "M30\n")]


def test_failed_store_does_not_stop_run_history() -> None:
    class Broken(WrittenDown):
        def record_run_start(self, program: str) -> None:
            raise StoreError(f"the disk is full: {program}")

    record = RunHistory(Kept(records=Broken()))
    for snapshot in (READY, RUNNING, READY):
        record.process_snapshot(snapshot, NO_PROGRAM)
    assert record.running_program == ""


def test_run_without_counted_part_has_no_cycle_time() -> None:
    done = replace(READY, ends=1, last_cycle=3.0)
    assert told(READY, RUNNING, done, done) == [("started", "pin.nc"), ("ended", "pin.nc", "NOT COUNTED")]
