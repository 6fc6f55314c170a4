"""Delta VFD-B. Registers after the manual of July 2008, page 5-83 on, and LinuxCNC's experience with it.

It wants each register asked alone, and a reset said once: said again it restarts again.
"""

from __future__ import annotations

from collections.abc import Iterator

from core.message import Message
from drivers.inverter.inverter_family import Look, OnModbus, Setting, Top, number
from drivers.inverter.modbus_rtu import Modbus

_COMMAND, _FREQUENCY = 0x2000, 0x2001
_STOP, _RUN, _FORWARD, _REVERSE, _RESET = 0x0001, 0x0002, 0x0010, 0x0020, 0x2000
_ERROR, _STATUS, _SETPOINT, _OUTPUT, _CURRENT = 0x2100, 0x2101, 0x2102, 0x2103, 0x2104
_TOP = Top(0x0100, 100, "Pr.01-00")
_SOURCES = (
    Setting(0x0200, 5, "Pr.02-00", "frequency command from RS-485"),
    Setting(0x0201, 3, "Pr.02-01", "run and stop commands from RS-485, with the keypad STOP key enabled"),
)
_TRIPS = {
    1: "over-current",
    2: "over-voltage",
    3: "overheating",
    4: "inverter overload",
    5: "motor overload",
    6: "external fault",
    33: "emergency stop",
}


class DeltaVfdB(OnModbus):
    """Status word: bits 0 and 1 say stopped, stopping, standing by, running; bits 3 and 4 the direction:
    forward, back to forward, on to reverse, reverse."""

    name = "Delta VFD-B"

    def __init__(self, line: Modbus) -> None:
        super().__init__(line)
        self._said = 0

    def prepare(self, comm_loss: float, highest: float) -> list[str]:
        """09-02 = 1: it ramps down when nothing has come for 09-03."""
        self._said = 0
        watch = (
            Setting(0x0902, 1, "Pr.09-02", "ramp to stop when communication is lost"),
            Setting(
                0x0903,
                round(comm_loss * 10.0),
                "Pr.09-03",
                Message("communication timeout of {comm_loss} s", comm_loss=f"{comm_loss:g}"),
            ),
        )
        return self._prepared(watch, _SOURCES, _TOP, highest)

    def stop(self) -> None:
        """By its ramp, 02-02 = 0."""
        self._said = 0
        self._line.write_register(_COMMAND, _STOP)

    def command(self, hz: float) -> None:
        """The frequency first, so that it never starts at an old one."""
        self._line.write_register(_FREQUENCY, number(hz))
        word = _RUN | (_REVERSE if hz < 0.0 else _FORWARD)
        if word != self._said and not self.hurry():
            self._line.write_register(_COMMAND, word)
            self._said = word

    def looks(self) -> Iterator[Look | None]:
        """Four words, or five."""
        words: list[int] = []
        for address in (_ERROR, _STATUS, _SETPOINT, _OUTPUT, _CURRENT):
            words += self._line.registers(address)
            yield None
        error, status, setpoint, output, current = words
        code = error & 0xFF
        yield Look(
            output=output / 100.0,
            setpoint=setpoint / 100.0,
            run=status & 3 >= 2,
            reverse=status >> 3 & 3 in {1, 3},
            asked_reverse=status >> 3 & 3 in {2, 3},
            trip=_TRIPS.get(code, Message("fault code {code} in the inverter manual", code=code))
            if code
            else "",
            current=current / 10.0,
        )

    def reset(self) -> None:
        """Once; its next command is one from the beginning."""
        self._said = 0
        self._line.write_register(_COMMAND, _RESET, tries=1)
