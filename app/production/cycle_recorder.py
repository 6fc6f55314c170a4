"""Recorder of cycle times and stops from the executor's events, one row per part and stop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from core.executor.snapshot import LogEvent, MachineState
from core.store.production.part_cycles import CycleRow, ProductionRow, ProductionStopRow
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
    start_time_s: float
    stopped_s: float = 0.0
    is_restarted: bool = False


@dataclass(slots=True)
class _Stop:
    row: ProductionStopRow
    start_time_s: float
    has_specific_reason: bool  # whether the reason is more specific than the name of the state


class CycleRecorder:
    """Recorder of production cycles and stops.

    - ``hear`` receives every event in order, and returns the rows to be stored.
    - The time of day of a row is the time of the call. Durations are calculated from the event times.
    - When a cycle ends, a stop begins with the reason for the end. It lasts until the next cycle starts.
    """

    def __init__(self, read_clock: Callable[[], str] = get_utc_now_text) -> None:
        self._now = read_clock
        self._program = ""
        self._cycle: _Cycle | None = None
        self._stop: _Stop | None = None
        self._reason = ""  # reason that was reported before the machine stopped
        self._numbered = 0
        self._rows: list[ProductionRow] = []  # rows of the current call

    def hear(self, event: LogEvent) -> tuple[ProductionRow, ...]:
        """Process one event, and return the rows of cycles and stops that have changed."""
        self._update(event)
        rows, self._rows = tuple(self._rows), []
        return rows

    def _update(self, event: LogEvent) -> None:
        if event.kind == "load":
            self._program = Path(event.text).name
        elif event.kind in {"start", "repeat"}:
            self._end_stop(event)
            self._begin(event)
        elif event.kind == "restart" and self._cycle is not None:
            self._cycle.is_restarted = True
        elif event.kind == "state":
            self._state(event)
        elif event.kind in {"stop", "alarm", "estop"} and event.alarm is not None:
            self._name_reason(event.alarm.text)
        elif event.kind in {"part", "uncounted"}:
            self._end(event, COMPLETE if event.kind == "part" else UNCOUNTED)
        elif event.kind == "end":
            self._end(event, GIVEN_UP)  # no cycle is left to end after a part
            if self._stop is None or self._stop.row.cycle:
                self._end_stop(event)
                self._begin_stop(event, BETWEEN_CYCLES, named=True)

    # --- cycles -------------------------------------------------------------------------------------------

    def _key(self) -> tuple[str, str]:
        self._numbered += 1
        now = self._now()
        return f"{now}#{self._numbered}", now

    def _begin(self, event: LogEvent) -> None:
        key, now = self._key()
        self._cycle = _Cycle(CycleRow(key, self._program, 0, now), event.time_s)
        self._rows.append(self._cycle.row)

    def _end(self, event: LogEvent, outcome: str) -> None:
        cycle, self._cycle = self._cycle, None
        if cycle is None:
            return
        if self._stop is not None and self._stop.row.cycle:
            cycle.stopped_s += event.time_s - self._stop.start_time_s
        if cycle.is_restarted and outcome == COMPLETE:
            outcome = RESTARTED
        seconds = max(0.0, event.time_s - cycle.start_time_s - cycle.stopped_s)
        row = cycle.row._replace(
            part=event.part_number,
            ended=self._now(),
            seconds=seconds,
            outcome=outcome,
            load=event.mean_load_percent,
        )
        self._rows.append(row)

    # --- stops --------------------------------------------------------------------------------------------

    def _state(self, event: LogEvent) -> None:
        cycle = self._cycle
        if event.text in _FAULT_STATES:
            self._interrupt_cycle(event)
        elif cycle is None:
            return
        elif event.text in _STOPPED_STATES and self._stop is None:
            self._begin_stop(event, self._reason or event.text, named=bool(self._reason))
        elif event.text in _RUNNING_STATES:
            self._go(cycle, event)

    def _go(self, cycle: _Cycle, event: LogEvent) -> None:
        if event.text != MachineState.STOPPING.value:
            self._reason = ""
        if self._stop is not None:
            cycle.stopped_s += event.time_s - self._stop.start_time_s
            self._end_stop(event)

    def _interrupt_cycle(self, event: LogEvent) -> None:
        """End the cycle after an alarm or E-stop.

        Production is stopped until the next start.
        """
        self._end(event, event.text)
        if self._stop is not None and self._stop.row.reason == BETWEEN_CYCLES:
            self._end_stop(event)
        if self._stop is None:
            self._begin_stop(event, self._reason or event.text, named=bool(self._reason))

    def _begin_stop(self, event: LogEvent, reason: str, *, named: bool) -> None:
        key, now = self._key()
        cycle = self._cycle.row.key if self._cycle is not None else ""
        self._stop = _Stop(
            ProductionStopRow(key, cycle, self._program, now, 0.0, reason, event.line_number),
            event.time_s,
            named,
        )
        self._reason = ""

    def _end_stop(self, event: LogEvent) -> None:
        stop, self._stop, self._reason = self._stop, None, ""
        if stop is None:
            return
        row = stop.row._replace(seconds=max(0.0, event.time_s - stop.start_time_s))
        self._rows.append(row)

    def _name_reason(self, reason: str) -> None:
        """Set the reason for the current stop, or for the next stop if the machine is running."""
        stop = self._stop
        if stop is None:
            self._reason = reason
        elif not stop.has_specific_reason:
            self._stop = replace(stop, row=stop.row._replace(reason=reason), has_specific_reason=True)
