"""Detection of drawings in a wrong unit, which are too large or unusually small."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from core.message import Message

if TYPE_CHECKING:
    from core.extras.drawings.contour_tracing import ElementGroup

UNIT_SIZES_MM = {"MM": 1.0, "INCH": 25.4}
"""Units that a user can choose, each with its length in mm."""
_SMALL_DIAMETER_MM, _SMALL_LENGTH_MM = 2.0, 6.0


class WrongUnit(NamedTuple):
    """A size that suggests a wrong unit, and the unit in which the contour has a usual size.

    ``is_too_large`` is False if the contour is unusually small.
    """

    size: str
    unit_name: str
    is_too_large: bool = True


def detect_wrong_unit(group: ElementGroup, unit_mm: float, travel: tuple[float, float]) -> WrongUnit | None:
    """Return the size that suggests a wrong unit, or None if the unit is plausible.

    ``unit_mm`` is the size of the drawing's unit in mm. ``travel`` is the travel of X (as a radius) and Z
    in mm, or 0 if unknown. A contour is too large if it exceeds the travel, and too small if it is less than
    2 mm in diameter and 6 mm long. In both cases it must fit in another unit.
    """
    low, high, radius = group.extent_mm
    if not all(travel):
        return None
    if not _fits(high - low, radius, travel):
        smaller = sorted(((mm, name) for name, mm in UNIT_SIZES_MM.items() if mm < unit_mm), reverse=True)
        for mm, name in smaller:
            if _fits((high - low) * mm / unit_mm, radius * mm / unit_mm, travel):
                return WrongUnit(_format_size(high - low, radius, unit_mm, travel[1]), name)
        return None
    inch = UNIT_SIZES_MM["INCH"] / unit_mm
    is_small = high - low < _SMALL_LENGTH_MM and 2.0 * radius < _SMALL_DIAMETER_MM
    if is_small and inch > 1.0 and _fits((high - low) * inch, radius * inch, travel):
        size = _format_size(high - low, radius, unit_mm, math.inf)  # the diameter
        return WrongUnit(size, "INCH", is_too_large=False)
    return None


def _fits(long: float, radius: float, travel: tuple[float, float]) -> bool:
    return radius <= travel[0] and long <= travel[1]


def _format_size(long: float, radius: float, unit: float, most: float) -> str:
    size, template = (long, "{size} {unit} long") if long > most else (2.0 * radius, "{size} {unit} across")
    mm, name = (25.4, "in") if unit == UNIT_SIZES_MM["INCH"] else (1.0, "mm")
    return Message(template, size=f"{size / mm:.4g}", unit=name)
