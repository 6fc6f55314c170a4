"""Simulated spindle motor with a frequency inverter, including its latency, ramps, encoder and faults."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from core.ports import BoolArray, FloatArray
from drivers.simulators.plant_config import SimSpindle

_BEARINGS, _SPEEDS_UP, _IN_CUT = 10.0, 70.0, 30.0  # Percent.
_MAX_ORIENT_START_RPM = 10.0  # Rpm up to which the drive accepts an orientation.
_ANGLE_TOLERANCE_REV = 1e-9  # turns
_GRIP_FREQUENCY_HZ = 5.0  # Frequency in Hz at which a slipping belt grips.


@dataclass(slots=True)
class SpindleFaults:
    """Faults of the spindle that tests can set."""

    speed_fraction: float = 1.0  # fraction of the commanded speed that the motor reaches
    is_stop_ignored: bool = False
    oscillation_fraction: float = 0.0  # Amplitude of the speed oscillation as a fraction.
    oscillation_period_s: float = 2.0  # s
    belt_slip_fraction: float = 0.0  # fraction of the speed that a slipping belt loses in the cut
    fault_text: str = ""
    is_never_oriented: bool = False  # The drive does not report that the angle is reached.


class OrientationCommand(NamedTuple):
    """Command to orient the spindle to ``angle_deg`` degrees from the index.

    ``direction`` is 1 for the direction of M03, -1 for that of M04, and 0 for the shortest path.
    """

    angle_deg: float
    direction: int

    def get_revolutions_to_angle(self, revolutions: float) -> float:
        """Return the signed revolutions from ``revolutions``, the current position, to the angle."""
        left = (self.angle_deg / 360.0 - revolutions) % 1.0
        if left > 1.0 - _ANGLE_TOLERANCE_REV:
            left = 0.0
        if self.direction > 0 or (not self.direction and left <= 0.5):
            return left
        return left - 1.0 if left else 0.0


class SimulatedSpindle(Protocol):
    """Interface of a simulated spindle; speeds and revolutions are signed."""

    @property
    def speed(self) -> float:
        """Return the actual speed in rpm, signed."""
        ...

    @property
    def revolutions(self) -> float:
        """Return the signed revolutions of the spindle."""
        ...

    def advance_to(self, now: float) -> None:
        """Advance the spindle to time ``now``, and execute the commands that become due."""
        ...

    def command_speed(self, time_s: float, rpm: float) -> None:
        """Queue a command for the signed speed ``rpm`` at time ``time_s``."""
        ...


class SpindleMotor:
    """Simulated spindle motor, whose speed ramps and angle are calculated with closed-form formulas."""

    def __init__(self, config: SimSpindle) -> None:
        self.config = config
        self.faults = SpindleFaults()
        self._even = 0.0  # rpm, without wander
        self.slip_fraction = 0.0  # Fraction of the speed that the belt loses now.
        self.is_cutting = False  # A tool is cutting.
        self.revolutions = 0.0
        self.time_s = 0.0
        self._target = 0.0
        self._coasting = False
        self._orders: deque[tuple[float, float, bool]] = deque()
        self._orient: OrientationCommand | None = None  # The spindle is at this angle or turning to it.
        self._begins = 0.0  # Start time of the orientation.

    @property
    def speed(self) -> float:
        """Return the actual speed in rpm, signed."""
        faults = self.faults
        even = self._even * (1.0 - self.slip_fraction) + self._orient_speed
        if not faults.oscillation_fraction:
            return even
        swing = math.sin(2.0 * math.pi * self.time_s / faults.oscillation_period_s)
        return even * (1.0 + faults.oscillation_fraction * swing)

    @property
    def load_percent(self) -> float:
        """Return the load in percent, which results from bearing friction, acceleration and cutting.

        The load is a rough estimate; the depth of cut has no effect.
        """
        if not self._even:
            return 0.0
        faster = (
            abs(self._target) * self.faults.speed_fraction > abs(self._even) + 1e-9 and not self._coasting
        )
        turning = _BEARINGS * abs(self._even) / self.config.max_rpm
        return min(100.0, turning + (_SPEEDS_UP if faster else 0.0) + (_IN_CUT if self.is_cutting else 0.0))

    @property
    def is_at_rest(self) -> bool:
        """Return whether the spindle is at rest and no command is pending."""
        return not self._even and not self._target and not self._orders and not self._orient_speed

    @property
    def is_turning(self) -> bool:
        """Return whether the spindle turns or will turn because of a speed command.

        The motion of an orientation does not count.
        """
        commanded = self._target or any(rpm for _, rpm, _ in self._orders)
        return bool(commanded) or abs(self._even) > _MAX_ORIENT_START_RPM

    @property
    def is_speed_constant(self) -> bool:
        """Return whether the speed will remain constant until a command or a fault changes it."""
        faults = self.faults
        target = 0.0 if faults.fault_text else self._target * faults.speed_fraction
        return self._even == target and not (
            self._orders or self._orient or faults.oscillation_fraction or self.slip_fraction
        )

    @property
    def counted_revolutions(self) -> float:
        """Return the revolutions that the encoder counts, in steps of a quarter pulse."""
        edges = 4 * self.config.pulses_per_rev
        return round(self.revolutions * edges) / edges

    def command_speed(self, time_s: float, rpm: float, should_coast: bool = False) -> None:
        """Queue a speed command, which takes effect after the latency of the inverter.

        A stop cancels pending speed commands. With ``should_coast``, the spindle stops without a ramp.
        """
        if self.faults.is_stop_ignored and abs(rpm) < abs(self._target):
            return
        limit = self.config.max_rpm
        self.cancel_orientation()
        if rpm == 0.0:
            self._orders = deque(waiting for waiting in self._orders if waiting[1] == 0.0)
        self._orders.append(
            (time_s + self.config.command_latency_s, min(max(rpm, -limit), limit), should_coast)
        )

    def remove_power(self, now: float) -> None:
        """Remove the power of the motor, so that the spindle coasts."""
        self._orders.clear()
        self.cancel_orientation()
        self._orders.append((now, 0.0, True))

    # --- orientation --------------------------------------------------------------------------------------

    def orient_spindle(self, now: float, angle_deg: float, direction: int) -> None:
        """Turn the spindle from standstill to ``angle_deg`` degrees, and hold the spindle at this angle.

        The motion starts after the latency of the inverter.
        """
        self._orient, self._begins = (
            OrientationCommand(angle_deg, direction),
            now + self.config.command_latency_s,
        )

    def cancel_orientation(self) -> None:
        """Cancel the orientation; the spindle stays at its current angle."""
        self._orient = None

    @property
    def is_oriented(self) -> bool:
        """Return whether the spindle has reached the commanded angle and the drive reports this."""
        order = self._orient
        there = (
            order is not None
            and self.time_s >= self._begins
            and not order.get_revolutions_to_angle(self.revolutions)
        )
        return there and not self.faults.is_never_oriented and not self.faults.fault_text

    @property
    def _orient_speed(self) -> float:
        """Return the speed in rpm, signed, while the spindle turns to the commanded angle, otherwise 0."""
        order = self._orient
        if order is None or self.time_s < self._begins or self._even or self.faults.fault_text:
            return 0.0
        travel_rev = order.get_revolutions_to_angle(self.revolutions)
        return math.copysign(self.config.orientation_rpm, travel_rev) if travel_rev else 0.0

    def _turn_to_angle(self, now: float) -> None:
        """Turn toward the commanded angle at a constant speed, without simulating the acceleration."""
        order, begins = self._orient, max(self.time_s, self._begins)
        if order is None or self._even or self.faults.fault_text or now <= begins:
            return
        travel_rev = order.get_revolutions_to_angle(self.revolutions)
        done = self.config.orientation_rpm / 60.0 * (now - begins)
        if done >= abs(travel_rev):
            self.revolutions = (
                round(self.revolutions + travel_rev - order.angle_deg / 360.0) + order.angle_deg / 360.0
            )
        else:
            self.revolutions += math.copysign(done, travel_rev)

    def advance_to(self, now: float) -> None:
        """Advance the spindle to time ``now``, and execute the commands that become due."""
        while self._orders and self._orders[0][0] <= now:
            at, rpm, coast = self._orders.popleft()
            self._ramp_speed(max(at - self.time_s, 0.0))
            self.time_s = max(self.time_s, at)
            self._target, self._coasting = rpm, coast
        self._ramp_speed(now - self.time_s)
        if self._orient is not None:
            self._turn_to_angle(now)
        self.time_s = now

    def advance_through_times(self, times: FloatArray, cutting_flags: BoolArray) -> FloatArray:
        """Turn to the last of ``times``, and return the speed, counted revolutions and load at each time.

        The times are in seconds, and the result has the shape (n, 3). ``cutting_flags`` specifies for each
        time whether a tool is cutting.
        """
        if not self.is_speed_constant:
            return np.array(
                [self._turn_to(*each) for each in zip(times.tolist(), cutting_flags.tolist(), strict=True)]
            )
        edges, self.is_cutting = 4 * self.config.pulses_per_rev, False
        rows = np.empty((len(times), 3))
        rows[:, 0] = self._even
        rows[:, 1] = np.rint((self.revolutions + self._even / 60.0 * (times - self.time_s)) * edges) / edges
        rows[:, 2] = self.load_percent + _IN_CUT * cutting_flags if self._even else 0.0
        self.advance_to(float(times[-1]))
        return rows

    def _turn_to(self, t: float, cuts: bool) -> tuple[float, float, float]:
        self.is_cutting = cuts
        self.advance_to(t)
        return self.speed, self.counted_revolutions, self.load_percent

    def set_cutting(self, now: float, *, is_cutting: bool) -> None:
        """Set whether a tool is cutting; while it is, a slipping belt loses and regains speed."""
        now = max(now, self.time_s)
        self.advance_to(now)
        swing = 0.5 - 0.5 * math.cos(2.0 * math.pi * _GRIP_FREQUENCY_HZ * now)
        self.slip_fraction = self.faults.belt_slip_fraction * swing if is_cutting else 0.0

    def _ramp_speed(self, dt: float) -> None:
        """Ramp toward the target speed for ``dt`` seconds, and run at this speed once it is reached."""
        faults, t, held = self.faults, self.time_s, 1.0 - self.slip_fraction
        target = 0.0 if faults.fault_text else self._target * faults.speed_fraction
        while dt > 0.0:
            if self._even == target:
                self.revolutions += held * self._even / 60.0 * (dt + self._oscillation_seconds(t, dt))
                return
            braking = self._even * target <= 0.0 < abs(self._even) or abs(target) < abs(self._even)
            rate = self.config.deceleration_rpm_per_s if braking else self.config.acceleration_rpm_per_s
            if braking and (self._coasting or faults.fault_text):
                rate = self.config.coast_deceleration_rpm_per_s
            goal = 0.0 if self._even * target < 0.0 else target
            used = min(dt, abs(goal - self._even) / rate)
            before = self._even
            reached = used < dt
            self._even = goal if reached else before + (rate if goal > before else -rate) * used
            self.revolutions += (
                held * 0.5 * (before + self._even) / 60.0 * (used + self._oscillation_seconds(t, used))
            )
            dt, t = dt - used, t + used
            if reached and goal == target:
                self.revolutions += held * self._even / 60.0 * (dt + self._oscillation_seconds(t, dt))
                return

    def _oscillation_seconds(self, t: float, dt: float) -> float:
        """Return the additional rotation caused by the oscillation, as seconds at constant speed.

        The rotation starts at time ``t`` and lasts ``dt`` seconds. The fault ``oscillation_fraction``
        causes the oscillation.
        """
        faults = self.faults
        if not faults.oscillation_fraction:
            return 0.0
        rate = 2.0 * math.pi / faults.oscillation_period_s
        return faults.oscillation_fraction * (math.cos(rate * t) - math.cos(rate * (t + dt))) / rate
