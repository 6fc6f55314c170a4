"""Samples of the scope between two looks of the control, in memory that was set aside beforehand."""

from __future__ import annotations

import struct

import numpy as np

from core.ports import FloatArray

KEPT = 8192  # rows: eight seconds at 1 ms for a control that is late


class SampleLog:
    """Rows as ``core.ports.SampleSource`` has them, added by a driver and taken by its control."""

    def __init__(self, axes: int, kept: int = KEPT) -> None:
        self.width = 5 + 3 * axes
        self._row = struct.Struct(f"={self.width}d")
        self._kept = kept
        self._bytes = bytearray(kept * self._row.size)
        self._added = self._taken = 0
        self._rows = np.frombuffer(self._bytes, dtype=np.float64).reshape(kept, self.width)
        self._none = np.empty((0, self.width))
        self.last = -np.inf  # time of the newest row

    def add(self, t: float, *figures: float) -> None:
        """One more row; the oldest goes when there is no room."""
        self._row.pack_into(self._bytes, self._added % self._kept * self._row.size, t, *figures)
        self._added += 1
        self.last = t

    def extend(self, rows: FloatArray) -> None:
        """Add the newest of these rows, as many as the log has room for."""
        rows = rows[-self._kept :]
        at = self._added % self._kept
        head = rows[: self._kept - at]
        self._rows[at : at + len(head)] = head
        self._rows[: len(rows) - len(head)] = rows[len(head) :]
        self._added += len(rows)
        self.last = rows[-1, 0]

    def take(self, most: int = KEPT) -> FloatArray:
        """The oldest rows that have not been taken, ``most`` at a time."""
        first = max(self._taken, self._added - self._kept)
        count = min(self._added - first, most)
        if not count:
            return self._none
        self._taken = first + count
        at = first % self._kept
        if at + count <= self._kept:
            return self._rows[at : at + count].copy()
        return np.concatenate((self._rows[at:], self._rows[: at + count - self._kept]))
