"""The picture of round bodies and blocks, calculated exactly at each pixel.

The line of sight through a pixel is described by the depth toward the viewer. Lengths are in pixels, and
depths are measured from the middle of the picture.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from core.part.picture.clamping_bodies import Body, RoundBody
from core.part.picture.part_scene import SHADES
from core.part.picture.picture_edges import PixelImages
from core.part.picture.point_lighting import AnyArray, calculate_brightness
from core.part.picture.point_projection import DEPTH_STEPS, FAR_DEPTH
from core.part.picture.solid_view import SolidView
from core.part.picture.surface_points import Float32Array

_FLAT = 1e-9
Direction = tuple[float, float, float]
"""Components along Z, toward the operator's side of the axis, and up."""


class _Hit(NamedTuple):
    """The nearest points of a body on the lines of sight of some pixels.

    ``depth`` (rows, columns) is -inf where a line does not hit the body. ``normals`` are the components of
    the surface normals to the right, up and toward the viewer.
    """

    depth: Float32Array
    normals: tuple[AnyArray, AnyArray, AnyArray]


class _Lines(NamedTuple):
    """The lines of sight of a rectangle of pixels.

    ``right`` (columns,) and ``up`` (rows, 1) are the positions of the pixels from the middle. ``cos`` and
    ``sin`` belong to the azimuth.
    """

    right: Float32Array
    up: Float32Array
    cos: float
    sin: float

    @property
    def z(self) -> Float32Array:
        """Return the Z coordinate of each line of sight at a depth of 0."""
        return self.right * self.cos

    @property
    def near(self) -> Float32Array:
        """Return the distance of each line of sight from the axis, toward the viewer, at a depth of 0."""
        return -self.right * self.sin


def draw_bodies(bodies: Iterable[Body], view: SolidView, width: int, height: int) -> PixelImages:
    """Return the images of bodies. The color number of a pixel is the material of its body."""
    images = PixelImages(
        np.full((height, width), -1, np.int16),
        np.zeros((height, width), np.int32),
        np.zeros((height, width), np.float32),
        np.zeros((height, width), np.float32),
    )
    for body in bodies:
        _draw_body(body, view, images)
    return images


def _draw_body(body: Body, view: SolidView, images: PixelImages) -> None:
    rows, columns = _find_rectangle(body, view, images.codes.shape)
    if rows.stop <= rows.start or columns.stop <= columns.start:
        return
    height, width = images.codes.shape
    cos, sin = view.azimuth_cos_sin
    lines = _Lines(
        (np.arange(columns.start, columns.stop) + 0.5 - 0.5 * width - view.offset_px[0]).astype(np.float32),
        (0.5 * height + view.offset_px[1] - 0.5 - np.arange(rows.start, rows.stop)).astype(np.float32)[
            :, None
        ],
        cos,
        sin,
    )
    hit = _hit_round(body, lines, view) if isinstance(body, RoundBody) else _hit_block(body, lines, view)
    steps = (np.maximum(hit.depth, -FAR_DEPTH + 1.0) + FAR_DEPTH) * DEPTH_STEPS
    nearer = np.isfinite(hit.depth) & (steps > images.depth[rows, columns])
    right, above, towards = (np.broadcast_to(each, nearer.shape)[nearer] for each in hit.normals)
    level = np.clip(calculate_brightness(right, above, towards) * SHADES, 0, SHADES - 1)
    images.codes[rows, columns][nearer] = level.astype(np.int16) + SHADES * int(body.material)
    images.depth[rows, columns][nearer] = steps[nearer].astype(np.int32)
    images.right[rows, columns][nearer] = right
    images.above[rows, columns][nearer] = above


