"""What a block does to all axes of a machine, where that is more than X, Z and C of a lathe."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


class CurvedMove(Protocol):
    """A way on which the axes do not run in proportion; fractions of it run from 0 to 1."""

    @property
    def length(self) -> float:
        """What the feed counts, mm; degrees where only rotary axes are meant."""
        ...

    @property
    def straight(self) -> bool:
        """Whether the axes run in proportion after all."""
        ...

    def machine(self, share: FloatArray) -> FloatArray:
        """Machine positions (k, axes) at fractions (k,), without a jump."""
        ...

    def part(self, points: FloatArray) -> FloatArray:
        """Where the tool is on the part (k, 3), mm, at machine positions (k, axes)."""
        ...

    def nearest(self) -> float:
        """Fraction at which the axes turn most for the way, so that it is looked at for sure."""
        ...


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
