"""The path of one thread pass: s along Z from the start, X as a function of it, and the way out of it.

Plans are lists of phases (seconds, acceleration); all mm and seconds, X as a radius, signs of the machine.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from core.executor.raised_alarm import AlarmError
from core.executor.spindle_control import SpindleControl
from core.interpreter.elementary_blocks import Block, Kind
from core.motion.axis_limits import MotionLimits
from core.ports import Segments

Phases = list[tuple[float, float]]
_BRIEF = 1e-9  # s
_RETRACTED = 1e-6  # mm
_INCH = 25.4  # mm


class ThreadPath(NamedTuple):
    """Machine coordinates. The thread runs from ``x z`` for ``length`` along Z (sign ``along``), X changing
    by ``slope`` per s. Then X goes to ``out``: while Z goes on by ``beyond`` in step, or, ``beyond`` being 0,
    at ``rapid`` with Z at rest. ``a`` is the acceleration along the thread, ``ax az`` those of the slides."""

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

    @classmethod
    def of(cls, blocks: Sequence[Block], limits: MotionLimits) -> ThreadPath:
        """The pass that these blocks are: the thread, and what pulls out of it if anything does."""
        first, out = blocks[0], blocks[-1]
        length = abs(first.z - first.z0)
        if not length or not first.feed:
            raise AlarmError("program", "a thread has no length or no lead", first.line)
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

    def place(self, z: float, vz: float) -> tuple[float, float]:
        """s and its speed where Z is at ``z``."""
        return (z - self.z) * self.along, vz * self.along

    def full_depth(self, v: float) -> float:
        """s up to which nothing but the thread itself is cut at speed ``v``."""
        return min(self.length, self.length + self.beyond - 0.5 * v * v / self.az)

    def onwards(self, t: float, s: float, v_in: float, lead_in: Phases) -> tuple[Segments, float]:
        """From ``s`` at ``t``, with speed ``v_in``: ``lead_in``, then on at the speed reached to the end.

        Returns the setpoints and the moment at which the thread is left.
        """
        at, speed = _after(s, v_in, lead_in)
        end = self.length + self.beyond
        brake = min(0.5 * speed * speed / self.az, end - at)
        cruise = (end - at - brake) / speed if speed > 0.0 else 0.0
        ramp = [(2.0 * brake / speed, -0.5 * speed * speed / brake)] if brake > 0.0 else []
        z_phases = [each for each in (*lead_in, (cruise, 0.0), *ramp) if each[0] > _BRIEF]
        left, v_left = _moment(z_phases, s, v_in, self.length)
        x_thread = [(dt, self.slope * acc) for dt, acc in _until(z_phases, left)]
        x_from = self.x + self.slope * self.length
        top = v_left if self.beyond else self.rapid
        sign = math.copysign(1.0, self.out - x_from)
        x_out = _trapezoid(abs(self.out - x_from), sign * self.slope * v_left, top, self.ax)
        x_phases = [*x_thread, *((dt, sign * acc) for dt, acc in x_out)]
        x_start = self.x + self.slope * s
        return self._joined(t, (x_start, self.slope * v_in, x_phases), (s, v_in, z_phases)), t + left

    def drawn_back(self) -> Segments | None:
        """Behind the end of a thread without pull-out: X straight out by time, from 0 on; None with one."""
        x = self.x + self.slope * self.length
        phases = _trapezoid(abs(self.out - x), 0.0, self.rapid, self.ax)
        if self.beyond or not phases:
            return None
        sign = math.copysign(1.0, self.out - x)
        still = [(sum(dt for dt, _ in phases), 0.0)]
        return self._joined(0.0, (x, 0.0, [(dt, sign * a) for dt, a in phases]), (self.length, 0.0, still))

    def stopping(self, t: float, s: float, v: float) -> Segments:
        """To rest at once along the thread."""
        phases = [(v / self.a, -self.a)] if v > 0.0 else [(_BRIEF, 0.0)]
        x = self.x + self.slope * s, self.slope * v, [(dt, self.slope * acc) for dt, acc in phases]
        return self._joined(t, x, (s, v, phases))

    def _joined(self, t: float, x: tuple[float, float, Phases], s: tuple[float, float, Phases]) -> Segments:
        """Both slides as pieces of constant acceleration that begin and end together."""
        px, vx, ax = _axis(*x)
        ps, vs, as_ = _axis(*s)
        tx, ts = _joints(x[2]), _joints(s[2])
        joints = np.unique(np.concatenate([tx, ts]).round(12))
        joints = joints[np.concatenate([[True], np.diff(joints) > _BRIEF])]
        starts, dt = joints[:-1], np.diff(joints)
        p, v, a = (np.zeros((len(starts), 3)) for _ in range(3))
        for column, times, pos, vel, acc, sign, zero in (
            (0, tx, px, vx, ax, 1.0, 0.0),
            (1, ts, ps, vs, as_, self.along, self.z),
        ):
            i = np.clip(np.searchsorted(times, starts + _BRIEF, side="right") - 1, 0, len(acc))
            u = starts - times[i]
            accel = np.append(acc, 0.0)[i]
            p[:, column] = zero + sign * (pos[i] + (vel[i] + 0.5 * accel * u) * u)
            v[:, column] = sign * (vel[i] + accel * u)
            a[:, column] = sign * accel
        p[:, 2] = self.c
        return Segments(t + starts, dt, p, v, a)


def _joints(phases: Phases) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.concatenate([[0.0], np.cumsum([dt for dt, _ in phases])])


def _axis(
    p: float, v: float, phases: Phases
) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.float64]], ...]:
    """Position and speed at the joints, acceleration of the phases."""
    positions, speeds = [p], [v]
    for dt, a in phases:
        p, v = p + (v + 0.5 * a * dt) * dt, v + a * dt
        positions.append(p)
        speeds.append(v)
    speeds[-1] = 0.0 if abs(speeds[-1]) < 1e-6 else speeds[-1]
    return np.array(positions), np.array(speeds), np.array([a for _, a in phases])


def _after(p: float, v: float, phases: Phases) -> tuple[float, float]:
    for dt, a in phases:
        p, v = p + (v + 0.5 * a * dt) * dt, v + a * dt
    return p, v


def _moment(phases: Phases, p: float, v: float, goal: float) -> tuple[float, float]:
    """When ``goal`` is reached, and how fast; the end of the phases when they stop there."""
    t = 0.0
    for dt, a in phases:
        end = p + (v + 0.5 * a * dt) * dt
        if end >= goal - 1e-9 and goal - p > 0.0 and end - goal > 1e-9:
            root = math.sqrt(max(v * v + 2.0 * a * (goal - p), 0.0))
            return t + 2.0 * (goal - p) / (v + root), root
        p, v, t = end, v + a * dt, t + dt
    return t, max(v, 0.0) if v > 1e-6 else 0.0


def _until(phases: Phases, end: float) -> Phases:
    """The phases up to a moment."""
    kept: Phases = []
    t = 0.0
    for dt, a in phases:
        if t >= end - 1e-12:
            break
        kept.append((min(dt, end - t), a))
        t += dt
    return kept


def _trapezoid(length: float, v: float, top: float, a: float) -> Phases:
    """From speed ``v`` (towards the goal positive) to rest at the goal, no faster than ``top``."""
    if length <= 0.0:
        return []
    peak = min(math.sqrt(a * length + 0.5 * v * v), max(top, v))
    up = max(peak - v, 0.0)
    cruise = (length - (peak * peak - v * v) / (2.0 * a) - peak * peak / (2.0 * a)) / peak
    return [(up / a, a), (max(cruise, 0.0), 0.0), (peak / a, -a)]


class ThreadRetract(NamedTuple):
    """Out of a thread whose spindle is lost: stop along the thread, then draw X back as the pass would have.

    ``x`` is the machine X to which the pass would have pulled out, ``cutting`` whether it was still in the
    thread itself, ``why`` what became of the spindle, for the operator.
    """

    block: Block
    x: float
    cutting: bool
    why: str

    @classmethod
    def of(cls, block: Block, behind: Sequence[Block], spindle: SpindleControl) -> ThreadRetract:
        """The way out of ``block``, which is being cut; ``behind`` are those of its pass that follow."""
        return cls(block, [block, *behind][-1].mx, bool(behind), _why_lost(spindle))

    def demand_left(self, at: Sequence[float]) -> None:
        """Raises AlarmError("thread-lost") once the slides, at machine X, Z, C, are out of the thread."""
        if abs(at[0] - self.x) < _RETRACTED:
            raise AlarmError("thread-lost", self._left(at[1]), self.block.line)

    def way_out(self, at: Sequence[float]) -> Block:
        """A rapid along X alone from where the slides stand (machine X, Z, C)."""
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
        """Why, and what the thread on the part is now."""
        if not self.cutting:
            return f"{self.why} in the pull-out: the thread is cut, its end runs out short"
        metric = self.block.modal.metric
        at = f"{z - self.block.offset_z:.3f}" if metric else f"{(z - self.block.offset_z) / _INCH:.4f}"
        return f"{self.why}: the tool left the thread at Z{at}, behind it this pass is not cut"


def _why_lost(spindle: SpindleControl) -> str:
    if spindle.why_slow:
        return spindle.why_slow.lower()
    if spindle.measured * spindle.command < 0.0:
        return f"the spindle turned the wrong way, at {abs(spindle.measured):.0f} rpm"
    return f"the spindle fell to {abs(spindle.measured):.0f} of {abs(spindle.command):.0f} rpm"
