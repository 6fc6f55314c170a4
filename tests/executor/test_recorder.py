"""The recorder of the scope: what the executor hands over is what was done, and it waits for nobody."""

from __future__ import annotations

import dataclasses
import errno
import os
import re
from pathlib import Path

import numpy as np
import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import CycleStart, EnableDrives
from core.executor.executor import Executor
from core.executor.scope_recorder import ScopeRecorder, delete_oldest_records, list_recorded_signals
from core.executor.snapshot import LogEvent, MachineState, TickData
from core.machine.hardware_model import AnalogInputModel
from core.ports import ALL_UNKNOWN_PARTS, DriverError, FloatArray, SampleSource, UnknownPart
from core.records.record import RecordError
from core.records.record_file import open_record
from core.records.recordings import MAX_ALARM_RECORDS
from core.records.ring_file import CURRENT_RING_NAME, read_ring_file
from tests.executor.rig import FINE, INCH, Rig
from tests.texts import pattern

PART = "G90G94\nM03S600\nM08\nG01X.2Z-.2F20\nX0Z0\nM30\n"


class Recorded(Rig):
    """A rig that is recorded."""

    folder: Path | None = None
    own: bool = True  # whether the driver has samples of its own
    recorder: ScopeRecorder

    def __post_init__(self) -> None:
        self.every = FINE
        super().__post_init__()
        ports = self.sim.ports if self.own else dataclasses.replace(self.sim.ports, samples=None)
        self.recorder = ScopeRecorder(list_recorded_signals(self.machine, ports), self.folder)

        def hear(event: LogEvent) -> None:
            self.events.append(self.recorder.add_record_name(event))

        self.executor = Executor(
            self.machine, ports, hear, self._passes, record_tick=self.recorder.queue_tick
        )
        self.executor.run_tick()

    def make_part(self) -> None:
        """One part."""
        self.post(EnableDrives())
        self.load(PART)
        self.post(CycleStart())
        self.until(MachineState.RUN)
        self.until(MachineState.IDLE)


def rig(folder: Path | None = None, *, own: bool = True) -> Recorded:
    kind = type("OneRecorded", (Recorded,), {"folder": folder, "own": own})
    made: Recorded = kind()
    return made


def test_a_part_is_recorded_with_line_block_state_and_outputs() -> None:
    it = rig()
    it.make_part()
    it.recorder.store_queued_ticks()
    record = it.recorder.get_record_between(-np.inf, np.inf)
    columns = record.values_by_channel
    assert record.sampling_rate_hz == 1000.0
    assert columns["X demand"].max() == pytest.approx(0.2 * INCH, abs=1e-3)
    assert columns["Z demand"].min() == pytest.approx(-0.2 * INCH, abs=1e-3)
    feeding = columns["line"] == 4
    assert feeding.sum() == pytest.approx(1000 * np.hypot(0.2, 0.2) / 20 * 60, rel=0.1)
    assert set(columns["output coolant"][feeding]) == {1.0}
    states = record.about["states"].split("|")
    assert {states[int(each)] for each in columns["state"][feeding]} == {"RUNNING"}
    assert columns["queue"][feeding].max() > 0.2
    assert np.diff(record.times_s[feeding]) == pytest.approx(0.001, abs=1e-9)


def test_driver_without_samples_is_recorded_once_per_tick() -> None:
    it = rig(own=False)
    it.make_part()
    it.recorder.store_queued_ticks()
    record = it.recorder.get_record_between(-np.inf, np.inf)
    moving = record.values_by_channel["line"] == 4
    assert record.sampling_rate_hz == 100.0
    assert np.diff(record.times_s[moving]) == pytest.approx(0.01, abs=1e-9)
    assert record.values_by_channel["X demand"].max() == pytest.approx(0.2 * INCH, abs=1e-3)
    assert np.isnan(record.values_by_channel["X load"]).all()
    assert record.values_by_channel["spindle turns"].max() > 5.0
    assert record.values_by_channel["queue"].max() > 0.2


class Loadless:
    """The driver's samples without the load of its spindle."""

    def __init__(self, source: SampleSource) -> None:
        self._source, self.sample_rate_hz = source, source.sample_rate_hz

    def take_samples(self, max_rows: int = 8192) -> FloatArray:
        rows = self._source.take_samples(max_rows).copy()
        rows[:, -2] = np.nan
        return rows


