"""Faults that drivers report with their alarm codes, and trips of a driver host.

Every code has an entry in the alarm catalog (``core.alarms``) with its number, likely causes and remedy.
"""

from __future__ import annotations

from enum import StrEnum
from typing import Literal, NamedTuple, Protocol

from core.message import CodedError, Message

FaultCode = Literal[
    # axes
    "axis",
    "following",
    "driver",
    "power-lost",
    "no-power",
    "drive-silent",
    "drive-restarted",
    "drive-setup",
    "drive-keeps-fault",
    "limit-switch",
    "homing",
    "position-lost",
    "drive-limits",
    "queue-dry",
    # spindle
    "spindle",
    "ignores-stop",
    "spindle-off",
    "inverter-silent",
    "spindle-disagrees",
    "spindle-encoder",
    "c-coupling",
    "thread-no-encoder",
    # wiring and connected devices
    "bus",
    "io-silent",
    "output",
    "feeder-gone",
    "feeder-silent",
    "hal-setup",
    "hal-bridge",
    "hal-silent",
    "hal-thread",
    "hal-board",
    "controller-lost",
    "controller-silent",
    "controller-reset",
    "controller-refuses",
    "controller-alarm",
    "controller-modes",
    "controller-estop",
    "door",
    # the control itself
    "late",
    "broken-path",
]


class Fault(str):
    """An active fault: a message with an alarm code. An empty string means that there is no fault.

    Because a fault is a string, a driver without faults can return ``""``, and a driver with several
    possible faults can return the first active one with ``a or b``.
    """

    __slots__ = ("code",)
    code: FaultCode

    def __new__(cls, text: str, code: FaultCode, **values: object) -> Fault:
        """Create a fault from its text and its alarm code.

        ``text`` names the drive, wire or terminal and the symptom. ``values`` fill the fields of the text.
        """
        made = super().__new__(cls, Message(text, **values) if values else text)
        made.code = code
        return made

    def __reduce__(self) -> tuple[type[Fault], tuple[str, FaultCode]]:
        """Return the data from which pickle and copy recreate the fault, including its code."""
        return Fault, (str(self), self.code)


def get_fault_code(fault: str, default: FaultCode) -> FaultCode:
    """Return the code of a fault, or ``default`` for a plain string."""
    return fault.code if isinstance(fault, Fault) else default


class DriverError(CodedError):
    """An error raised by a driver that cannot perform a requested operation.

    - The text states the fault, the device and a remedy; ``values`` fill its fields, as in ``Message``.
    - ``code`` is the code of the alarm that an unhandled error causes. If ``text`` is a ``Fault``,
      the code of the fault is used.
    - ``reason`` distinguishes causes with the same code, in lower case with hyphens. It is empty if
      the code is sufficient.
    """

    def __init__(
        self, text: str = "", code: FaultCode | None = None, *, reason: str = "", **values: object
    ) -> None:
        super().__init__(Message(text, **values) if values else text)
        self.code: FaultCode = code or get_fault_code(text, "driver")
        self.reason = reason

    @property
    def fault(self) -> Fault:
        """Return the error as an active fault."""
        return Fault(str(self), self.code)


# Reason of a DriverError for a command that the drive accepts only when the spindle has stopped.
SPINDLE_TURNS = "spindle-turns"


class TrippedError(DriverError):
    """An error raised if a tripped driver host rejects a command.

    The driver host has stopped the machine because it received no messages from the control. It rejects
    setpoints and commands that switch something on until the trip is acknowledged. See
    ``TrippingDriverHost``.
    """

    def __init__(self, text: str) -> None:
        super().__init__(text, "late")


class DriverHostTrip(NamedTuple):
    """A shutdown by the driver host because it received no messages from the control.

    ``silence_s`` is the time without messages in seconds. ``spindle`` is True if the spindle was commanded
    to run. ``active_outputs`` are the outputs that were on. If ``was_connection_lost`` is True, the driver
    host had lost its connection to the machine, so it could not switch off the spindle and the outputs.
    """

    trip_number: int
    silence_s: float
    spindle: bool
    active_outputs: tuple[str, ...]
    was_connection_lost: bool = False


class TrippingDriverHost(Protocol):
    """A driver host that stops the spindle and switches off the outputs if control messages stop.

    It then raises TrippedError for setpoints and for commands that switch something on, until the control
    acknowledges the trip.
    """

    def get_active_trip(self) -> DriverHostTrip | None:
        """Return the trip that has not been acknowledged yet, or None if there is no such trip."""
        ...

    def acknowledge_trip(self, trip: DriverHostTrip) -> None:
        """Acknowledge this trip, but not a newer trip. Raises DriverError if the driver host fails."""
        ...


class UnknownMachinePart(StrEnum):
    """Part of the machine whose state is unknown because its connection is lost or silent."""

    AXES = "slides"
    SPINDLE = "spindle"
    OUTPUTS = "outputs"
    INPUTS = "inputs"


ALL_UNKNOWN_PARTS = frozenset(UnknownMachinePart)
