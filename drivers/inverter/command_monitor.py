"""Monitoring of an inverter: detection of ignored commands, and comparison with the encoder."""

from __future__ import annotations

from core.message import Message
from core.ports import Fault
from drivers.inverter.inverter_family import InverterState

RESPONSE_TIME_S = 1.0  # s
_ROUNDING = 0.001  # Additional tolerance in Hz for rounding of the setpoint.
STANDSTILL_HZ = 0.5  # Hz
_SPEED_DROP_FRACTION = 0.005  # Fraction of the speed by which it must fall at least once per second.
PRESS_ESTOP_TEXT = "PRESS E-STOP"


def append_estop_instruction(reason: str) -> str:
    """Return the fault text with the request to press the E-stop appended."""
    return Message("{why}: {press}", why=reason, press=PRESS_ESTOP_TEXT)


class InverterCommandMonitor:
    """Monitor that checks whether an inverter follows its commands.

    ``record_command`` records a command, and ``check_polled_state`` checks a polled state. On a slow line,
    polled values are outdated by up to the duration of the exchange. The one second in which the inverter
    must react therefore starts after the exchange, and a decreasing speed is compared with the first poll
    after the command. ``setpoint_step_hz`` is the resolution of the reported setpoint in Hz.
    """

    def __init__(self, setpoint_step_hz: float = 0.01) -> None:
        self._within = setpoint_step_hz + _ROUNDING
        self._since: float | None = None  # Time since which the inverter does not obey; None: it obeys.
        self._lowest: float = 0.0  # Lowest output in Hz while the speed falls.
        self._unseen = False  # No poll has been completed since the command.
        self._asked = 0.0

    def record_command(self, time_s: float, commanded_hz: float, last_state: InverterState | None) -> None:
        """Record a command in Hz, with its sign.

        A new setpoint in the same direction does not restart the time limit.
        """
        if commanded_hz == self._asked:
            return
        if last_state is not None and (
            commanded_hz == 0.0 or commanded_hz * self._asked < 0.0 or abs(commanded_hz) < abs(self._asked)
        ):
            self._lowest = last_state.output_hz
            self._unseen = True
        self._asked = commanded_hz
        if self._since is None:
            self._since = time_s

    def check_polled_state(self, time_s: float, state: InverterState, exchange_s: float = 0.0) -> str:
        """Return a fault text if the inverter has not followed its command in time, else an empty string.

        The permitted time is one second plus ``exchange_s``, the duration of one exchange in seconds.
        """
        if self._unseen:  # The motor may still have accelerated when the command was sent.
            self._lowest, self._unseen = max(self._lowest, state.output_hz), False
        wrong = self._wrong(state)
        if self._is_decelerating(state):
            self._lowest = state.output_hz
        if not wrong:
            self._since = None
            return ""
        if self._since is None:
            self._since = time_s
        return wrong if time_s - self._since > RESPONSE_TIME_S + exchange_s else ""

    def _wrong(self, look: InverterState) -> str:
        why = (
            self._standing(look)
            if self._asked == 0.0
            else self._describe_setpoint_error(look) or self._describe_rotation_error(look)
        )
        return append_estop_instruction(why) if why else ""

    def _standing(self, look: InverterState) -> str:
        if look.output_hz > STANDSTILL_HZ and (look.is_running or not self._is_decelerating(look)):
            return Message(
                "a stop was commanded, but the inverter still outputs {output} Hz",
                output=f"{look.output_hz:.1f}",
            )
        return (
            "a stop was commanded, but the inverter still reports that it is running"
            if look.is_running
            else ""
        )

    def _describe_setpoint_error(self, state: InverterState) -> str:
        """Return a description of a setpoint, run state or direction that differs from the command.

        The compared values are those that the inverter reports.
        """
        asked = abs(self._asked)
        if abs(state.setpoint_hz - asked) > self._within:
            return Message(
                "{requested} Hz was commanded, but the inverter reports a setpoint of {setpoint} Hz",
                requested=f"{asked:.2f}",
                setpoint=f"{state.setpoint_hz:.2f}",
            )
        if not state.is_running:
            return Message(
                "{requested} Hz was commanded, but the inverter is not running", requested=f"{asked:.1f}"
            )
        return (
            ""
            if state.is_reverse_commanded == (self._asked < 0.0)
            else ("the inverter reports a command for the opposite direction")
        )

    def _describe_rotation_error(self, state: InverterState) -> str:
        """Return a description of a wrong output speed or direction, or an empty string.

        The speed must decrease toward a lower setpoint or before a reversal.
        """
        back = state.is_reverse_direction != (self._asked < 0.0) and state.output_hz > STANDSTILL_HZ
        if back and not self._is_decelerating(state):
            return "the inverter runs in the direction opposite to its command"
        if (
            not back
            and state.output_hz > abs(self._asked) + STANDSTILL_HZ
            and not self._is_decelerating(state)
        ):
            return Message(
                "{requested} Hz was commanded, but the inverter outputs {output} Hz",
                requested=f"{abs(self._asked):.1f}",
                output=f"{state.output_hz:.1f}",
            )
        return ""

    def _is_decelerating(self, state: InverterState) -> bool:
        """Return whether the output is more than a ripple below its lowest value since the command."""
        return state.output_hz < self._lowest * (1.0 - _SPEED_DROP_FRACTION)


# --- Comparison of encoder and inverter, to detect open couplings, slipping belts and wrong counts. The value
# of the inverter is delayed by one exchange, so it is compared only while it is constant.


_EVEN_RPM, _EVEN = 10.0, 0.01  # A smaller change of the output is ignored.
_SETTLING_TIME_S = 0.5  # Seconds of constant output before the comparison.
_DEVIATION_TIME_S = 1.0  # Seconds for which both must differ.
_SLACK_RPM = 30.0  # rpm


class SpeedComparator:
    """Comparator of the spindle speeds that the encoder and the inverter report.

    ``max_difference`` is the permitted relative difference.
    """

    def __init__(self, max_difference: float) -> None:
        self._fraction = max_difference
        self._given = 0.0
        self._even_since = 0.0
        self._off_since: float | None = None

    def compare_speeds(self, measured_rpm: float, reported_rpm: float, time_s: float) -> str:
        """Return a fault text if the speeds have differed for 1 s, or an empty string.

        Both speeds are in rpm, with their signs. They are compared only at a constant inverter output other
        than 0.
        """
        if abs(reported_rpm - self._given) > _EVEN_RPM + _EVEN * abs(reported_rpm):
            self._given, self._even_since = reported_rpm, time_s
        off = abs(measured_rpm - reported_rpm) > _SLACK_RPM + self._fraction * abs(reported_rpm)
        if reported_rpm == 0.0 or not off or time_s - self._even_since < _SETTLING_TIME_S:
            self._off_since = None
            return ""
        self._off_since = time_s if self._off_since is None else self._off_since
        if time_s - self._off_since < _DEVIATION_TIME_S:
            return ""
        return Fault(
            "the encoder measures {measured} rpm, but the inverter output corresponds to {given} "
            "rpm; check the coupling, the belt and counts_per_rev; {press}",
            "spindle-disagrees",
            measured=f"{measured_rpm:.0f}",
            given=f"{reported_rpm:.0f}",
            press=PRESS_ESTOP_TEXT,
        )
