"""The row types of the store, and the fields of an offset.

Lengths are in mm with X as a radius. Times are UTC in ISO 8601 format. The fields are declared in
annotations. This module does not postpone their evaluation, because Python would then compile each of them
from its text at every start.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from enum import StrEnum
from math import isfinite
from typing import Annotated, Any, NamedTuple, TypeVar, get_args, get_type_hints

from core.message import Message
from core.tool_edges import EDGE_NUMBERS, make_edge_row_number

MM_PER_INCH = 25.4
TOOL_OFFSET_LIMIT_MM = 1270.0  # mm, 50 in, more than the travel of any such lathe
SECONDARY_OFFSET_LIMIT_MM = 254.0  # mm, 10 in, the limit of the digits on the control's display
MAX_NOSE_RADIUS_MM = 50.8  # mm, 2 in
WEAR_LIMIT_MM = 2.54  # mm, .1 in; a tool with more wear has to be touched off again
MAX_REMARK_LENGTH = 40  # characters
MAX_SHAPE_DIMENSION_MM = 508.0  # mm, 20 in, more than the stick-out of any tool of such a lathe
MAX_OUTLINE_LENGTH = 600  # characters
ZERO_OFFSET_LIMIT_MM = 5000.0  # mm, more than the travel of any such lathe
MILL_TOOL_LIMIT_MM = 1000.0  # mm, more than the length or diameter of any mill tool
OVERSIZE_LIMIT_MM = 99.999  # mm, as in TOOL CALL
MAX_TOOL_LIFE_MINUTES = 100_000.0  # minutes
ANGLE_LIMIT_DEG = 360.0  # degrees; larger angles repeat the same positions
TOOL_KINDS = (
    *("turning", "boring", "grooving", "parting", "threading", "drill"),
    *("centre-drill", "reamer", "tap", "end-mill", "form"),
)
TOOL_HANDS = ("right", "left", "neutral")
_ROUNDING = 1e-9  # in
OFFSET_NUMBERS = range(1, 33)
TOOL_ROW_NUMBERS = frozenset(
    make_edge_row_number(tool, edge) for tool in OFFSET_NUMBERS for edge in EDGE_NUMBERS
)
"""Row numbers of the tool tables: the T numbers and their further cutting edges."""
ZERO_CODES = range(54, 60)
MILL_TOOL_NUMBERS = range(1, 1000)
PRESET_NUMBERS = range(1, 100)  # preset 0 is specified in the machine file
FieldValue = float | int | str | bool


class FieldType(StrEnum):
    """The type of a field's value, with its unit."""

    LENGTH = "length"  # stored in mm, entered and shown in inches
    METRIC_LENGTH = "millimetres"
    ANGLE = "degrees"
    MINUTES = "minutes"
    INTEGER = "whole number"
    TEXT = "text"
    BOOLEAN = "yes or no"


_UNITS = {FieldType.METRIC_LENGTH: "mm", FieldType.ANGLE: "degrees", FieldType.MINUTES: "minutes"}


@dataclass(frozen=True, slots=True)
class RowField:
    """The name, the limits and the type of one field of a row.

    ``minimum`` and ``maximum`` are in mm for a length, and numbers of characters for a string. Each field
    is declared in the annotation of an attribute of the row class. Commands and files use the name of this
    attribute.
    """

    label: str  # the name used in messages
    minimum: float = 0.0
    maximum: float = 0.0
    field_type: FieldType = FieldType.LENGTH
    choices: tuple[str, ...] = ()  # valid values of a text with fixed values
    column: str = ""  # the database column, if it differs from the name
    name: str = ""

    @property
    def range_text(self) -> str:
        """Return the accepted range as text, in the unit in which the value is entered."""
        if self.choices:
            return ", ".join(self.choices)
        if self.field_type is FieldType.LENGTH:
            return Message(
                "{low}…{high} in",
                low=f"{self.minimum / MM_PER_INCH:g}",
                high=f"{self.maximum / MM_PER_INCH:g}",
            )
        if self.field_type in _UNITS:
            return Message(
                "{low}…{high} {units}",
                low=f"{self.minimum:g}",
                high=f"{self.maximum:g}",
                units=_UNITS[self.field_type],
            )
        if self.field_type is FieldType.TEXT:
            return Message("up to {high} characters on one line", high=f"{self.maximum:g}")
        return f"{self.minimum:g}…{self.maximum:g}"

    def is_valid_value(self, value: object) -> bool:
        """Return whether the store accepts a value.

        NaN is never accepted.
        """
        if self.choices:
            return value in self.choices
        if isinstance(value, str):
            return (
                self.field_type is FieldType.TEXT
                and len(value) <= self.maximum
                and (value.isprintable() or not value)
            )
        if self.field_type is FieldType.TEXT or not isinstance(value, int | float):
            return False
        rounding = _ROUNDING * MM_PER_INCH if self.field_type is FieldType.LENGTH else 0.0
        if not isfinite(value) or (
            self.field_type in {FieldType.INTEGER, FieldType.BOOLEAN} and not float(value).is_integer()
        ):
            return False
        return self.minimum - rounding <= value <= self.maximum + rounding


