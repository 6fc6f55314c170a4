"""A planned motion: the distance along the path over time, in phases of constant acceleration.

The setpoints of a planned motion describe the motion of each axis for a driver, in pieces of constant
acceleration.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from core.motion.axis_limits import BoolArray, FloatArray, IntArray
from core.motion.motion_path import MotionPath

SegmentArrays = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]

MAX_PART_S = 0.002  # s, longest part of an arc
MAX_ARC_ERROR_MM = 2.5e-4  # mm by which a part may deviate from the arc between its ends
SHORT_PART_S = (
    1e-6  # s; shorter parts use the tangent, because their position differences would be rounding errors
)
MAX_PART_ANGLE_RAD = 0.25  # rad, longest part of an arc


class MotionPhases(NamedTuple):
    """Arrays (k,) of k phases of constant acceleration along a path, each within one piece."""

    start_times_s: FloatArray  # start, s
    durations_s: FloatArray  # length, s
    start_distances: FloatArray  # distance along the path at the start, mm
    start_speeds: FloatArray  # speed at the start, mm/s
    accelerations: FloatArray  # mm/s²
    piece_indices: IntArray

    def select_phases(self, selection: IntArray | BoolArray | slice) -> MotionPhases:
        """Return only the phases that ``selection`` selects."""
        return MotionPhases(
            start_times_s=self.start_times_s[selection],
            durations_s=self.durations_s[selection],
            start_distances=self.start_distances[selection],
            start_speeds=self.start_speeds[selection],
            accelerations=self.accelerations[selection],
            piece_indices=self.piece_indices[selection],
        )


def make_axis_segments(path: MotionPath, phases: MotionPhases, time_origin_s: float) -> SegmentArrays:
    """Return the setpoint pieces (t, dt, p, v, a) of k phases; ``time_origin_s`` is added to times.

    - A phase on a line gives one exact piece.
    - A phase on an arc is divided into parts of equal time h, each at most 2 ms. The ends of the parts are
      on the arc and are joined by a = 2·(P1 - P0 - V0·h)/h², so positions are continuous.
    - The true motion has the jerk j = v/R·hypot(v²/R, 3a). Between the ends of a part, the position error
      is at most j·h³·2/81. Between two parts, the velocity steps by at most j·h²/6.
    - The time h is chosen so that the position error is below 0.25 µm. The velocity step is then far below
      amax · interval.
    - A part that ends at rest has velocity 0 at its end and its velocity step at its start.
    """
    parts = _part_counts(path, phases)
    owner = np.repeat(np.arange(len(parts)), parts)
    nth = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    h = (phases.durations_s / np.maximum(parts, 1))[owner]
    p, v, a = _phase_states(path, phases.select_phases(owner), nth * h)
    arc = np.flatnonzero(path.pieces.curvatures[phases.piece_indices[owner]] != 0.0) if len(path) else owner
    if len(arc):
        v[arc], a[arc] = _join_on_arc(
            path, phases.select_phases(owner[arc]), nth[arc], h[arc], (p[arc], v[arc])
        )
    return time_origin_s + phases.start_times_s[owner] + nth * h, h, p, v, a


def _join_on_arc(
    path: MotionPath, phases: MotionPhases, nth: IntArray, h: FloatArray, begin: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Return the velocity and acceleration that move each part from its start to its end on the arc."""
    end = (nth + 1) * h
    p1, _, _ = _phase_states(path, phases, end)
    resting = (phases.start_speeds + phases.accelerations * end <= 1e-9 * phases.start_speeds)[:, None]
    p0, v0 = begin
    short = (h < SHORT_PART_S)[:, None]
    chord, span = p1 - p0, np.maximum(h, SHORT_PART_S)[:, None]
    v = np.where(resting & ~short, 2.0 * chord / span, v0)
    joining = np.where(resting, -v / span, 2.0 * (chord - v * span) / span**2)
    return v, np.where(short, _arc_acceleration(path, phases, v0), joining)


def _arc_acceleration(path: MotionPath, phases: MotionPhases, v: FloatArray) -> FloatArray:
    """Return the true acceleration (k, 3) at the start of phases on arcs.

    ``v`` (k, 3) is the velocity at this point.
    """
    pieces = path.pieces[phases.piece_indices]
    tangent = pieces.tangent(
        np.clip(phases.start_distances - path.joint_distances[phases.piece_indices], 0.0, pieces.length)
    )
    curved: FloatArray = tangent * phases.accelerations[:, None]
    turning = pieces.curvatures * np.hypot(v[:, 0], v[:, 1])
    curved[:, 0] += turning * v[:, 1]
    curved[:, 1] -= turning * v[:, 0]
    return curved


