"""The solid picture of a part, drawn with numpy from surface points with lighting.

The nearest point is shown at each pixel. Drawing requires no graphics card and no Qt. The result is an
image of 0xAARRGGBB values, which both a graphics card and Qt can show. Normals are computed only for
visible pixels.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.part_scene import SHADES, ImageArray, PartColors, PartScene, make_color_table
from core.part.solid_bodies import DepthArray, ImageLayer, make_tool_layers
from core.part.solid_view import SolidView
from core.part.surface_points import (
    MISSING_RADIUS,
    Float32Array,
    IntArray,
    LayerWall,
    Solid,
    SolidSurface,
    SurfacePatch,
)

IndexArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]
CodeArray = npt.NDArray[np.int16]
ZSpans = tuple[tuple[float, float], ...]

_POINT = 26  # bits of a key for the number of the point; the depth is in the higher bits
_NUMBER = (1 << _POINT) - 1
_DEPTH = 32.0  # depth steps per pixel
_FAR = 1e5  # pixels; the greatest distance of a point from the middle of the part
_BLOCK = 1 << 15  # points processed together, so that the data fits into the CPU cache
_LIGHT = (-0.38, 0.62, 0.69)  # right, up, toward the viewer
_BISECTOR = (-0.207, 0.337, 0.919)  # halfway between light and viewer
_STEEP = 0.5  # cosine between a wall's normal and the radius, below which the wall is not round
_EDGE = 8.0  # pixels of depth
_FACING = 0.02  # radians beyond the horizon that are also drawn
_OUTSIDE, _BORE, _SECTION, _HIT = range(4)
_FACING_AWAY = -2  # used instead of a color


class _PointGroup(NamedTuple):
    """A group of surface points that are drawn together: a wall, a patch or a cut face.

    ``first_point_index`` is the index of the first point of the group.
    """

    first_point_index: int
    point_count: int
    layer_wall: LayerWall | None = None
    columns: IntArray | None = None
    ray_range: slice = slice(None)
    surface_patch: SurfacePatch | None = None
    cut_face_angle: float = 0.0  # phi of a cut face
    z: Float32Array | None = None


class SolidPicture:
    """A painter that draws a solid repeatedly.

    It caches the data that does not change from one picture to the next.
    """

    def __init__(self, colors: PartColors | None = None) -> None:
        self.colors = colors or PartColors()
        self._table = make_color_table(self.colors)
        self._surface: SolidSurface | None = None
        self._made_of: tuple[object, ...] = ()
        self._held: tuple[tuple[object, ...], ImageLayer] | None = None  # chuck or collet in the last view

    def draw_picture(
        self,
        solid: Solid,
        view: SolidView,
        width: int,
        height: int,
        *,
        version: int = 0,
        hit_z_spans: ZSpans = (),
        is_preview: bool = False,
        scene: PartScene = PartScene(),  # noqa: B008 - it is a tuple
    ) -> ImageArray:
        """Return the picture as an array (height, width).

        ``version`` changes when the material changes. ``hit_z_spans`` are ranges of Z that are drawn in
        red. ``is_preview`` draws blocks of two by two pixels in a third of the time, for a part that is
        being cut.
        """
        if is_preview:
            half, small = (
                replace(view, pixels_per_mm=0.5 * view.pixels_per_mm),
                (-(-width // 2), -(-height // 2)),
            )
            image = self.draw_picture(
                solid, half, *small, version=version, hit_z_spans=hit_z_spans, scene=scene
            )
            return image.repeat(2, axis=0).repeat(2, axis=1)[:height, :width]
        surface = self._kept(solid, view, width, version)
        image, depth = _PictureDrawing(surface, view, width, height).draw_image(
            self._table, self.colors.background, hit_z_spans
        )
        if scene.chuck is not None:
            self._draw_chuck(scene.chuck, view, width, height).draw_onto_image(image, depth)
        if scene.tool is not None:
            looks = (self.colors.holder, self.colors.insert)
            for layer in make_tool_layers(scene.tool, view, width, height, looks, _DEPTH, _FAR):
                layer.draw_onto_image(image, depth)
        return image

    def _draw_chuck(self, chuck: Solid, view: SolidView, width: int, height: int) -> ImageLayer:
        """Return the image layer of the chuck.

        The chuck is drawn again only if the view has changed.
        """
        seen = (id(chuck), replace(view, roll_deg=0.0), width, height)
        if self._held is None or self._held[0] != seen:
            painter = SolidPicture(self.colors._replace(outside=self.colors.chuck, section=self.colors.chuck))
            surface = painter._kept(chuck, view, width, 0)
            drawn = _PictureDrawing(surface, view, width, height).draw_image(painter._table, 0, ())
            self._held = seen, ImageLayer(*drawn)
        return self._held[1]

    def _kept(self, solid: Solid, view: SolidView, width: int, version: int) -> SolidSurface:
        cos, sin = view.azimuth_cos_sin
        towards = 0 if abs(sin) < 0.01 else int(math.copysign(1, sin))
        half = (0.5 * width / view.pixels_per_mm + solid.max_radius_mm * abs(sin)) / max(cos, 0.05)
        span = view.center_z_mm - half, view.center_z_mm + half
        made_of = (id(solid.column_edges), id(solid.outer_radii), version, view.pixels_per_mm, towards, span)
        if self._surface is None or made_of != self._made_of:
            self._surface = SolidSurface(solid, view.pixels_per_mm, view.center_z_mm, span, towards)
            self._made_of = made_of
        return self._surface


class _PictureDrawing:
    """One picture in progress: points are projected to pixels, and then the nearest points are lit."""

    def __init__(self, surface: SolidSurface, view: SolidView, width: int, height: int) -> None:
        self.surface, self.view, self.width, self.height = surface, view, width, height
        self.cos, self.sin = (np.float32(part) for part in view.azimuth_cos_sin)
        self.phi = view.convert_to_viewer_angles(surface.ray_angles)
        self.shown = ~view.is_cut_out(self.phi)
        # Patches also need the angles halfway between rays.
        phi = view.convert_to_viewer_angles(np.arange(2 * surface.ray_count) * (math.pi / surface.ray_count))
        self.near, self.up = np.cos(phi).astype(np.float32), np.sin(phi).astype(np.float32)
        self.halves_shown = None if view.cut_out_range_deg is None else ~view.is_cut_out(phi)
        self.nearest = np.zeros((height + 2) * (width + 2), np.int64)
        self.groups: list[_PointGroup] = []
        self._next = 0
        for wall in surface.walls:
            self._wall(wall)
        self._patches()
        self._sections()

    # --- conversion of points to pixels

    def _wall(self, wall: LayerWall) -> None:
        """Draw the visible points of a wall.

        Columns that slope along Z may be visible even where a cylinder would face away from the viewer.
        """
        if wall.faces_axis and not self._seen_inside():
            return
        off = math.pi - np.abs(self.phi) if wall.faces_axis else np.abs(self.phi)
        facing = off <= 0.5 * math.pi + wall.max_slope_rad + _FACING
        self._part_of_wall(wall, None, facing & self.shown)
        if self.surface.faces is not None and wall.is_sloped.any():
            self._part_of_wall(wall, np.flatnonzero(wall.is_sloped), ~facing & self.shown)

    def _seen_inside(self) -> bool:
        looked_into = self.surface.faces is not None or self.view.cut_out_range_deg is not None
        return looked_into or len(self.surface.inner_radii) > 1

    def _part_of_wall(self, wall: LayerWall, columns: IntArray | None, rays: BoolArray) -> None:
        for run in _true_slices(rays):
            r = wall.radius_px if columns is None else wall.radius_px[columns]
            z = self.surface.z_px[wall.columns if columns is None else wall.columns[columns]][:, None]
            group = _PointGroup(self._next, len(r) * (run.stop - run.start), wall, columns, run)
            if not self.surface.is_turned:
                r = r[:, run]
            self._put(group, z, r, self.up[::2][run], self.near[::2][run], masked=not wall.is_complete)

    def _patches(self) -> None:
        for patch in (self.surface.faces, self.surface.flanks):
            if patch is None or not len(patch.radius_px):
                continue
            z, r = patch.z_px[:, None], patch.radius_px[:, None]
            if patch.half_ray_numbers is None:
                for run in _true_slices(self.shown):
                    group = _PointGroup(
                        self._next, len(r) * (run.stop - run.start), ray_range=run, surface_patch=patch
                    )
                    self._put(group, z, r, self.up[::2][run], self.near[::2][run])
            else:
                if self.halves_shown is not None:
                    r = np.where(self.halves_shown[patch.half_ray_numbers][:, None], r, MISSING_RADIUS)
                up, near = (
                    self.up[patch.half_ray_numbers][:, None],
                    self.near[patch.half_ray_numbers][:, None],
                )
                self._put(_PointGroup(self._next, len(r), surface_patch=patch), z, r, up, near, masked=True)

    def _sections(self) -> None:
        """Draw the cut faces of the material at both edges of an opening."""
        if self.view.cut_out_range_deg is None:
            return
        surface = self.surface
        r = (np.arange(math.ceil(max(surface.max_radius_px, 1.0))) + 0.5).astype(np.float32)
        for side, degrees in zip((1.0, -1.0), self.view.cut_out_range_deg, strict=True):
            edge = math.radians(degrees)
            away = np.abs(np.remainder(self.phi - edge + math.pi, 2.0 * math.pi) - math.pi)
            ray = 0 if surface.is_turned else int(np.argmin(away))
            metal = np.zeros((len(surface.z_px), len(r)), np.bool_)
            for low, high in zip(surface.inner_radii, surface.outer_radii, strict=True):
                metal |= (low[:, ray, None] <= r) & (r < high[:, ray, None])
            column, place = np.nonzero(metal)
            z = surface.z_px[column]
            group = _PointGroup(self._next, len(column), cut_face_angle=side * (edge or 1e-9), z=z)
            up, near = np.array([math.sin(edge)], np.float32), np.array([math.cos(edge)], np.float32)
            self._put(group, z[:, None], r[place][:, None], up, near)

    def _put(
        self,
        group: _PointGroup,
        z: Float32Array,
        r: Float32Array,
        up: Float32Array,
        near: Float32Array,
        *,
        masked: bool = False,
    ) -> None:
        """Draw a group of points, and store only the nearest point of each pixel.

        The depth and the index of a point are combined in one value, and the greatest value at each pixel
        is stored. ``z``, ``r`` and the sine and cosine of phi have compatible shapes (n, k). Points are
        numbered along k first. If ``masked`` is True, some points are missing.
        """
        across = max(r.shape[1], up.shape[-1])
        block = max(_BLOCK // across, 1)
        for start in range(0, len(z), block):
            rows = slice(start, start + block)
            turned = (up[rows], near[rows]) if up.ndim == 2 else (up, near)
            self._put_block(
                group.first_point_index + start * across, z[rows], r[rows], *turned, masked=masked
            )
        self.groups.append(group)
        self._next += group.point_count

    def _put_block(
        self,
        first: int,
        z: Float32Array,
        r: Float32Array,
        up: Float32Array,
        near: Float32Array,
        *,
        masked: bool,
    ) -> None:
        right = r * (near * -self.sin)
        right += z * self.cos + np.float32(0.5 * self.width + 1.0)
        np.clip(right, 0.0, self.width + 1.0, out=right)
        np.floor(right, out=right)
        pixel = r * -up
        pixel += np.float32(0.5 * self.height + 1.0)
        np.clip(pixel, 0.0, self.height + 1.0, out=pixel)
        np.floor(pixel, out=pixel)
        pixel *= np.float32(self.width + 2)
        pixel += right
        depth = r * (near * (self.cos * np.float32(_DEPTH)))
        depth += (z * self.sin + np.float32(_FAR)) * np.float32(_DEPTH)
        if masked:
            depth *= r > 0.0
        keys = depth.astype(np.int64)
        keys <<= _POINT
        keys += np.arange(first, first + keys.size).reshape(keys.shape)
        np.maximum.at(self.nearest, pixel.astype(np.intp).ravel(), keys.ravel())

    # --- lighting of the nearest points

    def draw_image(self, table: ImageArray, ground: int, hits: ZSpans) -> tuple[ImageArray, DepthArray]:
        """Return the picture and the depth of each pixel.

        ``table`` is the color table and has the shape (colors, shades).
        """
        inside = self.nearest.reshape(self.height + 2, self.width + 2)[1:-1, 1:-1].ravel()
        pixel = np.flatnonzero(inside > _NUMBER)
        point = inside[pixel] & _NUMBER
        shade, colour = np.zeros(len(point), np.float32), np.zeros(len(point), np.int16)
        rough = np.zeros(len(point), np.bool_)
        bounds = np.array([group.first_point_index for group in self.groups[1:]], np.int64)
        which = np.searchsorted(bounds, point, side="right").astype(np.int8)
        for number, group in enumerate(self.groups):
            own = np.flatnonzero(which == number)
            if len(own):
                shade[own], colour[own], rough[own] = self._lit(
                    group, point[own] - group.first_point_index, hits
                )
        if rough.any():
            self._smooth(pixel, shade, rough)
        codes = np.full(inside.shape, -1, np.int16)
        level = np.clip(shade * np.float32(SHADES), 0, SHADES - 1).astype(np.int16)
        codes[pixel] = np.where(shade < 0.0, _FACING_AWAY, level + colour * SHADES)
        codes = _remove_specks(codes.reshape(self.height, self.width))
        depth = (inside >> _POINT).astype(np.int32).reshape(codes.shape)
        _draw_edges(codes, depth)
        return np.append(table.ravel(), np.uint32(ground))[np.maximum(codes, -1)], depth

    def _smooth(self, pixel: IntArray, shade: Float32Array, rough: BoolArray) -> None:
        """Set the brightness of each rough point to the mean of the rough points within 5 × 5 pixels."""
        at, wide = pixel[rough], self.width
        light, count = (np.zeros(self.height * wide, np.float32) for _ in range(2))
        light[at], count[at] = np.maximum(shade[rough], 0.0), 1.0
        for step in (1, wide):
            light, count = (_sum_neighbors(values, step) for values in (light, count))
        shade[rough] = light[at] / count[at]

    def _lit(
        self, group: _PointGroup, index: IndexArray, hits: ZSpans
    ) -> tuple[Float32Array, CodeArray | int, BoolArray | bool]:
        """Return the brightness (n,) and the colors of points of a group, and a mask of the rough points."""
        rough: BoolArray | bool = False
        colour: CodeArray | int = _SECTION
        if group.layer_wall is not None:
            shade, z, colour, rough = self._wall_light(group, group.layer_wall, index)
        elif group.surface_patch is not None:
            shade, z, colour, rough = self._patch_light(group, group.surface_patch, index)
        else:
            assert group.z is not None
            shade, z = self._section_light(group.cut_face_angle, len(index)), group.z[index]
        if not hits:
            return shade, colour, rough
        at = z / self.view.pixels_per_mm + self.view.center_z_mm
        hit = np.any([(at >= low) & (at <= high) for low, high in hits], axis=0)
        return shade, np.where(hit, _HIT, colour).astype(np.int16), rough

    def _wall_light(
        self, group: _PointGroup, wall: LayerWall, index: IndexArray
    ) -> tuple[Float32Array, Float32Array, CodeArray | int, BoolArray]:
        row, ray = np.divmod(index, group.ray_range.stop - group.ray_range.start)
        ray += group.ray_range.start
        if group.columns is not None:
            row = group.columns[row]
        across, tangential, along = _wall_normals(wall, row, ray, self.surface)
        if wall.faces_axis:
            across, tangential, along = -across, -tangential, -along
        shade = self._shade(2 * ray, across, tangential, along)
        rough = np.abs(across) < _STEEP
        colour: CodeArray | int = _OUTSIDE
        if wall.bore_radius_px is not None:  # a slot through the axis is not a bore
            r = wall.radius_px[row, 0 if self.surface.is_turned else ray]
            colour = np.where(np.abs(r - wall.bore_radius_px[row]) < 1.0, _BORE, _OUTSIDE).astype(np.int16)
        return shade, self.surface.z_px[wall.columns[row]], colour, rough

    def _patch_light(
        self, group: _PointGroup, patch: SurfacePatch, index: IndexArray
    ) -> tuple[Float32Array, Float32Array, int, BoolArray]:
        if patch.half_ray_numbers is None:
            index, ray = np.divmod(index, group.ray_range.stop - group.ray_range.start)
            halves = 2 * (ray + group.ray_range.start)
        else:
            halves = patch.half_ray_numbers[index]
        shade = self._shade(halves, patch.normal_r[index], patch.normal_angle[index], patch.normal_z[index])
        return shade, patch.z_px[index], _OUTSIDE, patch.is_rough[index]

    def _section_light(self, edge: float, count: int) -> Float32Array:
        phi, side = abs(edge), math.copysign(1.0, edge)
        towards, above = np.array([-side * math.sin(phi)]), np.array([side * math.cos(phi)])
        shade = self._light(towards.astype(np.float32), above.astype(np.float32), np.zeros(1, np.float32))
        return np.repeat(np.maximum(shade, np.float32(0.5)), count)

    def _shade(
        self, halves: IntArray, across: Float32Array, tangential: Float32Array, along: Float32Array
    ) -> Float32Array:
        """Return the brightness of surface normals given along r, the part's angle and Z.

        The direction of phi is opposite to the part's angle.
        """
        near, up = self.near[halves], self.up[halves]
        return self._light(across * near + tangential * up, across * up - tangential * near, along)

    def _light(self, towards: Float32Array, above: Float32Array, along: Float32Array) -> Float32Array:
        """Return the brightness of surface normals from 0 to 1, or -1 for normals that point away.

        The normals are given as components toward the viewer, up and along Z.
        """
        right = along * self.cos - towards * self.sin
        towards = along * self.sin + towards * self.cos
        lit = right * _LIGHT[0] + above * _LIGHT[1] + towards * _LIGHT[2]
        np.maximum(lit, 0.0, out=lit)
        glint = right * _BISECTOR[0] + above * _BISECTOR[1] + towards * _BISECTOR[2]
        np.maximum(glint, 0.0, out=glint)
        for _ in range(4):
            glint *= glint
        shade = np.asarray(0.2 + 0.5 * lit + 0.28 * glint, np.float32)
        shade[towards < -0.05] = -1.0
        return shade


def _true_slices(wanted: BoolArray) -> list[slice]:
    """Return a slice for each run of consecutive true values."""
    bounds = np.flatnonzero(np.diff(wanted, prepend=False, append=False)).tolist()
    return [slice(a, b) for a, b in zip(bounds[::2], bounds[1::2], strict=True)]


def _wall_normals(
    wall: LayerWall, row: IntArray, ray: IntArray, surface: SolidSurface
) -> tuple[Float32Array, Float32Array, Float32Array]:
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


def _remove_specks(codes: CodeArray) -> CodeArray:
    """Replace points on the rim that face away, and isolated points, by the median of their neighbors.

    The median of three points is applied horizontally, then vertically.
    """
    for turned in (codes, codes[:, ::-1], codes.T, codes.T[:, ::-1]):
        away = turned[:, :-1] == _FACING_AWAY
        np.copyto(turned[:, :-1], turned[:, 1:], where=away)
    for turned in (codes.T, codes):
        before, own, next_codes = turned[:-2], turned[1:-1], turned[2:]
        low, high = np.minimum(before, next_codes), np.maximum(before, next_codes)
        turned[1:-1] = np.maximum(low, np.minimum(high, own))
    return codes


def _draw_edges(codes: CodeArray, depth: npt.NDArray[np.int32]) -> None:
    """Darken the deeper side of each step in depth, to separate two faces of equal brightness.

    A point is on the deeper side if its depth exceeds the mean of its two neighbors by more than ``_EDGE``.
    """
    for picture, deep in ((codes, depth), (codes.T, depth.T)):
        sunk = deep[:-2] + deep[2:]
        sunk -= 2 * deep[1:-1]
        is_deeper = sunk > _EDGE * _DEPTH
        is_deeper &= picture[1:-1] >= 0
        own = picture[1:-1]
        own[is_deeper] -= (own[is_deeper] & (SHADES - 1)) // 3
