"""Brightness, color and direction of the surface at each pixel of a solid picture."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.picture.part_scene import SHADES
from core.part.picture.picture_edges import FACING_AWAY, CodeArray, PixelImages
from core.part.picture.point_projection import BoolArray, IndexArray, PointGroup, PointProjection
from core.part.picture.surface_points import Float32Array, IntArray, LayerWall, SolidSurface, SurfacePatch

ZSpans = tuple[tuple[float, float], ...]

_LIGHT = (-0.38, 0.62, 0.69)  # right, up, toward the viewer
_BISECTOR = (-0.207, 0.337, 0.919)  # halfway between light and viewer
_STEEP = 0.5  # cosine between a wall's normal and the radius, below which the wall is not round
_OUTSIDE, _BORE, _SECTION, _HIT = range(4)
AnyArray = npt.NDArray[np.floating]
Vectors = tuple[Float32Array, Float32Array, Float32Array]


class _LitPoints(NamedTuple):
    """Surface points (n,) with their brightness and color.

    ``right`` and ``above`` are the components of their normals in the picture. ``is_rough`` marks points
    whose normals vary from point to point.
    """

    brightness: Float32Array
    right: Float32Array
    above: Float32Array
    colors: CodeArray | int
    is_rough: BoolArray | bool


class PointLighting:
    """The light on the nearest points of a projection.

    ``hits`` are the ranges of Z that are drawn in the color of a collision.
    """

    def __init__(self, projection: PointProjection, hits: ZSpans) -> None:
        self.points, self.surface, self.view = projection, projection.surface, projection.view
        self._hits = hits

    def make_images(self) -> PixelImages:
        """Return the images of the color codes, the depths and the normals."""
        points = self.points
        pixel, point, depth = points.find_nearest_points()
        shape, count = depth.shape, len(point)
        shade, right, above = (np.zeros(count, np.float32) for _ in range(3))
        colour, rough = np.zeros(count, np.int16), np.zeros(count, np.bool_)
        bounds = np.array([group.first_point_index for group in points.groups[1:]], np.int64)
        which = np.searchsorted(bounds, point, side="right").astype(np.int16)
        order = np.argsort(which, kind="stable")
        ends = np.searchsorted(which[order], np.arange(len(points.groups)), side="right").tolist()
        for group, first, last in zip(points.groups, [0, *ends], ends, strict=False):
            own = order[first:last]
            if len(own):
                lit = self._light_points(group, point[own] - group.first_point_index)
                shade[own], right[own], above[own], colour[own], rough[own] = lit
        if rough.any():
            self._smooth(pixel, shade, rough)
        codes = np.full(depth.size, -1, np.int16)
        level = np.clip(shade * np.float32(SHADES), 0, SHADES - 1).astype(np.int16)
        codes[pixel] = np.where(shade < 0.0, FACING_AWAY, level + colour * SHADES)
        normals = []
        for component in (right, above):
            component[rough] = np.nan
            image = np.zeros(depth.size, np.float32)
            image[pixel] = component
            normals.append(image.reshape(shape))
        return PixelImages(codes.reshape(shape), depth, normals[0], normals[1])

    def _smooth(self, pixel: IndexArray, shade: Float32Array, rough: BoolArray) -> None:
        """Set the brightness of each rough point to the mean of the rough points within 5 × 5 pixels."""
        at, wide = pixel[rough], self.points.width
        light, count = (np.zeros(self.points.height * wide, np.float32) for _ in range(2))
        light[at], count[at] = np.maximum(shade[rough], 0.0), 1.0
        for step in (1, wide):
            light, count = (_sum_neighbors(values, step) for values in (light, count))
        shade[rough] = light[at] / count[at]

    def _light_points(self, group: PointGroup, index: IndexArray) -> _LitPoints:
        if group.layer_wall is not None:
            lit, z = self._light_wall(group, group.layer_wall, index)
        elif group.surface_patch is not None:
            lit, z = self._light_patch(group, group.surface_patch, index)
        else:
            assert group.z is not None
            lit, z = self._light_section(group.cut_face_angle, len(index)), group.z[index]
        if not self._hits:
            return lit
        at = z / self.view.pixels_per_mm + self.view.center_z_mm
        hit = np.any([(at >= low) & (at <= high) for low, high in self._hits], axis=0)
        return lit._replace(colors=np.where(hit, _HIT, lit.colors).astype(np.int16))

    def _light_wall(
        self, group: PointGroup, wall: LayerWall, index: IndexArray
    ) -> tuple[_LitPoints, Float32Array]:
        row, ray = np.divmod(index, group.ray_range.stop - group.ray_range.start)
        ray += group.ray_range.start
        if group.columns is not None:
            row = group.columns[row]
        across, tangential, along = _wall_normals(wall, row, ray, self.surface)
        if wall.faces_axis:
            across, tangential, along = -across, -tangential, -along
        colour: CodeArray | int = _OUTSIDE
        if wall.bore_radius_px is not None:  # a slot through the axis is not a bore
            r = wall.radius_px[row, 0 if self.surface.is_turned else ray]
            colour = np.where(np.abs(r - wall.bore_radius_px[row]) < 1.0, _BORE, _OUTSIDE).astype(np.int16)
        rough = False if self.surface.is_turned else np.abs(across) < _STEEP
        lit = self._light_normals(2 * ray, (across, tangential, along), colour, rough)
        return lit, self.surface.z_px[wall.columns[row]]

    def _light_patch(
        self, group: PointGroup, patch: SurfacePatch, index: IndexArray
    ) -> tuple[_LitPoints, Float32Array]:
        if patch.half_ray_numbers is None:
            index, ray = np.divmod(index, group.ray_range.stop - group.ray_range.start)
            halves = 2 * (ray + group.ray_range.start)
        else:
            halves = patch.half_ray_numbers[index]
        normals = patch.normal_r[index], patch.normal_angle[index], patch.normal_z[index]
        return self._light_normals(halves, normals, _OUTSIDE, patch.is_rough[index]), patch.z_px[index]

    def _light_section(self, edge: float, count: int) -> _LitPoints:
        phi, side = abs(edge), math.copysign(1.0, edge)
        towards, above = np.array([-side * math.sin(phi)]), np.array([side * math.cos(phi)])
        lit = self._light(towards.astype(np.float32), above.astype(np.float32), np.zeros(1, np.float32))
        shade, right, above = (np.repeat(each, count) for each in lit)
        return _LitPoints(np.maximum(shade, np.float32(0.5)), right, above, _SECTION, is_rough=False)

    def _light_normals(
        self, halves: IntArray, normals: Vectors, colors: CodeArray | int, is_rough: BoolArray | bool
    ) -> _LitPoints:
        """Return the light on surface normals that are given along r, the part's angle and Z.

        The direction of phi is opposite to the part's angle.
        """
        across, tangential, along = normals
        near, up = self.points.near[halves], self.points.up[halves]
        lit = self._light(across * near + tangential * up, across * up - tangential * near, along)
        return _LitPoints(*lit, colors, is_rough)

    def _light(self, towards: Float32Array, above: Float32Array, along: Float32Array) -> Vectors:
        """Return the brightness of surface normals, and their components to the right and up.

        The normals are given as components toward the viewer, up and along Z. The brightness is from 0 to
        1, or -1 for normals that point away.
        """
        cos, sin = self.points.cos, self.points.sin
        right = along * cos - towards * sin
        towards = along * sin + towards * cos
        return calculate_brightness(right, above, towards), right, above


def calculate_brightness(right: AnyArray, above: AnyArray, towards: AnyArray) -> Float32Array:
    """Return the brightness of surface normals from 0 to 1, or -1 for normals that point away.

    The normals are given as components to the right, up and toward the viewer.
    """
    lit = right * _LIGHT[0] + above * _LIGHT[1] + towards * _LIGHT[2]
    np.maximum(lit, 0.0, out=lit)
    glint = right * _BISECTOR[0] + above * _BISECTOR[1] + towards * _BISECTOR[2]
    np.maximum(glint, 0.0, out=glint)
    for _ in range(4):
        glint *= glint
    shade = np.asarray(0.14 + 0.44 * lit + 0.16 * towards + 0.28 * glint, np.float32)
    shade[towards < -0.05] = -1.0
    return shade


def _wall_normals(wall: LayerWall, row: IntArray, ray: IntArray, surface: SolidSurface) -> Vectors:
    """Return the surface normals of a wall along r, the angle and Z.

    Each normal is calculated from the neighbor with the smaller difference.
    """
    r, here, last = wall.radius_px, (0 if surface.is_turned else ray), len(wall.radius_px) - 1
    own = r[row, here]
    along = -_smoother(own - r[np.maximum(row - 1, 0), here], r[np.minimum(row + 1, last), here] - own)
    along = np.clip(along, -50.0, 50.0) / np.float32(surface.column_step_px)
    if surface.is_turned:
        size = 1.0 / np.sqrt(1.0 + along * along)
        return size, np.zeros_like(size), along * size
    before, next_radius = r[row, ray - 1], r[row, (ray + 1) % surface.ray_count]
    ring = np.maximum(own, np.float32(1e-3)) * np.float32(2.0 * math.pi / surface.ray_count)
    tangential = -np.clip(_smoother(own - before, next_radius - own), -50.0, 50.0) / ring
    size = 1.0 / np.sqrt(1.0 + along * along + tangential * tangential)
    return size, tangential * size, along * size


def _sum_neighbors(values: Float32Array, step: int) -> Float32Array:
    """Return the sum of each value and its two neighbors on either side, ``step`` apart."""
    total = values.copy()
    for off in (step, 2 * step):
        total[off:] += values[:-off]
        total[:-off] += values[off:]
    return total


def _smoother(before: Float32Array, next_change: Float32Array) -> Float32Array:
    return np.where(np.abs(before) < np.abs(next_change), before, next_change)
