"""Drive test: one axis performs a step, a ramp or a sine while its lease is renewed, as in a jog.

The queued setpoints always end in the stop of an expired lease. The full excursion must be within the travel
before the axis moves. Nothing is written to a drive.

A setpoint cannot jump, so a step is a move with the full acceleration of the axis over the first half and
full braking over the second. A sine is s/2·(1 - cos ωt). It starts at rest and stays on one side of the start
position.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np

from core.executor.hand_motion.jog_line import Ramp, room_to_limit
from core.executor.hand_motion.jogging import LONGEST_LEASE, Jogger, step_ramps
from core.executor.machine_context import MachineContext
from core.executor.snapshot import DriveTestState
from core.machine.machine_model import Axis
from core.message import Message
from core.ports import MachinePorts

LARGEST = 2.54  # mm, largest travel of a step or a sine
LONGEST = 25.4  # mm, largest travel of a ramp, which needs distance to reach a constant speed
PAUSE = 0.5  # s of rest after each move, for settling
_BETWEEN = 0.2  # s of rest after each sine
_WAVES, _LASTS = 5, 0.8  # least number of periods and least s of a sine; the first period is for settling
_PIECES = 40  # most ramps per period
_SHORTEST = 0.002  # s, shortest ramp
_LEAST = 12  # least ramps per period
_ROUND = 1e-9
PLANS = (
    "drive tests are not available because the controller plans its own motion and does not accept setpoints"
)
TICKS = 100.0  # samples per second if the driver has no samples


class Shape(StrEnum):
    """The shape of the setpoints of a test over time."""

    STEP = "step"
    RAMP = "ramp"
    SINE = "sine"


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits of the axis in a test: speed in mm/s, acceleration in mm/s², and samples per second."""

    top: float
    amax: float
    rate: float

    @property
    def fastest_sine(self) -> float:
        """The highest sine frequency in Hz, which gives ten samples per period."""
        return self.rate / 10.0


