"""Fields of a shape, and the setting they are filled in for: program, machine, material, tools."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from math import inf
from typing import NamedTuple

from core.language.source import Dialect
from core.message import Message
from core.part.tool_shape import ToolShape

Value = float | str
Values = Mapping[str, Value]
"""By the word of the field; lengths in the unit of the program, diameters as diameters."""
Proposal = Callable[[Values, "Setting"], Value | None]


class Kind(StrEnum):
    """What a field measures."""

    LENGTH = "length"
    DIAMETER = "diameter"
    COORDINATE = "coordinate"  # Z as the program has it, signed
    ANGLE = "angle"
    RATIO = "ratio"
    COUNT = "count"
    FEED = "feed"  # a turn of the spindle
    RATE = "rate"  # a minute
    RPM = "rpm"
    SURFACE = "surface"  # ft/min, metric m/min
    SECONDS = "seconds"
    TOOL = "tool"
    OFFSET = "offset"  # number of a secondary offset
    CHOICE = "choice"
    NAME = "name"


LENGTHS = frozenset({Kind.LENGTH, Kind.DIAMETER, Kind.COORDINATE})
WHOLE = frozenset({Kind.COUNT, Kind.TOOL, Kind.OFFSET})
WORDS = frozenset({Kind.CHOICE, Kind.NAME})


class Refusal(NamedTuple):
    """A value that no part can have: the word of its field, and one sentence with what to do."""

    word: str
    text: str


def _always(_values: Values) -> bool:
    return True


@dataclass(frozen=True, slots=True)
class Field:
    """``word`` names it in the comment, ``label`` on the form. ``start`` is proposed where nothing is typed.

    ``zero``: 0 means "none". ``only`` says for which other values the field exists. ``marked``: a metric
    comment carries MM, since whoever reads it as a tool's size knows no program.
    """

    word: str
    label: str
    kind: Kind = Kind.LENGTH
    start: Proposal | Value | None = None
    choices: tuple[str, ...] = ()
    most: float = inf
    zero: bool = False
    only: Callable[[Values], bool] = field(default=_always)
    marked: bool = False
    tools: tuple[str, ...] = ()  # of T: the kinds that its sheet may state

    def proposed(self, values: Values, setting: Setting) -> Value | None:
        """What is taken where nothing is typed; None: it has to be typed."""
        return self.start(values, setting) if callable(self.start) else self.start

    def refusal(self, value: Value | None) -> Refusal | None:
        """What is wrong with a value by itself; None: nothing."""
        said = self._wrong_word(value) if isinstance(value, str | None) else self._wrong_number(value)
        return Refusal(self.word, said) if said else None

    def _wrong_word(self, value: str | None) -> str:
        if value is None:
            if self.kind is Kind.NAME:
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
        if self.kind in WHOLE and value != int(value):
            return Message(
                "{label} {value} is not a whole number: enter a number such as 1, 2 or 3.",
                label=Message(self.label),
                value=f"{value:g}",
            )
        if value > self.most:
            return Message(
                "{label} {value} is more than {maximum}: enter a smaller value.",
                label=Message(self.label),
                value=f"{value:g}",
                maximum=f"{self.most:g}",
            )
        if self.kind in {Kind.COORDINATE, Kind.ANGLE}:
            return ""
        if value < 0.0 or (value == 0.0 and not self.zero):
            return Message(
                "{label} is {value}, but must be more than 0.", label=Message(self.label), value=f"{value:g}"
            )
        return ""


def choice_text(each: Field, choice: str) -> str:
    """How the catalogues of translations know a choice: with the label of its field."""
    return f"{each.label}: {choice}"


def size(inch: float, metric: float) -> Proposal:
    """A proposal for a length, in the unit of the program."""
    return lambda _values, setting: metric if setting.metric else inch


def number(values: Values, word: str) -> float:
    """A value that is a number; 0 where there is none."""
    value = values.get(word, 0.0)
    return float(value) if not isinstance(value, str) else 0.0


def text(values: Values, word: str) -> str:
    """A value that is a word; empty where there is none."""
    value = values.get(word, "")
    return value if isinstance(value, str) else ""


_NEAR = {False: 0.1, True: 2.5}  # by metric: how near a rapid comes to the part
CLEAR = {False: 1.0, True: 25.0}  # by metric: Z where tools change, where nobody has said it


@dataclass(frozen=True, slots=True)
class Shop:
    """What the machine and its tool store say: rpm, live tool, tools by T (mm)."""

    max_rpm: float = 3500.0
    power: float = 1500.0  # W at the highest speed; where the machine file does not state it, a small drive
    slide_accel: float = 0.0  # mm/s²; 0: not known
    c_rpm: float = 200.0
    live: tuple[int, int] = (15, 16)  # M codes of the live tool: on, off
    live_output: bool = True  # SINUMERIK: an output turns the live tool as spindle 2
    third_axis: str = "C"  # what SINUMERIK programs call C; empty: there is none
    spindle_is_c: bool = True  # C is a second use of the spindle: it taps without a holder that gives
    chuck: tuple[int, int] | None = None  # SINUMERIK: M codes that open and close it
    travel: tuple[float, float] = (0.0, 0.0)  # mm, of X as a radius and of Z; 0: not known
    tools: Mapping[int, ToolShape] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Setting:
    """Lengths in the unit of the program. ``change_z`` is Z where tools change, 0 where nobody has said it,
    ``bar`` the bar's diameter.

    ``called``: the shape stands in a subroutine, ``used`` are the tools before it,
    ``free_sub`` the first number that no subroutine of the program has, or no labelled contour of SINUMERIK.
    """

    metric: bool = False
    diameter: bool = True
    change_z: float = 0.0
    bar: float = 0.0
    material: str = ""
    called: bool = False
    used: frozenset[int] = frozenset()
    free_sub: int = 1
    shop: Shop = field(default_factory=Shop)
    dialect: Dialect = Dialect.OMNITURN

    @property
    def near(self) -> float:
        """How near a rapid comes to the part."""
        return _NEAR[self.metric]

    @property
    def clear(self) -> float:
        """Z where tools change."""
        return self.change_z or CLEAR[self.metric]

    @property
    def mm(self) -> float:
        """mm of one unit of the program."""
        return 1.0 if self.metric else 25.4

    def tool(self, number: float) -> ToolShape | None:
        """The shape of a tool, where its sheet states one."""
        return self.shop.tools.get(int(number))
