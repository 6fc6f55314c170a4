"""Passes of equal depth, as the cycles of all dialects count them: pecks, cuts, plunges and levels."""

from __future__ import annotations

from math import ceil

_WHOLE = 1e-6  # of a pass: what a decimal fraction lacks in binary


def pass_count(whole: float, most: float) -> int:
    """Return how many passes of ``most`` mm at most a depth of ``whole`` mm takes."""
    return ceil(whole / most - _WHOLE)


def equal_depths(whole: float, count: int) -> list[float]:
    """Return the depths of equal passes, the whole depth last."""
    return [whole * k / count for k in range(1, count + 1)]
