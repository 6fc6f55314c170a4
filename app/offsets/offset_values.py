"""Input and display formats of offsets: unit, diameter, range and sign.

Inches have 5 decimals and mm have 4. Zero offsets have 3 decimals in mm and degrees. Stored values are in mm
and degrees, with X as a radius.
"""

from __future__ import annotations

from dataclasses import dataclass

from app.desk.arithmetic import EntryError, value_of
from app.desk.status import formats
from app.desk.status.formats import MINUS, MM_PER_INCH
from app.desk.translation import tr
from core.message import Message
from core.store.store_rows import (
    FIELDS,
    Field,
    Kind,
    MillRow,
    PresetRow,
    Row,
    SecondaryRow,
    ShapeRow,
    Sort,
    ToolRow,
    Value,
    ZeroRow,
)

TOOL_FIELDS = {**FIELDS[Kind.TOOL], **FIELDS[Kind.SHAPE]}  # Fields of a tool's offset and of its shape.
ZERO_PLACES = 3


@dataclass(frozen=True, slots=True)
class Mode:
    """The control's unit, and whether X is a diameter, from one snapshot."""

    metric: bool = False
    diameter: bool = False

    @property
    def unit(self) -> float:
        """The number of millimeters in one unit of an entry."""
        return 1.0 if self.metric else MM_PER_INCH

    @property
    def name(self) -> str:
        """The name of the unit in messages."""
        return "mm" if self.metric else "in"


UNKNOWN = "?"  # Replaces a value that could not be read.


def not_set(*, unread: bool = False) -> str:
    """Return the text for an offset that was never entered, or that could not be read."""
    return tr("unreadable") if unread else tr("not set")


def signed(mm: float, metric: bool) -> str:
    """Return a length in mm as text with a sign, also a plus, because an offset differs from a dimension."""
    figure = formats.length(mm, metric)
    return figure if figure.startswith(MINUS) else f"+{figure}"


def signed_zero_offset(value: float) -> str:
    """Return a zero offset in mm or degrees as text with a sign."""
    figure = formats.fixed(value, ZERO_PLACES)
    return figure if value < 0 and figure[:1] not in "0123456789" else f"+{figure}"


def to_mm(value: float, metric: bool) -> float:
    """Return an entered length in mm, rounded in its own unit so that it is displayed as entered."""
    return round(value, 10) * (1.0 if metric else MM_PER_INCH)


def added(mm: float, value: float, metric: bool) -> float:
    """Return ``mm`` plus an entered correction in mm.

    The sum is rounded in the unit of the entry, so that ten times .0005 is .005.
    """
    unit = 1.0 if metric else MM_PER_INCH
    return round(mm / unit + value, 10) * unit


def out_of_range(field: str, value: str, unit: str, low: float, high: float) -> str:
    """Return the message for a value out of its range, in the unit of the entry."""
    text = tr("{field} would become {value} {unit}; allowed range is {low}…{high}")
    return tr(Message(text, field=field, value=value, unit=unit, low=f"{low:g}", high=f"{high:g}"))


# =


def in_words(offset: Row | None, mode: Mode) -> str:
    """Return an offset in one line. X of a tool follows the control's mode; other X values are radii."""
    if offset is None:
        return not_set()
    if isinstance(offset, ToolRow):
        return f"{_pair(offset.x, offset.z, mode.metric, mode.diameter)}{_more(offset, mode)}"
    if isinstance(offset, SecondaryRow):
        x, z, r = offset
        return f"X {signed(x, mode.metric)}  Z {signed(z, mode.metric)}  R {formats.length(r, mode.metric)}"
    if isinstance(offset, ShapeRow):
        return _shape_in_words(offset, mode)
    if isinstance(offset, ZeroRow):
        both = zip("XZC", offset, strict=True)
        return "  ".join(f"{name} {signed_zero_offset(value)}" for name, value in both)
    return stated_fields(offset)


