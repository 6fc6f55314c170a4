"""Path of one thread pass: the distance s along Z, X as a function of s, and the exit.

Plans are lists of phases (seconds, acceleration). Units are mm and seconds, X is a radius, and signs are
those of the machine.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.executor.program_motion.thread_curve import (
    ThreadCurve,
    build_thread_curve,
    calculate_spindle_revolutions,
)
from core.executor.raised_alarm import AlarmError
from core.executor.spindle_control import SpindleControl
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.message import Message
from core.motion.axis_limits import MotionLimits
from core.ports import MotionSegments

Phases = list[tuple[float, float]]
FloatArray = npt.NDArray[np.float64]
_SHORT_TIME_S = 1e-9  # s
_RETRACTED_TOLERANCE_MM = 1e-6  # mm
_INCH = 25.4  # mm


class ThreadPath(NamedTuple):
    """The path of a thread pass in machine coordinates.

    - The thread starts at ``x z`` and has ``length_mm`` along Z in the direction ``z_direction`` (±1). X
      changes by ``x_slope`` per unit of s.
    - X then moves to ``retract_x_mm`` while Z continues in step with the spindle by ``exit_length_mm``.
      If this length is 0, X moves at ``rapid_speed_mm_s`` with Z at rest.
    - ``path_acceleration`` applies along the thread, ``x_acceleration`` and ``z_acceleration`` to the axes.
    - A chain of threads has a ``curve`` with s = revolutions · ``lead_mm``. ``x_slope`` and ``end_z_slope``
      are then the changes of X and Z per unit of s at its end.
    """

    start_x: float
    start_z: float
    start_c: float
    z_direction: float
    length_mm: float
    x_slope: float
    retract_x_mm: float
    exit_length_mm: float
    rapid_speed_mm_s: float
    lead_mm: float
    path_acceleration: float
    x_acceleration: float
    z_acceleration: float
    curve: ThreadCurve | None = None
    end_z_slope: float = 1.0

    @classmethod
    def from_blocks(cls, blocks: Sequence[Block], limits: MotionLimits) -> ThreadPath:
        """Return the path of a pass from its blocks, which are the thread and an optional pull-out."""
        first, out = blocks[0], blocks[-1]
        cut = [first, *(block for block in blocks[1:] if block.continues)]
        length = abs(first.z - first.z0)
        if not length or not first.feed:
            raise AlarmError("program", "the thread has a length or lead of zero", first.line)
        if len(cut) > 1 or first.growth:
            return cls._from_chain(cut, out, limits)
        ax, az = limits.amax[:2]
        slope = (first.x - first.x0) / length
        return cls(
            start_x=first.x0 + first.offset_x,
            start_z=first.z0 + first.offset_z,
            start_c=first.c0 + first.modal.offset_c,
            z_direction=math.copysign(1.0, first.z - first.z0),
            length_mm=length,
            x_slope=slope,
            retract_x_mm=out.mx,
            exit_length_mm=abs(out.z - out.z0) if out is not first and out.kind is BlockKind.THREAD else 0.0,
            rapid_speed_mm_s=min(out.feed, limits.vmax[0]) if out.kind is BlockKind.RAPID else limits.vmax[0],
            lead_mm=first.feed,
            path_acceleration=min(az, ax / abs(slope)) if slope else az,
            x_acceleration=ax,
            z_acceleration=az,
        )

    @classmethod
    def _from_chain(cls, cut: Sequence[Block], last: Block, limits: MotionLimits) -> ThreadPath:
        """Return the path of a chain of threads.

        ``last`` is the pull-out, or the last thread block if there is no pull-out.
        """
        first = cut[0]
        curve, (ax, az) = build_thread_curve(cut, limits), limits.amax[:2]
        _, _, slope, along = curve.evaluate_curve(curve.length_mm)
        in_step = last is not cut[-1] and last.kind is BlockKind.THREAD
        return cls(
            start_x=float(curve.x_mm[0]),
            start_z=float(curve.z_mm[0]),
            start_c=first.c0 + first.modal.offset_c,
            z_direction=math.copysign(1.0, along),
            length_mm=curve.length_mm,
            x_slope=slope,
            retract_x_mm=last.mx,
            exit_length_mm=abs(last.z - last.z0) / abs(along) if in_step else 0.0,
            rapid_speed_mm_s=min(last.feed, limits.vmax[0])
            if last.kind is BlockKind.RAPID
            else limits.vmax[0],
            lead_mm=first.feed - 0.5 * first.growth * calculate_spindle_revolutions(first),
            path_acceleration=curve.compute_max_acceleration(ax, az),
            x_acceleration=ax,
            z_acceleration=az / abs(along),
            curve=curve,
            end_z_slope=abs(along),
        )

    @property
    def end_x_mm(self) -> float:
        """Return X at the end of the thread, in machine coordinates."""
        return (
            self.start_x + self.x_slope * self.length_mm if self.curve is None else float(self.curve.x_mm[-1])
        )

    def find_position_and_speed(self, z: float, z_velocity: float) -> tuple[float, float]:
        """Return s and the speed along s when Z is at ``z`` with the velocity ``z_velocity``."""
        if self.curve is not None:
            s = self.curve.find_curve_position(z)
            return s, z_velocity / self.curve.evaluate_curve(s)[3]
        return (z - self.start_z) * self.z_direction, z_velocity * self.z_direction

    def find_full_depth_end(self, speed: float) -> float:
        """Return the s at which a pass at ``speed`` leaves the full depth or begins to brake."""
        return min(
            self.length_mm, self.length_mm + self.exit_length_mm - 0.5 * speed * speed / self.z_acceleration
        )

    def plan_remaining_pass(
        self, start_time_s: float, s: float, entry_speed: float, lead_in_phases: Phases
    ) -> tuple[MotionSegments, float]:
        """Plan the rest of the pass from ``s`` at the time ``start_time_s`` and the speed ``entry_speed``.

        The plan starts with the phases ``lead_in_phases``. The pass then continues to its end at the speed
        that these phases reach. Returns the setpoints and the time at which the tool leaves the thread.
        """
        at, speed = _after(s, entry_speed, lead_in_phases)
        end = self.length_mm + self.exit_length_mm
        brake = min(0.5 * speed * speed / self.z_acceleration, end - at)
        cruise = (end - at - brake) / speed if speed > 0.0 else 0.0
        ramp = [(2.0 * brake / speed, -0.5 * speed * speed / brake)] if brake > 0.0 else []
        z_phases = [each for each in (*lead_in_phases, (cruise, 0.0), *ramp) if each[0] > _SHORT_TIME_S]
        left, v_left = _target_time(z_phases, s, entry_speed, self.length_mm)
        x_from = self.end_x_mm
        top = v_left * self.end_z_slope if self.exit_length_mm else self.rapid_speed_mm_s
        sign = math.copysign(1.0, self.retract_x_mm - x_from)
        x_out = _plan_trapezoid(
            abs(self.retract_x_mm - x_from), sign * self.x_slope * v_left, top, self.x_acceleration
        )
        out = [(dt, sign * acc) for dt, acc in x_out]
        if self.curve is not None:
            thread, z = _map_to_curve(self.curve, s, entry_speed, z_phases)
            x = _motion_before(thread, left).append_phases(x_from, self.x_slope * v_left, out)
            return self._join_axes(start_time_s, x, z), start_time_s + left
        x_thread = [(dt, self.x_slope * acc) for dt, acc in _phases_before(z_phases, left)]
        x = _axis_motion(self.start_x + self.x_slope * s, self.x_slope * entry_speed, [*x_thread, *out])
        return self._join_axes(start_time_s, x, self._z(s, entry_speed, z_phases)), start_time_s + left

    def make_retract(self) -> MotionSegments | None:
        """Return the straight retract of X after a thread without pull-out.

        The result is None if the thread has a pull-out. Time is measured from the start of the retract.
        """
        x = self.end_x_mm
        phases = _plan_trapezoid(abs(self.retract_x_mm - x), 0.0, self.rapid_speed_mm_s, self.x_acceleration)
        if self.exit_length_mm or not phases:
            return None
        sign = math.copysign(1.0, self.retract_x_mm - x)
        still = [(sum(dt for dt, _ in phases), 0.0)]
        end = (
            self.start_z + self.z_direction * self.length_mm
            if self.curve is None
            else float(self.curve.z_mm[-1])
        )
        return self._join_axes(
            0.0, _axis_motion(x, 0.0, [(dt, sign * a) for dt, a in phases]), _axis_motion(end, 0.0, still)
        )

    def make_stop_setpoints(self, start_time_s: float, s: float, speed: float) -> MotionSegments:
        """Return the setpoints of an immediate stop along the thread."""
        phases = (
            [(speed / self.path_acceleration, -self.path_acceleration)]
            if speed > 0.0
            else [(_SHORT_TIME_S, 0.0)]
        )
        if self.curve is not None:
            return self._join_axes(start_time_s, *_map_to_curve(self.curve, s, speed, phases))
        x = _axis_motion(
            self.start_x + self.x_slope * s,
            self.x_slope * speed,
            [(dt, self.x_slope * acc) for dt, acc in phases],
        )
        return self._join_axes(start_time_s, x, self._z(s, speed, phases))

    def _z(self, s: float, v: float, phases: Phases) -> _AxisMotion:
        along = self.z_direction
        return _axis_motion(self.start_z + along * s, along * v, [(dt, along * acc) for dt, acc in phases])

    def _join_axes(self, t: float, x: _AxisMotion, z: _AxisMotion) -> MotionSegments:
        """Combine the motions of X and Z into segments in which both accelerations are constant.

        A segment ends wherever a phase of X or of Z ends. ``t`` is the start time in seconds.
        """
        joints = np.unique(np.concatenate([x.times_s, z.times_s]).round(12))
        joints = joints[np.concatenate([[True], np.diff(joints) > _SHORT_TIME_S])]
        starts, dt = joints[:-1], np.diff(joints)
        p, v, a = (np.zeros((len(starts), 3)) for _ in range(3))
        for column, track in enumerate((x, z)):
            i = np.clip(
                np.searchsorted(track.times_s, starts + _SHORT_TIME_S, side="right") - 1,
                0,
                len(track.accelerations),
            )
            u = starts - track.times_s[i]
            accel = np.append(track.accelerations, 0.0)[i]
            p[:, column] = track.positions[i] + (track.velocities[i] + 0.5 * accel * u) * u
            v[:, column] = track.velocities[i] + accel * u
            a[:, column] = accel
        p[:, 2] = self.start_c
        return MotionSegments(t + starts, dt, p, v, a)


def _joints(phases: Phases) -> FloatArray:
    return np.concatenate([[0.0], np.cumsum([dt for dt, _ in phases])])


class _AxisMotion(NamedTuple):
    """The motion of one axis in n phases of constant acceleration.

    ``times_s``, ``positions`` and ``velocities`` are the values at the n + 1 ends of the phases.
    ``accelerations`` contains the acceleration of each phase.
    """

    times_s: FloatArray
    positions: FloatArray
    velocities: FloatArray
    accelerations: FloatArray

    def append_phases(self, p: float, v: float, phases: Phases) -> _AxisMotion:
        """Return the motion extended by phases that start from position ``p`` and speed ``v``."""
        more = _axis_motion(p, v, phases)
        return _AxisMotion(
            np.concatenate([self.times_s[:-1], self.times_s[-1] + more.times_s]),
            np.concatenate([self.positions[:-1], more.positions]),
            np.concatenate([self.velocities[:-1], more.velocities]),
            np.concatenate([self.accelerations, more.accelerations]),
        )


def _motion_before(track: _AxisMotion, end: float) -> _AxisMotion:
    """Return the motion up to the time ``end``."""
    n = max(min(int(np.searchsorted(track.times_s, end - 1e-12)), len(track.accelerations)), 0)
    return _AxisMotion(
        np.append(track.times_s[:n], end),
        np.append(track.positions[:n], 0.0),
        np.append(track.velocities[:n], 0.0),
        track.accelerations[:n],
    )


def _map_to_curve(curve: ThreadCurve, s: float, v: float, phases: Phases) -> tuple[_AxisMotion, _AxisMotion]:
    """Return the motions of X and Z along a curve when s moves in the given phases."""
    t, tracks = 0.0, (list[tuple[float, ...]](), list[tuple[float, ...]]())
    for whole, acc in phases:
        for dt in _knot_durations(curve, s, v, whole, acc):
            middle = s + (v + 0.25 * acc * dt) * 0.5 * dt
            x, z, dx, dz = curve.evaluate_curve(middle)
            for rows, at, ratio in ((tracks[0], x, dx), (tracks[1], z, dz)):
                rows.append((t, at - ratio * (middle - s), ratio * v, ratio * acc))
            s, v, t = s + (v + 0.5 * acc * dt) * dt, v + acc * dt, t + dt
    x, z, dx, dz = curve.evaluate_curve(s)
    speed = 0.0 if abs(v) < 1e-6 else v
    made = []
    for rows, at, ratio in ((tracks[0], x, dx), (tracks[1], z, dz)):
        table = np.array([*rows, (t, at, ratio * speed, 0.0)])
        made.append(_AxisMotion(table[:, 0], table[:, 1], table[:, 2], table[:-1, 3]))
    return made[0], made[1]


def _knot_durations(curve: ThreadCurve, s: float, v: float, duration: float, acc: float) -> list[float]:
    """Return the durations of the parts into which the points of the curve divide a phase."""
    end = s + (v + 0.5 * acc * duration) * duration
    gone = (
        curve.curve_positions_mm[
            (curve.curve_positions_mm > s + 1e-9) & (curve.curve_positions_mm < end - 1e-9)
        ]
        - s
    )
    root = np.sqrt(np.maximum(v * v + 2.0 * acc * gone, 0.0))
    times = np.concatenate([[0.0], 2.0 * gone / np.maximum(v + root, 1e-12), [duration]])
    return [float(dt) for dt in np.diff(times) if dt > 0.0]


def _axis_motion(p: float, v: float, phases: Phases) -> _AxisMotion:
    """Return the motion of one axis for the given phases, starting from a position and a speed."""
    positions, speeds = [p], [v]
    for dt, a in phases:
        p, v = p + (v + 0.5 * a * dt) * dt, v + a * dt
        positions.append(p)
        speeds.append(v)
    speeds[-1] = 0.0 if abs(speeds[-1]) < 1e-6 else speeds[-1]
    return _AxisMotion(
        _joints(phases), np.array(positions), np.array(speeds), np.array([a for _, a in phases])
    )


def _after(p: float, v: float, phases: Phases) -> tuple[float, float]:
    for dt, a in phases:
        p, v = p + (v + 0.5 * a * dt) * dt, v + a * dt
    return p, v


def _target_time(phases: Phases, p: float, v: float, goal: float) -> tuple[float, float]:
    """Return the time and speed at which ``goal`` is reached.

    If the phases do not reach ``goal``, the time and speed at their end are returned.
    """
    t = 0.0
    for dt, a in phases:
        end = p + (v + 0.5 * a * dt) * dt
        if end >= goal - 1e-9 and goal - p > 0.0 and end - goal > 1e-9:
            root = math.sqrt(max(v * v + 2.0 * a * (goal - p), 0.0))
            return t + 2.0 * (goal - p) / (v + root), root
        p, v, t = end, v + a * dt, t + dt
    return t, max(v, 0.0) if v > 1e-6 else 0.0


def _phases_before(phases: Phases, end: float) -> Phases:
    """Return the phases up to the time ``end``."""
    kept: Phases = []
    t = 0.0
    for dt, a in phases:
        if t >= end - 1e-12:
            break
        kept.append((min(dt, end - t), a))
        t += dt
    return kept


def _plan_trapezoid(length: float, v: float, max_speed: float, a: float) -> Phases:
    """Return phases from speed ``v`` to rest at the goal, with a speed of at most ``max_speed``.

    ``v`` is positive toward the goal.
    """
    if length <= 0.0:
        return []
    peak = min(math.sqrt(a * length + 0.5 * v * v), max(max_speed, v))
    up = max(peak - v, 0.0)
    cruise = (length - (peak * peak - v * v) / (2.0 * a) - peak * peak / (2.0 * a)) / peak
    return [(up / a, a), (max(cruise, 0.0), 0.0), (peak / a, -a)]


class ThreadRetract(NamedTuple):
    """The retract from a thread that has lost spindle synchronization.

    The axes stop along the thread, and then X moves. ``retract_x_mm`` is the X of the programmed pull-out
    in machine coordinates. ``is_tool_in_thread`` is True if the tool was cutting the thread and not in its
    pull-out. ``reason`` is the spindle fault, as a text for the operator.
    """

    block: Block
    retract_x_mm: float
    is_tool_in_thread: bool
    reason: str

    @classmethod
    def from_block(
        cls, block: Block, following_blocks: Sequence[Block], spindle: SpindleControl
    ) -> ThreadRetract:
        """Return the retract from ``block``; ``following_blocks`` are the later blocks of the same pass."""
        return cls(block, [block, *following_blocks][-1].mx, bool(following_blocks), _why_lost(spindle))

    def require_axes_in_thread(self, position: Sequence[float]) -> None:
        """Raise AlarmError("thread-lost") if the axes have left the thread.

        ``position`` contains X, Z and C in machine coordinates.
        """
        if abs(position[0] - self.retract_x_mm) < _RETRACTED_TOLERANCE_MM:
            raise AlarmError("thread-lost", self._describe_thread_state(position[1]), self.block.line)

    def make_retract_block(self, position: Sequence[float]) -> Block:
        """Return a rapid along X alone from ``position``.

        ``position`` contains X, Z and C in machine coordinates.
        """
        block = self.block
        return dataclasses.replace(
            block,
            kind=BlockKind.RAPID,
            per_rev=False,
            x0=position[0] - block.offset_x,
            z0=position[1] - block.offset_z,
            c0=position[2],
            x=self.retract_x_mm - block.offset_x,
            z=position[1] - block.offset_z,
            c=position[2],
            feed=block.modal.rapid_rate,
        )

    def _describe_thread_state(self, z: float) -> str:
        """Return the alarm text with the cause and the state of the thread on the part."""
        if not self.is_tool_in_thread:
            return Message(
                "{why} during the pull-out: the thread is cut, but the thread runout is shorter than "
                "programmed",
                why=self.reason,
            )
        metric = self.block.modal.metric
        at = f"{z - self.block.offset_z:.3f}" if metric else f"{(z - self.block.offset_z) / _INCH:.4f}"
        return Message(
            "{why}: the tool retracted from the thread at Z{position}, and the rest of "
            "this thread pass is not cut",
            why=self.reason,
            position=at,
        )


def _why_lost(spindle: SpindleControl) -> str:
    if spindle.spindle_stopped_reason:
        return spindle.spindle_stopped_reason.lower()
    if spindle.measured_rpm * spindle.commanded_rpm < 0.0:
        return Message(
            "the spindle turned in the wrong direction at {measured} rpm",
            measured=f"{abs(spindle.measured_rpm):.0f}",
        )
    return Message(
        "the spindle speed dropped to {measured} rpm (commanded: {command} rpm)",
        measured=f"{abs(spindle.measured_rpm):.0f}",
        command=f"{abs(spindle.commanded_rpm):.0f}",
    )
