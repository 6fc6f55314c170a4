"""Points of a trail that are worth measuring from: ends, middles of arcs, crossings; and what lies nearest.

No answer here takes longer than a look at every point once, so that a key may ask among a million.
"""

from __future__ import annotations

import numpy as np

from app.desk.drawing.spots import Kind, Spot
from app.desk.drawing.trail import Bounds, Floats, Stroke, Trail

MOST_CROSSED = 300  # stretches in sight up to which crossings are looked for
APART = 1e-6  # mm: nearer points are one
WIDE = 1.2  # how far aside of an arrow key's direction a point may lie, of its distance along it


class Features:
    """Of one trail; crossings are those in sight, looked for when another part is looked at."""

    def __init__(self, trail: Trail) -> None:
        self._trail = trail
        self._ends = _ends(trail)
        self._box: Bounds | None = None
        self._crossings = np.zeros((0, 2))

    def look(self, box: Bounds) -> None:
        """This part is in sight: (least z, greatest z, least x, greatest x)."""
        if box != self._box:
            self._box, self._crossings = box, crossings(self._trail, box)

    def nearest(self, z: float, x: float) -> Spot | None:
        """The point nearest to a place."""
        best: tuple[float, Spot] | None = None
        for kind, table in self._tables():
            if len(table):
                off = (table[:, 0] - z) ** 2 + (table[:, 1] - x) ** 2
                at = int(np.argmin(off))
                if best is None or off[at] < best[0] - APART**2:
                    best = float(off[at]), Spot(float(table[at, 0]), float(table[at, 1]), kind)
        return best[1] if best else None

    def towards(self, z: float, x: float, way: tuple[int, int]) -> Spot | None:
        """The next point in a direction, (1, 0) for Z+ and (0, 1) for X+: near, and not far aside of it."""
        best: tuple[float, Spot] | None = None
        for kind, table in self._tables():
            dz, dx = table[:, 0] - z, table[:, 1] - x
            along, aside = dz * way[0] + dx * way[1], np.abs(dz * way[1] + dx * way[0])
            fits = np.flatnonzero((along > APART) & (aside <= WIDE * along))
            if len(fits):
                cost = along[fits] + aside[fits]
                at = int(np.argmin(cost))
                if best is None or cost[at] < best[0] - APART:
                    there = fits[at]
                    best = float(cost[at]), Spot(float(table[there, 0]), float(table[there, 1]), kind)
        return best[1] if best else None

    def following(self, z: float, x: float, steps: int) -> Spot | None:
        """The end that comes so many steps after this one along the path, going on at the other end."""
        ends = self._ends
        if not len(ends):
            return None
        at = int(np.argmin((ends[:, 0] - z) ** 2 + (ends[:, 1] - x) ** 2))
        for _ in range(len(ends)):
            at = (at + steps) % len(ends)
            if abs(ends[at, 0] - z) > APART or abs(ends[at, 1] - x) > APART:
                break
        return Spot(float(ends[at, 0]), float(ends[at, 1]), Kind.END)

    def _tables(self) -> tuple[tuple[Kind, Floats], ...]:
        return (
            (Kind.END, self._ends),
            (Kind.CENTRE, self._trail.centres),
            (Kind.CROSSING, self._crossings),
        )


def _ends(trail: Trail) -> Floats:
    """Ends of blocks and starts after jumps (n, 2), along the path."""
    told = trail.stroke == Stroke.JUMP
    told[trail.first[1:][np.diff(trail.first) > 0] - 1] = True
    index = np.flatnonzero(told)
    return np.column_stack((trail.z[index], trail.x[index]))


def crossings(trail: Trail, box: Bounds) -> Floats:
    """Where stretches within a box cross each other (n, 2); none where there are too many of them."""
    z0, x0, z1, x1 = trail.z[:-1], trail.x[:-1], trail.z[1:], trail.x[1:]
    seen = trail.stroke[1:] != Stroke.JUMP
    seen &= (np.maximum(z0, z1) >= box[0]) & (np.minimum(z0, z1) <= box[1])
    seen &= (np.maximum(x0, x1) >= box[2]) & (np.minimum(x0, x1) <= box[3])
    index = np.flatnonzero(seen)
    if len(index) > MOST_CROSSED:
        return np.zeros((0, 2))
    a, b = np.triu_indices(len(index), 2)
    a, b = index[a], index[b]
    ax, az, bx, bz = x1[a] - x0[a], z1[a] - z0[a], x1[b] - x0[b], z1[b] - z0[b]
    cross = az * bx - ax * bz
    dz, dx = z0[b] - z0[a], x0[b] - x0[a]
    safe = np.where(np.abs(cross) > 1e-12, cross, np.inf)
    s, t = (dz * bx - dx * bz) / safe, (dz * ax - dx * az) / safe
    met = (np.abs(cross) > 1e-12) & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    return np.column_stack((z0[a] + s * az, x0[a] + s * ax))[met]


def point_at(trail: Trail, z: float, x: float, within: float) -> int | None:
    """The point that ends the stretch nearest to a place, no farther than ``within`` mm; None: none is."""
    z0, x0, z1, x1 = trail.z[:-1], trail.x[:-1], trail.z[1:], trail.x[1:]
    near = trail.stroke[1:] != Stroke.JUMP
    near &= (np.maximum(z0, z1) >= z - within) & (np.minimum(z0, z1) <= z + within)
    near &= (np.maximum(x0, x1) >= x - within) & (np.minimum(x0, x1) <= x + within)
    index = np.flatnonzero(near)
    if not len(index):
        return None
    z0, x0, dz, dx = z0[index], x0[index], (z1 - z0)[index], (x1 - x0)[index]
    size = np.maximum(dz * dz + dx * dx, 1e-18)
    share = np.clip(((z - z0) * dz + (x - x0) * dx) / size, 0.0, 1.0)
    off = np.hypot(z0 + share * dz - z, x0 + share * dx - x)
    at = int(np.argmin(off))
    return int(index[at]) + 1 if off[at] <= within else None