def stated_fields(row: MillRow | PresetRow) -> str:
    """Return the fields of a mill's tool or preset that have values, with the control's names."""
    fields = FIELDS[Kind.MILL_TOOL if isinstance(row, MillRow) else Kind.PRESET]
    values: tuple[Value, ...] = tuple(row)
    told = [
        field.word if field.sort is Sort.FLAG else f"{field.word} {cell_text(field, value)}"
        for field, value in zip(fields.values(), values, strict=True)
        if value or field.name in {"x", "y", "z", "rotation"}
    ]
    return "  ".join(told) or formats.NOTHING


def cell_text(field: Field, value: Value) -> str:
    """Return a value as text in mm, degrees or minutes, for a table of a mill."""
    if isinstance(value, str):
        return value
    if field.sort is Sort.FLAG:
        return field.word if value else formats.NOTHING
    if field.sort in {Sort.WHOLE, Sort.MINUTES}:
        return f"{value:g}"
    return signed_zero_offset(value) if field.low < 0 else formats.fixed(value, ZERO_PLACES)


def _pair(x: float, z: float, metric: bool, diameter: bool) -> str:
    mark = "Ø" if diameter else ""
    return f"X{mark} {signed(2 * x if diameter else x, metric)}  Z {signed(z, metric)}"


def _more(tool: ToolRow, mode: Mode) -> str:
    """Return the other values of a tool, if they are set."""
    parts = [f"  R {formats.length(tool.nose_radius, mode.metric)}"]
    if tool.wear_x or tool.wear_z:
        parts.append(f"  {tr('WEAR')} {_pair(tool.wear_x, tool.wear_z, mode.metric, True)}")
    if tool.quadrant:
        parts.append(f"  {tr('TIP')} {tool.quadrant}")
    if tool.master:
        parts.append(f"  {tr('MASTER')}")
    return "".join(parts) + (f"  {tool.remark}" if tool.remark else "")


def _shape_in_words(shape: ShapeRow, mode: Mode) -> str:
    """Return the kind and hand of a tool shape, and its specified values."""
    stated = [
        f"{word(name)} {shown_value(name, value, mode)}"
        for name, value in shape._asdict().items()
        if value and not TOOL_FIELDS[name].choices
    ]
    return "  ".join([choice_word(shape.kind), choice_word(shape.hand), *stated])


def from_to(old: Row | None, new: Row | None, mode: Mode) -> str:
    """Return an offset before and after a change.

    For a tool that is set before and after, only the changed fields are included.
    """
    if not (isinstance(old, ToolRow | ShapeRow) and isinstance(new, ToolRow | ShapeRow)):
        return f"{in_words(old, mode)}  →  {in_words(new, mode)}"
    changed = [name for name in old._fields if getattr(old, name) != getattr(new, name)]
    return "   ".join(
        f"{word(name)} {_in_change(name, old, mode)} → {_in_change(name, new, mode)}" for name in changed
    )


def _in_change(name: str, row: ToolRow | ShapeRow, mode: Mode) -> str:
    if TOOL_FIELDS[name].sort is Sort.FLAG:
        return tr("yes") if getattr(row, name) else tr("no")
    return shown_value(name, getattr(row, name), mode) or tr("none")


# --- a field of a tool -----------------------------------------------------------------------------------


def value_typed(name: str, text: str, mode: Mode) -> Value:
    """Return the field value for an entered text, in mm for lengths. Raises EntryError with the reason."""
    field = TOOL_FIELDS[name]
    if field.sort is Sort.TEXT:
        value: Value = text.strip()
    elif field.sort is Sort.FLAG and text in {"yes", "no"}:
        value = text == "yes"
    elif field.sort is Sort.LENGTH:
        value = to_mm(value_of(text) / _doubled(name, mode), mode.metric)
    else:
        number = value_of(text)
        value = int(number) if number.is_integer() else number
    return _taken(field, value, mode)


