"""Input fields of shapes, and the data from which their values are proposed.

The data are the program, the machine, the material and the tools.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from math import inf
from typing import NamedTuple

from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolShape

FieldValue = float | str
FieldValues = Mapping[str, FieldValue]
"""Field values by field word. Lengths are in the program unit, and diameters are diameters."""
ValueProposal = Callable[[FieldValues, "ProgramSettings"], FieldValue | None]


class FieldKind(StrEnum):
    """Kind of value that a shape field accepts."""

    LENGTH = "length"
    DIAMETER = "diameter"
    COORDINATE = "coordinate"  # a Z value of the program, with its sign
    ANGLE = "angle"
    RATIO = "ratio"
    COUNT = "count"
    FEED = "feed"  # per revolution
    RATE = "rate"  # per minute
    RPM = "rpm"
    SURFACE_SPEED = "surface"  # ft/min, or m/min in a metric program
    SECONDS = "seconds"
    TOOL = "tool"
    OFFSET = "offset"  # =
    CHOICE = "choice"
    NAME = "name"


LENGTH_KINDS = frozenset({FieldKind.LENGTH, FieldKind.DIAMETER, FieldKind.COORDINATE})
INTEGER_KINDS = frozenset({FieldKind.COUNT, FieldKind.TOOL, FieldKind.OFFSET})
TEXT_KINDS = frozenset({FieldKind.CHOICE, FieldKind.NAME})


class FieldError(NamedTuple):
    """An error in a field of a shape: the field's name, and a sentence with the cause and a remedy."""

    field_name: str
    message: str


def _always(_values: FieldValues) -> bool:
    return True


@dataclass(frozen=True, slots=True)
class ShapeField:
    """An input field of a shape.

    - ``word`` is the field's name in the comment, and ``label`` its name on the form.
    - ``default`` is the proposed value.
    - ``allows_zero`` permits the value 0, which means "none".
    - ``applies_to`` returns whether the field applies, depending on the other values.
    - ``is_in_comment`` adds MM to metric values in the comment, for programs that read the
      value as a tool size without knowing the program's unit.
    """

    name: str
    label: str
    kind: FieldKind = FieldKind.LENGTH
    default: ValueProposal | FieldValue | None = None
    choices: tuple[str, ...] = ()
    maximum: float = inf
    allows_zero: bool = False
    applies_to: Callable[[FieldValues], bool] = field(default=_always)
    is_in_comment: bool = False
    tool_kinds: tuple[str, ...] = ()  # for T, the permitted kinds of tool

    def propose_value(self, values: FieldValues, settings: ProgramSettings) -> FieldValue | None:
        """Return the proposed value, or None if the operator must enter a value."""
        return self.default(values, settings) if callable(self.default) else self.default

    def find_error(self, value: FieldValue | None) -> FieldError | None:
        """Return the error in a value entered in this field, or None if the value is valid."""
        said = self._wrong_word(value) if isinstance(value, str | None) else self._wrong_number(value)
        return FieldError(self.name, said) if said else None

    def _wrong_word(self, value: str | None) -> str:
        if value is None:
            if self.kind is FieldKind.NAME:
                return Message(
                    "{label} is missing: enter a value, or choose one with the arrows.",
                    label=Message(self.label),
                )
            return Message("{label} is missing: enter a value.", label=Message(self.label))
        if self.choices and value not in self.choices:
            return Message(
                "{label} {value} is not valid: choose one of {choices}.",
                label=Message(self.label),
                value=value,
                choices=", ".join(self.choices),
            )
        return ""

    def _wrong_number(self, value: float) -> str:
        if self.kind in INTEGER_KINDS and value != int(value):
            return Message(
                "{label} {value} is not a whole number: enter a number such as 1, 2 or 3.",
                label=Message(self.label),
                value=f"{value:g}",
            )
        if value > self.maximum:
            return Message(
                "{label} {value} is more than {maximum}: enter a smaller value.",
                label=Message(self.label),
                value=f"{value:g}",
                maximum=f"{self.maximum:g}",
            )
        if self.kind in {FieldKind.COORDINATE, FieldKind.ANGLE}:
            return ""
        if value < 0.0 or (value == 0.0 and not self.allows_zero):
            return Message(
                "{label} is {value}, but must be more than 0.", label=Message(self.label), value=f"{value:g}"
            )
        return ""


