"""A program laid out in time: every elementary block with its start and end, by the law that a run obeys."""

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

# --- blocks that are not timed yet ----------------------------------------------------------------------


Part = list[Block] | Series
"""Blocks one after the other that have come one by one, or as a series."""


class BlocksInMotion:
    """Blocks that the planner has and that are not timed yet; series are kept whole where they can be."""

    def __init__(self) -> None:
        self._parts: deque[Part] = deque()

    @property
    def first(self) -> Block | None:
        """The block that has waited longest."""
        return self._parts[0][0] if self._parts else None

    def append(self, each: Block | Series) -> None:
        """Put in behind the others."""
        if isinstance(each, Series):
            self._parts.append(each)
        elif self._parts and isinstance(self._parts[-1], list):
            self._parts[-1].append(each)
        else:
            self._parts.append([each])

    def take(self, count: int) -> tuple[Part, ...]:
        """Take so many out, those that have waited longest."""
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
    """A span of motion from ``t0`` on, and the blocks that end in it with when they start and end."""

    t0: float
    chunk: Chunk
    parts: tuple[Part, ...]

    @property
    def blocks(self) -> list[Block]:
        """The blocks that end in it, those of series made for whoever asks."""
        return list(chain.from_iterable(self.parts))

    @property
    def last(self) -> Block | None:
        """The last block that ends in it."""
        return self.parts[-1][-1] if self.parts else None

    @property
    def t1(self) -> float:
        """When the span ends; the next one may go on without a stop."""
        return self.t0 + self.chunk.profile.duration

    def times(self) -> Iterator[TimedBlock]:
        """Each block with its start and end on the program's clock."""
        for each in self.times_of_parts():
            if isinstance(each, TimedSeries):
                yield from zip(each.series, each.t0.tolist(), each.t1.tolist(), strict=True)
            else:
                yield each

    def times_of_parts(self) -> Iterator[TimedBlock | TimedSeries]:
        """The same, series in one."""
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
    """At rest from ``t0`` to ``t1``: a block that does not move, or (None) a wait before the next motion."""

    t0: float
    t1: float
    block: Block | None

    def times(self) -> Iterator[TimedBlock]:
        """The block, if any, with its start and end on the program's clock."""
        if self.block is not None:
            yield self.block, self.t0, self.t1

    def times_of_parts(self) -> Iterator[TimedBlock | TimedSeries]:
        """The same."""
        return self.times()


_AT_ONCE = 1e12  # mm/s²: the ramps of an ideal machine are shorter than any digit that is shown


class RestState(NamedTuple):
    """A place between two blocks at rest: time, spindle, whether a feed has to wait for its speed, and where
    path sections end from there on."""

    t: float
    spindle: SpindleForecast
    speed_wanted: bool
    ends: SectionEnds


class Timeline:
    """One pass through a program, once. Constant memory: spans are handed out as they are settled.

    Where the machine cannot do what a block asks, the pass ends with an error in ``diagnostics``. An
    ``ideal`` machine needs no time to accelerate, to settle or to plan; its limits of speed are the same.
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
        self._back: Block | Series | None = None  # what ended a motion and is still to come
        self._moving = BlocksInMotion()
        self._ends = SectionEnds()
        self._speed_wanted = False  # a speed was commanded that no feed has waited for yet
        self._refused: list[Diagnostic] = []

    @classmethod
    def of(
        cls, program: Source | ReadProgram, setup: Setup, machine: Machine, *, ideal: bool = False
    ) -> Timeline:
        """The timeline of a program's text, or of its reading."""
        reading = program if isinstance(program, ReadProgram) else ReadProgram(program, strict=setup.strict)
        return cls(reading.begin(setup), setup, machine, ideal=ideal)

    @property
    def rest_state(self) -> RestState:
        """What another way through the program, which leaves this one here, goes on with."""
        return RestState(self.t, copy(self.spindle), self._speed_wanted, copy(self._ends))

    def go_on(self, rest_state: RestState) -> None:
        """Begin where another timeline has stood at rest, not at the start of the program."""
        self.t, self.spindle, self._speed_wanted = (
            rest_state.t,
            copy(rest_state.spindle),
            rest_state.speed_wanted,
        )
        self._ends = copy(rest_state.ends)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """What reading and interpreting have found so far, in the order of lines."""
        return in_order([*self.interpreter.diagnostics, *self._refused])

    @property
    def errors(self) -> bool:
        """Whether the program will be refused."""
        return any(d.severity is Severity.ERROR for d in self.diagnostics)

    def spans(self) -> Iterator[MotionSpan | RestSpan]:
        """The program in time order, without gaps."""
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
        """One path section, from rest to rest."""
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
        """The blocks of a path section that begins with ``each``."""
        while each is not None:
            self._moving.append(each)
            yield each
            each = self._next()
            if each is not None and self._ends.rests_before(_like(each)):
                break
        self._back = each

    def _index(self, block: Block) -> RestSpan:
        """Until the slides may start, so that they are in step with an index of the spindle: see the
        executor's rule in docs/decisions/0016-threads-follow-the-spindle.md. Up to one turn."""
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
        """Constant surface speed has led to this speed; one not reached yet is still being ramped to."""
        if self._speed_wanted:
            self.spindle.command(self.t, rpm)
        else:
            self.spindle.settle(self.t, rpm)

    def _at_speed(self) -> Iterator[RestSpan]:
        """Before a feed the spindle must have been at speed for as long as the machine file says."""
        if self._speed_wanted:
            self._speed_wanted = False
            yield self._rest(self._wait(max(0.0, self.spindle.ready_at() - self.t)))

    def _wait(self, seconds: float) -> float:
        """What a real machine waits for; an ideal one does not."""
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
    """The block, or one such as each of the series."""
    return each.pattern if isinstance(each, Series) else each


def timed_blocks(timeline: Timeline) -> Iterator[TimedBlock]:
    """Every elementary block with its start and end, s; waits belong to no block."""
    for span in timeline.spans():
        yield from span.times()


def timed_series(timeline: Timeline) -> Iterator[TimedBlock | TimedSeries]:
    """The same, series of moves in one."""
    for span in timeline.spans():
        yield from span.times_of_parts()
