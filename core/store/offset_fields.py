"""The fields of an offset: what they are called, where they are kept, and which values they take."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from math import isfinite
from typing import get_args, get_type_hints

from core.message import Message

MM_PER_INCH = 25.4
TOOL_REACH = 1270.0  # mm: 50 in, more than any such lathe travels
SECONDARY_REACH = 254.0  # mm: 10 in, what the control's display has digits for
RADIUS_MAX = 50.8  # mm: 2 in
WEAR_REACH = 2.54  # mm: .1 in; a tool that is off by more has to be touched off
REMARK_LONGEST = 40  # characters
SHAPE_REACH = 508.0  # mm: 20 in, longer than any tool of such a lathe sticks out
OUTLINE_LONGEST = 600  # characters
ZERO_REACH = 5000.0  # mm, more than any such lathe travels
MILL_TOOL_REACH = 1000.0  # mm, longer and thicker than any tool of a mill
OVERSIZE_REACH = 99.999  # mm, as TOOL CALL takes it
LIFE_REACH = 100_000.0  # minutes
ANGLE_REACH = 360.0  # degrees: further is the same place
TOOL_KINDS = (
    *("turning", "boring", "grooving", "parting", "threading", "drill"),
    *("centre-drill", "reamer", "tap", "end-mill", "form"),
)
HANDS = ("right", "left", "neutral")
_ROUNDING = 1e-9  # in


class Sort(StrEnum):
    """What a value is."""

    LENGTH = "length"  # mm, and inches for whoever enters it
    METRIC = "millimetres"
    ANGLE = "degrees"
    MINUTES = "minutes"
    WHOLE = "whole number"
    TEXT = "text"
    FLAG = "yes or no"


_UNITS = {Sort.METRIC: "mm", Sort.ANGLE: "degrees", Sort.MINUTES: "minutes"}


@dataclass(frozen=True, slots=True)
class Field:
    """One field: ``low`` and ``high`` are mm for a length, characters for a text.

    It stands at its place in a row (``store_rows``), whose name is what commands and files call it.
    """

    word: str  # as a sentence calls it
    low: float = 0.0
    high: float = 0.0
    sort: Sort = Sort.LENGTH
    choices: tuple[str, ...] = ()  # of a text that is one of these
    column: str = ""  # of the database, where it is not the name
    name: str = ""

    @property
    def range(self) -> str:
        """What it takes, in the unit of the door."""
        if self.choices:
            return ", ".join(self.choices)
        if self.sort is Sort.LENGTH:
            return Message(
                "{low}…{high} in", low=f"{self.low / MM_PER_INCH:g}", high=f"{self.high / MM_PER_INCH:g}"
            )
        if self.sort in _UNITS:
            return Message(
                "{low}…{high} {units}", low=f"{self.low:g}", high=f"{self.high:g}", units=_UNITS[self.sort]
            )
        if self.sort is Sort.TEXT:
            return Message("up to {high} characters on one line", high=f"{self.high:g}")
        return f"{self.low:g}…{self.high:g}"

    def takes(self, value: object) -> bool:
        """Whether the store keeps this value; a NaN is out of every range."""
        if self.choices:
            return value in self.choices
        if isinstance(value, str):
            return self.sort is Sort.TEXT and len(value) <= self.high and (value.isprintable() or not value)
        if self.sort is Sort.TEXT or not isinstance(value, int | float):
            return False
        rounding = _ROUNDING * MM_PER_INCH if self.sort is Sort.LENGTH else 0.0
        if not isfinite(value) or (self.sort in {Sort.WHOLE, Sort.FLAG} and not float(value).is_integer()):
            return False
        return self.low - rounding <= value <= self.high + rounding


def fields_of(row: type) -> Mapping[str, Field]:
    """The fields of a row by name, in their order; each stands beside its type."""
    fields = {name: get_args(hint)[1] for name, hint in get_type_hints(row, include_extras=True).items()}
    return {name: replace(field, name=name, column=field.column or name) for name, field in fields.items()}
