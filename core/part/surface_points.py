"""The surfaces of a part as points one pixel apart, ready for rotation: walls, faces and flanks.

Walls are on the rays, with one point per column. Where the material of one column ends short of the next
column's, a face is filled with points. Where that of one ray ends short of the next ray's, the flank of a
slot or a flat is filled. The points are cached until the part or the scale changes, because a rotation only
multiplies them by sines and cosines.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.polar_field import PolarField, in_order
from core.part.ray_cuts import FloatArray

Floats = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.intp]
Cells = tuple[IntArray, IntArray]

AWAY = np.float32(-1e6)
"""r of a point that is not there, pixels: it falls out of every picture."""

_SLOPE = 2.0  # slope between columns below which a step is a cone or an arc and not a shoulder
_GAP = 0.7  # pixels
_NEAR = 6.0  # pixels; neighboring rays that are further apart do not form one surface
_BEYOND = np.float32(1e6)
_SPREAD = 3  # columns and rays over which the direction of a wall is measured
_AROUND = 90  # rays used to find the radius of a bore
_FINEST = 4  # largest number of interpolated rays per ray


class Solid(NamedTuple):
    """A solid in columns and rays. A turned part has one ray.

    ``edges`` (columns + 1,) are Z, and ``low`` and ``high`` (layers, columns, rays) are r.
    """

    edges: FloatArray
    low: FloatArray
    high: FloatArray

    @property
    def radius(self) -> float:
        """The greatest radius in mm."""
        return float(self.high.max(initial=0.0))


def solid_of(part: PolarField) -> Solid:
    """Return the solid of a milled part."""
    return Solid(part.edges, part.low, part.high)


def turned_solid(edges: FloatArray, low: FloatArray, high: FloatArray) -> Solid:
    """Return the solid of a half section with ``low`` and ``high`` (layers, columns)."""
    low, high = in_order(low, high)
    return Solid(edges, low[:, :, None], high[:, :, None])


class Patch(NamedTuple):
    """Points that are not on the walls of rays: Z and r in pixels, and normals along r, the angle and Z.

    ``ray`` (n,) counts halves of the step between rays. None means that the points are rings, at every ray.
    ``rough`` means that the wall crosses columns and rays, so that its normals vary from point to point.
    """

    z: Floats
    r: Floats
    ray: IntArray | None
    across: Floats
    way: Floats
    along: Floats
    rough: npt.NDArray[np.bool_]


class Wall(NamedTuple):
    """One side of one layer: r (columns, rays) in pixels for these ``columns`` of the surface.

    ``inside`` means that the wall faces the axis. ``bore`` (columns,) is given for the innermost wall, with
    its usual radius. ``whole`` means that no point is missing. ``leaning`` marks the columns that rise or
    fall along Z, and ``lean`` is the greatest angle in radians between a normal and the radius.
    """

    columns: IntArray
    r: Floats
    inside: bool
    leaning: npt.NDArray[np.bool_]
    lean: float
    whole: bool
    bore: Floats | None


class Surface:
    """The points of a solid at a scale, with Z measured from ``centre``.

    ``towards`` is the sign of Z of the visible faces, or 0.
    """

    def __init__(
        self, solid: Solid, scale: float, centre: float, span: tuple[float, float], towards: int
    ) -> None:
        back = max(span[0], float(solid.edges[0]))
        front = max(min(span[1], float(solid.edges[-1])), back)
        count = max(math.ceil((front - back) * scale), 1)
        at = np.linspace(back, front, 2 * count + 1)[1::2]
        self.z = ((at - centre) * scale).astype(np.float32)
        self.step = max((front - back) / count * scale, 1e-6)  # pixels
        self.turned = solid.low.shape[2] == 1
        self.rays = _rays(solid, scale)
        times = 1
        if not self.turned:
            times = min(max(math.ceil(self.rays / solid.low.shape[2]), 1), _FINEST)
            self.rays = solid.low.shape[2] * times
        layers = [_sampled(solid, layer, at, scale, times) for layer in range(len(solid.low))]
        self.low, self.high = [low for low, _ in layers], [high for _, high in layers]
        self.angles = np.arange(self.rays) * (2.0 * math.pi / self.rays)
        self.radius = max(float(high.max()) for high in self.high)
        self.thick = self.high[0] - self.low[0]
        for low, high in layers[1:]:
            self.thick += high - low
        self.walls = [wall for number, both in enumerate(layers) for wall in self._walls(number, *both)]
        self.faces = self._faces(towards, solid, (back, front)) if towards else None
        self.flanks = None if self.turned else self._flanks()

    def _walls(self, layer: int, low: Floats, high: Floats) -> list[Wall]:
        metal = high > low
        found = []
        for r, inside in ((high, False), (low, True)):
            there = metal & (r > 0.0)
            columns = np.flatnonzero(there.any(axis=1))
            if len(columns):
                kept = np.where(there[columns], r[columns], AWAY)
                whole = bool((kept > 0.0).all())
                leaning, lean = self._leaning(columns, kept)
                bore = None
                if inside and not layer:
                    bore = np.median(kept[:, :: max(kept.shape[1] // _AROUND, 1)], axis=1).astype(np.float32)
                found.append(Wall(columns, kept, inside, leaning, lean, whole, bore))
        return found

    def _leaning(self, columns: IntArray, r: Floats) -> tuple[npt.NDArray[np.bool_], float]:
        rise = np.abs(np.diff(r, axis=0))
        slanted = ((rise > 0.01) & (rise <= _GAP + 0.01)).any(axis=1) | (np.diff(columns) > 1)
        leaning = np.zeros(len(columns), np.bool_)
        leaning[1:] |= slanted
        leaning[:-1] |= slanted
        if self.turned:
            return leaning, 0.0
        turn = np.abs(np.diff(r[:, :: max(self.rays // 720, 1)], axis=1))
        steady = np.where(turn < 2.0, turn, 0.0) / np.maximum(r[:, : turn.shape[1]], 4.0)
        return leaning, math.atan(float(steady.max(initial=0.0)) * 720.0 / (2.0 * math.pi))

    def _faces(self, towards: int, solid: Solid, drawn: tuple[float, float]) -> Patch:
        """Return the parts of each column that the next column does not cover.

        The edge of the picture is not an end of the part.
        """
        beside = _beside(self.low, self.high, _GAP, round_=False)
        own, other = beside if towards > 0 else beside[::-1]
        nth, first, last = _free(self.low, self.high, own, other, _GAP)
        column, ray = own[0][nth], own[1][nth]
        inner = len(column)
        ends = (drawn[0] <= float(solid.edges[0]), drawn[1] >= float(solid.edges[-1]))
        if ends[towards > 0]:
            at = len(self.z) - 1 if towards > 0 else 0
            whole = _whole(self.low, self.high, at)
            column = np.concatenate((column, np.full(len(whole[0]), at)))
            ray = np.concatenate((ray, whole[0]))
            first, last = np.concatenate((first, whole[1])), np.concatenate((last, whole[2]))
        index, r = _filled(first, last)
        slope = (last - first) / np.float32(self.step)
        across = (1.0 / np.sqrt(1.0 + slope * slope)).astype(np.float32)
        across[first <= self.low[0][column, ray]] *= -1.0
        along = towards * slope * np.abs(across)
        across[inner:], along[inner:] = 0.0, towards
        rough = ~self._straight(column, ray, round_=False)
        rough[inner:] = False
        return Patch(
            self.z[column[index]] + np.float32(0.5 * towards * self.step),
            r,
            None if self.turned else 2 * ray[index],
            across[index],
            np.zeros_like(r),
            along[index],
            rough[index],
        )

    def _straight(self, column: IntArray, ray: IntArray, *, round_: bool) -> npt.NDArray[np.bool_]:
        """Return whether a step continues unchanged on both sides of a cell, in its column or on its ray."""
        own = self._step(column, ray, round_=round_)
        limit, thick = 0.5 * np.abs(own), self.thick[column, ray]
        straight = np.ones(len(column), np.bool_)
        if self.turned:
            return straight
        for off in (-_SPREAD, _SPREAD):
            if round_:
                at = np.clip(column + off, 0, len(self.z) - 1), ray
            else:
                at = column, (ray + off) % self.rays
            straight &= np.abs(self._step(*at, round_=round_) - own) <= limit
            straight &= np.abs(self.thick[at] - thick) <= limit
        return straight

    def _step(self, column: IntArray, ray: IntArray, *, round_: bool) -> Floats:
        """Return the change of the material thickness between the two neighbors of a cell."""
        if round_:
            return self.thick[column, (ray + 1) % self.rays] - self.thick[column, ray - 1]
        ahead, behind = np.minimum(column + 1, len(self.z) - 1), np.maximum(column - 1, 0)
        return self.thick[ahead, ray] - self.thick[behind, ray]

    def _flanks(self) -> Patch:
        """Return the material of each ray that the next ray does not cover, on either side."""
        here, there = _beside(self.low, self.high, 1.0, round_=True)
        one, other = self._flank(here, there, 1), self._flank(there, here, -1)
        return Patch(
            np.concatenate((one.z, other.z)),
            np.concatenate((one.r, other.r)),
            np.concatenate((_halves(one), _halves(other))),
            np.concatenate((one.across, other.across)),
            np.concatenate((one.way, other.way)),
            np.concatenate((one.along, other.along)),
            np.concatenate((one.rough, other.rough)),
        )

    def _flank(self, own: Cells, other: Cells, side: int) -> Patch:
        nth, first, last = _free(self.low, self.high, own, other, 1.0)
        column, ray = own[0][nth], own[1][nth]
        index, r = _filled(first, last)
        ring = np.float32(math.pi / self.rays) * (first + last)
        rest = (last - first) / np.hypot(ring, last - first)
        across = np.sqrt(np.maximum(np.float32(1.0) - rest * rest, np.float32(0.0)))
        rough = ~self._straight(column, ray, round_=True)
        halves = (2 * ray[index] + side) % (2 * self.rays)
        parts = across[index], (side * rest)[index], np.zeros_like(r), rough[index]
        return Patch(self.z[column[index]], r, halves, *parts)


def _halves(patch: Patch) -> IntArray:
    assert patch.ray is not None
    return patch.ray


def _rays(solid: Solid, scale: float) -> int:
    """Return the number of rays that are one pixel apart at the outside."""
    return max(math.ceil(2.0 * math.pi * solid.radius * scale), 90)


def _sampled(solid: Solid, layer: int, at: FloatArray, scale: float, times: int) -> tuple[Floats, Floats]:
    """Return a layer at these Z in pixels, with ``times`` as many rays.

    Missing material is 0, and only shoulders are steps.
    """
    own, beside, share, limit = _neighbours(solid.edges, at, scale)
    shape = len(at), solid.low.shape[2] * times
    filled = np.flatnonzero((solid.high[layer] > solid.low[layer]).any(axis=1)) if layer else np.arange(1)
    rows = (
        np.flatnonzero((own >= filled[0]) & (own <= filled[-1]))
        if layer and len(filled)
        else np.arange(len(at))
    )
    if not len(filled) or not len(rows):
        return np.zeros(shape, np.float32), np.zeros(shape, np.float32)
    low, high = (r[layer].astype(np.float32) * np.float32(scale) for r in (solid.low, solid.high))
    there = high > low
    low *= there
    high *= there
    own, beside, share, limit = own[rows], beside[rows], share[rows], limit[rows]
    both = there[own] & there[beside]
    found = []
    for r in (low, high):
        full = np.zeros(shape, np.float32) if layer else np.empty(shape, np.float32)
        full[rows[0] : rows[-1] + 1] = _upsampled(
            _mixed(r, own, beside, share, limit, both), there[own], times
        )
        found.append(full)
    return found[0], found[1]


def _neighbours(edges: FloatArray, at: FloatArray, scale: float) -> tuple[IntArray, IntArray, Floats, Floats]:
    """Return the column of each Z, its nearest neighbor with its share, and the step limit in pixels."""
    middles = 0.5 * (edges[1:] + edges[:-1])
    own = np.clip(np.searchsorted(edges, at, side="right") - 1, 0, len(middles) - 1)
    beside = np.clip(own + np.where(at > middles[own], 1, -1), 0, len(middles) - 1)
    apart = np.abs(middles[beside] - middles[own])
    share = np.abs(at - middles[own]) / np.maximum(apart, 1e-12) * (apart > 0.0)
    return (
        own,
        beside,
        share.astype(np.float32)[:, None],
        (_SLOPE * apart * scale).astype(np.float32)[:, None],
    )


def _mixed(
    r: Floats, own: IntArray, beside: IntArray, share: Floats, limit: Floats, both: npt.NDArray[np.bool_]
) -> Floats:
    mine = r[own]
    change = r[beside]
    change -= mine
    change *= both
    change *= np.abs(change) <= limit
    change *= share
    mine += change
    return mine


def _upsampled(r: Floats, there: npt.NDArray[np.bool_], times: int) -> Floats:
    """Return interpolated rays between rays, where neighbors form one surface."""
    if times == 1:
        return r
    change = np.roll(r, -1, axis=1)
    change -= r
    change *= there & np.roll(there, -1, axis=1)
    change *= np.abs(change) <= _NEAR
    fine = np.empty((*r.shape, times), np.float32)
    for nth in range(times):
        fine[..., nth] = r + change * np.float32(nth / times)
    return fine.reshape(len(r), -1)


def _beside(low: list[Floats], high: list[Floats], least: float, *, round_: bool) -> tuple[Cells, Cells]:
    """Return the cells that differ by more than ``least`` from the next cell, and these next cells.

    The next cell is along Z, or around the part if ``round_``.
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
        differs |= np.abs(change) > least
    column, ray = np.nonzero(differs)
    return (column, ray), ((column, (ray + 1) % low[0].shape[1]) if round_ else (column + 1, ray))


