"""What of a turned contour the nose of the tool gets to: fillets and nicks smaller than it are passed by.

G41 and G42 are refused where the radius of the nose does not fit in. The contour that a ball of this radius
touches from outside is the contour moved off by the radius, what it cannot reach left out, and moved back.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.extras.drawings.contour_walk import turned_about
from core.geometry.contour_offset import GougeError, TrimError, pieces_beside, trimmed_offset
from core.geometry.lines_and_arcs import Arc, Element

_SPARE = 0.02  # mm: a fillet of just the nose radius leaves its centre no way, least of all in rounded words
_BACK = 0.001  # mm: moved back by less than off, so that a corner outwards keeps a length
_SLIVER = 0.03  # mm
_STRAIGHT = 0.1  # rad: what is left out lies within .0015 mm


def reached_by_nose(elements: Sequence[Element], nose: float, *, inside: bool) -> tuple[Element, ...]:
    """The contour as it is where a nose of this radius (mm) follows it, else with fillets that it fits into.

    Where no unbroken way along it is left the contour stays, and the proof of the program tells the place.
    """
    contour = tuple(turned_about(elements)) if inside else tuple(elements)
    if not nose or _follows(contour, nose):
        return tuple(elements)
    try:
        off = trimmed_offset(contour, nose + _SPARE)
        back = trimmed_offset(_reversed(off), nose + _SPARE - _BACK)
    except TrimError:
        return tuple(elements)
    reached = list(_without_slivers(_reversed(back)))
    return tuple(turned_about(reached)) if inside else tuple(reached)


def _without_slivers(contour: Sequence[Element]) -> Iterator[Element]:
    """Without arcs so short that rounded words say nothing of them; the next begins where the last ended."""
    for number, each in enumerate(contour):
        short = isinstance(each, Arc) and each.length < _SLIVER and abs(each.sweep) < _STRAIGHT
        if not short or number in {0, len(contour) - 1}:
            yield each


def _reversed(elements: Sequence[Element]) -> list[Element]:
    return [each.reversed() for each in reversed(elements)]


def _follows(contour: Sequence[Element], nose: float) -> bool:
    """Whether nose compensation takes the contour, by the same offset that the control makes."""
    try:
        pieces_beside(contour, nose)
    except GougeError:
        return False
    return True
