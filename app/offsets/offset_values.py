"""Input and display formats of offsets: unit, diameter, range and sign.

Values in inches have 5 decimals, and values in mm have 4. Zero offsets have 3 decimals in mm and degrees.
Stored values are in mm and degrees, with X as a radius.
"""

from __future__ import annotations

from dataclasses import dataclass

from app.desk.arithmetic import InvalidEntryError, evaluate_expression
from app.desk.status import formats
from app.desk.status.formats import MINUS_SIGN, MM_PER_INCH
from app.desk.translation import tr
from core.message import Message
from core.store.store_rows import (
    FIELDS_BY_KIND,
    FieldType,
    FieldValue,
    MillToolRow,
    OffsetKind,
    OffsetRow,
    PresetRow,
    RowField,
    SecondaryOffsetRow,
    ToolOffsetRow,
    ToolShapeRow,
    ZeroOffsetRow,
)

TOOL_FIELDS = {
    **FIELDS_BY_KIND[OffsetKind.TOOL],
    **FIELDS_BY_KIND[OffsetKind.SHAPE],
}  # Fields of a tool's offset and of its shape.
ZERO_OFFSET_DECIMALS = 3


@dataclass(frozen=True, slots=True)
class UnitMode:
    """Length unit of the control, and whether X values are diameters, at one point in time."""

    is_metric: bool = False
    is_diameter: bool = False

    @property
    def unit_length_mm(self) -> float:
        """Return the length of 1 inch (25.4) or 1 mm (1.0) in millimeters, as selected on the control."""
        return 1.0 if self.is_metric else MM_PER_INCH

    @property
    def name(self) -> str:
        """Return the abbreviation of the length unit, mm or in."""
        return "mm" if self.is_metric else "in"


UNKNOWN_VALUE = "?"  # Replaces a value that could not be read.


def describe_missing_offset(*, is_unreadable: bool = False) -> str:
    """Return the text "not set" for an offset that was never entered.

    If ``is_unreadable`` is true, return the text "unreadable" instead.
    """
    return tr("unreadable") if is_unreadable else tr("not set")


def format_signed_length(mm: float, is_metric: bool) -> str:
    """Return a length in mm as text with a plus or minus sign.

    The plus sign distinguishes an offset from a dimension.
    """
    figure = formats.format_length(mm, is_metric)
    return figure if figure.startswith(MINUS_SIGN) else f"+{figure}"


def format_zero_offset(value: float) -> str:
    """Return a zero offset in mm or degrees as text with a sign."""
    figure = formats.format_fixed(value, ZERO_OFFSET_DECIMALS)
    return figure if value < 0 and figure[:1] not in "0123456789" else f"+{figure}"


def convert_to_mm(value: float, is_metric: bool) -> float:
    """Return an entered length in mm.

    The length is first rounded in the unit of the entry, so that it is later displayed as it was entered.
    """
    return round(value, 10) * (1.0 if is_metric else MM_PER_INCH)


def add_correction(mm: float, value: float, is_metric: bool) -> float:
    """Return ``mm`` plus an entered correction, in mm.

    The sum is rounded in the unit of the entry, so that adding .0005 ten times gives .005.
    """
    unit = 1.0 if is_metric else MM_PER_INCH
    return round(mm / unit + value, 10) * unit


def describe_range_error(field: str, value: str, unit: str, low: float, high: float) -> str:
    """Return the message that a field would be out of range, in the given unit."""
    text = tr("{field} would become {value} {unit}; allowed range is {low}…{high}")
    return tr(Message(text, field=field, value=value, unit=unit, low=f"{low:g}", high=f"{high:g}"))


# =


