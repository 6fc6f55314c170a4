"""What every family of inverters offers, and what one look at an inverter tells."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol


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
