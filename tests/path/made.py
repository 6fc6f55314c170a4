"""Blocks and trails made by hand."""

from __future__ import annotations

import numpy as np

from app.path.polyline import Polyline, StrokeKind
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState

LOCKED = ModalState(c_locked=True, tool=1)

Way = tuple[float, float, float]


def turned(n: int, kind: BlockKind, start: Way, end: Way, **more: object) -> Block:
    """A block with C locked from (x, z, c) to (x, z, c)."""
    given = {"offset_x": 0.0, "offset_z": 0.0, "modal": LOCKED, **more}
    return Block(n, n, kind, "", *start, *end, **given)  # type: ignore[arg-type]


def polyline(points: list[tuple[float, float, StrokeKind]], first: list[int]) -> Polyline:
    """A trail of (z, x, stroke) points and where blocks end."""
    z, x, stroke = (np.array(column) for column in zip(*points, strict=True))
    bounds = (float(z.min()), float(z.max()), float(x.min()), float(x.max()))
    return Polyline(z.astype(float), x.astype(float), stroke.astype(np.uint8), np.array(first), bounds)
