"""Times of key presses and frames, used to detect key presses that were processed too late."""

from __future__ import annotations

import time
from collections.abc import Callable

STALL_TIME_S = 0.3  # Seconds without a frame. A press that waited during a longer stall starts nothing.
FRAMES_AFTER_STALL = 2  # Frames that must be shown after a stall before a press may start something.
PAUSE_TIME_S = 1.0  # Seconds without a press that end a sequence of presses with a dropped answer.
_WRAP_THRESHOLD_S = 1e5  # Seconds: a larger difference means that the 32-bit time stamps have overflowed.
_MAX_CLOCK_DRIFT = 1e-3  # Maximum drift between two clocks, as a fraction of the elapsed time.


class InputTimes:
    """Times of input events, and periods in which the screen did not respond (stalls).

    ``clock`` is monotonic, in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.clock = clock
        self.input_time_s = self.clock()  # Time of the last key press or touch.
        self.on_wake: Callable[[], None] = lambda: None  # Called at each key press or touch.
        self.stall_duration_s = 0.0  # Duration of the last stall in seconds.
        self._alive: float | None = None
        self._behind = float("-inf")  # End of the last stall.
        self._dropped = float("-inf")  # Time of the last dropped answer or of a press that relied on it.
        self._frames = FRAMES_AFTER_STALL  # Frames that were shown since the last stall.
        # By clock: offset, and time when the offset was determined.
        self._offsets: dict[str, tuple[float, float]] = {}

    @property
    def has_seen_screen(self) -> bool:
        """Return whether the operator has seen the current screen since the last stall."""
        return self._frames >= FRAMES_AFTER_STALL

    def frame(self) -> None:
        """Record the time at which a frame of the screen is shown."""
        self._lives(self.clock())
        self._frames += 1

    def record_input(self) -> None:
        """Record that an input event has arrived. Call this before its time is checked."""
        self.input_time_s = self.clock()
        self._lives(self.input_time_s)
        self.on_wake()

    def _lives(self, now: float) -> None:
        if self._alive is not None and now - self._alive > STALL_TIME_S:
            self.stall_duration_s, self._behind, self._frames = now - self._alive, now, 0
        self._alive = now

    def find_event_time(self, time_ms: int, event_source: str = "") -> float:
        """Return the time of an event in seconds of the screen's clock.

        An event without a time stamp is treated as occurring now. ``time_ms`` is in ms of the clock
        ``event_source``. Each clock has its own offset.
        """
        now = self.clock()
        if not time_ms:
            return now
        apart = now - time_ms / 1000
        offset, seen = self._offsets.get(event_source, (apart, now))
        if apart - offset > _WRAP_THRESHOLD_S:
            offset = apart
        offset = min(apart, offset + _MAX_CLOCK_DRIFT * (now - seen))
        self._offsets[event_source] = offset, now
        return min(now, time_ms / 1000 + offset)

    def was_delayed(self, time_ms: int, event_source: str = "") -> bool:
        """Return whether an event was delayed by a stall of the screen, or before it reached the screen."""
        if not time_ms:
            return False
        at = self.find_event_time(time_ms, event_source)
        return at <= self._behind or not self.has_seen_screen or self.clock() - at > STALL_TIME_S

    def record_dropped_answer(self, time_ms: int, event_source: str = "") -> None:
        """Record a dropped answer to a question, so that the presses after it are dropped too."""
        self._dropped = max(self._dropped, self.find_event_time(time_ms, event_source))

    def follows_dropped_answer(self, time_ms: int, event_source: str = "") -> bool:
        """Return whether a press must also be dropped because an answer to a question was dropped.

        This applies to a press in the same stall of the screen as the dropped answer. It also applies to a
        press less than 1 s after the dropped answer.
        """
        at = self.find_event_time(time_ms, event_source)
        same_stall = self._behind - self.stall_duration_s < self._dropped and at <= self._behind
        return same_stall or at - self._dropped < PAUSE_TIME_S

    def find_delay(self, time_ms: int, event_source: str = "") -> float:
        """Return the delay of a press in seconds, or the duration of the stall that delayed it."""
        at = self.find_event_time(time_ms, event_source)
        return self.stall_duration_s if at <= self._behind else self.clock() - at
