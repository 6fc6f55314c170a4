"""How G54 to G59 are typed and written: mm and degrees with three places, always with their sign."""

from __future__ import annotations

from datetime import datetime
from math import remainder

from app.desk.arithmetic import EntryError, value_of
from app.desk.formats import fixed
from app.desk.words import tr
from core.store.zero import ZeroChange, ZeroRow, reach

PLACES = 3


def entered(code: int, name: str, text: str) -> float:
    """What a field becomes by a typed text: mm, degrees for ``c``. Raises EntryError with the reason."""
    return checked(code, name, value_of(text))


def touched(code: int, name: str, at: float, text: str) -> float:
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
    told = tr("{name} would become {value} {unit}; it may be {low}…{high}")
    field, low, high = f"G{code} {name.upper()}", f"-{most:g}", f"{most:g}"
    raise EntryError(told.format(name=field, value=shown(value), unit=unit, low=low, high=high))


def shown(value: float) -> str:
    """A value with its sign, also a plus: an offset without one reads like a dimension."""
    figure = fixed(value, PLACES)
    return figure if value < 0 and figure[:1] not in "0123456789" else f"+{figure}"


def in_words(row: ZeroRow | None) -> str:
    """An offset in one line."""
    if row is None:
        return tr("not set")
    return f"X {shown(row.x)}  Z {shown(row.z)}  C {shown(row.c)}"


def told(change: ZeroChange) -> tuple[str, str, str, str]:
    """Of one change: when (local time), which offset, from → to, why and by whom."""
    at = datetime.fromisoformat(change.at).astimezone().strftime("%Y-%m-%d %H:%M:%S")
    who = "" if change.who == "operator" else f" ({change.who})"
    return at, f"G{change.code}", f"{in_words(change.old)}  →  {in_words(change.new)}", f"{change.why}{who}"
