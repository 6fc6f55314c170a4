"""One field of a tool as it is typed and as it is shown: unit, diameter, range."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from math import remainder

from app.desk import formats
from app.desk.arithmetic import EntryError, value_of
from app.desk.formats import MINUS, MM_PER_INCH, fixed
from app.desk.translation import tr
from core.store.offset_fields import FIELDS, Field, Sort
from core.store.store_rows import Kind, Row, SecondaryRow, ToolRow, Value
from core.store.zero_offset_table import ZeroChange, ZeroRow, reach

# --- How offsets are written: inch with 5 places, metric with 4, always with their sign.


@dataclass(frozen=True, slots=True)
class Mode:
    """The control's unit and whether X is a diameter, from one snapshot."""

    metric: bool = False
    diameter: bool = False

    @property
    def unit(self) -> float:
        """Millimetres in one unit of an entry."""
        return 1.0 if self.metric else MM_PER_INCH

    @property
    def name(self) -> str:
        """The unit in words."""
        return "mm" if self.metric else "in"


def not_set() -> str:
    """What stands for an offset that nobody has entered."""
    return tr("not set")


def signed(mm: float, metric: bool) -> str:
    """A length with its sign, also a plus: an offset without one reads like a dimension."""
    figure = formats.length(mm, metric)
    return figure if figure.startswith(MINUS) else f"+{figure}"


def row(number: int, offset: SecondaryRow, metric: bool) -> str:
    """One row of the secondary offsets as the control writes it; X as the radius that is stored."""
    x, z, r = offset
    return f"{number}  X: {signed(x, metric)} Z: {signed(z, metric)}R: {formats.length(r, metric)}"


def in_words(offset: Row | None, mode: Mode) -> str:
    """An offset in one line: a tool's X as the control has it, a secondary one's as the radius stored."""
    if offset is None:
        return not_set()
    if isinstance(offset, ToolRow):
        return f"{_pair(offset.x, offset.z, mode.metric, mode.diameter)}{_more(offset, mode)}"
    x, z, r = offset
    return f"X {signed(x, mode.metric)}  Z {signed(z, mode.metric)}  R {formats.length(r, mode.metric)}"


def _pair(x: float, z: float, metric: bool, diameter: bool) -> str:
    mark = "Ø" if diameter else ""
    return f"X{mark} {signed(2 * x if diameter else x, metric)}  Z {signed(z, metric)}"


def _more(tool: ToolRow, mode: Mode) -> str:
    """What else there is of a tool, as far as it is anything."""
    parts = [f"  R {formats.length(tool.nose_radius, mode.metric)}"]
    if tool.wear_x or tool.wear_z:
        parts.append(f"  {tr('WEAR')} {_pair(tool.wear_x, tool.wear_z, mode.metric, True)}")
    if tool.quadrant:
        parts.append(f"  {tr('TIP')} {tool.quadrant}")
    if tool.master:
        parts.append(f"  {tr('MASTER')}")
    return "".join(parts) + (f"  {tool.remark}" if tool.remark else "")


def to_mm(value: float, metric: bool) -> float:
    """A typed length in mm; rounded in its own unit, so that it comes back as it was entered."""
    return round(value, 10) * (1.0 if metric else MM_PER_INCH)


def added(mm: float, value: float, metric: bool) -> float:
    """``mm`` and a typed correction: summed in the unit of the entry, so that .0005 ten times is .005."""
    unit = 1.0 if metric else MM_PER_INCH
    return round(mm / unit + value, 10) * unit


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


# --- How G54 to G59 are typed and written: mm and degrees with three places, always with their sign.


PLACES = 3


def zero_typed(code: int, name: str, text: str) -> float:
    """What a field becomes by a typed text: mm, degrees for ``c``. Raises EntryError with the reason."""
    return checked(code, name, value_of(text))


def zero_touched(code: int, name: str, at: float, text: str) -> float:
    """What a field becomes so that the machine position ``at`` reads as was typed, 0 where nothing was.

    Whole turns of C say nothing and are left out. Raises EntryError.
    """
    value = at - (value_of(text) if text.strip() else 0.0)
    return checked(code, name, remainder(value, 360.0) if name == "c" else value)


def checked(code: int, name: str, value: float) -> float:
    """The value, where it is one that is kept. Raises EntryError."""
    most = reach(name)
    if abs(value) <= most:
        return round(value, 10)
    unit = tr("degrees") if name == "c" else tr("mm")
    zero_change_in_words = tr("{name} would become {value} {unit}; it may be {low}…{high}")
    field, low, high = f"G{code} {name.upper()}", f"-{most:g}", f"{most:g}"
    raise EntryError(
        zero_change_in_words.format(name=field, value=shown_zero(value), unit=unit, low=low, high=high)
    )


def shown_zero(value: float) -> str:
    """A value with its sign, also a plus: an offset without one reads like a dimension."""
    figure = fixed(value, PLACES)
    return figure if value < 0 and figure[:1] not in "0123456789" else f"+{figure}"


def zero_in_words(row: ZeroRow | None) -> str:
    """An offset in one line."""
    if row is None:
        return tr("not set")
    return f"X {shown_zero(row.x)}  Z {shown_zero(row.z)}  C {shown_zero(row.c)}"


def zero_change_in_words(change: ZeroChange) -> tuple[str, str, str, str]:
    """Of one change: when (local time), which offset, from → to, why and by whom."""
    at = datetime.fromisoformat(change.at).astimezone().strftime("%Y-%m-%d %H:%M:%S")
    who = "" if change.who == "operator" else f" ({change.who})"
    return (
        at,
        f"G{change.code}",
        f"{zero_in_words(change.old)}  →  {zero_in_words(change.new)}",
        f"{change.why}{who}",
    )
