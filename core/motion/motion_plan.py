"""Motion plan of a path: look-ahead, speeds at piece junctions, and acceleration phases.

To add a jerk limit, change ``build_profile``, which divides each piece into acceleration, cruise and
deceleration. Use seven phases instead of these three, and replace ``2·a·length`` by the speed that such a
ramp reaches.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from core.message import Message
from core.motion.axis_limits import OVERRIDE_MAX, FloatArray, IntArray, MotionError
from core.motion.motion_path import MotionPath
from core.motion.motion_profile import MotionPhases, MotionProfile

# --- look-ahead -----------------------------------------------------------------------------------------


FEW_PIECES = 24  # number of limits up to which a plain loop is faster than arrays
_SUMS_ROW = 256  # =


def limit_values_forward(limit: FloatArray, gain: FloatArray) -> FloatArray:
    """Return the largest r (n+1,) with r[i] ≤ limit[i] and r[i+1] ≤ r[i] + gain[i].

    If ``limit`` contains squared speeds and ``gain`` (n,) ≥ 0 is 2·a·length, the result is the squared
    speed that acceleration can reach. It is r[i] = min over j ≤ i of limit[j] + (W[i] - W[j]), where W is
    the running sum of ``gain``.
    """
    count = len(limit)
    if count <= FEW_PIECES:
        return _one_by_one(limit.tolist(), gain.tolist())
    rows = -(-count // _SUMS_ROW)
    top = float(limit[np.isfinite(limit)].max(initial=0.0))
    # A gain as large as the largest limit decouples its neighbors; a larger one would only reduce the
    # precision.
    steps = np.zeros(rows * _SUMS_ROW)
    np.minimum(gain, top, out=steps[1:count])
    limits = np.full(rows * _SUMS_ROW, np.inf)
    limits[:count] = limit
    table, sums = limits.reshape(rows, _SUMS_ROW), np.cumsum(steps.reshape(rows, _SUMS_ROW), axis=1)
    local = np.minimum.accumulate(table - sums, axis=1)
    carried = np.minimum(local, _carry_limits(local[:, -1].tolist(), sums[:, -1].tolist())[:, None]) + sums
    return _remove_rounding(carried.reshape(-1)[:count], limit, steps[1:count])


def limit_values_backward(limit: FloatArray, gain: FloatArray) -> FloatArray:
    """Return the largest r (n+1,) with r[i] ≤ limit[i] and r[i] ≤ r[i+1] + gain[i].

    The result is the squared speed from which braking is possible.
    """
    return limit_values_forward(limit[::-1], gain[::-1])[::-1]


def _one_by_one(limits: list[float], gains: list[float]) -> FloatArray:
    reached = limits[:1]
    for limit, gain in zip(limits[1:], gains, strict=True):
        reached.append(max(min(limit, reached[-1] + gain), 0.0))
    return np.array(reached)


def _carry_limits(lows: list[float], totals: list[float]) -> FloatArray:
    """Return the limit that each row of values inherits from all rows before it."""
    carry, carries = np.inf, []
    for low, total in zip(lows, totals, strict=True):
        carries.append(carry)
        carry = min(carry, low) + total
    return np.array(carries)


def _remove_rounding(rough: FloatArray, limit: FloatArray, steps: FloatArray) -> FloatArray:
    """Return the minima without the rounding errors of the running sums where a limit applies."""
    sharp = rough.copy()
    np.minimum(limit[1:], rough[:-1] + steps, out=sharp[1:])
    sharp[0] = limit[0]
    np.minimum(limit[1:], sharp[:-1] + steps, out=sharp[1:])
    return np.maximum(sharp, 0.0)


# --- phases ---------------------------------------------------------------------------------------------


_TINY_LENGTH = 1e-12  # relative length below which a ramp or a cruise is a rounding error


def make_rest_profile(path: MotionPath, distance: float) -> MotionProfile:
    """Return a profile without motion at the given distance."""
    none = np.empty(0)
    phases = MotionPhases(none, none, none, none, none, np.empty(0, dtype=np.int64))
    return MotionProfile(
        path=path, start_distance=distance, end_distance=distance, duration_s=0.0, phases=phases
    )


def build_profile(
    path: MotionPath,
    first_piece: int,
    start_distance: float,
    *,
    length: FloatArray,
    accelerations: FloatArray,
    speed_caps: FloatArray,
    speeds: FloatArray,
) -> MotionProfile:
    """Return the profile of n consecutive pieces, starting at ``first_piece`` and ``start_distance``.

    ``speed_caps`` (n,) are the squared feeds within the pieces, and ``speeds`` (n+1,) are the squared
    speeds at the joints. A piece accelerates to its cap or as far as its length permits, cruises, and
    decelerates. A piece that is entered above its cap decelerates first.
    """
    s = path.joint_distances[first_piece : first_piece + len(length)].copy()
    s[0] = start_distance
    ramps = find_ramps(
        s,
        length=length,
        accelerations=accelerations,
        speed_caps=speed_caps,
        start_squares=speeds[:-1],
        end_squares=speeds[1:],
    )
    times = np.concatenate([[0.0], np.cumsum(ramps.durations_s)])
    pieces = np.arange(first_piece, first_piece + len(length))
    return MotionProfile(
        path=path,
        start_distance=start_distance,
        end_distance=min(float(s[-1] + length[-1]), float(path.joint_distances[first_piece + len(length)])),
        duration_s=float(times[-1]),
        phases=ramps.make_phases(times[:-1], np.repeat(pieces, 3)),
    )


class Ramps(NamedTuple):
    """The acceleration, cruise and deceleration phases of n pieces, one row (n, 3) for each piece.

    If a piece lacks a phase, the duration of this phase is 0.
    """

    durations_s: FloatArray
    start_distances: FloatArray
    start_speeds: FloatArray
    speed_changes: FloatArray

    def make_phases(self, start_times_s: FloatArray, piece_indices: IntArray) -> MotionPhases:
        """Return the phases without those of duration 0.

        The arguments have one entry for each of the 3·n phases.
        """
        kept = np.flatnonzero(self.durations_s)
        dt = self.durations_s.take(kept)
        return MotionPhases(
            start_times_s=start_times_s.take(kept),
            durations_s=dt,
            start_distances=self.start_distances.take(kept),
            start_speeds=self.start_speeds.take(kept),
            accelerations=self.speed_changes.take(kept) / dt,
            piece_indices=piece_indices.take(kept),
        )


def find_ramps(
    start_distances: FloatArray,
    *,
    length: FloatArray,
    accelerations: FloatArray,
    speed_caps: FloatArray,
    start_squares: FloatArray,
    end_squares: FloatArray,
) -> Ramps:
    """Return the ramps of n pieces that start at ``start_distances`` (n,).

    ``speed_caps``, ``start_squares`` and ``end_squares`` (n,) are the squared speeds that are permitted
    within each piece, at its start and at its end.
    """
    peak = np.minimum(
        np.maximum(speed_caps, end_squares), 0.5 * (start_squares + end_squares) + accelerations * length
    )
    v0, vp, v1 = np.sqrt(start_squares), np.sqrt(peak), np.sqrt(end_squares)
    up, cruise, down = _distances(length, accelerations, v0, vp, v1)
    times = np.zeros((len(length), 3))
    for k, (dist, total) in enumerate(((up, v0 + vp), (cruise, vp + vp), (down, vp + v1))):
        np.divide(2.0 * dist, total, out=times[:, k], where=total > 0.0)
    np.maximum(times, 0.0, out=times)
    s = start_distances
    return Ramps(
        durations_s=times,
        start_distances=_in_turn(s, s + up, s + up + cruise),
        start_speeds=_in_turn(v0, vp, vp),
        speed_changes=_in_turn(vp - v0, vp - vp, v1 - vp),
    )


def _in_turn(*columns: FloatArray) -> FloatArray:
    """Return the three columns (n,) combined into rows (n, 3), one row for each piece."""
    rows = np.empty((len(columns[0]), len(columns)))
    for k, column in enumerate(columns):
        rows[:, k] = column
    return rows


def _distances(
    length: FloatArray, a: FloatArray, v0: FloatArray, peak: FloatArray, v1: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the lengths (n,) of the acceleration, cruise and deceleration of each piece.

    ``v0``, ``peak`` and ``v1`` are the speeds at the start, during the cruise and at the end.
    """
    tiny, double = _TINY_LENGTH * peak, 2.0 * a
    rise = np.abs(peak - v0)
    fall = np.abs(peak - v1)
    up = np.where(rise > tiny, rise * (peak + v0) / double, 0.0)
    down = np.where(fall > tiny, (peak - v1) * (peak + v1) / double, 0.0)
    ramps = up + down
    cruise = length - ramps
    full = (cruise <= _TINY_LENGTH * length) & (ramps > 0.0)
    fit = np.divide(length, ramps, out=np.ones_like(length), where=full)
    return up * fit, np.where(full, 0.0, cruise), down * fit


