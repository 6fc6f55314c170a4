"""Live tools on a turned part: their moves, and the polar field that they cut."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from core.interpreter.shared.elementary_blocks import Block
from core.part.milled_part import MilledPart
from core.part.polar_field import PolarField, Taken, in_order, turned_field
from core.part.ray_cuts import FloatArray, axial_path, locked_path, plane_path, radial_path
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import Piece, TurnedPart
from core.proving.tip_moves import QUICK, Place

_CONES = frozenset({ToolKind.DRILL, ToolKind.CENTRE_DRILL})
_DEEPER = 0.0254  # mm
_BESIDE = 0.002  # mm of tolerance for a slope in a wider column


class MillMove(NamedTuple):
    """One elementary block of a live tool, with its path (n, 3) for ``MilledPart``, axial or radial."""

    n: int
    line: int
    path: FloatArray
    axial: bool
    quick: bool


def mill_move(block: Block, place: Place, shape: ToolShape) -> MillMove | None:
    """Return the path of a block in the part's frame, or None without a move.

    ``place`` is added to X and Z of the block.
    """
    turns_only = (block.x, block.z) == (block.x0, block.z0)  # the feed of the block is in degrees
    quick = block.rapid or (not block.per_rev and not turns_only and block.feed >= QUICK)
    dx, dz = place
    if block.plane is not None:
        lift = dz + block.modal.secondary_z
        axial = not block.plane.on_side
        return MillMove(block.n, block.line, plane_path(block.plane, lift), axial, quick)
    ends = np.array(
        [[block.x0 + dx, block.z0 + dz, block.c0], [block.x + dx, block.z + dz, block.c]], dtype=np.float64
    )
    if np.array_equal(ends[0], ends[1]):
        return None
    axial = shape.direction[0] != 0
    if axial:
        return MillMove(block.n, block.line, axial_path(locked_path(ends[0], ends[1])), True, quick)
    far_side = float(ends[:, 0].mean()) > 0.0
    return MillMove(block.n, block.line, radial_path(ends, far_side=far_side), False, quick)


def between(path: FloatArray, first: float, last: float) -> FloatArray:
    """Return the piece of a path between two shares of it, from 0 to 1."""
    at = np.linspace(0.0, 1.0, len(path))
    shares = np.concatenate(([first], at[(at > first) & (at < last)], [last]))
    return np.column_stack([np.interp(shares, at, figures) for figures in path.T])


def cone_height(shape: ToolShape) -> float:
    """Return the height in mm of the point of a live drill; 0 for a mill."""
    if shape.kind not in _CONES or not shape.point:
        return 0.0
    return float(shape.diameter / 2.0 / np.tan(np.radians(shape.point / 2.0)))


class Milling:
    """A turned part with its polar field. Material that is turned off later is removed from the field too."""

    def __init__(self, part: TurnedPart) -> None:
        self._turned = part
        columns = part.columns
        edges: FloatArray = columns.first + columns.step * (
            np.arange(columns.number + 1, dtype=np.float64) - 0.5
        )
        self._part = MilledPart(turned_field(edges, part.low, part.high))
        self._volume = part.volume  # volume of the turned part at the last update of the field

    @classmethod
    def of(cls, part: TurnedPart, field: PolarField, volume: float) -> Milling:
        """Return the state with an existing field; ``volume`` is the turned volume at its last update."""
        milling = cls.__new__(cls)
        milling._turned, milling._part, milling._volume = part, MilledPart(field), volume
        return milling

    @property
    def even_with(self) -> float:
        """The volume in mm³ of the turned part at the last update of the field."""
        return self._volume

    @property
    def field(self) -> PolarField:
        """The material, updated with the turned cuts."""
        self._follow()
        return self._part.field

    @property
    def nbytes(self) -> int:
        """The memory of the field in bytes."""
        return self._part.field.low.nbytes + self._part.field.high.nbytes

    @property
    def left(self) -> float:
        """The volume in mm³ of the material in the chuck."""
        return self.field.volume

    def cut(self, move: MillMove, shape: ToolShape) -> Taken:
        """Remove the material that a live tool sweeps, and return it."""
        self._follow()
        part, (radius, length, point) = self._part, _sizes(shape)
        if move.axial:
            return part.mill_axial(move.path, radius, length, point)
        return part.mill_radial(move.path, radius, length, point=point)

    def touches(self, move: MillMove, shape: ToolShape) -> bool:
        """Return whether a live tool moves along a face: it would hit material .001 in deeper."""
        self._follow()
        part, (radius, length, point) = self._part, _sizes(shape)
        if move.axial:
            return part.meets_axial(move.path - [0.0, 0.0, _DEEPER], radius, length, point)
        return part.meets_radial(move.path - [_DEEPER, 0.0, 0.0], radius, length, point=point)

    def less_milled(self, piece: Piece) -> Piece:
        """Return a piece that was just parted off, without the volume that live tools had removed."""
        if not piece.outside:
            return piece
        field = self._part.field
        front, back = piece.outside[0][0], piece.outside[-1][0]
        there = (field.middles < front) & (field.middles > back)
        return piece._replace(volume=min(float(field.volumes[there].sum()), piece.volume))

    def sides(self) -> tuple[Piece, Piece]:
        """Return both halves of the section with C at 0: X+, then X-."""
        field = self.field
        rays = field.low.shape[2]  # =
        upper, lower = (
            _side(field.edges, field.low[:, :, ray], field.high[:, :, ray]) for ray in (rays // 2, 0)
        )
        return upper, lower

    def _follow(self) -> None:
        """Remove from the field the material that has been turned off since the last update."""
        turned = self._turned
        if turned.volume == self._volume:
            return
        self._volume = turned.volume
        field = self._part.field
        at = np.clip(
            np.rint((field.middles - turned.columns.first) / turned.columns.step).astype(np.intp),
            0,
            turned.columns.number - 1,
        )
        everywhere = slice(0, len(field.middles))
        for start, end in _gaps(*in_order(turned.low[:, at], turned.high[:, at])):
            field.take(everywhere, slice(None), start[:, None], end[:, None])


def _side(edges: FloatArray, low: FloatArray, high: FloatArray) -> Piece:
    """Return one half of a section as the profiles of a piece without volume."""
    there = high > low
    outer = np.max(np.where(there, high, 0.0), axis=0)
    inner = np.min(np.where(there, low, np.inf), axis=0)
    columns = np.flatnonzero(outer > 0.0)[::-1].tolist()
    outside, bore = (
        [(float(z), float(r[at])) for at in columns for z in (edges[at + 1], edges[at])]
        for r in (outer, inner)
    )
    return Piece(0.0, outside, bore if any(r > 0.0 for _, r in bore) else None, None)


def _sizes(shape: ToolShape) -> tuple[float, float, float]:
    """Return radius, cutting length and height of the point."""
    return shape.diameter / 2.0, shape.length or math.inf, cone_height(shape)


def _gaps(low: FloatArray, high: FloatArray) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield the ranges without material in sorted layers (layers, columns), from the axis outward."""
    there = high > low
    begins = np.where(there, low - _BESIDE, np.inf)
    ends = np.maximum.accumulate(np.where(there, high + _BESIDE, 0.0), axis=0)
    yield np.zeros(low.shape[1]), begins[0]
    for layer in range(len(low)):
        outer = begins[layer + 1] if layer + 1 < len(low) else np.full(low.shape[1], np.inf)
        yield ends[layer], outer
