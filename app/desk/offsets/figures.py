"""How offsets are written: inch with 5 places, metric with 4, always with their sign."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime

from app.desk import formats
from app.desk.formats import MINUS, MM_PER_INCH
from core.store.rows import Change

Triple = tuple[float, float, float]
NOT_SET = "not set"
Figures = Callable[[Triple | None, bool], str]


def signed(mm: float, metric: bool) -> str:
    """A length with its sign, also a plus: an offset without one reads like a dimension."""
    figure = formats.length(mm, metric)
    return figure if figure.startswith(MINUS) else f"+{figure}"


def row(number: int, offset: Triple, metric: bool) -> str:
    """One row of the secondary offsets as the control writes it; X as the radius that is stored."""
    x, z, r = offset
    return f"{number}  X: {signed(x, metric)} Z: {signed(z, metric)}R: {formats.length(r, metric)}"


def triple(offset: Triple | None, metric: bool, diameter: bool = False) -> str:
    """X, Z and R in words; ``diameter``: X doubled, as a control in G72 shows it."""
    if offset is None:
        return NOT_SET
    x, z, r = offset
    mark = "Ø" if diameter else ""
    return (
        f"X{mark} {signed(2 * x if diameter else x, metric)}  Z {signed(z, metric)}"
        f"  R {formats.length(r, metric)}"
    )


def to_mm(value: float, metric: bool) -> float:
    """A typed length in mm; rounded in its own unit, so that it comes back as it was entered."""
    return round(value, 10) * (1.0 if metric else MM_PER_INCH)


def added(mm: float, value: float, metric: bool) -> float:
    """``mm`` and a typed correction: summed in the unit of the entry, so that .0005 ten times is .005."""
    unit = 1.0 if metric else MM_PER_INCH
    return round(mm / unit + value, 10) * unit


def told(change: Change, letter: str, metric: bool, diameter: bool) -> tuple[str, str, str, str]:
    """Of one change: when (local time), which offset, from → to, why and by whom."""
    at = datetime.fromisoformat(change.at).astimezone().strftime("%Y-%m-%d %H:%M:%S")
    was, now = (triple(side, metric, diameter) for side in (change.old, change.new))
    who = "" if change.who == "operator" else f" ({change.who})"
    return at, f"{letter}{change.number}", f"{was}  →  {now}", f"{change.why}{who}"
