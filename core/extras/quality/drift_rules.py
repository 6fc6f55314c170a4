"""Rules that tell drift on a control chart: Western Electric (1956), Nelson (1984), in Nelson's numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.extras.quality.control_charts import Chart

Zones = npt.NDArray[np.float64]


class Finding(NamedTuple):
    """A rule that is broken: at which point (from 0, the last of its run), which rule, and in words."""

    point: int
    rule: int
    words: str


def findings(chart: Chart) -> tuple[Finding, ...]:
    """What the rules find, point by point; nothing where the points do not scatter."""
    if chart.sigma <= 0.0 or not len(chart.points):
        return ()
    zones = (chart.points - chart.centre) / chart.sigma
    found = [
        Finding(point, number, words) for number, (words, rule) in RULES.items() for point in rule(zones)
    ]
    return tuple(sorted(found))


def _beyond(zones: Zones) -> Iterator[int]:
    yield from (int(at) for at in np.nonzero(np.abs(zones) > 3.0)[0])


def _runs(zones: Zones, length: int, whole: Callable[[Zones], bool]) -> Iterator[int]:
    """The last point of each stretch of ``length`` points of which ``whole`` is true."""
    for end in range(length, len(zones) + 1):
        if whole(zones[end - length : end]):
            yield end - 1


def _one_side(zones: Zones) -> bool:
    return bool((zones > 0.0).all() or (zones < 0.0).all())


def _steady(zones: Zones) -> bool:
    steps = np.diff(zones)
    return bool((steps > 0.0).all() or (steps < 0.0).all())


def _alternating(zones: Zones) -> bool:
    steps = np.diff(zones)
    return bool((steps[1:] * steps[:-1] < 0.0).all())


def _so_many(zones: Zones, count: int, beyond: float) -> bool:
    """The last point and others, ``count`` together, lie beyond so many sigmas on its side."""
    side = 1.0 if zones[-1] > 0.0 else -1.0
    far = zones * side > beyond
    return bool(far[-1] and far.sum() >= count)


RULES: dict[int, tuple[str, Callable[[Zones], Iterator[int]]]] = {
    1: ("one point beyond a control limit", _beyond),
    2: ("nine points in a row on one side of the center line", lambda z: _runs(z, 9, _one_side)),
    3: ("six points in a row rising or falling", lambda z: _runs(z, 6, _steady)),
    4: ("fourteen points in a row alternating up and down", lambda z: _runs(z, 14, _alternating)),
    5: (
        "two of three points beyond two sigma on one side",
        lambda z: _runs(z, 3, lambda s: _so_many(s, 2, 2.0)),
    ),
    6: (
        "four of five points beyond one sigma on one side",
        lambda z: _runs(z, 5, lambda s: _so_many(s, 4, 1.0)),
    ),
    7: (
        "fifteen points in a row within one sigma",
        lambda z: _runs(z, 15, lambda s: bool((np.abs(s) < 1.0).all())),
    ),
    8: (
        "eight points in a row beyond one sigma",
        lambda z: _runs(z, 8, lambda s: bool((np.abs(s) > 1.0).all())),
    ),
}
"""By Nelson's number: in words, and the points at which it is broken. 1, 5, 6 are Western Electric's too."""
