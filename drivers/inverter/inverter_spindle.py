"""Spindle with an inverter, whose methods never wait for the serial line."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from core.message import Message
from core.ports import Clock, DriverError, Fault
from drivers.inverter.family_files import family_table
from drivers.inverter.family_table import FamilyTable
from drivers.inverter.huanyang_hy import HuanyangHy
from drivers.inverter.inverter_attendant import DEAD, PRESS, Agreement, Attendant
from drivers.inverter.inverter_family import Family
from drivers.inverter.inverter_table import InverterTable
from drivers.inverter.modbus_rtu import Modbus
from drivers.inverter.register_family import RegisterFamily
from drivers.port_parts import demand_estop_released, demand_spindle
from drivers.serial_line import Wire


class Encoder(Protocol):
    """Encoder that measures the spindle independently of the inverter."""

    def speed(self) -> float:
        """Return the measured speed in rpm, signed."""
        ...

    def angle(self) -> tuple[float, float] | None:
        """Return a (time, revolutions) pair, or None."""
        ...


class InverterSpindle:
    """``core.ports.Spindle`` of an inverter. Without an encoder, its speed is the inverter's output.

    ``alive`` returns whether the inverter is still monitored, and ``revive`` restarts the monitoring.
    ``estop`` returns whether the E-stop is pressed. ``lost`` returns the reason why the encoder is invalid,
    which is a fault while the spindle turns or must turn.
    """

    def __init__(
        self,
        config: InverterTable,
        attendant: Attendant,
        clock: Clock,
        *,
        encoder: Encoder | None = None,
        alive: Callable[[], bool] = lambda: True,
        revive: Callable[[], None] = lambda: None,
        estop: Callable[[], bool] = lambda: False,
        lost: Callable[[], str] = str,
    ) -> None:
        self._config, self._attendant, self._clock = config, attendant, clock
        self._encoder, self._alive, self._estop, self._lost = encoder, alive, estop, lost
        self._agreement = Agreement(config.disagree)
        self._revive = revive
        self._unmeasured = ""  # Reason for an invalid measurement, latched until ``clear_fault``.

    def run(self, rpm: float) -> None:
        """Turn the spindle at ``rpm``, signed; 0 stops it.

        Raises DriverError if the speed is not 0 in E-stop, with a fault, or before a stopped inverter has
        sent enough valid responses.
        """
        if rpm:
            demand_estop_released(self._estop())
            demand_spindle(self.fault() or self._lost())
            # A spindle that turns may change its speed, because a rejected surface speed would scrap the
            # part.
            if not (self._attendant.want or self._attendant.warm):
                raise DriverError(
                    "the spindle stays off until the inverter has sent the required number of "
                    "valid responses",
                    "spindle-off",
                    reason="not-ready",
                )
        limit = self._config.rpm_max
        self._attendant.want = min(max(rpm, -limit), limit) * self._config.hz_per_rpm

    def coast(self) -> None:
        """Stop by the inverter's ramp, because coasting is possible only by its STO input."""
        self._attendant.want = 0.0

    def clear_fault(self) -> None:
        """Clear the fault and reset a trip of the inverter, without turning the spindle."""
        if not self._alive():
            self._revive()
        self._attendant.clear()
        self._unmeasured = ""

    def speed(self) -> float:
        """Return the speed in rpm, signed, measured by the encoder or reported by the inverter.

        The inverter's value is used while the encoder is invalid. If both disagree, the higher value is
        returned.
        """
        if self._encoder is None or self._lost():
            return self.reported_rpm
        if self._unmeasured:
            return max(self._encoder.speed(), self.reported_rpm, key=abs)
        return self._encoder.speed()

    @property
    def reported_rpm(self) -> float:
        """The speed in rpm, signed, by the last poll of the inverter."""
        seen = self._attendant.seen
        return seen.look.signed / self._config.hz_per_rpm if seen else 0.0

    def lag(self) -> float:
        """Return the seconds by which the line delays a command and the speed that shows its effect."""
        return self._attendant.lag

    @property
    def load(self) -> float:
        """The output current in percent of the motor's rated current, or nan if unknown."""
        seen, rated = self._attendant.seen, self._config.rated
        if not rated or seen is None or self._attendant.unheard:
            return math.nan
        return 100.0 * seen.look.current / rated

    def angle(self) -> tuple[float, float] | None:
        """Return a (time, revolutions) pair of the encoder, or None without a valid encoder."""
        if self._encoder is None or self._unmeasured or self._lost():
            return None
        return self._encoder.angle()

    def fault(self) -> str:
        """Return the fault with the instruction for the operator, or an empty text.

        The method is called continuously, so an E-stop also cancels the commanded speed.
        """
        attendant = self._attendant
        if self._estop():
            attendant.want = 0.0
        if attendant.trouble:
            return attendant.trouble
        if self._encoder is not None and self._wrong(self._encoder):
            attendant.want = 0.0
            return self._unmeasured
        if not self._alive():
            return Fault("TurnDesk no longer monitors the inverter; {press}", "inverter-silent", press=PRESS)
        if attendant.silent_for > DEAD:
            return Fault(
                "no response from the inverter for {dead} s; {press}",
                "inverter-silent",
                dead=f"{DEAD:g}",
                press=PRESS,
            )
        return ""

    def _wrong(self, encoder: Encoder) -> bool:
        """Return whether the spindle turns or must turn without a valid measurement."""
        needed = self._attendant.want != 0.0 or self.reported_rpm != 0.0
        if needed and not self._unmeasured:
            now = self._clock.now()
            self._unmeasured = self._lost() or self._agreement.look(encoder.speed(), self.reported_rpm, now)
        return bool(self._unmeasured)

    @property
    def unknown(self) -> bool:
        """Whether it is unknown if the spindle turns, because encoder and inverter are both unavailable."""
        if self._encoder is not None and not (self._unmeasured or self._lost()):
            return False
        return not self._alive() or self._attendant.unheard

    def status(self) -> str:
        """Return one line about the state of the inverter for a check."""
        seen = self._attendant.seen
        if seen is None:
            return "no response yet"
        look = seen.look
        what = f"turns {'back' if look.reverse else 'forward'}" if look.output else "stands"
        return Message(
            "{what}, output {output} Hz, setpoint {setpoint} Hz, current {current} A",
            what=what,
            output=f"{look.output:.2f}",
            setpoint=f"{look.setpoint:.2f}",
            current=f"{look.current:.1f}",
        )


