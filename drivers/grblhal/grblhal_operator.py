"""Feed holds, jogs and overrides of a grblHAL controller.

The controller can change its overrides only in steps. The steps start from the reported value, and the
result is verified. A jog is a motion lease: the controller never has more travel than the lease permits, so
the axis stops if the driver sends nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from core.message import Message
from core.ports import DriverError, FaultCode
from drivers.grblhal import grblhal_codes
from drivers.grblhal.grblhal_codes import format_jog
from drivers.grblhal.grblhal_controller import GrblController
from drivers.grblhal.grblhal_report import StatusReport
from drivers.grblhal.grblhal_transport import SentLine

_SEND_INTERVAL_S = 0.1  # Seconds between two corrections.
# Seconds without a report of the overrides, which at least every twentieth plain report contains.
_RESEND_DELAY_S = 2.5
_OVERRIDE_TIMEOUT_S = 7.0  # Seconds after which an override counts as rejected.
LEAST, MOST = 10, 200  # Range of the controller in percent.


def encode_override_steps(
    target_percent: int, reported_percent: int, step_codes: tuple[int, ...] = grblhal_codes.FEED
) -> bytes:
    """Return the bytes that change an override from ``reported_percent`` to ``target_percent``.

    The sequence starts with the reset to 100 % only if 100 % is between both values, because the reset is
    immediate and a slow axis would jump. The number of bytes never exceeds the queue of the controller.
    """
    reset, *moves = step_codes
    straight, over = (
        _encode_steps(reported_percent, target_percent, moves),
        bytes([reset]) + _encode_steps(100, target_percent, moves),
    )
    crosses = (target_percent - 100) * (reported_percent - 100) <= 0
    return over if crosses and len(over) < len(straight) else straight


def _encode_steps(reported_percent: int, percent: int, moves: list[int]) -> bytes:
    """Return the bytes of the coarse steps, followed by those of the fine steps.

    If a coarse step would exceed a limit, the fine steps come first.
    """
    up_10, down_10, up_1, down_1 = moves
    tens, ones = divmod(abs(percent - reported_percent), 10)
    tens, ones = (tens + 1, ones - 10) if ones > 5 else (tens, ones)
    sign = 1 if percent > reported_percent else -1
    coarse, fine, back = (up_10, up_1, down_1) if sign > 0 else (down_10, down_1, up_1)
    steps = [coarse] * tens, [fine if ones > 0 else back] * abs(ones)
    fits = LEAST <= reported_percent + sign * 10 * tens <= MOST
    return bytes([*steps[0], *steps[1]] if fits else [*steps[1], *steps[0]])


def round_rapid_override(fraction: float) -> int:
    """Return the controller's largest rapid override, in percent, that does not exceed ``fraction``.

    If ``fraction`` is below 0.25, the result is 25 %.
    """
    return 100 if fraction >= 1.0 else 50 if fraction >= 0.5 else 25


def convert_override_to_percent(fraction: float) -> int:
    """Convert a fraction into percent, limited to the override range of the controller."""
    return min(max(round(100 * fraction), LEAST), MOST)


class GrblOverrides:
    """Commanded overrides of the controller, compared with the overrides in its reports.

    If they differ, the driver sends override steps.
    """

    def __init__(self, write: Callable[[bytes], None], set_fault: Callable[[str, FaultCode], None]) -> None:
        self._write = write
        self._fail = set_fault
        self._asked = [100, 100, 100]
        self._sent_at, self._seen = -1.0, 0
        self._since: float | None = None  # Start of the time without a change toward the commanded values.
        self._last: tuple[int, ...] | None = None  # Last reported values.
        self.is_thread_active = False  # A thread is active and requires 100 %.

    @property
    def commanded_override_percents(self) -> list[int]:
        """Return the commanded feed, rapid and spindle overrides in percent."""
        return [100, self._asked[1], 100] if self.is_thread_active else self._asked

    def set_motion_overrides(self, feed_fraction: float, rapid_fraction: float) -> None:
        """Set the feed and rapid overrides as fractions above 0."""
        self._asked[:2] = convert_override_to_percent(feed_fraction), round_rapid_override(rapid_fraction)

    def set_spindle_override(self, percent: int) -> None:
        """Set the spindle override as a percentage of the last S word."""
        self._asked[2] = percent

    def are_overrides_confirmed(self, reported: tuple[int, ...] | None) -> bool:
        """Return whether the reported overrides are equal to the commanded overrides."""
        return reported is not None and list(reported[:3]) == self.commanded_override_percents

    def send_override_steps(self, reported: tuple[int, ...] | None, report_count: int, now: float) -> None:
        """Send override steps if the commanded and reported overrides differ.

        Steps are sent only after a report that is newer than the last steps, or again if no such report
        arrives. ``report_count`` is the number of reports with overrides.
        """
        if reported is None or self.are_overrides_confirmed(reported) or reported != self._last:
            self._since = None  # A spindle that follows the radius changes continuously.
        self._last = reported
        if reported is None or self.are_overrides_confirmed(reported):
            return
        fresh = report_count > self._seen and now - self._sent_at >= _SEND_INTERVAL_S
        if not fresh and now - self._sent_at < _RESEND_DELAY_S:
            return
        self._since = now if self._since is None else self._since
        if now - self._since > _OVERRIDE_TIMEOUT_S:
            self._fail(
                Message(
                    "the controller does not accept an override: {commanded} was commanded, but "
                    "{reported} is reported",
                    commanded=self.commanded_override_percents,
                    reported=list(reported),
                ),
                "controller-refuses",
            )
            return
        self._sent_at, self._seen = now, report_count
        self._write(self._steps(reported))

    def _steps(self, reported: tuple[int, ...]) -> bytes:
        feed, rapid, spindle = self.commanded_override_percents
        data = encode_override_steps(feed, reported[0])
        data += bytes([grblhal_codes.RAPID_OVERRIDES[rapid]]) if reported[1] != rapid else b""
        return data + (
            encode_override_steps(spindle, reported[2], grblhal_codes.SPINDLE) if len(reported) > 2 else b""
        )


# --- Feed holds by TurnDesk and at the controller, and their ends.


_MAX_STALE_REPORTS = 3  # Reports that may still show the state before a hold or before its end.


class FeedHoldControl:
    """Feed holds (byte 82h) and resumes (byte 81h), whose effects are tracked from report to report."""

    def __init__(self, controller: GrblController) -> None:
        self._c = controller
        self._asked = False  # A hold is requested.
        self._ours = False  # TurnDesk may end the present hold.
        # Report counts from which a hold counts again or must be sent again.
        self._released = self._again = 0

    @property
    def is_in_feed_hold(self) -> bool:
        """Return whether the controller is at rest in a feed hold."""
        c = self._c
        held = c.report is not None and c.report.state == "Hold" and not c.report.sub
        return held and c.report_count >= self._released and not c.is_script_running

    def start_feed_hold(self) -> None:
        """Start a feed hold immediately."""
        self._asked = self._ours = True
        self._released = 0
        self._say()

    def end_feed_hold(self) -> None:
        """End a feed hold as soon as the axes are at rest."""
        self._asked, self._ours = False, True
        self._send_resume()

    def clear_hold_request(self) -> None:
        """Cancel a requested feed hold, because the motion is being stopped completely."""
        self._asked = self._ours = False

    def process_report(self, report: StatusReport) -> None:
        """Update the state of the feed hold from a report."""
        if report.state == "Hold":
            self._send_resume()
        elif self._asked and report.state == "Run" and self._c.report_count >= self._again:
            self._say()  # A button at the controller has ended the hold.
        else:
            self._ours = self._ours and (self._asked or report.state in {"Run", "Jog"})

    # --- inside -------------------------------------------------------------------------------------------

    def _say(self) -> None:
        self._again = self._c.report_count + _MAX_STALE_REPORTS
        self._c.send_realtime_bytes(grblhal_codes.HOLD)
        self._c.request_report()

    def _send_resume(self) -> None:
        """Resume the motion if the axes are at rest and the operator has ended the hold.

        A hold that was started at the controller never ends automatically.
        """
        report = self._c.report
        if (
            self._ours
            and not self._asked
            and report is not None
            and report.state == "Hold"
            and not report.sub
        ):
            self._ours = False
            self._released = self._c.report_count + _MAX_STALE_REPORTS
            self._c.send_realtime_bytes(grblhal_codes.START)
            self._c.request_report()


# --- Jog with a motion lease.


_MIN_JOG_MM = 0.002  # Minimum travel in mm.
_MIN_RENEWAL_S = 0.02  # Seconds; a shorter renewal is not sent.


class GrblJogSender:
    """Sender of jog lines (``$J``), which waits for the acknowledgment of each line.

    The lease is the time for which a jog may continue without renewal. The target of a line is the position
    that the axis would reach one lease later at full speed since the start of the jog. The remaining travel
    is therefore at most lease · velocity plus the braking distance.
    """

    def __init__(self, controller: GrblController) -> None:
        self._c = controller
        self.is_active = False
        self._axis, self._velocity = "", 0.0
        self._from, self._since = 0.0, 0.0
        self._sent = 0.0  # Target of the last line.
        self._wanted = 0.0
        self._ask: SentLine | None = None

    def start_or_renew_jog(
        self, axis: str, velocity: float, lease_s: float, limits: tuple[float, float] | None
    ) -> bool:
        """Start or renew a jog, and return False if the axis is at the end of its travel."""
        now = self._c.clock.now()
        if not self.is_active or axis != self._axis or velocity != self._velocity:
            self._begin(axis, velocity, now)
        target = self._from + velocity * (now - self._since + lease_s)
        if limits is not None:
            target = min(max(target, limits[0]), limits[1])
        if (target - self._from) * math.copysign(1.0, velocity) < _MIN_JOG_MM:
            self.is_active = False
            return False
        self._wanted, self.is_active = target, True
        self.send_remaining_travel()
        return True

    def start_step_jog(self, axis: str, target: float, speed: float) -> None:
        """Jog an axis from rest to ``target``, and stop it there."""
        self._begin(axis, speed, self._c.clock.now())
        self._wanted, self.is_active = target, True
        self.send_remaining_travel()

    def send_remaining_travel(self) -> None:
        """Send the jog travel that was not sent yet, if the last line has been acknowledged."""
        if not self.is_active or (self._ask is not None and not self._ask.is_acknowledged):
            return
        added = abs(self._wanted - self._sent)
        if added < max(_MIN_JOG_MM, _MIN_RENEWAL_S * abs(self._velocity)) and self._ask is not None:
            return
        self._sent = self._wanted
        target = self._wanted + self._c.home_origin.get(self._axis, 0.0)
        self._ask = self._c.send_line(format_jog(self._axis, target, abs(self._velocity)))

    def handle_standstill(self) -> None:
        """End the jog after a report shows that the controller is at rest."""
        if self._ask is None or self._ask.is_acknowledged:
            self.clear_jog()

    def clear_jog(self) -> None:
        """Mark the jog as ended."""
        self.is_active, self._ask = False, None

    def _begin(self, axis: str, velocity: float, now: float) -> None:
        place = self._c.position.get(axis)
        if place is None:
            raise DriverError(
                "the controller does not have an axis {axis} to jog", "controller-refuses", axis=axis
            )
        if self.is_active:
            # With another speed or direction, continue from the end of the present travel.
            place = self._sent
        self._axis, self._velocity = axis, velocity
        self._from = self._sent = place
        self._since, self._ask = now, None
