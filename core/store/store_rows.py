"""What the store hands out, and the fields of an offset: lengths mm, X a radius; times UTC, ISO 8601."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from enum import StrEnum
from math import isfinite
from typing import Annotated, Any, NamedTuple, TypeVar, get_args, get_type_hints

from core.message import Message
from core.tool_edges import EDGES, edge_key

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
OFFSETS = range(1, 33)
TOOL_ROWS = frozenset(edge_key(tool, edge) for tool in OFFSETS for edge in EDGES)
"""Numbers of the tables of tools: T, and their further cutting edges."""
ZERO_CODES = range(54, 60)
MILL_TOOLS = range(1, 1000)
PRESETS = range(1, 100)  # 0 is that of the machine file
Value = float | int | str | bool


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


class Kind(StrEnum):
    """The tables of offsets: T, D, the settable zero offsets G54 to G59, the shapes of the tools; and those
    of a mill, its tools and the presets of the workpiece's zero."""

    TOOL = "tool"
    SECONDARY = "secondary"
    ZERO = "zero"
    SHAPE = "shape"
    MILL_TOOL = "mill tool"
    PRESET = "preset"


def _reach(word: str, most: float, sort: Sort = Sort.LENGTH) -> Field:
    return Field(word, -most, most, sort)


def _size(word: str) -> Field:
    return Field(word, 0.0, SHAPE_REACH)


class ToolRow(NamedTuple):
    """Machine position at which the tip stood on part zero when it was touched off, and its wear since.

    ``quadrant`` is where the tip lies as seen from the nose centre, 0…9; one tool at most is the master.
    """

    x: Annotated[float, _reach("X", TOOL_REACH)] = 0.0
    z: Annotated[float, _reach("Z", TOOL_REACH)] = 0.0
    nose_radius: Annotated[float, Field("nose radius", 0.0, RADIUS_MAX, column="r")] = 0.0
    wear_x: Annotated[float, _reach("wear X", WEAR_REACH)] = 0.0
    wear_z: Annotated[float, _reach("wear Z", WEAR_REACH)] = 0.0
    quadrant: Annotated[int, Field("tip quadrant", 0, 9, Sort.WHOLE)] = 0
    remark: Annotated[str, Field("remark", 0, REMARK_LONGEST, Sort.TEXT)] = ""
    master: Annotated[bool, Field("master", 0, 1, Sort.FLAG)] = False

    @property
    def offset(self) -> tuple[float, float]:
        """Geometry and wear together: what the control moves by."""
        return self.x + self.wear_x, self.z + self.wear_z


class SecondaryRow(NamedTuple):
    """D offset as stored: X a radius, R the nose radius."""

    x: Annotated[float, _reach("X", SECONDARY_REACH)] = 0.0
    z: Annotated[float, _reach("Z", SECONDARY_REACH)] = 0.0
    r: Annotated[float, Field("nose radius", 0.0, RADIUS_MAX)] = 0.0


class ZeroRow(NamedTuple):
    """Zero offset: machine position of the program's zero, X a radius, C in degrees."""

    x: Annotated[float, _reach("X", ZERO_REACH, Sort.METRIC)] = 0.0
    z: Annotated[float, _reach("Z", ZERO_REACH, Sort.METRIC)] = 0.0
    c: Annotated[float, _reach("C", ANGLE_REACH, Sort.ANGLE)] = 0.0


class ShapeRow(NamedTuple):
    """Shape of a tool, mm and degrees, 0 or empty: not stated; nose radius and tip are those of its offset.

    ``length`` is what can cut, ``stick_out`` where the tool is held, ``entry`` the entering angle of the main
    edge; ``rear``: it works at X negative; ``profile`` is an outline, ``z,x z,x z,x`` in mm.
    """

    kind: Annotated[str, Field("kind", sort=Sort.TEXT, choices=TOOL_KINDS)] = ""
    hand: Annotated[str, Field("hand", sort=Sort.TEXT, choices=HANDS)] = "right"
    insert: Annotated[str, Field("insert", 0, REMARK_LONGEST, Sort.TEXT, column="insert_code")] = ""
    holder: Annotated[str, Field("holder", 0, OUTLINE_LONGEST, Sort.TEXT)] = ""
    width: Annotated[float, _size("width")] = 0.0
    diameter: Annotated[float, _size("diameter")] = 0.0
    point: Annotated[float, Field("point angle", 0.0, 180.0, Sort.ANGLE)] = 0.0
    stick_out: Annotated[float, _size("stick-out")] = 0.0
    length: Annotated[float, _size("cutting length")] = 0.0
    pitch: Annotated[float, Field("pitch", 0.0, MM_PER_INCH)] = 0.0
    flutes: Annotated[int, Field("flutes", 0, 20, Sort.WHOLE)] = 0
    entry: Annotated[float, Field("entering angle", 0.0, 150.0, Sort.ANGLE)] = 0.0
    rear: Annotated[bool, Field("rear tool", 0, 1, Sort.FLAG)] = False
    profile: Annotated[str, Field("profile", 0, OUTLINE_LONGEST, Sort.TEXT)] = ""


