"""A program on a time scale: every elementary block with its start and end, planned as in a run."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from copy import copy
from dataclasses import replace
from itertools import chain
from typing import NamedTuple

from core.interpreter.dialects import ReadProgram
from core.interpreter.shared.actions import (
    Action,
    Collet,
    Dwell,
    ProgramEnd,
    SpindleLock,
    SpindleOrient,
    SpindleRun,
    SpindleStop,
)
from core.interpreter.shared.elementary_blocks import Block, Kind, SectionEnds, Series, TimedSeries
from core.interpreter.shared.interpretation import Interpretation
from core.interpreter.shared.job_setup import Setup
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Source
from core.machine.machine_model import Machine
from core.motion.axis_limits import MotionError, MotionLimits
from core.motion.window_planner import Chunk, ChunkPlanner
from core.proving.proof_report import in_order
from core.proving.spindle_forecast import SETTLING, THREAD_EARLY, SpindleForecast, orienting

# --- blocks without times -------------------------------------------------------------------------------


Part = list[Block] | Series
"""Blocks one after the other that have come one by one, or as a series."""


class BlocksInMotion:
    """Blocks that were passed to the planner but are not timed yet. Series remain whole if possible."""

    def __init__(self) -> None:
        self._parts: deque[Part] = deque()

    @property
    def first(self) -> Block | None:
        """The oldest block, or None."""
        return self._parts[0][0] if self._parts else None

    def append(self, each: Block | Series) -> None:
        """Append a block or a series."""
        if isinstance(each, Series):
            self._parts.append(each)
        elif self._parts and isinstance(self._parts[-1], list):
            self._parts[-1].append(each)
        else:
            self._parts.append([each])

    def take(self, count: int) -> tuple[Part, ...]:
        """Remove and return the ``count`` oldest blocks."""
        taken: list[Part] = []
        while count:
            part = self._parts.popleft()
            if len(part) > count:
                self._parts.appendleft(part[count:])
                part = part[:count]
            taken.append(part)
            count -= len(part)
        return tuple(taken)


# --- spans of motion and of rest ------------------------------------------------------------------------


TimedBlock = tuple[Block, float, float]
"""A block with its start and end on the program's clock, s."""


class MotionSpan(NamedTuple):
    """A span of motion from ``t0`` on, with the blocks that end in it and their times."""

    t0: float
    chunk: Chunk
    parts: tuple[Part, ...]

    @property
    def blocks(self) -> list[Block]:
        """The blocks that end in the span. Blocks of series are created on each access."""
        return list(chain.from_iterable(self.parts))

    @property
    def last(self) -> Block | None:
        """The last block that ends in the span, or None."""
        return self.parts[-1][-1] if self.parts else None

    @property
    def t1(self) -> float:
        """The end of the span. The next span may continue without a stop."""
        return self.t0 + self.chunk.profile.duration

    def times(self) -> Iterator[TimedBlock]:
        """Yield each block with its start and end on the program's clock."""
        for each in self.times_of_parts():
            if isinstance(each, TimedSeries):
                yield from zip(each.series, each.t0.tolist(), each.t1.tolist(), strict=True)
            else:
                yield each

    def times_of_parts(self) -> Iterator[TimedBlock | TimedSeries]:
        """Yield the same as ``times``, but each series as one item."""
        shift, first = self.t0 - self.chunk.t, 0
        for part in self.parts:
            there = slice(first, first + len(part))
            t0, t1 = self.chunk.t0[there] + shift, self.chunk.t1[there] + shift
            if isinstance(part, Series):
                yield TimedSeries(part, t0, t1)
            else:
                yield from zip(part, t0.tolist(), t1.tolist(), strict=True)
            first = there.stop


class RestSpan(NamedTuple):
    """A rest from ``t0`` to ``t1``: a block without motion, or (None) a wait before the next motion."""

    t0: float
    t1: float
    block: Block | None

    def times(self) -> Iterator[TimedBlock]:
        """Yield the block, if any, with its start and end on the program's clock."""
        if self.block is not None:
            yield self.block, self.t0, self.t1

    def times_of_parts(self) -> Iterator[TimedBlock | TimedSeries]:
        """Yield the same as ``times``."""
        return self.times()


