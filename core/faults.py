"""What a driver can find wrong, with the code of its alarm; what has tripped, and what is unknown then.

Every code here has its entry in the catalogue (``core.alarms``), with number, likely causes and remedy.
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
    # wires and what hangs on them
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
    """A fault that stands: a sentence for whoever mends it, and the alarm's code; empty when all is well.

    It is a string, so that a driver without more to say can answer ``""``, and one that has several joins
    them by ``or``.
    """

    __slots__ = ("code",)
    code: FaultCode

    def __new__(cls, text: str, code: FaultCode, **values: object) -> Fault:
        """``text`` says which drive, wire or terminal, and what was seen; ``values`` fill its holes."""
        made = super().__new__(cls, Message(text, **values) if values else text)
        made.code = code
        return made

    def __reduce__(self) -> tuple[type[Fault], tuple[str, FaultCode]]:
        """A copy keeps its code."""
        return Fault, (str(self), self.code)


def code_of(fault: str, otherwise: FaultCode) -> FaultCode:
    """The code of a fault; ``otherwise`` for a plain sentence."""
    return fault.code if isinstance(fault, Fault) else otherwise


class DriverError(CodedError):
    """A driver cannot do what it was asked; the sentence says what, where and what to do.

    ``values`` fill the holes of the sentence, like those of a ``Message``. ``code`` is the alarm that it
    becomes when nobody deals with it. The code of a ``Fault`` that is handed on goes with it. ``reason``
    tells causes with the same code apart, in lower case and with hyphens; it is empty where the code is
    enough.
    """

    def __init__(
        self, text: str = "", code: FaultCode | None = None, *, reason: str = "", **values: object
    ) -> None:
        super().__init__(Message(text, **values) if values else text)
        self.code: FaultCode = code or code_of(text, "driver")
        self.reason = reason

    @property
    def fault(self) -> Fault:
        """The same as a fault that stands."""
        return Fault(str(self), self.code)


class TrippedError(DriverError):
    """What stands between control and machine has switched something off by itself, and does nothing more
    before the control has taken note of it (``Tripping``).
    """

    def __init__(self, text: str) -> None:
        super().__init__(text, "late")


class Trip(NamedTuple):
    """What something between control and machine has switched off, because nobody told it anything.

    ``away``: s for which it heard nothing. ``spindle``: it was to turn. ``outputs``: those that were on.
    ``found``: on the way back, where it was the machine that was not heard: it was on all the while.
    """

    number: int
    away: float
    spindle: bool
    outputs: tuple[str, ...]
    found: bool = False


class Tripping(Protocol):
    """A driver host that stops spindle and outputs when its control is silent. From then on it takes no
    setpoint and switches nothing on, with TrippedError, until the control has acknowledged what it did.
    """

    def tripped(self) -> Trip | None:
        """What it has switched off and nobody has acknowledged; None: nothing."""
        ...

    def acknowledge(self, trip: Trip) -> None:
        """The control knows of this very trip; a newer one stays. Raises DriverError."""
        ...


class Unknown(StrEnum):
    """Of what nothing is heard any more: its wire is lost, or is silent."""

    SLIDES = "slides"
    SPINDLE = "spindle"
    OUTPUTS = "outputs"
    INPUTS = "inputs"


ALL_UNKNOWN = frozenset(Unknown)
