"""What a block does to all axes of a machine, where that is more than X, Z and C of a lathe."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.geometry.plane_arcs import HelixMove
from core.geometry.rotary_axes import PivotMove
from core.geometry.virtual_mill import PlaneMove

FloatArray = npt.NDArray[np.float64]


CurvedMove = HelixMove | PivotMove | PlaneMove
"""A way on which the axes do not run in proportion, unless it is ``straight`` after all.

All tell ``length`` (what the feed counts: mm, or ``in_degrees`` where rotary axes are meant), ``machine``
positions (k, axes) at fractions (k,) from 0 to 1, without a jump, where the tool is on the ``part`` (k, 3) at
machine positions, and the fraction ``nearest`` to where the axes turn most for the way.
"""


@dataclass(frozen=True, slots=True)
class Travel:
    """From ``start`` to ``end``: machine positions of all axes in the machine's order, slides first; mm and
    degrees, rotary axes counted on without a jump. ``length`` is what the feed counts: mm, or degrees where
    only rotary axes turn. ``way`` where the axes do not run in proportion; its length is ``length``.
    ``slides`` tells whether any slide is meant to move.
    """

    start: tuple[float, ...]
    end: tuple[float, ...]
    length: float
    way: CurvedMove | None = None
    slides: bool = True

    def reach(self) -> tuple[FloatArray, FloatArray]:
        """Least and greatest position of each axis (axes,) all along, the start left out of straight ways."""
        if self.way is None:
            return np.array(self.end), np.array(self.end)
        points = self.way.machine(np.linspace(0.0, 1.0, _SAMPLES))
        return points.min(axis=0), points.max(axis=0)


_SAMPLES = 65
