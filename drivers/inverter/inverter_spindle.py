"""The spindle port of an inverter, with methods that never wait for the serial line."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from core.message import Message
from core.ports import Clock, DriverError, Fault
from drivers.inverter.command_monitor import PRESS_ESTOP_TEXT, SpeedComparator
from drivers.inverter.family_files import load_inverter_family
from drivers.inverter.family_table import FamilyTable
from drivers.inverter.huanyang_hy import HuanyangInverter
from drivers.inverter.inverter_control import MAX_SILENCE_S, InverterControl
from drivers.inverter.inverter_family import InverterFamily
from drivers.inverter.inverter_table import InverterTable
from drivers.inverter.modbus_rtu import ModbusMaster
from drivers.inverter.register_family import RegisterInverter
from drivers.port_checks import require_estop_released, require_spindle_ready
from drivers.serial_line import SerialTransport


class SpindleEncoder(Protocol):
    """An encoder that measures the spindle independently of the inverter."""

    def speed(self) -> float:
        """Return the measured speed in rpm, with its sign."""
        ...

    def read_angle(self) -> tuple[float, float] | None:
        """Return the time and the revolutions of the encoder, or None if no reading is valid."""
        ...


class InverterSpindle:
    """Spindle port (``core.ports.Spindle``) of an inverter.

    Without an encoder, its speed is the inverter's output. The functions that it receives are:

    - ``is_thread_alive`` returns whether the inverter is still monitored.
    - ``restart_thread`` restarts the monitoring.
    - ``is_estop_pressed`` returns whether the E-stop is pressed.
    - ``get_encoder_fault`` returns why the encoder is invalid, which is a fault while the spindle turns
      or must turn.
    """

    def __init__(
        self,
        config: InverterTable,
        control: InverterControl,
        clock: Clock,
        *,
        encoder: SpindleEncoder | None = None,
        is_thread_alive: Callable[[], bool] = lambda: True,
        restart_thread: Callable[[], None] = lambda: None,
        is_estop_pressed: Callable[[], bool] = lambda: False,
        get_encoder_fault: Callable[[], str] = str,
    ) -> None:
        self._config, self._attendant, self._clock = config, control, clock
        self._encoder, self._alive, self._estop, self._lost = (
            encoder,
            is_thread_alive,
            is_estop_pressed,
            get_encoder_fault,
        )
        self._agreement = SpeedComparator(config.disagree)
        self._revive = restart_thread
        self._unmeasured = ""  # Reason for an invalid measurement, latched until ``clear_fault``.

    def set_speed(self, rpm: float) -> None:
        """Run the spindle at the signed speed ``rpm``; 0 stops it.

        For a speed other than 0, raises DriverError if the E-stop is pressed or a fault is active. Also
        raises DriverError if the inverter is stopped and has not sent enough valid responses yet.
        """
        if rpm:
            require_estop_released(self._estop())
            require_spindle_ready(self.read_fault() or self._lost())
            # A spindle that turns may change its speed, because a rejected surface speed would scrap the
            # part.
            if not (self._attendant.commanded_hz or self._attendant.is_inverter_trusted):
                raise DriverError(
                    "the spindle stays off until the inverter has sent the required number of "
                    "valid responses",
                    "spindle-off",
                    reason="not-ready",
                )
        limit = self._config.rpm_max
        self._attendant.commanded_hz = min(max(rpm, -limit), limit) * self._config.hz_per_rpm

    def start_coasting(self) -> None:
        """Stop the spindle by the inverter's ramp.

        Coasting is possible only through the STO input of the inverter.
        """
        self._attendant.commanded_hz = 0.0

    def clear_fault(self) -> None:
        """Clear the fault and reset a trip of the inverter, without turning the spindle."""
        if not self._alive():
            self._revive()
        self._attendant.clear_fault()
        self._unmeasured = ""

    def speed(self) -> float:
        """Return the speed in rpm, with its sign, as measured by the encoder or reported by the inverter.

        The inverter's value is used while the encoder is invalid. If the values disagree, the higher value
        is returned.
        """
        if self._encoder is None or self._lost():
            return self.reported_rpm
        if self._unmeasured:
            return max(self._encoder.speed(), self.reported_rpm, key=abs)
        return self._encoder.speed()

    @property
    def reported_rpm(self) -> float:
        """Return the speed in rpm, with its sign, according to the last poll of the inverter."""
        seen = self._attendant.last_poll
        return seen.inverter_state.signed_output_hz / self._config.hz_per_rpm if seen else 0.0

    def get_line_delay(self) -> float:
        """Return the delay in seconds from a command to the reported speed that shows its effect.

        This delay is caused by the serial line.
        """
        return self._attendant.line_delay_s

    @property
    def load_percent(self) -> float:
        """Return the output current in percent of the motor's rated current, or NaN if it is unknown."""
        seen, rated = self._attendant.last_poll, self._config.rated_current_a
        if not rated or seen is None or self._attendant.is_state_unknown:
            return math.nan
        return 100.0 * seen.inverter_state.current_a / rated

    def read_angle(self) -> tuple[float, float] | None:
        """Return the time and the revolutions of the encoder, or None without a valid encoder."""
        if self._encoder is None or self._unmeasured or self._lost():
            return None
        return self._encoder.read_angle()

    def read_fault(self) -> str:
        """Return the fault and the instruction for the operator, or an empty string if there is no fault.

        This method is called continuously, so it also cancels the commanded speed when the E-stop is
        pressed.
        """
        attendant = self._attendant
        if self._estop():
            attendant.commanded_hz = 0.0
        if attendant.failure:
            return attendant.failure
        if self._encoder is not None and self._is_encoder_wrong(self._encoder):
            attendant.commanded_hz = 0.0
            return self._unmeasured
        if not self._alive():
            return Fault(
                "TurnDesk no longer monitors the inverter; {press}", "inverter-silent", press=PRESS_ESTOP_TEXT
            )
        if attendant.silence_s > MAX_SILENCE_S:
            return Fault(
                "no response from the inverter for {dead} s; {press}",
                "inverter-silent",
                dead=f"{MAX_SILENCE_S:g}",
                press=PRESS_ESTOP_TEXT,
            )
        return ""

    def _is_encoder_wrong(self, encoder: SpindleEncoder) -> bool:
        """Return whether the encoder has been invalid since the last reset.

        It is checked only while the spindle turns or must turn.
        """
        needed = self._attendant.commanded_hz != 0.0 or self.reported_rpm != 0.0
        if needed and not self._unmeasured:
            now = self._clock.now()
            self._unmeasured = self._lost() or self._agreement.compare_speeds(
                encoder.speed(), self.reported_rpm, now
            )
        return bool(self._unmeasured)

    @property
    def is_state_unknown(self) -> bool:
        """Return whether the rotation of the spindle is unknown.

        This is the case if the encoder and the inverter are both unavailable.
        """
        if self._encoder is not None and not (self._unmeasured or self._lost()):
            return False
        return not self._alive() or self._attendant.is_state_unknown

    def describe_status(self) -> str:
        """Return the state of the inverter as one line of text, for a check of the inverter."""
        seen = self._attendant.last_poll
        if seen is None:
            return "no response yet"
        look = seen.inverter_state
        what = f"turns {'back' if look.is_reverse_direction else 'forward'}" if look.output_hz else "stands"
        return Message(
            "{what}, output {output} Hz, setpoint {setpoint} Hz, current {current} A",
            what=what,
            output=f"{look.output_hz:.2f}",
            setpoint=f"{look.setpoint_hz:.2f}",
            current=f"{look.current_a:.1f}",
        )


