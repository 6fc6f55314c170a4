"""Paths of a mill's end on the part, from moves of plane switching and moves with C locked.

The part's frame stands still on the part: its X and Y are those of XC entered with C at 0, and polar angles
count from X towards Y. The spindle turns the part the same way: a tool on the negative X side of the lathe,
at its height, meets the point of the part at the angle -C.
"""

from __future__ import annotations

import math

import numpy as np

from core.geometry.virtual_mill import PlaneMove, Side
from core.part.ray_cuts import FloatArray

CHORD = 0.002
"""How far a chord may lie off its curve, mm."""

_AWAY = 1e-6  # mm


def plane_path(move: PlaneMove, lift: float = 0.0, chord: float = CHORD) -> FloatArray:
    """The path (n, 3) of a move of plane switching; ``lift`` leads from program Z to the part's, mm.

    On the face x, y and z of the mill's end, as ``MilledPart.mill_axial`` takes them; on the side r, z and
    the polar angle in degrees, as ``mill_radial`` does.
    """
    shares = np.linspace(0.0, 1.0, _chords(move, chord) + 1)
    if isinstance(move.frame, Side):
        return radial_path(move.machine(shares) + np.array([0.0, lift, 0.0]), far_side=move.frame.far)
    points = move.part(move.machine(shares))
    turn = math.radians(move.frame.heading)
    return _turned(points, np.full(len(points), turn), lift)


def axial_path(machine: FloatArray, height: float = 0.0, lift: float = 0.0) -> FloatArray:
    """x, y, z (n, 3) in the part's frame of a tool parallel to Z at lathe X (radius), Z, C (n, 3).

    ``height`` is how far the tool stands above the axis; mm and degrees.
    """
    spot = np.column_stack([-machine[:, 0], np.full(len(machine), height), machine[:, 1]])
    return _turned(spot, -np.radians(machine[:, 2]), lift)


def radial_path(machine: FloatArray, *, far_side: bool = False) -> FloatArray:
    """r, z and polar angle in degrees (n, 3) of a tool on a radius at lathe X (radius), Z, C (n, 3).

    It comes from the negative X side of the lathe, or from the ``far_side`` where X is positive.
    """
    x, z, c = machine.T
    return np.column_stack([x, z, 180.0 - c]) if far_side else np.column_stack([-x, z, -c])


def locked_path(start: FloatArray, end: FloatArray, chord: float = CHORD) -> FloatArray:
    """Lathe X, Z, C (n, 3) along a straight move of all three, close enough for a tool parallel to Z."""
    turn = math.radians(abs(float(end[2] - start[2])))
    far = max(abs(float(start[0])), abs(float(end[0])), _AWAY)
    count = max(math.ceil(turn / math.sqrt(8.0 * chord / far)), 1)
    return np.linspace(start, end, count + 1)


def _chords(move: PlaneMove, chord: float) -> int:
    """How many straight pieces a move is made of."""
    if move.centre is None:
        return 1 if move.straight or not _unreachable(move) else 360
    half = 2.0 * math.acos(max(1.0 - chord / max(move.radius, chord), -1.0))
    turns = max(move.length / max(move.radius, chord) / half, 1.0)
    return max(math.ceil(turns), 360 if _unreachable(move) else 1)


def _unreachable(move: PlaneMove) -> bool:
    """Whether a mill on the face passes nearer to the axis than its height lets it come."""
    return not isinstance(move.frame, Side) and move.rho(move.nearest()) < abs(move.frame.h) - _AWAY


def _turned(points: FloatArray, angles: FloatArray, lift: float) -> FloatArray:
    cos, sin = np.cos(angles), np.sin(angles)
    x, y, z = points.T
    return np.column_stack([x * cos - y * sin, x * sin + y * cos, z + lift])
