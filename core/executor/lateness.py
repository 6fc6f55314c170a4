"""How late the computer lets the executor tick, and how deep the setpoint queue is because of it.

The queue is what moves the axes while the executor does not run. It deepens by one step as soon as a tick has
come so late that half of it was used up, and gives one step back after a while without a late tick.
"""

from __future__ import annotations

import math

STEPS = (0.0, 0.5, 1.0, 2.0)  # s by which the queue is deeper
LATE = 0.1  # s: a tick that comes later than this is late
CALM = 30.0  # s without a late tick after which one step is given back
SHOWN = 0.1  # s: the steps in which a later reaction is shown
AHEAD = 0.25  # s queued beyond the look-ahead, so that extending is not needed every tick


class Lateness:
    """Of one executor, on its thread alone. ``lookahead`` is the depth that the machine file gives, s."""

    def __init__(self, lookahead: float) -> None:
        self._lookahead = lookahead
        self._step = 0
        self._calm_since = -math.inf
        self._worst = 0.0  # s, since the computer was last calm

    @property
    def lookahead(self) -> float:
        """Seconds for which setpoints are queued ahead of the motion."""
        return self._lookahead + STEPS[self._step]

    @property
    def hold_later(self) -> float:
        """Seconds by which a hold may react later than it does on a computer that is not busy.

        They are never more than the depth of the queue: at its end the axes stop by themselves.
        """
        if self._worst < LATE:
            return 0.0
        return math.ceil(min(self._worst, self.lookahead + AHEAD) / SHOWN - 1e-9) * SHOWN

    def look(self, late: float, now: float) -> bool:
        """Note by how many seconds a tick came late; returns whether ``hold_later`` has grown."""
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
