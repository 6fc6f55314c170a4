"""Delay of the executor's ticks on a busy computer, and the resulting depth of the setpoint queue.

The queue moves the axes while the executor does not run. The queue becomes one step deeper when a late tick
has used more than half of it. After a time without late ticks, it becomes one step shallower.
"""

from __future__ import annotations

import math

STEPS = (0.0, 0.5, 1.0, 2.0)  # s added to the queue depth
LATE = 0.1  # s; a tick with a longer delay counts as late
CALM = 30.0  # s without a late tick after which the depth is reduced by one step
SHOWN = 0.1  # s; the displayed delay is rounded up to this step
AHEAD = 0.25  # s queued beyond the look-ahead, so that extending is not needed every tick


class Lateness:
    """Tracks late ticks of one executor. ``lookahead`` is the queue depth of the machine file, in seconds."""

    def __init__(self, lookahead: float) -> None:
        self._lookahead = lookahead
        self._step = 0
        self._calm_since = -math.inf
        self._worst = 0.0  # longest delay in s since the last reset of the depth

    @property
    def lookahead(self) -> float:
        """The time for which setpoints are queued ahead of the motion, in seconds."""
        return self._lookahead + STEPS[self._step]

    @property
    def hold_later(self) -> float:
        """The additional delay of a feed hold on a busy computer, in seconds, rounded up to 0.1 s.

        The delay never exceeds the queue depth, because the axes stop at the end of the queue.
        """
        if self._worst < LATE:
            return 0.0
        return math.ceil(min(self._worst, self.lookahead + AHEAD) / SHOWN - 1e-9) * SHOWN

    def look(self, late: float, now: float) -> bool:
        """Record that a tick was ``late`` seconds late; return whether ``hold_later`` has increased."""
        before = self.hold_later
        if late >= LATE:
            self._calm_since = now
            self._worst = max(self._worst, late)
            if late >= 0.5 * self.lookahead and self._step + 1 < len(STEPS):
                self._step += 1
        elif now - self._calm_since >= CALM:
            self._calm_since = now
            self._worst, self._step = 0.0, max(self._step - 1, 0)
        return self.hold_later > before
