"""The part at one time of a program: section, tool, what was hit, and copies to go on from.

Arrays of their own, which another thread may keep.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.language.diagnostics import Diagnostic
from core.part.polar_field import FieldCopy, Taken, copied, restored
from core.part.solid_bodies import Round
from core.part.stock import Clamping, Stock
from core.part.swept_edge import FloatArray, Point
from core.part.turned_part import Cut, TurnedPart
from core.proving.checks.part_checks import is_serious
from core.proving.milling import Milling
from core.proving.part_making import PartMaking
from core.proving.tip_moves import LiveStep, Step

_TOUCH = 1e-6  # mm
_PLACES = 40  # along a hit in chuck or tailstock
_OF_CLAMPING = frozenset({"into-chuck", "into-tailstock"})
# What a block that is found to be wrong for another reason takes off is what it shall take off.
_OF_METAL = frozenset(
    {"rapid-into-stock", "feed-into-holder", "holder-into-stock", "through-part", "neighbour-tool"}
)
Metal = tuple[FloatArray, FloatArray]
"""Lowest and highest radius of each column's layers, mm."""
_EVERY = 16  # blocks from one copy to the next, at first
_MOST_COPIES = 96
_MOST_BYTES = 96e6  # of all copies


class Half(NamedTuple):
    """One side of the section: ``edges`` (columns + 1,) of Z, rising; metal from ``low`` to ``high`` (layers,
    columns), radii; mm."""

    edges: FloatArray
    low: FloatArray
    high: FloatArray


class Hit(NamedTuple):
    """Metal that was met where nothing may be met: ``finding``, and from ``low`` to ``high`` at each ``z``
    (n,), ``wide`` mm of Z each."""

    finding: Diagnostic
    z: FloatArray
    low: FloatArray
    high: FloatArray
    wide: float


class PlacedTool(NamedTuple):
    """A tool where it stands: its control point ``at``, its outlines (k, 2) of Z and r, mm.

    ``assumed``: nobody has described it, its body is what such tools have. ``round``: about which axis it is.
    """

    number: int
    at: Point
    cutting: tuple[FloatArray, ...]
    body: tuple[FloatArray, ...]
    assumed: bool
    round: Round = Round.NOT


class PartInstant(NamedTuple):
    """The part when ``block`` blocks are done and ``share`` of the next.

    ``near`` is the side of the section at X+, ``far`` that beyond the axis; None: there is no metal.
    ``hits`` and ``findings`` are those that have come up by then. ``reach`` is how far the tip may go, from
    and to which Z and r.
    """

    block: int
    share: float
    line: int
    near: Half | None
    far: Half | None
    stock: Stock | None
    tool: PlacedTool | None
    hits: tuple[Hit, ...]
    findings: tuple[Diagnostic, ...]
    pieces: int
    clamping: Clamping | None = None
    is_open: bool = False
    reach: tuple[Point, Point] | None = None
    c: float = 0.0  # degrees at which the part is held, or was last


def metal_of(part: TurnedPart | None) -> Metal | None:
    """The metal of this moment, to be compared with later."""
    return None if part is None else (part.low.copy(), part.high.copy())


def hit_of(found: Diagnostic, step: Step, making: PartMaking, before: Metal | None) -> Hit | None:
    """What the block just seen has hit, for one of its findings; ``before`` is the metal before it."""
    if not is_serious(found):
        return None
    if found.check in _OF_CLAMPING:
        met = making.findings.into_clamping.get((found.check, found.line))
        return _held_hit(found, met, making.findings.clamping, making.stock)
    if found.check not in _OF_METAL:
        return None
    if isinstance(step, LiveStep):
        return _milled_hit(found, making.milled_last)
    if before is None or making.part is None:
        return None
    return _hit(found, before, making.part)


def _held_hit(found: Diagnostic, met: Cut | None, held: Clamping | None, stock: Stock | None) -> Hit | None:
    """Where a tool would come into chuck, collet or tailstock: from its outside as deep as it does."""
    if met is None or held is None or stock is None:
        return None
    body = held.tailstock if found.check == "into-tailstock" else held.around(stock)
    if body is None:
        return None
    low, high = max(min(met.back, met.front), body.back), min(max(met.back, met.front), body.front)
    z = np.linspace(low, high, _PLACES)
    outside = body.outside_at(z)
    return Hit(found, z, np.maximum(outside - met.depth, 0.0), outside, (high - low) / (_PLACES - 1))


def _hit(found: Diagnostic, before: Metal, part: TurnedPart) -> Hit | None:
    """What a block has taken off, from the lowest to the highest of each column."""
    layers = len(before[0])
    low, high = part.low[:layers], part.high[:layers]
    was = before[1] > before[0]
    above = was & (before[1] - high > _TOUCH)
    below = was & (low - before[0] > _TOUCH)
    touched = (above | below).any(axis=0)
    if not touched.any():
        return None
    least = np.minimum(
        np.where(above, np.maximum(high, before[0]), np.inf).min(axis=0),
        np.where(below, before[0], np.inf).min(axis=0),
    )
    most = np.maximum(
        np.where(above, before[1], 0.0).max(axis=0),
        np.where(below, np.minimum(low, before[1]), 0.0).max(axis=0),
    )
    z = part.columns.middles[touched]
    return Hit(found, z, least[touched], most[touched], part.columns.step)


def _milled_hit(found: Diagnostic, met: Taken) -> Hit | None:
    """What a live tool has met."""
    if not met:
        return None
    middle, low, high = (np.array([each]) for each in (0.5 * (met.back + met.front), met.low, met.high))
    return Hit(found, middle, low, high, met.front - met.back)


class PartCopies:
    """By how many steps were done; of too many every other goes.

    Of a milled part they share the columns that were not touched between two of them.
    """

    def __init__(self) -> None:
        self._copies: dict[int, tuple[PartMaking, FieldCopy | None, float]] = {}
        self._every = _EVERY

    def before(self, done: int) -> int:
        """The last copy that is not behind so many steps."""
        return max(each for each in self._copies if each <= done)

    def copy(self, done: int) -> PartMaking:
        """One to go on from."""
        kept, field, even_with = self._copies[done]
        making = kept.copy()
        if field is not None and making.part is not None:
            making.milling = Milling.of(making.part, restored(field), even_with)
        return making

    def perhaps(self, done: int, making: PartMaking) -> None:
        """Keep one when it is time."""
        if done % self._every == 0 and done not in self._copies:
            self.keep(done, making)

    def keep(self, done: int, making: PartMaking) -> None:
        """Keep a copy of what there is after so many steps."""
        milling = making.milling
        field, even_with = None, 0.0
        if milling is not None:
            near = self._copies.get(max((each for each in self._copies if each < done), default=-1))
            field = copied(milling.field, near[1] if near is not None else None)
            even_with = milling.even_with
        making.milling = None
        self._copies[done] = making.copy(), field, even_with
        making.milling = milling
        while len(self._copies) > _MOST_COPIES or (self._size > _MOST_BYTES and len(self._copies) > 2):
            self._every *= 2
            for each in [each for each in self._copies if each % self._every]:
                del self._copies[each]

    @property
    def _size(self) -> int:
        """Bytes of all of them; what is shared counts once."""
        columns = {
            id(column): column.nbytes
            for _, field, _ in self._copies.values()
            if field is not None
            for column in field.columns.values()
        }
        return sum(columns.values()) + sum(making.nbytes for making, _, _ in self._copies.values())
