"""Hitachi WJ200. Addresses on the line are the manual's numbers less one.

Its "frequency reached" is true in the wrong direction too, so nobody here asks for it. After a reset it
needs a second before it answers again.
"""

from __future__ import annotations

from collections.abc import Iterator

from core.message import Message
from core.ports import Clock
from drivers.inverter.inverter_family import Look, OnModbus, Setting, Top, number
from drivers.inverter.modbus_rtu import Modbus

_RUN, _DIRECTION, _RESET = 0x0000, 0x0001, 0x0003  # coils 1, 2 and 4
_STATUS = 0x000E  # coils 000F…0018: running, direction, ready, … alarm
_FREQUENCY = 0x0000  # registers 1 and 2: high and low word
_OUTPUT = 0x1000  # d001: two words, then the current d002
_TRIP = 0x0011  # register 0012: the factor of the trip, d081
_TOP = Top(0x1203, 10, "A004")
_AFTER_RESET = 1.0
_SOURCES = (
    Setting(0x1200, 3, "A001", "frequency command from Modbus"),
    Setting(0x1201, 3, "A002", "run and stop commands from Modbus"),
)


class HitachiWj200(OnModbus):
    """Coils for run and direction, one register for the frequency."""

    name = "Hitachi WJ200"

    def __init__(self, line: Modbus, clock: Clock) -> None:
        super().__init__(line)
        self._clock = clock

    def prepare(self, comm_loss: float, highest: float) -> list[str]:
        """C076 = 4: it ramps down when nothing has come for C077."""
        watch = (
            Setting(0x113C, 4, "C076", "ramp to stop when communication is lost"),
            Setting(
                0x113D,
                round(comm_loss * 100.0),
                "C077",
                Message("communication timeout of {comm_loss} s", comm_loss=f"{comm_loss:g}"),
            ),
        )
        return self._prepared(watch, _SOURCES, _TOP, highest)

    def stop(self) -> None:
        """By its ramp."""
        self._line.write_coil(_RUN, False)

    def command(self, hz: float) -> None:
        """Frequency and direction first."""
        self._line.write_registers(_FREQUENCY, (0, number(hz)))
        for address, on in ((_DIRECTION, hz < 0.0), (_RUN, True)):
            if self.hurry():
                return
            self._line.write_coil(address, on)

    def looks(self) -> Iterator[Look | None]:
        """Coils of command and state, setpoint, output."""
        line = self._line
        run, asked_reverse = line.coils(_RUN, 2)
        yield None
        state = line.coils(_STATUS, 10)
        yield None
        _high, setpoint = line.registers(_FREQUENCY, 2)
        yield None
        high, low, current = line.registers(_OUTPUT, 3)
        yield None
        yield Look(
            output=(high << 16 | low) / 100.0,
            setpoint=setpoint / 100.0,
            run=run,
            reverse=state[1],
            asked_reverse=asked_reverse,
            trip=self._trip() if state[9] else "",
            current=current / 100.0,
        )

    def _trip(self) -> str:
        (factor,) = self._line.registers(_TRIP)
        return Message("error code E{factor} on the inverter keypad", factor=f"{factor:02d}")

    def reset(self) -> None:
        """It is deaf for a second."""
        self._line.write_coil(_RESET, True)
        self._clock.sleep_until(self._clock.now() + _AFTER_RESET)
