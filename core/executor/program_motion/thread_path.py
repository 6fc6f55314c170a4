"""The path of one thread pass: s along Z from the start, X as a function of s, and the exit.

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

from core.executor.program_motion.thread_curve import ThreadCurve, curve_of, turns_of
from core.executor.raised_alarm import AlarmError
from core.executor.spindle_control import SpindleControl
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.message import Message
from core.motion.axis_limits import MotionLimits
from core.ports import Segments

Phases = list[tuple[float, float]]
Floats = npt.NDArray[np.float64]
_BRIEF = 1e-9  # s
_RETRACTED = 1e-6  # mm
_INCH = 25.4  # mm


class ThreadPath(NamedTuple):
    """The path of a thread pass in machine coordinates.

    The thread starts at ``x z`` and has the ``length`` along Z in the direction ``along`` (±1). X changes by
    ``slope`` per s. Then X moves to ``out`` while Z continues in step by ``beyond``. If ``beyond`` is 0, X
    moves at ``rapid`` with Z at rest. ``a`` is the acceleration along the thread, and ``ax az`` are those of
    the axes. A chain of threads has a ``curve``, whose s is the revolutions times ``lead``. ``slope`` and
    ``end_lead`` are then the changes of X and Z per s at its end.
    """

    x: float
    z: float
    c: float
    along: float
    length: float
    slope: float
    out: float
    beyond: float
    rapid: float
    lead: float
    a: float
    ax: float
    az: float
    curve: ThreadCurve | None = None
    end_lead: float = 1.0

    @classmethod
    def of(cls, blocks: Sequence[Block], limits: MotionLimits) -> ThreadPath:
        """Return the path of a pass from its blocks: the thread and its pull-out, if any."""
        first, out = blocks[0], blocks[-1]
        cut = [first, *(block for block in blocks[1:] if block.continues)]
        length = abs(first.z - first.z0)
        if not length or not first.feed:
            raise AlarmError("program", "the thread has a length or lead of zero", first.line)
        if len(cut) > 1 or first.growth:
            return cls._chained(cut, out, limits)
        ax, az = limits.amax[:2]
        slope = (first.x - first.x0) / length
        return cls(
            x=first.x0 + first.offset_x,
            z=first.z0 + first.offset_z,
            c=first.c0 + first.modal.offset_c,
            along=math.copysign(1.0, first.z - first.z0),
            length=length,
            slope=slope,
            out=out.mx,
            beyond=abs(out.z - out.z0) if out is not first and out.kind is Kind.THREAD else 0.0,
            rapid=min(out.feed, limits.vmax[0]) if out.kind is Kind.RAPID else limits.vmax[0],
            lead=first.feed,
            a=min(az, ax / abs(slope)) if slope else az,
            ax=ax,
            az=az,
        )

    @classmethod
    def _chained(cls, cut: Sequence[Block], last: Block, limits: MotionLimits) -> ThreadPath:
        """Return the path of a chain of threads. ``last`` is its pull-out, or the last block of the chain."""
        first = cut[0]
        curve, (ax, az) = curve_of(cut, limits), limits.amax[:2]
        _, _, slope, along = curve.at(curve.length)
        in_step = last is not cut[-1] and last.kind is Kind.THREAD
        return cls(
            x=float(curve.x[0]),
            z=float(curve.z[0]),
            c=first.c0 + first.modal.offset_c,
            along=math.copysign(1.0, along),
            length=curve.length,
            slope=slope,
            out=last.mx,
            beyond=abs(last.z - last.z0) / abs(along) if in_step else 0.0,
            rapid=min(last.feed, limits.vmax[0]) if last.kind is Kind.RAPID else limits.vmax[0],
            lead=first.feed - 0.5 * first.growth * turns_of(first),
            a=curve.acceleration(ax, az),
            ax=ax,
            az=az / abs(along),
            curve=curve,
            end_lead=abs(along),
        )

    @property
    def x_end(self) -> float:
        """Machine X at the end of the thread."""
        return self.x + self.slope * self.length if self.curve is None else float(self.curve.x[-1])

    def place(self, z: float, vz: float) -> tuple[float, float]:
        """Return s and its speed where Z is at ``z`` and moves at ``vz``."""
        if self.curve is not None:
            s = self.curve.place(z)
            return s, vz / self.curve.at(s)[3]
        return (z - self.z) * self.along, vz * self.along

    def full_depth(self, v: float) -> float:
        """Return the s up to which only the thread itself is cut at speed ``v``."""
        return min(self.length, self.length + self.beyond - 0.5 * v * v / self.az)

    def onwards(self, t: float, s: float, v_in: float, lead_in: Phases) -> tuple[Segments, float]:
        """Plan the rest of the pass from ``s`` at time ``t`` and speed ``v_in``.

        The phases ``lead_in`` come first. The pass then continues at the speed reached to its end. Returns
        the setpoints and the time at which the thread is left.
        """
        at, speed = _after(s, v_in, lead_in)
        end = self.length + self.beyond
        brake = min(0.5 * speed * speed / self.az, end - at)
        cruise = (end - at - brake) / speed if speed > 0.0 else 0.0
        ramp = [(2.0 * brake / speed, -0.5 * speed * speed / brake)] if brake > 0.0 else []
        z_phases = [each for each in (*lead_in, (cruise, 0.0), *ramp) if each[0] > _BRIEF]
        left, v_left = _moment(z_phases, s, v_in, self.length)
        x_from = self.x_end
        top = v_left * self.end_lead if self.beyond else self.rapid
        sign = math.copysign(1.0, self.out - x_from)
        x_out = _trapezoid(abs(self.out - x_from), sign * self.slope * v_left, top, self.ax)
        out = [(dt, sign * acc) for dt, acc in x_out]
        if self.curve is not None:
            thread, z = _mapped(self.curve, s, v_in, z_phases)
            x = _before(thread, left).then(x_from, self.slope * v_left, out)
            return self._joined(t, x, z), t + left
        x_thread = [(dt, self.slope * acc) for dt, acc in _until(z_phases, left)]
        x = _axis(self.x + self.slope * s, self.slope * v_in, [*x_thread, *out])
        return self._joined(t, x, self._z(s, v_in, z_phases)), t + left

    def drawn_back(self) -> Segments | None:
        """Return the straight retract of X after a thread without pull-out, or None with one.

        Its time starts at 0.
        """
        x = self.x_end
        phases = _trapezoid(abs(self.out - x), 0.0, self.rapid, self.ax)
        if self.beyond or not phases:
            return None
        sign = math.copysign(1.0, self.out - x)
        still = [(sum(dt for dt, _ in phases), 0.0)]
        end = self.z + self.along * self.length if self.curve is None else float(self.curve.z[-1])
        return self._joined(0.0, _axis(x, 0.0, [(dt, sign * a) for dt, a in phases]), _axis(end, 0.0, still))

    def stopping(self, t: float, s: float, v: float) -> Segments:
        """Return the setpoints of an immediate stop along the thread."""
        phases = [(v / self.a, -self.a)] if v > 0.0 else [(_BRIEF, 0.0)]
        if self.curve is not None:
            return self._joined(t, *_mapped(self.curve, s, v, phases))
        x = _axis(self.x + self.slope * s, self.slope * v, [(dt, self.slope * acc) for dt, acc in phases])
        return self._joined(t, x, self._z(s, v, phases))

    def _z(self, s: float, v: float, phases: Phases) -> _Track:
        along = self.along
        return _axis(self.z + along * s, along * v, [(dt, along * acc) for dt, acc in phases])

    def _joined(self, t: float, x: _Track, z: _Track) -> Segments:
        """Join both axes as phases of constant acceleration that start and end together."""
        joints = np.unique(np.concatenate([x.t, z.t]).round(12))
        joints = joints[np.concatenate([[True], np.diff(joints) > _BRIEF])]
        starts, dt = joints[:-1], np.diff(joints)
        p, v, a = (np.zeros((len(starts), 3)) for _ in range(3))
        for column, track in enumerate((x, z)):
            i = np.clip(np.searchsorted(track.t, starts + _BRIEF, side="right") - 1, 0, len(track.a))
            u = starts - track.t[i]
            accel = np.append(track.a, 0.0)[i]
            p[:, column] = track.p[i] + (track.v[i] + 0.5 * accel * u) * u
            v[:, column] = track.v[i] + accel * u
            a[:, column] = accel
        p[:, 2] = self.c
        return Segments(t + starts, dt, p, v, a)


def _joints(phases: Phases) -> Floats:
    return np.concatenate([[0.0], np.cumsum([dt for dt, _ in phases])])


class _Track(NamedTuple):
    """The motion of one axis.

    ``t``, ``p`` and ``v`` are times, positions and speeds at n + 1 joints, and ``a`` are the n accelerations
    between them.
    """

    t: Floats
    p: Floats
    v: Floats
    a: Floats

    def then(self, p: float, v: float, phases: Phases) -> _Track:
        """Return the motion with phases appended from this position and speed."""
        more = _axis(p, v, phases)
        return _Track(
            np.concatenate([self.t[:-1], self.t[-1] + more.t]),
            np.concatenate([self.p[:-1], more.p]),
            np.concatenate([self.v[:-1], more.v]),
            np.concatenate([self.a, more.a]),
        )


def _before(track: _Track, end: float) -> _Track:
    """Return the motion up to the time ``end``."""
    n = max(min(int(np.searchsorted(track.t, end - 1e-12)), len(track.a)), 0)
    return _Track(
        np.append(track.t[:n], end), np.append(track.p[:n], 0.0), np.append(track.v[:n], 0.0), track.a[:n]
    )


def _mapped(curve: ThreadCurve, s: float, v: float, phases: Phases) -> tuple[_Track, _Track]:
    """Return the motion of X and Z along a curve for phases of s."""
    t, tracks = 0.0, (list[tuple[float, ...]](), list[tuple[float, ...]]())
    for whole, acc in phases:
        for dt in _crossings(curve, s, v, whole, acc):
            middle = s + (v + 0.25 * acc * dt) * 0.5 * dt
            x, z, dx, dz = curve.at(middle)
            for rows, at, ratio in ((tracks[0], x, dx), (tracks[1], z, dz)):
                rows.append((t, at - ratio * (middle - s), ratio * v, ratio * acc))
            s, v, t = s + (v + 0.5 * acc * dt) * dt, v + acc * dt, t + dt
    x, z, dx, dz = curve.at(s)
    speed = 0.0 if abs(v) < 1e-6 else v
    made = []
    for rows, at, ratio in ((tracks[0], x, dx), (tracks[1], z, dz)):
        table = np.array([*rows, (t, at, ratio * speed, 0.0)])
        made.append(_Track(table[:, 0], table[:, 1], table[:, 2], table[:-1, 3]))
    return made[0], made[1]


def _crossings(curve: ThreadCurve, s: float, v: float, whole: float, acc: float) -> list[float]:
    """Return the durations of the parts into which the knots of the curve divide a phase."""
    end = s + (v + 0.5 * acc * whole) * whole
    gone = curve.s[(curve.s > s + 1e-9) & (curve.s < end - 1e-9)] - s
    root = np.sqrt(np.maximum(v * v + 2.0 * acc * gone, 0.0))
    times = np.concatenate([[0.0], 2.0 * gone / np.maximum(v + root, 1e-12), [whole]])
    return [float(dt) for dt in np.diff(times) if dt > 0.0]


def _axis(p: float, v: float, phases: Phases) -> _Track:
    """Return the motion of one axis from a position and a speed with the given phases."""
    positions, speeds = [p], [v]
    for dt, a in phases:
        p, v = p + (v + 0.5 * a * dt) * dt, v + a * dt
        positions.append(p)
        speeds.append(v)
    speeds[-1] = 0.0 if abs(speeds[-1]) < 1e-6 else speeds[-1]
    return _Track(_joints(phases), np.array(positions), np.array(speeds), np.array([a for _, a in phases]))


def _after(p: float, v: float, phases: Phases) -> tuple[float, float]:
    for dt, a in phases:
        p, v = p + (v + 0.5 * a * dt) * dt, v + a * dt
    return p, v


def _moment(phases: Phases, p: float, v: float, goal: float) -> tuple[float, float]:
    """Return the time and speed at which ``goal`` is reached, or those at the end of the phases."""
    t = 0.0
    for dt, a in phases:
        end = p + (v + 0.5 * a * dt) * dt
        if end >= goal - 1e-9 and goal - p > 0.0 and end - goal > 1e-9:
            root = math.sqrt(max(v * v + 2.0 * a * (goal - p), 0.0))
            return t + 2.0 * (goal - p) / (v + root), root
        p, v, t = end, v + a * dt, t + dt
    return t, max(v, 0.0) if v > 1e-6 else 0.0


def _until(phases: Phases, end: float) -> Phases:
    """Return the phases up to the time ``end``."""
    kept: Phases = []
    t = 0.0
    for dt, a in phases:
        if t >= end - 1e-12:
            break
        kept.append((min(dt, end - t), a))
        t += dt
    return kept


def _trapezoid(length: float, v: float, top: float, a: float) -> Phases:
    """Return phases from speed ``v`` (positive toward the goal) to rest at the goal, at most at ``top``."""
    if length <= 0.0:
        return []
    peak = min(math.sqrt(a * length + 0.5 * v * v), max(top, v))
    up = max(peak - v, 0.0)
    cruise = (length - (peak * peak - v * v) / (2.0 * a) - peak * peak / (2.0 * a)) / peak
    return [(up / a, a), (max(cruise, 0.0), 0.0), (peak / a, -a)]


class ThreadRetract(NamedTuple):
    """The retract from a thread that has lost its spindle: a stop along the thread, then a move of X.

    ``x`` is the machine X of the programmed pull-out. ``cutting`` is True if the tool was still in the thread
    itself. ``why`` is the fault of the spindle, for the operator.
    """

    block: Block
    x: float
    cutting: bool
    why: str

    @classmethod
    def of(cls, block: Block, behind: Sequence[Block], spindle: SpindleControl) -> ThreadRetract:
        """Return the retract from ``block``; ``behind`` are the blocks of its pass that follow."""
        return cls(block, [block, *behind][-1].mx, bool(behind), _why_lost(spindle))

    def demand_left(self, at: Sequence[float]) -> None:
        """Raise AlarmError("thread-lost") if the axes, at machine X, Z and C, have left the thread."""
        if abs(at[0] - self.x) < _RETRACTED:
            raise AlarmError("thread-lost", self._left(at[1]), self.block.line)

    def way_out(self, at: Sequence[float]) -> Block:
        """Return a rapid along X alone from the position of the axes (machine X, Z, C)."""
        block = self.block
        return dataclasses.replace(
            block,
            kind=Kind.RAPID,
            per_rev=False,
            x0=at[0] - block.offset_x,
            z0=at[1] - block.offset_z,
            c0=at[2],
            x=self.x - block.offset_x,
            z=at[1] - block.offset_z,
            c=at[2],
            feed=block.modal.rapid_rate,
        )

    def _left(self, z: float) -> str:
        """Return the cause and the state of the thread on the part, for the alarm."""
        if not self.cutting:
            return Message(
                "{why} during the pull-out: the thread is cut, but the thread runout is shorter than "
                "programmed",
                why=self.why,
            )
        metric = self.block.modal.metric
        at = f"{z - self.block.offset_z:.3f}" if metric else f"{(z - self.block.offset_z) / _INCH:.4f}"
        return Message(
            "{why}: the tool retracted from the thread at Z{position}, and the rest of "
            "this thread pass is not cut",
            why=self.why,
            position=at,
        )


def _why_lost(spindle: SpindleControl) -> str:
    if spindle.why_slow:
        return spindle.why_slow.lower()
    if spindle.measured * spindle.command < 0.0:
        return Message(
            "the spindle turned in the wrong direction at {measured} rpm",
            measured=f"{abs(spindle.measured):.0f}",
        )
    return Message(
        "the spindle speed dropped to {measured} rpm (commanded: {command} rpm)",
        measured=f"{abs(spindle.measured):.0f}",
        command=f"{abs(spindle.command):.0f}",
    )
