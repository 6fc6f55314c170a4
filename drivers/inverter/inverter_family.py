"""What every family of inverters offers, and what one look at an inverter tells."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from core.message import Message
from drivers.inverter.family_table import ABSENT, FamilyTable, ParameterKeys, TopKeys
from drivers.inverter.modbus_rtu import NoAnswerError, RefusedError


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

    ``hurry`` is asked between requests: a stop is waiting, so that what is not a stop breaks off. It is asked
    right before each frame that can make the motor turn, which is then not sent: HeldBackError.
    """

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
        """Turn; negative against M03. Raises HeldBackError."""
        ...

    def looks(self) -> Iterator[Look | None]:
        """One look, request by request: None between them, the look at last. Raises HeldBackError."""
        ...

    def reset(self) -> None:
        """Clear a trip, said once."""
        ...

    def close(self) -> None:
        """Let the line go."""
        ...


# --- Parameters of an inverter that this control needs: read, written where that may be, read back.


Read = Callable[[int], int]  # the value of a parameter by its register
Write = Callable[[int, int], None]


class Setting(NamedTuple):
    """A register, what it ought to hold, its name at the keypad, and what for."""

    register: int
    value: int
    name: str
    why: str

    def differs(self, read: Read) -> str:
        """A sentence when it holds something else; it is left as it is. Empty when it is right."""
        try:
            there = read(self.register)
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


def check_parameters(
    table: FamilyTable, comm_loss: float, highest: float, read: Read, write: Write
) -> list[str]:
    """Write what may be written, and return a sentence for each parameter that is not as it must be.

    ``comm_loss`` is in seconds, ``highest`` in Hz. Raises NoAnswerError, WireError.
    """
    known = [] if any(each.counts_per_s for each in table.parameters) else [_no_timeout(table, comm_loss)]
    known += _settled(_settings(table, comm_loss, write=True), read, write)
    known += [text for each in _settings(table, comm_loss, write=False) if (text := each.differs(read))]
    if table.top is not None and (text := _below(table.top, highest, read)):
        known.append(text)
    return known


def _settings(table: FamilyTable, comm_loss: float, *, write: bool) -> list[Setting]:
    return [_setting(each, comm_loss) for each in table.parameters if each.write is write]


def _setting(each: ParameterKeys, comm_loss: float) -> Setting:
    if each.value != ABSENT:
        return Setting(each.register, each.value, each.name, each.why)
    why = Message("communication timeout of {comm_loss} s", comm_loss=f"{comm_loss:g}")
    return Setting(each.register, round(comm_loss * each.counts_per_s), each.name, why)


def _settled(wanted: Iterable[Setting], read: Read, write: Write) -> list[str]:
    """Write what differs, and read it back; a sentence for each that is still not as it must be.

    Only what differs is written: such memory wears out.
    """
    wanted = list(wanted)
    for setting in wanted:
        if setting.differs(read):
            try:
                write(setting.register, setting.value)
            except (RefusedError, NoAnswerError):
                continue  # told below, by what it holds now
    return [text for setting in wanted if (text := setting.differs(read))]


def _below(top: TopKeys, highest: float, read: Read) -> str:
    """A sentence when the inverter ends below ``highest`` Hz; empty when it is enough."""
    try:
        there = read(top.register)
    except RefusedError as error:
        return Message("{path} cannot be read: {cause}", path=top.name, cause=error)
    if there * 100 >= round(highest * 100.0) * top.counts_per_hz:
        return ""
    return Message(
        "{name} limits the frequency to {ends} Hz, but the maximum spindle speed needs "
        "{highest} Hz; change one of these values",
        name=top.name,
        ends=f"{there / top.counts_per_hz:g}",
        highest=f"{highest:g}",
    )


def _no_timeout(table: FamilyTable, comm_loss: float) -> str:
    return Message(
        "{name}: this inverter does not have a communication timeout, so comm_loss_s = "
        "{comm_loss} has no effect. If the cable is disconnected, the spindle continues to "
        "turn. Wire the E-stop and a watchdog relay to the run terminal of the inverter",
        name=table.name,
        comm_loss=f"{comm_loss:g}",
    )
