"""Where two pictures of one program differ most: a thousandth is not seen at any usual scale."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.desk.drawing.trail import SAME, Stroke, Trail


class Apart(NamedTuple):
    """The greatest way between a point that is cut and the same point of the other picture; mm, there."""

    distance: float
    z: float
    x: float


def farthest(before: Trail, after: Trail) -> Apart | None:
    """Point by point; None where the pictures are not of the same points: then no point has a partner."""
    if len(before.z) != len(after.z) or not np.array_equal(before.stroke, after.stroke):
        return None
    cut = np.flatnonzero(after.stroke >= Stroke.TURN)
    if not len(cut):
        return None
    way = np.hypot(after.z[cut] - before.z[cut], after.x[cut] - before.x[cut])
    at = int(np.argmax(way))
    distance = float(way[at]) if way[at] > SAME else 0.0
    return Apart(distance, float(after.z[cut[at]]), float(after.x[cut[at]]))
