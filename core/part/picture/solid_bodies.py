"""Tool and holder in the solid picture, as image layers merged with the part by depth.

The outlines of a tool become prisms below its rake face, which is in the XZ plane through the spindle axis.
A rotating tool becomes a solid of revolution. The points of these bodies are one pixel apart. They are not
cached, because there are few of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from enum import StrEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.picture.solid_view import SolidView
from core.part.ray_cuts import FloatArray

ImageArray = npt.NDArray[np.uint32]
DepthArray = npt.NDArray[np.int32]

_INSERT_HEIGHT_MM = 0.1  # mm by which an insert is drawn above its holder
_INSERT, _HOLDER = 4.8, 16.0  # mm below the rake face; a holder uses its width if it is less
_LIGHT = np.array([-0.38, 0.62, 0.69])  # right, up, toward the viewer
_GHOST = 0.3


class SymmetryAxis(StrEnum):
    """The axis about which a tool is rotationally symmetrical, if any."""

    NONE = ""
    Z = "z"
    X = "x"


class ToolBody(NamedTuple):
    """A tool at its position, as outlines (k, 2) of Z and X in mm.

    ``is_body_assumed`` means that the body of the tool is only assumed.
    """

    cutting_outlines: tuple[FloatArray, ...]
    body_outlines: tuple[FloatArray, ...]
    symmetry_axis: SymmetryAxis = SymmetryAxis.NONE
    is_body_assumed: bool = False


class ImageLayer(NamedTuple):
    """An image of 0xAARRGGBB values with the depth of each pixel; depth 0 means empty.

    ``opacity`` is the opacity of the layer, from 0 to 1.
    """

    image: ImageArray
    depth: DepthArray
    opacity: float = 1.0

    def draw_onto_image(self, image: ImageArray, depth: DepthArray) -> None:
        """Draw the layer over a picture, and update the depth of the picture."""
        nearer = self.depth > depth
        if not nearer.any():
            return
        if self.opacity < 1.0:
            image[nearer] = _blend_images(self.image[nearer], image[nearer], self.opacity)
        else:
            np.copyto(image, self.image, where=nearer)
            np.copyto(depth, self.depth, where=nearer)


class _LitFace(NamedTuple):
    """The surface points of a face with their brightness under the picture's lighting.

    ``points`` (n, 3) are Z, X and height in mm. ``brightness`` is from 0 to 1, as an array (n,) or one
    value.
    """

    points: FloatArray
    brightness: FloatArray | float


class _Viewer(NamedTuple):
    """The position of the viewer and the visible range.

    ``rotation`` is the rotation into coordinates to the right, up and toward the viewer. ``z_range_mm`` and
    ``x_range_mm`` are the visible ranges in mm.
    """

    rotation: FloatArray
    pixels_per_mm: float
    z_range_mm: tuple[float, float]
    x_range_mm: tuple[float, float]


def make_tool_layers(
    tool: ToolBody,
    view: SolidView,
    width: int,
    height: int,
    colors: tuple[int, int],
    depth_steps_per_pixel: float,
    far_depth: float,
) -> Iterator[ImageLayer]:
    """Yield the image layers of the body and the edges of a tool.

    The depth of a pixel is measured from a plane ``far_depth`` pixels on the far side of the axis, with
    ``depth_steps_per_pixel`` steps per pixel.
    """
    eye = _make_viewer(view, width, height)
    for polygons, lift, thick, colour, ghost in (
        (tool.body_outlines, 0.0, _HOLDER, colors[0], tool.is_body_assumed),
        (tool.cutting_outlines, _INSERT_HEIGHT_MM, _INSERT, colors[1], False),
    ):
        faces = [
            face for polygon in polygons for face in _faces(polygon, (lift, thick), tool.symmetry_axis, eye)
        ]
        if faces:
            yield _make_layer(
                faces, view, (width, height), colour, (depth_steps_per_pixel, far_depth)
            )._replace(opacity=_GHOST if ghost else 1.0)


def _make_viewer(view: SolidView, width: int, height: int) -> _Viewer:
    """Return the viewer of a view; a tilted view has larger visible ranges."""
    cos, _ = view.azimuth_cos_sin
    across = (0.5 * height / view.pixels_per_mm + _HOLDER) / max(
        abs(math.sin(math.radians(view.tilt_deg))), 0.25
    )
    along = (0.5 * width / view.pixels_per_mm + across) / max(cos, 0.25)
    return _Viewer(
        _view_rotation(view),
        view.pixels_per_mm,
        (view.center_z_mm - along, view.center_z_mm + along),
        (-across, across),
    )


def _faces(
    polygon: FloatArray, heights: tuple[float, float], round_: SymmetryAxis, eye: _Viewer
) -> Iterable[_LitFace]:
    if round_ is not SymmetryAxis.NONE:
        return [_revolved_surface(polygon, round_, eye)]
    lift, thick = heights
    size = np.ptp(polygon, axis=0)
    return _prism_faces(polygon, lift, min(thick, max(float(size.min()), 1.0)), eye)


def _prism_faces(polygon: FloatArray, lift: float, thick: float, eye: _Viewer) -> Iterator[_LitFace]:
    """Yield the visible faces of a prism with a convex outline.

    The upper face is at the height ``lift``.
    """
    for height, normal in ((lift, (0.0, 0.0, 1.0)), (-thick, (0.0, 0.0, -1.0))):
        if (shade := _face_brightness(eye, np.array(normal))) > 0.0:
            inside = _points_inside(polygon, eye)
            yield _LitFace(np.column_stack([inside, np.full(len(inside), height)]), float(shade))
    turned = float(np.sign(_area(polygon)) or 1.0)
    down = np.linspace(lift, -thick, max(math.ceil((thick + lift) * eye.pixels_per_mm), 2))
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        vector = b - a
        length = math.hypot(*vector)
        shade = _face_brightness(eye, np.array([vector[1], -vector[0], 0.0]) * (turned / max(length, 1e-9)))
        if length < 1e-9 or shade <= 0.0:
            continue
        share = np.linspace(0.0, 1.0, max(math.ceil(length * eye.pixels_per_mm), 1), endpoint=False)
        edge = a + share[:, None] * vector
        edge = edge[_seen(edge[:, 0], eye.z_range_mm) & _seen(edge[:, 1], eye.x_range_mm)]
        points = np.column_stack([np.repeat(edge, len(down), axis=0), np.tile(down, len(edge))])
        yield _LitFace(points, float(shade))


def _seen(values: FloatArray, span: tuple[float, float]) -> npt.NDArray[np.bool_]:
    return (values >= span[0]) & (values <= span[1])


def _face_brightness(eye: _Viewer, normals: FloatArray) -> FloatArray:
    """Return the brightness of faces with the given normals (…, 3), or 0 for faces that face away."""
    turned = normals @ eye.rotation.T
    light = 0.35 + 0.65 * np.clip(turned @ _LIGHT, 0.0, 1.0)
    return np.where(turned[..., 2] > 0.0, light, 0.0)


def _revolved_surface(polygon: FloatArray, round_: SymmetryAxis, eye: _Viewer) -> _LitFace:
    """Return the surface of a rotating tool, whose outline is symmetrical about its axis."""
    axis, across = (0, 1) if round_ is SymmetryAxis.Z else (1, 0)
    span = eye.z_range_mm if axis == 0 else eye.x_range_mm
    low, high = max(polygon[:, axis].min(), span[0]), min(polygon[:, axis].max(), span[1])
    middle = 0.5 * (polygon[:, across].min() + polygon[:, across].max())
    at = np.linspace(low, high, max(math.ceil((high - low) * eye.pixels_per_mm), 2))
    first, last = _crossing_range(polygon, axis, at)
    radius = np.nan_to_num(np.maximum(last - middle, middle - first))
    angles = np.linspace(
        0.0, 2.0 * math.pi, max(math.ceil(2.0 * math.pi * radius.max() * eye.pixels_per_mm), 12)
    )
    lean = np.gradient(radius, at) if high > low else np.zeros(len(at))
    cos, sin = np.cos(angles), np.sin(angles)
    points, normals = np.empty((len(at), len(angles), 3)), np.empty((len(at), len(angles), 3))
    points[..., axis], points[..., across] = at[:, None], middle + radius[:, None] * cos
    points[..., 2] = radius[:, None] * sin
    normals[..., axis], normals[..., across], normals[..., 2] = -lean[:, None], cos, sin
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    shade = _face_brightness(eye, normals).ravel()
    return _LitFace(points.reshape(-1, 3)[shade > 0.0], shade[shade > 0.0])


def _crossing_range(polygon: FloatArray, axis: int, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the range across an axis that a convex outline covers at each position on the axis.

    The range is NaN where the outline does not reach the position.
    """
    a, b = polygon[None], np.roll(polygon, -1, axis=0)[None]
    place = at[:, None]
    edge_delta = b[..., axis] - a[..., axis]
    share = (place - a[..., axis]) / np.where(edge_delta == 0.0, np.inf, edge_delta)
    met = (share >= -1e-9) & (share <= 1.0 + 1e-9) & (edge_delta != 0.0)
    found = a[..., 1 - axis] + share * (b[..., 1 - axis] - a[..., 1 - axis])
    low = np.where(met, found, np.inf).min(axis=1)
    high = np.where(met, found, -np.inf).max(axis=1)
    none = low > high
    return np.where(none, np.nan, low), np.where(none, np.nan, high)


