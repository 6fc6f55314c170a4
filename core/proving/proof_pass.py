"""One proved pass through a program: findings in its blocks, and sums of times and lengths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from core.geometry.lines_and_arcs import arc_sweep
from core.interpreter.shared.actions import Dwell, ProgramStop
from core.interpreter.shared.elementary_blocks import Block, Floats, Kind, Series
from core.interpreter.shared.machine_requirements import Need, first_needs, needs_of
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect, Source
from core.machine.machine_model import Machine
from core.message import Message, join_messages
from core.proving.checks.machine_checks import CuttingChecks, c_findings, travel_findings
from core.proving.program_timeline import MotionSpan, Part, RestSpan, Timeline
from core.proving.proof_report import MillFigures, Range, Reach, Report, Times, in_order

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove

_TURN = 360.0
_ROUNDING = 1e-9

# --- sums -----------------------------------------------------------------------------------------------


class Extent:
    """The range of values; (0, 0) without values."""

    def __init__(self) -> None:
        self.low, self.high = math.inf, -math.inf

    def see(self, *values: float) -> None:
        """Extend the range to these values."""
        self.low = min(self.low, *values)
        self.high = max(self.high, *values)

    @property
    def range(self) -> Range:
        """The least and the greatest value."""
        return (self.low, self.high) if self.low <= self.high else (0.0, 0.0)


def turned_range(low: float, high: float) -> Range:
    """Return the range of a modulo axis in degrees; 0 to 360 if it has passed through 0."""
    turns = math.floor(low / _TURN + _ROUNDING) * _TURN
    low, high = low - turns, high - turns
    return (max(low, 0.0), high) if high <= _TURN + _ROUNDING else (0.0, _TURN)


class Tally:
    """Sums of lengths in mm, and ranges in the program's frame, from the blocks in order."""

    def __init__(self) -> None:
        self.x, self.z, self.c, self.rpm, self.feed = Extent(), Extent(), Extent(), Extent(), Extent()
        self.axes: list[Extent] = []  # machine positions of the axes of a mill
        self.cutting_length = 0.0
        self.rapid_length = 0.0

    @property
    def reach(self) -> Reach:
        """The ranges that the program uses."""
        return Reach(self.x.range, self.z.range, self.c.range, self.rpm.range, self.feed.range)

    def add(self, parts: Sequence[Part]) -> None:
        """Add the moving blocks of a span."""
        if not parts:
            return
        series = [part for part in parts if isinstance(part, Series)]
        if len(series) == len(parts) and len({part.pattern.rapid for part in series}) == 1:
            self._add_series(series)
            return
        table = np.concatenate([_columns(part) for part in parts], axis=1)
        length = np.hypot(table[2] - table[0], table[3] - table[1])
        first = 0
        for part in parts:
            if not isinstance(part, Series):
                self._curved(part, length[first : first + len(part)])
            first += len(part)
        rapid, turned, locked = table[8:] > 0.0
        self.rapid_length += float(length[rapid].sum())
        self.cutting_length += float(length[~rapid].sum())
        for span, column in ((self.x, 2), (self.z, 3), (self.c, 4)):
            span.see(float(table[column].min()), float(table[column].max()))
        in_degrees = turned | (length == 0.0)  # rapids of C only, and blocks without motion
        if not in_degrees.all():
            self._feeds(*table[5:8, ~in_degrees])
        self._turning(table[5, ~(turned | locked)])

    def _add_series(self, parts: Sequence[Series]) -> None:
        """Add series that are all rapids or all feeds, without a table of their equal values."""
        x0, z0, x, z = (np.concatenate([getattr(part, name) for part in parts]) for name in _ENDS)
        length = np.hypot(x - x0, z - z0)
        total = float(length.sum())
        if parts[0].pattern.rapid:
            self.rapid_length += total
        else:
            self.cutting_length += total
        self.x.see(float(x.min()), float(x.max()))
        self.z.see(float(z.min()), float(z.max()))
        self.c.see(*(part.pattern.c for part in parts))
        first = 0
        for part in parts:
            like, moves = part.pattern, length[first : first + len(part)] != 0.0
            first += len(part)
            rpm = np.array([like.rpm])
            if moves.any():
                feeds = np.array([like.feed]) if part.feed is None else part.feed[moves]
                self._feeds(rpm, feeds, np.array([like.per_rev]))
            if not like.modal.c_locked:
                self._turning(rpm)

    def _curved(self, blocks: Sequence[Block], length: Floats) -> None:
        """Store the lengths of moves that are not straight lines of X and Z."""
        for index, block in enumerate(blocks):
            if block.travel is not None:
                length[index] = 0.0 if block.swivels else block.travel.length
                self._see_axes(block)
            elif block.kind is Kind.ARC:
                length[index] = self._arc(block)
            elif block.plane is not None:
                length[index] = self._plane(block, block.plane)

    def _see_axes(self, block: Block) -> None:
        if not self.axes:
            self.axes = [Extent() for _ in block.machine_end]
        for span, reach in zip(self.axes, block.machine_reach(), strict=True):
            span.see(*reach)

    def _reach(self, block: Block) -> None:
        low_x, high_x, low_z, high_z = block.reach()
        self.x.see(low_x, high_x)
        self.z.see(low_z, high_z)

    def _arc(self, block: Block) -> float:
        self._reach(block)
        _, sweep = arc_sweep(block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise)
        return abs(sweep) * math.hypot(block.x0 - block.cx, block.z0 - block.cz)

    def _plane(self, block: Block, way: PlaneMove) -> float:
        self._reach(block)
        low, high = way.reach()
        self.c.see(float(low[2]), float(high[2]))
        return way.length

    def _feeds(self, rpm: Floats, feed: Floats, per_rev: Floats) -> None:
        path_speed = np.where(per_rev > 0, feed * np.abs(rpm) / 60, feed)
        self.feed.see(float(path_speed.min()), float(path_speed.max()))

    def _turning(self, rpm: Floats) -> None:
        """Extend the range of spindle speeds, without those of the C axis."""
        turning = np.abs(rpm[rpm != 0])
        if turning.size:
            self.rpm.see(float(turning.min()), float(turning.max()))


