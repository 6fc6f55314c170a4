"""Where the spindle will be: the encoder's last readings, and what follows from them for the next moments."""

from __future__ import annotations

from collections import deque

import numpy as np

from core.executor.alarms import TroubleError

_WINDOW = 0.2  # s of readings that count; longer is quieter, shorter follows a changing speed better
_DEGREE = 3
_CURVED = 0.06  # s beyond the last reading for which a change of speed is taken to go on
_LEAST = 8  # readings


class Turns:
    """A cubic through the encoder's readings of the last moments; revolutions, signed, and seconds.

    A reading every 10 ms in 4096 steps a turn tells the angle 45 ms ahead within .15 degree, and with a speed
    that swings by 2 % in two seconds within .2 degree (docs/decisions/0009-threads.md).
    """

    def __init__(self) -> None:
        self._reads: deque[tuple[float, float]] = deque()
        self._fit: tuple[list[float], float] | None = None

    def note(self, read: tuple[float, float] | None) -> None:
        """A reading (time, revolutions), None from a spindle without encoder."""
        if read is None:
            self._reads.clear()
        elif not self._reads or read[0] > self._reads[-1][0]:
            self._reads.append(read)
            while self._reads[0][0] < read[0] - _WINDOW:
                self._reads.popleft()
        else:
            return
        self._fit = None

    @property
    def known(self) -> bool:
        """Whether enough was read of late: not right after the control was away, never without encoder."""
        return len(self._reads) >= _LEAST

    def at(self, t: float) -> tuple[float, float] | None:
        """(revolutions, revolutions per second) at ``t``; None as long as too little has been read."""
        if not self.known:
            return None
        if self._fit is None:
            self._fit = self._fitted()
        shape, base = self._fit
        u = t - self._reads[-1][0]
        near = min(u, _CURVED)
        turns = speed = 0.0
        for factor in reversed(shape):
            turns, speed = turns * near + factor, speed * near + turns
        return base + turns + speed * (u - near), speed

    def turning_at(self, t: float) -> tuple[float, float]:
        """The same of a spindle that turns. Raises TroubleError for one that stands or is not measured."""
        state = self.at(t)
        if state is None:
            raise TroubleError("thread-no-encoder", "the encoder on the spindle counts nothing")
        if state[1] == 0.0:
            raise TroubleError("thread-no-encoder", "the spindle does not turn")
        return state

    def _fitted(self) -> tuple[list[float], float]:
        """Factors of the cubic from the last reading on, and that reading."""
        table = np.array(self._reads)
        u, base = table[:, 0] - table[-1, 0], float(table[-1, 1])
        shape: list[float] = np.polynomial.polynomial.polyfit(u, table[:, 1] - base, _DEGREE).tolist()
        return shape, base