# --- Creation from a configuration.


def create_inverter_control(
    config: InverterTable,
    open_wire: Callable[[], SerialTransport],
    clock: Clock,
    family_folder: Path = Path(),
) -> InverterControl:
    """Create the control of an inverter without opening its line.

    ``open_wire`` opens the line, or raises SerialLineError if this fails. ``family_folder`` contains the
    file of a family that is not shipped with TurnDesk. Raises DriverError if the family cannot be read or
    does not fit the machine.
    """
    table = load_inverter_family(config.family, family_folder)
    highest = config.rpm_max * config.hz_per_rpm
    _check_limits(table, config, highest)

    def open_inverter() -> InverterFamily:
        return _create_family(table, config, open_wire(), clock)

    return InverterControl(
        open_inverter, clock, config.communication_timeout_s, highest, table.setpoint_step_hz
    )


def _check_limits(table: FamilyTable, config: InverterTable, max_hz: float) -> None:
    """Raise DriverError if the inverter does not support the line settings or the maximum frequency in Hz."""
    slowest, fastest = table.serial_line.baud
    if not slowest <= config.baud <= fastest:
        raise DriverError(
            "spindle.vfd.baud = {baud}: {name} supports {slowest} to {fastest}; change baud here and at "
            "the keypad",
            reason="baud",
            baud=config.baud,
            name=table.name,
            slowest=f"{slowest:g}",
            fastest=f"{fastest:g}",
        )
    if config.parity not in table.serial_line.parity.split():
        raise DriverError(
            "spindle.vfd.parity = {parity}: {name} supports {known}; change parity here and at the keypad",
            reason="parity",
            parity=config.parity,
            name=table.name,
            known=table.serial_line.parity,
        )
    if max_hz > table.max_hz:
        raise DriverError(
            "the maximum spindle speed needs {highest} Hz, but {name} has {limit} Hz at most; reduce "
            "spindle.rpm or check hz_per_rpm",
            reason="max-hz",
            highest=f"{max_hz:g}",
            name=table.name,
            limit=f"{table.max_hz:g}",
        )


def _create_family(
    table: FamilyTable, config: InverterTable, wire: SerialTransport, clock: Clock
) -> InverterFamily:
    """Create the inverter of the given family on an open line."""
    if table.register_table is None:
        return HuanyangInverter(table, wire, clock, config.unit, config.line_settings.character_time_s)
    line = ModbusMaster(wire, clock, config.unit, config.line_settings.character_time_s)
    return RegisterInverter(table, table.register_table, line, clock)