# --- Creation from a configuration.


def attendant(
    config: InverterTable, open_wire: Callable[[], Wire], clock: Clock, folder: Path = Path()
) -> Attendant:
    """Create the control of an inverter without opening its line; ``open_wire`` raises WireError.

    ``folder`` contains the file of a family that is not shipped. Raises DriverError if the family cannot be
    read or does not fit the machine.
    """
    table = family_table(config.family, folder)
    highest = config.rpm_max * config.hz_per_rpm
    _check_fits(table, config, highest)

    def opened() -> Family:
        return _family(table, config, open_wire(), clock)

    return Attendant(opened, clock, config.comm_loss, highest, table.step)


def _check_fits(table: FamilyTable, config: InverterTable, highest: float) -> None:
    """Raise DriverError if the inverter does not support the line settings or the maximum frequency in Hz."""
    slowest, fastest = table.line.baud
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
    if config.parity not in table.line.parity.split():
        raise DriverError(
            "spindle.vfd.parity = {parity}: {name} supports {known}; change parity here and at the keypad",
            reason="parity",
            parity=config.parity,
            name=table.name,
            known=table.line.parity,
        )
    if highest > table.max_hz:
        raise DriverError(
            "the maximum spindle speed needs {highest} Hz, but {name} has {limit} Hz at most; reduce "
            "spindle.rpm or check hz_per_rpm",
            reason="max-hz",
            highest=f"{highest:g}",
            name=table.name,
            limit=f"{table.max_hz:g}",
        )


def _family(table: FamilyTable, config: InverterTable, wire: Wire, clock: Clock) -> Family:
    """Create the inverter on an open line."""
    if table.registers is None:
        return HuanyangHy(table, wire, clock, config.unit, config.line.character)
    line = Modbus(wire, clock, config.unit, config.line.character)
    return RegisterFamily(table, table.registers, line, clock)
