"""Drawing of an analysis, with lines and labeled points. Lengths are in mm."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from app.desk.translation import tr

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class AnalysisDrawing:
    """Drawing of an analysis in one or two plots.

    - ``commanded_points`` (n, 2) is the commanded curve.
    - ``upper_curves`` are in the first plot, and ``lower_curves`` are in the second plot.
    - ``has_equal_axes`` means that both axes are lengths with the same scale.
    - ``axis_labels`` are for the vertical axis, the second vertical axis, and the horizontal axis.
    - ``labeled_points`` are points with labels. In a label, {unit} is replaced by the unit of length.
    """

    commanded_points: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    upper_curves: tuple[FloatArray, ...] = ()
    lower_curves: tuple[FloatArray, ...] = ()
    labeled_points: tuple[tuple[float, float, str], ...] = ()
    has_equal_axes: bool = True
    has_upper_length_axis: bool = True  # the vertical axis is a length
    has_lower_length_axis: bool = False  # the vertical axis of the second plot is a length
    axis_labels: tuple[str, str, str] = ("", "", "")

    @property
    def is_vertical_axis_inverted(self) -> bool:
        """Return whether the vertical axis points down, as the operator sees the X axis of a lathe."""
        return self.has_equal_axes and self.axis_labels[0].startswith("X")


def scale_drawing(drawing: AnalysisDrawing, factor: float) -> AnalysisDrawing:
    """Return the drawing converted to another unit of length.

    If the axes share a scale, both are multiplied by ``factor``. Otherwise only those vertical axes that
    are lengths are multiplied.
    """
    by = np.array(
        [factor if drawing.has_equal_axes else 1.0, factor if drawing.has_upper_length_axis else 1.0]
    )
    marks = tuple((x * by[0], y * by[1], word) for x, y, word in drawing.labeled_points)
    curves = tuple(each * by for each in drawing.upper_curves)
    below = (
        tuple(each * by for each in drawing.lower_curves)
        if drawing.has_lower_length_axis
        else drawing.lower_curves
    )
    unit = "mm" if factor == 1.0 else tr("in")
    upper, lower, across = (each.replace("{unit}", unit) for each in drawing.axis_labels)
    soft, names = drawing.commanded_points * by, (upper, lower, across)
    return replace(
        drawing,
        commanded_points=soft,
        upper_curves=curves,
        labeled_points=marks,
        lower_curves=below,
        axis_labels=names,
    )
