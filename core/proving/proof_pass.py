"""One proved pass through a program: the findings in its blocks, and the totals of times and lengths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from core.geometry.lines_and_arcs import compute_arc_sweep
from core.interpreter.shared.actions import Dwell, ProgramStop
from core.interpreter.shared.elementary_blocks import Block, BlockKind, FloatArray, StraightMoveSeries
from core.interpreter.shared.machine_requirements import (
    MachineRequirement,
    list_requirements,
    remove_repeated_requirements,
)
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.message import Message, join_messages
from core.proving.checks.machine_checks import CuttingChecks, check_c_motion, check_travel
from core.proving.program_timeline import BlockGroup, MotionSpan, RestSpan, Timeline
from core.proving.proof_report import (
    MillResults,
    ProgramRanges,
    ProgramTimes,
    ProofReport,
    ValueRange,
    sort_findings,
)

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove

_TURN = 360.0
_ROUNDING = 1e-9

# --- sums -----------------------------------------------------------------------------------------------


class RangeTracker:
    """Tracker of the smallest and largest of the added values; the range is (0, 0) without values."""

    def __init__(self) -> None:
        self.minimum, self.maximum = math.inf, -math.inf

    def include_values(self, *values: float) -> None:
        """Extend the range to include the given values."""
        self.minimum = min(self.minimum, *values)
        self.maximum = max(self.maximum, *values)

    @property
    def min_and_max(self) -> ValueRange:
        """Return the least and the greatest value that were added."""
        return (self.minimum, self.maximum) if self.minimum <= self.maximum else (0.0, 0.0)


def find_modulo_angle_range(minimum: float, maximum: float) -> ValueRange:
    """Return the range of a modulo axis in degrees.

    The range is 0 to 360 if the axis has passed through 0.
    """
    turns = math.floor(minimum / _TURN + _ROUNDING) * _TURN
    minimum, maximum = minimum - turns, maximum - turns
    return (max(minimum, 0.0), maximum) if maximum <= _TURN + _ROUNDING else (0.0, _TURN)


class ProgramTotals:
    """Totals of lengths in mm, and ranges in the program's frame.

    Blocks must be added in program order.
    """

    def __init__(self) -> None:
        self.x_range, self.z_range, self.c_range, self.rpm_range, self.feed_range = (
            RangeTracker(),
            RangeTracker(),
            RangeTracker(),
            RangeTracker(),
            RangeTracker(),
        )
        self.axis_ranges: list[RangeTracker] = []  # machine positions of the axes of a mill
        self.cutting_length_mm = 0.0
        self.rapid_length_mm = 0.0

    @property
    def program_ranges(self) -> ProgramRanges:
        """Return the ranges that the program uses."""
        return ProgramRanges(
            self.x_range.min_and_max,
            self.z_range.min_and_max,
            self.c_range.min_and_max,
            self.rpm_range.min_and_max,
            self.feed_range.min_and_max,
        )

    def add_blocks(self, parts: Sequence[BlockGroup]) -> None:
        """Add the moving blocks of a span."""
        if not parts:
            return
        series = [part for part in parts if isinstance(part, StraightMoveSeries)]
        if len(series) == len(parts) and len({part.pattern.rapid for part in series}) == 1:
            self._add_series(series)
            return
        table = np.concatenate([_summed_columns(part) for part in parts], axis=1)
        length = np.hypot(table[2] - table[0], table[3] - table[1])
        first = 0
        for part in parts:
            if not isinstance(part, StraightMoveSeries):
                self._add_curved(part, length[first : first + len(part)])
            first += len(part)
        rapid, turned, locked = table[8:] > 0.0
        self.rapid_length_mm += float(length[rapid].sum())
        self.cutting_length_mm += float(length[~rapid].sum())
        for span, column in ((self.x_range, 2), (self.z_range, 3), (self.c_range, 4)):
            span.include_values(float(table[column].min()), float(table[column].max()))
        in_degrees = turned | (length == 0.0)  # rapids of C only, and blocks without motion
        if not in_degrees.all():
            self._feeds(*table[5:8, ~in_degrees])
        self._add_spindle_speeds(table[5, ~(turned | locked)])

    def _add_series(self, parts: Sequence[StraightMoveSeries]) -> None:
        """Add move series that are either all rapids or all feeds.

        Values that are equal in all moves are not expanded into a table.
        """
        x0, z0, x, z = (np.concatenate([getattr(part, name) for part in parts]) for name in _ENDS)
        length = np.hypot(x - x0, z - z0)
        total = float(length.sum())
        if parts[0].pattern.rapid:
            self.rapid_length_mm += total
        else:
            self.cutting_length_mm += total
        self.x_range.include_values(float(x.min()), float(x.max()))
        self.z_range.include_values(float(z.min()), float(z.max()))
        self.c_range.include_values(*(part.pattern.c for part in parts))
        first = 0
        for part in parts:
            like, moves = part.pattern, length[first : first + len(part)] != 0.0
            first += len(part)
            rpm = np.array([like.rpm])
            if moves.any():
                feeds = np.array([like.feed]) if part.feed is None else part.feed[moves]
                self._feeds(rpm, feeds, np.array([like.per_rev]))
            if not like.modal.c_locked:
                self._add_spindle_speeds(rpm)

    def _add_curved(self, blocks: Sequence[Block], length: FloatArray) -> None:
        """Correct the lengths of blocks that are not straight moves of X and Z."""
        for index, block in enumerate(blocks):
            if block.travel is not None:
                length[index] = 0.0 if block.has_angular_feed else block.travel.length
                self._see_axes(block)
            elif block.kind is BlockKind.ARC:
                length[index] = self._arc(block)
            elif block.plane is not None:
                length[index] = self._plane(block, block.plane)

    def _see_axes(self, block: Block) -> None:
        if not self.axis_ranges:
            self.axis_ranges = [RangeTracker() for _ in block.machine_end]
        for span, reach in zip(self.axis_ranges, block.compute_machine_bounds(), strict=True):
            span.include_values(*reach)

    def _reach(self, block: Block) -> None:
        low_x, high_x, low_z, high_z = block.reach()
        self.x_range.include_values(low_x, high_x)
        self.z_range.include_values(low_z, high_z)

    def _arc(self, block: Block) -> float:
        self._reach(block)
        _, sweep = compute_arc_sweep(
            block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise
        )
        return abs(sweep) * math.hypot(block.x0 - block.cx, block.z0 - block.cz)

    def _plane(self, block: Block, plane_move: PlaneMove) -> float:
        self._reach(block)
        low, high = plane_move.find_travel_range()
        self.c_range.include_values(float(low[2]), float(high[2]))
        return plane_move.length

    def _feeds(self, rpm: FloatArray, feed: FloatArray, per_rev: FloatArray) -> None:
        path_speed = np.where(per_rev > 0, feed * np.abs(rpm) / 60, feed)
        self.feed_range.include_values(float(path_speed.min()), float(path_speed.max()))

    def _add_spindle_speeds(self, rpm: FloatArray) -> None:
        """Extend the range of spindle speeds, ignoring rotations of the C axis."""
        turning = np.abs(rpm[rpm != 0])
        if turning.size:
            self.rpm_range.include_values(float(turning.min()), float(turning.max()))


def _summed_columns(part: BlockGroup) -> FloatArray:
    """Return the values of m blocks that contribute to the totals, as columns (11, m)."""
    if not isinstance(part, StraightMoveSeries):
        return np.array([_figures(block) for block in part]).T
    columns = np.repeat(np.array([_figures(part.pattern)]).T, len(part), axis=1)
    columns[:4] = part.x0, part.z0, part.x, part.z
    if part.feed is not None:
        columns[_FEED] = part.feed
    return columns


_FEED = 6  # index of the feed in the columns
_ENDS = ("x0", "z0", "x", "z")


def _figures(b: Block) -> tuple[float, ...]:
    turned = b.kind is BlockKind.ROTATE or b.has_angular_feed
    return b.x0, b.z0, b.x, b.z, b.c, b.rpm, b.feed, b.per_rev, b.rapid, turned, b.modal.c_locked


_MAX_BLOCKS_AT_ONCE = 1000  # blocks that are evaluated together
MAX_FINDINGS = 100  # A wrong offset can make every line leave the travel, so more findings would be useless.


class ProofPass:
    """The findings and the totals of one pass through a program."""

    def __init__(self, machine: Machine, checks: CuttingChecks) -> None:
        self._machine = machine
        self._checks = checks
        self._tally = ProgramTotals()
        self._unseen: list[BlockGroup] = []
        self._waiting = 0  # number of blocks in these parts
        self._cutting = self._rapid = self._dwell = self._wait = 0.0
        self._beyond: dict[tuple[int, str], Diagnostic] = {}
        self._needs: tuple[MachineRequirement, ...] = ()
        self._before: Block | None = None
        self.last_block: Block | None = None
        self.last_moving_block: Block | None = None
        self.elementary_block_count = 0
        self._stops = self._optional_stops = 0

    @property
    def cutting_checks(self) -> CuttingChecks:
        """Return the cutting checks in their current state."""
        return self._checks

    def add_span(self, span: MotionSpan | RestSpan) -> None:
        """Add the next span of the timeline."""
        if isinstance(span, MotionSpan):
            self._moved(span)
        else:
            self._rested(span)

    def _moved(self, span: MotionSpan) -> None:
        spent = span.planned_chunk.block_ends_s - span.planned_chunk.block_starts_s
        rapid = float(spent[_find_rapids(span.block_groups)].sum())
        self._rapid += rapid
        self._cutting += float(spent.sum()) - rapid
        self._unseen += span.block_groups
        for part in span.block_groups:
            self._checks.check_blocks(part)
        self._waiting += len(spent)
        self.elementary_block_count += len(spent)
        if span.last_block is not None:
            self.last_block = self.last_moving_block = span.last_block
        if self._waiting >= _MAX_BLOCKS_AT_ONCE:
            self._evaluate_pending()

    def _evaluate_pending(self) -> None:
        """Evaluate all collected blocks at once, which is faster when motions are short."""
        parts, self._unseen, self._waiting = self._unseen, [], 0
        self._tally.add_blocks(parts)
        for part in parts:
            self._collect_needs(part)
            self._look_beyond(part)

    def _look_beyond(self, part: BlockGroup) -> None:
        if len(self._beyond) >= MAX_FINDINGS:
            return
        beyond = check_travel(part, self._machine, self._checks.dialect)
        for finding in chain(beyond, check_c_motion(part, self._machine)):
            self._beyond.setdefault((finding.line, finding.message[:1]), finding)
            if len(self._beyond) >= MAX_FINDINGS:
                return

    def _collect_needs(self, blocks: BlockGroup) -> None:
        """Record the machine functions that blocks require.

        Only a controller with its own motion planner can lack such functions.
        """
        if blocks and self._machine.backend == "grblhal":
            # all blocks of a series need the same
            unlike = blocks[:1] if isinstance(blocks, StraightMoveSeries) else blocks
            self._needs = remove_repeated_requirements(
                (*self._needs, *list_requirements(unlike, self._before))
            )
            self._before = blocks[-1]

    def _rested(self, span: RestSpan) -> None:
        spent = span.end_time_s - span.start_time_s
        if span.block is None:
            self._wait += spent
            return
        self.elementary_block_count += 1
        self.last_block = span.block
        self._checks.check_blocks([span.block])
        self._collect_needs([span.block])
        if isinstance(span.block.action, ProgramStop):
            self._optional_stops += span.block.action.optional
            self._stops += not span.block.action.optional
        if isinstance(span.block.action, Dwell):
            self._dwell += spent
        else:
            self._wait += spent

    def make_report(self, timeline: Timeline, source: ProgramSource) -> ProofReport:
        """Return the report of the pass after the whole program has been added."""
        self._evaluate_pending()
        beyond = list(self._beyond.values())[:MAX_FINDINGS]
        warnings = map(_weaken_to_warning, timeline.diagnostics)
        found = [*warnings, *beyond, *self._checks.findings]
        interpreter, last, tally = timeline.interpreter, self.last_block, self._tally
        end = self.last_moving_block  # in its own frame, because M30 removes the work shift without a motion
        return ProofReport(
            name=source.name,
            dialect=source.dialect,
            is_metric=bool(last and last.modal.metric),
            block_count=interpreter.source_block_count,
            elementary_block_count=self.elementary_block_count,
            diagnostics=sort_findings(found),
            program_times=ProgramTimes(self._cutting, self._rapid, self._dwell, self._wait),
            cutting_length_mm=tally.cutting_length_mm,
            rapid_length_mm=tally.rapid_length_mm,
            tool_numbers=tuple(sorted(interpreter.used_tools)),
            missing_tool_numbers=tuple(sorted(interpreter.tools_without_offset)),
            program_ranges=self._lathe_ranges(source),
            final_position=(end.x, end.z, _displayed_c(end))
            if end
            else _lathe_position(timeline.start_position),
            machine_final_position=end.machine_end if end else timeline.start_position,
            mill_results=self._mill(),
            required_functions=remove_repeated_requirements((*self._needs, *interpreter.missing_functions)),
            stop_count=self._stops,
            optional_stop_count=self._optional_stops,
            corner_tolerance_mm=self._machine.limits.corner_tolerance,
        )

    def _lathe_ranges(self, source: ProgramSource) -> ProgramRanges:
        """Return the ranges of a lathe program.

        The C range of a SINUMERIK program follows the angle count of its C axis.
        """
        reach = self._tally.program_ranges
        modulo = (
            source.dialect is Dialect.SINUMERIK
            and self._machine.is_c_enabled
            and self._machine.is_c_axis_modulo
        )
        return replace(reach, c_range=find_modulo_angle_range(*reach.c_range)) if modulo else reach

    def _mill(self) -> MillResults | None:
        if self._machine.kind != "mill":
            return None
        return MillResults(
            axis_names=tuple(axis.name for axis in self._machine.axes),
            axis_ranges=tuple(
                find_modulo_angle_range(*span.min_and_max)
                if axis.is_rotary and axis.travel is None
                else span.min_and_max
                for axis, span in zip(self._machine.axes, self._tally.axis_ranges, strict=False)
            ),
            final_position=self.last_block.swivel if self.last_block else None,
        )


def _weaken_to_warning(finding: Diagnostic) -> Diagnostic:
    """Return the finding, as a warning if it is an error that depends on an assumed position.

    The hint states the assumption, and that nothing after this point is proved.
    """
    if not finding.assumptions or finding.severity is not Severity.ERROR:
        return finding
    hint = Message(
        "{hint} Assumed: {assumed}; nothing after this point is proved.",
        hint=finding.hint,
        assumed=join_messages(", ", finding.assumptions),
    )
    return replace(finding, severity=Severity.WARNING, hint=hint)


def _find_rapids(parts: Sequence[BlockGroup]) -> npt.NDArray[np.bool_]:
    """Return a mask of the blocks that are rapids."""
    found = [np.empty(0, bool)]
    for part in parts:
        alike = [part.pattern] if isinstance(part, StraightMoveSeries) else part
        rapid = np.array([block.rapid for block in alike], bool)
        found.append(np.broadcast_to(rapid, len(part)))
    return np.concatenate(found)


def _lathe_position(start: tuple[float, ...]) -> tuple[float, float, float]:
    """Return the X, Z and C of a start position, in the machine's order."""
    return start[0], start[1], start[-1]


def _displayed_c(block: Block) -> float:
    """Return the C angle at the end of a block as the program counts it, in degrees."""
    return block.c % 360.0 if block.modal.is_c_axis_modulo else block.c
