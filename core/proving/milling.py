"""Live tools at work on what has been turned: the polar field that begins with their first cut."""

from __future__ import annotations

import math

import numpy as np

from core.part.milled_part import MilledPart
from core.part.polar_field import PolarField, Taken, turned_field
from core.part.swept_edge import FloatArray
from core.part.tool_shape import ToolShape
from core.part.turned_part import Piece, TurnedPart
from core.proving.mill_moves import MillMove, cone_height

_BESIDE = 0.01  # mm


class Milling:
    """A turned part and the field of its metal; what is turned off later leaves the field as well."""

    def __init__(self, part: TurnedPart) -> None:
        self._turned = part
        columns = part.columns
        edges: FloatArray = columns.first + columns.step * (
            np.arange(columns.number + 1, dtype=np.float64) - 0.5
        )
        self._part = MilledPart(turned_field(edges, part.low, part.high))
        self._volume = part.volume  # of the turned part, when its field was last made even with it
        self.removed = 0.0  # mm³, by live tools alone

    @property
    def field(self) -> PolarField:
        """The metal, even with what has been turned."""
        self._follow()
        return self._part.field

    @property
    def nbytes(self) -> int:
        """Memory of the field."""
        return self._part.field.low.nbytes + self._part.field.high.nbytes

    @property
    def left(self) -> float:
        """mm³ that the chuck holds."""
        return self.field.volume

    def cut(self, move: MillMove, shape: ToolShape) -> Taken:
        """Take off what a live tool sweeps."""
        self._follow()
        length = shape.length or math.inf
        radius, point = shape.diameter / 2.0, cone_height(shape)
        work = self._part.mill_axial if move.axial else self._part.mill_radial
        met = work(move.path, radius, length=length, point=point)
        self.removed += met.volume
        return met

    def fallen(self, piece: Piece) -> Piece:
        """A piece that has just been parted off, less what live tools had taken out of it before it fell."""
        if not piece.outside:
            return piece
        field = self._part.field
        front, back = piece.outside[0][0], piece.outside[-1][0]
        there = (field.middles < front) & (field.middles > back)
        return piece._replace(volume=min(float(field.volumes[there].sum()), piece.volume))

    def _follow(self) -> None:
        """Take out of the field what has been turned off since."""
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
        outer, inner = turned.outermost[at], turned.innermost[at]
        everywhere = slice(0, len(field.middles))
        endless = np.full((len(at), 1), math.inf)
        field.take(everywhere, slice(None), outer[:, None] + _BESIDE * (outer > 0.0)[:, None], endless)
        bored = np.where(inner > _BESIDE, inner - _BESIDE, 0.0)
        field.take(everywhere, slice(None), np.zeros((len(at), 1)), bored[:, None])