_SETTLED = 1e-12  # relative difference of squared speeds that is a rounding error
_BACKWARD_PIECES = 1000  # joints before the end that are searched first for a settled one
ROUNDING_TOLERANCE = 1e-9  # mm of path and relative squared speed that are rounding errors


def plan_motion(
    path: MotionPath,
    *,
    start_distance: float | None = None,
    start_speed: float = 0.0,
    feed_scale: float = 1.0,
    rapid_scale: float = 1.0,
    stop_early: bool = False,
) -> MotionProfile:
    """Return the fastest motion from ``start_distance`` to rest.

    The motion starts at ``start_speed``; the default distance is the start of the path. It ends at the end
    of the path or, if ``stop_early`` is True, as soon as braking permits.

    - A scale of 0 stops the motion before the first piece at feed (or at rapid), or immediately if the
      motion can no longer stop before that piece.
    - A speed above a new, lower feed is reduced with full acceleration.
    - Limits of axes, arcs and corners always apply.

    Raises MotionError if a value is not valid, or if the speed is too high for the next corner or for a
    stop on this path. Such a speed does not result from a plan on this path.
    """
    _demand_sane(start_speed, feed_scale, rapid_scale)
    at = _start(path, start_distance)
    first = int(path.find_piece_indices(np.array([at]))[0])
    if path.joint_distances[-1] - at <= ROUNDING_TOLERANCE or not len(path):
        return _rest(path, start_speed)
    if stop_early:
        return _braking_profile(path, at, start_speed, first)
    scale = np.where(path.pieces.rapid[first:], rapid_scale, feed_scale)
    soft = np.minimum(path.speed_caps[first:], scale * path.pieces.rate[first:])
    blocked = np.flatnonzero(soft == 0.0)
    last = int(blocked[0]) if len(blocked) else len(soft)
    run = _PieceRun.from_path(path, at, first, first + last)
    if len(blocked) and (last == 0 or not run.can_stop(start_speed)):
        return _braking_profile(path, at, start_speed, first)
    speeds = _squared_speeds(run, soft[:last] ** 2, start_speed)
    cap = soft[:last] ** 2
    return build_profile(
        path, first, at, length=run.length, accelerations=run.accelerations, speed_caps=cap, speeds=speeds
    )


