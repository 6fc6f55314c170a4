"""Spindle of a grblHAL controller, commanded by M codes at standstill and by override steps during motion.

In a feed hold, a toggle byte stops and restarts the spindle.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from core.ports import DriverError
from drivers.grblhal import grblhal_codes
from drivers.grblhal.grblhal_blocks import GrblBlocks
from drivers.grblhal.grblhal_codes import number
from drivers.grblhal.grblhal_controller import GrblController
from drivers.grblhal.grblhal_operator import LEAST, MOST
from drivers.grblhal.grblhal_transport import SentLine
from drivers.port_checks import require_spindle_ready

_OBEY_TIME_S = 1.0  # Seconds until a spindle stopped in a hold must be reported as off.
_CLIPPING_TIME_S = 2.0  # Seconds in which report, override and S word may be from different times.
_MAX_SPEED_SETTING = 30  # Number of the setting.
_OVER, _UNDER = MOST / 100.0, LEAST / 100.0  # Range of the override as fractions of the S word.
# Seconds without a reply to M3 or M4, after which the controller is assumed to wait for the speed.
_WAIT_DETECTION_S = 0.3
_STANDSTILL_RPM = 30.0  # Rpm, between two reports of a spindle that reverses.


class GrblEncoder:
    """Encoder connected to the controller, for a spindle that another device drives.

    The encoder does not report the direction of rotation.
    """

    def __init__(self, controller: GrblController) -> None:
        self._c = controller
        # Signed rpm reported by the device that turns the spindle.
        self.get_reported_rpm: Callable[[], float] = lambda: 0.0
        self._sign = 1.0

    @property
    def has_measured_speed(self) -> bool:
        """Return whether the controller reports a measured speed."""
        return self._c.report is not None and self._c.report.measured is not None

    def speed(self) -> float:
        """Return the measured speed in rpm, with the sign of the speed that the spindle drive reports.

        If the drive reports a speed of 0, for example while the spindle coasts, the previous sign remains
        valid. While the controller is silent, the speed that the drive reports is returned.
        """
        reported_rpm, report = self.get_reported_rpm(), self._c.report
        if self._c.is_silent:
            return reported_rpm
        self._sign = math.copysign(1.0, reported_rpm) if reported_rpm else self._sign
        return self._sign * abs(report.measured or 0.0) if report is not None else 0.0

    def read_angle(self) -> tuple[float, float] | None:
        """Return None, because the controller does not report the angle."""
        return None


class _SpeedSign:
    """Sign for a measured speed whose direction is not measured.

    The sign changes only at standstill, or when the speed rises again after it has fallen.
    """

    def __init__(self) -> None:
        self._sign, self._least = 1.0, math.inf

    def apply_sign(self, rpm: float, commanded_rpm: float) -> float:
        """Return ``rpm`` with the current sign, which follows the sign of ``commanded_rpm`` with a delay."""
        rpm = abs(rpm)
        if math.copysign(1.0, commanded_rpm) == self._sign:
            self._least = math.inf
            return self._sign * rpm
        self._least = min(self._least, rpm)
        if rpm < _STANDSTILL_RPM or rpm > 1.05 * self._least + _STANDSTILL_RPM:
            self._sign, self._least = -self._sign, math.inf
        return self._sign * rpm


class GrblSpindle:
    """``core.ports.Spindle`` of the controller.

    At standstill, M3, M4 and M5 are sent; otherwise the override of the last S word is changed.
    """

    def __init__(self, controller: GrblController, blocks: GrblBlocks) -> None:
        self._c = controller
        self._blocks = blocks
        self._wanted = 0.0
        self._said = 0.0  # Speed of the last M3 or M4, signed.
        self._runs = False  # The spindle is on in the controller until a stop or a reset.
        self._way = _SpeedSign()
        self._paused_at: float | None = None  # Stopped in a feed hold, in which lines are not read.
        self._word: SentLine | None = None  # Last M3 or M4.
        self._unlike_since: float | None = None  # Start of a difference between reported and expected speed.

    def set_speed(self, rpm: float) -> None:
        """Turn the spindle at the signed speed ``rpm``, or stop the spindle if ``rpm`` is 0.

        The speed is limited to the maximum of the machine. A stop raises no error. Any other speed raises
        DriverError if the controller does not accept lines, or if its own speed limit is lower: the
        controller would reduce the speed without a message.
        """
        if rpm:
            require_spindle_ready(self._blocks.get_start_refusal_reason())
        rpm = math.copysign(min(abs(rpm), self._c.config.max_rpm), rpm)
        highest = self.controller_max_rpm
        if highest and abs(rpm) > 1.001 * highest:
            raise DriverError(
                "spindle: the controller allows {highest} rpm ($30), not {rpm} rpm",
                "spindle-off",
                highest=f"{highest:g}",
                rpm=f"{abs(rpm):.0f}",
            )
        self._wanted = rpm
        self.send_spindle_commands()

    def start_coasting(self) -> None:
        """Stop the spindle with M5, because the controller has no other stop."""
        self.set_speed(0.0)

    @property
    def controller_max_rpm(self) -> float:
        """Return the speed limit of the controller in rpm, or 0 if it is not reported.

        The controller reduces higher speeds to this limit.
        """
        return float(self._c.settings.get(_MAX_SPEED_SETTING, "0"))

    def speed(self) -> float:
        """Return the measured speed in rpm, signed; without an encoder, return the commanded speed."""
        report = self._c.report
        if report is None or report.speeds is None or len(report.speeds) < 2:
            return 0.0
        if report.measured is None:
            return math.copysign(report.speeds[1], self._said)
        return self._way.apply_sign(report.measured, self._said)

    def read_angle(self) -> tuple[float, float] | None:
        """Return None, because the controller does not report the angle."""
        return None

    def read_fault(self) -> str:
        """Return an empty string, because the axes report all alarms of the controller."""
        return ""

    def handle_reset(self) -> None:
        """Record that a stop or reset has switched the spindle off until the program starts it again."""
        self._wanted, self._runs, self._paused_at, self._word = 0.0, False, None, None

    def send_spindle_commands(self) -> None:
        """Send the commands that bring the spindle to the requested speed."""
        c = self._c
        self.speed()  # Evaluate each report; otherwise a reversal could be missed.
        if not c.is_ready:
            return
        if c.state_name == "Hold":
            self._handle_hold()
        elif self._paused_at is not None:
            self._restore_after_hold()
        elif self._wanted == 0.0:
            self._stop()
        elif (
            self._blocks.is_at_standstill
            and self._blocks.can_accept_lines
            and (not self._runs or self._base_rpm != self._said)
        ):
            self._start()
        elif self._runs and not (self._blocks.is_at_standstill and not self._blocks.max_css_rpm):
            self._follow_by_override(self._said)
        self._check_clipping()
        if c.config.has_own_spindle:
            laid = self._blocks.max_css_rpm and self._runs and self._base_rpm == self._said
            self._blocks.css_max_rpm = _OVER * abs(self._said) if laid else 0.0

    # --- inside -------------------------------------------------------------------------------------------

    @property
    def _base_rpm(self) -> float:
        """Return the speed for the S word in rpm, signed.

        For constant surface speed, the base is half of the highest speed, because the override range is 10
        to 200 %. If the override is reset to 100 %, for example by a pendant, the speed then never exceeds
        the programmed limit.
        """
        highest, wanted = self._blocks.max_css_rpm, abs(self._wanted)
        if not highest:
            return self._wanted
        said = abs(self._said)
        fits = highest <= 1.001 * _OVER * said and said <= 1.001 * highest and _UNDER * said <= 1.001 * wanted
        if self._runs and self._wanted * self._said > 0.0 and fits:
            return self._said
        return math.copysign(max(min(highest / _OVER, wanted / _UNDER), wanted / _OVER), self._wanted)

    def _start(self) -> None:
        """Send M3 or M4.

        For constant surface speed, the command is sent only after the override is reported.
        """
        base = self._base_rpm
        if self._blocks.max_css_rpm:
            self._follow_by_override(base)
            if not self._blocks.overrides.are_overrides_confirmed(self._c.overrides):
                return
        else:
            self._blocks.overrides.set_spindle_override(100)
        self._runs, self._said = True, base
        self._word = self._c.send_line(f"M{3 if base > 0.0 else 4}S{number(abs(base))}")

    def _check_clipping(self) -> None:
        """Set a fault if the controller limits the speed without a message.

        A change of setting $30 may take effect only after the controller restarts. The commanded speed in
        the reports is the speed after limiting.
        """
        c = self._c
        now, reported_speeds = c.clock.now(), c.report.speeds if c.report is not None else None
        share = c.overrides[2] / 100.0 if c.overrides is not None and len(c.overrides) > 2 else None
        said = self._runs and self._word is not None and self._word.is_acknowledged and c.state_name != "Hold"
        if not said or reported_speeds is None or share is None or len(reported_speeds) < 2:
            self._unlike_since = None
            return
        expected = abs(self._said) * share
        if abs(reported_speeds[1] - expected) <= 0.02 * expected + 2.0:
            self._unlike_since = None
        elif self._unlike_since is None:
            self._unlike_since = now
        elif now - self._unlike_since > _CLIPPING_TIME_S:
            c.set_fault(
                "the controller runs the spindle at {details} rpm instead of {expected} rpm "
                "because the controller limits the speed ($30, $31; a changed setting may take "
                "effect only after the controller restarts)",
                "controller-refuses",
                details=f"{reported_speeds[1]:g}",
                expected=f"{expected:.0f}",
            )

    def _follow_by_override(self, base: float) -> None:
        """Set the spindle override that results in the requested speed if the S word is ``base``."""
        if self._wanted * base > 0.0:
            share = round(100.0 * self._wanted / base)
            self._blocks.overrides.set_spindle_override(min(max(share, LEAST), MOST))

    def _stop(self) -> None:
        if not self._runs or self._abort_start_wait():
            return
        if self._blocks.can_accept_lines:
            self._runs = False
            self._c.send_line("M5")
        else:
            self._blocks.stop_jog()  # A line would be rejected; M5 follows when the axes rest.

    def _abort_start_wait(self) -> bool:
        """Return whether M3 or M4 has not been acknowledged yet, and abort the wait if it is too long.

        While the firmware waits for the spindle speed, it does not read M5 and ignores the spindle toggle.
        Only an abort with a reset can then stop the spindle.
        """
        word = self._word
        if word is None or word.is_acknowledged:
            return False
        if self._c.listened_s - word.sent_time_s > _WAIT_DETECTION_S:
            self._blocks.abort_blocks()
        return True

    def _handle_hold(self) -> None:
        """Stop or restart the spindle in a feed hold with one toggle byte, and verify the result."""
        stops = self._runs and self._wanted == 0.0
        if self._paused_at is None and stops and self._abort_start_wait():
            return
        if self._paused_at is None and stops:
            self._paused_at = self._c.clock.now()
            self._c.send_realtime_bytes(grblhal_codes.SPINDLE_PAUSE_BYTE)
        elif self._paused_at is not None and self._runs and self._wanted * self._said > 0.0:
            self._paused_at = None
            self._c.send_realtime_bytes(grblhal_codes.SPINDLE_PAUSE_BYTE)
        elif (
            self._paused_at is not None
            and self._c.clock.now() - self._paused_at > _OBEY_TIME_S
            and self._turns()
        ):
            self._c.set_fault(
                "the controller does not stop its spindle in feed hold: PRESS E-STOP", "ignores-stop"
            )

    def _restore_after_hold(self) -> None:
        """Send M5 after a feed hold, because the controller may have restarted the spindle."""
        self._paused_at, self._runs = None, False
        self._c.send_line("M5")

    def _turns(self) -> bool:
        report = self._c.report
        return report is not None and report.speeds is not None and report.speeds[1:2] > (0.0,)
