"""The interface of all inverter families, the polled state of an inverter, and its parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from core.message import Message
from drivers.inverter.family_table import ABSENT_REGISTER, FamilyTable, MaxFrequencyKeys, ParameterKeys
from drivers.inverter.modbus_rtu import NoResponseError, RequestRejectedError


@dataclass(frozen=True, slots=True)
class InverterState:
    """The polled state of an inverter.

    Frequencies are in Hz and never negative.
    """

    output_hz: float
    setpoint_hz: float  # As the inverter has received it.
    is_running: bool  # Run command as the inverter has received it.
    is_reverse_direction: bool  # Turns, or last turned, in reverse.
    is_reverse_commanded: bool  # A reverse command is active.
    trip_text: str = ""  # Reason for a trip.
    current_a: float = 0.0  # A

    @property
    def signed_output_hz(self) -> float:
        """Return the output frequency in Hz, positive for M03 and negative for M04."""
        return -self.output_hz if self.is_reverse_direction else self.output_hz


class InverterFamily(Protocol):
    """Protocol for an inverter on its serial line.

    Methods that communicate raise NoResponseError, RequestRejectedError or SerialLineError.
    ``is_stop_pending`` is a function that returns whether a stop is pending. It is called between requests,
    so that a stop cancels the remaining requests. It is also called directly before each frame that can
    start the motor. If a stop is pending, the frame is not sent and RequestWithheldError is raised.
    """

    required_response_count: int  # Consecutive valid responses before the inverter is trusted.
    is_stop_pending: Callable[[], bool]

    @property
    def valid_response_count(self) -> int:
        """Return the number of consecutive valid responses."""
        ...

    def check_parameters(self, comm_timeout_s: float, max_hz: float) -> list[str]:
        """Check the communication timeout and the settings, once per connection.

        ``comm_timeout_s`` is the required timeout in seconds, and ``max_hz`` is the required frequency in
        Hz. Returns the messages for the operator.
        """
        ...

    def stop_motor(self) -> None:
        """Stop the motor by the inverter's ramp."""
        ...

    def command_frequency_hz(self, hz: float) -> None:
        """Run the motor at a frequency in Hz, which is positive for M03 and negative for M04.

        Raises RequestWithheldError if a stop is pending.
        """
        ...

    def iter_poll_steps(self) -> Iterator[InverterState | None]:
        """Poll the inverter; yield None between requests, and the polled state at the end.

        Raises RequestWithheldError if a stop is pending and the poll would repeat a run command. Families
        that only read registers never raise it here.
        """
        ...

    def reset_trip(self) -> None:
        """Reset a trip of the inverter once."""
        ...

    def close(self) -> None:
        """Close the line."""
        ...


# --- Required parameters of an inverter: read, written if permitted, and read back.


ReadParameter = Callable[[int], int]  # Returns the value of a parameter by its register.
WriteParameter = Callable[[int, int], None]


class RequiredParameter(NamedTuple):
    """A required parameter value, with its register, its name at the keypad and its purpose."""

    register_address: int
    required_value: int
    keypad_name: str
    purpose: str

    def describe_difference(self, read_value: ReadParameter) -> str:
        """Return a message if the inverter has a different value, or an empty string.

        The parameter is not written.
        """
        try:
            there = read_value(self.register_address)
        except RequestRejectedError as error:
            return Message(
                "{name} cannot be read ({error}); its value must be {value} ({why})",
                name=self.keypad_name,
                error=error,
                value=self.required_value,
                why=self.purpose,
            )
        if there == self.required_value:
            return ""
        return Message(
            "{name} is {present} but must be {value} ({why})",
            name=self.keypad_name,
            present=there,
            value=self.required_value,
            why=self.purpose,
        )


def write_and_check_parameters(
    table: FamilyTable,
    comm_timeout_s: float,
    max_hz: float,
    read_parameter: ReadParameter,
    write_parameter: WriteParameter,
) -> list[str]:
    """Write the parameters that may be written, and return a message for each wrong parameter.

    ``comm_timeout_s`` is in seconds, ``max_hz`` in Hz. A rejected request results in a message. Raises
    NoResponseError if the inverter does not respond to a read request, and SerialLineError if the line has
    failed.
    """
    known = (
        [] if any(each.counts_per_s for each in table.parameters) else [_no_timeout(table, comm_timeout_s)]
    )
    known += _apply_setting(_settings(table, comm_timeout_s, write=True), read_parameter, write_parameter)
    known += [
        text
        for each in _settings(table, comm_timeout_s, write=False)
        if (text := each.describe_difference(read_parameter))
    ]
    if table.max_frequency_parameter is not None and (
        text := _check_max_frequency(table.max_frequency_parameter, max_hz, read_parameter)
    ):
        known.append(text)
    return known


def _settings(table: FamilyTable, comm_loss: float, *, write: bool) -> list[RequiredParameter]:
    return [_setting(each, comm_loss) for each in table.parameters if each.write is write]


def _setting(each: ParameterKeys, comm_loss: float) -> RequiredParameter:
    if each.value != ABSENT_REGISTER:
        return RequiredParameter(each.register, each.value, each.name, each.why)
    why = Message("communication timeout of {comm_loss} s", comm_loss=f"{comm_loss:g}")
    return RequiredParameter(each.register, round(comm_loss * each.counts_per_s), each.name, why)


def _apply_setting(
    required: Iterable[RequiredParameter], read: ReadParameter, write: WriteParameter
) -> list[str]:
    """Write the values that differ, read them back, and return a message for each wrong value.

    Equal values are not written, because each write wears the inverter's memory.
    """
    required = list(required)
    for setting in required:
        if setting.describe_difference(read):
            try:
                write(setting.register_address, setting.required_value)
            except (RequestRejectedError, NoResponseError):
                continue  # Reported below with the present value.
    return [text for setting in required if (text := setting.describe_difference(read))]


def _check_max_frequency(parameter: MaxFrequencyKeys, highest: float, read: ReadParameter) -> str:
    """Return a message if the inverter limits its output below ``highest`` Hz, or an empty string."""
    try:
        there = read(parameter.register)
    except RequestRejectedError as error:
        return Message("{path} cannot be read: {cause}", path=parameter.name, cause=error)
    if there * 100 >= round(highest * 100.0) * parameter.counts_per_hz:
        return ""
    return Message(
        "{name} limits the frequency to {ends} Hz, but the maximum spindle speed needs "
        "{highest} Hz; change one of these values",
        name=parameter.name,
        ends=f"{there / parameter.counts_per_hz:g}",
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
