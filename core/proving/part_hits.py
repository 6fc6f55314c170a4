"""Where a block has met metal, chuck or tailstock that it may not meet: as much of it as is shown."""

from __future__ import annotations

import numpy as np

from core.language.diagnostics import Diagnostic
from core.part.clamping import Clamping
from core.part.polar_field import Taken
from core.part.stock import Stock
from core.part.swept_edge import FloatArray
from core.part.turned_part import Cut, TurnedPart
from core.proving.part_checks import is_serious
from core.proving.part_instant import Hit
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