def format_offset(offset: OffsetRow | None, mode: UnitMode) -> str:
    """Return the values of an offset as one line of text.

    X of a tool offset is a diameter or a radius, as on the control. The wear in X is a diameter. All other
    X values are radii.
    """
    if offset is None:
        return describe_missing_offset()
    if isinstance(offset, ToolOffsetRow):
        return (
            f"{_pair(offset.x, offset.z, mode.is_metric, mode.is_diameter)}"
            f"{_format_more_fields(offset, mode)}"
        )
    if isinstance(offset, SecondaryOffsetRow):
        x, z, r = offset
        return (
            f"X {format_signed_length(x, mode.is_metric)}  Z {format_signed_length(z, mode.is_metric)}  R "
            f"{formats.format_length(r, mode.is_metric)}"
        )
    if isinstance(offset, ToolShapeRow):
        return _format_shape(offset, mode)
    if isinstance(offset, ZeroOffsetRow):
        both = zip("XZC", offset, strict=True)
        return "  ".join(f"{name} {format_zero_offset(value)}" for name, value in both)
    return format_specified_fields(offset)


def format_specified_fields(row: MillToolRow | PresetRow) -> str:
    """Return the specified fields of a mill tool or preset as text, with the control's field names."""
    fields = FIELDS_BY_KIND[OffsetKind.MILL_TOOL if isinstance(row, MillToolRow) else OffsetKind.PRESET]
    values: tuple[FieldValue, ...] = tuple(row)
    field_texts = [
        field.label if field.field_type is FieldType.BOOLEAN else f"{field.label} {format_cell(field, value)}"
        for field, value in zip(fields.values(), values, strict=True)
        if value or field.name in {"x", "y", "z", "rotation"}
    ]
    return "  ".join(field_texts) or formats.NO_VALUE


def format_cell(field: RowField, value: FieldValue) -> str:
    """Return a value of a milling tool table or preset table as text, in mm, degrees or minutes."""
    if isinstance(value, str):
        return value
    if field.field_type is FieldType.BOOLEAN:
        return field.label if value else formats.NO_VALUE
    if field.field_type in {FieldType.INTEGER, FieldType.MINUTES}:
        return f"{value:g}"
    return (
        format_zero_offset(value) if field.minimum < 0 else formats.format_fixed(value, ZERO_OFFSET_DECIMALS)
    )


def _pair(x: float, z: float, metric: bool, diameter: bool) -> str:
    mark = "Ø" if diameter else ""
    return (
        f"X{mark} {format_signed_length(2 * x if diameter else x, metric)}  Z "
        f"{format_signed_length(z, metric)}"
    )


def _format_more_fields(tool: ToolOffsetRow, mode: UnitMode) -> str:
    """Return the text of a tool's remaining fields that have a value."""
    parts = [f"  R {formats.format_length(tool.nose_radius, mode.is_metric)}"]
    if tool.wear_x or tool.wear_z:
        parts.append(f"  {tr('WEAR')} {_pair(tool.wear_x, tool.wear_z, mode.is_metric, True)}")
    if tool.quadrant:
        parts.append(f"  {tr('TIP')} {tool.quadrant}")
    if tool.master:
        parts.append(f"  {tr('MASTER')}")
    return "".join(parts) + (f"  {tool.remark}" if tool.remark else "")


def _format_shape(shape: ToolShapeRow, mode: UnitMode) -> str:
    """Return the kind and hand of a tool shape and its specified values as text."""
    stated = [
        f"{translate_field_name(name)} {format_value(name, value, mode)}"
        for name, value in shape._asdict().items()
        if value and not TOOL_FIELDS[name].choices
    ]
    return "  ".join([translate_choice(shape.kind), translate_choice(shape.hand), *stated])


def format_offset_change(old: OffsetRow | None, new: OffsetRow | None, mode: UnitMode) -> str:
    """Return the change from the old to the new offset as text.

    For a tool that already had an offset, the text contains only the changed fields.
    """
    if not (isinstance(old, ToolOffsetRow | ToolShapeRow) and isinstance(new, ToolOffsetRow | ToolShapeRow)):
        return f"{format_offset(old, mode)}  →  {format_offset(new, mode)}"
    changed = [name for name in old._fields if getattr(old, name) != getattr(new, name)]
    return "   ".join(
        f"{translate_field_name(name)} {_in_change(name, old, mode)} → {_in_change(name, new, mode)}"
        for name in changed
    )


