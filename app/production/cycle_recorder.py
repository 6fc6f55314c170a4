"""Recorder of cycle times and stops from the executor's events, one row per part and per stop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from core.executor.snapshot import Event, State
from core.store.production.part_cycles import CycleRecords, CycleRow, StopRow
from core.store.store_rows import utc_now

COMPLETE, UNCOUNTED, GIVEN_UP, RESTARTED = "COMPLETE", "NOT COUNTED", "GIVEN UP", "RESTARTED"
BETWEEN = "BETWEEN CYCLES"  # the next cycle was not started
_STANDS = frozenset({State.HOLD.value, State.BLOCK_END.value, State.PROGRAM_STOP.value})
_GOES = frozenset({State.RUN.value, State.WAIT.value, State.HOLDING.value})
_BROKEN = frozenset({State.FAULT.value, State.ESTOP.value})


@dataclass(slots=True)
class _Cycle:
    """Cycle of the present part: its row, its start time and its stopped time in seconds."""

    row: CycleRow
    began: float
    stood: float = 0.0
    restarted: bool = False


@dataclass(slots=True)
class _Stop:
    row: StopRow
    began: float
    named: bool  # whether the reason is more specific than the name of the state


class CycleRecorder:
    """Recorder of cycles. ``hear`` receives every event in order and posts to the store without waiting.

    Times of day are those of the call, and durations are those of the events. The reason that ends a cycle
    counts as a stop until the next cycle starts.
    """

    def __init__(self, now: Callable[[], str] = utc_now) -> None:
        self._now = now
        self._program = ""
        self._cycle: _Cycle | None = None
        self._stop: _Stop | None = None
        self._reason = ""  # reason that was reported before the machine stopped
        self._numbered = 0

    def hear(self, event: Event, cycles: CycleRecords) -> None:
        """Update the present cycle and stop with one event of the executor."""
        if event.kind == "load":
            self._program = Path(event.text).name
        elif event.kind in {"start", "repeat"}:
            self._end_stop(event, cycles)
            self._begin(event, cycles)
        elif event.kind == "restart" and self._cycle is not None:
            self._cycle.restarted = True
        elif event.kind == "state":
            self._state(event, cycles)
        elif event.kind in {"stop", "alarm", "estop"} and event.alarm is not None:
            self._name(event.alarm.text)
        elif event.kind in {"part", "uncounted"}:
            self._end(event, cycles, COMPLETE if event.kind == "part" else UNCOUNTED)
        elif event.kind == "end":
            self._end(event, cycles, GIVEN_UP)  # no cycle is left to end after a part
            if self._stop is None or self._stop.row.cycle:
                self._end_stop(event, cycles)
                self._begin_stop(event, BETWEEN, named=True)

    def go_on(self, program: str, t: float, cycles: CycleRecords) -> None:
        """Record the rest of a part that was started before this process. It counts as restarted."""
        self._program = Path(program).name
        self._begin(Event(t, "start", program), cycles)
        assert self._cycle is not None
        self._cycle.restarted = True

    # --- cycles -------------------------------------------------------------------------------------------

    def _key(self) -> tuple[str, str]:
        self._numbered += 1
        now = self._now()
        return f"{now}#{self._numbered}", now

    def _begin(self, event: Event, cycles: CycleRecords) -> None:
        key, now = self._key()
        self._cycle = _Cycle(CycleRow(key, self._program, 0, now), event.t)
        cycles.record_cycle(self._cycle.row)

    def _end(self, event: Event, cycles: CycleRecords, outcome: str) -> None:
        cycle, self._cycle = self._cycle, None
        if cycle is None:
            return
        if self._stop is not None and self._stop.row.cycle:
            cycle.stood += event.t - self._stop.began
        if cycle.restarted and outcome == COMPLETE:
            outcome = RESTARTED
        seconds = max(0.0, event.t - cycle.began - cycle.stood)
        row = cycle.row._replace(
            part=event.part, ended=self._now(), seconds=seconds, outcome=outcome, load=event.load
        )
        cycles.record_cycle(row)

    # --- stops --------------------------------------------------------------------------------------------

    def _state(self, event: Event, cycles: CycleRecords) -> None:
        cycle = self._cycle
        if event.text in _BROKEN:
            self._break(event, cycles)
        elif cycle is None:
            return
        elif event.text in _STANDS and self._stop is None:
            self._begin_stop(event, self._reason or event.text, named=bool(self._reason))
        elif event.text in _GOES:
            self._go(cycle, event, cycles)

    def _go(self, cycle: _Cycle, event: Event, cycles: CycleRecords) -> None:
        if event.text != State.HOLDING.value:
            self._reason = ""
        if self._stop is not None:
            cycle.stood += event.t - self._stop.began
            self._end_stop(event, cycles)

    def _break(self, event: Event, cycles: CycleRecords) -> None:
        """End the cycle after an alarm or E-stop. Production is stopped until the next start."""
        self._end(event, cycles, event.text)
        if self._stop is not None and self._stop.row.reason == BETWEEN:
            self._end_stop(event, cycles)
        if self._stop is None:
            self._begin_stop(event, self._reason or event.text, named=bool(self._reason))

    def _begin_stop(self, event: Event, reason: str, *, named: bool) -> None:
        key, now = self._key()
        cycle = self._cycle.row.key if self._cycle is not None else ""
        self._stop = _Stop(StopRow(key, cycle, self._program, now, 0.0, reason, event.line), event.t, named)
        self._reason = ""

    def _end_stop(self, event: Event, cycles: CycleRecords) -> None:
        stop, self._stop, self._reason = self._stop, None, ""
        if stop is None:
            return
        row = stop.row._replace(seconds=max(0.0, event.t - stop.began))
        cycles.record_stop(row)

    def _name(self, reason: str) -> None:
        """Set the reason for the present stop, or for the next stop if the machine runs."""
        stop = self._stop
        if stop is None:
            self._reason = reason
        elif not stop.named:
            self._stop = replace(stop, row=stop.row._replace(reason=reason), named=True)
