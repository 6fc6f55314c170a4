"""The nearest surface point at each pixel of a solid picture."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.picture.solid_view import SolidView
from core.part.picture.surface_points import (
    MISSING_RADIUS,
    Float32Array,
    IntArray,
    LayerWall,
    SolidSurface,
    SurfacePatch,
)

IndexArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]
CheckCanceled = Callable[[], None]

DEPTH_STEPS = 32.0
"""Depth steps per pixel."""
FAR_DEPTH = 1e5
"""Greatest distance of a point from the middle of the part, in pixels."""

_POINT = 26  # bits of a key for the number of the point; the depth is in the higher bits
_NUMBER = (1 << _POINT) - 1
_BLOCK = 1 << 15  # points processed together, so that the data fits into the CPU cache
_FACING = 0.02  # radians beyond the horizon that are also drawn


class PointGroup(NamedTuple):
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


class PointProjection:
    """The surface points of a part, projected to the pixels of one picture.

    ``nearest`` contains the key of the nearest point at each pixel, with a border of one pixel. A key
    consists of the depth and the number of the point. ``groups`` are the groups of points in the order of
    their numbers. ``check_canceled`` is called regularly, and may raise an exception to cancel.
    """

    def __init__(
        self,
        surface: SolidSurface,
        view: SolidView,
        width: int,
        height: int,
        check_canceled: CheckCanceled | None = None,
    ) -> None:
        self.surface, self.view, self.width, self.height = surface, view, width, height
        self._check_canceled = check_canceled
        self._middle_px = (
            np.float32(0.5 * width + 1.0 + view.offset_px[0]),
            np.float32(0.5 * height + 1.0 + view.offset_px[1]),
        )
        self.cos, self.sin = (np.float32(part) for part in view.azimuth_cos_sin)
        self.phi = view.convert_to_viewer_angles(surface.ray_angles)
        self.shown = ~view.is_cut_out(self.phi)
        # Patches also need the angles halfway between rays.
        phi = view.convert_to_viewer_angles(np.arange(2 * surface.ray_count) * (math.pi / surface.ray_count))
        self.near, self.up = np.cos(phi).astype(np.float32), np.sin(phi).astype(np.float32)
        self.halves_shown = None if view.cut_out_range_deg is None else ~view.is_cut_out(phi)
        self.nearest = np.zeros((height + 2) * (width + 2), np.int64)
        self.groups: list[PointGroup] = []
        self._next = 0
        for wall in surface.walls:
            self._wall(wall)
        self._patches()
        self._sections()

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
            group = PointGroup(self._next, len(r) * (run.stop - run.start), wall, columns, run)
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
                    group = PointGroup(
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
                self._put(PointGroup(self._next, len(r), surface_patch=patch), z, r, up, near, masked=True)

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
            group = PointGroup(self._next, len(column), cut_face_angle=side * (edge or 1e-9), z=z)
            up, near = np.array([math.sin(edge)], np.float32), np.array([math.cos(edge)], np.float32)
            self._put(group, z[:, None], r[place][:, None], up, near)

    def _put(
        self,
        group: PointGroup,
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
        if self._check_canceled is not None:
            self._check_canceled()
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
        right += z * self.cos + self._middle_px[0]
        np.clip(right, 0.0, self.width + 1.0, out=right)
        np.floor(right, out=right)
        pixel = r * -up
        pixel += self._middle_px[1]
        np.clip(pixel, 0.0, self.height + 1.0, out=pixel)
        np.floor(pixel, out=pixel)
        pixel *= np.float32(self.width + 2)
        pixel += right
        depth = r * (near * (self.cos * np.float32(DEPTH_STEPS)))
        depth += (z * self.sin + np.float32(FAR_DEPTH)) * np.float32(DEPTH_STEPS)
        if masked:
            depth *= r > 0.0
        keys = depth.astype(np.int64)
        keys <<= _POINT
        keys += np.arange(first, first + keys.size).reshape(keys.shape)
        np.maximum.at(self.nearest, pixel.astype(np.intp).ravel(), keys.ravel())

    def find_nearest_points(self) -> tuple[IndexArray, IndexArray, npt.NDArray[np.int32]]:
        """Return the pixels that show the part, the point number at each of them, and the depth image.

        The pixels are numbered row by row. In the depth image, 0 means empty.
        """
        inside = self.nearest.reshape(self.height + 2, self.width + 2)[1:-1, 1:-1].ravel()
        pixel = np.flatnonzero(inside > _NUMBER)
        depth = (inside >> _POINT).astype(np.int32).reshape(self.height, self.width)
        return pixel, inside[pixel] & _NUMBER, depth


def _true_slices(wanted: BoolArray) -> list[slice]:
    """Return a slice for each run of consecutive true values."""
    bounds = np.flatnonzero(np.diff(wanted, prepend=False, append=False)).tolist()
    return [slice(a, b) for a, b in zip(bounds[::2], bounds[1::2], strict=True)]
