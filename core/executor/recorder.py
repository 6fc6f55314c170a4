"""Recorder of the scope: stores the data of the executor's ticks for the last minutes.

The executor only appends to a queue. A separate thread moves the queue into a ring buffer ten times per
second, or twice per second while the machine rests. The thread also saves the record before an alarm to a
file.
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

from core.executor.raised_alarm import Attempt
from core.executor.snapshot import Event, Snapshot, State, Tick
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import FloatArray, MachinePorts, Unknown
from core.records.record import RecordError
from core.records.record_file import ENDING, save_record
from core.records.record_ring import TICKS, Recorded, Ring, Rows, bits_of
from core.records.recordings import KEPT, Recordings
from core.records.ring_file import NOW, RingFile, new_ring

_log = logging.getLogger(__name__)
_NAN = float("nan")
_LOOK = 0.1  # s between two passes through the queue
_RESTS = 0.5  # additional s while nothing happens
_AT_REST = 0.1  # s between two rows while no value changes
_GRAIN = 0.005  # s; half a tick
_MOST = 12_000  # largest number of queued ticks: 2 min
BEFORE, BEHIND = 10.0, 2.0  # s before and after an alarm that its record contains
_SOON = 0.2  # s that the record continues after an alarm at rest
ENDS = 3.0  # s that closing waits for the thread, because a disk may hang
_FROZEN = frozenset({"alarm", "estop"})  # kinds of events
_STATES = {state: float(i) for i, state in enumerate(State)}
_STANDS = 0.01  # mm/s
_TURNS = 1.0  # rpm


class _Frozen(NamedTuple):
    """An alarm whose record has not been written yet."""

    event: Event
    program: str


def recorded_of(machine: Machine, ports: MachinePorts) -> Recorded:
    """Return the list of signals that are recorded for this machine."""
    return Recorded(
        {axis.name: axis.rotary for axis in machine.axes},
        tuple(machine.inputs),
        tuple(machine.outputs),
        ports.samples.rate if ports.samples is not None else TICKS,
        time.time() - ports.clock.now(),
        machine.name,
        tuple(state.value for state in State),
    )


class Recorder(Recordings):
    """Records ticks in a ring buffer and saves a file for each alarm.

    The executor calls ``tell`` and ``note``; ``latest`` and ``between`` may be used from any thread.
    ``folder`` contains the ring file ``name`` and the alarm records; None means that no file is written.
    ``trouble`` is the reason why the ring file cannot be written, in which case the record is in memory only.
    ``memory`` is shared with another process that reads the ring.
    """

    def __init__(
        self,
        recorded: Recorded,
        folder: Path | None = None,
        name: str = NOW,
        memory: memoryview | None = None,
    ) -> None:
        super().__init__(Ring.of(recorded, memory), folder)
        self._told: deque[Tick] = deque(maxlen=_MOST)
        self._noted: deque[_Frozen] = deque()
        self._freezing: _Frozen | None = None
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
            self._file = new_ring(folder, name, self.ring)
        except RecordError as error:
            self.trouble = Message("the scope record is stored in memory only: {error}", error=error)

    # --- the executor's thread ------------------------------------------------------------------------

    def tell(self, tick: Tick) -> None:
        """Queue the data of one tick. Never waits."""
        self._program = tick.snapshot.program
        self._told.append(tick)
        if not tick.rests:
            self._happens.set()

    def note(self, event: Event) -> Event:
        """Return an alarm or E-stop event with the name of the record that will be written. Never waits."""
        if self.folder is None or event.kind not in _FROZEN or event.alarm is None:
            return event
        if not self._name:
            began = time.localtime(self.ring.recorded.began + event.t)
            stamp = time.strftime("%Y%m%dT%H%M%S", began)
            self._name = f"{stamp}-alarm{event.alarm.number}{ENDING}"
            named = replace(event, record=self._name)
            self._noted.append(_Frozen(named, self._program))
            return named
        return replace(event, record=self._name)

    def is_saving(self, name: str) -> bool:
        """Return whether the record of this alarm is still to be written."""
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
            self._thread.join(ENDS)
        self.drain(last=True)
        if self._file is not None:
            self._file.close()
            self._file = None

    def _run(self) -> None:
        while not self._closing.wait(_LOOK):
            self._happens.wait(_RESTS)
            self._happens.clear()
            with Attempt() as trial:
                self.drain()
            if trial.error is not None:
                _log.error("the recorder has failed", exc_info=trial.error)
                return

    def drain(self, *, last: bool = False) -> None:
        """Store the queued ticks. ``last`` is True if no more ticks will follow."""
        ticks = [self._told.popleft() for _ in range(len(self._told))]
        if ticks:
            self._keep(self.ring.ticks, self._tick_rows(ticks))
            self._keep(self.ring.samples, self._sample_rows(ticks))
        self._freeze(ticks[-1].snapshot if ticks else None, last=last)

    def _keep(self, rows: Rows, new: FloatArray) -> None:
        if not len(new):
            return
        parts = rows.write(new)
        if self._file is not None:
            try:
                self._file.write(rows, parts)
            except RecordError as error:
                self.trouble = Message("the scope record is stored in memory only: {error}", error=error)
                _log.warning("%s", self.trouble)
                self._file.close()
                self._file = None

    def _tick_rows(self, ticks: Iterable[Tick]) -> FloatArray:
        """Return a row for each tick that contains a change, and ten rows per second at rest."""
        recorded, last = self.ring.recorded, self.ring.ticks.last
        rows: list[list[float]] = []
        for tick in ticks:
            s = tick.snapshot
            if s.t <= last:
                continue
            heard = Unknown.SPINDLE not in s.unknown
            figures = [
                s.rpm_command,
                s.rpm_actual if heard else _NAN,
                tick.turns if heard else _NAN,
                s.feed_override,
                s.spindle_override,
                tick.queue,
                0.0,
                float(s.line),
                float(s.block),
                _STATES[s.state],
                *_told(bits_of(recorded.inputs, s.inputs), Unknown.INPUTS not in s.unknown),
                *_told(bits_of(recorded.outputs, s.outputs), Unknown.OUTPUTS not in s.unknown),
            ]
            self._late = max(self._late, tick.late)
            if figures == self._figures and s.t < last + _AT_REST - _GRAIN:
                continue
            self._figures, last = figures, s.t
            rows.append([s.t, *figures[:6], self._late, *figures[7:]])
            self._late = 0.0
        return np.array(rows).reshape(-1, recorded.tick_width)

    def _sample_rows(self, ticks: list[Tick]) -> FloatArray:
        """Return the driver's samples, or the axis positions at each tick if the driver has no samples."""
        width, last = self.ring.recorded.sample_width, self.ring.samples.last
        told = [
            _loaded(tick.samples, tick) for tick in ticks if tick.samples is not None and len(tick.samples)
        ]
        rows = np.concatenate(told) if told else self._seen(ticks, last)
        rows = self._with_gap(rows, ticks)
        if rows.shape[1:] != (width,):
            return np.empty((0, width))
        return rows[rows[:, 0] > np.maximum.accumulate(np.concatenate(([last], rows[:-1, 0])))]

    def _with_gap(self, rows: FloatArray, ticks: Iterable[Tick]) -> FloatArray:
        """Insert a row of NaN where the data of the axes is lost, so that no line is drawn across the gap."""
        silent = [tick.snapshot.t for tick in ticks if Unknown.SLIDES in tick.snapshot.unknown]
        begins, self._silent = bool(silent) and not self._silent, bool(silent)
        if not silent:
            return rows
        before, behind = rows[rows[:, 0] < silent[0]], rows[rows[:, 0] > silent[-1]]
        gap = np.full((int(begins), self.ring.recorded.sample_width), _NAN)
        gap[:, 0] = silent[0]
        return np.concatenate([before, gap, behind])

    def _seen(self, ticks: Iterable[Tick], last: float) -> FloatArray:
        """Return samples taken from the snapshots. The last row before a change is always included."""
        width, none = self.ring.recorded.sample_width, [_NAN] * len(self.ring.recorded.axes)
        rows: list[list[float]] = []
        for tick in ticks:
            s = tick.snapshot
            if tick.samples is not None or s.t <= last or Unknown.SLIDES in s.unknown:
                continue
            place = (s.demand, s.actual, s.rpm_actual)
            row = [s.t, *s.demand, *s.actual, *none, s.rpm_actual, tick.turns, _load(tick), tick.queue]
            if place == self._place and s.t < last + _AT_REST - _GRAIN:
                self._resting = row
                continue
            if self._resting is not None and place != self._place:
                rows.append(self._resting)
            self._place, self._resting, last = place, None, s.t
            rows.append(row)
        return np.array(rows).reshape(-1, width)

    # --- records of alarms --------------------------------------------------------------------------------

    def _freeze(self, now: Snapshot | None, *, last: bool) -> None:
        """Write the record of an alarm when the machine is at rest or 2 s have passed."""
        if self._freezing is None and self._noted:
            self._freezing = self._noted.popleft()
        if self._freezing is None or (now is None and not last):
            return
        event = self._freezing.event
        if last or now is None or _over(now, event.t):
            self._name, self._writing = "", self._name  # a later alarm gets its own record
            frozen, self._freezing = self._freezing, None
            self._write(frozen, min(self.ring.samples.last, event.t + BEHIND))
            self._writing = ""

    def _write(self, frozen: _Frozen, end: float) -> None:
        event, folder = frozen.event, self.folder
        assert folder is not None
        assert event.alarm is not None
        record = self.ring.between(event.t - BEFORE, end)
        about = {
            **record.about,
            "program": frozen.program,
            "alarm": Message(
                "{number} {alarm}: {cause}",
                number=event.alarm.number,
                alarm=event.alarm.text,
                cause=event.alarm.cause,
            ),
            "alarm line": str(event.line),
            "alarm time": repr(event.t),  # on the clock of the samples
        }
        try:
            save_record(replace(record, about=about), folder / event.record)
            rotate(folder)
        except RecordError as error:
            self.trouble = Message("the record of an alarm was lost: {error}", error=error)
            _log.warning("%s", self.trouble)


def _told(figures: list[float], heard: bool) -> list[float]:
    """Return the values, or NaN for each value if no data arrives."""
    return figures if heard else [_NAN] * len(figures)


def _over(now: Snapshot, alarm: float) -> bool:
    stands = now.velocity < _STANDS and abs(now.rpm_actual) < _TURNS
    return now.t >= alarm + BEHIND or (stands and now.t >= alarm + _SOON)


def rotate(folder: Path) -> None:
    """Delete the oldest alarm records above the permitted number. Raises RecordError if deletion fails."""
    try:
        for old in sorted(folder.glob(f"*-alarm*{ENDING}"))[:-KEPT]:
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


def _load(tick: Tick) -> float:
    return _NAN if tick.snapshot.spindle_load is None else tick.snapshot.spindle_load


def _loaded(rows: FloatArray, tick: Tick) -> FloatArray:
    """Return the samples with the spindle load of the machine's input, if the driver does not measure it."""
    load = tick.snapshot.spindle_load
    if load is None or not len(rows) or not np.isnan(rows[:, _LOAD]).all():
        return rows
    rows = rows.copy()
    rows[:, _LOAD] = load
    return rows