def read_row_fields(row: type) -> Mapping[str, RowField]:
    """Return the fields of a row type by name, in order.

    The fields are read from the annotations of the row type.
    """
    fields = {name: get_args(hint)[1] for name, hint in get_type_hints(row, include_extras=True).items()}
    return {name: replace(field, name=name, column=field.column or name) for name, field in fields.items()}


class OffsetKind(StrEnum):
    """The kinds of offset tables of a lathe and of a mill.

    A lathe has tool offsets T, secondary offsets D, zero offsets G54 to G59 and tool shapes. A mill has
    tools and presets of the workpiece zero.
    """

    TOOL = "tool"
    SECONDARY = "secondary"
    ZERO = "zero"
    SHAPE = "shape"
    MILL_TOOL = "mill tool"
    PRESET = "preset"


def _reach(word: str, most: float, sort: FieldType = FieldType.LENGTH) -> RowField:
    return RowField(word, -most, most, sort)


def _size(word: str) -> RowField:
    return RowField(word, 0.0, MAX_SHAPE_DIMENSION_MM)


class ToolOffsetRow(NamedTuple):
    """A tool offset: the machine position of the tip at part zero at touch-off, and the wear since then.

    Lengths are in mm, with X as a radius. ``quadrant`` is the direction of the tip from the nose center, 0
    to 9. At most one tool is the master tool.
    """

    x: Annotated[float, _reach("X", TOOL_OFFSET_LIMIT_MM)] = 0.0
    z: Annotated[float, _reach("Z", TOOL_OFFSET_LIMIT_MM)] = 0.0
    nose_radius: Annotated[float, RowField("nose radius", 0.0, MAX_NOSE_RADIUS_MM, column="r")] = 0.0
    wear_x: Annotated[float, _reach("wear X", WEAR_LIMIT_MM)] = 0.0
    wear_z: Annotated[float, _reach("wear Z", WEAR_LIMIT_MM)] = 0.0
    quadrant: Annotated[int, RowField("tip quadrant", 0, 9, FieldType.INTEGER)] = 0
    remark: Annotated[str, RowField("remark", 0, MAX_REMARK_LENGTH, FieldType.TEXT)] = ""
    master: Annotated[bool, RowField("master", 0, 1, FieldType.BOOLEAN)] = False

    @property
    def offset(self) -> tuple[float, float]:
        """Return the geometry plus the wear in X and Z, in mm, with X as a radius."""
        return self.x + self.wear_x, self.z + self.wear_z


class SecondaryOffsetRow(NamedTuple):
    """A secondary offset (D) in mm, with X as a radius; ``r`` is the nose radius."""

    x: Annotated[float, _reach("X", SECONDARY_OFFSET_LIMIT_MM)] = 0.0
    z: Annotated[float, _reach("Z", SECONDARY_OFFSET_LIMIT_MM)] = 0.0
    r: Annotated[float, RowField("nose radius", 0.0, MAX_NOSE_RADIUS_MM)] = 0.0


