"""Scope recorder, which stores the data of the executor's ticks for the last few minutes.

The executor only appends to a queue. A separate thread moves the queued data into a ring buffer ten times
per second, or twice per second while the machine is at rest. When an alarm occurs, the thread also saves
the data that precedes it to a file.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from core.executor.raised_alarm import ErrorCatcher
from core.executor.snapshot import LogEvent, MachineState, Snapshot, TickData
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import FloatArray, MachinePorts, UnknownPart
from core.records.record import RecordError
from core.records.record_file import RECORD_SUFFIX, save_record
from core.records.record_ring import TICK_RATE_HZ, RingLayout, RowBuffer, ScopeRing, pack_bits
from core.records.recordings import MAX_ALARM_RECORDS, ScopeRecordings
from core.records.ring_file import CURRENT_RING_NAME, RingFile, create_ring_file

_log = logging.getLogger(__name__)
_NAN = float("nan")
_POLL_INTERVAL_S = 0.1  # s between two passes through the queue
_REST_PAUSE_S = 0.5  # additional s while nothing happens
_REST_ROW_INTERVAL_S = 0.1  # s between two rows while no value changes
_TIME_RESOLUTION_S = 0.005  # s; half a tick
_MAX_QUEUED_TICKS = 12_000  # largest number of queued ticks: 2 min
BEFORE, BEHIND = 10.0, 2.0  # s before and after an alarm that its record contains
_RECORD_DELAY_S = 0.2  # s that the record continues after an alarm at rest
CLOSE_TIMEOUT_S = 3.0  # s that closing waits for the thread, because a disk may hang
_RECORDED_EVENT_KINDS = frozenset({"alarm", "estop"})  # kinds of events
_STATES = {state: float(i) for i, state in enumerate(MachineState)}
_STANDSTILL_SPEED_MM_S = 0.01  # mm/s
_TURNING_RPM = 1.0  # rpm


class _OpenRecord(NamedTuple):
    """An alarm whose record has not been written yet, with the name of the program that was running."""

    alarm_event: LogEvent
    program_name: str


def list_recorded_signals(machine: Machine, ports: MachinePorts) -> RingLayout:
    """Return the layout of the signals that are recorded for this machine."""
    return RingLayout(
        {axis.name: axis.is_rotary for axis in machine.axes},
        tuple(machine.inputs),
        tuple(machine.outputs),
        ports.samples.sample_rate_hz if ports.samples is not None else TICK_RATE_HZ,
        time.time() - ports.clock.now(),
        machine.name,
        tuple(state.value for state in MachineState),
    )


class ScopeRecorder(ScopeRecordings):
    """Recorder of ticks in a ring buffer, which saves a file for each alarm.

    - The executor calls ``queue_tick`` and ``add_record_name``. Any thread may call
      ``get_record_since`` and ``get_record_between``.
    - ``folder`` contains the ring file ``name`` and the alarm records, or is None if no file is written.
    - ``storage_error`` is the reason why the ring file cannot be written. The record is then in memory
      only.
    - ``memory`` is shared with another process that reads the ring.
    """

    def __init__(
        self,
        recorded: RingLayout,
        folder: Path | None = None,
        name: str = CURRENT_RING_NAME,
        memory: memoryview | None = None,
    ) -> None:
        super().__init__(ScopeRing.from_layout(recorded, memory), folder)
        self._told: deque[TickData] = deque(maxlen=_MAX_QUEUED_TICKS)
        self._noted: deque[_OpenRecord] = deque()
        self._freezing: _OpenRecord | None = None
        self._name = self._writing = ""  # names of the record that is pending and of the record being written
        self._program = ""
        self._skipped: list[float] | None = None  # the last tick if it contained no change
        self._figures: list[float] = []
        self._late = 0.0
        self._silent = False  # no data arrives from the axes
        self._place: tuple[object, ...] = ()
        self._resting: list[float] | None = None
        self._file: RingFile | None = None
        if folder is not None:
            self._open(folder, name)
        self._closing, self._happens = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)

    def _open(self, folder: Path, name: str) -> None:
        try:
            self._file = create_ring_file(folder, name, self.ring)
        except RecordError as error:
            self.storage_error = Message("the scope record is stored in memory only: {error}", error=error)

    # --- the executor's thread ------------------------------------------------------------------------

    def queue_tick(self, tick: TickData) -> None:
        """Queue the data of one tick without waiting."""
        self._program = tick.snapshot.program
        self._told.append(tick)
        if not tick.is_at_rest:
            self._happens.set()

    def add_record_name(self, event: LogEvent) -> LogEvent:
        """Return the event with the name of its future record if it is an alarm or an E-stop.

        Other events are returned unchanged. The function does not wait.
        """
        if self.folder is None or event.kind not in _RECORDED_EVENT_KINDS or event.alarm is None:
            return event
        if not self._name:
            began = time.localtime(self.ring.layout.clock_zero_utc_s + event.time_s)
            stamp = time.strftime("%Y%m%dT%H%M%S", began)
            self._name = f"{stamp}-alarm{event.alarm.number}{RECORD_SUFFIX}"
            named = replace(event, record_name=self._name)
            self._noted.append(_OpenRecord(named, self._program))
            return named
        return replace(event, record_name=self._name)

    def is_saving_record(self, name: str) -> bool:
        """Return whether the alarm record with this name is still pending or being written."""
        return name in {self._name, self._writing} - {""}

    # --- the recorder's thread --------------------------------------------------------------------------

    def start(self) -> None:
        """Start the recorder's thread."""
        self._thread.start()

    def close(self) -> None:
        """Store the queued ticks, write the open alarm record and end the thread."""
        self._closing.set()
        self._happens.set()
        if self._thread.is_alive():
            self._thread.join(CLOSE_TIMEOUT_S)
        self.store_queued_ticks(is_last=True)
        if self._file is not None:
            self._file.close()
            self._file = None

    def _run(self) -> None:
        while not self._closing.wait(_POLL_INTERVAL_S):
            self._happens.wait(_REST_PAUSE_S)
            self._happens.clear()
            with ErrorCatcher() as trial:
                self.store_queued_ticks()
            if trial.error is not None:
                _log.error("the recorder has failed", exc_info=trial.error)
                return

    def store_queued_ticks(self, *, is_last: bool = False) -> None:
        """Store the queued ticks in the ring buffer.

        ``is_last`` is True if no more ticks will follow.
        """
        ticks = [self._told.popleft() for _ in range(len(self._told))]
        if ticks:
            self._keep(self.ring.ticks, self._tick_rows(ticks))
            self._keep(self.ring.samples, self._sample_rows(ticks))
        self._write_due_record(ticks[-1].snapshot if ticks else None, last=is_last)

    def _keep(self, rows: RowBuffer, new: FloatArray) -> None:
        if not len(new):
            return
        parts = rows.append_rows(new)
        if self._file is not None:
            try:
                self._file.write_rows(rows, parts)
            except RecordError as error:
                self.storage_error = Message(
                    "the scope record is stored in memory only: {error}", error=error
                )
                _log.warning("%s", self.storage_error)
                self._file.close()
                self._file = None

    def _tick_rows(self, ticks: Iterable[TickData]) -> FloatArray:
        """Return a row for each tick in which a value changed.

        While the machine is at rest, there are at most ten rows per second.
        """
        recorded, last = self.ring.layout, self.ring.ticks.last_time_s
        rows: list[list[float]] = []
        for tick in ticks:
            s = tick.snapshot
            if s.t <= last:
                continue
            is_spindle_known = UnknownPart.SPINDLE not in s.unknown
            row_values = [
                s.rpm_command,
                s.rpm_actual if is_spindle_known else _NAN,
                tick.spindle_revolutions if is_spindle_known else _NAN,
                s.feed_override,
                s.spindle_override,
                tick.queued_motion_s,
                0.0,
                float(s.line),
                float(s.block),
                _STATES[s.state],
                *_values_or_nan(
                    pack_bits(recorded.input_names, s.inputs), UnknownPart.INPUTS not in s.unknown
                ),
                *_values_or_nan(
                    pack_bits(recorded.output_names, s.outputs), UnknownPart.OUTPUTS not in s.unknown
                ),
            ]
            self._late = max(self._late, tick.delay_s)
            if row_values == self._figures and s.t < last + _REST_ROW_INTERVAL_S - _TIME_RESOLUTION_S:
                continue
            self._figures, last = row_values, s.t
            rows.append([s.t, *row_values[:6], self._late, *row_values[7:]])
            self._late = 0.0
        return np.array(rows).reshape(-1, recorded.tick_width)

    def _sample_rows(self, ticks: list[TickData]) -> FloatArray:
        """Return the driver's samples, or the axis positions at each tick if the driver has no samples."""
        width, last = self.ring.layout.sample_width, self.ring.samples.last_time_s
        sample_blocks = [
            _add_spindle_load(tick.samples, tick)
            for tick in ticks
            if tick.samples is not None and len(tick.samples)
        ]
        rows = np.concatenate(sample_blocks) if sample_blocks else self._rows_from_snapshots(ticks, last)
        rows = self._with_gap(rows, ticks)
        if rows.shape[1:] != (width,):
            return np.empty((0, width))
        return rows[rows[:, 0] > np.maximum.accumulate(np.concatenate(([last], rows[:-1, 0])))]

    def _with_gap(self, rows: FloatArray, ticks: Iterable[TickData]) -> FloatArray:
        """Insert a row of NaN where axis data is missing, so that the plot shows a gap."""
        silent = [tick.snapshot.t for tick in ticks if UnknownPart.AXES in tick.snapshot.unknown]
        begins, self._silent = bool(silent) and not self._silent, bool(silent)
        if not silent:
            return rows
        before, later_rows = rows[rows[:, 0] < silent[0]], rows[rows[:, 0] > silent[-1]]
        gap = np.full((int(begins), self.ring.layout.sample_width), _NAN)
        gap[:, 0] = silent[0]
        return np.concatenate([before, gap, later_rows])

    def _rows_from_snapshots(self, ticks: Iterable[TickData], last: float) -> FloatArray:
        """Return samples made from the snapshots, including the last sample before each change."""
        width, none = self.ring.layout.sample_width, [_NAN] * len(self.ring.layout.is_rotary_by_axis)
        rows: list[list[float]] = []
        for tick in ticks:
            s = tick.snapshot
            if tick.samples is not None or s.t <= last or UnknownPart.AXES in s.unknown:
                continue
            place = (s.demand, s.actual, s.rpm_actual)
            row = [
                s.t,
                *s.demand,
                *s.actual,
                *none,
                s.rpm_actual,
                tick.spindle_revolutions,
                _load(tick),
                tick.queued_motion_s,
            ]
            if place == self._place and s.t < last + _REST_ROW_INTERVAL_S - _TIME_RESOLUTION_S:
                self._resting = row
                continue
            if self._resting is not None and place != self._place:
                rows.append(self._resting)
            self._place, self._resting, last = place, None, s.t
            rows.append(row)
        return np.array(rows).reshape(-1, width)

    # --- records of alarms --------------------------------------------------------------------------------

    def _write_due_record(self, now: Snapshot | None, *, last: bool) -> None:
        """Write the pending alarm record once the machine is at rest or 2 s after the alarm."""
        if self._freezing is None and self._noted:
            self._freezing = self._noted.popleft()
        if self._freezing is None or (now is None and not last):
            return
        event = self._freezing.alarm_event
        if last or now is None or _over(now, event.time_s):
            self._name, self._writing = "", self._name  # a later alarm gets its own record
            frozen, self._freezing = self._freezing, None
            self._write(frozen, min(self.ring.samples.last_time_s, event.time_s + BEHIND))
            self._writing = ""

    def _write(self, frozen: _OpenRecord, end: float) -> None:
        event, folder = frozen.alarm_event, self.folder
        assert folder is not None
        assert event.alarm is not None
        record = self.ring.get_record_between(event.time_s - BEFORE, end)
        about = {
            **record.about,
            "program": frozen.program_name,
            "alarm": Message(
                "{number} {alarm}: {cause}",
                number=event.alarm.number,
                alarm=event.alarm.text,
                cause=event.alarm.cause,
            ),
            "alarm line": str(event.line_number),
            "alarm time": repr(event.time_s),  # on the clock of the samples
        }
        try:
            save_record(replace(record, about=about), folder / event.record_name)
            delete_oldest_records(folder)
        except RecordError as error:
            self.storage_error = Message("the record of an alarm was lost: {error}", error=error)
            _log.warning("%s", self.storage_error)