def find_last_settled_joint(path: MotionPath, start_distance: float | None = None) -> int:
    """Return the last joint (junction of pieces) whose planned speed is final, or -1 if none is.

    Pieces that are added later cannot change this speed. They may form a sharp corner with the last piece,
    or none. The speed at the start of the last piece may therefore have any value up to its limit. A joint
    is settled if its speed is the same for 0 and for this limit.
    """
    first = int(path.find_piece_indices(np.array([_start(path, start_distance)]))[0])
    # Later pieces may raise the limits of joints of short chords near the end.
    known = int(
        np.searchsorted(
            path.joint_distances[:-1], path.joint_distances[-1] - path.corner_reach_mm, side="right"
        )
    )
    known = min(known, len(path) - path.movable_joint_count)
    settled, back = -1, _BACKWARD_PIECES
    while settled < 0 and known - first >= 2:
        begin = max(known - back, first)
        settled = _find_settled_joint(path, begin, known)
        if begin == first:
            break
        back *= 8
    return settled


def _find_settled_joint(path: MotionPath, first: int, known: int) -> int:
    """Return the last settled joint from ``first`` on and before ``known``, or -1 if none is settled."""
    run = _PieceRun.from_path(path, float(path.joint_distances[first]), first, known)
    limit = run.max_squared_speeds[:-1].copy()
    soft = np.minimum(path.speed_caps[first:known], path.pieces.rate[first:known]) ** 2
    np.minimum(limit, soft, out=limit)
    np.minimum(limit[1:], soft[:-1], out=limit[1:])
    gain = run.squared_speed_gains[:-1]
    most = limit_values_backward(limit, gain)
    limit[-1] = 0.0
    least = limit_values_backward(limit, gain)
    same = np.flatnonzero(most - least <= _SETTLED * most)
    return first + int(same[-1]) if len(same) else -1


