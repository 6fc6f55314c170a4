"""Points on the surfaces of a part, one pixel apart, for drawing a rotated part.

The part is divided into columns along Z and into rays around its axis. A wall is an inner or outer surface,
with one point per ray and column. A face is the exposed side of a column whose next column has less
material. A flank is the exposed side of a slot or a flat, where the next ray has less material. Faces and
flanks are filled with points. The points are cached until the part or the scale changes. Rotating them only
requires multiplication by sines and cosines.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.polar_field import PolarField, sort_intervals
from core.part.ray_cuts import FloatArray

Float32Array = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.intp]
CellIndices = tuple[IntArray, IntArray]

MISSING_RADIUS = np.float32(-1e6)
"""Radius of a missing point, in pixels. The point is outside every picture."""

_SLOPE = 2.0  # slope between columns below which a step is a cone or an arc and not a shoulder
_GAP = 0.4  # pixels; a larger step along Z is a face
_NEAR_PX = 6.0  # pixels; neighboring rays that are further apart do not form one surface
_LARGE_RADIUS = np.float32(1e6)
_SPREAD = 3  # columns and rays over which the direction of a wall is measured
_SAMPLED_RAYS = 90  # rays used to find the radius of a bore
_MAX_SUBDIVISION = 4  # largest number of interpolated rays per ray


class Solid(NamedTuple):
    """A solid as intervals of r in columns along Z and on rays; a turned part has only one ray.

    ``column_edges`` (columns + 1,) are the Z positions of the column edges. ``inner_radii`` and
    ``outer_radii`` (layers, columns, rays) are the limits of the material along r.
    """

    column_edges: FloatArray
    inner_radii: FloatArray
    outer_radii: FloatArray

    @property
    def max_radius_mm(self) -> float:
        """Return the greatest radius in mm."""
        return float(self.outer_radii.max(initial=0.0))


def make_milled_solid(part: PolarField) -> Solid:
    """Return the solid of a milled part."""
    return Solid(part.column_edges, part.inner_radii, part.outer_radii)


def make_turned_solid(column_edges: FloatArray, inner_radii: FloatArray, outer_radii: FloatArray) -> Solid:
    """Return the solid of a half section with ``inner_radii`` and ``outer_radii`` (layers, columns)."""
    inner_radii, outer_radii = sort_intervals(inner_radii, outer_radii)
    return Solid(column_edges, inner_radii[:, :, None], outer_radii[:, :, None])


class SurfacePatch(NamedTuple):
    """Surface points of faces and flanks, which are not on the walls along rays, with their normals.

    ``z_px`` and ``radius_px`` are Z and r in pixels. The normals are given along r, the polar angle and Z.
    ``half_ray_numbers`` (n,) are the angular positions in half steps between rays. They are None if the
    points are rings with a point at every ray. ``is_rough`` means that the wall crosses columns and rays,
    so that its normals vary from point to point.
    """

    z_px: Float32Array
    radius_px: Float32Array
    half_ray_numbers: IntArray | None
    normal_r: Float32Array
    normal_angle: Float32Array
    normal_z: Float32Array
    is_rough: npt.NDArray[np.bool_]


class LayerWall(NamedTuple):
    """The inner or outer side of one layer of a solid, as radii (columns, rays) in pixels.

    - ``columns`` are the columns of the surface to which the wall belongs.
    - ``faces_axis`` means that the wall faces the axis.
    - ``bore_radius_px`` (columns,) is the usual bore radius. It is specified only for the innermost wall.
    - ``is_complete`` means that no point is missing.
    - ``is_sloped`` is a mask of the columns whose radius changes along Z.
    - ``max_slope_rad`` is the greatest angle in radians between a normal and the radius.
    """

    columns: IntArray
    radius_px: Float32Array
    faces_axis: bool
    is_sloped: npt.NDArray[np.bool_]
    max_slope_rad: float
    is_complete: bool
    bore_radius_px: Float32Array | None


class SolidSurface:
    """The surface points of a solid at a given scale, with Z measured from ``center_z``.

    ``face_direction`` is 1 or -1 if the visible faces point toward Z+ or Z-, or 0 if no faces are visible.
    """

    def __init__(
        self, solid: Solid, scale: float, center_z: float, z_range: tuple[float, float], face_direction: int
    ) -> None:
        back = max(z_range[0], float(solid.column_edges[0]))
        front = max(min(z_range[1], float(solid.column_edges[-1])), back)
        count = max(math.ceil((front - back) * scale), 1)
        at = np.linspace(back, front, 2 * count + 1)[1::2]
        self.z_px = ((at - center_z) * scale).astype(np.float32)
        self.column_step_px = max((front - back) / count * scale, 1e-6)  # pixels
        self.is_turned = solid.inner_radii.shape[2] == 1
        self.ray_count = _count_rays(solid, scale)
        times = 1
        if not self.is_turned:
            times = min(max(math.ceil(self.ray_count / solid.inner_radii.shape[2]), 1), _MAX_SUBDIVISION)
            self.ray_count = solid.inner_radii.shape[2] * times
        layers = [_sample_layer(solid, layer, at, scale, times) for layer in range(len(solid.inner_radii))]
        self.inner_radii, self.outer_radii = [low for low, _ in layers], [high for _, high in layers]
        self.ray_angles = np.arange(self.ray_count) * (2.0 * math.pi / self.ray_count)
        self.max_radius_px = max(float(high.max()) for high in self.outer_radii)
        self.thickness_px = self.outer_radii[0] - self.inner_radii[0]
        for low, high in layers[1:]:
            self.thickness_px += high - low
        self.walls = [wall for number, both in enumerate(layers) for wall in self._walls(number, *both)]
        self.faces = self._make_faces(face_direction, solid, (back, front)) if face_direction else None
        self.flanks = None if self.is_turned else self._make_flanks()

    def _walls(self, layer: int, low: Float32Array, high: Float32Array) -> list[LayerWall]:
        metal = high > low
        found = []
        for r, inside in ((high, False), (low, True)):
            there = metal & (r > 0.0)
            columns = np.flatnonzero(there.any(axis=1))
            if len(columns):
                kept = np.where(there[columns], r[columns], MISSING_RADIUS)
                whole = bool((kept > 0.0).all())
                leaning, lean = self._leaning(columns, kept)
                bore = None
                if inside and not layer:
                    bore = np.median(kept[:, :: max(kept.shape[1] // _SAMPLED_RAYS, 1)], axis=1).astype(
                        np.float32
                    )
                found.append(LayerWall(columns, kept, inside, leaning, lean, whole, bore))
        return found

    def _leaning(self, columns: IntArray, r: Float32Array) -> tuple[npt.NDArray[np.bool_], float]:
        rise = np.abs(np.diff(r, axis=0))
        slanted = ((rise > 0.01) & (rise <= _GAP + 0.01)).any(axis=1) | (np.diff(columns) > 1)
        leaning = np.zeros(len(columns), np.bool_)
        leaning[1:] |= slanted
        leaning[:-1] |= slanted
        if self.is_turned:
            return leaning, 0.0
        turn = np.abs(np.diff(r[:, :: max(self.ray_count // 720, 1)], axis=1))
        steady = np.where(turn < 2.0, turn, 0.0) / np.maximum(r[:, : turn.shape[1]], 4.0)
        return leaning, math.atan(float(steady.max(initial=0.0)) * 720.0 / (2.0 * math.pi))

    def _make_faces(self, face_direction: int, solid: Solid, drawn: tuple[float, float]) -> SurfacePatch:
        """Return the exposed face of each column, where the next column has less material.

        No face is made at the edge of the picture, because the part does not end there.
        """
        cell_pair = _differing_cells(self.inner_radii, self.outer_radii, _GAP, round_=False)
        own, other = cell_pair if face_direction > 0 else cell_pair[::-1]
        nth, first, last = _uncovered_cells(self.inner_radii, self.outer_radii, own, other, _GAP)
        column, ray = own[0][nth], own[1][nth]
        inner = len(column)
        ends = (drawn[0] <= float(solid.column_edges[0]), drawn[1] >= float(solid.column_edges[-1]))
        if ends[face_direction > 0]:
            at = len(self.z_px) - 1 if face_direction > 0 else 0
            whole = _column_material(self.inner_radii, self.outer_radii, at)
            column = np.concatenate((column, np.full(len(whole[0]), at)))
            ray = np.concatenate((ray, whole[0]))
            first, last = np.concatenate((first, whole[1])), np.concatenate((last, whole[2]))
        index, r = _fill_points(first, last)
        slope = (last - first) / np.float32(self.column_step_px)
        across = (1.0 / np.sqrt(1.0 + slope * slope)).astype(np.float32)
        across[first <= self.inner_radii[0][column, ray]] *= -1.0
        along = face_direction * slope * np.abs(across)
        across[inner:], along[inner:] = 0.0, face_direction
        rough = ~self._is_straight(column, ray, round_=False)
        rough[inner:] = False
        return SurfacePatch(
            self.z_px[column[index]] + np.float32(0.5 * face_direction * self.column_step_px),
            r,
            None if self.is_turned else 2 * ray[index],
            across[index],
            np.zeros_like(r),
            along[index],
            rough[index],
        )

    def _is_straight(self, column: IntArray, ray: IntArray, *, round_: bool) -> npt.NDArray[np.bool_]:
        """Return a mask of the cells at which a step in thickness continues unchanged on both sides.

        The step is followed across columns if ``round_`` is True, or across rays otherwise.
        """
        own = self._thickness_step(column, ray, round_=round_)
        limit, thick = 0.5 * np.abs(own), self.thickness_px[column, ray]
        straight = np.ones(len(column), np.bool_)
        if self.is_turned:
            return straight
        for off in (-_SPREAD, _SPREAD):
            if round_:
                at = np.clip(column + off, 0, len(self.z_px) - 1), ray
            else:
                at = column, (ray + off) % self.ray_count
            straight &= np.abs(self._thickness_step(*at, round_=round_) - own) <= limit
            straight &= np.abs(self.thickness_px[at] - thick) <= limit
        return straight

    def _thickness_step(self, column: IntArray, ray: IntArray, *, round_: bool) -> Float32Array:
        """Return the change of the material thickness between the two neighbors of a cell."""
        if round_:
            return self.thickness_px[column, (ray + 1) % self.ray_count] - self.thickness_px[column, ray - 1]
        ahead, previous = np.minimum(column + 1, len(self.z_px) - 1), np.maximum(column - 1, 0)
        return self.thickness_px[ahead, ray] - self.thickness_px[previous, ray]

    def _make_flanks(self) -> SurfacePatch:
        """Return the exposed flank of each ray, where the next ray on either side has less material."""
        here, there = _differing_cells(self.inner_radii, self.outer_radii, 1.0, round_=True)
        one, other = self._flank(here, there, 1), self._flank(there, here, -1)
        return SurfacePatch(
            np.concatenate((one.z_px, other.z_px)),
            np.concatenate((one.radius_px, other.radius_px)),
            np.concatenate((_halves(one), _halves(other))),
            np.concatenate((one.normal_r, other.normal_r)),
            np.concatenate((one.normal_angle, other.normal_angle)),
            np.concatenate((one.normal_z, other.normal_z)),
            np.concatenate((one.is_rough, other.is_rough)),
        )

    def _flank(self, own: CellIndices, other: CellIndices, side: int) -> SurfacePatch:
        nth, first, last = _uncovered_cells(self.inner_radii, self.outer_radii, own, other, 1.0)
        column, ray = own[0][nth], own[1][nth]
        index, r = _fill_points(first, last)
        ring = np.float32(math.pi / self.ray_count) * (first + last)
        rest = (last - first) / np.hypot(ring, last - first)
        across = np.sqrt(np.maximum(np.float32(1.0) - rest * rest, np.float32(0.0)))
        rough = ~self._is_straight(column, ray, round_=True)
        halves = (2 * ray[index] + side) % (2 * self.ray_count)
        parts = across[index], (side * rest)[index], np.zeros_like(r), rough[index]
        return SurfacePatch(self.z_px[column[index]], r, halves, *parts)


def _halves(patch: SurfacePatch) -> IntArray:
    assert patch.half_ray_numbers is not None
    return patch.half_ray_numbers


def _count_rays(solid: Solid, scale: float) -> int:
    """Return the number of rays that are one pixel apart at the greatest radius."""
    return max(math.ceil(2.0 * math.pi * solid.max_radius_mm * scale), 90)


def _sample_layer(
    solid: Solid, layer: int, at: FloatArray, scale: float, times: int
) -> tuple[Float32Array, Float32Array]:
    """Return the inner and outer radii of a layer at given Z, with ``times`` times as many rays.

    The radii are in pixels, and the Z positions ``at`` are in mm. The radii are 0 where material is
    missing. They are interpolated along Z, except at shoulders.
    """
    own, neighbor, share, limit = _neighbor_columns(solid.column_edges, at, scale)
    shape = len(at), solid.inner_radii.shape[2] * times
    filled = (
        np.flatnonzero((solid.outer_radii[layer] > solid.inner_radii[layer]).any(axis=1))
        if layer
        else np.arange(1)
    )
    rows = (
        np.flatnonzero((own >= filled[0]) & (own <= filled[-1]))
        if layer and len(filled)
        else np.arange(len(at))
    )
    if not len(filled) or not len(rows):
        return np.zeros(shape, np.float32), np.zeros(shape, np.float32)
    low, high = (
        r[layer].astype(np.float32) * np.float32(scale) for r in (solid.inner_radii, solid.outer_radii)
    )
    there = high > low
    low *= there
    high *= there
    own, neighbor, share, limit = own[rows], neighbor[rows], share[rows], limit[rows]
    both = there[own] & there[neighbor]
    found = []
    for r in (low, high):
        full = np.zeros(shape, np.float32) if layer else np.empty(shape, np.float32)
        full[rows[0] : rows[-1] + 1] = _interpolate_rays(
            _mixed(r, own, neighbor, share, limit, both), there[own], times
        )
        found.append(full)
    return found[0], found[1]


def _neighbor_columns(
    edges: FloatArray, at: FloatArray, scale: float
) -> tuple[IntArray, IntArray, Float32Array, Float32Array]:
    """Return the column at each Z, its nearest neighbor, the neighbor's weight and the step limit.

    A difference in radius above the step limit, in pixels, is treated as a shoulder.
    """
    middles = 0.5 * (edges[1:] + edges[:-1])
    own = np.clip(np.searchsorted(edges, at, side="right") - 1, 0, len(middles) - 1)
    neighbor = np.clip(own + np.where(at > middles[own], 1, -1), 0, len(middles) - 1)
    apart = np.abs(middles[neighbor] - middles[own])
    share = np.abs(at - middles[own]) / np.maximum(apart, 1e-12) * (apart > 0.0)
    return (
        own,
        neighbor,
        share.astype(np.float32)[:, None],
        (_SLOPE * apart * scale).astype(np.float32)[:, None],
    )


def _mixed(
    r: Float32Array,
    own: IntArray,
    neighbor: IntArray,
    share: Float32Array,
    limit: Float32Array,
    both: npt.NDArray[np.bool_],
) -> Float32Array:
    mine = r[own]
    change = r[neighbor]
    change -= mine
    change *= both
    change *= np.abs(change) <= limit
    change *= share
    mine += change
    return mine


def _interpolate_rays(r: Float32Array, there: npt.NDArray[np.bool_], times: int) -> Float32Array:
    """Return the radii with interpolated rays inserted where neighboring rays form one surface."""
    if times == 1:
        return r
    change = np.roll(r, -1, axis=1)
    change -= r
    change *= there & np.roll(there, -1, axis=1)
    change *= np.abs(change) <= _NEAR_PX
    fine = np.empty((*r.shape, times), np.float32)
    for nth in range(times):
        fine[..., nth] = r + change * np.float32(nth / times)
    return fine.reshape(len(r), -1)


def _differing_cells(
    low: list[Float32Array], high: list[Float32Array], min_difference: float, *, round_: bool
) -> tuple[CellIndices, CellIndices]:
    """Return the pairs of adjacent cells whose radii differ by over ``min_difference`` pixels.

    The first result contains the first cell of each pair. The second result contains the next cell along Z,
    or the next cell around the part if ``round_`` is True.
    """
    differs = np.zeros(low[0].shape, np.bool_)
    change = np.zeros(low[0].shape, np.float32)
    for number, r in enumerate((*low, *high)):
        if number % len(low) and not r.any():
            continue
        if round_:
            np.subtract(r[:, 1:], r[:, :-1], out=change[:, :-1])
            np.subtract(r[:, 0], r[:, -1], out=change[:, -1])
        else:
            np.subtract(r[1:], r[:-1], out=change[:-1])
        differs |= np.abs(change) > min_difference
    column, ray = np.nonzero(differs)
    return (column, ray), ((column, (ray + 1) % low[0].shape[1]) if round_ else (column + 1, ray))


def _uncovered_cells(
    low: list[Float32Array], high: list[Float32Array], own: CellIndices, other: CellIndices, min_length: float
) -> tuple[IntArray, Float32Array, Float32Array]:
    """Return the material sections of the ``own`` cells that the ``other`` cells do not cover.

    The results are the index of the cell in ``own``, the inner radius and the outer radius of each section,
    with the radii in pixels. Sections of up to ``min_length`` pixels are omitted.
    """
    deep = np.zeros(len(own[0]), np.bool_)
    for r in high[1:]:
        if r.any():
            deep |= (r[own] > 0.0) | (r[other] > 0.0)
    found = [_free_in(low[:1], high[:1], own, other, np.flatnonzero(~deep), min_length)]
    if deep.any():
        found.append(_free_in(low, high, own, other, np.flatnonzero(deep), min_length))
    nth, first, last = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return nth.astype(np.intp), first, last


def _free_in(
    low: list[Float32Array],
    high: list[Float32Array],
    own: CellIndices,
    other: CellIndices,
    some: IntArray,
    least: float,
) -> tuple[IntArray, Float32Array, Float32Array]:
    one, two = (own[0][some], own[1][some]), (other[0][some], other[1][some])
    mine = np.stack([r[one] for r in low]), np.stack([r[one] for r in high])
    other_intervals = np.stack([r[two] for r in low]), np.stack([r[two] for r in high])
    if len(low) > 1:
        mine, other_intervals = sort_intervals(*mine), sort_intervals(*other_intervals)
    nth, first, last = _subtract_intervals(*mine, *other_intervals, least)
    return some[nth], first, last


def _subtract_intervals(
    low: Float32Array, high: Float32Array, other_low: Float32Array, other_high: Float32Array, least: float
) -> tuple[IntArray, Float32Array, Float32Array]:
    """Return the parts of intervals (layers, n) that the other intervals do not cover.

    Each part is given by its index, start and end.
    """
    found: list[tuple[IntArray, Float32Array, Float32Array]] = []
    there = other_high > other_low
    for layer in range(len(low)):
        floor = np.zeros(low.shape[1], np.float32)
        for gap in range(len(low) + 1):
            open_end = gap == len(low)
            top = _LARGE_RADIUS if open_end else np.where(there[gap], other_low[gap], _LARGE_RADIUS)
            first, end = np.maximum(low[layer], floor), np.minimum(high[layer], top)
            nth = np.flatnonzero(end - first > least)
            found.append((nth, first[nth], end[nth]))
            if not open_end:
                floor = np.where(there[gap], other_high[gap], _LARGE_RADIUS)
    parts = [np.concatenate(each) for each in zip(*found, strict=True)]
    return parts[0], parts[1], parts[2]


def _column_material(
    low: list[Float32Array], high: list[Float32Array], at: int
) -> tuple[IntArray, Float32Array, Float32Array]:
    """Return the ray numbers, inner radii and outer radii of the material of one column."""
    found = [(np.flatnonzero(b[at] > a[at]), a[at], b[at]) for a, b in zip(low, high, strict=True)]
    parts = [np.concatenate(each) for each in zip(*((n, a[n], b[n]) for n, a, b in found), strict=True)]
    return parts[0], parts[1], parts[2]


def _fill_points(first: Float32Array, last: Float32Array) -> tuple[IntArray, Float32Array]:
    """Return the indices and radii of points one pixel apart from ``first`` to ``last`` (n,)."""
    count = np.maximum(np.ceil(last - first), 1.0).astype(np.intp)
    index = np.repeat(np.arange(len(first)), count)
    start = np.cumsum(count) - count
    nth = np.arange(len(index)) - start[index]
    share = ((nth + 0.5) / count[index]).astype(np.float32)
    return index, first[index] + share * (last - first)[index]
