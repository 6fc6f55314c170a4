"""The part at one time of a program: section, tool and hits, and copies from which to continue.

All arrays are independent, so another thread may store them.
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
_PLACES = 40  # points along a hit in chuck or tailstock
_OF_CLAMPING = frozenset({"into-chuck", "into-tailstock"})
# For other findings, the material that a block removes is the intended cut.
_OF_METAL = frozenset(
    {"rapid-into-stock", "feed-into-holder", "holder-into-stock", "through-part", "neighbour-tool"}
)
Metal = tuple[FloatArray, FloatArray]
"""Lowest and highest radius of each column's layers, mm."""
_EVERY = 16  # initial number of blocks between two copies
_MOST_COPIES = 96
_MOST_BYTES = 96e6  # bytes of all copies


class Half(NamedTuple):
    """One side of the section.

    ``edges`` (columns + 1,) are ascending Z. The material is from ``low`` to ``high`` (layers, columns), as
    radii in mm.
    """

    edges: FloatArray
    low: FloatArray
    high: FloatArray


class Hit(NamedTuple):
    """Material that was hit by a fault of the program.

    ``finding`` is the diagnostic. The hit is from ``low`` to ``high`` at each ``z`` (n,), with a width of
    ``wide`` mm in Z each.
    """

    finding: Diagnostic
    z: FloatArray
    low: FloatArray
    high: FloatArray
    wide: float


class PlacedTool(NamedTuple):
    """A tool at its position: its control point ``at``, and its outlines (k, 2) of Z and r in mm.

    ``assumed`` means that its shape is not specified, so its body is a typical one. ``round`` is the axis
    about which it is round.
    """

    number: int
    at: Point
    cutting: tuple[FloatArray, ...]
    body: tuple[FloatArray, ...]
    assumed: bool
    round: Round = Round.NOT


class PartInstant(NamedTuple):
    """The part when ``block`` blocks and the ``share`` of the next one are done.

    ``near`` is the side of the section at X+, and ``far`` the opposite side; None means no material. ``hits``
    and ``findings`` are those up to this time. ``reach`` is the range of the tip in Z and r.
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
    c: float = 0.0  # present or last angle of an engaged C axis, degrees


def metal_of(part: TurnedPart | None) -> Metal | None:
    """Return a copy of the present material, for a later comparison."""
    return None if part is None else (part.low.copy(), part.high.copy())


def hit_of(found: Diagnostic, step: Step, making: PartMaking, before: Metal | None) -> Hit | None:
    """Return the hit of the last block for one of its findings, or None.

    ``before`` is the material before that block.
    """
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
    """Return the hit of a tool in chuck, collet or tailstock, from its outside to the depth of the cut."""
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
    """Return the material that a block has removed, from the lowest to the highest of each column."""
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
    """Return the material that a live tool has hit."""
    if not met:
        return None
    middle, low, high = (np.array([each]) for each in (0.5 * (met.back + met.front), met.low, met.high))
    return Hit(found, middle, low, high, met.front - met.back)


class PartCopies:
    """Copies of the part by the number of steps done. If there are too many, every second one is dropped.

    Copies of a milled part share the columns that did not change between them.
    """

    def __init__(self) -> None:
        self._copies: dict[int, tuple[PartMaking, FieldCopy | None, float]] = {}
        self._every = _EVERY

    def before(self, done: int) -> int:
        """Return the number of steps of the last copy at or before ``done`` steps."""
        return max(each for each in self._copies if each <= done)

    def copy(self, done: int) -> PartMaking:
        """Return a part from which to continue."""
        kept, field, even_with = self._copies[done]
        making = kept.copy()
        if field is not None and making.part is not None:
            making.milling = Milling.of(making.part, restored(field), even_with)
        return making

    def perhaps(self, done: int, making: PartMaking) -> None:
        """Store a copy if the interval has passed."""
        if done % self._every == 0 and done not in self._copies:
            self.keep(done, making)

    def keep(self, done: int, making: PartMaking) -> None:
        """Store a copy of the part after ``done`` steps."""
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
        """The memory of all copies in bytes; shared columns count once."""
        columns = {
            id(column): column.nbytes
            for _, field, _ in self._copies.values()
            if field is not None
            for column in field.columns.values()
        }
        return sum(columns.values()) + sum(making.nbytes for making, _, _ in self._copies.values())
