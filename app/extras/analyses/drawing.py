"""Drawing of an analysis: lines and marks in internal units."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """Drawing with the command ``soft`` (n, 2), the ``curves``, and the curves ``below`` of a second plot.

    ``equal`` means that both axes are lengths with one scale. ``marks`` are points with labels. ``names`` are
    the labels of the vertical axis, the second vertical axis and the horizontal axis. In a label, {unit} is
    replaced by the unit of length.
    """

    soft: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    curves: tuple[FloatArray, ...] = ()
    below: tuple[FloatArray, ...] = ()
    marks: tuple[tuple[float, float, str], ...] = ()
    equal: bool = True
    lengths: bool = True  # the vertical axis is a length
    lengths_below: bool = False  # the vertical axis of the second plot is a length
    names: tuple[str, str, str] = ("", "", "")

    @property
    def downwards(self) -> bool:
        """Whether the vertical axis points down, as X of a lathe does for the operator."""
        return self.equal and self.names[0].startswith("X")
