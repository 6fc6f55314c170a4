"""A planned motion: path distance over time, in phases of constant acceleration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.motion.limits import FloatArray, IntArray
from core.motion.path import Path
from core.motion.setpoints import Phases, SegmentArrays, axis_segments

NEAR = 1e-9  # mm that are rounding, not distance
BRIEF = 1e-12  # s that are rounding, not time


@dataclass(frozen=True, slots=True)
class Profile:
    """Motion along ``path`` from ``start_s`` at t = 0 to ``end_s`` at ``duration``.

    A plan ends at rest; only a part cut off for a longer plan (``until``) ends in motion. Without phases it
    stands at ``end_s``. Times in s from the start of the profile.
    """

    path: Path
    start_s: float
    end_s: float
    duration: float
    phases: Phases

    def __len__(self) -> int:
        return len(self.phases.t)

    def at(self, t: FloatArray | float) -> tuple[FloatArray, FloatArray]:
        """Distance and speed at the times ``t`` (m,); before the start as at 0, after the end at rest."""
        times = np.atleast_1d(np.asarray(t, dtype=np.float64))
        if not len(self):
            return np.full(times.shape, self.end_s), np.zeros(times.shape)
        k = self._phase(times)
        _, dt, s0, v0, a, _ = self.phases.pick(k)
        tau = np.clip(times - self.phases.t[k], 0.0, dt)
        ends = np.append(self.phases.s[1:], self.end_s)[k]
        s = np.clip(s0 + (v0 + 0.5 * a * tau) * tau, s0, ends)
        done = times >= self.duration
        return np.where(done, self.end_s, s), np.where(done, 0.0, np.maximum(v0 + a * tau, 0.0))

    @property
    def end_v(self) -> float:
        """Speed at the end, mm/s: 0 for a plan, the speed to go on with for a part of one."""
        if not len(self):
            return 0.0
        last = self.phases.pick(slice(-1, None))
        return max(float(last.v[0] + last.a[0] * last.dt[0]), 0.0)

    def position(self, t: FloatArray | float) -> FloatArray:
        """Machine position (m, axes) at the times ``t`` (m,), exact on lines and arcs."""
        times = np.atleast_1d(np.asarray(t, dtype=np.float64))
        s, _ = self.at(times)
        if not len(self):
            return self.path.point(s)
        return self.path.point(s, self.phases.piece[self._phase(times)])

    def block_at(self, t: FloatArray | float) -> IntArray:
        """Number of the block that is executed at the times ``t`` (m,); 0 where nothing moves at all."""
        times = np.atleast_1d(np.asarray(t, dtype=np.float64))
        if not len(self):
            return np.zeros(times.shape, dtype=np.int64)
        owner: IntArray = self.path.pieces.block[self.phases.piece[self._phase(times)]]
        return owner

    def block_times(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Numbers of all blocks of the path and when each starts and ends, s; endless where it never does.

        Blocks behind the start have 0 for both; a block without length ends where it starts.
        """
        joints, first = self._joint_times(), self.path.first
        return self.path.blocks, joints[first[:-1]], joints[first[1:]]

    def time_at(self, s: FloatArray) -> FloatArray:
        """When the distances ``s`` (m,) are reached; 0 behind the start, endless beyond the end."""
        beyond = s > self.end_s + NEAR
        if not len(self):
            return np.where(beyond, np.inf, 0.0)
        k = np.clip(np.searchsorted(self.phases.s, s, side="right") - 1, 0, len(self) - 1)
        t0, dt, s0, v0, a, _ = self.phases.pick(k)
        ahead = np.maximum(s - s0, 0.0)
        total = v0 + np.sqrt(np.maximum(v0**2 + 2.0 * a * ahead, 0.0))
        tau = np.divide(2.0 * ahead, total, out=np.zeros_like(ahead), where=total > 0.0)
        times = np.where(s >= self.end_s, self.duration, t0 + np.minimum(tau, dt))
        return np.where(beyond, np.inf, times)

    def segments(self, t_from: float, t_to: float, t_origin: float = 0.0) -> SegmentArrays:
        """Arrays (t, dt, p, v, a) of setpoint pieces for a window: the fields of ``core.ports.Segments``.

        One piece of constant acceleration per phase on lines; on arcs parts of 2 ms at most whose ends lie
        on the arc, see ``core.motion.setpoints``. ``t`` is the time of the profile plus ``t_origin``. Cut
        at ``t_to`` it ends in motion; reaching the end of the profile it ends at rest.
        """
        return axis_segments(self.path, self._window(t_from, t_to), t_origin)

    def until(self, s: float) -> Profile:
        """The part up to the distance ``s``, which must be a joint of the path; it may end in motion."""
        count = int(np.searchsorted(self.phases.s, s, side="left"))
        phases = self.phases.pick(slice(0, count))
        duration = float(phases.t[-1] + phases.dt[-1]) if count else 0.0
        return Profile(path=self.path, start_s=self.start_s, end_s=s, duration=duration, phases=phases)

    def _joint_times(self) -> FloatArray:
        """``time_at`` of all joints, by their pieces: near a stop a distance says little about a time."""
        joints = np.arange(len(self.path) + 1)
        times = np.append(self.phases.t, self.duration)[np.searchsorted(self.phases.piece, joints)]
        return np.where(self.path.s > self.end_s + NEAR, np.inf, times)

    def _window(self, t_from: float, t_to: float) -> Phases:
        lo, hi = max(t_from, 0.0), min(t_to, self.duration)
        if not len(self) or hi <= lo:
            return self.phases.pick(slice(0, 0))
        i = int(np.searchsorted(self.phases.t, lo, side="right")) - 1
        j = int(np.searchsorted(self.phases.t, hi, side="left"))
        part = self.phases.pick(np.arange(i, j))  # a copy, as a slice would not be
        part.dt[-1] = min(part.dt[-1], hi - part.t[-1])
        skip = lo - part.t[0]
        part.s[0] += (part.v[0] + 0.5 * part.a[0] * skip) * skip
        part.v[0] += part.a[0] * skip
        part.t[0] += skip
        part.dt[0] -= skip
        return part.pick(part.dt > BRIEF)

    def _phase(self, times: FloatArray) -> IntArray:
        found: IntArray = np.searchsorted(self.phases.t, times, side="right") - 1
        return np.clip(found, 0, len(self) - 1)