_AT_ONCE = 1e12  # mm/s²; the ramps of an ideal machine are shorter than the displayed resolution


class RestState(NamedTuple):
    """The state at rest between two blocks: time, spindle, pending speed wait, and path section rules."""

    t: float
    spindle: SpindleForecast
    speed_wanted: bool
    ends: SectionEnds


class Timeline:
    """One pass through a program in constant memory; spans are yielded as they become final.

    If the machine cannot execute a block, the pass ends with an error in ``diagnostics``. An ``ideal``
    machine needs no time to accelerate, settle or plan, but has the same speed limits.
    """

    def __init__(
        self, interpreter: Interpretation, setup: Setup, machine: Machine, *, ideal: bool = False
    ) -> None:
        self.interpreter = interpreter
        self.spindle = SpindleForecast(machine)
        self.t = 0.0
        self.start = setup.start
        self._machine = machine
        self._ideal = ideal
        limits = MotionLimits.of(machine.axes, machine.timing.setpoint, machine.limits.corner_tolerance)
        if ideal:
            limits = replace(limits, amax=(_AT_ONCE,) * len(limits.amax))
        self._planner = ChunkPlanner(limits, rpm_max=machine.spindle.rpm_max)
        self._source = self.interpreter.series()
        self._back: Block | Series | None = None  # the next item after a motion, already read
        self._moving = BlocksInMotion()
        self._ends = SectionEnds()
        self._speed_wanted = False  # a speed was commanded, and no feed has waited for it yet
        self._refused: list[Diagnostic] = []

    @classmethod
    def of(
        cls, program: Source | ReadProgram, setup: Setup, machine: Machine, *, ideal: bool = False
    ) -> Timeline:
        """Return the timeline of a program's text, or of its parsed form."""
        reading = program if isinstance(program, ReadProgram) else ReadProgram(program, strict=setup.strict)
        return cls(reading.begin(setup), setup, machine, ideal=ideal)

    @property
    def rest_state(self) -> RestState:
        """The state from which another path through the program continues."""
        return RestState(self.t, copy(self.spindle), self._speed_wanted, copy(self._ends))

    def go_on(self, rest_state: RestState) -> None:
        """Continue from the state of another timeline at rest instead of the start of the program."""
        self.t, self.spindle, self._speed_wanted = (
            rest_state.t,
            copy(rest_state.spindle),
            rest_state.speed_wanted,
        )
        self._ends = copy(rest_state.ends)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of reading and interpreting so far, in the order of lines."""
        return in_order([*self.interpreter.diagnostics, *self._refused])

    @property
    def errors(self) -> bool:
        """True if the diagnostics contain an error."""
        return any(d.severity is Severity.ERROR for d in self.diagnostics)

    def spans(self) -> Iterator[MotionSpan | RestSpan]:
        """Yield the program in time order, without gaps."""
        while (each := self._next()) is not None:
            if isinstance(each, Series) or each.moves:
                yield from self._motion(each)
            else:
                yield self._action(each)

    def _next(self) -> Block | Series | None:
        if self._back is not None:
            back, self._back = self._back, None
            return back
        return next(self._source, None)

    def _motion(self, each: Block | Series) -> Iterator[MotionSpan | RestSpan]:
        """Yield one path section, from rest to rest."""
        first = _like(each)
        if self._ends.rests_before(first):
            self._ends.rested(first)
        if not first.rapid:
            yield from self._at_speed()
        yield self._rest(self._wait(self._machine.timing.commit))
        if first.kind is Kind.THREAD and not self._ideal:
            yield self._index(first)
        start = self.t - self._planner.t
        try:
            for chunk in self._planner.add(self._moves(each)):
                yield self._moved(start, chunk)
            for chunk in self._planner.finish():
                yield self._moved(start, chunk)
            yield self._rest(self._wait(SETTLING))
        except MotionError as error:
            self._refuse(str(error))

    def _moves(self, each: Block | Series | None) -> Iterator[Block | Series]:
        """Yield the blocks of a path section that starts with ``each``."""
        while each is not None:
            self._moving.append(each)
            yield each
            each = self._next()
            if each is not None and self._ends.rests_before(_like(each)):
                break
        self._back = each

    def _index(self, block: Block) -> RestSpan:
        """Return the wait until the axes may start in step with the spindle index, up to one revolution.

        The rule of the executor is in docs/decisions/0016-threads-follow-the-spindle.md.
        """
        turn = abs(self.spindle.speed(self.t)) / 60.0
        if not turn:
            return self._rest(0.0)
        ramp = block.feed * turn / (2.0 * self._machine.axes[1].amax)
        ahead = abs(self.spindle.turns(self.t)) + turn * (ramp + THREAD_EARLY)
        return self._rest(THREAD_EARLY + (math.ceil(ahead - 1e-9) - ahead) / turn)

    def _moved(self, start: float, chunk: Chunk) -> MotionSpan:
        span = MotionSpan(start + chunk.t, chunk, self._moving.take(len(chunk.n)))
        self.t = span.t1
        last = span.last
        if last is not None and last.css is not None:
            self._follow(last.rpm)
        return span

    def _follow(self, rpm: float) -> None:
        """Set the speed reached by constant surface speed, or ramp to it if it has not been reached."""
        if self._speed_wanted:
            self.spindle.command(self.t, rpm)
        else:
            self.spindle.settle(self.t, rpm)

    def _at_speed(self) -> Iterator[RestSpan]:
        """Yield the wait for the spindle to be at speed before a feed."""
        if self._speed_wanted:
            self._speed_wanted = False
            yield self._rest(self._wait(max(0.0, self.spindle.ready_at() - self.t)))

    def _wait(self, seconds: float) -> float:
        """Return the wait of a real machine; 0 for an ideal machine."""
        return 0.0 if self._ideal else seconds

    def _rest(self, seconds: float, block: Block | None = None) -> RestSpan:
        span = RestSpan(self.t, self.t + seconds, block)
        self.t = span.t1
        return span

    def _action(self, block: Block) -> RestSpan:
        assert block.action is not None
        self._ends.rests_before(block)
        self._turn(block)
        return self._rest(self._seconds(block.action), block)

    def _turn(self, block: Block) -> None:
        action = block.action
        if isinstance(action, SpindleRun):
            self.spindle.command(self.t, block.rpm)
            self._speed_wanted = True
        elif isinstance(action, SpindleStop | SpindleLock | SpindleOrient) or (
            isinstance(action, ProgramEnd) and action.reset
        ):
            self.spindle.command(self.t, 0.0)
            self._speed_wanted = False

    def _seconds(self, action: Action) -> float:
        collet = self._machine.collet
        if isinstance(action, Dwell):
            return action.seconds
        if isinstance(action, SpindleLock) or (isinstance(action, SpindleStop) and action.stands):
            return self._until_still()
        if isinstance(action, SpindleOrient):
            return self._until_still() + orienting(self._machine.spindle, action.sense)
        if isinstance(action, Collet):
            return collet.close_time if action.closed else collet.open_time
        return 0.0

    def _until_still(self) -> float:
        return max(0.0, self.spindle.still_at(self._machine.spindle.stop_below) - self.t)

    def _refuse(self, why: str) -> None:
        line = self._moving.first.line if self._moving.first else 0
        hint = "change the move named in the message"
        self._refused.append(Diagnostic(line, 0, Severity.ERROR, "impossible-motion", why, hint))
        self._source, self._back = iter(()), None


def _like(each: Block | Series) -> Block:
    """Return the block, or the pattern of a series."""
    return each.pattern if isinstance(each, Series) else each


def timed_blocks(timeline: Timeline) -> Iterator[TimedBlock]:
    """Yield every elementary block with its start and end in seconds. Waits belong to no block."""
    for span in timeline.spans():
        yield from span.times()


def timed_series(timeline: Timeline) -> Iterator[TimedBlock | TimedSeries]:
    """Yield the same as ``timed_blocks``, but each series of moves as one item."""
    for span in timeline.spans():
        yield from span.times_of_parts()
