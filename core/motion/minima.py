"""Reachable speeds by running minima: the look-ahead, without a loop over the pieces."""

from __future__ import annotations

import numpy as np

from core.motion.limits import FloatArray

_FEW = 24  # limits, up to which a plain loop costs less than arrays
_ROW = 256  # sums restart every row, so that rounding stays below 1e-9 of a row's sum


def reachable_forward(limit: FloatArray, gain: FloatArray) -> FloatArray:
    """Largest r (n+1,) with r[i] ≤ limit[i] and r[i+1] ≤ r[i] + gain[i].

    With squared speeds as ``limit`` and 2·a·length as ``gain`` (n,) ≥ 0 it is what acceleration can reach:
    r[i] = min over j ≤ i of limit[j] + (W[i] - W[j]), W the running sum of gain.
    """
    count = len(limit)
    if count <= _FEW:
        return _one_by_one(limit.tolist(), gain.tolist())
    rows = -(-count // _ROW)
    top = float(limit[np.isfinite(limit)].max(initial=0.0))
    # A gain as large as the largest limit decouples its neighbours; more would only cost digits.
    steps = np.zeros(rows * _ROW)
    np.minimum(gain, top, out=steps[1:count])
    limits = np.full(rows * _ROW, np.inf)
    limits[:count] = limit
    table, sums = limits.reshape(rows, _ROW), np.cumsum(steps.reshape(rows, _ROW), axis=1)
    local = np.minimum.accumulate(table - sums, axis=1)
    carried = np.minimum(local, _carry(local[:, -1].tolist(), sums[:, -1].tolist())[:, None]) + sums
    return _sharpened(carried.reshape(-1)[:count], limit, steps[1:count])


def reachable_backward(limit: FloatArray, gain: FloatArray) -> FloatArray:
    """Largest r (n+1,) with r[i] ≤ limit[i] and r[i] ≤ r[i+1] + gain[i]: what braking allows."""
    return reachable_forward(limit[::-1], gain[::-1])[::-1]


def _one_by_one(limits: list[float], gains: list[float]) -> FloatArray:
    reached = limits[:1]
    for limit, gain in zip(limits[1:], gains, strict=True):
        reached.append(max(min(limit, reached[-1] + gain), 0.0))
    return np.array(reached)


def _carry(lows: list[float], totals: list[float]) -> FloatArray:
    """For each row, what the rows before it allow at its start."""
    carry, carries = np.inf, []
    for low, total in zip(lows, totals, strict=True):
        carries.append(carry)
        carry = min(carry, low) + total
    return np.array(carries)


def _sharpened(rough: FloatArray, limit: FloatArray, steps: FloatArray) -> FloatArray:
    """The same minima with the rounding of the sums taken out of every place where a limit holds."""
    sharp = rough.copy()
    np.minimum(limit[1:], rough[:-1] + steps, out=sharp[1:])
    sharp[0] = limit[0]
    np.minimum(limit[1:], sharp[:-1] + steps, out=sharp[1:])
    return np.maximum(sharp, 0.0)