def _free(
    low: list[Floats], high: list[Floats], own: Cells, other: Cells, least: float
) -> tuple[IntArray, Floats, Floats]:
    """Return which cells of ``own`` have material that ``other`` does not cover, with its limits of r."""
    deep = np.zeros(len(own[0]), np.bool_)
    for r in high[1:]:
        if r.any():
            deep |= (r[own] > 0.0) | (r[other] > 0.0)
    found = [_free_in(low[:1], high[:1], own, other, np.flatnonzero(~deep), least)]
    if deep.any():
        found.append(_free_in(low, high, own, other, np.flatnonzero(deep), least))
    nth, first, last = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return nth.astype(np.intp), first, last


def _free_in(
    low: list[Floats], high: list[Floats], own: Cells, other: Cells, some: IntArray, least: float
) -> tuple[IntArray, Floats, Floats]:
    one, two = (own[0][some], own[1][some]), (other[0][some], other[1][some])
    mine = np.stack([r[one] for r in low]), np.stack([r[one] for r in high])
    beside = np.stack([r[two] for r in low]), np.stack([r[two] for r in high])
    if len(low) > 1:
        mine, beside = in_order(*mine), in_order(*beside)
    nth, first, last = _without(*mine, *beside, least)
    return some[nth], first, last


def _without(
    low: Floats, high: Floats, other_low: Floats, other_high: Floats, least: float
) -> tuple[IntArray, Floats, Floats]:
    """Return the parts of intervals (layers, n) that the others do not cover: index, start and end."""
    found: list[tuple[IntArray, Floats, Floats]] = []
    there = other_high > other_low
    for layer in range(len(low)):
        floor = np.zeros(low.shape[1], np.float32)
        for gap in range(len(low) + 1):
            open_end = gap == len(low)
            top = _BEYOND if open_end else np.where(there[gap], other_low[gap], _BEYOND)
            first, end = np.maximum(low[layer], floor), np.minimum(high[layer], top)
            nth = np.flatnonzero(end - first > least)
            found.append((nth, first[nth], end[nth]))
            if not open_end:
                floor = np.where(there[gap], other_high[gap], _BEYOND)
    parts = [np.concatenate(each) for each in zip(*found, strict=True)]
    return parts[0], parts[1], parts[2]


def _whole(low: list[Floats], high: list[Floats], at: int) -> tuple[IntArray, Floats, Floats]:
    """Return all the material of one column: ray, start and end."""
    found = [(np.flatnonzero(b[at] > a[at]), a[at], b[at]) for a, b in zip(low, high, strict=True)]
    parts = [np.concatenate(each) for each in zip(*((n, a[n], b[n]) for n, a, b in found), strict=True)]
    return parts[0], parts[1], parts[2]


def _filled(first: Floats, last: Floats) -> tuple[IntArray, Floats]:
    """Return points one pixel apart from ``first`` to ``last`` (n,): their index and r."""
    count = np.maximum(np.ceil(last - first), 1.0).astype(np.intp)
    index = np.repeat(np.arange(len(first)), count)
    start = np.cumsum(count) - count
    nth = np.arange(len(index)) - start[index]
    share = ((nth + 0.5) / count[index]).astype(np.float32)
    return index, first[index] + share * (last - first)[index]