def _part_counts(path: MotionPath, phases: MotionPhases) -> IntArray:
    counts = np.ones(len(phases.start_times_s), dtype=np.int64)
    if not len(path):
        return counts
    bend = np.abs(path.pieces.curvatures[phases.piece_indices])
    arc = np.flatnonzero(bend)
    bend, (_, dt, _, v, a, _) = bend[arc], phases.select_phases(arc)
    fastest = np.maximum(v, v + a * dt)
    jerk = fastest * bend * np.hypot(fastest**2 * bend, 3.0 * a)
    longest = np.minimum(MAX_PART_S, MAX_PART_ANGLE_RAD / (fastest * bend))
    longest = np.minimum(longest, np.cbrt(MAX_ARC_ERROR_MM * 40.5 / jerk))
    counts[arc] = np.maximum(np.ceil(dt / longest * (1.0 - 1e-12)), 1.0).astype(np.int64)
    return counts


def _phase_states(
    path: MotionPath, phases: MotionPhases, tau: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the position, velocity and tangential acceleration (k, axes) at a time in each phase.

    ``tau`` (k,) is the time in seconds since the start of the phase.
    """
    pieces = path.pieces[phases.piece_indices]
    speed = np.maximum(phases.start_speeds + phases.accelerations * tau, 0.0)
    local = (
        phases.start_distances
        - path.joint_distances[phases.piece_indices]
        + (phases.start_speeds + 0.5 * phases.accelerations * tau) * tau
    )
    local = np.clip(local, 0.0, pieces.length)
    tangent = pieces.tangent(local)
    return pieces.point(local), tangent * speed[:, None], tangent * phases.accelerations[:, None]


ROUNDING_TOLERANCE_MM = 1e-9  # mm that are a rounding error
ROUNDING_TOLERANCE_S = 1e-12  # s that are a rounding error


@dataclass(frozen=True, slots=True)
class MotionProfile:
    """A motion along ``path`` from ``start_distance`` to ``end_distance`` in ``duration_s`` seconds.

    Times start at 0 at the start of the profile and are in seconds. A complete plan ends at rest. Only a
    section that ``cut_at_distance`` returns may end in motion. A profile without phases is at rest at
    ``end_distance``.
    """

    path: MotionPath
    start_distance: float
    end_distance: float
    duration_s: float
    phases: MotionPhases

    def __len__(self) -> int:
        return len(self.phases.start_times_s)

    def compute_distances_and_speeds(self, times_s: FloatArray | float) -> tuple[FloatArray, FloatArray]:
        """Return the distances and speeds at the times ``times_s`` (m,).

        Before the start of the profile, the values are those at the start. After the end, the motion is at
        rest at the end.
        """
        times = np.atleast_1d(np.asarray(times_s, dtype=np.float64))
        if not len(self):
            return np.full(times.shape, self.end_distance), np.zeros(times.shape)
        k = self._phase(times)
        _, dt, s0, v0, a, _ = self.phases.select_phases(k)
        tau = np.clip(times - self.phases.start_times_s[k], 0.0, dt)
        ends = np.append(self.phases.start_distances[1:], self.end_distance)[k]
        s = np.clip(s0 + (v0 + 0.5 * a * tau) * tau, s0, ends)
        done = times >= self.duration_s
        return np.where(done, self.end_distance, s), np.where(done, 0.0, np.maximum(v0 + a * tau, 0.0))

    @property
    def end_speed(self) -> float:
        """Return the speed at the end of the profile in mm/s.

        It is 0 for a complete plan. For a section of a plan, it is the start speed of the next section.
        """
        if not len(self):
            return 0.0
        last = self.phases.select_phases(slice(-1, None))
        return max(float(last.start_speeds[0] + last.accelerations[0] * last.durations_s[0]), 0.0)

    def compute_positions(self, times_s: FloatArray | float) -> FloatArray:
        """Return the machine positions (m, axes) at the times ``times_s`` (m,).

        The positions are exact on lines and arcs.
        """
        times = np.atleast_1d(np.asarray(times_s, dtype=np.float64))
        s, _ = self.compute_distances_and_speeds(times)
        if not len(self):
            return self.path.compute_positions(s)
        return self.path.compute_positions(s, self.phases.piece_indices[self._phase(times)])

    def find_block_numbers(self, times_s: FloatArray | float) -> IntArray:
        """Return the numbers of the blocks that are executed at the times ``times_s`` (m,).

        All numbers are 0 for a profile without motion.
        """
        times = np.atleast_1d(np.asarray(times_s, dtype=np.float64))
        if not len(self):
            return np.zeros(times.shape, dtype=np.int64)
        owner: IntArray = self.path.pieces.block[self.phases.piece_indices[self._phase(times)]]
        return owner

    def find_block_number(self, time_s: float) -> int:
        """Return the number of the block that is executed at ``time_s``, in seconds.

        This is faster than ``find_block_numbers``.
        """
        if not len(self):
            return 0
        found = int(self.phases.start_times_s.searchsorted(time_s, side="right")) - 1
        piece = self.phases.piece_indices[min(max(found, 0), len(self) - 1)]
        return int(self.path.pieces.block[piece])

    def find_block_times(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Return the numbers of all blocks of the path, with their start and end times in seconds.

        The times are inf for a block that the motion does not reach, and 0 for a block before the start of
        the profile. A block without length ends at its start time.
        """
        joints, first = self._joint_times(), self.path.first_pieces
        return self.path.block_numbers, joints[first[:-1]], joints[first[1:]]

    def compute_times_at_distances(self, distances: FloatArray) -> FloatArray:
        """Return the times at which the motion reaches the distances (m,).

        The time is 0 for a distance before the start of the profile, and inf for one after its end.
        """
        beyond = distances > self.end_distance + ROUNDING_TOLERANCE_MM
        if not len(self):
            return np.where(beyond, np.inf, 0.0)
        k = np.clip(
            np.searchsorted(self.phases.start_distances, distances, side="right") - 1, 0, len(self) - 1
        )
        t0, dt, s0, v0, a, _ = self.phases.select_phases(k)
        ahead = np.maximum(distances - s0, 0.0)
        total = v0 + np.sqrt(np.maximum(v0**2 + 2.0 * a * ahead, 0.0))
        tau = np.divide(2.0 * ahead, total, out=np.zeros_like(ahead), where=total > 0.0)
        times = np.where(distances >= self.end_distance, self.duration_s, t0 + np.minimum(tau, dt))
        return np.where(beyond, np.inf, times)

    def make_segments(
        self, start_time_s: float, end_time_s: float, time_origin_s: float = 0.0
    ) -> SegmentArrays:
        """Return the setpoint arrays (t, dt, p, v, a) of a time window.

        The arrays are the fields of ``core.ports.MotionSegments``. A phase on a line gives one piece of
        constant acceleration. Arcs give parts of at most 2 ms, as described in ``make_axis_segments``. The
        times t are times of the profile plus ``time_origin_s``. The arrays end in motion if ``end_time_s`` is
        before the end of the profile, and at rest otherwise.
        """
        return make_axis_segments(self.path, self._window(start_time_s, end_time_s), time_origin_s)

    def cut_at_distance(self, distance: float) -> MotionProfile:
        """Return the section of the profile up to ``distance``, at which two pieces must meet.

        The section may end in motion.
        """
        count = int(np.searchsorted(self.phases.start_distances, distance, side="left"))
        phases = self.phases.select_phases(slice(0, count))
        duration = float(phases.start_times_s[-1] + phases.durations_s[-1]) if count else 0.0
        return MotionProfile(
            path=self.path,
            start_distance=self.start_distance,
            end_distance=distance,
            duration_s=duration,
            phases=phases,
        )

    def _joint_times(self) -> FloatArray:
        """Return the times at which the motion passes the joints (points between two pieces).

        They are calculated from the phases, because near a stop, exact times cannot be calculated from
        distances.
        """
        joints = np.arange(len(self.path) + 1)
        times = np.append(self.phases.start_times_s, self.duration_s)[
            np.searchsorted(self.phases.piece_indices, joints)
        ]
        return np.where(self.path.joint_distances > self.end_distance + ROUNDING_TOLERANCE_MM, np.inf, times)

    def _window(self, t_from: float, t_to: float) -> MotionPhases:
        lo, hi = max(t_from, 0.0), min(t_to, self.duration_s)
        if not len(self) or hi <= lo:
            return self.phases.select_phases(slice(0, 0))
        i = int(np.searchsorted(self.phases.start_times_s, lo, side="right")) - 1
        j = int(np.searchsorted(self.phases.start_times_s, hi, side="left"))
        part = self.phases.select_phases(np.arange(i, j))  # an index array makes a copy, a slice would not
        part.durations_s[-1] = min(part.durations_s[-1], hi - part.start_times_s[-1])
        skip = lo - part.start_times_s[0]
        part.start_distances[0] += (part.start_speeds[0] + 0.5 * part.accelerations[0] * skip) * skip
        part.start_speeds[0] += part.accelerations[0] * skip
        part.start_times_s[0] += skip
        part.durations_s[0] -= skip
        return part.select_phases(part.durations_s > ROUNDING_TOLERANCE_S)

    def _phase(self, times: FloatArray) -> IntArray:
        found: IntArray = np.searchsorted(self.phases.start_times_s, times, side="right") - 1
        return np.clip(found, 0, len(self) - 1)
