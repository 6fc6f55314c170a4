"""Units of a machine file. The file writes its own; the model has mm, seconds, degrees, rpm."""

from __future__ import annotations

from enum import StrEnum

INCH = 25.4


class Unit(StrEnum):
    """What a number of the file means; the word is what a finding shows, ``len`` is the file's in or mm."""

    PLAIN = ""
    LENGTH = "len"
    FEED = "len/min"
    ACCEL = "len/s²"
    MILLISECONDS = "ms"
    SECONDS = "s"
    PERCENT = "%"
    DEGREES = "deg"
    RPM = "rpm"
    RPM_PER_SECOND = "rpm/s"
    TURNS_PER_MINUTE = "rpm of C"
    TURNS_PER_MINUTE_SECOND = "rpm/s of C"
    HERTZ = "Hz"
    DEGREES_PER_MINUTE = "deg/min"
    DEGREES_PER_SECOND_SQUARED = "deg/s²"


# A division where there is one, so that 300 in/min gives the very number that an F300 word gives.
_DIVISOR = {
    Unit.FEED: 60.0,
    Unit.DEGREES_PER_MINUTE: 60.0,
    Unit.MILLISECONDS: 1000.0,
    Unit.PERCENT: 100.0,
}
_MULTIPLIER = {Unit.TURNS_PER_MINUTE: 6.0, Unit.TURNS_PER_MINUTE_SECOND: 6.0}
LENGTHS = frozenset((Unit.LENGTH, Unit.FEED, Unit.ACCEL))


def to_model(value: float, unit: Unit, inch: bool) -> float:
    """A number of the file in the model's unit."""
    length = value * INCH if inch and unit in LENGTHS else value
    return length * _MULTIPLIER.get(unit, 1.0) / _DIVISOR.get(unit, 1.0)


def to_file(value: float, unit: Unit, inch: bool) -> float:
    """A number of the model in the file's unit."""
    number = value * _DIVISOR.get(unit, 1.0) / _MULTIPLIER.get(unit, 1.0)
    return number / INCH if inch and unit in LENGTHS else number


def word(unit: Unit, inch: bool) -> str:
    """The unit as the file's owner would write it, with a space before it."""
    text = unit.value.replace("len", "in" if inch else "mm")
    return f" {text}" if text else ""


def shown(value: float, unit: Unit, inch: bool) -> str:
    """A number of the model in the file's unit, for a sentence."""
    return f"{to_file(value, unit, inch):.6g}{word(unit, inch)}"
