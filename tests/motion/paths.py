"""Paths of blocks that are all there."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from core.motion.axis_limits import MotionLimits
from core.motion.block_table import MotionBlock
from core.motion.motion_path import MotionPath, PathBuilder


def build_path(blocks: Iterable[MotionBlock], limits: MotionLimits, *, rpm_max: float = np.inf) -> MotionPath:
    """The path of ``blocks``; see ``PathBuilder``. Raises MotionError when a block cannot be moved."""
    builder = PathBuilder(limits, rpm_max=rpm_max)
    builder.add_blocks(blocks)
    builder.end_path()
    return builder.build_path()
