"""A serial line as its drivers see it: settings, both directions, and that it can be cut."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from core.ports import DriverError


class WireError(DriverError):
    """The line itself has failed: no such port, cable or adapter out."""


@dataclass(frozen=True, slots=True)
class LineSettings:
    """How the bits go over a line. ``flow``: xonxoff, rtscts or none."""

    port: str
    baud: int = 9600
    bits: int = 8
    parity: str = "N"
    stop: int = 1
    flow: str = "none"

    @property
    def character(self) -> float:
        """Seconds that one character takes, with start, parity and stop bits."""
        return (1 + self.bits + (self.parity != "N") + self.stop) / self.baud

    @property
    def words(self) -> str:
        """``9600 7E1``."""
        return f"{self.baud} {self.bits}{self.parity}{self.stop}"


class Wire(Protocol):
    """Questions and answers. Every method raises WireError when the line is cut."""

    def send(self, data: bytes) -> None:
        """Give bytes to the line; waits at most a moment."""
        ...

    def receive(self, limit: float) -> bytes:
        """What has come; waits ``limit`` seconds at most for the first byte."""
        ...

    def discard(self) -> None:
        """Forget what has come and was not read."""
        ...

    def close(self) -> None: ...


class FlowWire(Wire, Protocol):
    """A line whose other side may hold what is sent, and where damaged characters are counted."""

    @property
    def damaged(self) -> int:
        """Characters with a parity or framing error since the line was opened."""
        ...

    def offer(self, data: bytes) -> int:
        """How many of these bytes the line takes now; none while the other side holds it."""
        ...

    def obey_codes(self) -> None:
        """From now on the other side's DC3 and DC1 (XOFF, XON) hold and release what is sent.

        A line that cannot leaves them in what comes.
        """
        ...

    def waiting(self) -> int:
        """Bytes taken that have not gone out."""
        ...

    def drop_output(self) -> None:
        """What was taken and has not gone out is not sent any more."""
        ...
