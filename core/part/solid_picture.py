"""The solid picture of a part, drawn with numpy: surface points, the nearest at each pixel, with lighting.

No graphics card and no Qt are needed. The result is an image of 0xAARRGGBB that both can show. Normals are
computed only for visible pixels.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.solid_bodies import Depths, Layer, ToolBody, tool_layers
from core.part.solid_view import SolidView
from core.part.surface_points import AWAY, Floats, IntArray, Patch, Solid, Surface, Wall

Image = npt.NDArray[np.uint32]
Numbers = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]
Codes = npt.NDArray[np.int16]
Spans = tuple[tuple[float, float], ...]

_POINT = 26  # bits of a key for the number of the point; the depth is in the higher bits
_NUMBER = (1 << _POINT) - 1
_DEPTH = 32.0  # depth steps per pixel
_FAR = 1e5  # pixels; the greatest distance of a point from the middle of the part
_BLOCK = 1 << 15  # points processed together, so that the data fits into the CPU cache
_LIGHT = (-0.38, 0.62, 0.69)  # right, up, toward the viewer
_BISECTOR = (-0.207, 0.337, 0.919)  # halfway between light and viewer
_SHADES = 256
_STEEP = 0.5  # cosine between a wall's normal and the radius, below which the wall is not round
_EDGE = 8.0  # pixels of depth
_FACING = 0.02  # radians beyond the horizon that are also drawn


class Colours(NamedTuple):
    """Colors of the part, as 0xRRGGBB, and of the objects around it.

    ``outside``, ``bore``, ``section`` and ``hit`` are those of the part; ``chuck``, ``holder`` and ``insert``
    are those around it. ``ground`` is 0xAARRGGBB.
    """

    outside: int = 0xB9C3CC
    bore: int = 0xC9B48A
    section: int = 0xD98E4A
    hit: int = 0xE5322D
    ground: int = 0x00000000
    chuck: int = 0x6F6A61
    holder: int = 0x6C7A89
    insert: int = 0xE8B923


class Scene(NamedTuple):
    """The objects around the part: chuck or collet, and a tool."""

    chuck: Solid | None = None
    tool: ToolBody | None = None


_OUTSIDE, _BORE, _SECTION, _HIT = range(4)
_AWAY = -2  # used instead of a color


class _Group(NamedTuple):
    """Points that are drawn together, with the number of the first: a wall, a patch or a cut face."""

    first: int
    points: int
    wall: Wall | None = None
    columns: IntArray | None = None
    rays: slice = slice(None)
    patch: Patch | None = None
    edge: float = 0.0  # phi of a cut face
    z: Floats | None = None


class SolidPicture:
    """Draws a solid repeatedly and caches what does not change between two pictures."""

    def __init__(self, colours: Colours | None = None) -> None:
        self.colours = colours or Colours()
        self._table = _shades(self.colours)
        self._surface: Surface | None = None
        self._made_of: tuple[object, ...] = ()
        self._held: tuple[tuple[object, ...], Layer] | None = None  # chuck or collet in the last view

    def draw(
        self,
        solid: Solid,
        view: SolidView,
        width: int,
        height: int,
        *,
        version: int = 0,
        hits: Spans = (),
        quick: bool = False,
        around: Scene = Scene(),  # noqa: B008 - it is a tuple
    ) -> Image:
        """Return the picture (height, width).

        ``version`` changes with the material, and ``hits`` are spans of Z drawn in red. ``quick`` draws
        blocks of two by two pixels in a third of the time, for a part that is being cut.
        """
        if quick:
            half, small = replace(view, scale=0.5 * view.scale), (-(-width // 2), -(-height // 2))
            image = self.draw(solid, half, *small, version=version, hits=hits, around=around)
            return image.repeat(2, axis=0).repeat(2, axis=1)[:height, :width]
        surface = self._kept(solid, view, width, version)
        image, depth = _Drawing(surface, view, width, height).image(self._table, self.colours.ground, hits)
        if around.chuck is not None:
            self._chuck(around.chuck, view, width, height).over(image, depth)
        if around.tool is not None:
            looks = (self.colours.holder, self.colours.insert)
            for layer in tool_layers(around.tool, view, width, height, looks, _DEPTH, _FAR):
                layer.over(image, depth)
        return image

    def _chuck(self, chuck: Solid, view: SolidView, width: int, height: int) -> Layer:
        """Return the layer of the chuck, drawn again only if the view has changed."""
        seen = (id(chuck), replace(view, roll=0.0), width, height)
        if self._held is None or self._held[0] != seen:
            painter = SolidPicture(
                self.colours._replace(outside=self.colours.chuck, section=self.colours.chuck)
            )
            surface = painter._kept(chuck, view, width, 0)
            drawn = _Drawing(surface, view, width, height).image(painter._table, 0, ())
            self._held = seen, Layer(*drawn)
        return self._held[1]

    def _kept(self, solid: Solid, view: SolidView, width: int, version: int) -> Surface:
        cos, sin = view.along
        towards = 0 if abs(sin) < 0.01 else int(math.copysign(1, sin))
        half = (0.5 * width / view.scale + solid.radius * abs(sin)) / max(cos, 0.05)
        span = view.centre - half, view.centre + half
        made_of = (id(solid.edges), id(solid.high), version, view.scale, towards, span)
        if self._surface is None or made_of != self._made_of:
            self._surface = Surface(solid, view.scale, view.centre, span, towards)
            self._made_of = made_of
        return self._surface


class _Drawing:
    """One picture: points are converted to pixels, then the nearest ones are lit."""

    def __init__(self, surface: Surface, view: SolidView, width: int, height: int) -> None:
        self.surface, self.view, self.width, self.height = surface, view, width, height
        self.cos, self.sin = (np.float32(part) for part in view.along)
        self.phi = view.phi(surface.angles)
        self.shown = ~view.open_at(self.phi)
        # Patches also need the angles halfway between rays.
        phi = view.phi(np.arange(2 * surface.rays) * (math.pi / surface.rays))
        self.near, self.up = np.cos(phi).astype(np.float32), np.sin(phi).astype(np.float32)
        self.halves_shown = None if view.opening is None else ~view.open_at(phi)
        self.nearest = np.zeros((height + 2) * (width + 2), np.int64)
        self.groups: list[_Group] = []
        self._next = 0
        for wall in surface.walls:
            self._wall(wall)
        self._patches()
        self._sections()

    # --- conversion of points to pixels

    def _wall(self, wall: Wall) -> None:
        """Draw the visible points of a wall. Slanted columns may be visible beyond the horizon."""
        if wall.inside and not self._seen_inside():
            return
        off = math.pi - np.abs(self.phi) if wall.inside else np.abs(self.phi)
        facing = off <= 0.5 * math.pi + wall.lean + _FACING
        self._part_of_wall(wall, None, facing & self.shown)
        if self.surface.faces is not None and wall.leaning.any():
            self._part_of_wall(wall, np.flatnonzero(wall.leaning), ~facing & self.shown)

    def _seen_inside(self) -> bool:
        looked_into = self.surface.faces is not None or self.view.opening is not None
        return looked_into or len(self.surface.low) > 1

    def _part_of_wall(self, wall: Wall, columns: IntArray | None, rays: Bools) -> None:
        for run in _runs(rays):
            r = wall.r if columns is None else wall.r[columns]
            z = self.surface.z[wall.columns if columns is None else wall.columns[columns]][:, None]
            group = _Group(self._next, len(r) * (run.stop - run.start), wall, columns, run)
            if not self.surface.turned:
                r = r[:, run]
            self._put(group, z, r, self.up[::2][run], self.near[::2][run], masked=not wall.whole)

    def _patches(self) -> None:
        for patch in (self.surface.faces, self.surface.flanks):
            if patch is None or not len(patch.r):
                continue
            z, r = patch.z[:, None], patch.r[:, None]
            if patch.ray is None:
                for run in _runs(self.shown):
                    group = _Group(self._next, len(r) * (run.stop - run.start), rays=run, patch=patch)
                    self._put(group, z, r, self.up[::2][run], self.near[::2][run])
            else:
                if self.halves_shown is not None:
                    r = np.where(self.halves_shown[patch.ray][:, None], r, AWAY)
                up, near = self.up[patch.ray][:, None], self.near[patch.ray][:, None]
                self._put(_Group(self._next, len(r), patch=patch), z, r, up, near, masked=True)

    def _sections(self) -> None:
        """Draw the material at both edges of an opening."""
        if self.view.opening is None:
            return
        surface = self.surface
        r = (np.arange(math.ceil(max(surface.radius, 1.0))) + 0.5).astype(np.float32)
        for side, degrees in zip((1.0, -1.0), self.view.opening, strict=True):
            edge = math.radians(degrees)
            away = np.abs(np.remainder(self.phi - edge + math.pi, 2.0 * math.pi) - math.pi)
            ray = 0 if surface.turned else int(np.argmin(away))
            metal = np.zeros((len(surface.z), len(r)), np.bool_)
            for low, high in zip(surface.low, surface.high, strict=True):
                metal |= (low[:, ray, None] <= r) & (r < high[:, ray, None])
            column, place = np.nonzero(metal)
            z = surface.z[column]
            group = _Group(self._next, len(column), edge=side * (edge or 1e-9), z=z)
            up, near = np.array([math.sin(edge)], np.float32), np.array([math.cos(edge)], np.float32)
            self._put(group, z[:, None], r[place][:, None], up, near)

    def _put(
        self, group: _Group, z: Floats, r: Floats, up: Floats, near: Floats, *, masked: bool = False
    ) -> None:
        """Store the nearest point of each pixel.

        Depth and number are combined in one value, of which the greatest remains. ``z``, ``r`` and the sine
        and cosine of phi have compatible shapes (n, k). Points are numbered along k first. With ``masked``,
        some points are missing.
        """
        across = max(r.shape[1], up.shape[-1])
        block = max(_BLOCK // across, 1)
        for start in range(0, len(z), block):
            rows = slice(start, start + block)
            turned = (up[rows], near[rows]) if up.ndim == 2 else (up, near)
            self._put_block(group.first + start * across, z[rows], r[rows], *turned, masked=masked)
        self.groups.append(group)
        self._next += group.points

    def _put_block(self, first: int, z: Floats, r: Floats, up: Floats, near: Floats, *, masked: bool) -> None:
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

    def image(self, table: Image, ground: int, hits: Spans) -> tuple[Image, Depths]:
        """Return the picture and the depth of each pixel; ``table`` has the shape (colors, shades)."""
        inside = self.nearest.reshape(self.height + 2, self.width + 2)[1:-1, 1:-1].ravel()
        pixel = np.flatnonzero(inside > _NUMBER)
        point = inside[pixel] & _NUMBER
        shade, colour = np.zeros(len(point), np.float32), np.zeros(len(point), np.int16)
        rough = np.zeros(len(point), np.bool_)
        bounds = np.array([group.first for group in self.groups[1:]], np.int64)
        which = np.searchsorted(bounds, point, side="right").astype(np.int8)
        for number, group in enumerate(self.groups):
            own = np.flatnonzero(which == number)
            if len(own):
                shade[own], colour[own], rough[own] = self._lit(group, point[own] - group.first, hits)
        if rough.any():
            self._smooth(pixel, shade, rough)
        codes = np.full(inside.shape, -1, np.int16)
        level = np.clip(shade * np.float32(_SHADES), 0, _SHADES - 1).astype(np.int16)
        codes[pixel] = np.where(shade < 0.0, _AWAY, level + colour * _SHADES)
        codes = _without_specks(codes.reshape(self.height, self.width))
        depth = (inside >> _POINT).astype(np.int32).reshape(codes.shape)
        _draw_edges(codes, depth)
        return np.append(table.ravel(), np.uint32(ground))[np.maximum(codes, -1)], depth

    def _smooth(self, pixel: IntArray, shade: Floats, rough: Bools) -> None:
        """Give rough points the mean brightness of the rough points around them, five by five."""
        at, wide = pixel[rough], self.width
        light, count = (np.zeros(self.height * wide, np.float32) for _ in range(2))
        light[at], count[at] = np.maximum(shade[rough], 0.0), 1.0
        for step in (1, wide):
            light, count = (_summed(values, step) for values in (light, count))
        shade[rough] = light[at] / count[at]

    def _lit(self, group: _Group, index: Numbers, hits: Spans) -> tuple[Floats, Codes | int, Bools | bool]:
        """Return the brightness of points (n,) of a group, their colors, and which of them are rough."""
        rough: Bools | bool = False
        colour: Codes | int = _SECTION
        if group.wall is not None:
            shade, z, colour, rough = self._wall_light(group, group.wall, index)
        elif group.patch is not None:
            shade, z, colour, rough = self._patch_light(group, group.patch, index)
        else:
            assert group.z is not None
            shade, z = self._section_light(group.edge, len(index)), group.z[index]
        if not hits:
            return shade, colour, rough
        at = z / self.view.scale + self.view.centre
        hit = np.any([(at >= low) & (at <= high) for low, high in hits], axis=0)
        return shade, np.where(hit, _HIT, colour).astype(np.int16), rough

    def _wall_light(
        self, group: _Group, wall: Wall, index: Numbers
    ) -> tuple[Floats, Floats, Codes | int, Bools]:
        row, ray = np.divmod(index, group.rays.stop - group.rays.start)
        ray += group.rays.start
        if group.columns is not None:
            row = group.columns[row]
        across, way, along = _normals(wall, row, ray, self.surface)
        if wall.inside:
            across, way, along = -across, -way, -along
        shade = self._shade(2 * ray, across, way, along)
        rough = np.abs(across) < _STEEP
        colour: Codes | int = _OUTSIDE
        if wall.bore is not None:  # a slot through the axis is not a bore
            r = wall.r[row, 0 if self.surface.turned else ray]
            colour = np.where(np.abs(r - wall.bore[row]) < 1.0, _BORE, _OUTSIDE).astype(np.int16)
        return shade, self.surface.z[wall.columns[row]], colour, rough

    def _patch_light(self, group: _Group, patch: Patch, index: Numbers) -> tuple[Floats, Floats, int, Bools]:
        if patch.ray is None:
            index, ray = np.divmod(index, group.rays.stop - group.rays.start)
            halves = 2 * (ray + group.rays.start)
        else:
            halves = patch.ray[index]
        shade = self._shade(halves, patch.across[index], patch.way[index], patch.along[index])
        return shade, patch.z[index], _OUTSIDE, patch.rough[index]

    def _section_light(self, edge: float, count: int) -> Floats:
        phi, side = abs(edge), math.copysign(1.0, edge)
        towards, above = np.array([-side * math.sin(phi)]), np.array([side * math.cos(phi)])
        shade = self._light(towards.astype(np.float32), above.astype(np.float32), np.zeros(1, np.float32))
        return np.repeat(np.maximum(shade, np.float32(0.5)), count)

    def _shade(self, halves: IntArray, across: Floats, way: Floats, along: Floats) -> Floats:
        """Return the brightness of normals along r, the part's angle and Z.

        Phi is opposite to the part's angle.
        """
        near, up = self.near[halves], self.up[halves]
        return self._light(across * near + way * up, across * up - way * near, along)

    def _light(self, towards: Floats, above: Floats, along: Floats) -> Floats:
        """Return the brightness of normals from 0 to 1, or -1 if they point away.

        The normals are given toward the viewer, up and along Z.
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