@pytest.mark.parametrize("own", [True, False])
def test_load_input_fills_gaps_in_the_samples(own: bool) -> None:
    machine = load_machine()
    pots = {"spindle_load": AnalogInputModel("spindle_load", "AI-1", (0.0, 150.0))}
    hardware = dataclasses.replace(machine.hardware, analog_inputs=pots)
    kind = type("LoadRecorded", (Recorded,), {"own": own})
    it: Recorded = kind(machine=dataclasses.replace(machine, hardware=hardware))
    source = it.sim.ports.samples
    assert source is not None
    if own:
        it.executor._ports = dataclasses.replace(it.executor._ports, samples=Loadless(source))
    told: list[float] = []
    it.watch.append(lambda shot: told.append(shot.spindle_load or 0.0))
    it.make_part()
    it.recorder.store_queued_ticks()
    columns = it.recorder.get_record_between(-np.inf, np.inf).values_by_channel
    assert max(told) > 10.0
    assert np.nanmax(columns["spindle load"]) == pytest.approx(max(told))


@pytest.mark.parametrize("own", [True, False])
def test_machine_at_rest_records_ten_rows_per_second(own: bool) -> None:
    it = rig(own=own)
    it.run(10.0)
    it.recorder.store_queued_ticks()
    assert it.recorder.ring.ticks.completed_row_count == pytest.approx(100, abs=12)
    assert it.recorder.ring.samples.completed_row_count == pytest.approx(100, abs=12)


def test_late_tick_at_rest_is_recorded() -> None:
    it = rig()
    it.run(1.0)
    it.tick(0.08)
    it.run(0.5)
    it.recorder.store_queued_ticks()
    assert it.recorder.get_record_between(0.0, 9.0, ("lateness",)).values_by_channel[
        "lateness"
    ].max() == pytest.approx(0.07)


def test_failing_sample_driver_stops_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    it = rig()

    def broken() -> FloatArray:
        raise DriverError("no samples")

    monkeypatch.setattr(it.sim.ports.samples, "take_samples", broken)
    it.make_part()
    assert it.shot.alarms == ()


def test_recorder_exception_stops_nothing_and_is_logged_once(caplog: pytest.LogCaptureFixture) -> None:
    it = Rig()

    def raises(_tick: TickData) -> None:
        raise ValueError("no room")

    it.executor = Executor(it.machine, it.sim.ports, it.events.append, record_tick=raises)
    it.post(EnableDrives())
    it.run(0.1)
    assert it.state is MachineState.IDLE
    assert it.shot.alarms == ()
    assert [each.message for each in caplog.records] == ["the scope misses what the machine does"]


# --- alarms ----------------------------------------------------------------------------------------------


def test_alarm_record_spans_ten_seconds_before_until_rest(tmp_path: Path) -> None:
    it = rig(tmp_path)
    it.post(EnableDrives())
    it.run(11.0)
    it.load(PART)
    it.post(CycleStart())
    it.until(MachineState.RUN)
    it.run(1.2)
    it.recorder.store_queued_ticks()
    it.sim.machine.drive_fault("X", "overcurrent")
    it.until(MachineState.FAULT)
    for _ in range(300):
        it.tick()
        it.recorder.store_queued_ticks()
    (alarm,) = [event for event in it.events if event.kind == "alarm"]
    assert alarm.alarm is not None
    assert alarm.record_name.endswith(f"-alarm{alarm.alarm.number}.scope")
    record = open_record(tmp_path / alarm.record_name)
    assert record.times_s[0] == pytest.approx(alarm.time_s - 10.0, abs=0.11)
    assert alarm.time_s + 0.2 < record.times_s[-1] < alarm.time_s + 2.001
    assert float(record.about["alarm time"]) == alarm.time_s
    assert record.about["alarm"].startswith(f"{alarm.alarm.number} ")
    assert record.about["program"] == "PART"
    assert abs(record.values_by_channel["spindle speed"][-1]) < 1.0 or record.times_s[-1] > alarm.time_s + 1.9
    np.testing.assert_array_equal(it.recorder.open_alarm_record(alarm.record_name).times_s, record.times_s)
    assert not [each for each in tmp_path.iterdir() if each.name.endswith(".part")]


def test_simultaneous_alarms_share_a_record_that_close_writes(tmp_path: Path) -> None:
    it = rig(tmp_path)
    it.post(EnableDrives())
    it.run(0.5)
    it.sim.machine.drive_fault("X", "overcurrent")
    it.run(0.05)
    it.sim.machine.press_estop()
    it.run(0.05)
    it.recorder.close()
    names = {event.record_name for event in it.events if event.kind in {"alarm", "estop"}}
    assert len(names) == 1
    assert open_record(tmp_path / names.pop()).times_s.size > 5


