"""The solid picture of a part, drawn with numpy from surface points with lighting.

The nearest point is shown at each pixel. Drawing requires no graphics card and no Qt. The result is an
image of 0xAARRGGBB values, which both a graphics card and Qt can show. Normals are computed only for
visible pixels.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from core.part.picture.body_picture import draw_bodies
from core.part.picture.clamping_bodies import Body
from core.part.picture.part_scene import ImageArray, PartColors, PartScene, make_color_table
from core.part.picture.picture_edges import draw_edges, fill_holes, soften_steps
from core.part.picture.point_lighting import PointLighting, ZSpans
from core.part.picture.point_projection import DEPTH_STEPS, FAR_DEPTH, CheckCanceled, PointProjection
from core.part.picture.solid_bodies import DepthArray, ImageLayer, make_tool_layers
from core.part.picture.solid_view import SolidView
from core.part.picture.surface_points import Solid, SolidSurface

_SAMPLES = ((-0.125, -0.375), (0.125, 0.375), (0.375, -0.125), (-0.375, 0.125))  # pixels right and down
_BACK_AZIMUTH_DEG = -10.0  # from further back, the clamping would hide the part
_BACK_OPACITY = 0.3
_STOCK_OPACITY = 0.3
_MAX_SURFACES = 2  # one for coarse and one for fine pictures


class PartImage(NamedTuple):
    """A picture of 0xAARRGGBB values, and the depth of each pixel that shows the part.

    The depth is 0 at the other pixels, and at pixels where something else hides the part.
    """

    image: ImageArray
    depth: DepthArray

    def find_surface_point(self, view: SolidView, column: int, row: int) -> tuple[float, float] | None:
        """Return Z and the radius of the part at a pixel in mm, or None if it does not show the part."""
        height, width = self.depth.shape
        if not (0 <= column < width and 0 <= row < height) or not self.depth[row, column]:
            return None
        cos, sin = view.azimuth_cos_sin
        toward = (float(self.depth[row, column]) + 0.5) / DEPTH_STEPS - FAR_DEPTH
        right = column + 0.5 - 0.5 * width - view.offset_px[0]
        up = 0.5 * height + view.offset_px[1] - row - 0.5
        z = view.center_z_mm + (right * cos + toward * sin) / view.pixels_per_mm
        return z, math.hypot(toward * cos - right * sin, up) / view.pixels_per_mm


class SolidPicture:
    """A painter that draws a solid repeatedly.

    It caches the data that does not change from one picture to the next.
    """

    def __init__(self, colors: PartColors | None = None) -> None:
        self.colors = colors or PartColors()
        self._table = make_color_table(self.colors.part_colors)
        self._body_table = make_color_table(self.colors.body_colors)
        self._surfaces: dict[tuple[object, ...], SolidSurface] = {}
        self._clamping: tuple[tuple[object, ...], ImageLayer] | None = None  # in the last view

    def draw_picture(
        self,
        solid: Solid,
        view: SolidView,
        width: int,
        height: int,
        *,
        version: int = 0,
        hit_z_spans: ZSpans = (),
        scene: PartScene = PartScene(),  # noqa: B008 - it is a tuple
        check_canceled: CheckCanceled | None = None,
    ) -> ImageArray:
        """Return the picture as an array (height, width), with one sample for each pixel.

        ``version`` changes when the material changes. ``hit_z_spans`` are ranges of Z that are drawn in
        red. ``check_canceled`` is called regularly, and may raise an exception to cancel.
        """
        return self._draw_scene(
            self._find_surface(solid, view, width, version),
            view,
            (width, height),
            hit_z_spans,
            scene,
            check_canceled,
        ).image

    def _draw_scene(
        self,
        surface: SolidSurface,
        view: SolidView,
        size: tuple[int, int],
        hit_z_spans: ZSpans,
        scene: PartScene,
        check_canceled: CheckCanceled | None,
    ) -> PartImage:
        image, depth = self._draw_surface(surface, view, size, hit_z_spans, check_canceled)
        part_depth = depth.copy()
        if scene.clamping:
            self._draw_clamping(scene.clamping, view, size).draw_onto_image(image, depth)
        if scene.tool is not None:
            looks = (self.colors.holder, self.colors.insert)
            for layer in make_tool_layers(scene.tool, view, *size, looks, DEPTH_STEPS, FAR_DEPTH):
                layer.draw_onto_image(image, depth)
        if scene.stock:
            self._draw_bodies(scene.stock, view, size, _STOCK_OPACITY).draw_onto_image(image, depth)
        part_depth[depth > part_depth] = 0
        return PartImage(image, part_depth)

    def refine_picture(
        self,
        solid: Solid,
        view: SolidView,
        width: int,
        height: int,
        *,
        version: int = 0,
        hit_z_spans: ZSpans = (),
        scene: PartScene = PartScene(),  # noqa: B008 - it is a tuple
        check_canceled: CheckCanceled | None = None,
    ) -> Iterator[PartImage]:
        """Yield pictures of rising quality, from one with softened edges to one with smooth edges.

        The later pictures are the mean of several samples, each displaced by a fraction of a pixel. All
        colors are premultiplied by their opacity.
        """
        total = np.zeros((height, width, 4), np.uint16)
        surface = self._find_surface(solid, view, width, version)
        for count, (right, down) in enumerate(_SAMPLES, 1):
            offset = view.offset_px[0] + right, view.offset_px[1] + down
            drawn = self._draw_scene(
                surface,
                replace(view, offset_px=offset),
                (width, height),
                hit_z_spans,
                scene,
                check_canceled,
            )
            total += drawn.image.view(np.uint8).reshape(total.shape)
            if count == 1:
                yield drawn._replace(image=soften_steps(drawn.image))
            elif count in (len(_SAMPLES) // 2, len(_SAMPLES)):
                mean = (total + count // 2) // count
                yield drawn._replace(image=mean.astype(np.uint8).view(np.uint32)[..., 0])

    def draw_fine_picture(
        self,
        solid: Solid,
        view: SolidView,
        width: int,
        height: int,
        scene: PartScene = PartScene(),  # noqa: B008 - it is a tuple
    ) -> ImageArray:
        """Return the picture with smooth edges; its colors are premultiplied by their opacity."""
        *_, drawn = self.refine_picture(solid, view, width, height, scene=scene)
        return drawn.image

    def _draw_surface(
        self,
        surface: SolidSurface,
        view: SolidView,
        size: tuple[int, int],
        hits: ZSpans,
        check_canceled: CheckCanceled | None,
    ) -> tuple[ImageArray, DepthArray]:
        """Return the picture of a surface, and the depth of each pixel."""
        images = PointLighting(PointProjection(surface, view, *size, check_canceled), hits).make_images()
        fill_holes(images)
        draw_edges(images)
        table = np.append(self._table.ravel(), np.uint32(self.colors.background))
        return table[np.maximum(images.codes, -1)], images.depth

    def _draw_clamping(self, bodies: tuple[Body, ...], view: SolidView, size: tuple[int, int]) -> ImageLayer:
        """Return the image layer of the clamping, which is drawn again only if the view has changed."""
        seen = (bodies, view, *size)
        if self._clamping is None or self._clamping[0] != seen:
            opacity = _BACK_OPACITY if view.azimuth_deg < _BACK_AZIMUTH_DEG else 1.0
            self._clamping = seen, self._draw_bodies(bodies, view, size, opacity)
        return self._clamping[1]

    def _draw_bodies(
        self, bodies: tuple[Body, ...], view: SolidView, size: tuple[int, int], opacity: float
    ) -> ImageLayer:
        """Return the image layer of round bodies and blocks."""
        images = draw_bodies(bodies, view, *size)
        draw_edges(images)
        table = np.append(self._body_table.ravel(), np.uint32(0))
        return ImageLayer(table[images.codes], images.depth, opacity)

    def _find_surface(self, solid: Solid, view: SolidView, width: int, version: int) -> SolidSurface:
        """Return the surface points of the visible part of a solid, from the cache if they are there."""
        cos, sin = view.azimuth_cos_sin
        towards = 0 if abs(sin) < 0.01 else int(math.copysign(1, sin))
        half = (0.5 * width / view.pixels_per_mm + solid.max_radius_mm * abs(sin)) / max(cos, 0.05)
        back, front = float(solid.column_edges[0]), float(solid.column_edges[-1])
        span = max(view.center_z_mm - half, back), min(view.center_z_mm + half, front)
        made_of = (id(solid.column_edges), id(solid.outer_radii), version, view.pixels_per_mm, towards, span)
        found = self._surfaces.pop(made_of, None)
        if found is None:
            found = SolidSurface(solid, view.pixels_per_mm, view.center_z_mm, span, towards)
        self._surfaces[made_of] = found  # the last used surface is the last item
        for outdated in list(self._surfaces)[:-_MAX_SURFACES]:
            del self._surfaces[outdated]
        return found
