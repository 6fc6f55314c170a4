"""Path of a drive test: a step, ramp or sine of small size that comes back to where it began.

A setpoint cannot leap, so a step is the way done as hard as the axis may: speeding up over one half, braking
over the other. A sine is s/2·(1 - cos ωt): it begins at rest, and lies to one side of where it began.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np

from core.executor.jog_line import Ramp
from core.executor.jogging import step_ramps
from core.message import Message

LARGEST = 2.54  # mm: what is larger is no small test
LONGEST = 25.4  # mm of a ramp, which needs way to become even
PAUSE = 0.5  # s of rest behind every way, in which it settles
_BETWEEN = 0.2  # s of rest behind every sine
_WAVES, _LASTS = 5, 0.8  # of a sine at least, and s; the first wave is the one in which it swings in
_PIECES = 40  # of a wave at most; a piece is no shorter than
_SHORTEST = 0.002  # s, and a wave has no less than
_LEAST = 12  # pieces
_ROUND = 1e-9


class Shape(StrEnum):
    """What the setpoints of a test look like over time."""

    STEP = "step"
    RAMP = "ramp"
    SINE = "sine"


@dataclass(frozen=True, slots=True)
class Limits:
    """What the axis may in a test: mm/s, mm/s², and how many samples a second tell of it."""

    top: float
    amax: float
    rate: float

    @property
    def fastest_sine(self) -> float:
        """Hz: of a wave ten samples are needed."""
        return self.rate / 10.0


@dataclass(frozen=True, slots=True)
class DriveTestPath:
    """``size`` mm, signed, peak to peak of a sine; ``speed`` mm/s of a ramp; ``frequencies`` Hz of sines."""

    axis: str
    shape: Shape
    size: float
    speed: float = 0.0
    frequencies: tuple[float, ...] = ()

    def refusal(self, limits: Limits) -> str:
        """Why this is no test; empty when it is one."""
        longest = LONGEST if self.shape is Shape.RAMP else LARGEST
        if not 0.0 < abs(self.size) <= longest + _ROUND:
            return Message(
                "the travel of this test must be greater than 0 and at most {longest} mm",
                longest=f"{longest:g}",
            )
        if self.shape is Shape.RAMP:
            return self._ramp_refusal(limits)
        return self._sine_refusal(limits) if self.shape is Shape.SINE else ""

    def _ramp_refusal(self, limits: Limits) -> str:
        if not 0.0 < self.speed <= limits.top + _ROUND:
            return Message(
                "the speed of a ramp must be above 0 and at most {top} mm/s, the limit for manual moves",
                top=f"{limits.top:.0f}",
            )
        if self.speed**2 / limits.amax > 0.5 * abs(self.size):
            return Message(
                "a travel of {size} mm is too short to reach a constant speed of {speed} mm/s",
                size=f"{abs(self.size):g}",
                speed=f"{self.speed:g}",
            )
        return ""

    def _sine_refusal(self, limits: Limits) -> str:
        if not self.frequencies or not all(0.5 <= each <= 200.0 for each in self.frequencies):
            return "the sine frequency must be from 0.5 to 200 Hz"
        fastest = max(self.frequencies)
        if fastest > limits.fastest_sine + _ROUND:
            return Message(
                "this driver reports {rate} samples per second, which is not enough for a {fastest} Hz sine",
                rate=f"{limits.rate:g}",
                fastest=f"{fastest:g}",
            )
        return ""

    def size_at(self, frequency: float, limits: Limits) -> float:
        """Peak to peak of the sine of this frequency, mm, signed: less where the axis cannot do the whole."""
        omega = 2.0 * math.pi * frequency
        able = min(2.0 * limits.top / omega, 2.0 * limits.amax / omega**2)
        return math.copysign(min(abs(self.size), able), self.size)

    def ramps(self, limits: Limits) -> list[Ramp]:
        """Pieces from rest to rest, (seconds, speed at its start, acceleration)."""
        if self.shape is Shape.SINE:
            return [piece for each in self.frequencies for piece in self._sine(each, limits)]
        top = self.speed if self.shape is Shape.RAMP else limits.top
        return [
            piece
            for way in (self.size, -self.size)
            for piece in (*step_ramps(way, top, limits.amax), (PAUSE, 0.0, 0.0))
        ]

    def _sine(self, frequency: float, limits: Limits) -> list[Ramp]:
        """Its velocity is exact at the ends of the pieces and straight between: it comes back exactly.

        Its size is less than asked by (ω dt)²/12: 2 % of the fastest, .2 % of the others.
        """
        count = max(_LEAST, min(_PIECES, int(1.0 / (frequency * _SHORTEST))))
        waves = max(_WAVES, math.ceil(_LASTS * frequency))
        dt = 1.0 / (frequency * count)
        peak = math.pi * frequency * self.size_at(frequency, limits)
        speeds = peak * np.sin(2.0 * math.pi * np.arange(count + 1) / count)
        speeds[[0, -1]] = 0.0
        wave = [(dt, float(v), float(w - v) / dt) for v, w in pairwise(speeds)]
        return [*(wave * waves), (_BETWEEN, 0.0, 0.0)]


def seconds(ramps: list[Ramp]) -> float:
    """How long they take."""
    return math.fsum(piece[0] for piece in ramps)


def reach(ramps: list[Ramp]) -> tuple[float, float]:
    """How far they lead from where they begin, mm down and up.

    Wherever they are broken off the axis comes to rest within that: they themselves brake no harder than it.
    """
    p, low, high = 0.0, 0.0, 0.0
    for dt, v, a in ramps:
        w = v + a * dt
        turn = p - v * v / (2.0 * a) if v * w < 0.0 else p
        p += 0.5 * (v + w) * dt
        low, high = min(low, turn, p), max(high, turn, p)
    return low, high


def cut(ramps: list[Ramp], begin: float, end: float) -> list[Ramp]:
    """The part of them between two instants, s from their beginning."""
    found, at = [], 0.0
    for dt, v, a in ramps:
        first, last = max(begin - at, 0.0), min(end - at, dt)
        if last - first > _ROUND:
            found.append((last - first, v + a * first, a))
        at += dt
    return found


def braking(ramps: list[Ramp], amax: float) -> list[Ramp]:
    """From their end to rest."""
    if not ramps:
        return []
    dt, v, a = ramps[-1]
    last = v + a * dt
    return [(abs(last) / amax, last, -math.copysign(amax, last))] if abs(last) > _ROUND else []