def test_missing_alarm_record_is_reported(tmp_path: Path) -> None:
    it = rig(tmp_path)
    it.post(EnableDrives())
    it.sim.machine.drive_fault("X", "overcurrent")
    it.run(0.05)
    it.recorder.store_queued_ticks()
    (name,) = {event.record_name for event in it.events if event.kind == "alarm"}
    with pytest.raises(RecordError, match=pattern("executor.record-being-written")):
        it.recorder.open_alarm_record(name)
    it.recorder.close()
    assert it.recorder.open_alarm_record(name).times_s.size
    for gone in ("20250101T000000-alarm507.scope", f"../{tmp_path.name}/{name}", "now.ring/"):
        with pytest.raises(RecordError, match=pattern("executor.record-gone", number=50)):
            it.recorder.open_alarm_record(gone)
    with pytest.raises(RecordError, match=pattern("executor.record-gone")):
        rig().recorder.open_alarm_record(name)


def test_normal_stop_writes_no_record(tmp_path: Path) -> None:
    it = rig(tmp_path)
    it.make_part()
    it.recorder.close()
    assert {event.record_name for event in it.events} == {""}
    assert [each.name for each in tmp_path.iterdir()] == [CURRENT_RING_NAME]


def test_oldest_alarm_records_are_deleted(tmp_path: Path) -> None:
    for n in range(MAX_ALARM_RECORDS + 3):
        (tmp_path / f"20260101T1200{n:02d}-alarm507.scope").write_bytes(b"")
    (tmp_path / "mine.scope").write_bytes(b"")
    delete_oldest_records(tmp_path)
    left = sorted(each.name for each in tmp_path.iterdir())
    assert len(left) == MAX_ALARM_RECORDS + 1
    assert left[0] == "20260101T120003-alarm507.scope"
    assert left[-1] == "mine.scope"


# --- the file --------------------------------------------------------------------------------------------


def test_ring_file_matches_the_record_in_memory(tmp_path: Path) -> None:
    it = rig(tmp_path)
    it.make_part()
    it.recorder.close()
    kept, found = (
        it.recorder.get_record_between(-np.inf, np.inf),
        read_ring_file(tmp_path / CURRENT_RING_NAME),
    )
    np.testing.assert_array_equal(found.times_s, kept.times_s)
    for name in ("X demand", "Z actual", "line", "output coolant", "spindle turns"):
        np.testing.assert_array_equal(found.values_by_channel[name], kept.values_by_channel[name], name)


def test_full_disk_is_reported_and_recording_continues_in_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_fd: int, _at: int, _size: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", full)
    it = rig(tmp_path)
    full_disk = pattern("executor.disk-full", path="now.ring")
    assert re.search(full_disk, it.recorder.storage_error)
    assert re.fullmatch(pattern("executor.record-in-memory"), it.recorder.storage_error)
    it.make_part()
    it.recorder.store_queued_ticks()
    assert it.recorder.get_record_between(-np.inf, np.inf).values_by_channel["X demand"].max() > 5.0
    it.recorder.close()


def test_later_disk_failure_ends_the_file_but_not_the_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    it = rig(tmp_path)
    it.run(1.0)
    it.recorder.store_queued_ticks()

    def fails(*_: object) -> int:
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(os, "pwrite", fails)
    it.make_part()
    it.recorder.store_queued_ticks()
    monkeypatch.undo()
    assert "now.ring: Input/output error" in it.recorder.storage_error
    assert it.recorder.get_record_between(-np.inf, np.inf).values_by_channel["X demand"].max() > 5.0
    assert read_ring_file(tmp_path / CURRENT_RING_NAME).times_s.size >= 10


@pytest.mark.parametrize("own", [True, False])
def test_record_has_a_gap_while_the_machine_is_silent(own: bool) -> None:
    """0.5 s without a word, then it is heard again: nothing is drawn across."""
    it = rig(own=own)
    it.make_part()
    unknown: list[frozenset[UnknownPart]] = [frozenset()]
    it.executor._ports = dataclasses.replace(it.executor._ports, unknown=lambda: unknown[0])
    it.run(0.2)
    lost, unknown[0] = it.executor._ports.clock.now(), ALL_UNKNOWN_PARTS
    it.run(0.5)
    back, unknown[0] = it.executor._ports.clock.now(), frozenset()
    it.run(0.5)
    it.recorder.store_queued_ticks()
    record = it.recorder.get_record_between(lost - 0.1, back + 0.3)
    dark = (record.times_s > lost + 0.0099) & (record.times_s < back - 0.02)
    assert dark.sum() == 1
    for name in ("X actual", "X demand", "spindle speed", "output collet"):
        assert np.isnan(record.values_by_channel[name][dark]).all()
        assert np.isfinite(record.values_by_channel[name][[0, -1]]).all()
