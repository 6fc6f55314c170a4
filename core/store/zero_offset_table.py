"""Zero offsets by the names under which the desk still asks for them."""

from __future__ import annotations

from typing import NamedTuple

from core.store.offset_fields import FIELDS
from core.store.store_rows import ZERO_CODES, Change, Kind, ZeroRow

__all__ = ["ZERO_CODES", "ZERO_FIELDS", "ZeroChange", "ZeroRow", "reach", "zero_change"]
ZERO_FIELDS = tuple(FIELDS[Kind.ZERO])


class ZeroChange(NamedTuple):
    """One offset's change: its row before and after, None where it was not set. Ids give the order."""

    id: int
    step: int
    undoes: int | None
    at: str
    code: int
    old: ZeroRow | None
    new: ZeroRow | None
    why: str
    who: str


def zero_change(change: Change) -> ZeroChange:
    """The same change."""
    i, step, undoes, at, _kind, code, old, new, why, who = change
    assert not old or isinstance(old, ZeroRow)
    assert not new or isinstance(new, ZeroRow)
    return ZeroChange(i, step, undoes, at, code, old, new, why, who)


def reach(field: str) -> float:
    """How large a value of this field may be: mm, or degrees for ``c``."""
    return FIELDS[Kind.ZERO][field].high
