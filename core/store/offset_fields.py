"""The fields of an offset: what they are called, where they are kept, and which values they take."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import isfinite

from core.store.store_rows import (
    ANGLE_REACH,
    MM_PER_INCH,
    OUTLINE_LONGEST,
    RADIUS_MAX,
    REMARK_LONGEST,
    SECONDARY_REACH,
    SHAPE_REACH,
    TOOL_REACH,
    WEAR_REACH,
    ZERO_REACH,
    Kind,
)

_ROUNDING = 1e-9  # in


class Sort(StrEnum):
    """What a value is."""

    LENGTH = "length"  # mm, and inches for whoever enters it
    METRIC = "millimetres"
    ANGLE = "degrees"
    WHOLE = "whole number"
    TEXT = "text"
    FLAG = "yes or no"


_UNITS = {Sort.METRIC: "mm", Sort.ANGLE: "degrees"}


@dataclass(frozen=True, slots=True)
class Field:
    """One field: ``low`` and ``high`` are mm for a length, characters for a text."""

    name: str  # as commands and files call it
    column: str
    word: str  # as a sentence calls it
    low: float
    high: float
    sort: Sort = Sort.LENGTH
    choices: tuple[str, ...] = ()  # of a text that is one of these

    @property
    def range(self) -> str:
        """What it takes, in the unit of the door."""
        if self.choices:
            return ", ".join(self.choices)
        if self.sort is Sort.LENGTH:
            return f"{self.low / MM_PER_INCH:g}…{self.high / MM_PER_INCH:g} in"
        if self.sort in _UNITS:
            return f"{self.low:g}…{self.high:g} {_UNITS[self.sort]}"
        if self.sort is Sort.TEXT:
            return f"up to {self.high:g} characters in one line"
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


_TOOL = (
    Field("x", "x", "X", -TOOL_REACH, TOOL_REACH),
    Field("z", "z", "Z", -TOOL_REACH, TOOL_REACH),
    Field("nose_radius", "r", "nose radius", 0.0, RADIUS_MAX),
    Field("wear_x", "wear_x", "wear X", -WEAR_REACH, WEAR_REACH),
    Field("wear_z", "wear_z", "wear Z", -WEAR_REACH, WEAR_REACH),
    Field("quadrant", "quadrant", "tip quadrant", 0, 9, Sort.WHOLE),
    Field("remark", "remark", "remark", 0, REMARK_LONGEST, Sort.TEXT),
    Field("master", "master", "master", 0, 1, Sort.FLAG),
)
_SECONDARY = (
    Field("x", "x", "X", -SECONDARY_REACH, SECONDARY_REACH),
    Field("z", "z", "Z", -SECONDARY_REACH, SECONDARY_REACH),
    Field("r", "r", "nose radius", 0.0, RADIUS_MAX),
)
_ZERO = (
    Field("x", "x", "X", -ZERO_REACH, ZERO_REACH, Sort.METRIC),
    Field("z", "z", "Z", -ZERO_REACH, ZERO_REACH, Sort.METRIC),
    Field("c", "c", "C", -ANGLE_REACH, ANGLE_REACH, Sort.ANGLE),
)
TOOL_KINDS = (
    *("turning", "boring", "grooving", "parting", "threading", "drill"),
    *("centre-drill", "reamer", "tap", "end-mill", "form"),
)
HANDS = ("right", "left", "neutral")
_SHAPE = (
    Field("kind", "kind", "kind", 0, 0, Sort.TEXT, TOOL_KINDS),
    Field("hand", "hand", "hand", 0, 0, Sort.TEXT, HANDS),
    Field("insert", "insert_code", "insert", 0, REMARK_LONGEST, Sort.TEXT),
    Field("holder", "holder", "holder", 0, OUTLINE_LONGEST, Sort.TEXT),
    Field("width", "width", "width", 0.0, SHAPE_REACH, Sort.LENGTH),
    Field("diameter", "diameter", "diameter", 0.0, SHAPE_REACH, Sort.LENGTH),
    Field("point", "point", "point angle", 0.0, 180.0, Sort.ANGLE),
    Field("stick_out", "stick_out", "stick-out", 0.0, SHAPE_REACH, Sort.LENGTH),
    Field("length", "length", "cutting length", 0.0, SHAPE_REACH, Sort.LENGTH),
    Field("pitch", "pitch", "pitch", 0.0, MM_PER_INCH, Sort.LENGTH),
    Field("flutes", "flutes", "flutes", 0, 20, Sort.WHOLE),
    Field("entry", "entry", "entering angle", 0.0, 150.0, Sort.ANGLE),
    Field("rear", "rear", "behind the spindle", 0, 1, Sort.FLAG),
    Field("profile", "profile", "profile", 0, OUTLINE_LONGEST, Sort.TEXT),
)
FIELDS: Mapping[Kind, Mapping[str, Field]] = {
    Kind.TOOL: {field.name: field for field in _TOOL},
    Kind.SECONDARY: {field.name: field for field in _SECONDARY},
    Kind.ZERO: {field.name: field for field in _ZERO},
    Kind.SHAPE: {field.name: field for field in _SHAPE},
}