@dataclass(frozen=True, slots=True)
class _PieceRun:
    """The n pieces that a plan covers. The plan may start within the first piece."""

    length: FloatArray
    accelerations: FloatArray
    max_squared_speeds: FloatArray  # (n+1,) squared speed limits that always apply, 0 at the end

    @classmethod
    def from_path(cls, path: MotionPath, at: float, first: int, last: int) -> _PieceRun:
        length, cap = path.pieces.length[first:last].copy(), path.speed_caps[first:last] ** 2
        hard = np.zeros(len(length) + 1)
        if len(length):
            length[0] = path.joint_distances[first + 1] - at
            hard[:-1] = cap
            hard[1:-1] = np.minimum(
                np.minimum(cap[:-1], cap[1:]), path.squared_speed_limits[first + 1 : last]
            )
            if at <= path.joint_distances[first]:
                hard[0] = min(cap[0], path.squared_speed_limits[first])
        return cls(length, path.accelerations[first:last], hard)

    @property
    def squared_speed_gains(self) -> FloatArray:
        return 2.0 * self.accelerations * self.length

    def can_stop(self, v: float) -> bool:
        return v * v <= float(self.squared_speed_gains.sum()) + self.calculate_rounding_error(v)

    def calculate_rounding_error(self, v: float) -> float:
        """Return the error of the squared speed ``v``² that rounded distances can cause."""
        return float(
            ROUNDING_TOLERANCE * v * v + 2.0 * ROUNDING_TOLERANCE * self.accelerations.max(initial=0.0)
        )


def _squared_speeds(run: _PieceRun, soft: FloatArray, v: float) -> FloatArray:
    """Return the squared speeds at the ends of n pieces, as an array (n+1,).

    ``soft`` contains the squared feed of each piece, and ``v`` is the speed at the start. If ``v`` exceeds
    the limits, the motion first brakes fully.
    """
    limit = run.max_squared_speeds.copy()
    np.minimum(limit[:-1], soft, out=limit[:-1])
    np.minimum(limit[1:], soft, out=limit[1:])
    allowed = limit_values_backward(limit, run.squared_speed_gains)
    slack = run.calculate_rounding_error(v)
    if v * v <= allowed[0] + slack:
        allowed[0] = v * v
        return limit_values_forward(allowed, run.squared_speed_gains)
    return _brake_to_limits(run, allowed, v * v, slack)


def _brake_to_limits(run: _PieceRun, allowed: FloatArray, square: float, slack: float) -> FloatArray:
    """Return the squared speeds of a motion that first brakes fully to meet the limits.

    After that, the speeds are those of a normal plan. ``allowed`` contains the squared speed limits at the
    ends of the pieces, and ``square`` is the squared start speed. Raises MotionError if the axes cannot
    meet the limits within the remaining distance.
    """
    braked = square - np.concatenate([[0.0], np.cumsum(run.squared_speed_gains)])
    fits = np.flatnonzero(braked <= allowed + slack)
    fits = fits[fits > 0]
    if not len(fits):
        raise MotionError(
            Message(
                "At {square} mm/s, the axes cannot stop within the remaining {sum} mm. Start "
                "from a position on this path, at a lower speed.",
                square=f"{math.sqrt(square):.3f}",
                sum=f"{run.length.sum():.4f}",
            ),
            "cannot-stop",
        )
    k = int(fits[0])
    _demand_passable(braked[:k], run.max_squared_speeds[:k], slack)
    allowed[k] = min(allowed[k], braked[k - 1] + run.squared_speed_gains[k - 1])
    tail = limit_values_forward(allowed[k:], run.squared_speed_gains[k:])
    return np.concatenate([braked[:k], tail])


