"""Checks of threads and taps: run-up and end of a pass, depth and pitch, and reversal of a tap."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from core.interpreter.shared.elementary_blocks import Kind
from core.message import Message
from core.part.swept_edge import FloatArray
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import Cut, TurnedPart
from core.proving.tip_moves import TipMove
from core.tool_edges import edge_name

_LATENCY = 0.08  # s before a drive follows a new command
_POINT = 60.0  # degrees, assumed angle of an unspecified thread
_DEEPER = 1.02  # fraction of the depth of a sharp V
_SOLID = 1.0  # pitches of depth in r; a thread is 0.6 deep, and tap holes are never that small
# fraction of a pitch, as between 1/2-12 and 1/2-13; floating holders are fed slightly slower
_OTHER_PITCH = 0.08
_OTHER_FEED = 0.15  # fraction of the feed in by which the feed out may differ
_GIVES = 12.7  # mm of length compensation of a tap holder
_IN_HOLE = 0.05  # mm
_NEAR = 1e-6  # mm
_MOST_STARTS = 24
_IDLE = 3  # passes
_SAME_END = 1.0  # mm of Z between passes of one thread


class Found(NamedTuple):
    """The result of a check for the move just checked, or for the move ``at``."""

    check: str
    text: str
    at: TipMove | None = None


class Drives(NamedTuple):
    """Limits of axis and spindle: mm/s² along Z and rpm/s of the spindle deceleration; 0 if unknown."""

    slide_accel: float = 0.0
    spindle_decel: float = 0.0


UNKNOWN = Drives()


@dataclass(slots=True)
class ThreadChecks:
    """Checks of threads, called with the moves in their order: ``before_cut`` and ``look`` for each cut.

    ``releases`` returns by T whether a tap holder reverses or releases the tap automatically.
    """

    drives: Drives = UNKNOWN
    releases: Callable[[int], bool] = lambda _: False
    stock_given: bool = False  # the stock is specified instead of assumed
    # line, first column, radii, and 1 for an outside thread
    _crest: tuple[int, int, FloatArray, float] | None = None
    _pass: tuple[TipMove, Cut] | None = None  # the last thread pass, until its end is known
    _fed: TipMove | None = None  # the last feed of a tap into its hole
    _entry: float = 0.0  # Z of the first material of the tap
    _idle: int = 0  # consecutive passes that stay outside the material
    _uncut: tuple[int, TipMove] | None = None  # T and first pass of a thread that has not cut yet
    _begun: TipMove | None = None  # =

    def before_cut(self, move: TipMove, part: TurnedPart) -> None:
        """Record the radii of the material before the first pass of a thread is cut."""
        if move.kind is not Kind.THREAD or (self._crest is not None and self._crest[0] == move.line):
            return
        z0, z1 = move.points[0][0], move.points[-1][0]
        short = math.copysign(min(move.per_rev, abs(z1 - z0) / 2.0), z0 - z1)  # the length next to a shoulder
        low, high = sorted((z0, z1 + short))
        there = slice(part.columns.at(low), part.columns.at(high))
        inside = self._in_bore(move, part, there)
        radii = part.innermost if inside else part.outermost
        self._crest = move.line, there.start, radii[there], -1.0 if inside else 1.0

    @staticmethod
    def _in_bore(move: TipMove, part: TurnedPart, there: slice) -> bool:
        """Return whether the thread is in a bore, with its material outside its edge."""
        inner = part.innermost[there]
        bored = inner[inner > 0.0]
        if not len(bored):
            return False
        edge = max(abs(r) for _, r in move.points)
        return abs(edge - float(bored.min())) < abs(float(part.outermost[there].max()) - edge)

    def look(
        self, move: TipMove, met: Cut, part: TurnedPart, shape: ToolShape | None, tool: int
    ) -> Iterator[Found]:
        """Yield the faults of a move that has just been cut."""
        goes_on = self._pass is not None and move.kind is Kind.THREAD  # the pull-out of the thread
        yield from self._end_of_pass(move)
        if shape is not None and shape.kind is ToolKind.TAP:
            yield from self._tap(move, met, shape, tool)
        else:
            self._fed = None
        if move.kind is Kind.THREAD and move.per_rev and not goes_on:
            yield from self._thread(move, met, part, shape, tool)
            self._pass = move, met

    def finish(self) -> Iterator[Found]:
        """Yield the faults of the last thread of a program or of a tool."""
        uncut, self._uncut, self._begun = self._uncut, None, None
        if uncut is not None and self.stock_given:
            tool, move = uncut
            yield Found(
                "thread-cuts-nothing",
                Message("{tool} does not touch the part in any pass of this thread.", tool=edge_name(tool)),
                move,
            )

    # --- threads cut by an insert

    def _counted(self, move: TipMove, tool: int, *, cuts: bool) -> Iterator[Found]:
        """Record a thread pass. Passes with another lead or Z range belong to another thread."""
        before = self._begun
        if before is None or not _of_one_thread(before, move):
            yield from self.finish()
            self._uncut = tool, move
        self._begun = move
        if cuts:
            self._uncut = None

    def _thread(
        self, move: TipMove, met: Cut, part: TurnedPart, shape: ToolShape | None, tool: int
    ) -> Iterator[Found]:
        text = move.modal.length_text
        deep, angle = self._depth(move, part), _POINT
        self._idle = 0 if met or deep else self._idle + 1
        yield from self._counted(move, tool, cuts=bool(met) or deep > 0.0)
        if self._idle == _IDLE and self.stock_given:
            yield Found(
                "thread-in-air",
                Message("The first {idle} passes of this thread do not touch any material.", idle=_IDLE),
            )
        if shape is not None and shape.kind is ToolKind.THREADING and shape.point:
            angle = shape.point
        sharp = move.per_rev / 2.0 / math.tan(math.radians(angle / 2.0))
        if deep > _DEEPER * sharp:
            yield Found(
                "thread-form",
                Message(
                    "The thread is {depth} deep, but with a lead of {per_rev} and {angle}° its flanks "
                    "meet at a depth of {sharp}.",
                    depth=text(deep),
                    per_rev=text(move.per_rev),
                    angle=f"{angle:g}",
                    sharp=text(sharp),
                ),
            )
        if shape is not None and shape.pitch and shape.kind is ToolKind.THREADING:
            starts = move.per_rev / shape.pitch
            if abs(starts - round(starts)) > 0.02 * max(starts, 1.0) or not 0 < round(starts) <= _MOST_STARTS:
                words = Message(
                    "The insert of {tool} has a pitch of {pitch}, but the lead is {per_rev}.",
                    tool=edge_name(tool),
                    pitch=text(shape.pitch),
                    per_rev=text(move.per_rev),
                )
                yield Found("thread-pitch", words)
        before, needed = self._run_up(move, met), self._braking(move)
        if met and before < needed:
            words = Message(
                "The material begins {before} after the start of the pass, but the Z axis needs "
                "{needed} to reach the speed for the lead.",
                before=text(max(before, 0.0)),
                needed=text(needed),
            )
            yield Found("thread-run-up", words)

    def _depth(self, move: TipMove, part: TurnedPart) -> float:
        """Return the depth in mm of the edge below the material before the first pass, or 0."""
        if self._crest is None:
            return 0.0
        _, first, radii, inwards = self._crest
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        if not len(radii) or abs(z1 - z0) <= move.per_rev:
            return 0.0
        middles = part.columns.first + part.columns.step * np.arange(first, first + len(radii))
        edge = np.abs(r0 + (r1 - r0) * (middles - z0) / (z1 - z0))
        there = (radii > 0.0) & (middles >= min(z0, z1)) & (middles <= max(z0, z1))
        return float((inwards * (radii - edge))[there].max(initial=0.0))

    @staticmethod
    def _run_up(move: TipMove, met: Cut) -> float:
        z0, z1 = move.points[0][0], move.points[-1][0]
        return z0 - met.front if z1 < z0 else met.back - z0

    def _braking(self, move: TipMove) -> float:
        """Return the distance in mm in which the axis reaches the speed of the lead, or stops from it."""
        accel = self.drives.slide_accel
        return (move.per_rev * abs(move.rpm) / 60.0) ** 2 / (2.0 * accel) if accel else 0.0

    def _end_of_pass(self, move: TipMove) -> Iterator[Found]:
        """Check for an axis that brakes in the material, because the last turns then have a smaller lead."""
        if self._pass is None:
            return
        (cut, met), self._pass = self._pass, None
        needed = self._braking(cut)
        if move.kind is Kind.THREAD or needed <= cut.per_rev or not met:
            return  # the axis continues during the pull-out, or only the last turn is affected
        z0, z1 = cut.points[0][0], cut.points[-1][0]
        left = met.back - z1 if z1 < z0 else z1 - met.front
        if left < needed:
            text = cut.modal.length_text
            yield Found(
                "thread-run-up",
                Message(
                    "The Z axis needs {needed} to stop from the speed for the lead, but the material "
                    "ends {left} before the end of the pass, so the last turns of the thread have a "
                    "different lead.",
                    needed=text(needed),
                    left=text(max(left, 0.0)),
                ),
                cut,
            )

    # --- taps

    def _tap(self, move: TipMove, met: Cut, shape: ToolShape, tool: int) -> Iterator[Found]:
        along = move.points[-1][0] - move.points[0][0]
        if along < -_NEAR and not move.quick and (met or self._inside(move)):
            if self._fed is None:
                self._entry = met.front
            self._fed = move
            yield from self._pitch(move, shape, tool)
            pitch = shape.pitch or _per_turn(move)
            if pitch and met.depth > _SOLID * pitch:
                text = move.modal.length_text
                words = Message(
                    "{tool} cuts a thread {depth} deep on the radius, but its pitch is only {pitch}.",
                    tool=edge_name(tool),
                    depth=text(met.depth),
                    pitch=text(pitch),
                )
                yield Found("tap-no-hole", words)
        elif along > _NEAR and self._fed is not None and self._inside(move):
            fed = self._fed
            if move.points[-1][0] >= self._entry:
                self._fed = None
            if not self.releases(tool):
                yield from self._out(move, fed, tool)

    def _inside(self, move: TipMove) -> bool:
        return self._fed is not None and move.points[0][0] < self._entry - _IN_HOLE

    @staticmethod
    def _pitch(move: TipMove, shape: ToolShape, tool: int) -> Iterator[Found]:
        feed = _per_turn(move)
        if feed and shape.pitch and abs(feed - shape.pitch) > _OTHER_PITCH * shape.pitch:
            text = move.modal.length_text
            yield Found(
                "tap-pitch",
                Message(
                    "{tool} feeds {feed} per revolution, but its pitch is {pitch}.",
                    tool=edge_name(tool),
                    feed=text(feed),
                    pitch=text(shape.pitch),
                ),
            )

    def _out(self, move: TipMove, fed: TipMove, tool: int) -> Iterator[Found]:
        if not fed.rpm:
            return  # a manually switched spindle
        if move.quick:
            yield Found(
                "tap-reversal", Message("{tool} retracts from the thread at rapid.", tool=edge_name(tool))
            )
        elif fed.rpm * move.rpm > 0.0:
            yield Found(
                "tap-reversal",
                Message(
                    "{tool} retracts from the thread while the spindle still turns in the tapping direction.",
                    tool=edge_name(tool),
                ),
            )
        elif not move.rpm:
            yield Found(
                "tap-reversal",
                Message("{tool} retracts from the thread with the spindle stopped.", tool=edge_name(tool)),
            )
        else:
            yield from self._reversed(move, fed, tool)

    def _reversed(self, move: TipMove, fed: TipMove, tool: int) -> Iterator[Found]:
        text, into, out = move.modal.length_text, _per_turn(fed), _per_turn(move)
        if abs(out - into) > _OTHER_FEED * into:
            words = Message(
                "{tool} feeds in at {into} per revolution, but feeds out at {file}.",
                tool=edge_name(tool),
                into=text(into),
                file=text(out),
            )
            yield Found("tap-reversal", words)
        slows = self.drives.spindle_decel
        if not slows:
            return
        turns = abs(fed.rpm) / 60.0 * (_LATENCY + abs(fed.rpm) / slows / 2.0)
        if turns * into > _GIVES:
            words = Message(
                "{tool} travels {revolutions} farther before the spindle stops",
                tool=edge_name(tool),
                revolutions=text(turns * into),
            )
            yield Found(
                "tap-reversal",
                Message("{words}, which is more than a tap holder can compensate for.", words=words),
            )


def _of_one_thread(before: TipMove, move: TipMove) -> bool:
    """Return whether two passes have the same lead and the same Z range."""
    ends = (before.points[0], before.points[-1]), (move.points[0], move.points[-1])
    apart = max(abs(a[0] - b[0]) for a, b in zip(*ends, strict=True))
    return apart < _SAME_END + move.per_rev and math.isclose(before.per_rev, move.per_rev, rel_tol=1e-3)


def _per_turn(move: TipMove) -> float:
    """Return the feed of a move per revolution of the spindle in mm, or 0 if the spindle is stopped."""
    return move.per_rev or (move.speed * 60.0 / abs(move.rpm) if move.rpm else 0.0)
