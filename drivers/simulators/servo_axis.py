"""Simulated servo axis with position loop, feed-forward, drive limits, encoder, wear and faults.

``SimulatedServo.follow_setpoint`` calculates one step of a linear second-order model. While no drive limit
takes effect, the model has a closed-form solution: the axis follows the setpoint with a constant lag, and
two deviations decay. One evaluation of ``ServoLoop`` then replaces any number of steps. Both results agree
within rounding (1e-9 mm).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeVar

from core.ports import Cam, DriverError, FloatArray, MotionSegments
from drivers.setpoint_queue import check_setpoint_limits
from drivers.simulators.plant_config import SimAxis

# Lowest speed in mm/s and fraction of the rapid between which an axis is assumed to cut.
_FEEDS, _CUTS = 0.05, 0.25
_SETTLED_DISTANCE = 1e-4  # Mm or degrees; an axis closer than this and almost at rest is set to its setpoint.


class SimulatedServo:
    """Simulated axis with its drive.

    Positions are as the control counts them; after homing, they are relative to the home position.
    """

    def __init__(self, axis: SimAxis, step_s: float = 0.001) -> None:
        """Create the axis; ``step_s`` is the grid interval of the model in seconds."""
        self.axis = axis
        self._step = step_s
        self.homed = axis.absolute
        self.switch = 0.0 if axis.absolute else -axis.power_up_position  # Home position in the present count.
        self.p = axis.power_up_position if axis.absolute else 0.0
        self.v = 0.0
        self.jammed = False
        self.stuck: float | None = None  # Reading of a stuck encoder.
        self.runaway = 0.0  # Speed of a runaway drive with power.
        self.worn = AxisWear()
        self.over = 0.0  # Seconds outside the following error window.
        self.load = 0.0  # Percent of the drive's capacity, signed.
        self.feeds = (_FEEDS, _CUTS * axis.vmax)  # Speed range in which the axis is assumed to cut.
        self._wn = 2 * math.pi * axis.bandwidth_hz
        self._loop = (
            ServoLoop(self._wn * step_s, axis.feed_forward_fraction) if self._wn * step_s < 0.5 else None
        )

    @property
    def reading(self) -> float:
        """Return the measured position, rounded to whole encoder counts."""
        if self.stuck is not None:
            return self.stuck
        worn = self.worn
        p = (
            worn.slide_position
            if worn.gib
            else worn.get_encoder_position(self.p)
            if worn.has_encoder_error
            else self.p
        )
        return round(p / self.axis.count) * self.axis.count

    @property
    def sound(self) -> bool:
        """Return whether the axis, its drive and its encoder have no fault."""
        worn = self.worn
        return not (
            self.jammed or self.runaway or worn.gib or worn.ripple or worn.missed or self.stuck is not None
        )

    @property
    def cuts(self) -> bool:
        """Return whether the axis moves at a cutting feed, which is well below its rapid speed."""
        least, most = self.feeds
        return least < abs(self.v) < most

    @property
    def where(self) -> float:
        """Return the true position of the axis."""
        return self.worn.slide_position if self.worn.gib else self.p

    def push(self, distance: float) -> None:
        """Displace the axis by ``distance``."""
        self.p += distance
        self.worn.slide_position += distance

    def lead(self, position: float, velocity: float, acceleration: float) -> float:
        """Return the setpoint that makes the axis reach ``position`` despite its following error.

        The calculation inverts ``follow_setpoint``. With ff as the feed-forward fraction and wn as the
        natural frequency, 2(1 - ff)v/wn compensates for the velocity v, and a/wn² compensates for the
        acceleration a.
        """
        return (
            position
            + (2.0 * (1.0 - self.axis.feed_forward_fraction) * velocity + acceleration / self._wn) / self._wn
        )

    def follow_setpoint(self, position: float, velocity: float, seconds: float) -> bool:
        """Advance the powered drive by one step of ``seconds``, and return whether the drive trips.

        The setpoint consists of a position and a velocity v. The drive trips if the following error is
        outside its window for too long. The model is of second order with damping 1. With a feed-forward
        fraction ff below 1, the axis lags by 2(1 - ff)v/wn, where wn is the natural frequency.
        """
        wn, axis = self._wn, self.axis
        seen = self.p if self.stuck is None and not self.worn.has_encoder_error else self._encoder_reading()
        limit = axis.amax * axis.acceleration_reserve_factor
        force = wn * (wn * (position - seen) + 2 * (axis.feed_forward_fraction * velocity - self.v))
        # Faster than min and max; this code runs three times per millisecond.
        if not -limit <= force <= limit:
            force = math.copysign(limit, force)
        self.load = 100.0 * force / limit
        if self.jammed:
            self.v = 0.0
        elif self.runaway:
            self.v = self.runaway
            self.p += self.v * seconds
        else:
            speed, top = self.v + force * seconds, axis.vmax * 1.1
            self.v = speed if -top <= speed <= top else math.copysign(top, speed)
            self.p += self.v * seconds
        if self.worn.gib:
            self.worn.move_slide(self.p, self.v)
        if abs(position - seen) > axis.following_window:
            self.over += seconds
            return self.over > axis.following_time
        self.over = 0.0
        return False

    def predict_response(self, setpoints: SetpointPolynomial, point_count: int) -> ServoResponse | None:
        """Return the response to ``point_count`` setpoints, or None if a fault or a limit may apply.

        The limits are those of ``follow_setpoint``. The force at the first point is calculated exactly; all
        other values are upper bounds.
        """
        loop, axis, dt = self._loop, self.axis, self._step
        if not self.sound or loop is None:
            return None
        p, dp, ddp = setpoints
        if self.p == p and not (self.v or dp or ddp):
            return RESPONSE_AT_REST
        response = loop.calculate_response(self.p, self.v * dt, setpoints)
        lag, drift, slow, fast = response
        slow, fast = abs(slow), abs(fast)
        if abs(lag) + abs(drift) * point_count + slow + fast > axis.following_window:
            return None
        bent = 2.0 * abs(ddp) + slow * loop.slow_curvature + fast * loop.fast_curvature
        first = self._wn * (self._wn * (p - self.p) + 2.0 * (axis.feed_forward_fraction * dp / dt - self.v))
        if max(bent / (dt * dt), abs(first)) > axis.amax * axis.acceleration_reserve_factor:
            return None
        fastest = max(abs(dp), abs(dp + 2.0 * ddp * point_count)) + abs(drift) + slow + fast
        return response if fastest <= axis.vmax * 1.1 * dt else None

    def apply_response(
        self, setpoints: SetpointPolynomial, response: ServoResponse, point_count: int
    ) -> None:
        """Move the axis as ``point_count`` calls of ``follow_setpoint`` would do.

        ``response`` is the result of ``predict_response``.
        """
        self.p, self.v, self.load = self.states(setpoints, response, point_count)
        self.over = 0.0

    def states(
        self, setpoints: SetpointPolynomial, response: ServoResponse, point_count: FloatOrArray
    ) -> tuple[FloatOrArray, FloatOrArray, FloatOrArray]:
        """Return the position, velocity and load after ``point_count`` grid points.

        ``point_count`` is a single number or an array.
        """
        assert self._loop is not None
        dt = self._step
        place, moved, bent = self._loop.calculate_states_at(setpoints, response, point_count)
        return (
            place,
            moved / dt,
            100.0 * bent / (dt * dt) / (self.axis.amax * self.axis.acceleration_reserve_factor),
        )

    def _encoder_reading(self) -> float:
        """Return the position that the drive measures."""
        if self.stuck is not None:
            return self.stuck
        return self.worn.get_encoder_position(self.p) if self.worn.has_encoder_error else self.p

    def roll(self, seconds: float) -> None:
        """Let the axis coast without power for one step of ``seconds`` seconds, slowed down by friction."""
        drop = 0.5 * self.axis.amax * seconds
        self.v = 0.0 if self.jammed or abs(self.v) <= drop else self.v - math.copysign(drop, self.v)
        self.p += self.v * seconds
        if self.worn.gib:
            self.worn.move_slide(self.p, self.v)
        self.over = self.load = 0.0

    def settle_at_setpoint(self, position: float) -> bool:
        """If the axis is almost at ``position``, set it to rest there; return whether it is at rest."""
        if self.jammed or self.stuck is not None or self.runaway:
            return False
        if (
            abs(self._encoder_reading() - position) < _SETTLED_DISTANCE
            and abs(self.v) < _SETTLED_DISTANCE * self._wn
        ):
            self.p = self.p if self.worn.has_encoder_error else position
            self.v = self.over = self.load = 0.0
            return True
        return False

    def reference(self) -> None:
        """Set the position count to zero at the home switch, and mark the axis as homed."""
        self.push(-self.switch)
        self.switch = 0.0
        self.homed = True

    def handle_power_loss(self) -> None:
        """Clear the home reference of an incremental encoder, as a loss of power does."""
        self.load = 0.0
        if not self.axis.absolute and self.homed:
            self.homed = False


# --- Limits of the drives: setpoints beyond them are rejected.


_STANDSTILL_RPM = 10.0  # Rpm above which the spindle drive cannot position.
_SLIP_SPEED_FACTOR = 1.1  # Factor of an axis' speed: above it a cam is rejected, below it the gear slips.


def check_drive_limits(segments: MotionSegments, servos: Sequence[SimulatedServo], rpm: float) -> None:
    """Check setpoints against the limits of the drives.

    Raises DriverError if a speed is too high, or if a position of a homed axis is out of range. Also raises
    DriverError if C moves on the spindle drive while the spindle is turning; C with its own drive may move.
    """
    axes = [servo.axis for servo in servos]
    check_setpoint_limits(
        segments, axes, [servo.homed for servo in servos], [servo.reading for servo in servos]
    )
    for i, axis in enumerate(axes):
        if (
            axis.name == "C"
            and not axis.own_drive
            and abs(rpm) > _STANDSTILL_RPM
            and segments.velocities[:, i].any()
        ):
            raise DriverError(
                "C axis: the spindle is turning at {rpm} rpm, so no setpoints were queued",
                "drive-limits",
                rpm=f"{rpm:.0f}",
            )


def check_cam_limits(cam: Cam, servos: Sequence[SimulatedServo], rpm: float) -> None:
    """Check a cam against the limits of the drives at a spindle speed of ``rpm``.

    Raises DriverError in the same cases as ``check_drive_limits``. The speeds on the cam may be up to 10 %
    above the limit, because the gear then slips.
    """
    by_time = cam.segments.velocities * (abs(rpm) / 60.0 / _SLIP_SPEED_FACTOR)
    check_drive_limits(cam.segments._replace(velocities=by_time), servos, rpm)
    if cam.following_segments is not None:
        check_drive_limits(cam.following_segments, servos, rpm)


# --- Wear: a loose gib, and an encoder error once per revolution of the screw.


_STICK_SLIP_SPEED = 2.0  # Speed in mm/s below which a loose slide sticks and slips.
_STICK_FRACTION = 0.25  # Fraction of the play by which the screw winds up before a sticking slide moves.
SCREW_LEAD_MM = 5.0  # Travel in mm per revolution of the screw.


class AxisWear:
    """Mechanical wear and encoder errors between the motor and the measured position.

    With a loose gib, the drive controls the motor, but the encoder measures the slide. The slide lags by
    half of the play in the direction of motion, so that a reversal loses the full play. Below 2 mm/s, the
    slide sticks until the screw has advanced by another quarter of the play, and then slips.

    An encoder error also affects the drive. ``ripple`` is the amplitude of an error that repeats once per
    revolution, as with an eccentric encoder disc. ``missed`` is the distance that the encoder fails to
    count once per revolution.
    """

    def __init__(self) -> None:
        self.gib = 0.0  # mm of play
        self.ripple = 0.0  # mm
        self.missed = 0.0  # mm
        self.turn = SCREW_LEAD_MM
        self.slide_position = 0.0  # Position of the slide while the gib is loose.

    @property
    def has_encoder_error(self) -> bool:
        """Return whether the position that the drive measures differs from the motor position."""
        return self.ripple != 0.0 or self.missed != 0.0

    def set_gib_play(self, play_mm: float, slide_position: float) -> None:
        """Set the play of the gib in mm while the slide is at ``slide_position``; 0 removes the play."""
        self.gib, self.slide_position = play_mm, slide_position

    def get_encoder_position(self, motor_position: float) -> float:
        """Return the position that the encoder measures when the motor is at ``motor_position``."""
        turns = motor_position / self.turn
        return (
            motor_position + self.ripple * math.sin(2.0 * math.pi * turns) - self.missed * math.floor(turns)
        )

    def move_slide(self, motor_position: float, motor_velocity: float) -> None:
        """Move the slide with the motor, which is at ``motor_position`` with ``motor_velocity``."""
        play = 0.5 * self.gib
        slide_lag = motor_position - self.slide_position
        if abs(slide_lag) > play * (
            1.0 + 2.0 * _STICK_FRACTION if abs(motor_velocity) < _STICK_SLIP_SPEED else 1.0
        ):
            self.slide_position = motor_position - math.copysign(play, slide_lag)


# --- Closed-form response of the servo to setpoints of constant acceleration.


FloatOrArray = TypeVar("FloatOrArray", float, FloatArray)


class SetpointPolynomial(NamedTuple):
    """Setpoints of one axis on the time grid of the model, as a polynomial of second order.

    At grid point k, the setpoint is constant_term + linear_term · k + quadratic_term · k².
    """

    constant_term: float
    linear_term: float
    quadratic_term: float


class ServoResponse(NamedTuple):
    """Difference between position and setpoint of one axis on the time grid of the model.

    At grid point k, the difference is lag + drift · k + slow_amplitude · s^k + fast_amplitude · f^k, where
    s and f are ``slow_mode`` and ``fast_mode`` of ``ServoLoop``.
    """

    lag: float
    drift: float
    slow_amplitude: float
    fast_amplitude: float


RESPONSE_AT_REST = ServoResponse(0.0, 0.0, 0.0, 0.0)


class ServoLoop:
    """Position loop with damping 1, as a difference equation.

    ``stiffness`` is the natural frequency times the duration of a step. ``feed_forward`` is the fraction of
    the velocity that is sent to the drive. Raises ValueError if the stiffness is not positive, or if the
    loop would oscillate (stiffness of 0.5 or more).
    """

    def __init__(self, stiffness: float, feed_forward: float) -> None:
        if not 0.0 < stiffness < 0.5:
            raise ValueError(f"stiffness {stiffness}: must be between 0 and 0.5")
        w = self._w = stiffness
        self._missing = 1.0 - feed_forward
        # The characteristic equation m² - (2 - 2w - w²)m + (1 - 2w) = 0 has two real roots.
        middle, half = 1.0 - w - 0.5 * w * w, 0.5 * w * math.sqrt(w * (4.0 + w))
        self.slow_mode, self.fast_mode = middle + half, middle - half
        self.slow_curvature, self.fast_curvature = (self.slow_mode - 1.0) ** 2, (self.fast_mode - 1.0) ** 2

    def calculate_response(
        self, position: float, last_move: float, setpoints: SetpointPolynomial
    ) -> ServoResponse:
        """Return the response of an axis at ``position`` with the last move ``last_move``.

        Both are in mm or degrees.
        """
        w, missing, (p, dp, ddp) = self._w, self._missing, setpoints
        drift = -4.0 * ddp * missing / w
        lag = (2.0 * w * (ddp - missing * dp - drift) - 2.0 * ddp) / (w * w)
        now = position - p - lag
        before = position - last_move - (p - dp + ddp) - (lag - drift)
        after = (2.0 - 2.0 * w - w * w) * now - (1.0 - 2.0 * w) * before
        slow = (after - self.fast_mode * now) / (self.slow_mode - self.fast_mode)
        return ServoResponse(lag, drift, slow, now - slow)

    def calculate_states_at(
        self, setpoints: SetpointPolynomial, response: ServoResponse, grid_point: FloatOrArray
    ) -> tuple[FloatOrArray, FloatOrArray, FloatOrArray]:
        """Return the position, the last move and its change at grid point ``grid_point``.

        A move is the distance from one grid point to the next. Lengths are in mm or degrees, and times are
        in grid intervals.
        """
        (p, dp, ddp), (lag, drift, slow_part, fast_part) = setpoints, response
        slow, fast = (
            slow_part * self.slow_mode ** (grid_point - 1),
            fast_part * self.fast_mode ** (grid_point - 1),
        )
        place = p + dp * grid_point + ddp * grid_point * grid_point + lag + drift * grid_point
        place = place + (slow * self.slow_mode + fast * self.fast_mode)
        moved = dp + ddp * (2 * grid_point - 1) + drift
        moved = moved + slow * (self.slow_mode - 1.0) + fast * (self.fast_mode - 1.0)
        bent = (
            2.0 * ddp
            + slow * self.slow_curvature / self.slow_mode
            + fast * self.fast_curvature / self.fast_mode
        )
        return place, moved, bent