def value_added(name: str, old: ToolRow, text: str, mode: Mode) -> Value:
    """Return the length in mm after adding an entered text. Raises EntryError with the reason."""
    field, before = TOOL_FIELDS[name], getattr(old, name)
    if field.sort is not Sort.LENGTH:
        raise EntryError(
            tr(
                Message(
                    "{field} does not accept an added value; press Enter to set the value", field=field.word
                )
            )
        )
    return _taken(field, added(before, value_of(text) / _doubled(name, mode), mode.metric), mode)


def _taken(field: Field, value: Value, mode: Mode) -> Value:
    if field.takes(value):
        return value
    if field.sort is not Sort.LENGTH:
        raise EntryError(tr(Message("{field} must be {range}", field=field.word, range=field.range)))
    factor = _doubled(field.name, mode) / mode.unit
    figure = shown_value(field.name, value, mode)
    raise EntryError(out_of_range(field.word, figure, mode.name, field.low * factor, field.high * factor))


def _doubled(name: str, mode: Mode) -> float:
    """Return the factor between an entered X and the stored radius.

    Wear is always a diameter, because it is measured on the part. The control's mode may be radius between
    two parts.
    """
    return 2.0 if name == "wear_x" or (name == "x" and mode.diameter) else 1.0


def shown_value(name: str, value: Value, mode: Mode) -> str:
    """Return a field value as text for the operator."""
    field = TOOL_FIELDS[name]
    if field.choices:
        return choice_word(str(value))
    if field.sort is Sort.FLAG:
        words = (tr("MASTER"), "") if name == "master" else (tr("YES"), tr("NO"))
        return words[0] if value else words[1]
    if isinstance(value, str) or field.sort is Sort.WHOLE:
        return str(value)
    if field.sort is Sort.ANGLE:
        return f"{value:g}°"
    mm = value * _doubled(name, mode)
    return signed(mm, mode.metric) if field.low < 0.0 else formats.length(mm, mode.metric)


def marked(name: str, mode: Mode) -> str:
    """Return Ø or R for a field that is an X value, else an empty text."""
    if name not in {"x", "wear_x"}:
        return ""
    return "Ø" if _doubled(name, mode) > 1.0 else "R"


def word(name: str) -> str:
    """Return the translated name of a field."""
    words = {
        "x": tr("X"),
        "z": tr("Z"),
        "nose_radius": tr("NOSE RADIUS"),
        "quadrant": tr("TIP"),
        "wear_x": tr("WEAR X"),
        "wear_z": tr("WEAR Z"),
        "remark": tr("REMARK"),
        "master": tr("MASTER"),
        "kind": tr("KIND"),
        "hand": tr("HAND"),
        "insert": tr("INSERT"),
        "holder": tr("HOLDER"),
        "width": tr("WIDTH"),
        "diameter": tr("DIAMETER"),
        "point": tr("POINT ANGLE"),
        "stick_out": tr("STICK-OUT"),
        "length": tr("CUTTING LENGTH"),
        "pitch": tr("PITCH"),
        "flutes": tr("FLUTES"),
        "entry": tr("ENTERING ANGLE"),
        "rear": tr("CUTS ON X− SIDE"),
        "profile": tr("PROFILE"),
    }
    return words[name]


def choice_word(value: str) -> str:
    """Return the translated name of a tool kind or hand."""
    words = {
        "turning": tr("TURNING"),
        "boring": tr("BORING"),
        "grooving": tr("GROOVING"),
        "parting": tr("PARTING"),
        "threading": tr("THREADING"),
        "drill": tr("DRILL"),
        "centre-drill": tr("CENTER DRILL"),
        "reamer": tr("REAMER"),
        "tap": tr("TAP"),
        "end-mill": tr("END MILL"),
        "form": tr("FORM TOOL"),
        "right": tr("RIGHT HAND"),
        "left": tr("LEFT HAND"),
        "neutral": tr("NEUTRAL"),
    }
    return words.get(value, value)


def heading(name: str, mode: Mode) -> str:
    """Return the translated name of a field, with Ø or R for an X value."""
    mark = marked(name, mode)
    return f"{word(name)} {mark}" if mark else word(name)