def _find_rectangle(body: Body, view: SolidView, shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Return the rows and columns of the picture that can show a body."""
    cos, sin = view.azimuth_cos_sin
    if isinstance(body, RoundBody):
        reach = max(body.back_radius_mm, body.front_radius_mm)
        corners = [
            (z, n, v)
            for z in (body.back_z_mm, body.front_z_mm)
            for n in (-reach, reach)
            for v in (-reach, reach)
        ]
    else:
        corners = list(_find_corners(body, view))
    right = [((z - view.center_z_mm) * cos - n * sin) * view.pixels_per_mm for z, n, _ in corners]
    up = [v * view.pixels_per_mm for *_, v in corners]
    height, width = shape
    x, y = 0.5 * width + view.offset_px[0], 0.5 * height + view.offset_px[1]
    return (
        slice(max(math.floor(y - max(up)), 0), min(math.ceil(y - min(up)) + 1, height)),
        slice(max(math.floor(x + min(right)), 0), min(math.ceil(x + max(right)) + 1, width)),
    )


def _find_block_axes(body: Body, view: SolidView) -> tuple[Direction, Direction]:
    """Return the radial and the tangential direction of a block."""
    assert not isinstance(body, RoundBody)
    phi = float(view.convert_to_viewer_angles(np.radians(np.array([body.angle_deg])))[0])
    return (0.0, math.cos(phi), math.sin(phi)), (0.0, -math.sin(phi), math.cos(phi))


def _find_corners(body: Body, view: SolidView) -> Iterator[Direction]:
    """Yield the corners of a block as Z, distance toward the viewer and height in mm."""
    assert not isinstance(body, RoundBody)
    (_, n0, v0), (_, n1, v1) = _find_block_axes(body, view)
    for z in (body.back_z_mm, body.front_z_mm):
        for radial in (body.inner_mm, body.outer_mm):
            for side in (-0.5 * body.width_mm, 0.5 * body.width_mm):
                yield z, n0 * radial + n1 * side, v0 * radial + v1 * side


def _hit_block(body: Body, lines: _Lines, view: SolidView) -> _Hit:
    """Return the hits on a block.

    A line is inside the block while it is between both faces along each of the three axes.
    """
    assert not isinstance(body, RoundBody)
    scale = view.pixels_per_mm
    radial, tangential = _find_block_axes(body, view)
    half = 0.5 * body.width_mm
    axes: tuple[tuple[Direction, float, float], ...] = (
        ((1.0, 0.0, 0.0), body.back_z_mm - view.center_z_mm, body.front_z_mm - view.center_z_mm),
        (radial, body.inner_mm, body.outer_mm),
        (tangential, -half, half),
    )
    entry, leave = np.full(1, np.inf, np.float32), np.full(1, -np.inf, np.float32)
    right, above, towards = (np.zeros(1, np.float32) for _ in range(3))
    for axis, low, high in axes:
        start = axis[0] * lines.z + axis[1] * lines.near + axis[2] * lines.up
        rate = axis[0] * lines.sin + axis[1] * lines.cos
        if abs(rate) < _FLAT:
            inside = (start >= low * scale) & (start <= high * scale)
            first, last = np.where(inside, np.inf, -np.inf), np.where(inside, -np.inf, np.inf)
        else:
            side = math.copysign(1.0, rate)
            first = ((high if rate > 0.0 else low) * scale - start) / rate
            last = ((low if rate > 0.0 else high) * scale - start) / rate
            seen = first < entry
            normal = _to_picture(axis, lines)
            right = np.where(seen, side * normal[0], right)
            above = np.where(seen, side * normal[1], above)
            towards = np.where(seen, side * normal[2], towards)
        entry, leave = np.minimum(first, entry), np.maximum(last, leave)
    return _Hit(np.where(entry >= leave, entry, -np.inf), (right, above, towards))


def _to_picture(vector: Direction, lines: _Lines) -> Direction:
    """Return a direction as components to the right, up and toward the viewer."""
    z, near, up = vector
    return lines.cos * z - lines.sin * near, up, lines.sin * z + lines.cos * near


def _hit_round(body: RoundBody, lines: _Lines, view: SolidView) -> _Hit:
    """Return the hits on the side of a cylinder or cone, or on its visible end."""
    scale = view.pixels_per_mm
    back, front = ((z - view.center_z_mm) * scale for z in (body.back_z_mm, body.front_z_mm))
    rise = (body.front_radius_mm - body.back_radius_mm) / (body.front_z_mm - body.back_z_mm)
    radius = body.back_radius_mm * scale + rise * (lines.z - back)  # at a depth of 0
    depth = _hit_side(lines, radius, rise, (back, front))
    near = lines.near + np.where(np.isfinite(depth), depth, 0.0) * lines.cos
    own = np.maximum(np.hypot(near, lines.up), _FLAT)
    size = math.hypot(1.0, rise)
    along, side, above = -rise / size, near / (own * size), lines.up / (own * size)
    right, towards = lines.cos * along - lines.sin * side, lines.sin * along + lines.cos * side
    if abs(lines.sin) > _FLAT:
        end, end_radius = (front, body.front_radius_mm) if lines.sin > 0.0 else (back, body.back_radius_mm)
        end_depth = (end - lines.z) / lines.sin
        on_end = np.hypot(lines.near + end_depth * lines.cos, lines.up) <= end_radius * scale
        on_end &= end_depth > depth
        facing = math.copysign(1.0, lines.sin)
        depth = np.where(on_end, end_depth, depth)
        right = np.where(on_end, facing * lines.cos, right)
        above = np.where(on_end, 0.0, above)
        towards = np.where(on_end, facing * lines.sin, towards)
    return _Hit(depth, (right, above, towards))


def _hit_side(lines: _Lines, radius: Float32Array, rise: float, ends: tuple[float, float]) -> Float32Array:
    """Return the depth of the nearest points on the side of a cone, or -inf where there are none.

    The points satisfy near² + up² = (radius + rise · sin · depth)², which is a quadratic equation of the
    depth.
    """
    slope = rise * lines.sin
    square = lines.cos**2 - slope**2
    square = math.copysign(max(abs(square), _FLAT), square)
    half = lines.near * lines.cos - radius * slope
    root = half * half - square * (lines.near**2 + lines.up**2 - radius * radius)
    missed = root < 0.0
    root = np.sqrt(np.where(missed, 0.0, root))
    best = np.full(root.shape, -np.inf, np.float32)
    for sign in (1.0, -1.0):
        depth = (-half + sign * root) / square
        z = lines.z + depth * lines.sin
        valid = ~missed & (z >= ends[0]) & (z <= ends[1]) & (radius + slope * depth >= 0.0)
        best = np.where(valid & (depth > best), depth, best)
    return best
