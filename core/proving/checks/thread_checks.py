"""Checks of screw threads and taps: run-up, end of a pass, depth, pitch, and reversal of a tap."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from core.interpreter.shared.elementary_blocks import BlockKind
from core.message import Message
from core.part.swept_edge import FloatArray
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import Cut, TurnedPart
from core.proving.tip_moves import TipMove
from core.tool_edges import format_edge_name

_LATENCY = 0.08  # s before a drive follows a new command
_POINT = 60.0  # degrees, assumed angle of an unspecified thread
_DEEPER = 1.02  # fraction of the depth of a sharp V
_SOLID = 1.0  # pitches of depth in r; a thread is 0.6 deep, and tap holes are never that small
# fraction of a pitch, as between 1/2-12 and 1/2-13; floating holders are fed slightly slower
_OTHER_PITCH = 0.08
_OTHER_FEED = 0.15  # fraction of the feed in by which the feed out may differ
_TAP_HOLDER_PLAY = 12.7  # mm of length compensation of a tap holder
_IN_HOLE = 0.05  # mm
_NEAR = 1e-6  # mm
_MAX_STARTS = 24
_IDLE = 3  # passes
_SAME_END = 1.0  # mm of Z between passes of one thread


class Found(NamedTuple):
    """A fault that a check has found.

    The fault is at ``move``. If ``move`` is None, the fault is at the move that was just checked.
    """

    check_name: str
    message: str
    move: TipMove | None = None


class DriveLimits(NamedTuple):
    """Limits of the Z axis and the spindle; 0 means unknown.

    The acceleration along Z is in mm/s², and the deceleration of the spindle is in rpm/s.
    """

    z_acceleration_mm_s2: float = 0.0
    spindle_deceleration_rpm_s: float = 0.0


UNKNOWN_LIMITS = DriveLimits()


@dataclass(slots=True)
class ThreadChecks:
    """Checks of screw threads, to be called for each move in program order.

    Call ``record_initial_radii`` before each cut and ``check_move`` after it. ``has_releasing_tap_holder``
    returns, for a T number, whether the tap holder reverses or releases the tap automatically.
    """

    drive_limits: DriveLimits = UNKNOWN_LIMITS
    has_releasing_tap_holder: Callable[[int], bool] = lambda _: False
    is_stock_specified: bool = False  # the stock is specified instead of assumed
    # line, first column, radii, and 1 for an outside thread
    _crest: tuple[int, int, FloatArray, float] | None = None
    _pass: tuple[TipMove, Cut] | None = None  # the last thread pass, until its end is known
    _fed: TipMove | None = None  # the last feed of a tap into its hole
    _entry: float = 0.0  # Z of the first material of the tap
    _idle: int = 0  # consecutive passes that stay outside the material
    _uncut: tuple[int, TipMove] | None = None  # T and first pass of a thread that has not cut yet
    _begun: TipMove | None = None  # =

    def record_initial_radii(self, move: TipMove, part: TurnedPart) -> None:
        """Record the radii of the material before the first pass of a thread is cut."""
        if move.block_kind is not BlockKind.THREAD or (
            self._crest is not None and self._crest[0] == move.line
        ):
            return
        z0, z1 = move.points[0][0], move.points[-1][0]
        short = math.copysign(
            min(move.feed_per_rev_mm, abs(z1 - z0) / 2.0), z0 - z1
        )  # the length next to a shoulder
        low, high = sorted((z0, z1 + short))
        there = slice(part.columns.find_column(low), part.columns.find_column(high))
        inside = self._is_in_bore(move, part, there)
        radii = part.min_radii if inside else part.max_radii
        self._crest = move.line, there.start, radii[there], -1.0 if inside else 1.0

    @staticmethod
    def _is_in_bore(move: TipMove, part: TurnedPart, columns: slice) -> bool:
        """Return whether the thread is in a bore, with the material outside the edge."""
        inner = part.min_radii[columns]
        bored = inner[inner > 0.0]
        if not len(bored):
            return False
        edge = max(abs(r) for _, r in move.points)
        return abs(edge - float(bored.min())) < abs(float(part.max_radii[columns].max()) - edge)

    def check_move(
        self, move: TipMove, cut: Cut, part: TurnedPart, shape: ToolShape | None, tool: int
    ) -> Iterator[Found]:
        """Yield the thread faults of a move that has just been cut."""
        goes_on = self._pass is not None and move.block_kind is BlockKind.THREAD  # the pull-out of the thread
        yield from self._check_pass_end(move)
        if shape is not None and shape.kind is ToolKind.TAP:
            yield from self._tap(move, cut, shape, tool)
        else:
            self._fed = None
        if move.block_kind is BlockKind.THREAD and move.feed_per_rev_mm and not goes_on:
            yield from self._thread(move, cut, part, shape, tool)
            self._pass = move, cut

    def check_last_thread(self) -> Iterator[Found]:
        """Yield the faults of the last thread of a program or of a tool."""
        uncut, self._uncut, self._begun = self._uncut, None, None
        if uncut is not None and self.is_stock_specified:
            tool, move = uncut
            yield Found(
                "thread-cuts-nothing",
                Message(
                    "{tool} does not touch the part in any pass of this thread.", tool=format_edge_name(tool)
                ),
                move,
            )

    # --- threads cut by an insert

    def _record_pass(self, move: TipMove, tool: int, *, cuts: bool) -> Iterator[Found]:
        """Record a thread pass, and yield the faults of the previous thread when a new thread starts.

        Passes with a different lead or Z range belong to different threads.
        """
        before = self._begun
        if before is None or not _is_same_thread(before, move):
            yield from self.check_last_thread()
            self._uncut = tool, move
        self._begun = move
        if cuts:
            self._uncut = None

    def _thread(
        self, move: TipMove, met: Cut, part: TurnedPart, shape: ToolShape | None, tool: int
    ) -> Iterator[Found]:
        text = move.modal.format_length
        deep, angle = self._edge_depth(move, part), _POINT
        self._idle = 0 if met or deep else self._idle + 1
        yield from self._record_pass(move, tool, cuts=bool(met) or deep > 0.0)
        if self._idle == _IDLE and self.is_stock_specified:
            yield Found(
                "thread-in-air",
                Message("The first {idle} passes of this thread do not touch any material.", idle=_IDLE),
            )
        if shape is not None and shape.kind is ToolKind.THREADING and shape.point:
            angle = shape.point
        sharp = move.feed_per_rev_mm / 2.0 / math.tan(math.radians(angle / 2.0))
        if deep > _DEEPER * sharp:
            yield Found(
                "thread-form",
                Message(
                    "The thread is {depth} deep, but with a lead of {per_rev} and {angle}° its flanks "
                    "meet at a depth of {sharp}.",
                    depth=text(deep),
                    per_rev=text(move.feed_per_rev_mm),
                    angle=f"{angle:g}",
                    sharp=text(sharp),
                ),
            )
        if shape is not None and shape.pitch and shape.kind is ToolKind.THREADING:
            starts = move.feed_per_rev_mm / shape.pitch
            if abs(starts - round(starts)) > 0.02 * max(starts, 1.0) or not 0 < round(starts) <= _MAX_STARTS:
                words = Message(
                    "The insert of {tool} has a pitch of {pitch}, but the lead is {per_rev}.",
                    tool=format_edge_name(tool),
                    pitch=text(shape.pitch),
                    per_rev=text(move.feed_per_rev_mm),
                )
                yield Found("thread-pitch", words)
        before, needed = self._run_up(move, met), self._braking_distance(move)
        if met and before < needed:
            words = Message(
                "The material begins {before} after the start of the pass, but the Z axis needs "
                "{needed} to reach the speed for the lead.",
                before=text(max(before, 0.0)),
                needed=text(needed),
            )
            yield Found("thread-run-up", words)

    def _edge_depth(self, move: TipMove, part: TurnedPart) -> float:
        """Return the greatest depth in mm of the edge below the original surface of the thread.

        The result is 0 if this surface is not known, or if the edge is not below it.
        """
        if self._crest is None:
            return 0.0
        _, first, radii, inwards = self._crest
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        if not len(radii) or abs(z1 - z0) <= move.feed_per_rev_mm:
            return 0.0
        middles = part.columns.first_z_mm + part.columns.step_mm * np.arange(first, first + len(radii))
        edge = np.abs(r0 + (r1 - r0) * (middles - z0) / (z1 - z0))
        there = (radii > 0.0) & (middles >= min(z0, z1)) & (middles <= max(z0, z1))
        return float((inwards * (radii - edge))[there].max(initial=0.0))

    @staticmethod
    def _run_up(move: TipMove, met: Cut) -> float:
        z0, z1 = move.points[0][0], move.points[-1][0]
        return z0 - met.front_z_mm if z1 < z0 else met.back_z_mm - z0

    def _braking_distance(self, move: TipMove) -> float:
        """Return the distance in mm in which the axis reaches the speed that the lead requires.

        The axis needs the same distance to stop from this speed.
        """
        accel = self.drive_limits.z_acceleration_mm_s2
        return (move.feed_per_rev_mm * abs(move.rpm) / 60.0) ** 2 / (2.0 * accel) if accel else 0.0

    def _check_pass_end(self, move: TipMove) -> Iterator[Found]:
        """Check that the axis does not brake while the tool is in the material.

        If it does, the last revolutions of the thread have a smaller lead.
        """
        if self._pass is None:
            return
        (cut, met), self._pass = self._pass, None
        needed = self._braking_distance(cut)
        if move.block_kind is BlockKind.THREAD or needed <= cut.feed_per_rev_mm or not met:
            return  # the axis continues during the pull-out, or only the last turn is affected
        z0, z1 = cut.points[0][0], cut.points[-1][0]
        left = met.back_z_mm - z1 if z1 < z0 else z1 - met.front_z_mm
        if left < needed:
            text = cut.modal.format_length
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
        if along < -_NEAR and not move.is_fast and (met or self._inside(move)):
            if self._fed is None:
                self._entry = met.front_z_mm
            self._fed = move
            yield from self._pitch(move, shape, tool)
            pitch = shape.pitch or _feed_per_revolution(move)
            if pitch and met.depth_mm > _SOLID * pitch:
                text = move.modal.format_length
                words = Message(
                    "{tool} cuts a thread {depth} deep on the radius, but its pitch is only {pitch}.",
                    tool=format_edge_name(tool),
                    depth=text(met.depth_mm),
                    pitch=text(pitch),
                )
                yield Found("tap-no-hole", words)
        elif along > _NEAR and self._fed is not None and self._inside(move):
            fed = self._fed
            if move.points[-1][0] >= self._entry:
                self._fed = None
            if not self.has_releasing_tap_holder(tool):
                yield from self._out(move, fed, tool)

    def _inside(self, move: TipMove) -> bool:
        return self._fed is not None and move.points[0][0] < self._entry - _IN_HOLE

    @staticmethod
    def _pitch(move: TipMove, shape: ToolShape, tool: int) -> Iterator[Found]:
        feed = _feed_per_revolution(move)
        if feed and shape.pitch and abs(feed - shape.pitch) > _OTHER_PITCH * shape.pitch:
            text = move.modal.format_length
            yield Found(
                "tap-pitch",
                Message(
                    "{tool} feeds {feed} per revolution, but its pitch is {pitch}.",
                    tool=format_edge_name(tool),
                    feed=text(feed),
                    pitch=text(shape.pitch),
                ),
            )

    def _out(self, move: TipMove, fed: TipMove, tool: int) -> Iterator[Found]:
        if not fed.rpm:
            return  # a manually switched spindle
        if move.is_fast:
            yield Found(
                "tap-reversal",
                Message("{tool} retracts from the thread at rapid.", tool=format_edge_name(tool)),
            )
        elif fed.rpm * move.rpm > 0.0:
            yield Found(
                "tap-reversal",
                Message(
                    "{tool} retracts from the thread while the spindle still turns in the tapping direction.",
                    tool=format_edge_name(tool),
                ),
            )
        elif not move.rpm:
            yield Found(
                "tap-reversal",
                Message(
                    "{tool} retracts from the thread with the spindle stopped.", tool=format_edge_name(tool)
                ),
            )
        else:
            yield from self._reversed(move, fed, tool)

    def _reversed(self, move: TipMove, fed: TipMove, tool: int) -> Iterator[Found]:
        text, into, out = move.modal.format_length, _feed_per_revolution(fed), _feed_per_revolution(move)
        if abs(out - into) > _OTHER_FEED * into:
            words = Message(
                "{tool} feeds in at {into} per revolution, but feeds out at {file}.",
                tool=format_edge_name(tool),
                into=text(into),
                file=text(out),
            )
            yield Found("tap-reversal", words)
        slows = self.drive_limits.spindle_deceleration_rpm_s
        if not slows:
            return
        turns = abs(fed.rpm) / 60.0 * (_LATENCY + abs(fed.rpm) / slows / 2.0)
        if turns * into > _TAP_HOLDER_PLAY:
            words = Message(
                "{tool} travels {revolutions} farther before the spindle stops",
                tool=format_edge_name(tool),
                revolutions=text(turns * into),
            )
            yield Found(
                "tap-reversal",
                Message("{words}, which is more than a tap holder can compensate for.", words=words),
            )


def _is_same_thread(previous: TipMove, move: TipMove) -> bool:
    """Return whether two passes have the same lead and nearly the same Z range."""
    ends = (previous.points[0], previous.points[-1]), (move.points[0], move.points[-1])
    apart = max(abs(a[0] - b[0]) for a, b in zip(*ends, strict=True))
    return apart < _SAME_END + move.feed_per_rev_mm and math.isclose(
        previous.feed_per_rev_mm, move.feed_per_rev_mm, rel_tol=1e-3
    )


def _feed_per_revolution(move: TipMove) -> float:
    """Return the feed of a move in mm per revolution of the spindle, or 0 if the spindle is stopped."""
    return move.feed_per_rev_mm or (move.speed_mm_s * 60.0 / abs(move.rpm) if move.rpm else 0.0)
