"""Interface of all inverter families, the polled state of an inverter, and its parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from core.message import Message
from drivers.inverter.family_table import ABSENT, FamilyTable, ParameterKeys, TopKeys
from drivers.inverter.modbus_rtu import NoAnswerError, RefusedError


@dataclass(frozen=True, slots=True)
class Look:
    """Polled state of an inverter; frequencies are in Hz and never negative."""

    output: float
    setpoint: float  # As the inverter has received it.
    run: bool  # Run command as the inverter has received it.
    reverse: bool  # Turns, or last turned, in reverse.
    asked_reverse: bool  # A reverse command is active.
    trip: str = ""  # Reason for a trip.
    current: float = 0.0  # A

    @property
    def signed(self) -> float:
        """The output frequency in Hz, positive as M03 and negative as M04."""
        return -self.output if self.reverse else self.output


class Family(Protocol):
    """Inverter on its line. Methods that communicate raise NoAnswerError, RefusedError or WireError.

    ``hurry`` returns whether a stop is pending. It is called between requests, so that other requests are
    canceled. It is also called directly before each frame that can turn the motor; the frame is then not sent
    and HeldBackError is raised.
    """

    warm_up: int  # Consecutive valid responses before the inverter is trusted.
    hurry: Callable[[], bool]

    @property
    def good(self) -> int:
        """The number of consecutive valid responses."""
        ...

    def prepare(self, comm_loss: float, highest: float) -> list[str]:
        """Check the communication timeout (``comm_loss``, seconds) and the settings, once per connection.

        ``highest`` is the required frequency in Hz. Return the messages for the operator.
        """
        ...

    def stop(self) -> None:
        """Stop by the inverter's ramp."""
        ...

    def command(self, hz: float) -> None:
        """Turn at a frequency in Hz, negative against M03. Raises HeldBackError if a stop is pending."""
        ...

    def looks(self) -> Iterator[Look | None]:
        """Poll the inverter; yield None between requests and the state at the end.

        Raises HeldBackError if a stop is pending.
        """
        ...

    def reset(self) -> None:
        """Reset a trip once."""
        ...

    def close(self) -> None:
        """Close the line."""
        ...


# --- Required parameters of an inverter: read, written if permitted, and read back.


Read = Callable[[int], int]  # Returns the value of a parameter by its register.
Write = Callable[[int, int], None]


class Setting(NamedTuple):
    """Required parameter value: register, value, name at the keypad, and purpose."""

    register: int
    value: int
    name: str
    why: str

    def differs(self, read: Read) -> str:
        """Return a message if the inverter has another value, or an empty text; nothing is written."""
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
    """Write the parameters that may be written and return a message for each wrong parameter.

    ``comm_loss`` is in seconds, ``highest`` in Hz. Raises NoAnswerError or WireError.
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
    """Write the values that differ, read them back, and return a message for each wrong value.

    Equal values are not written, because the memory wears out.
    """
    wanted = list(wanted)
    for setting in wanted:
        if setting.differs(read):
            try:
                write(setting.register, setting.value)
            except (RefusedError, NoAnswerError):
                continue  # Reported below with the present value.
    return [text for setting in wanted if (text := setting.differs(read))]


def _below(top: TopKeys, highest: float, read: Read) -> str:
    """Return a message if the inverter limits its output below ``highest`` Hz, or an empty text."""
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