def _columns(part: Part) -> Floats:
    """Return the values of m blocks that are summed: columns (11, m)."""
    if not isinstance(part, Series):
        return np.array([_figures(block) for block in part]).T
    columns = np.repeat(np.array([_figures(part.pattern)]).T, len(part), axis=1)
    columns[:4] = part.x0, part.z0, part.x, part.z
    if part.feed is not None:
        columns[_FEED] = part.feed
    return columns


_FEED = 6  # index of the feed in the columns
_ENDS = ("x0", "z0", "x", "z")


def _figures(b: Block) -> tuple[float, ...]:
    turned = b.kind is Kind.ROTATE or b.swivels
    return b.x0, b.z0, b.x, b.z, b.c, b.rpm, b.feed, b.per_rev, b.rapid, turned, b.modal.c_locked


_AT_ONCE = 1000  # blocks that are evaluated together
MAX_FINDINGS = 100  # A wrong offset can make every line leave the travel, so more findings would be useless.


class ProofPass:
    """Findings and sums of one pass through a program."""

    def __init__(self, machine: Machine, checks: CuttingChecks) -> None:
        self._machine = machine
        self._checks = checks
        self._tally = Tally()
        self._unseen: list[Part] = []
        self._waiting = 0  # number of blocks in these parts
        self._cutting = self._rapid = self._dwell = self._wait = 0.0
        self._beyond: dict[tuple[int, str], Diagnostic] = {}
        self._needs: tuple[Need, ...] = ()
        self._before: Block | None = None
        self.last: Block | None = None
        self.last_move: Block | None = None
        self.elementary = 0
        self._stops = self._optional_stops = 0

    @property
    def checks(self) -> CuttingChecks:
        """The cutting checks in their present state."""
        return self._checks

    def add(self, span: MotionSpan | RestSpan) -> None:
        """Add the next span of the timeline."""
        if isinstance(span, MotionSpan):
            self._moved(span)
        else:
            self._rested(span)

    def _moved(self, span: MotionSpan) -> None:
        spent = span.chunk.t1 - span.chunk.t0
        rapid = float(spent[_rapid(span.parts)].sum())
        self._rapid += rapid
        self._cutting += float(spent.sum()) - rapid
        self._unseen += span.parts
        for part in span.parts:
            self._checks.look(part)
        self._waiting += len(spent)
        self.elementary += len(spent)
        if span.last is not None:
            self.last = self.last_move = span.last
        if self._waiting >= _AT_ONCE:
            self._see()

    def _see(self) -> None:
        """Evaluate the collected blocks together, which is faster for short motions."""
        parts, self._unseen, self._waiting = self._unseen, [], 0
        self._tally.add(parts)
        for part in parts:
            self._need(part)
            self._look_beyond(part)

    def _look_beyond(self, part: Part) -> None:
        if len(self._beyond) >= MAX_FINDINGS:
            return
        beyond = travel_findings(part, self._machine, self._checks.dialect)
        for finding in chain(beyond, c_findings(part, self._machine)):
            self._beyond.setdefault((finding.line, finding.message[:1]), finding)
            if len(self._beyond) >= MAX_FINDINGS:
                return

    def _need(self, blocks: Part) -> None:
        """Collect the required machine functions, which only a controller with its own planner can lack."""
        if blocks and self._machine.backend == "grblhal":
            # all blocks of a series need the same
            unlike = blocks[:1] if isinstance(blocks, Series) else blocks
            self._needs = first_needs((*self._needs, *needs_of(unlike, self._before)))
            self._before = blocks[-1]

    def _rested(self, span: RestSpan) -> None:
        spent = span.t1 - span.t0
        if span.block is None:
            self._wait += spent
            return
        self.elementary += 1
        self.last = span.block
        self._checks.look([span.block])
        self._need([span.block])
        if isinstance(span.block.action, ProgramStop):
            self._optional_stops += span.block.action.optional
            self._stops += not span.block.action.optional
        if isinstance(span.block.action, Dwell):
            self._dwell += spent
        else:
            self._wait += spent

    def report(self, timeline: Timeline, source: Source) -> Report:
        """Return the report after the whole program."""
        self._see()
        beyond = list(self._beyond.values())[:MAX_FINDINGS]
        told = map(_as_assumed, timeline.diagnostics)
        found = [*told, *beyond, *self._checks.findings]
        interpreter, last, tally = timeline.interpreter, self.last, self._tally
        end = self.last_move  # in its own frame, because M30 removes the work shift without a motion
        return Report(
            name=source.name,
            dialect=source.dialect,
            metric=bool(last and last.modal.metric),
            blocks=interpreter.source_blocks,
            elementary=self.elementary,
            diagnostics=in_order(found),
            times=Times(self._cutting, self._rapid, self._dwell, self._wait),
            cutting_length=tally.cutting_length,
            rapid_length=tally.rapid_length,
            tools=tuple(sorted(interpreter.used_tools)),
            missing_tools=tuple(sorted(interpreter.missing_tools)),
            reach=self._lathe_reach(source),
            final=(end.x, end.z, _shown_c(end)) if end else _lathe(timeline.start),
            machine_final=end.machine_end if end else timeline.start,
            mill=self._mill(),
            needs=first_needs((*self._needs, *interpreter.lacking)),
            stops=self._stops,
            optional_stops=self._optional_stops,
            corner_tolerance=self._machine.limits.corner_tolerance,
        )

    def _lathe_reach(self, source: Source) -> Reach:
        """Return the ranges of a lathe, with C of a SINUMERIK program as its axis counts."""
        reach = self._tally.reach
        modulo = source.dialect is Dialect.SINUMERIK and self._machine.c_enabled and self._machine.c_modulo
        return replace(reach, c=turned_range(*reach.c)) if modulo else reach

    def _mill(self) -> MillFigures | None:
        if self._machine.kind != "mill":
            return None
        return MillFigures(
            axes=tuple(axis.name for axis in self._machine.axes),
            reach=tuple(
                turned_range(*span.range) if axis.rotary and axis.travel is None else span.range
                for axis, span in zip(self._machine.axes, self._tally.axes, strict=False)
            ),
            final=self.last.swivel if self.last else None,
        )


def _as_assumed(found: Diagnostic) -> Diagnostic:
    """Return an error that depends on an assumed position as a warning, because a run would stop there."""
    if not found.assumed or found.severity is not Severity.ERROR:
        return found
    hint = Message(
        "{hint} Assumed: {assumed}; nothing after this point is proved.",
        hint=found.hint,
        assumed=join_messages(", ", found.assumed),
    )
    return replace(found, severity=Severity.WARNING, hint=hint)


def _rapid(parts: Sequence[Part]) -> npt.NDArray[np.bool_]:
    """Return for each block whether it is a rapid."""
    found = [np.empty(0, bool)]
    for part in parts:
        alike = [part.pattern] if isinstance(part, Series) else part
        rapid = np.array([block.rapid for block in alike], bool)
        found.append(np.broadcast_to(rapid, len(part)))
    return np.concatenate(found)


def _lathe(start: tuple[float, ...]) -> tuple[float, float, float]:
    """Return X, Z and C of a start in the machine's order."""
    return start[0], start[1], start[-1]


def _shown_c(block: Block) -> float:
    """Return C at the end of a block as the program counts it."""
    return block.c % 360.0 if block.modal.wraps_c else block.c