def make_choice_text(field: ShapeField, choice: str) -> str:
    """Return the text that identifies a choice in translation catalogs.

    The text consists of the field's label and the choice.
    """
    return f"{field.label}: {choice}"


def make_length_proposal(inch_value: float, metric_value: float) -> ValueProposal:
    """Return a function that proposes a length in the unit of the program."""
    return lambda _values, setting: metric_value if setting.metric else inch_value


def number(values: FieldValues, word: str) -> float:
    """Return the value of a number field, or 0 if it is missing."""
    value = values.get(word, 0.0)
    return float(value) if not isinstance(value, str) else 0.0


def text(values: FieldValues, word: str) -> str:
    """Return the value of a text field, or an empty string if it is missing."""
    value = values.get(word, "")
    return value if isinstance(value, str) else ""


_NEAR = {False: 0.1, True: 2.5}  # by metric; distance from the part at which a rapid ends
DEFAULT_TOOL_CHANGE_Z = {False: 1.0, True: 25.0}  # by metric; default Z of the tool change position


@dataclass(frozen=True, slots=True)
class ShopData:
    """Data of the machine and its tools for proposals.

    The data include the maximum rpm, the live tool, and the tools by T number in mm.
    """

    max_rpm: float = 3500.0
    spindle_power_w: float = 1500.0  # W at the highest speed; the default is a small drive
    max_acceleration_mm_s2: float = 0.0  # mm/s², or 0 if it is unknown
    max_c_axis_rpm: float = 200.0
    live_tool_codes: tuple[int, int] = (15, 16)  # =
    has_live_output: bool = True  # SINUMERIK: an output drives the live tool as spindle 2
    third_axis_name: str = "C"  # name of the C axis in SINUMERIK programs; empty without a C axis
    is_spindle_c_axis: bool = True  # the C axis is the spindle, so rigid tapping is possible
    chuck_codes: tuple[int, int] | None = None  # SINUMERIK: M codes that open and close the chuck
    travel_mm: tuple[float, float] = (0.0, 0.0)  # mm, travel of X (as a radius) and of Z, or 0 if unknown
    tools: Mapping[int, ToolShape] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ProgramSettings:
    """Settings that are active at one place in a program, with lengths in the program's unit.

    - ``tool_change_z``: Z of the tool change position, or 0 if it is not specified.
    - ``bar``: diameter of the bar.
    - ``is_subroutine``: whether the place is in a subroutine.
    - ``used``: numbers of the tools used before the place.
    - ``free_subroutine_number``: first number that neither a subroutine nor, in SINUMERIK,
      a labeled contour of the program uses.
    """

    metric: bool = False
    diameter: bool = True
    tool_change_z: float = 0.0
    bar: float = 0.0
    material: str = ""
    is_subroutine: bool = False
    used: frozenset[int] = frozenset()
    free_subroutine_number: int = 1
    shop: ShopData = field(default_factory=ShopData)
    dialect: Dialect = Dialect.OMNITURN

    @property
    def near(self) -> float:
        """Return the safety distance from the part at which an approaching rapid ends."""
        return _NEAR[self.metric]

    @property
    def clear(self) -> float:
        """Return the Z of the tool change position, or a default if the program specifies none."""
        return self.tool_change_z or DEFAULT_TOOL_CHANGE_Z[self.metric]

    @property
    def mm(self) -> float:
        """Return the size of one length unit of the program in mm."""
        return 1.0 if self.metric else 25.4

    def tool(self, number: float) -> ToolShape | None:
        """Return the shape data of a tool, or None if the tool has no shape data."""
        return self.shop.tools.get(int(number))