def _runs(wanted: Bools) -> list[slice]:
    """Return the slices of consecutive true values."""
    bounds = np.flatnonzero(np.diff(wanted, prepend=False, append=False)).tolist()
    return [slice(a, b) for a, b in zip(bounds[::2], bounds[1::2], strict=True)]


def _normals(wall: Wall, row: IntArray, ray: IntArray, surface: Surface) -> tuple[Floats, Floats, Floats]:
    """Return the normals of a wall along r, the angle and Z, from the smoother neighbor on either side."""
    r, here, last = wall.r, (0 if surface.turned else ray), len(wall.r) - 1
    own = r[row, here]
    along = -_smoother(own - r[np.maximum(row - 1, 0), here], r[np.minimum(row + 1, last), here] - own)
    along = np.clip(along, -50.0, 50.0) / np.float32(surface.step)
    if surface.turned:
        size = 1.0 / np.sqrt(1.0 + along * along)
        return size, np.zeros_like(size), along * size
    before, behind = r[row, ray - 1], r[row, (ray + 1) % surface.rays]
    ring = np.maximum(own, np.float32(1e-3)) * np.float32(2.0 * math.pi / surface.rays)
    way = -np.clip(_smoother(own - before, behind - own), -50.0, 50.0) / ring
    size = 1.0 / np.sqrt(1.0 + along * along + way * way)
    return size, way * size, along * size


