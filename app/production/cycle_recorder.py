"""Recorder of cycle times and stops from the executor's events, one row per part and stop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from core.executor.snapshot import LogEvent, MachineState
from core.store.production.part_cycles import CycleRecords, CycleRow, StopRow
from core.store.store_rows import get_utc_now_text

COMPLETE, UNCOUNTED, GIVEN_UP, RESTARTED = "COMPLETE", "NOT COUNTED", "GIVEN UP", "RESTARTED"
BETWEEN_CYCLES = "BETWEEN CYCLES"  # the next cycle was not started
_STOPPED_STATES = frozenset(
    {MachineState.HOLD.value, MachineState.SINGLE_BLOCK_STOP.value, MachineState.PROGRAM_STOP.value}
)
_RUNNING_STATES = frozenset({MachineState.RUN.value, MachineState.WAIT.value, MachineState.STOPPING.value})
_FAULT_STATES = frozenset({MachineState.FAULT.value, MachineState.ESTOP.value})


@dataclass(slots=True)
class _Cycle:
    """Cycle of the current part: its row, its start time, and its total stopped time in seconds."""

    row: CycleRow
    start_time: float
    stopped_s: float = 0.0
    is_restarted: bool = False


@dataclass(slots=True)
class _Stop:
    row: StopRow
    start_time: float
    is_named: bool  # whether the reason is more specific than the name of the state


class CycleRecorder:
    """Recorder of cycles and stops.

    ``hear`` receives every event in order, and posts the rows to the store without waiting. The time of day
    of a row is the time of the call. Durations are calculated from the event times. The time from an alarm
    or E-stop that ends a cycle to the next start is recorded as a stop with this reason.
    """

    def __init__(self, read_clock: Callable[[], str] = get_utc_now_text) -> None:
        self._now = read_clock
        self._program = ""
        self._cycle: _Cycle | None = None
        self._stop: _Stop | None = None
        self._reason = ""  # reason that was reported before the machine stopped
        self._numbered = 0

    def hear(self, event: LogEvent, cycles: CycleRecords) -> None:
        """Update the current cycle and stop with one event of the executor."""
        if event.kind == "load":
            self._program = Path(event.text).name
        elif event.kind in {"start", "repeat"}:
            self._end_stop(event, cycles)
            self._begin(event, cycles)
        elif event.kind == "restart" and self._cycle is not None:
            self._cycle.is_restarted = True
        elif event.kind == "state":
            self._state(event, cycles)
        elif event.kind in {"stop", "alarm", "estop"} and event.alarm is not None:
            self._name_reason(event.alarm.text)
        elif event.kind in {"part", "uncounted"}:
            self._end(event, cycles, COMPLETE if event.kind == "part" else UNCOUNTED)
        elif event.kind == "end":
            self._end(event, cycles, GIVEN_UP)  # no cycle is left to end after a part
            if self._stop is None or self._stop.row.cycle:
                self._end_stop(event, cycles)
                self._begin_stop(event, BETWEEN_CYCLES, named=True)

    def resume_part(self, program: str, time_s: float, cycles: CycleRecords) -> None:
        """Record the remainder of a part that was started before this process was started.

        The part is recorded as restarted.
        """
        self._program = Path(program).name
        self._begin(LogEvent(time_s, "start", program), cycles)
        assert self._cycle is not None
        self._cycle.is_restarted = True

    # --- cycles -------------------------------------------------------------------------------------------

    def _key(self) -> tuple[str, str]:
        self._numbered += 1
        now = self._now()
        return f"{now}#{self._numbered}", now

    def _begin(self, event: LogEvent, cycles: CycleRecords) -> None:
        key, now = self._key()
        self._cycle = _Cycle(CycleRow(key, self._program, 0, now), event.time_s)
        cycles.record_cycle(self._cycle.row)

    def _end(self, event: LogEvent, cycles: CycleRecords, outcome: str) -> None:
        cycle, self._cycle = self._cycle, None
        if cycle is None:
            return
        if self._stop is not None and self._stop.row.cycle:
            cycle.stopped_s += event.time_s - self._stop.start_time
        if cycle.is_restarted and outcome == COMPLETE:
            outcome = RESTARTED
        seconds = max(0.0, event.time_s - cycle.start_time - cycle.stopped_s)
        row = cycle.row._replace(
            part=event.part_number,
            ended=self._now(),
            seconds=seconds,
            outcome=outcome,
            load=event.mean_load_percent,
        )
        cycles.record_cycle(row)

    # --- stops --------------------------------------------------------------------------------------------

    def _state(self, event: LogEvent, cycles: CycleRecords) -> None:
        cycle = self._cycle
        if event.text in _FAULT_STATES:
            self._interrupt_cycle(event, cycles)
        elif cycle is None:
            return
        elif event.text in _STOPPED_STATES and self._stop is None:
            self._begin_stop(event, self._reason or event.text, named=bool(self._reason))
        elif event.text in _RUNNING_STATES:
            self._go(cycle, event, cycles)

    def _go(self, cycle: _Cycle, event: LogEvent, cycles: CycleRecords) -> None:
        if event.text != MachineState.STOPPING.value:
            self._reason = ""
        if self._stop is not None:
            cycle.stopped_s += event.time_s - self._stop.start_time
            self._end_stop(event, cycles)

    def _interrupt_cycle(self, event: LogEvent, cycles: CycleRecords) -> None:
        """End the cycle after an alarm or E-stop, and begin a stop that lasts until the next start."""
        self._end(event, cycles, event.text)
        if self._stop is not None and self._stop.row.reason == BETWEEN_CYCLES:
            self._end_stop(event, cycles)
        if self._stop is None:
            self._begin_stop(event, self._reason or event.text, named=bool(self._reason))

    def _begin_stop(self, event: LogEvent, reason: str, *, named: bool) -> None:
        key, now = self._key()
        cycle = self._cycle.row.key if self._cycle is not None else ""
        self._stop = _Stop(
            StopRow(key, cycle, self._program, now, 0.0, reason, event.line_number), event.time_s, named
        )
        self._reason = ""

    def _end_stop(self, event: LogEvent, cycles: CycleRecords) -> None:
        stop, self._stop, self._reason = self._stop, None, ""
        if stop is None:
            return
        row = stop.row._replace(seconds=max(0.0, event.time_s - stop.start_time))
        cycles.record_stop(row)

    def _name_reason(self, reason: str) -> None:
        """Set the reason for the current stop, or for the next stop if the machine is running."""
        stop = self._stop
        if stop is None:
            self._reason = reason
        elif not stop.is_named:
            self._stop = replace(stop, row=stop.row._replace(reason=reason), is_named=True)