class ZeroOffsetRow(NamedTuple):
    """A zero offset: the machine position of program zero, in mm and degrees, with X as a radius."""

    x: Annotated[float, _reach("X", ZERO_OFFSET_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    z: Annotated[float, _reach("Z", ZERO_OFFSET_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    c: Annotated[float, _reach("C", ANGLE_LIMIT_DEG, FieldType.ANGLE)] = 0.0


class ToolShapeRow(NamedTuple):
    """The shape of a tool, in mm and degrees, in which 0 or an empty string means not specified.

    The nose radius and the tip quadrant are in the tool offset. ``length`` is the cutting length,
    ``stick_out`` is the distance from the holder to the tip, and ``entry`` is the entering angle of the
    main cutting edge. ``rear`` means that the tool works at negative X. ``profile`` is an outline ``z,x z,x
    z,x`` in mm.
    """

    kind: Annotated[str, RowField("kind", field_type=FieldType.TEXT, choices=TOOL_KINDS)] = ""
    hand: Annotated[str, RowField("hand", field_type=FieldType.TEXT, choices=TOOL_HANDS)] = "right"
    insert: Annotated[str, RowField("insert", 0, MAX_REMARK_LENGTH, FieldType.TEXT, column="insert_code")] = (
        ""
    )
    holder: Annotated[str, RowField("holder", 0, MAX_OUTLINE_LENGTH, FieldType.TEXT)] = ""
    width: Annotated[float, _size("width")] = 0.0
    diameter: Annotated[float, _size("diameter")] = 0.0
    point: Annotated[float, RowField("point angle", 0.0, 180.0, FieldType.ANGLE)] = 0.0
    stick_out: Annotated[float, _size("stick-out")] = 0.0
    length: Annotated[float, _size("cutting length")] = 0.0
    pitch: Annotated[float, RowField("pitch", 0.0, MM_PER_INCH)] = 0.0
    flutes: Annotated[int, RowField("flutes", 0, 20, FieldType.INTEGER)] = 0
    entry: Annotated[float, RowField("entering angle", 0.0, 150.0, FieldType.ANGLE)] = 0.0
    rear: Annotated[bool, RowField("rear tool", 0, 1, FieldType.BOOLEAN)] = False
    profile: Annotated[str, RowField("profile", 0, MAX_OUTLINE_LENGTH, FieldType.TEXT)] = ""


class MillToolRow(NamedTuple):
    """A tool of a mill: length L, radius R and corner radius R2 with their oversizes, in mm.

    ``life`` is the tool life in minutes. If ``stops`` is True, no further part starts when the tool life is
    used up.
    """

    name: Annotated[str, RowField("NAME", 0, MAX_REMARK_LENGTH, FieldType.TEXT)] = ""
    length: Annotated[float, _reach("L", MILL_TOOL_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    radius: Annotated[float, RowField("R", 0.0, MILL_TOOL_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    corner: Annotated[float, RowField("R2", 0.0, MILL_TOOL_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    dl: Annotated[float, _reach("DL", OVERSIZE_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    dr: Annotated[float, _reach("DR", OVERSIZE_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    dr2: Annotated[float, _reach("DR2", OVERSIZE_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    teeth: Annotated[int, RowField("CUT", 0, 99, FieldType.INTEGER)] = 0
    point: Annotated[float, RowField("T-ANGLE", 0.0, 180.0, FieldType.ANGLE)] = 0.0
    life: Annotated[float, RowField("TIME2", 0.0, MAX_TOOL_LIFE_MINUTES, FieldType.MINUTES)] = 0.0
    stops: Annotated[bool, RowField("STOP", 0, 1, FieldType.BOOLEAN)] = False


class PresetRow(NamedTuple):
    """The machine position of the workpiece zero in mm, and the basic rotation in degrees.

    ``a``, ``b`` and ``c`` are the positions in degrees at which the rotary axes display 0.
    """

    x: Annotated[float, _reach("X", ZERO_OFFSET_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    y: Annotated[float, _reach("Y", ZERO_OFFSET_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    z: Annotated[float, _reach("Z", ZERO_OFFSET_LIMIT_MM, FieldType.METRIC_LENGTH)] = 0.0
    rotation: Annotated[float, _reach("ROT", 180.0, FieldType.ANGLE)] = 0.0
    a: Annotated[float, _reach("A", ANGLE_LIMIT_DEG, FieldType.ANGLE)] = 0.0
    b: Annotated[float, _reach("B", ANGLE_LIMIT_DEG, FieldType.ANGLE)] = 0.0
    c: Annotated[float, _reach("C", ANGLE_LIMIT_DEG, FieldType.ANGLE)] = 0.0
    remark: Annotated[str, RowField("DOC", 0, MAX_REMARK_LENGTH, FieldType.TEXT)] = ""


FIELDS_BY_KIND: Mapping[OffsetKind, Mapping[str, RowField]] = {
    OffsetKind.TOOL: read_row_fields(ToolOffsetRow),
    OffsetKind.SECONDARY: read_row_fields(SecondaryOffsetRow),
    OffsetKind.ZERO: read_row_fields(ZeroOffsetRow),
    OffsetKind.SHAPE: read_row_fields(ToolShapeRow),
    OffsetKind.MILL_TOOL: read_row_fields(MillToolRow),
    OffsetKind.PRESET: read_row_fields(PresetRow),
}
OffsetRow = ToolOffsetRow | SecondaryOffsetRow | ZeroOffsetRow | ToolShapeRow | MillToolRow | PresetRow
ConcreteRowT = TypeVar(
    "ConcreteRowT", ToolOffsetRow, SecondaryOffsetRow, ZeroOffsetRow, ToolShapeRow, MillToolRow, PresetRow
)
RowT = TypeVar("RowT", bound=OffsetRow)  # also for rows whose type is known only at run time


def replace_fields(row: ConcreteRowT, values: Mapping[str, FieldValue]) -> ConcreteRowT:
    """Return the row with the given fields replaced. Raises ValueError for an unknown field name."""
    unknown = values.keys() - set(row._fields)
    if unknown:  # checked here, because the error of _replace depends on the version of Python
        raise ValueError(f"{type(row).__name__} has no field {', '.join(sorted(unknown))}")
    named: dict[str, Any] = dict(values)  # the fields have different types
    return row._replace(**named)


class OffsetChange(NamedTuple):
    """A change of one offset, with the row before and after the change.

    A row is None if the offset was not set. IDs increase with time.
    """

    id: int
    step: int
    undoes: int | None
    at: str
    kind: OffsetKind
    number: int
    old: OffsetRow | None
    new: OffsetRow | None
    why: str
    who: str


class ProgramRow(NamedTuple):
    """The name of a program and its newest version."""

    name: str
    created_at: str
    newest_version: int
    saved: str


class ProgramVersionRow(NamedTuple):
    """One saved version of a program, without its text."""

    number: int
    sha256: str
    saved: str
    why: str
    size: int
    who: str = ""


class EventOrigin(NamedTuple):
    """The identity of the control process that reported an event, and the event's number in that process."""

    control_id: str
    number: int


class EventRow(NamedTuple):
    """One entry of the event log.

    ``line`` is the program line, or 0. ``record`` is a file in the folder ``records``, or an empty string.
    ``who`` is the user who made a change, if users log in.
    """

    at: str
    kind: str
    text: str
    line: int = 0
    record: str = ""
    who: str = ""


class RunRow(NamedTuple):
    """The run record of a program: part count, last run with its outcome, and cycles.

    Times are in seconds. ``proof`` is the result of the last proof, and ``planned`` is its calculated cycle
    time. None means that no value exists yet.
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


def convert_to_inches(mm: float) -> float:
    """Return a length in mm converted to inches.

    The result is rounded to ten decimals, so that a value that was entered in inches is displayed
    unchanged.
    """
    return round(mm / MM_PER_INCH, 10)


def get_utc_now_text() -> str:
    """Return the current time as a UTC string with milliseconds."""
    return format_utc(datetime.now(UTC))


def format_utc(moment: datetime) -> str:
    """Return a time as a UTC string in the stored format, whose alphabetical order is chronological."""
    return moment.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
