"""Lines of a gauge by its SPC cable: Digimatic as text (``01A+00012.345``), or plain ``12.345 mm``."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from app.desk.translation import tr
from core.message import CodedError

LONGEST = 60  # characters of a line; more without an end is no gauge
_DIGIMATIC = re.compile(r"\d{2}A([+-]\d{1,8}(?:\.\d{1,8})?)")
_PLAIN = re.compile(r"([+-]?(?:\d{1,6}(?:[.,]\d{0,7})?|[.,]\d{1,7}))\s*(mm|in|inch|\"|)", re.IGNORECASE)
_UNITS = {"mm": "mm", "in": "in", "inch": "in", '"': "in", "": ""}
# What an interface of Mitutoyo answers instead of a value.
_ERRORS = {
    "911": ("the gauge is not connected or is switched off", "no-gauge"),
    "912": ("the gauge sent unreadable data", "unreadable"),
}


class GaugeError(CodedError, ValueError):
    """A line of a gauge that is not a reading."""


@dataclass(frozen=True, slots=True)
class Reading:
    """A value as it was sent; ``unit`` mm or in, empty where the line does not say it."""

    value: float
    unit: str = ""


def reading_of(line: str) -> Reading:
    """The value of one line. Raises GaugeError for anything else."""
    text = line.strip()
    if text in _ERRORS:
        raise GaugeError(*_ERRORS[text])
    digimatic = _DIGIMATIC.fullmatch(text)
    if digimatic:
        return Reading(float(digimatic.group(1)))
    plain = _PLAIN.fullmatch(text)
    if plain is None:
        raise GaugeError(f"it has sent {text[:24]!r}, which is no reading", "not-a-reading")
    return Reading(float(plain.group(1).replace(",", ".")), _UNITS[plain.group(2).lower()])


class LineReader:
    """Bytes as they come, cut into lines at CR or LF."""

    def __init__(self) -> None:
        self._text = ""

    def lines(self, data: bytes) -> list[str]:
        """Whole lines; what is unfinished waits, and goes where it is longer than any line."""
        self._text += data.decode("ascii", "replace")
        *whole, self._text = re.split(r"[\r\n]+", self._text)
        if len(self._text) > LONGEST:
            whole.append(self._text)
            self._text = ""
        return [line for line in whole if line.strip()]


class Gauge(Protocol):
    """A gauge on a serial line. Nothing here waits."""

    @property
    def open(self) -> bool:
        """Whether its line is listened to."""
        ...

    @property
    def name(self) -> str:
        """As the machine file calls it, kept with its readings."""
        ...

    @property
    def unit(self) -> str:
        """Of lines that do not say it, mm or in."""
        ...

    @property
    def words(self) -> str:
        """Whether it is listened to, and when it was heard last."""
        ...

    def turn(self) -> str:
        """Listen, or no more; why not, empty when it does."""
        ...

    def received(self) -> Sequence[Reading | str]:
        """What has come since the last look: readings, and sentences of what is wrong."""
        ...

    def close(self) -> None: ...


class NoGauge:
    """A machine whose file names no gauge."""

    open = False
    name = ""
    unit = "mm"

    @property
    def words(self) -> str:
        """How a gauge would be wired."""
        return tr("No gauge is configured: enter its serial port under [gauge] in the machine file.")

    def turn(self) -> str:
        """There is none."""
        return tr("NO GAUGE IN THE MACHINE FILE. ADD [gauge] port = …")

    def received(self) -> Sequence[Reading | str]:
        """Nothing ever comes."""
        return ()

    def close(self) -> None:
        """Nothing is open."""
