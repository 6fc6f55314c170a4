"""Drive test: one axis performs a step, a ramp or a sine while the test's lease is renewed.

As in a jog, the queued setpoints always end with the stop that follows an expired lease. The test starts
only if its full travel is within the travel limits, and it changes no drive parameters. A step is a move
with full acceleration over the first half and full braking over the second half. A sine is s/2·(1 - cos
ωt): it starts at rest and stays on one side of the start position.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np

from core.executor.hand_motion.jog_line import Ramp, get_distance_to_limit
from core.executor.hand_motion.jog_ramps import plan_step_ramps
from core.executor.hand_motion.jogging import MAX_LEASE_S, Jogger
from core.executor.machine_context import MachineContext
from core.executor.snapshot import DriveTestState
from core.machine.machine_model import Axis
from core.message import Message
from core.ports import MachinePorts

MAX_STEP_TRAVEL_MM = 2.54  # mm, largest travel of a step or a sine
MAX_RAMP_TRAVEL_MM = 25.4  # mm, largest travel of a ramp, which needs distance to reach a constant speed
PAUSE_BETWEEN_MOVES_S = 0.5  # s of rest after each move, for settling
_PAUSE_BETWEEN_SINES_S = 0.2  # s of rest after each sine
_WAVES, _LASTS = 5, 0.8  # least number of periods and least s of a sine; the first period is for settling
_MAX_SINE_PIECES = 40  # most ramps per period
_MIN_RAMP_S = 0.002  # s, shortest ramp
_MIN_SINE_PIECES = 12  # least ramps per period
_ROUNDING_TOLERANCE = 1e-9
NO_SETPOINTS_REASON = (
    "drive tests are not available because the controller plans its own motion and does not accept setpoints"
)
TICK_SAMPLE_RATE_HZ = 100.0  # samples per second if the driver has no samples


class Shape(StrEnum):
    """Waveform of the setpoints in a drive test."""

    STEP = "step"
    RAMP = "ramp"
    SINE = "sine"


@dataclass(frozen=True, slots=True)
class AxisTestLimits:
    """Limits for the drive test of an axis.

    The speed is in mm/s, the acceleration in mm/s², and the sample rate in Hz.
    """

    max_speed_mm_s: float
    max_acceleration_mm_s2: float
    sample_rate_hz: float

    @property
    def max_sine_frequency_hz(self) -> float:
        """Return the highest sine frequency in Hz that still has ten samples per period."""
        return self.sample_rate_hz / 10.0


@dataclass(frozen=True, slots=True)
class DriveTestMotion:
    """The parameters of the motion in a drive test.

    ``travel_mm`` is the signed travel in mm; for a sine it is the peak-to-peak travel. ``speed`` is the
    speed of a ramp in mm/s. ``frequencies_hz`` are the frequencies of the sines in Hz.
    """

    axis: str
    shape: Shape
    travel_mm: float
    speed: float = 0.0
    frequencies_hz: tuple[float, ...] = ()

    def find_refusal_reason(self, limits: AxisTestLimits) -> str:
        """Return why the test parameters are not permitted, or an empty string if they are."""
        longest = MAX_RAMP_TRAVEL_MM if self.shape is Shape.RAMP else MAX_STEP_TRAVEL_MM
        if not 0.0 < abs(self.travel_mm) <= longest + _ROUNDING_TOLERANCE:
            return Message(
                "the travel of this test must be greater than 0 and at most {longest} mm",
                longest=f"{longest:g}",
            )
        if self.shape is Shape.RAMP:
            return self._ramp_refusal(limits)
        return self._sine_refusal(limits) if self.shape is Shape.SINE else ""

    def _ramp_refusal(self, limits: AxisTestLimits) -> str:
        if not 0.0 < self.speed <= limits.max_speed_mm_s + _ROUNDING_TOLERANCE:
            return Message(
                "the speed of a ramp must be above 0 and at most {top} mm/s, the limit for manual moves",
                top=f"{limits.max_speed_mm_s:.0f}",
            )
        if self.speed**2 / limits.max_acceleration_mm_s2 > 0.5 * abs(self.travel_mm):
            return Message(
                "a travel of {size} mm is too short to reach a constant speed of {speed} mm/s",
                size=f"{abs(self.travel_mm):g}",
                speed=f"{self.speed:g}",
            )
        return ""

    def _sine_refusal(self, limits: AxisTestLimits) -> str:
        if not self.frequencies_hz or not all(0.5 <= each <= 200.0 for each in self.frequencies_hz):
            return "the sine frequency must be from 0.5 to 200 Hz"
        fastest = max(self.frequencies_hz)
        if fastest > limits.max_sine_frequency_hz + _ROUNDING_TOLERANCE:
            return Message(
                "this driver reports {rate} samples per second, which is not enough for a {fastest} Hz sine",
                rate=f"{limits.sample_rate_hz:g}",
                fastest=f"{fastest:g}",
            )
        return ""

    def compute_sine_travel_mm(self, frequency: float, limits: AxisTestLimits) -> float:
        """Return the signed peak-to-peak travel of the sine in mm.

        At high frequencies, it is reduced to what the axis can follow.
        """
        omega = 2.0 * math.pi * frequency
        able = min(2.0 * limits.max_speed_mm_s / omega, 2.0 * limits.max_acceleration_mm_s2 / omega**2)
        return math.copysign(min(abs(self.travel_mm), able), self.travel_mm)

    def make_ramps(self, limits: AxisTestLimits) -> list[Ramp]:
        """Return the ramps of the test from rest to rest, as (seconds, start speed, acceleration)."""
        if self.shape is Shape.SINE:
            return [piece for each in self.frequencies_hz for piece in self._make_sine(each, limits)]
        top = self.speed if self.shape is Shape.RAMP else limits.max_speed_mm_s
        return [
            piece
            for distance in (self.travel_mm, -self.travel_mm)
            for piece in (
                *plan_step_ramps(distance, top, limits.max_acceleration_mm_s2),
                (PAUSE_BETWEEN_MOVES_S, 0.0, 0.0),
            )
        ]

    def _make_sine(self, frequency: float, limits: AxisTestLimits) -> list[Ramp]:
        """Return the ramps that approximate a sine of one frequency.

        The velocity is exact at the ends of each ramp and linear between them. The amplitude is too small
        by the fraction (ω dt)²/12: 2 % for the fastest sine and 0.2 % for the others. The axis returns
        exactly to its start position.
        """
        count = max(_MIN_SINE_PIECES, min(_MAX_SINE_PIECES, int(1.0 / (frequency * _MIN_RAMP_S))))
        waves = max(_WAVES, math.ceil(_LASTS * frequency))
        dt = 1.0 / (frequency * count)
        peak = math.pi * frequency * self.compute_sine_travel_mm(frequency, limits)
        speeds = peak * np.sin(2.0 * math.pi * np.arange(count + 1) / count)
        speeds[[0, -1]] = 0.0
        wave = [(dt, float(v), float(w - v) / dt) for v, w in pairwise(speeds)]
        return [*(wave * waves), (_PAUSE_BETWEEN_SINES_S, 0.0, 0.0)]


def compute_duration_s(ramps: list[Ramp]) -> float:
    """Return the duration of the ramps in seconds."""
    return math.fsum(piece[0] for piece in ramps)


def compute_position_range(ramps: list[Ramp]) -> tuple[float, float]:
    """Return the lowest and the highest position relative to the start, in mm.

    An axis that is interrupted also stops within this range, because it can always brake at least as hard
    as the ramps do.
    """
    p, low, high = 0.0, 0.0, 0.0
    for dt, v, a in ramps:
        w = v + a * dt
        turn = p - v * v / (2.0 * a) if v * w < 0.0 else p
        p += 0.5 * (v + w) * dt
        low, high = min(low, turn, p), max(high, turn, p)
    return low, high


def slice_ramps(ramps: list[Ramp], start_s: float, end_s: float) -> list[Ramp]:
    """Return the part of the ramps between two times, which are in seconds from their start."""
    found, at = [], 0.0
    for dt, v, a in ramps:
        first, last = max(start_s - at, 0.0), min(end_s - at, dt)
        if last - first > _ROUNDING_TOLERANCE:
            found.append((last - first, v + a * first, a))
        at += dt
    return found


def make_braking_ramp(ramps: list[Ramp], max_acceleration: float) -> list[Ramp]:
    """Return the ramp from the final speed to rest, or an empty list if the ramps end at rest."""
    if not ramps:
        return []
    dt, v, a = ramps[-1]
    last = v + a * dt
    return (
        [(abs(last) / max_acceleration, last, -math.copysign(max_acceleration, last))]
        if abs(last) > _ROUNDING_TOLERANCE
        else []
    )


def find_unsupported_reason(ports: MachinePorts) -> str:
    """Return why this machine cannot run drive tests, or an empty string if it can."""
    return NO_SETPOINTS_REASON if ports.blocks is not None else ports.untraced


class DriveTester:
    """Executor component that runs drive tests, one at a time."""

    def __init__(self, context: MachineContext, jogger: Jogger) -> None:
        self._context, self._jogger = context, jogger
        self._ramps: list[Ramp] = []
        self._lasts = 0.0  # s, duration of all ramps
        self._began = 0.0
        self._until = 0.0  # s from the start of the test that are queued
        self._number = 0

    @property
    def state(self) -> DriveTestState:
        """Return the state of the drive tests for the snapshot."""
        jogger = self._jogger
        return DriveTestState(
            find_unsupported_reason(self._context.ports),
            jogger.axis_name if jogger.is_testing else "",
            self._number,
            self._began,
            jogger.completed_test_count,
            self._rate,
        )

    @property
    def _rate(self) -> float:
        samples = self._context.ports.samples
        return samples.sample_rate_hz if samples is not None else TICK_SAMPLE_RATE_HZ

    def find_refusal_reason(self, path: DriveTestMotion, lease_s: float) -> str:
        """Return why this test is refused, or an empty string if it may start."""
        if why := find_unsupported_reason(self._context.ports) or self._jogger.find_axis_refusal_reason(
            path.axis
        ):
            return why
        if not math.isfinite(lease_s) or lease_s <= 0.0:
            return "a drive test needs a watchdog time greater than 0"
        return self._not_now(path.axis) or self._no_test(path)

    def _not_now(self, name: str) -> str:
        context = self._context
        if self._jogger.axis_name:
            return Message("{axis} is still moving", axis=self._jogger.axis_name)
        if context.station_signals.is_hold_requested:
            return "feed hold is pressed"
        if context.spindle.is_guard_open:
            return "the guard is open"
        if context.spindle.is_requested or not context.spindle.is_stopped:
            return "the spindle is turning; stop it first"
        if not context.axis_sample.homed[context.ports.axes.axes.index(name)]:
            return Message(
                "{name} is not homed, so TurnDesk cannot check whether there is enough travel for the test",
                name=name,
            )
        return ""

    def _no_test(self, path: DriveTestMotion) -> str:
        axis = self._context.machine.find_axis(path.axis)
        if axis.is_rotary:
            return Message("{axis} is a rotary axis; drive tests are only for linear axes", axis=axis.name)
        limits = self._limits(axis)
        return path.find_refusal_reason(limits) or self._no_room(axis, path, limits)

    def _no_room(self, axis: Axis, path: DriveTestMotion, limits: AxisTestLimits) -> str:
        here = self._context.axis_sample.demand[self._context.ports.axes.axes.index(axis.name)]
        low, high = compute_position_range(path.make_ramps(limits))
        for travel in (low, high):
            if abs(travel) > _ROUNDING_TOLERANCE and abs(travel) > get_distance_to_limit(axis, here, travel):
                end = "+" if travel > 0.0 else "−"
                return Message(
                    "{axis} must move {distance} mm in the {end} direction for the test, but its travel ends "
                    "before that point",
                    axis=axis.name,
                    distance=f"{abs(travel):.3f}",
                    end=end,
                )
        return ""

    def _limits(self, axis: Axis) -> AxisTestLimits:
        return AxisTestLimits(
            self._jogger.get_max_jog_speed(axis, is_homed=True), axis.max_acceleration, self._rate
        )

    def start_test(self, path: DriveTestMotion, lease_s: float) -> bool:
        """Start a test from rest; return False if the lease expires before any axis moves.

        Raises DriverError if the driver rejects the setpoints.
        """
        self._ramps = path.make_ramps(self._limits(self._context.machine.find_axis(path.axis)))
        self._lasts, self._until = compute_duration_s(self._ramps), 0.0
        begins = self._queue(path.axis, lease_s)
        self._number += begins
        return begins

    def renew_lease(self, lease_s: float) -> None:
        """Renew the lease of the running test.

        A test that is braking or completed is not extended. Raises DriverError if the setpoints are
        rejected.
        """
        jogger = self._jogger
        if jogger.is_testing and not jogger.is_stopping and self._until < self._lasts and lease_s > 0.0:
            self._queue(jogger.axis_name, lease_s)

    def stop_if_guard_open(self) -> None:
        """Stop the test if the guard is open.

        The function is called once per tick. Raises DriverError if a driver fails.
        """
        if self._jogger.is_testing and not self._jogger.is_stopping and self._context.spindle.is_guard_open:
            self._jogger.stop()

    def _queue(self, name: str, lease: float) -> bool:
        """Queue the setpoints for the lease and the braking after it; return False if no motion remains."""
        amax, until = (
            self._context.machine.find_axis(name).max_acceleration,
            self._context.now + min(lease, MAX_LEASE_S),
        )

        def plan_ramps(start: float, _p: float, _v: float) -> list[Ramp]:
            if not self._until:
                self._began = start
            if start - self._began > self._until:
                return []  # the lease has expired and the axis is braking
            kept = slice_ramps(self._ramps, start - self._began, until - self._began)
            return [*kept, *make_braking_ramp(kept, amax)]

        plays = self._jogger.run_drive_test(name, plan_ramps)
        if plays:
            self._until = min(until - self._began, self._lasts)
            self._jogger.set_test_fully_queued(self._until >= self._lasts)
        return plays