def _values_or_nan(values: list[float], is_known: bool) -> list[float]:
    """Return ``values``, or the same number of NaN if the values are unknown."""
    return values if is_known else [_NAN] * len(values)


def _over(now: Snapshot, alarm: float) -> bool:
    is_stationary = now.velocity < _STANDSTILL_SPEED_MM_S and abs(now.rpm_actual) < _TURNING_RPM
    return now.t >= alarm + BEHIND or (is_stationary and now.t >= alarm + _RECORD_DELAY_S)


def delete_oldest_records(folder: Path) -> None:
    """Delete the oldest alarm records until the permitted number remains.

    Raises RecordError if a record cannot be deleted.
    """
    try:
        for old in sorted(folder.glob(f"*-alarm*{RECORD_SUFFIX}"))[:-MAX_ALARM_RECORDS]:
            old.unlink()
    except OSError as error:
        raise RecordError(
            Message(
                "{folder}: old alarm records cannot be deleted: {cause}",
                folder=folder,
                cause=error.strerror or error,
            )
        ) from error


_LOAD = -2  # column of the spindle load in a sample


def _load(tick: TickData) -> float:
    return _NAN if tick.snapshot.spindle_load is None else tick.snapshot.spindle_load


def _add_spindle_load(rows: FloatArray, tick: TickData) -> FloatArray:
    """Return the samples with the spindle load from the machine's input.

    The samples are returned unchanged if the driver measures the load itself.
    """
    load = tick.snapshot.spindle_load
    if load is None or not len(rows) or not np.isnan(rows[:, _LOAD]).all():
        return rows
    rows = rows.copy()
    rows[:, _LOAD] = load
    return rows
