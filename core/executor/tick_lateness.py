"""Delay of the executor's ticks on a busy computer, and the resulting setpoint queue depth.

While a tick is late, the axes continue along the queued setpoints. If a late tick uses up more than half of
the queue, more setpoints are queued from then on (one step more). After a period without late ticks, the
queue is reduced by one step again.
"""

from __future__ import annotations

import math

QUEUE_DEPTH_STEPS_S = (0.0, 0.5, 1.0, 2.0)  # s added to the queue depth
LATE_THRESHOLD_S = 0.1  # s; a tick with a longer delay counts as late
CALM_PERIOD_S = 30.0  # s without a late tick after which the depth is reduced by one step
DISPLAY_STEP_S = 0.1  # s; the displayed delay is rounded up to this step
QUEUE_RESERVE_S = 0.25  # s queued beyond the look-ahead, so that extending is not needed every tick


class TickLateness:
    """Record of the late ticks of one executor.

    ``lookahead`` is the queue depth from the machine file, in seconds.
    """

    def __init__(self, lookahead: float) -> None:
        self._lookahead = lookahead
        self._step = 0
        self._calm_since = -math.inf
        self._worst = 0.0  # longest delay in s since the last reset of the depth

    @property
    def lookahead_s(self) -> float:
        """Return the time in seconds for which setpoints are queued in advance."""
        return self._lookahead + QUEUE_DEPTH_STEPS_S[self._step]

    @property
    def hold_delay_s(self) -> float:
        """Return the additional delay of a feed hold on a busy computer, in seconds, rounded up to 0.1 s.

        The delay never exceeds the queue depth, because the axes stop at the end of the queue.
        """
        if self._worst < LATE_THRESHOLD_S:
            return 0.0
        return (
            math.ceil(min(self._worst, self.lookahead_s + QUEUE_RESERVE_S) / DISPLAY_STEP_S - 1e-9)
            * DISPLAY_STEP_S
        )

    def record_tick(self, delay_s: float, now: float) -> bool:
        """Record that a tick was ``delay_s`` seconds late; return whether ``hold_delay_s`` has increased."""
        before = self.hold_delay_s
        if delay_s >= LATE_THRESHOLD_S:
            self._calm_since = now
            self._worst = max(self._worst, delay_s)
            if delay_s >= 0.5 * self.lookahead_s and self._step + 1 < len(QUEUE_DEPTH_STEPS_S):
                self._step += 1
        elif now - self._calm_since >= CALM_PERIOD_S:
            self._calm_since = now
            self._worst, self._step = 0.0, max(self._step - 1, 0)
        return self.hold_delay_s > before
