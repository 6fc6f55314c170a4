"""Timeline of a program, with the start and end of each elementary block, planned as in a run."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from copy import copy
from dataclasses import replace
from itertools import chain
from typing import NamedTuple

from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.actions import (
    Action,
    ColletSwitch,
    Dwell,
    ProgramEnd,
    SpindleLock,
    SpindlePositioning,
    SpindleRun,
    SpindleStop,
)
from core.interpreter.shared.elementary_blocks import (
    Block,
    BlockKind,
    SectionEndDetector,
    StraightMoveSeries,
    TimedSeries,
)
from core.interpreter.shared.interpretation import InterpreterPass
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.motion.axis_limits import MotionError, MotionLimits
from core.motion.section_plans import SectionPlan
from core.motion.window_planner import PlannedChunk, WindowPlanner
from core.proving.proof_report import sort_findings
from core.proving.spindle_forecast import (
    SETTLING_TIME_S,
    THREAD_START_LEAD_S,
    SpindleForecast,
    calculate_max_orientation_time_s,
)

# --- blocks without times -------------------------------------------------------------------------------


BlockGroup = list[Block] | StraightMoveSeries
"""Consecutive blocks, either single or as a move series."""


class PendingBlocks:
    """Blocks that have been passed to the motion planner but have no times yet.

    A series of moves is divided only if necessary.
    """

    def __init__(self) -> None:
        self._parts: deque[BlockGroup] = deque()

    @property
    def first_block(self) -> Block | None:
        """Return the oldest pending block, or None if no block is pending."""
        return self._parts[0][0] if self._parts else None

    def append(self, blocks: Block | StraightMoveSeries) -> None:
        """Append a block or a series."""
        if isinstance(blocks, StraightMoveSeries):
            self._parts.append(blocks)
        elif self._parts and isinstance(self._parts[-1], list):
            self._parts[-1].append(blocks)
        else:
            self._parts.append([blocks])

    def pop_blocks(self, count: int) -> tuple[BlockGroup, ...]:
        """Remove and return the ``count`` oldest blocks."""
        taken: list[BlockGroup] = []
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
"""Block with its start and end time on the program clock, in seconds."""


class MotionSpan(NamedTuple):
    """A span of motion with the blocks that end in it and their times.

    The span starts at ``start_time_s``.
    """

    start_time_s: float
    planned_chunk: PlannedChunk
    block_groups: tuple[BlockGroup, ...]

    @property
    def blocks(self) -> list[Block]:
        """Return the blocks that end in the span.

        The blocks of a move series are created again on each access.
        """
        return list(chain.from_iterable(self.block_groups))

    @property
    def last_block(self) -> Block | None:
        """Return the last block that ends in the span, or None if no block ends in it."""
        return self.block_groups[-1][-1] if self.block_groups else None

    @property
    def end_time_s(self) -> float:
        """Return the end time of the span in seconds.

        The next span may continue without a stop.
        """
        return self.start_time_s + self.planned_chunk.profile.duration_s

    def iter_block_times(self) -> Iterator[TimedBlock]:
        """Yield each block with its start and end time in seconds on the program's time scale."""
        for each in self.iter_group_times():
            if isinstance(each, TimedSeries):
                yield from zip(
                    each.series, each.start_times_s.tolist(), each.end_times_s.tolist(), strict=True
                )
            else:
                yield each

    def iter_group_times(self) -> Iterator[TimedBlock | TimedSeries]:
        """Yield the same items as ``iter_block_times``, but with each series as a single item."""
        shift, first = self.start_time_s - self.planned_chunk.start_time_s, 0
        for part in self.block_groups:
            there = slice(first, first + len(part))
            t0, t1 = (
                self.planned_chunk.block_starts_s[there] + shift,
                self.planned_chunk.block_ends_s[there] + shift,
            )
            if isinstance(part, StraightMoveSeries):
                yield TimedSeries(part, t0, t1)
            else:
                yield from zip(part, t0.tolist(), t1.tolist(), strict=True)
            first = there.stop