def _summed(values: Floats, step: int) -> Floats:
    """Return the sums of each value with two neighbors on either side, ``step`` apart."""
    total = values.copy()
    for off in (step, 2 * step):
        total[off:] += values[:-off]
        total[:-off] += values[off:]
    return total


def _smoother(before: Floats, behind: Floats) -> Floats:
    return np.where(np.abs(before) < np.abs(behind), before, behind)


def _without_specks(codes: Codes) -> Codes:
    """Replace points that point away at a rim, and single points, by their neighbors.

    A median of three is applied horizontally, then vertically.
    """
    for turned in (codes, codes[:, ::-1], codes.T, codes.T[:, ::-1]):
        away = turned[:, :-1] == _AWAY
        np.copyto(turned[:, :-1], turned[:, 1:], where=away)
    for turned in (codes.T, codes):
        before, own, behind = turned[:-2], turned[1:-1], turned[2:]
        low, high = np.minimum(before, behind), np.maximum(before, behind)
        turned[1:-1] = np.maximum(low, np.minimum(high, own))
    return codes


def _draw_edges(codes: Codes, depth: npt.NDArray[np.int32]) -> None:
    """Darken the deeper side of an edge, so that a step is visible between two faces of equal brightness.

    A point is on the deeper side if it is deeper than the mean of its two neighbors by more than ``_EDGE``.
    """
    for picture, deep in ((codes, depth), (codes.T, depth.T)):
        sunk = deep[:-2] + deep[2:]
        sunk -= 2 * deep[1:-1]
        behind = sunk > _EDGE * _DEPTH
        behind &= picture[1:-1] >= 0
        own = picture[1:-1]
        own[behind] -= (own[behind] & (_SHADES - 1)) // 3


def _shades(colours: Colours) -> Image:
    """Return the color table (colors, shades) of 0xAARRGGBB: dark at 0, the color at 0.7, lighter above."""
    share = np.linspace(0.0, 1.0, _SHADES)
    rows = []
    for colour in colours[:4]:
        rgb = np.array([(colour >> 16) & 255, (colour >> 8) & 255, colour & 255])[:, None]
        dark = rgb * np.minimum(share / 0.7, 1.0)
        light = dark + (255.0 - dark) * np.maximum((share - 0.7) / 0.3, 0.0) * 0.9
        red, green, blue = np.clip(light, 0, 255).astype(np.uint32)
        rows.append((np.uint32(0xFF) << 24) | (red << 16) | (green << 8) | blue)
    return np.array(rows, np.uint32)
