"""Control of the main spindle: requested speed, operator limits, commanded speed and measured speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from core.executor.program_motion.spindle_angle import SpindleAnglePredictor
from core.executor.raised_alarm import AlarmError
from core.executor.spindle_orientation import OrientationControl, try_standstill_command
from core.faults import get_fault_code
from core.geometry.surface_speed import find_surface_rpm
from core.interpreter.shared.elementary_blocks import Block
from core.machine.machine_model import SpindleModel
from core.message import Message
from core.ports import OrientingSpindle, Spindle, SpindleCAxis

_GRACE_S = 1.0  # s within which a drive must start to follow a new speed
_REACTION_TIME_S = 0.5  # s of this time for the delay of the drive; the rest is for an ordinary connection
_OVERSPEED_FRACTION = 0.1  # fraction by which the speed may exceed the expected speed, and
_OVERSPEED_RPM = 50.0  # rpm by which the speed may exceed the expected speed
_STOPPED_TIME_S = 0.2  # s at standstill with a command, after which the spindle counts as stopped
_LOST_TIME_S = 2.0  # s after which the command is withdrawn, so that the drive can first report the cause


class SpindleRequest(NamedTuple):
    """The requested signed speed in rpm, or a surface speed in mm/s with its rpm limits.

    M03 and M04 determine the sign. G76 and G77 set the limits ``min_rpm`` and ``max_rpm``.
    """

    rpm: float
    surface_speed_mm_s: float | None = None
    min_rpm: float = 0.0
    max_rpm: float | None = None

    @classmethod
    def from_block(cls, block: Block) -> SpindleRequest:
        """Return the spindle speed that is active in a block."""
        return cls(block.rpm, block.css, block.modal.min_css_rpm, block.modal.max_css_rpm)


class SpindleControl:
    """Control that converts the programmed speed to commands and monitors the spindle drive.

    Only ``request_speed`` and ``permit_start`` start the spindle. After ``stop`` it remains at rest until
    the program requests it again. If the spindle switch, the potentiometer or a fault stops a requested
    spindle, it becomes a waiting spindle: the request is stored, the command is withdrawn, and it starts
    only when permitted.
    """

    def __init__(
        self,
        port: Spindle,
        model: SpindleModel,
        c_axis_port: SpindleCAxis | None = None,
        prepare_css: Callable[[float], None] = lambda _: None,
        orientation: OrientingSpindle | None = None,
        lag: Callable[[], float] = float,
    ) -> None:
        """Initialize the spindle control.

        Before each speed command, ``prepare_css`` receives the highest rpm that the radius may require.
        ``lag`` returns the delay in seconds that the connection adds to commands and measured speeds.
        """
        self._port = port
        self._lay_out, self._lag = prepare_css, lag
        self._lock = c_axis_port
        self.orientation = OrientationControl(orientation, model.orient_rpm)
        self._model = model
        self.operator_limit_rpm: float | None = None  # limit of page F10 until the restart of TurnDesk, rpm
        self.commanded_rpm = 0.0  # signed rpm as sent to the drive
        self.measured_rpm = 0.0
        self.is_c_refused_by_turning = False  # the drive rejected C-axis mode because the spindle turns
        self.is_speed_known = True  # if False, ``measured_rpm`` is the last known speed
        self.angle = SpindleAnglePredictor()
        self.override = 1.0
        self.is_auto = True
        self.is_guard_open = False  # the guard is open, and the machine stops the spindle for it
        self.waiting_reason = ""  # why a requested spindle is stopped and waits for permission to start
        self._ask: SpindleRequest | None = None
        self._turned = False  # the spindle has turned since the command was sent
        # time since which the spindle is stopped although it is commanded and has turned
        self._stands: float | None = None
        self._withdrawn = False  # the command of the waiting spindle is withdrawn
        self._again = False  # send the command even if it is unchanged, because a driver may have dropped it
        self._coasting = False
        self._in_band_since: float | None = None
        self._fell: tuple[float, float] = (0.0, 0.0)  # time and speed at which the command fell
        self._rose: tuple[float, float] = (0.0, 0.0)  # time and speed at which the command rose

    @property
    def max_rpm(self) -> float:
        """Return the maximum permitted speed in rpm."""
        return min(self._model.max_rpm, self.operator_limit_rpm or self._model.max_rpm)

    @property
    def is_requested(self) -> bool:
        """Return whether the program requests a turning spindle."""
        return self._ask is not None

    @property
    def requested_rpm(self) -> float:
        """Return the requested signed speed in rpm.

        With G96, the speed is calculated for the current tool radius.
        """
        ask = self._ask
        if ask is None:
            return 0.0
        return math.copysign(self._request_rpm(ask, self._model.max_rpm), ask.rpm)

    @property
    def is_stopped(self) -> bool:
        """Return whether the measured speed is zero. The result is False if no speed data arrives."""
        return self.is_speed_known and abs(self.measured_rpm) < self._model.stop_below

    @property
    def is_stopped_or_orienting(self) -> bool:
        """Return whether the spindle is stopped, or moves only because its drive is orienting it."""
        return self.is_speed_known and (self.is_stopped or self.orientation.max_rpm > 0.0)

    @property
    def is_speed_lost(self) -> bool:
        """Return whether the spindle turns in the wrong direction or below half its expected speed.

        If so, feed motion must stop.
        """
        along = math.copysign(1.0, self.commanded_rpm) * self.measured_rpm
        return self.commanded_rpm == 0.0 or along < 0.5 * min(
            abs(self.commanded_rpm), self._min_expected_rpm(self._now)
        )

    @property
    def is_too_slow(self) -> bool:
        """Return whether the spindle should turn but is too slow to cut."""
        return self._ask is not None and self.is_speed_lost

    @property
    def spindle_stopped_reason(self) -> str:
        """Return why the spindle is not requested, cannot start or is waiting.

        The result is an empty string if none of this applies.
        """
        if self._ask is None:
            return "SPINDLE STOPPED"
        return self.start_inhibit_reason or self.waiting_reason

    @property
    def start_inhibit_reason(self) -> str:
        """Return the reason at the operator station that prevents a spindle start, or an empty string."""
        if self.is_guard_open:
            return "GUARD OPEN"
        if not self.is_auto:
            return "SPINDLE SWITCH OFF"
        return "SPINDLE OVERRIDE AT 0" if self.override <= 0.0 else ""

    @property
    def waiting_start_rpm(self) -> float:
        """Return the signed speed in rpm at which a waiting spindle will start, or 0 if no spindle waits.

        The position of the spindle switch is ignored, because turning the switch may be the permission to
        start.
        """
        return self._obeying() if self.waiting_reason else 0.0

    def permit_start(self) -> None:
        """Permit a waiting spindle to start.

        The function is called after Cycle Start, or after the spindle switch was turned on.
        """
        if self._ask is not None and not self.start_inhibit_reason:
            self._forget_waiting()
            self._again, self._in_band_since = True, None

    def record_external_stop(self, reason: str) -> None:
        """Record that a device between control and drive has stopped the spindle.

        The spindle then waits for permission to start again.
        """
        if self._ask is not None:
            self.waiting_reason, self._withdrawn = reason, True

    def request_speed(self, demand: SpindleRequest) -> None:
        """Request a spindle speed, as commanded by M03, M04 or S."""
        self._let_go()
        self._ask = demand
        self._forget_waiting()
        self._in_band_since = None

    def adopt_block_speed(self, block: Block) -> None:
        """Adopt the speed of the block being executed, such as after G96 or G97.

        This never starts the spindle.
        """
        if self._ask is not None and block.rpm != 0.0:
            self._ask = SpindleRequest.from_block(block)

    def stop(self) -> None:
        """Stop the spindle because of M05 or a stop of the control, and discard the request."""
        self._ask = None
        self._forget_waiting()
        self._let_go()
        self._send(0.0, self._now)

    def prepare_safe_stop(self, *, should_coast: bool) -> list[tuple[str, Callable[[], None]]]:
        """Discard the spindle request, and return the steps of a safe stop of the spindle.

        The steps release C and command the drive to stop, even if a stop was already commanded. The caller
        must run each step, even if another step raises an error.
        """
        self._ask, self._in_band_since = None, None
        self._forget_waiting()
        if should_coast:
            self._coasting = True
        return [
            ("C", self._free_c),
            ("the spindle orientation", self.orientation.release_spindle),
            ("the spindle", partial(self._tell_off, coast=should_coast)),
        ]

    def _tell_off(self, *, coast: bool) -> None:
        if coast:
            self.commanded_rpm = 0.0
            self._port.start_coasting()
        else:
            if self.commanded_rpm != 0.0:  # a repeated stop does not restart the time limit
                self._record_fall(0.0, self._now)
            self.commanded_rpm = 0.0
            self._port.set_speed(0.0)

    def engage_c_axis(self, *, should_orient: bool) -> bool:
        """Switch the spindle to C-axis mode (M19, M89); return whether it is engaged.

        If the drive still considers the spindle as turning, the next call tries again. Raises DriverError if
        the drive rejects the change for another reason.
        """
        if self._lock is None:
            return True
        if not self._lock.is_c_ready():
            command = partial(self._lock.set_c_mode, True, should_orient)
            self.is_c_refused_by_turning = not try_standstill_command(command)
        return self._lock.is_c_ready()

    def orient_spindle(self, angle: float, direction: int) -> bool:
        """Orient the spindle (M19, SPOS); return whether the drive holds it at ``angle`` degrees.

        A condition that prevents a spindle start also prevents orienting. Raises AlarmError or DriverError
        on failure.
        """
        if self.start_inhibit_reason and self.orientation.angle_deg is None:
            self.orientation.release_spindle()
            return False
        return self.orientation.request_angle(angle, direction)

    def cancel_orientation(self) -> None:
        """Cancel a change to C-axis mode or an orientation in progress because of a feed hold."""
        if not self.is_c_axis_ready:
            self._free_c()
        if self.orientation.angle_deg is None:
            self.orientation.release_spindle()

    @property
    def is_c_axis_ready(self) -> bool:
        """Return whether the spindle drive permits C to move."""
        return self._lock is None or self._lock.is_c_ready()

    def _let_go(self) -> None:
        self.orientation.release_spindle()
        self._free_c()

    def _free_c(self) -> None:
        if self._lock is not None:
            self._lock.set_c_mode(False)

    def read_encoder(self) -> None:
        """Read the encoder. The function is called at the beginning of each tick."""
        self.angle.add_reading(self._port.read_angle())

    def update(self, now: float, radius: float) -> None:
        """Send a changed speed and monitor the drive, once per tick.

        ``radius`` is the radius of the tool position in mm, for constant surface speed. Raises DriverError
        if the drive rejects the speed. Raises AlarmError if the drive has tripped, does not follow its
        command, loses an orientation angle, or reports a speed that is not a number.
        """
        self._now = now
        measured = self._port.speed()
        # keep the last speed, because an unknown speed must not count as a standstill
        if not math.isfinite(measured):
            raise AlarmError("spindle-encoder", "the spindle drive reports a speed that is not a number")
        self.measured_rpm = measured
        self._radius = radius
        self._check_stopped_spindle(now)
        self._send(self._wanted(), now)
        self._watch_band(now)
        fault = self._port.read_fault()
        if fault:
            self._coasting = True
            raise AlarmError(get_fault_code(fault, "spindle"), fault)
        self._coasting = self._coasting and not self.is_stopped and self.commanded_rpm == 0.0
        self.orientation.check_angle()
        if not self._coasting and abs(self.measured_rpm) > self._max_expected_rpm(now):
            turns = Message(
                "the spindle turns at {measured} rpm; the commanded speed is {command} rpm",
                measured=f"{self.measured_rpm:.0f}",
                command=f"{self.commanded_rpm:.0f}",
            )
            raise AlarmError("ignores-stop", turns)

    def is_at_speed(self, now: float) -> bool:
        """Return whether the spindle has been within its speed window long enough.

        The result is also True if the spindle is not requested.
        """
        if self._ask is None:
            return True
        if self.commanded_rpm == 0.0 or self._in_band_since is None:
            return False
        return now - self._in_band_since >= self._model.at_speed_time_s - 1e-9

    def _wanted(self) -> float:
        return 0.0 if self._withdrawn or not self.is_auto else self._obeying()

    def _obeying(self) -> float:
        ask = self._ask
        if ask is None:
            return 0.0
        rpm = min(self._request_rpm(ask, self.max_rpm), self.max_rpm) * self.override
        if 0.0 < rpm < self._model.min_rpm:
            rpm = self._model.min_rpm
        return rpm if ask.rpm >= 0.0 else -rpm

    def _request_rpm(self, request: SpindleRequest, max_rpm: float) -> float:
        """Return the unsigned speed of a request in rpm. ``max_rpm`` limits a surface speed."""
        if request.surface_speed_mm_s is None:
            return abs(request.rpm)
        return find_surface_rpm(
            request.surface_speed_mm_s,
            self._radius,
            request.min_rpm,
            min(request.max_rpm or max_rpm, max_rpm),
        )

    def _send(self, rpm: float, now: float) -> None:
        same = abs(rpm - self.commanded_rpm) <= 0.002 * abs(rpm) and (rpm == 0.0) == (
            self.commanded_rpm == 0.0
        )
        if same and not self._again:
            return
        self._again = False
        self._record_fall(rpm, now)
        if abs(rpm - self.commanded_rpm) > self._model.at_speed_tolerance * abs(rpm):
            self._in_band_since = None
        if rpm * self.commanded_rpm <= 0.0:
            self._turned, self._stands = False, None
        self.commanded_rpm = rpm
        self._lay_out(self._max_css_rpm())
        self._port.set_speed(rpm)

    def _max_css_rpm(self) -> float:
        """Return the highest speed in rpm that constant surface speed may require at any radius.

        The result is 0 if no surface speed is programmed.
        """
        ask = self._ask
        if ask is None or ask.surface_speed_mm_s is None:
            return 0.0
        return min(min(ask.max_rpm or self.max_rpm, self.max_rpm) * self.override, self._model.max_rpm)

    def _record_fall(self, rpm: float, now: float) -> None:
        """Record the time and the speed at which the commanded speed begins to change.

        The change can be a fall, a reversal or a rise. The measured speed is recorded too, because the
        spindle may still coast after an E-stop.
        """
        fastest = max(abs(self.measured_rpm), abs(self.commanded_rpm))
        if abs(rpm) < fastest or rpm * self.commanded_rpm < 0.0 or rpm * self.measured_rpm < 0.0:
            self._fell = (now, fastest)
        elif (
            abs(rpm) > abs(self.commanded_rpm) <= self._min_expected_rpm(now)
        ):  # otherwise the spindle is still accelerating
            self._rose = (now, min(abs(self.measured_rpm), abs(self.commanded_rpm)))

    def _check_stopped_spindle(self, now: float) -> None:
        """Change a requested spindle that has stopped to a waiting spindle.

        It then does not start automatically when the cause of the stop disappears.
        """
        if self._ask is None:
            return
        if self.start_inhibit_reason:
            self.record_external_stop(self.start_inhibit_reason)
        elif not self.is_stopped or abs(self.commanded_rpm) < 2.0 * self._model.stop_below:
            self._turned, self._stands = self._turned or not self.is_stopped, None
        elif self._turned:
            self._stands = now if self._stands is None else self._stands
            if now - self._stands >= _STOPPED_TIME_S:
                self.waiting_reason = self.waiting_reason or "SPINDLE STOPPED UNEXPECTEDLY"
            self._withdrawn = self._withdrawn or now - self._stands >= _LOST_TIME_S

    def _forget_waiting(self) -> None:
        self.waiting_reason, self._withdrawn, self._turned, self._stands = "", False, False, None

    def _watch_band(self, now: float) -> None:
        if abs(self.measured_rpm - self.commanded_rpm) > self._model.at_speed_tolerance * abs(
            self.commanded_rpm
        ):
            self._in_band_since = None
        elif self._in_band_since is None:
            self._in_band_since = now

    def _min_expected_rpm(self, now: float) -> float:
        """Return the lowest speed in rpm that a working drive has after the commanded speed was raised."""
        since, speed = self._rose
        return speed + self._model.acceleration_rpm_s * max(now - since - self._grace_s, 0.0)

    def _max_expected_rpm(self, now: float) -> float:
        """Return the highest speed in rpm that a working drive has after the commanded speed was lowered."""
        since, speed = self._fell
        ramp = speed - self._model.deceleration_rpm_s * max(now - since - self._grace_s, 0.0)
        return (
            max(abs(self.commanded_rpm), ramp, self.orientation.max_rpm) * (1.0 + _OVERSPEED_FRACTION)
            + _OVERSPEED_RPM
        )

    @property
    def _grace_s(self) -> float:
        """Return for how many seconds after a command the measured speed may differ from it."""
        return max(_GRACE_S, self._lag() + _REACTION_TIME_S)

    _now = 0.0
    _radius = 0.0
