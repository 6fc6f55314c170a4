"""What was switched behind the back of the program: the cycle is held, and its part is not counted.

A feeder that heard nothing stops spindle and outputs; a terminal, a module or a controller may do so by
itself. Nothing is fed while an output is not what the program commanded; what a start switches on again is
announced. The spindle has its own watch (``core.executor.spindle``).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from core.alarms import Code
from core.executor.announced import Starting
from core.executor.bench import Bench
from core.executor.rounds import Rounds
from core.executor.states import ACTIVE, CYCLE, STOPPED
from core.ports import Trip


class Disturbance:
    """``look`` once a tick; ``starts`` is a source of the announcement. On the executor's thread alone."""

    def __init__(self, bench: Bench, rounds: Rounds) -> None:
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