def _points_inside(polygon: FloatArray, eye: _Viewer) -> FloatArray:
    """Return the visible points (n, 2) of a convex outline, one pixel apart."""
    low, high = max(polygon[:, 0].min(), eye.z_range_mm[0]), min(polygon[:, 0].max(), eye.z_range_mm[1])
    if high < low:
        return np.zeros((0, 2))
    at = np.linspace(low, high, max(math.ceil((high - low) * eye.pixels_per_mm), 2))
    first, last = (np.clip(each, *eye.x_range_mm) for each in _crossing_range(polygon, 0, at))
    there = last >= first
    at, first, last = at[there], first[there], last[there]
    count = np.maximum(np.ceil((last - first) * eye.pixels_per_mm), 1.0).astype(np.intp)
    index = np.repeat(np.arange(len(at)), count)
    nth = np.arange(len(index)) - (np.cumsum(count) - count)[index]
    share = (nth + 0.5) / count[index]
    return np.column_stack([at[index], first[index] + share * (last - first)[index]])


def _area(polygon: FloatArray) -> float:
    z, x = polygon.T
    return float(0.5 * np.sum(z * np.roll(x, -1) - x * np.roll(z, -1)))


def _make_layer(
    faces: Sequence[_LitFace], view: SolidView, size: tuple[int, int], color: int, depths: tuple[float, float]
) -> ImageLayer:
    """Return a layer of the given faces, with the nearest point at each pixel."""
    width, height = size
    points = np.concatenate([face.points for face in faces])
    light = np.concatenate([np.broadcast_to(face.brightness, len(face.points)) for face in faces])
    place = (points - np.array([view.center_z_mm, 0.0, 0.0])) @ _view_rotation(view).T * view.pixels_per_mm
    column = np.floor(place[:, 0] + 0.5 * width + view.offset_px[0]).astype(np.int64)
    row = np.floor(0.5 * height + view.offset_px[1] - place[:, 1]).astype(np.int64)
    there = (column >= 0) & (column < width) & (row >= 0) & (row < height)
    shade = (255.0 * light[there]).astype(np.int64)
    deep = ((place[there, 2] + depths[1]) * depths[0]).astype(np.int64)
    keys = np.zeros(width * height, np.int64)
    np.maximum.at(keys, row[there] * width + column[there], (deep << 8) + shade)
    return ImageLayer(
        _coloured(keys & 255, color, keys > 0).reshape(height, width),
        (keys >> 8).astype(np.int32).reshape(height, width),
    )