class RestSpan(NamedTuple):
    """A period at rest from ``start_time_s`` to ``end_time_s``.

    ``block`` is a block without motion, or None for a wait before the next motion.
    """

    start_time_s: float
    end_time_s: float
    block: Block | None

    def iter_block_times(self) -> Iterator[TimedBlock]:
        """Yield the block, if any, with its start and end time in seconds on the program's time scale."""
        if self.block is not None:
            yield self.block, self.start_time_s, self.end_time_s

    def iter_group_times(self) -> Iterator[TimedBlock | TimedSeries]:
        """Yield the same items as ``iter_block_times``."""
        return self.iter_block_times()


_MAX_BLOCKS_AHEAD = 256  # blocks of a cycle that are planned together
_IDEAL_ACCELERATION = 1e12  # mm/s²; the ramps of an ideal machine are shorter than the displayed resolution


class RestState(NamedTuple):
    """The machine state at rest between two blocks.

    It contains the time, the spindle forecast, whether the spindle must still reach its speed, and the
    detector of the ends of path sections.
    """

    time_s: float
    spindle_forecast: SpindleForecast
    is_speed_pending: bool
    section_end_detector: SectionEndDetector


class Timeline:
    """One pass through a program in constant memory, which yields spans as they become final.

    If the machine cannot execute a block, the pass ends with an error in ``diagnostics``. An ``ideal``
    machine needs no time to accelerate, settle or plan, but has the same speed limits.
    """

    def __init__(
        self, interpreter: InterpreterPass, setup: InterpreterSetup, machine: Machine, *, ideal: bool = False
    ) -> None:
        self.interpreter = interpreter
        self.spindle = SpindleForecast(machine)
        self.time_s = 0.0
        self.start_position = setup.start
        self._machine = machine
        self._ideal = ideal
        limits = MotionLimits.from_axes(
            machine.axes, machine.timing.setpoint_duration_s, machine.limits.corner_tolerance
        )
        if ideal:
            limits = replace(limits, amax=(_IDEAL_ACCELERATION,) * len(limits.amax))
        self._planner = WindowPlanner(limits, rpm_max=machine.spindle.max_rpm)
        self._source = self.interpreter.generate_series()
        self._read_items: deque[Block | StraightMoveSeries] = deque()  # the next items, already read
        self._plans: deque[tuple[int, SectionPlan | None]] = deque()  # of the next sections, by block count
        self._cycle_line = 0  # line of the first block of the last path section
        self._moving = PendingBlocks()
        self._ends = SectionEndDetector()
        self._speed_wanted = False  # a speed was commanded, and no feed has waited for it yet
        self._refused: list[Diagnostic] = []

    @classmethod
    def from_program(
        cls,
        program: ProgramSource | SharedProgram,
        setup: InterpreterSetup,
        machine: Machine,
        *,
        is_ideal: bool = False,
    ) -> Timeline:
        """Return the timeline of a program, given as its source or in its parsed form."""
        reading = (
            program if isinstance(program, SharedProgram) else SharedProgram(program, strict=setup.strict)
        )
        return cls(reading.start_pass(setup), setup, machine, ideal=is_ideal)

    @property
    def rest_state(self) -> RestState:
        """Return the state from which another path through the program continues."""
        return RestState(self.time_s, copy(self.spindle), self._speed_wanted, copy(self._ends))

    def continue_from(self, rest_state: RestState) -> None:
        """Continue from the rest state of another timeline.

        Without this call, the timeline starts at the beginning of the program.
        """
        self.time_s, self.spindle, self._speed_wanted = (
            rest_state.time_s,
            copy(rest_state.spindle_forecast),
            rest_state.is_speed_pending,
        )
        self._ends = copy(rest_state.section_end_detector)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Return the diagnostics of parsing and interpreting so far, in the order of lines."""
        return sort_findings([*self.interpreter.diagnostics, *self._refused])

    @property
    def has_errors(self) -> bool:
        """Return whether the diagnostics contain an error."""
        return any(d.severity is Severity.ERROR for d in self.diagnostics)

    def iter_spans(self) -> Iterator[MotionSpan | RestSpan]:
        """Yield the spans of the program in time order, without gaps."""
        while (each := self._next()) is not None:
            if isinstance(each, StraightMoveSeries) or each.moves:
                yield from self._path_section(each)
            else:
                yield self._action(each)

    def _next(self) -> Block | StraightMoveSeries | None:
        return self._read_items.popleft() if self._read_items else next(self._source, None)

    def _path_section(self, each: Block | StraightMoveSeries) -> Iterator[MotionSpan | RestSpan]:
        """Yield the spans of one path section, which starts and ends at rest."""
        first = _template_block(each)
        if self._ends.needs_standstill_before(first):
            self._ends.record_standstill(first)
        if not first.rapid:
            yield from self._wait_for_speed()
        yield self._rest(self._wait_seconds(self._machine.timing.commit_time_s))
        if first.kind is BlockKind.THREAD and not self._ideal:
            yield self._make_index_wait(first)
        start = self.time_s - self._planner.planned_time_s
        try:
            for chunk in self._plan_section(each):
                yield self._moved(start, chunk)
            yield self._rest(self._wait_seconds(SETTLING_TIME_S))
        except MotionError as error:
            self._refuse(str(error))

    def _plan_section(self, each: Block | StraightMoveSeries) -> Iterator[PlannedChunk]:
        """Yield the motion of the path section that starts with ``each``.

        If a cycle creates several sections from one line, those from the second section on are planned
        together.
        """
        line = each.line if isinstance(each, Block) else 0
        if not self._plans and isinstance(each, Block) and line == self._cycle_line:
            self._plan_cycle(each)
        self._cycle_line = line
        count, plan = self._plans.popleft() if self._plans else (0, None)
        if plan is None:
            yield from self._planner.plan_blocks(self._section_blocks(each))
            yield from self._planner.finish_section()
            return
        self._moving.append(each)
        for _ in range(count - 1):
            block = self._read_items.popleft()
            self._ends.needs_standstill_before(_template_block(block))
            self._moving.append(block)
        yield self._planner.accept_section(plan)

    def _plan_cycle(self, first: Block) -> None:
        """Plan the complete path sections that start with ``first`` and come from its line.

        Dwells between these sections are permitted, such as the dwells of a peck drilling cycle.
        """
        ends, sections = copy(self._ends), [[first]]
        for each in self._read_blocks_ahead(first.line):
            if ends.needs_standstill_before(each):
                ends.record_standstill(each)
                sections.append([])
            if each.moves:
                sections[-1].append(each)
        del sections[-1]  # more blocks may follow in it
        if sections := [section for section in sections if section]:
            plans = self._planner.plan_sections_ahead(sections)
            self._plans.extend(zip(map(len, sections), plans, strict=True))

    def _read_blocks_ahead(self, line: int) -> Iterator[Block]:
        """Yield the next moves and dwells of the program line ``line``, without consuming them."""
        for at in range(_MAX_BLOCKS_AHEAD):
            if at == len(self._read_items):
                item = next(self._source, None)
                if item is None:
                    return
                self._read_items.append(item)
            each = self._read_items[at]
            if isinstance(each, StraightMoveSeries) or each.line != line:
                return
            if not (each.moves or isinstance(each.action, Dwell)):
                return
            yield each

    def _section_blocks(
        self, each: Block | StraightMoveSeries | None
    ) -> Iterator[Block | StraightMoveSeries]:
        """Yield the blocks of the path section that starts with ``each``."""
        while each is not None:
            self._moving.append(each)
            yield each
            each = self._next()
            if each is not None and self._ends.needs_standstill_before(_template_block(each)):
                self._read_items.appendleft(each)
                return

    def _make_index_wait(self, block: Block) -> RestSpan:
        """Return the rest span until the axes may start at the spindle index, at most one revolution.

        The corresponding rule of the executor is in docs/decisions/0016-threads-follow-the-spindle.md.
        """
        turn = abs(self.spindle.calculate_speed_at(self.time_s)) / 60.0
        if not turn:
            return self._rest(0.0)
        ramp = block.feed * turn / (2.0 * self._machine.axes[1].max_acceleration)
        ahead = abs(self.spindle.calculate_revolutions_at(self.time_s)) + turn * (ramp + THREAD_START_LEAD_S)
        return self._rest(THREAD_START_LEAD_S + (math.ceil(ahead - 1e-9) - ahead) / turn)

    def _moved(self, start: float, chunk: PlannedChunk) -> MotionSpan:
        span = MotionSpan(
            start + chunk.start_time_s, chunk, self._moving.pop_blocks(len(chunk.block_numbers))
        )
        self.time_s = span.end_time_s
        last = span.last_block
        if last is not None and last.css is not None:
            self._follow_css(last.rpm)
        return span

    def _follow_css(self, rpm: float) -> None:
        """Set the spindle speed to ``rpm``, which constant surface speed (CSS) has reached.

        If the spindle has not yet reached its speed, command a ramp to ``rpm`` instead.
        """
        if self._speed_wanted:
            self.spindle.command_speed(self.time_s, rpm)
        else:
            self.spindle.set_speed(self.time_s, rpm)

    def _wait_for_speed(self) -> Iterator[RestSpan]:
        """Yield the rest span in which the spindle reaches its speed before a feed, if it must ramp."""
        if self._speed_wanted:
            self._speed_wanted = False
            yield self._rest(
                self._wait_seconds(max(0.0, self.spindle.calculate_at_speed_time_s() - self.time_s))
            )

    def _wait_seconds(self, seconds: float) -> float:
        """Return the waiting time in seconds, which is 0 for an ideal machine."""
        return 0.0 if self._ideal else seconds

    def _rest(self, seconds: float, block: Block | None = None) -> RestSpan:
        span = RestSpan(self.time_s, self.time_s + seconds, block)
        self.time_s = span.end_time_s
        return span

    def _action(self, block: Block) -> RestSpan:
        assert block.action is not None
        self._ends.needs_standstill_before(block)
        self._turn(block)
        return self._rest(self._seconds(block.action), block)

    def _turn(self, block: Block) -> None:
        action = block.action
        if isinstance(action, SpindleRun):
            self.spindle.command_speed(self.time_s, block.rpm)
            self._speed_wanted = True
        elif isinstance(action, SpindleStop | SpindleLock | SpindlePositioning) or (
            isinstance(action, ProgramEnd) and action.reset
        ):
            self.spindle.command_speed(self.time_s, 0.0)
            self._speed_wanted = False

    def _seconds(self, action: Action) -> float:
        collet = self._machine.collet
        if isinstance(action, Dwell):
            return action.seconds
        if isinstance(action, SpindleLock) or (
            isinstance(action, SpindleStop) and action.waits_for_standstill
        ):
            return self._until_still()
        if isinstance(action, SpindlePositioning):
            return self._until_still() + calculate_max_orientation_time_s(self._machine.spindle, action.sense)
        if isinstance(action, ColletSwitch):
            return collet.close_time_s if action.closed else collet.open_time_s
        return 0.0

    def _until_still(self) -> float:
        return max(
            0.0, self.spindle.calculate_slowdown_time_s(self._machine.spindle.stop_below) - self.time_s
        )

    def _refuse(self, why: str) -> None:
        line = self._moving.first_block.line if self._moving.first_block else 0
        hint = "change the move named in the message"
        self._refused.append(Diagnostic(line, 0, Severity.ERROR, "impossible-motion", why, hint))
        self._source = iter(())
        self._read_items.clear()
        self._plans.clear()


def _template_block(each: Block | StraightMoveSeries) -> Block:
    """Return the block itself, or the pattern block from which the moves of a series are made."""
    return each.pattern if isinstance(each, StraightMoveSeries) else each


def iter_timed_blocks(timeline: Timeline) -> Iterator[TimedBlock]:
    """Yield every elementary block with its start and end time in seconds.

    Waits do not belong to a block.
    """
    for span in timeline.iter_spans():
        yield from span.iter_block_times()


def iter_timed_series(timeline: Timeline) -> Iterator[TimedBlock | TimedSeries]:
    """Yield the same items as ``iter_timed_blocks``, but with each series as a single item."""
    for span in timeline.iter_spans():
        yield from span.iter_group_times()
