"""One field of a tool as it is typed and as it is shown: unit, diameter, range."""

from __future__ import annotations

from app.desk import formats
from app.desk.arithmetic import EntryError, value_of
from app.desk.offsets.figures import Mode, added, signed, to_mm
from app.desk.words import tr
from core.store.fields import FIELDS, Field, Sort
from core.store.rows import Kind, ToolRow, Value

TOOL_FIELDS = FIELDS[Kind.TOOL]


def value_typed(name: str, text: str, mode: Mode) -> Value:
    """What a field becomes by a typed text, mm. Raises EntryError with the reason."""
    field = TOOL_FIELDS[name]
    if field.sort is Sort.TEXT:
        value: Value = text.strip()
    elif field.sort is Sort.LENGTH:
        value = to_mm(value_of(text) / _doubled(name, mode), mode.metric)
    else:
        number = value_of(text)
        value = int(number) if number.is_integer() else number
    return _taken(field, value, mode)


def value_added(name: str, old: ToolRow, text: str, mode: Mode) -> Value:
    """What a length becomes when the text is added to it, mm. Raises EntryError with the reason."""
    field, before = TOOL_FIELDS[name], getattr(old, name)
    if field.sort is not Sort.LENGTH:
        raise EntryError(tr("{field} takes no sum; press Return to set it").format(field=field.word))
    return _taken(field, added(before, value_of(text) / _doubled(name, mode), mode.metric), mode)


def _taken(field: Field, value: Value, mode: Mode) -> Value:
    if field.takes(value):
        return value
    if field.sort is not Sort.LENGTH:
        raise EntryError(tr("{field} takes {range}").format(field=field.word, range=field.range))
    factor = _doubled(field.name, mode) / mode.unit
    text = tr("{field} would become {value} {unit}; it may be {low}…{high}")
    raise EntryError(
        text.format(
            field=field.word,
            value=shown_value(field.name, value, mode),
            unit=mode.name,
            low=f"{field.low * factor:g}",
            high=f"{field.high * factor:g}",
        )
    )


def _doubled(name: str, mode: Mode) -> float:
    """What a typed X is more than the radius that is kept.

    Wear comes from measured diameters, and between two parts the control is back in radius: it is always Ø.
    """
    return 2.0 if name == "wear_x" or (name == "x" and mode.diameter) else 1.0


def shown_value(name: str, value: Value, mode: Mode) -> str:
    """A field as the operator reads it."""
    field = TOOL_FIELDS[name]
    if field.sort is Sort.FLAG:
        return tr("MASTER") if value else ""
    if field.sort is not Sort.LENGTH or isinstance(value, str):
        return str(value)
    mm = value * _doubled(name, mode)
    return formats.length(mm, mode.metric) if name == "nose_radius" else signed(mm, mode.metric)


def marked(name: str, mode: Mode) -> str:
    """Ø or R where a field is an X, nothing elsewhere."""
    if name not in {"x", "wear_x"}:
        return ""
    return "Ø" if _doubled(name, mode) > 1.0 else "R"


def word(name: str) -> str:
    """What the screen calls a field."""
    words = {
        "x": tr("X"),
        "z": tr("Z"),
        "nose_radius": tr("NOSE RADIUS"),
        "quadrant": tr("TIP"),
        "wear_x": tr("WEAR X"),
        "wear_z": tr("WEAR Z"),
        "remark": tr("REMARK"),
        "master": tr("MASTER"),
    }
    return words[name]