class MillRow(NamedTuple):
    """A tool of a mill: L, R, R2 (its corner), what they are off by (DL, DR, DR2), mm; its life in min.

    ``stops``: no other part begins with it when its life is gone.
    """

    name: Annotated[str, Field("NAME", 0, REMARK_LONGEST, Sort.TEXT)] = ""
    length: Annotated[float, _reach("L", MILL_TOOL_REACH, Sort.METRIC)] = 0.0
    radius: Annotated[float, Field("R", 0.0, MILL_TOOL_REACH, Sort.METRIC)] = 0.0
    corner: Annotated[float, Field("R2", 0.0, MILL_TOOL_REACH, Sort.METRIC)] = 0.0
    dl: Annotated[float, _reach("DL", OVERSIZE_REACH, Sort.METRIC)] = 0.0
    dr: Annotated[float, _reach("DR", OVERSIZE_REACH, Sort.METRIC)] = 0.0
    dr2: Annotated[float, _reach("DR2", OVERSIZE_REACH, Sort.METRIC)] = 0.0
    teeth: Annotated[int, Field("CUT", 0, 99, Sort.WHOLE)] = 0
    point: Annotated[float, Field("T-ANGLE", 0.0, 180.0, Sort.ANGLE)] = 0.0
    life: Annotated[float, Field("TIME2", 0.0, LIFE_REACH, Sort.MINUTES)] = 0.0
    stops: Annotated[bool, Field("STOP", 0, 1, Sort.FLAG)] = False


class PresetRow(NamedTuple):
    """Machine position of the workpiece's zero, mm, and its basic rotation, with the rotary axes at A B C,
    where they read 0."""

    x: Annotated[float, _reach("X", ZERO_REACH, Sort.METRIC)] = 0.0
    y: Annotated[float, _reach("Y", ZERO_REACH, Sort.METRIC)] = 0.0
    z: Annotated[float, _reach("Z", ZERO_REACH, Sort.METRIC)] = 0.0
    rotation: Annotated[float, _reach("ROT", 180.0, Sort.ANGLE)] = 0.0
    a: Annotated[float, _reach("A", ANGLE_REACH, Sort.ANGLE)] = 0.0
    b: Annotated[float, _reach("B", ANGLE_REACH, Sort.ANGLE)] = 0.0
    c: Annotated[float, _reach("C", ANGLE_REACH, Sort.ANGLE)] = 0.0
    remark: Annotated[str, Field("DOC", 0, REMARK_LONGEST, Sort.TEXT)] = ""


FIELDS: Mapping[Kind, Mapping[str, Field]] = {
    Kind.TOOL: fields_of(ToolRow),
    Kind.SECONDARY: fields_of(SecondaryRow),
    Kind.ZERO: fields_of(ZeroRow),
    Kind.SHAPE: fields_of(ShapeRow),
    Kind.MILL_TOOL: fields_of(MillRow),
    Kind.PRESET: fields_of(PresetRow),
}
Row = ToolRow | SecondaryRow | ZeroRow | ShapeRow | MillRow | PresetRow
R = TypeVar("R", ToolRow, SecondaryRow, ZeroRow, ShapeRow, MillRow, PresetRow)
RowT = TypeVar("RowT", bound=Row)  # also where only the kind is known when the program runs


def with_fields(row: R, values: Mapping[str, Value]) -> R:
    """The row with these fields, by their names in ``FIELDS``. Raises ValueError for one that it has not."""
    named: dict[str, Any] = dict(values)  # each field is of its own sort
    return row._replace(**named)


class Change(NamedTuple):
    """One offset's change: its row before and after, None where it was not set. Ids give the order."""

    id: int
    step: int
    undoes: int | None
    at: str
    kind: Kind
    number: int
    old: Row | None
    new: Row | None
    why: str
    who: str


class ProgramRow(NamedTuple):
    """A program's name and its newest version."""

    name: str
    created: str
    version: int
    saved: str


class VersionRow(NamedTuple):
    """One saved version of a program."""

    number: int
    sha256: str
    saved: str
    why: str
    size: int
    who: str = ""


class EventRow(NamedTuple):
    """One line of the log; ``line`` is the program's, 0 none; ``record`` is a file of the folder records.

    ``who`` has changed something, where people say who they are.
    """

    at: str
    kind: str
    text: str
    line: int = 0
    record: str = ""
    who: str = ""


class RunRow(NamedTuple):
    """What a program has done: parts counted, last run and its outcome, cycles since ever, times in seconds.

    ``proof`` is what proving found last, ``planned`` the cycle time it reckoned with; None: never.
    """

    program: str
    parts: int = 0
    started: str | None = None
    outcome: str = ""
    cycles: int = 0
    best: float | None = None
    latest: float | None = None
    proved: str | None = None
    proof: str = ""
    planned: float | None = None


def inches(mm: float) -> float:
    """Millimetres as inches with ten places: what was entered in inches comes back as it was entered."""
    return round(mm / MM_PER_INCH, 10)


def utc_now() -> str:
    """This moment, to the millisecond."""
    return utc(datetime.now(UTC))


def utc(moment: datetime) -> str:
    """A moment as it is kept; what is later is greater as a text too."""
    return moment.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
