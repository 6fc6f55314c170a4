"""Looks after the machine every tick: one place for all drivers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

from core.alarms import Code
from core.executor.following_error import FollowingErrorWatch
from core.executor.machine_context import MachineContext
from core.executor.program_run import ProgramRun
from core.executor.raised_alarm import AlarmError
from core.executor.snapshot import ACTIVE, CYCLE, STOPPED, State
from core.executor.start_conditions import Starting
from core.ports import AxisSample, Trip, code_of


class Supervisor:
    """Sees faults and raises them as TroubleError."""

    def __init__(self, bench: MachineContext) -> None:
        self._bench = bench
        self._axes = FollowingErrorWatch(bench.machine.axes)
        self.max_following_error = 0.0

    def acknowledged(self) -> None:
        """An axis that stands elsewhere now may stand there."""
        self._axes.forget()

    def look(self, state: State) -> None:
        """Raises TroubleError for the first thing that must stop the machine."""
        sample, bench = self._bench.sample, self._bench
        if sample.fault:
            raise AlarmError(code_of(sample.fault, "axis"), sample.fault)
        self._numbers(sample)
        self.max_following_error = max(self.max_following_error, *map(abs, sample.following_error[:2]))
        self._axes.look(sample, unpowered=state is State.DISABLED)
        turning = not bench.spindle.stopped and bench.spindle.asked
        gripped = bench.inputs.get("collet_closed", True) or not bench.ports.io.outputs().get("collet", True)
        if turning and not gripped and not bench.machine.interlocks.spindle_with_collet_open:
            self._collet_lost()
        else:
            self._open_since = None

    def _numbers(self, sample: AxisSample) -> None:
        """No comparison ever trips on what is no number."""
        each = zip(
            self._bench.machine.axes, sample.demand, sample.actual, sample.following_error, strict=True
        )
        for axis, *told in each:
            if not all(map(math.isfinite, told)):
                raise AlarmError("axis", f"{axis.name}: its drive tells a position that is no number")

    def _collet_lost(self) -> None:
        """The switch may bounce while the collet closes; it must be off for its closing time."""
        now = self._bench.now
        self._open_since = now if self._open_since is None else self._open_since
        if now - self._open_since > 2.0 * self._bench.machine.timing.collet_close:
            raise AlarmError("collet-lost")

    _open_since: float | None = None


# --- outputs and the feeder -----------------------------------------------------------------------------


class OutputsWatch:
    """``look`` once a tick; ``starts`` is a source of the announcement. On the executor's thread alone."""

    def __init__(self, bench: MachineContext, rounds: ProgramRun) -> None:
        self._bench = bench
        self._rounds = rounds
        self._told: frozenset[str] = (
            frozenset()
        )  # outputs of which it is known that they are not as commanded

    def look(self) -> None:
        """Raises DriverError, TroubleError."""
        trips = self._bench.ports.trips
        trip = trips.tripped() if trips is not None else None
        if trips is not None and trip is not None:
            trips.acknowledge(trip)  # first: the hold is setpoints too
            self._tripped(trip)
        if self._rounds.standing.state not in CYCLE:
            self._told = frozenset()
            for each in self._bench.outputs.accept():
                self._bench.say("disturbed", f"{each.words} BY ITSELF")
            return
        differing = self._bench.outputs.differing()
        new = [each for each in differing if each.name not in self._told]
        self._told = frozenset(each.name for each in differing)
        if new:
            self._disturbed("switched-off", " AND ".join(each.words for each in new))

    def starts(self) -> Iterator[Starting]:
        """Outputs that going on switches as the program has them."""
        if self._rounds.standing.state in STOPPED:
            for name, wanted in self._bench.outputs.differing():
                words = f"{name.upper()} {'COMES ON' if wanted else 'GOES OFF'}"
                begin = partial(self._bench.outputs.write, name, wanted)
                yield Starting(f"output {name}", words, begin)

    def _tripped(self, trip: Trip) -> None:
        bench = self._bench
        off = [*(["SPINDLE"] if trip.spindle else []), *(name.upper() for name in trip.outputs)]
        if trip.spindle:
            bench.spindle.dropped("THE FEEDER HAS SWITCHED OFF")
        bench.outputs.fell(trip.outputs)
        self._told |= set(trip.outputs)
        self._disturbed(
            "feeder-tripped", f"CONTROL WAS SILENT FOR {trip.away:.1f} S, SWITCHED OFF: {', '.join(off)}"
        )

    def _disturbed(self, code: Code, words: str) -> None:
        rounds, state = self._rounds, self._rounds.standing.state
        self._bench.say("disturbed", words)
        if rounds.cycle is None or state not in CYCLE:
            return
        rounds.disturb(words.lower())
        if state in ACTIVE:
            self._bench.spindle.break_off()
        else:
            self._bench.stopped(code, words.lower())
        rounds.cycle.hold(words, code=code)
