"""Drawing of an analysis, with lines and labeled points in internal units."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class AnalysisDrawing:
    """Drawing of an analysis in one or two plots.

    ``command_points`` (n, 2) is the commanded curve. ``curves`` belong to the first plot, and
    ``lower_curves`` belong to the second plot. ``has_equal_axes`` means that both axes are lengths with the
    same scale. ``labeled_points`` are points with labels. ``axis_labels`` are the labels of the vertical
    axis, the vertical axis of the second plot, and the horizontal axis. In a label, {unit} is replaced by
    the unit of length.
    """

    command_points: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    curves: tuple[FloatArray, ...] = ()
    lower_curves: tuple[FloatArray, ...] = ()
    labeled_points: tuple[tuple[float, float, str], ...] = ()
    has_equal_axes: bool = True
    is_length: bool = True  # the vertical axis is a length
    is_lower_length: bool = False  # the vertical axis of the second plot is a length
    axis_labels: tuple[str, str, str] = ("", "", "")

    @property
    def is_inverted(self) -> bool:
        """Return whether the vertical axis points down, as X of a lathe does for the operator."""
        return self.has_equal_axes and self.axis_labels[0].startswith("X")
