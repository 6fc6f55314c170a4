"""What every family of inverters offers, and what one look at an inverter tells."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from core.message import Message
from drivers.inverter.modbus_rtu import Modbus, NoAnswerError, RefusedError


@dataclass(frozen=True, slots=True)
class Look:
    """An inverter as it said it was. Frequencies in Hz, never negative; directions apart."""

    output: float
    setpoint: float  # as the inverter has understood it
    run: bool  # as the inverter has understood it: it is to turn
    reverse: bool  # turns, or last turned, against M03
    asked_reverse: bool  # and is to
    trip: str = ""  # what has tripped it
    current: float = 0.0  # A

    @property
    def signed(self) -> float:
        """Output frequency with the sign of M03 and M04."""
        return -self.output if self.reverse else self.output


class Family(Protocol):
    """One kind of inverter on its line. Whatever talks raises NoAnswerError, RefusedError or WireError.

    ``hurry`` is asked between requests: a stop is waiting, so that what is not a stop breaks off.
    """

    name: str
    warm_up: int  # good answers in a row before it is trusted
    hurry: Callable[[], bool]

    @property
    def good(self) -> int:
        """Good answers in a row."""
        ...

    def prepare(self, comm_loss: float, highest: float) -> list[str]:
        """Once a connection: its own time-out (s) and its settings against ``highest`` Hz.

        Answers what has to be known.
        """
        ...

    def stop(self) -> None:
        """Stop by its ramp."""
        ...

    def command(self, hz: float) -> None:
        """Turn; negative against M03."""
        ...

    def looks(self) -> Iterator[Look | None]:
        """One look, request by request: None between them, the look at last."""
        ...

    def reset(self) -> None:
        """Clear a trip, said once."""
        ...

    def close(self) -> None:
        """Let the line go."""
        ...


def number(hz: float) -> int:
    """Hundredths of a hertz, as all these families count."""
    return round(abs(hz) * 100.0)


# --- Settings of an inverter that this control needs: read, written where that may be, read back.


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
            return Message(
                "{name} cannot be read ({error}); its value must be {value} ({why})",
                name=self.name,
                error=error,
                value=self.value,
                why=self.why,
            )
        if there == self.value:
            return ""
        return Message(
            "{name} is {present} but must be {value} ({why})",
            name=self.name,
            present=there,
            value=self.value,
            why=self.why,
        )


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
            return Message("{path} cannot be read: {cause}", path=self.name, cause=error)
        if there * 100 >= number(highest) * self.parts:
            return ""
        ends = there / self.parts
        return Message(
            "{name} limits the frequency to {ends} Hz, but the maximum spindle speed needs "
            "{highest} Hz; change one of these values",
            name=self.name,
            ends=f"{ends:g}",
            highest=f"{highest:g}",
        )


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


# --- What the families on Modbus share: their line, and the settings they are asked for at each connection.


class OnModbus:
    """The part of ``Family`` that is the line's."""

    warm_up = 1

    def __init__(self, line: Modbus) -> None:
        self._line = line

    @property
    def hurry(self) -> Callable[[], bool]:
        """Whether a stop waits."""
        return self._line.hurry

    @hurry.setter
    def hurry(self, asked: Callable[[], bool]) -> None:
        """``asked`` tells whether a stop waits, which breaks off what is no stop."""
        self._line.hurry = asked

    @property
    def good(self) -> int:
        """Good answers in a row."""
        return self._line.good

    def close(self) -> None:
        """Let the line go."""
        self._line.wire.close()

    def _prepared(
        self, ours: Sequence[Setting], others: Sequence[Setting], top: Top, highest: float
    ) -> list[str]:
        """Write ``ours``, look at the ``others``; what has to be known. Raises NoAnswerError, WireError."""
        known = settled(self._line, *ours)
        known += [text for setting in others if (text := setting.differs(self._line))]
        return [*known, *filter(None, [top.below(self._line, highest)])]
