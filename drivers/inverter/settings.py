"""Settings of an inverter that this control needs: read, written where that may be, read back."""

from __future__ import annotations

from typing import NamedTuple

from drivers.inverter.errors import NoAnswerError, RefusedError
from drivers.inverter.family import number
from drivers.inverter.modbus import Modbus


class Setting(NamedTuple):
    """A register, what it ought to hold, its name at the keypad, and what for."""

    register: int
    value: int
    name: str
    why: str

    def differs(self, line: Modbus) -> str:
        """A sentence when it holds something else; it is left as it is. Empty when it is right."""
        try:
            (there,) = line.registers(self.register)
        except RefusedError as error:
            return f"{self.name} cannot be read ({error}); it must be {self.value}: {self.why}"
        if there == self.value:
            return ""
        return f"{self.name} is {there}; set it to {self.value}: {self.why}"


class Top(NamedTuple):
    """The register of the highest output frequency, in how many parts of a hertz, its name at the keypad."""

    register: int
    parts: int
    name: str

    def below(self, line: Modbus, highest: float) -> str:
        """A sentence when it ends below ``highest`` Hz; empty when it is enough."""
        try:
            (there,) = line.registers(self.register)
        except RefusedError as error:
            return f"{self.name} cannot be read: {error}"
        if there * 100 >= number(highest) * self.parts:
            return ""
        ends = there / self.parts
        return f"{self.name} ends at {ends:g} Hz, the highest speed needs {highest:g} Hz; change one of them"


def settled(line: Modbus, *wanted: Setting) -> list[str]:
    """Write what differs, and read it back; a sentence for each that is still not as it must be.

    Only what differs is written: such memory wears out.
    """
    for setting in wanted:
        if setting.differs(line):
            try:
                line.write_register(setting.register, setting.value)
            except (RefusedError, NoAnswerError):
                continue  # told below, by what it holds now
    return [text for setting in wanted if (text := setting.differs(line))]