def _in_change(name: str, row: ToolOffsetRow | ToolShapeRow, mode: UnitMode) -> str:
    if TOOL_FIELDS[name].field_type is FieldType.BOOLEAN:
        return tr("yes") if getattr(row, name) else tr("no")
    return format_value(name, getattr(row, name), mode) or tr("none")


# --- a field of a tool -----------------------------------------------------------------------------------


def parse_field_value(field_name: str, text: str, mode: UnitMode) -> FieldValue:
    """Return the field value for an entered text, with lengths in mm.

    Raise InvalidEntryError with the reason if the text is invalid.
    """
    field = TOOL_FIELDS[field_name]
    if field.field_type is FieldType.TEXT:
        value: FieldValue = text.strip()
    elif field.field_type is FieldType.BOOLEAN and text in {"yes", "no"}:
        value = text == "yes"
    elif field.field_type is FieldType.LENGTH:
        value = convert_to_mm(evaluate_expression(text) / _find_factor(field_name, mode), mode.is_metric)
    else:
        number = evaluate_expression(text)
        value = int(number) if number.is_integer() else number
    return _taken(field, value, mode)


def parse_field_increment(field_name: str, old_row: ToolOffsetRow, text: str, mode: UnitMode) -> FieldValue:
    """Return the field's current length plus the entered increment, in mm.

    Raise InvalidEntryError with the reason if the text is invalid.
    """
    field, before = TOOL_FIELDS[field_name], getattr(old_row, field_name)
    if field.field_type is not FieldType.LENGTH:
        raise InvalidEntryError(
            tr(
                Message(
                    "{field} does not accept an added value; press Enter to set the value", field=field.label
                )
            )
        )
    return _taken(
        field,
        add_correction(before, evaluate_expression(text) / _find_factor(field_name, mode), mode.is_metric),
        mode,
    )


def _taken(field: RowField, value: FieldValue, mode: UnitMode) -> FieldValue:
    if field.is_valid_value(value):
        return value
    if field.field_type is not FieldType.LENGTH:
        raise InvalidEntryError(
            tr(Message("{field} must be {range}", field=field.label, range=field.range_text))
        )
    factor = _find_factor(field.name, mode) / mode.unit_length_mm
    figure = format_value(field.name, value, mode)
    raise InvalidEntryError(
        describe_range_error(field.label, figure, mode.name, field.minimum * factor, field.maximum * factor)
    )


def _find_factor(name: str, mode: UnitMode) -> float:
    """Return the divisor that converts an entered X (diameter or radius) to the stored radius.

    Wear is always a diameter, because it is measured on the part and the control's diameter mode can change
    between two parts.
    """
    return 2.0 if name == "wear_x" or (name == "x" and mode.is_diameter) else 1.0


def format_value(field_name: str, value: FieldValue, mode: UnitMode) -> str:
    """Return a field value as text for the operator."""
    field = TOOL_FIELDS[field_name]
    if field.choices:
        return translate_choice(str(value))
    if field.field_type is FieldType.BOOLEAN:
        words = (tr("MASTER"), "") if field_name == "master" else (tr("YES"), tr("NO"))
        return words[0] if value else words[1]
    if isinstance(value, str) or field.field_type is FieldType.INTEGER:
        return str(value)
    if field.field_type is FieldType.ANGLE:
        return f"{value:g}°"
    mm = value * _find_factor(field_name, mode)
    return (
        format_signed_length(mm, mode.is_metric)
        if field.minimum < 0.0
        else formats.format_length(mm, mode.is_metric)
    )


def find_x_symbol(field_name: str, mode: UnitMode) -> str:
    """Return "Ø" or "R" for a field that is an X value, or an empty string for other fields."""
    if field_name not in {"x", "wear_x"}:
        return ""
    return "Ø" if _find_factor(field_name, mode) > 1.0 else "R"


def translate_field_name(field_name: str) -> str:
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
    return words[field_name]


def translate_choice(value: str) -> str:
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


def make_field_heading(field_name: str, mode: UnitMode) -> str:
    """Return the translated name of a field, with Ø or R for an X value."""
    mark = find_x_symbol(field_name, mode)
    return f"{translate_field_name(field_name)} {mark}" if mark else translate_field_name(field_name)
