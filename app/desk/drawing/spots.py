"""Points that one measures from, and the words of measuring."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from app.desk.words import tr


class Kind(IntEnum):
    """What a point is; of two in one place the first is told."""

    END = 0
    CENTRE = 1
    CROSSING = 2
    FREE = 3  # anywhere


class Spot(NamedTuple):
    """A point of a trail."""

    z: float
    x: float
    kind: Kind = Kind.FREE


def kind_words(kind: Kind) -> str:
    """What the cursor stands on."""
    return {
        Kind.END: tr("END"),
        Kind.CENTRE: tr("CENTRE"),
        Kind.CROSSING: tr("CROSSING"),
        Kind.FREE: tr("FREE"),
    }[kind]


def measuring_words() -> str:
    """The prompt line while one measures."""
    return tr("ARROWS: NEXT POINT   TAB: ALONG THE PATH   RETURN: HOLD, AND MEASURE FROM THERE   ESC: BACK")
