"""Comparison of the proved part with its drawing.

It finds material that remains and cuts that are too deep.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.extras.drawings.drawing_placement import ContourProfile, ContourSide
from core.geometry.lines_and_arcs import Arc, Element

DEFAULT_TOLERANCE_MM = 0.02
"""Default tolerance of the radius, in mm.

Smaller differences come from the resolution of the control and the drawing.
"""
_STEP = 0.01  # mm along Z
_WALL = 0.02  # mm, permitted shift of a shoulder
_CHORD = 0.0005  # mm

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PartDeviation:
    """A deviation of the part from the drawing, in a range between two Z positions in mm.

    ``max_deviation_mm`` is the largest difference of the radius in mm; it is positive if material remains.
    """

    back_z_mm: float
    front_z_mm: float
    max_deviation_mm: float


@dataclass(frozen=True, slots=True)
class DrawingComparison:
    """Result of a comparison of a part with its drawing.

    ``worst_deviation_mm`` is the largest difference in mm that is still within the tolerance.
    ``deviations`` contains the deviations in order from the face.
    """

    worst_deviation_mm: float
    deviations: tuple[PartDeviation, ...]


def compare_part_with_drawing(
    profile: ContourProfile, part: Sequence[tuple[float, float]], tolerance: float = DEFAULT_TOLERANCE_MM
) -> DrawingComparison:
    """Compare one side of the part with the drawing's profile.

    ``part`` contains points (z, r) in order from the face. ``tolerance`` is in mm.
    """
    count = max(2, math.ceil((profile.front_z_mm - profile.back_z_mm) / _STEP))
    z = np.linspace(profile.back_z_mm + _WALL, profile.front_z_mm - _WALL, count)
    side = -1.0 if profile.side is ContourSide.INSIDE else 1.0
    low, high = _find_drawing_radii(profile.elements, z, side)
    made = _find_part_radii(part, z, side)
    off = np.where(made > high, made - high, np.where(made < low, made - low, 0.0))
    off[np.isnan(off)] = 0.0
    found = tuple(_spans(z, off, tolerance))
    within = np.abs(off[np.abs(off) <= tolerance])
    return DrawingComparison(float(within.max(initial=0.0)), found)


def _find_drawing_radii(
    elements: Iterable[Element], z: FloatArray, side: float
) -> tuple[FloatArray, FloatArray]:
    """Return the smallest and the largest radius of the outermost line of the drawing near each Z.

    At a shoulder these two radii differ.
    """
    fine = np.arange(z[0] - _WALL, z[-1] + _WALL + _STEP / 2.0, _STEP / 2.0)
    outer = np.full(fine.shape, np.nan)
    for each in elements:
        points = np.array(convert_element_to_points(each))
        order = np.argsort(points[:, 1])
        zs, rs = points[order, 1], side * points[order, 0]
        there = (fine >= zs[0] - 1e-9) & (fine <= zs[-1] + 1e-9)
        r = np.interp(fine[there], zs, rs)
        if zs[-1] - zs[0] < 1e-6:
            r = np.full(r.shape, rs.max())
        outer[there] = np.fmax(outer[there], r)
    reach = round(_WALL / (_STEP / 2.0))
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(outer, reach, mode="edge"), 2 * reach + 1)
    low, high = np.nanmin(windows, axis=1), np.nanmax(windows, axis=1)
    return np.interp(z, fine, low), np.interp(z, fine, high)


def convert_element_to_points(element: Element) -> list[tuple[float, float]]:
    """Convert an element to a polyline of points (r, z) with a chord error of at most 0.0005 mm."""
    if not isinstance(element, Arc):
        return [element.start, element.end]
    most = (
        2.0 * math.acos(max(0.0, 1.0 - _CHORD / element.radius)) if element.radius > _CHORD else math.pi / 2.0
    )
    count = max(2, math.ceil(abs(element.sweep_rad) / most))
    return [
        element.start,
        *(element.get_point(element.length * k / count) for k in range(1, count)),
        element.end,
    ]


def _find_part_radii(part: Sequence[tuple[float, float]], z: FloatArray, side: float) -> FloatArray:
    """Return the outermost radius of the part's polyline at each Z."""
    points = np.array(part, dtype=np.float64)[::-1]
    return np.interp(z, points[:, 0], side * points[:, 1], left=np.nan, right=np.nan)


def _spans(z: FloatArray, off: FloatArray, tolerance: float) -> Iterable[PartDeviation]:
    """Yield the deviations in order from the face, with adjacent deviations of the same sign joined."""
    kind = np.where(off > tolerance, 1, np.where(off < -tolerance, -1, 0))
    edges = np.flatnonzero(np.diff(kind)) + 1
    for part in reversed(np.split(np.arange(len(z)), edges)):
        if kind[part[0]]:
            worst = off[part][np.abs(off[part]).argmax()]
            yield PartDeviation(float(z[part[0]]), float(z[part[-1]]), float(worst))