@dataclass(frozen=True, slots=True)
class DriveTestPath:
    """The motion of a drive test.

    ``size`` is the signed travel in mm, peak to peak for a sine. ``speed`` is the speed of a ramp in mm/s.
    ``frequencies`` are those of the sines in Hz.
    """

    axis: str
    shape: Shape
    size: float
    speed: float = 0.0
    frequencies: tuple[float, ...] = ()

    def refusal(self, limits: Limits) -> str:
        """Return why the values are not valid for a test, or an empty string."""
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
        """Return the signed peak-to-peak travel in mm of the sine, reduced to what the axis can follow."""
        omega = 2.0 * math.pi * frequency
        able = min(2.0 * limits.top / omega, 2.0 * limits.amax / omega**2)
        return math.copysign(min(abs(self.size), able), self.size)

    def ramps(self, limits: Limits) -> list[Ramp]:
        """Return the ramps of the test from rest to rest: (seconds, start speed, acceleration)."""
        if self.shape is Shape.SINE:
            return [piece for each in self.frequencies for piece in self._sine(each, limits)]
        top = self.speed if self.shape is Shape.RAMP else limits.top
        return [
            piece
            for way in (self.size, -self.size)
            for piece in (*step_ramps(way, top, limits.amax), (PAUSE, 0.0, 0.0))
        ]

    def _sine(self, frequency: float, limits: Limits) -> list[Ramp]:
        """Return the ramps of one sine, whose velocity is exact at the ends and linear between them.

        The amplitude is smaller than requested by (ω dt)²/12: 2 % for the fastest sine and 0.2 % for the
        others. The axis returns exactly to its start.
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
    """Return the duration of the ramps in seconds."""
    return math.fsum(piece[0] for piece in ramps)


def reach(ramps: list[Ramp]) -> tuple[float, float]:
    """Return the lowest and the highest position relative to the start, in mm.

    If the ramps are interrupted, the axis stops within this range, because it can always brake as hard as the
    ramps do.
    """
    p, low, high = 0.0, 0.0, 0.0
    for dt, v, a in ramps:
        w = v + a * dt
        turn = p - v * v / (2.0 * a) if v * w < 0.0 else p
        p += 0.5 * (v + w) * dt
        low, high = min(low, turn, p), max(high, turn, p)
    return low, high


def cut(ramps: list[Ramp], begin: float, end: float) -> list[Ramp]:
    """Return the part of the ramps between two times in seconds from their start."""
    found, at = [], 0.0
    for dt, v, a in ramps:
        first, last = max(begin - at, 0.0), min(end - at, dt)
        if last - first > _ROUND:
            found.append((last - first, v + a * first, a))
        at += dt
    return found


def braking(ramps: list[Ramp], amax: float) -> list[Ramp]:
    """Return the ramp from the final speed to rest, or an empty list if the ramps end at rest."""
    if not ramps:
        return []
    dt, v, a = ramps[-1]
    last = v + a * dt
    return [(abs(last) / amax, last, -math.copysign(amax, last))] if abs(last) > _ROUND else []


def barred(ports: MachinePorts) -> str:
    """Return why this machine cannot run drive tests, or an empty string."""
    return PLANS if ports.blocks is not None else ports.untraced


class DriveTester:
    """Runs the drive tests of the executor, one at a time."""

    def __init__(self, context: MachineContext, jogger: Jogger) -> None:
        self._context, self._jogger = context, jogger
        self._ramps: list[Ramp] = []
        self._lasts = 0.0  # s, duration of all ramps
        self._began = 0.0
        self._until = 0.0  # s from the start of the test that are queued
        self._number = 0

    @property
    def state(self) -> DriveTestState:
        """The state of the drive tests for the snapshot."""
        jogger = self._jogger
        return DriveTestState(
            barred(self._context.ports),
            jogger.axis if jogger.testing else "",
            self._number,
            self._began,
            jogger.tested,
            self._rate,
        )

    @property
    def _rate(self) -> float:
        samples = self._context.ports.samples
        return samples.rate if samples is not None else TICKS

    def refusal(self, path: DriveTestPath, lease: float) -> str:
        """Return why this test is refused, or an empty string if it may start."""
        if why := barred(self._context.ports) or self._jogger.missing(path.axis):
            return why
        if not math.isfinite(lease) or lease <= 0.0:
            return "a drive test needs a watchdog time greater than 0"
        return self._not_now(path.axis) or self._no_test(path)

    def _not_now(self, name: str) -> str:
        context = self._context
        if self._jogger.axis:
            return Message("{axis} is still moving", axis=self._jogger.axis)
        if context.signals.hold:
            return "feed hold is pressed"
        if context.spindle.guard_open:
            return "the guard is open"
        if context.spindle.asked or not context.spindle.stopped:
            return "the spindle is turning; stop it first"
        if not context.sample.homed[context.ports.axes.axes.index(name)]:
            return Message(
                "{name} is not homed, so TurnDesk cannot check whether there is enough travel for the test",
                name=name,
            )
        return ""

    def _no_test(self, path: DriveTestPath) -> str:
        axis = self._context.machine.axis(path.axis)
        if axis.rotary:
            return Message("{axis} is a rotary axis; drive tests are only for linear axes", axis=axis.name)
        limits = self._limits(axis)
        return path.refusal(limits) or self._no_room(axis, path, limits)

    def _no_room(self, axis: Axis, path: DriveTestPath, limits: Limits) -> str:
        here = self._context.sample.demand[self._context.ports.axes.axes.index(axis.name)]
        low, high = reach(path.ramps(limits))
        for way in (low, high):
            if abs(way) > _ROUND and abs(way) > room_to_limit(axis, here, way):
                end = "+" if way > 0.0 else "−"
                return Message(
                    "{axis} must move {distance} mm in the {end} direction for the test, but its travel ends "
                    "before that point",
                    axis=axis.name,
                    distance=f"{abs(way):.3f}",
                    end=end,
                )
        return ""

    def _limits(self, axis: Axis) -> Limits:
        return Limits(self._jogger.top(axis, homed=True), axis.amax, self._rate)

    def begin(self, path: DriveTestPath, lease: float) -> bool:
        """Start a test from rest; return False if its lease expires before anything moves.

        Raises DriverError if the setpoints are rejected.
        """
        self._ramps = path.ramps(self._limits(self._context.machine.axis(path.axis)))
        self._lasts, self._until = seconds(self._ramps), 0.0
        begins = self._queue(path.axis, lease)
        self._number += begins
        return begins

    def renew(self, lease: float) -> None:
        """Renew the lease of the test. A test that is braking or finished is not extended.

        Raises DriverError if the setpoints are rejected.
        """
        jogger = self._jogger
        if jogger.testing and not jogger.ending and self._until < self._lasts and lease > 0.0:
            self._queue(jogger.axis, lease)

    def look(self) -> None:
        """Stop the test if the guard is open. Called once per tick. Raises DriverError."""
        if self._jogger.testing and not self._jogger.ending and self._context.spindle.guard_open:
            self._jogger.stop()

    def _queue(self, name: str, lease: float) -> bool:
        """Queue the setpoints for the lease and the braking after it; return False if nothing remains."""
        amax, until = self._context.machine.axis(name).amax, self._context.now + min(lease, LONGEST_LEASE)

        def go(start: float, _p: float, _v: float) -> list[Ramp]:
            if not self._until:
                self._began = start
            if start - self._began > self._until:
                return []  # the lease has expired and the axis is braking
            kept = cut(self._ramps, start - self._began, until - self._began)
            return [*kept, *braking(kept, amax)]

        plays = self._jogger.play(name, go)
        if plays:
            self._until = min(until - self._began, self._lasts)
            self._jogger.whole(self._until >= self._lasts)
        return plays