def _demand_passable(braked: FloatArray, hard: FloatArray, slack: float) -> None:
    over = braked > hard + slack
    if over.any():
        i = int(over.argmax())
        raise MotionError(
            Message(
                "A speed of {braked} mm/s is too high for the rest of the path, which allows "
                "{hard} mm/s. Plan from a position and a speed that are valid for this path.",
                braked=f"{math.sqrt(braked[i]):.3f}",
                hard=f"{math.sqrt(hard[i]):.3f}",
            ),
            "too-fast",
        )


def _braking_profile(path: MotionPath, at: float, v: float, first: int) -> MotionProfile:
    """Return the profile of a stop along the path at the full acceleration limit."""
    last = first
    while True:
        last = min(len(path), last + max(64, last - first))
        run = _PieceRun.from_path(path, at, first, last)
        if run.can_stop(v) or last == len(path):
            break
    if not run.can_stop(v):
        _brake_to_limits(run, np.zeros(len(run.length) + 1), v * v, run.calculate_rounding_error(v))
    braked = v * v - np.concatenate([[0.0], np.cumsum(run.squared_speed_gains)])
    k = (
        int(np.argmax(braked <= run.calculate_rounding_error(v)))
        if (braked <= run.calculate_rounding_error(v)).any()
        else len(run.length)
    )
    if v == 0.0:
        return make_rest_profile(path, at)
    # At least one piece, because C turns by degrees in 0.001 mm near the axis of a plane.
    k = max(k, 1)
    _demand_passable(braked[:k], run.max_squared_speeds[:k], run.calculate_rounding_error(v))
    length, speeds = run.length[:k].copy(), np.maximum(braked[: k + 1], 0.0)
    length[-1] = min(length[-1], speeds[-2] / (2.0 * run.accelerations[k - 1]))
    speeds[-1] = 0.0
    return build_profile(
        path,
        first,
        at,
        length=length,
        accelerations=run.accelerations[:k],
        speed_caps=np.zeros(k),
        speeds=speeds,
    )


def _rest(path: MotionPath, v: float) -> MotionProfile:
    if v * v > 2.0 * ROUNDING_TOLERANCE * float(path.accelerations.max(initial=1.0)):
        raise MotionError(
            Message(
                "At {value} mm/s, the axes cannot stop at the end of the path. Start planning before the "
                "end of the path.",
                value=f"{v:.3f}",
            ),
            "cannot-stop-at-end",
        )
    return make_rest_profile(path, float(path.joint_distances[-1]))


def _start(path: MotionPath, start_s: float | None) -> float:
    at = float(path.joint_distances[0]) if start_s is None else start_s
    if (
        not path.joint_distances[0] - ROUNDING_TOLERANCE
        <= at
        <= path.joint_distances[-1] + ROUNDING_TOLERANCE
    ):
        raise MotionError(
            Message(
                "Distance {position} mm is not on the path, which runs from {s} to {s2} mm.",
                position=at,
                s=f"{path.joint_distances[0]:.6f}",
                s2=f"{path.joint_distances[-1]:.6f}",
            ),
            "not-on-path",
        )
    return min(max(at, float(path.joint_distances[0])), float(path.joint_distances[-1]))


def _demand_sane(start_v: float, feed_scale: float, rapid_scale: float) -> None:
    if not (math.isfinite(start_v) and start_v >= 0.0):
        raise MotionError(
            Message("The current speed is {start_v}; it must be zero or above.", start_v=start_v),
            "negative-speed",
        )
    for name, scale in (("feed", feed_scale), ("rapid", rapid_scale)):
        if not 0.0 <= scale <= OVERRIDE_MAX:
            raise MotionError(
                Message(
                    "The {name} override is {scale}; it must be between 0 and {override_max}.",
                    name=name,
                    scale=scale,
                    override_max=OVERRIDE_MAX,
                ),
                f"{name}-override",
            )