def _view_rotation(view: SolidView) -> FloatArray:
    """Return the rotation matrix from part directions to view directions.

    The part directions are Z, X (toward the operator) and height. The view directions are right, up and
    toward the viewer.
    """
    cos, sin = view.azimuth_cos_sin
    tilt = math.radians(view.tilt_deg)
    near = np.array([0.0, math.cos(tilt), math.sin(tilt)])
    up = np.array([0.0, -math.sin(tilt), math.cos(tilt)])
    z = np.array([1.0, 0.0, 0.0])
    return np.array([cos * z - sin * near, up, sin * z + cos * near])


def _coloured(shade: npt.NDArray[np.int64], colour: int, there: npt.NDArray[np.bool_]) -> ImageArray:
    parts = [((colour >> off) & 255) * shade // 255 << off for off in (16, 8, 0)]
    whole = (0xFF << 24) | parts[0] | parts[1] | parts[2]
    return np.where(there, whole, 0).astype(np.uint32)


def _blend_images(upper: ImageArray, lower: ImageArray, opacity: float) -> ImageArray:
    """Return a blend of two images, calculated channel by channel.

    The upper image remains transparent over empty pixels.
    """
    mixed = np.zeros(upper.shape, np.uint32)
    for off in (0, 8, 16, 24):
        a, b = (((each >> np.uint32(off)) & np.uint32(255)).astype(np.float64) for each in (upper, lower))
        mixed |= np.round(opacity * a + (1.0 - opacity) * b).astype(np.uint32) << np.uint32(off)
    return mixed
