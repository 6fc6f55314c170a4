"""How one axis rides by hand: pieces of constant acceleration that always end at rest. Pure arithmetic."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from core.machine.model import Axis
from core.ports import Segments

Piece = tuple[float, float, float]  # seconds, speed at its start, acceleration

MARGIN = 0.01  # mm or degrees kept from the soft limit
_SHORTEST = 1e-12  # s; a piece that takes less is none
_SAME = 1e-9  # mm or degrees; places nearer than that are one


def room(axis: Axis, at: float, direction: float) -> float:
    """How far the axis may go in this direction; less than a count is nothing."""
    if axis.travel is None:
        return math.inf
    low, high = axis.travel
    left = (high - at if direction > 0.0 else at - low) - MARGIN
    return left if left > axis.count else 0.0


def ride(v0: float, v1: float, a: float, time: float, way: float) -> list[Piece]:
    """To ``v1``, on for the rest of ``time``, then to rest, within ``way`` mm.

    A ride that ``way`` is too short for goes less fast or less long. Braking alone takes v0²/2a.
    """
    if v0 * v1 < 0.0:
        first = abs(v0) / a
        return [(first, v0, -math.copysign(a, v0)), *ride(0.0, v1, a, time - first, way)]
    sign = math.copysign(1.0, v1 or v0)
    here, top = abs(v0), abs(v1)
    reach = math.sqrt(max(here * here / 2.0 + a * max(way, 0.0), 0.0)) if math.isfinite(way) else math.inf
    top = max(min(top, reach, here + a * max(time, 0.0)), 0.0) if top > here else min(top, reach)
    change = abs(top - here) / a
    least = change * (here + top) / 2.0 + top * top / (2.0 * a)
    cruise = max(time - change, 0.0) if top > 0.0 else 0.0
    if cruise and math.isfinite(way):
        cruise = min(cruise, max(way - least, 0.0) / top)
    return _pieces(
        (change, v0, sign * math.copysign(a, top - here)),
        (cruise, sign * top, 0.0),
        (top / a, sign * top, -sign * a),
    )


def step(distance: float, speed: float, a: float) -> list[Piece]:
    """From rest to rest over exactly ``distance``: up to ``speed``, on, down again.

    A way too short for that speed is half speeding up, half braking: top = √(a·|distance|).
    """
    sign, way = math.copysign(1.0, distance), abs(distance)
    top = min(speed, math.sqrt(a * way))
    change = top / a
    return _pieces(
        (change, 0.0, sign * a),
        ((way - top * change) / top, sign * top, 0.0),
        (change, sign * top, -sign * a),
    )


def reach(v0: float, way: float, top: float, a: float) -> list[Piece]:
    """From speed ``v0`` to rest at exactly ``way`` from here, no faster than ``top`` once it is that slow.

    A ``way`` that lies behind, or is shorter than the braking, is come back to from rest.
    """
    stop = v0 * abs(v0) / (2.0 * a)
    if v0 * way < 0.0 or abs(stop) > abs(way) + _SAME:
        brake = (abs(v0) / a, v0, -math.copysign(a, v0))
        back = way - stop
        return _pieces(brake, *(step(back, top, a) if abs(back) > _SAME else ()))
    if abs(way) <= _SAME:
        return []
    sign, here, left = math.copysign(1.0, way), abs(v0), abs(way)
    peak = min(top, math.sqrt(a * left + here * here / 2.0))
    change = abs(peak - here) / a
    cruise = (left - change * (here + peak) / 2.0 - peak * peak / (2.0 * a)) / peak
    return _pieces(
        (change, v0, sign * math.copysign(a, peak - here)),
        (cruise, sign * peak, 0.0),
        (peak / a, sign * peak, -sign * a),
    )


def _pieces(*pieces: Piece) -> list[Piece]:
    return [piece for piece in pieces if piece[0] > _SHORTEST]


def segments(start: float, p: npt.NDArray[np.float64], axis: int, pieces: list[Piece]) -> Segments:
    """The pieces of one axis from ``start`` on as setpoints of all; the others stay at ``p``."""
    n = len(pieces)
    dt = np.array([piece[0] for piece in pieces])
    t = start + np.concatenate([[0.0], np.cumsum(dt)[:-1]])
    position, v, a = np.tile(p, (n, 1)), np.zeros((n, len(p))), np.zeros((n, len(p)))
    v[:, axis] = [piece[1] for piece in pieces]
    a[:, axis] = [piece[2] for piece in pieces]
    way = (v[:, axis] + 0.5 * a[:, axis] * dt) * dt
    position[1:, axis] += np.cumsum(way)[:-1]
    return Segments(t, dt, position, v, a)
