"""How offsets are written: inch with 5 places, metric with 4, always with their sign."""

from __future__ import annotations

from dataclasses import dataclass

from app.desk import formats
from app.desk.formats import MINUS, MM_PER_INCH
from app.desk.words import tr
from core.store.rows import Row, SecondaryRow, ToolRow


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
