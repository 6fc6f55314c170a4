"""Setpoint queue of a driver, which always contains a complete trajectory that ends at rest.

If the host stalls, is killed or is disconnected, the axes therefore stop on their path at the planned
deceleration without a fault. Hold, override, abort and jog all use the same operation (splice), which
replaces the end of the queue.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from core.ports import DriverError, MotionSegments
from drivers.setpoint_pieces import MotionPiece, MotionPieceQueue

_BATCH_SIZE = 100  # Pieces per step; their conversion takes 0.1 ms.


def _do_nothing() -> None:
    """Do nothing; this is the default callback for yielding the CPU to other work."""


def convert_segments(
    segments: MotionSegments, axis_count: int, yield_cpu: Callable[[], None] = _do_nothing
) -> list[MotionPiece]:
    """Convert motion segments into motion pieces.

    ``yield_cpu`` is called repeatedly during the conversion, because some drives need commands before
    thousands of pieces are converted. Raises DriverError if an array has the wrong shape, a value is not
    finite or a duration is negative.
    """
    count = len(segments.start_times_s)
    shapes = {segments.positions.shape, segments.velocities.shape, segments.accelerations.shape}
    if count == 0 or shapes != {(count, axis_count)} or segments.durations_s.shape != (count,):
        raise DriverError(
            "each setpoint must contain t, dt, p, v and a for {axes} axes",
            "broken-path",
            reason="shape",
            axes=axis_count,
        )
    for part in segments:
        if not np.isfinite(part).all():
            raise DriverError(
                "setpoints contain a value that is not a number", "broken-path", reason="no-number"
            )
    if (segments.durations_s < 0).any():
        raise DriverError("the setpoint times run backward", "broken-path", reason="backwards")
    pieces: list[MotionPiece] = []
    for begin in range(0, count, _BATCH_SIZE):
        t, dt, p, v, a = (part[begin : begin + _BATCH_SIZE].tolist() for part in segments)
        pieces += map(MotionPiece, t, dt, map(tuple, p), map(tuple, v), map(tuple, a))
        yield_cpu()
    return pieces


@dataclass(frozen=True, slots=True)
class AxisProperties:
    """Limits and properties of one axis that its driver needs, in mm or degrees, and seconds."""

    name: str
    vmax: float
    amax: float  # Also the deceleration of the drive's own stop.
    count: float  # Length of one count of the drive in mm or degrees.
    following_window: float
    following_time: float
    travel: tuple[float, float] | None = None
    absolute: bool = True
    home_speed: float = 10.0
    corner: float = 4.0  # Permitted velocity jump at a corner: amax times the setpoint interval.


def check_setpoint_limits(
    segments: MotionSegments,
    axes: Sequence[AxisProperties],
    homed_axes: Sequence[bool],
    actual_positions: Sequence[float] | None = None,
) -> None:
    """Raise DriverError if a setpoint is too fast or outside the travel of a homed axis.

    If ``actual_positions`` is specified, an axis outside its travel may move back from its current
    position.
    """
    for n, axis in enumerate(axes):
        if abs(segments.velocities[:, n]).max(initial=0.0) > axis.vmax * 1.001 + 0.01:
            raise DriverError(
                "{axis}: the setpoint speed exceeds {vmax}/s; nothing was queued",
                "drive-limits",
                reason="too-fast",
                axis=axis.name,
                vmax=f"{axis.vmax:.1f}",
            )
        if axis.travel is None or not homed_axes[n]:
            continue
        low, high = axis.travel
        if actual_positions is not None:
            low, high = min(low, actual_positions[n]), max(high, actual_positions[n])
        place = segments.positions[:, n]
        if place.min(initial=low) < low - 0.01 or place.max(initial=high) > high + 0.01:
            raise DriverError(
                "{axis}: setpoints are outside the travel range {low}…{high}; nothing was queued",
                "drive-limits",
                reason="leaves-travel",
                axis=axis.name,
                low=f"{low:.2f}",
                high=f"{high:.2f}",
            )


_TIME_TOLERANCE_S = 1e-6  # s; clock rounding between the end of one piece and the start of the next
_REST_SPEED = 0.01  # mm/s or degrees/s; velocity that may remain by rounding.


@dataclass(frozen=True, slots=True)
class JunctionTolerance:
    """Permitted jumps of each axis in position and velocity where two motion pieces meet.

    Positions are in mm or degrees, and velocities are in mm/s or degrees/s. The position tolerance covers
    rounding. The velocity tolerance covers a corner: ``amax * interval``.
    """

    max_position_jumps: tuple[float, ...]
    max_velocity_jumps: tuple[float, ...]

    @classmethod
    def from_axes(cls, axes: Sequence[AxisProperties]) -> JunctionTolerance:
        """Create the tolerance for these axes: 0.001 mm or degrees, and the corner velocity of each axis."""
        return cls((0.001,) * len(axes), tuple(1.01 * axis.corner + 1e-3 for axis in axes))


class SetpointQueue(MotionPieceQueue):
    """Setpoint queue of all axes that checks new setpoints.

    The queue is not thread-safe, so the driver must lock it.
    """

    def __init__(
        self,
        axes: tuple[str, ...],
        rest_positions: Sequence[float],
        commit_time_s: float,
        tolerance: JunctionTolerance,
    ) -> None:
        super().__init__(rest_positions)
        self.axes = axes
        self.commit = commit_time_s
        self._tolerance = tolerance
        self.yield_cpu: Callable[[], None] = _do_nothing  # Called while a long path is converted.
        # Time up to which the drives already have setpoints.
        self.get_transferred_until: Callable[[], float] = lambda: -math.inf

    def splice_segments(self, segments: MotionSegments, now: float) -> None:
        """Replace all setpoints from time ``segments.start_times_s[0]`` on.

        The segments must start no earlier than the commit time after ``now``, and not before the time up to
        which the drives already have setpoints. They must continue the remaining queue in position and
        velocity, be continuous, and end at rest. Otherwise DriverError is raised, and the queue does not
        change.
        """
        pieces = convert_segments(segments, len(self.axes), self.yield_cpu)
        start = pieces[0].start_time_s
        fixed = max(now + self.commit, self.get_transferred_until())
        if start < fixed - 1e-9:
            late = 1000 * (fixed - start)
            raise DriverError(
                "setpoints start {late} ms too early to replace the queued setpoints; splice at a later time",
                "late",
                reason="too-early",
                late=f"{late:.1f}",
            )
        self._check_joint(self.get_commanded_state(start), (pieces[0].positions, pieces[0].velocities))
        self._check_run(segments)
        self.replace_pieces_from(start, pieces)

    def _check_run(self, segments: MotionSegments) -> None:
        """Raise DriverError if new segments contain a gap or a jump, or do not end at rest."""
        dt = segments.durations_s[:, None]
        t_end = segments.start_times_s + segments.durations_s
        p_end = segments.positions + (segments.velocities + 0.5 * segments.accelerations * dt) * dt
        v_end = segments.velocities + segments.accelerations * dt
        gaps = np.flatnonzero(np.abs(segments.start_times_s[1:] - t_end[:-1]) > _TIME_TOLERANCE_S)
        if gaps.size:
            raise DriverError(
                "setpoints have a gap at t = {t_end} s; nothing was queued",
                "broken-path",
                reason="gap",
                t_end=f"{t_end[gaps[0]]:.4f}",
            )
        jumps = (np.abs(segments.positions[1:] - p_end[:-1]) > self._tolerance.max_position_jumps) | (
            np.abs(segments.velocities[1:] - v_end[:-1]) > self._tolerance.max_velocity_jumps
        )
        if jumps.any():
            row, axis = np.argwhere(jumps)[0]
            raise DriverError(
                "{axis}: setpoints jump at t = {t_end} s from position {position} at speed {speed}/s to "
                "position {position2} at speed {speed2}/s; nothing was queued",
                "broken-path",
                reason="jump",
                axis=self.axes[axis],
                t_end=f"{t_end[row]:.4f}",
                position=f"{p_end[row, axis]:.4f}",
                speed=f"{v_end[row, axis]:.3f}",
                position2=f"{segments.positions[row + 1, axis]:.4f}",
                speed2=f"{segments.velocities[row + 1, axis]:.3f}",
            )
        moving = [name for name, speed in zip(self.axes, v_end[-1], strict=True) if abs(speed) > _REST_SPEED]
        if moving:
            raise DriverError(
                "at the end of the setpoints, these axes are still moving: {moving}",
                "broken-path",
                reason="moves-at-end",
                moving=", ".join(moving),
            )

    def _check_joint(
        self,
        old: tuple[tuple[float, ...], tuple[float, ...]],
        new: tuple[tuple[float, ...], tuple[float, ...]],
    ) -> None:
        """Raise DriverError if the new setpoints do not continue the old ones at the splice point.

        Position and velocity must agree within the tolerance.
        """
        templates = (
            "{axis}: at the splice point between queued and new setpoints, the position jumps from "
            "{before} to {after}",
            "{axis}: at the splice point between queued and new setpoints, the velocity jumps from "
            "{before}/s to {after}/s",
        )
        limits = (self._tolerance.max_position_jumps, self._tolerance.max_velocity_jumps)
        for template, limit, one, two in zip(templates, limits, old, new, strict=True):
            for name, tolerance, before, after in zip(self.axes, limit, one, two, strict=True):
                if abs(after - before) > tolerance:
                    raise DriverError(
                        template, reason="jump", axis=name, before=f"{before:.4f}", after=f"{after:.4f}"
                    )


# --- Move of one axis from rest to rest, as for homing.


def plan_axis_move(
    start_time: float,
    rest_positions: Sequence[float],
    axis_index: int,
    *,
    target: float,
    speed: float,
    accel: float,
) -> MotionSegments:
    """Plan a move of one axis from rest to rest, with ramps and a phase at constant ``speed``.

    The axis with index ``axis_index`` moves to ``target``; the other axes remain at rest.
    """
    travel = target - rest_positions[axis_index]
    sign = math.copysign(1.0, travel)
    top = min(speed, math.sqrt(abs(travel) * accel))
    ramp = top / accel
    cruise = (abs(travel) - top * ramp) / top if top > 0.0 else 0.0
    dt = np.array([ramp, max(cruise, 0.0), ramp])
    p, v = np.tile(np.asarray(rest_positions, dtype=np.float64), (3, 1)), np.zeros((3, len(rest_positions)))
    a = np.zeros_like(v)
    v[:, axis_index] = [0.0, sign * top, sign * top]
    a[:, axis_index] = [sign * accel, 0.0, -sign * accel]
    p[1, axis_index] += sign * 0.5 * top * ramp
    p[2, axis_index] = target - sign * 0.5 * top * ramp
    return MotionSegments(start_time + np.array([0.0, dt[0], dt[0] + dt[1]]), dt, p, v, a)
