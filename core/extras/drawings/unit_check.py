"""Detection of drawings in a wrong unit, which exceed the travel but would fit in another unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from core.message import Message

if TYPE_CHECKING:
    from core.extras.drawings.contour_tracing import ElementGroup

UNIT_SIZES_MM = {"MM": 1.0, "INCH": 25.4}
"""Units that a user can choose, each with its length in mm."""


def detect_wrong_unit(
    group: ElementGroup, unit_mm: float, travel: tuple[float, float]
) -> tuple[str, str] | None:
    """Return the size that exceeds the travel, and a smaller unit in which the contour would fit.

    ``unit_mm`` is the size of the drawing's unit in mm. ``travel`` is the travel of X (as a radius) and Z
    in mm, or 0 if unknown. The result is None if the contour fits, or if it does not fit in any smaller
    unit.
    """
    low, high, radius = group.extent_mm
    if not all(travel) or _fits(high - low, radius, travel):
        return None
    smaller = sorted(((mm, name) for name, mm in UNIT_SIZES_MM.items() if mm < unit_mm), reverse=True)
    for mm, name in smaller:
        if _fits((high - low) * mm / unit_mm, radius * mm / unit_mm, travel):
            return _too_large(high - low, radius, unit_mm, travel[1]), name
    return None


def _fits(long: float, radius: float, travel: tuple[float, float]) -> bool:
    return radius <= travel[0] and long <= travel[1]


def _too_large(long: float, radius: float, unit: float, most: float) -> str:
    size, template = (long, "{size} {unit} long") if long > most else (2.0 * radius, "{size} {unit} across")
    mm, name = (25.4, "in") if unit == UNIT_SIZES_MM["INCH"] else (1.0, "mm")
    return Message(template, size=f"{size / mm:.4g}", unit=name)
