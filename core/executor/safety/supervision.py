"""What is watched every tick besides the axes: faults of drives, the collet, outputs, the feeder.

A feeder that heard nothing stops spindle and outputs; a terminal, a module or a controller may do so by
itself. What was switched behind the back of the program holds the cycle, and its part is not counted: nothing
is fed while an output is not what the program commanded, and what a start switches on again is announced.
Axes have their own watch (``following_error``), and the spindle (``spindle_control``).
"""

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
from core.message import Message, join_messages
from core.ports import AxisSample, Trip, Unknown, code_of

_POWERED = CYCLE | {State.IDLE, State.JOG, State.HOME}
_UNHEARD = 0.25  # s for which a driver may have nothing of the slides before it reports why


class Supervisor:
    """Watches drives, axes and collet."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._axes = FollowingErrorWatch(context.machine.axes)
        self.max_following_error = 0.0

    def acknowledged(self) -> None:
        """The operator has acknowledged an alarm: an axis that stands elsewhere now may stand there."""
        self._axes.forget()

    def look(self, state: State) -> None:
        """Raises AlarmError for the first thing that must stop the machine."""
        sample, context = self._context.sample, self._context
        if sample.fault:
            raise AlarmError(code_of(sample.fault, "axis"), sample.fault)
        if Unknown.SLIDES in context.unknown:
            self._axes.forget()  # heard again, they may stand elsewhere
            self._unheard(powered=state in _POWERED)
            return
        self._unheard_since = None
        self._numbers(sample)
        self.max_following_error = max(self.max_following_error, *map(abs, sample.following_error[:2]))
        self._axes.look(sample, unpowered=state is State.DISABLED)
        turning = not context.spindle.stopped and context.spindle.asked
        gripped = context.inputs.get("collet_closed", True) or not context.ports.io.outputs().get(
            "collet", True
        )
        if turning and not gripped and not context.machine.interlocks.spindle_with_collet_open:
            self._collet_lost()
        else:
            self._open_since = None

    def _unheard(self, *, powered: bool) -> None:
        """A driver reports a fault too; where it does not, nothing moves on and nothing is ready."""
        now = self._context.now
        since = self._unheard_since = now if self._unheard_since is None else self._unheard_since
        if powered and now - since > _UNHEARD:
            raise AlarmError("drive-silent", "no data from the axes")

    def _numbers(self, sample: AxisSample) -> None:
        """No comparison ever trips on what is no number."""
        each = zip(
            self._context.machine.axes, sample.demand, sample.actual, sample.following_error, strict=True
        )
        for axis, *told in each:
            if not all(map(math.isfinite, told)):
                raise AlarmError(
                    "axis",
                    Message("{axis}: the drive reports a position that is not a number", axis=axis.name),
                )

    def _collet_lost(self) -> None:
        """The switch may bounce while the collet closes; it must be off for its closing time."""
        now = self._context.now
        self._open_since = now if self._open_since is None else self._open_since
        if now - self._open_since > 2.0 * self._context.machine.collet.close_time:
            raise AlarmError("collet-lost")

    _open_since: float | None = None
    _unheard_since: float | None = None


# --- outputs and the feeder -----------------------------------------------------------------------------


class OutputsWatch:
    """Watches outputs and the feeder, once a tick. On the executor's thread alone."""

    def __init__(self, context: MachineContext, program_run: ProgramRun) -> None:
        self._context = context
        self._program_run = program_run
        self._known_off: frozenset[str] = (
            frozenset()
        )  # outputs of which it is known that they are not as commanded

    def look(self) -> None:
        """Hold the cycle where something was switched by somebody else. Raises DriverError, AlarmError."""
        trips = self._context.ports.trips
        trip = trips.tripped() if trips is not None else None
        if trips is not None and trip is not None:
            trips.acknowledge(trip)  # first: the hold is setpoints too
            self._tripped(trip)
        if Unknown.OUTPUTS in self._context.unknown or self._context.sample.fault:
            return  # what a fault has switched off is the fault's, which is told in this tick
        if self._program_run.status.state not in CYCLE:
            told, self._known_off = self._known_off, frozenset()
            for each in self._context.outputs.accept():
                if each.name not in told:  # by what has switched it off
                    self._context.log("disturbed", Message("{item} MOVED WITHOUT A COMMAND", item=each.words))
            return
        differing = self._context.outputs.differing()
        new = [each for each in differing if each.name not in self._known_off]
        self._known_off = frozenset(each.name for each in differing)
        if new:
            self._disturbed("switched-off", " AND ".join(each.words for each in new))

    def starts(self) -> Iterator[Starting]:
        """What the announcement lists: outputs that going on switches as the program has them."""
        if self._program_run.status.state in STOPPED:
            for name, wanted in self._context.outputs.differing():
                words = Message("{output} TURNS ON" if wanted else "{output} TURNS OFF", output=name.upper())
                begin = partial(self._context.outputs.write, name, wanted)
                yield Starting(Message("output {name}", name=name), words, begin)

    def _tripped(self, trip: Trip) -> None:
        """Lamps are no outputs of the program: they are lit again, and nothing is held or told for them."""
        context = self._context
        outputs = tuple(name for name in trip.outputs if name not in context.machine.lamps)
        off = [*(["SPINDLE"] if trip.spindle else []), *(name.upper() for name in outputs)]
        if not off:
            return
        if trip.spindle:
            context.spindle.dropped("DRIVER HOST STOPPED SPINDLE/OUTPUTS")
        context.outputs.fell(outputs)
        self._known_off |= set(outputs)
        template = (
            "NO SIGNAL FROM MACHINE FOR {away} S, OUTPUTS FOUND ON AND SWITCHED OFF: {off}"
            if trip.found
            else "NO SIGNAL FROM CONTROL FOR {away} S, SWITCHED OFF: {off}"
        )
        self._disturbed(
            "feeder-tripped",
            Message(
                template,
                away=f"{trip.away:.1f}",
                off=join_messages(", ", off),
            ),
        )

    def _disturbed(self, code: Code, words: str) -> None:
        program_run, state = self._program_run, self._program_run.status.state
        self._context.log("disturbed", words)
        if program_run.cycle is None or state not in CYCLE:
            return
        program_run.disturb(words.lower())
        if state in ACTIVE:
            self._context.spindle.break_off()
        else:
            self._context.show_stop(code, words.lower())
        program_run.cycle.hold(words, code=code)
