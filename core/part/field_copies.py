"""Copies of a polar field that share the columns that no tool has touched between two of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from core.part.polar_field import PolarField
from core.part.ray_cuts import FloatArray

Ends = tuple[float, float]
"""Of a column: from and to which Z."""


class FieldCopy(NamedTuple):
    """``columns`` by their ends: (2, layers, rays) of low and high; one ray: it is round."""

    columns: Mapping[Ends, FloatArray]
    edges: FloatArray
    layers: int
    rays: int
    most: int


def copied(field: PolarField, before: FieldCopy | None) -> FieldCopy:
    """A copy; what is as it was ``before`` takes no more room."""
    known = before.columns if before is not None else {}
    ends = zip(field.edges[:-1].tolist(), field.edges[1:].tolist(), strict=True)
    columns = {
        pair: _shared(field.low[:, at], field.high[:, at], known.get(pair)) for at, pair in enumerate(ends)
    }
    layers, _, rays = field.low.shape
    return FieldCopy(columns, field.edges.copy(), layers, rays, field.most)


def restored(copy: FieldCopy) -> PolarField:
    """A field of its own, as it was when it was copied."""
    shape = copy.layers, len(copy.columns), copy.rays
    low, high = np.zeros(shape), np.zeros(shape)
    for at, column in enumerate(copy.columns.values()):
        low[: column.shape[1], at], high[: column.shape[1], at] = column
    return PolarField(copy.edges.copy(), low, high, copy.most)


def _shared(low: FloatArray, high: FloatArray, known: FloatArray | None) -> FloatArray:
    """A column without its empty layers, on one ray where all are alike; the known one where that is it."""
    filled = np.flatnonzero((high > low).any(axis=1))
    deep = int(filled[-1]) + 1 if len(filled) else 0
    column = np.stack((low[:deep], high[:deep]))
    if deep and (column == column[:, :, :1]).all():
        column = column[:, :, :1].copy()
    return known if known is not None and np.array_equal(known, column) else column
