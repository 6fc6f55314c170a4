"""Whether a nose on its way to a contour, or off it, cuts into what it comes to; for every language."""

from __future__ import annotations

from collections.abc import Iterable

from core.geometry.contour_offset import NEARER
from core.geometry.intersections import clearance
from core.geometry.lines_and_arcs import SAME_POINT, Element

# An approach of one nose radius along the first move itself passes its start at .71 of the radius.
_BESIDE = 0.5


def cuts_in(way: Element, contour: Iterable[Element], radius: float) -> bool:
    """Whether the centre of a nose of ``radius`` comes too near to the contour, its nearest element first.

    Next to the contour's end it always comes nearer than R where it does not come square; there _BESIDE of R
    is asked.
    """
    if way.length < SAME_POINT:
        return False
    far = 0.0
    for element in contour:
        least = radius * _BESIDE if far < 2 * radius else radius - NEARER
        far += element.length
        if clearance(way, element) < least - SAME_POINT:
            return True
    return False
