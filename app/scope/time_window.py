"""Time window of the scope with two cursors, and the trigger that freezes the curves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import numpy.typing as npt

from app.desk.translation import tr

ROUND_SPANS_S = (
    *(0.01, 0.02, 0.05, 0.1, 0.2, 0.5),
    *(1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 300.0),
)  # zoom steps in seconds
MIN_SPAN_S = ROUND_SPANS_S[0]
PAN_STEP_FRACTION = 0.1  # ratio of the window per step


@dataclass(slots=True)
class TimeWindow:
    """Time window of the scope, in seconds.

    The times are relative to the zero time of the record or, if the curves are live, to the newest sample.
    ``limits_s`` is the largest possible window, from the start to the end of the record.
    """

    begin_s: float = -10.0
    end_s: float = 0.0
    limits_s: tuple[float, float] = (-300.0, 0.0)

    @property
    def window_span_s(self) -> float:
        """Return the width of the window in seconds."""
        return self.end_s - self.begin_s

    @property
    def middle_time_s(self) -> float:
        """Return the middle of the window in seconds."""
        return 0.5 * (self.begin_s + self.end_s)

    def zoom_window(self, steps: int, time_s: float | None = None) -> None:
        """Zoom in (positive steps) or out (negative steps) to the next round width.

        The time ``time_s`` does not move.
        """
        near = [each for each in ROUND_SPANS_S if each < self.window_span_s * 0.999]
        far = [each for each in ROUND_SPANS_S if each > self.window_span_s * 1.001]
        for _ in range(abs(steps)):
            row = near if steps > 0 else far
            span = (row.pop() if steps > 0 else row.pop(0)) if row else self.window_span_s
            self.magnify(self.window_span_s / span, time_s)

    def magnify(self, factor: float, time_s: float | None = None) -> None:
        """Magnify the window by a factor, around a time or around the middle."""
        time_s = self.middle_time_s if time_s is None else time_s
        whole = self.limits_s[1] - self.limits_s[0]
        span = min(max(self.window_span_s / factor, MIN_SPAN_S), max(whole, MIN_SPAN_S))
        share = (time_s - self.begin_s) / self.window_span_s if self.window_span_s else 0.5
        self.begin_s = time_s - share * span
        self.end_s = self.begin_s + span
        self._stay()

    def pan_window(self, shift_s: float) -> None:
        """Move the window by a number of seconds, within the limits of the record."""
        self.begin_s, self.end_s = self.begin_s + shift_s, self.end_s + shift_s
        self._stay()

    def show_whole_record(self) -> None:
        """Show the whole record."""
        self.begin_s, self.end_s = self.limits_s
        if self.window_span_s < MIN_SPAN_S:
            self.begin_s = self.end_s - MIN_SPAN_S

    def show_time(self, time_s: float) -> None:
        """Pan only as far as necessary to show a time."""
        if not self.begin_s <= time_s <= self.end_s:
            self.pan_window(time_s - self.middle_time_s)

    def _stay(self) -> None:
        span = self.window_span_s
        self.begin_s = max(self.limits_s[0], min(self.begin_s, self.limits_s[1] - span))
        self.end_s = self.begin_s + span


@dataclass(slots=True)
class TimeCursors:
    """Two time cursors, with their times in seconds.

    ``active_index`` is the index of the cursor that the keys move, or -1 while the cursors are hidden.
    """

    times_s: tuple[float, float] = (0.0, 0.0)
    active_index: int = -1

    @property
    def shown(self) -> bool:
        """Return whether the cursors are shown."""
        return self.active_index >= 0

    @property
    def time_difference_s(self) -> float:
        """Return the time from the first to the second cursor in seconds."""
        return self.times_s[1] - self.times_s[0]

    def place_in_window(self, window: TimeWindow) -> None:
        """Place the cursors at one quarter and three quarters of the window."""
        quarter = 0.25 * window.window_span_s
        self.times_s, self.active_index = (window.begin_s + quarter, window.end_s - quarter), 0

    def move_cursor(self, time_s: float, cursor: int | None = None) -> None:
        """Move a cursor to a time.

        If no cursor is specified, move the active cursor.
        """
        self.active_index = self.active_index if cursor is None else cursor
        self.times_s = (time_s, self.times_s[1]) if self.active_index == 0 else (self.times_s[0], time_s)

    def activate_other_cursor(self) -> None:
        """Activate the other cursor."""
        if self.shown:
            self.active_index = 1 - self.active_index


FloatArray = npt.NDArray[np.float64]


class TriggerEvent(Enum):
    """The events that can fire the trigger."""

    OFF = tr("OFF: CURVES KEEP UPDATING")
    RISES_ABOVE = tr("SIGNAL RISES ABOVE LEVEL")
    FALLS_BELOW = tr("SIGNAL FALLS BELOW LEVEL")
    EXCEEDS = tr("SIGNAL EXCEEDS ± LEVEL")
    ALARM = tr("ALARM OR E-STOP")
    LINE = tr("A PROGRAM LINE STARTS")

    @property
    def needs_level(self) -> bool:
        """Return whether the event depends on a signal and a level."""
        return self in {TriggerEvent.RISES_ABOVE, TriggerEvent.FALLS_BELOW, TriggerEvent.EXCEEDS}


TRIGGER_POSITIONS = (0.1, 0.5, 0.9)  # shares of the window before the trigger


@dataclass(frozen=True, slots=True)
class Trigger:
    """Trigger of the scope.

    ``signal_key`` is the key of a signal. ``trigger_level`` is in internal units. ``fraction_before_event``
    is the fraction of the window before the event.
    """

    trigger_event: TriggerEvent = TriggerEvent.OFF
    signal_key: str = ""
    trigger_level: float = 0.0
    line_number: int = 1
    fraction_before_event: float = 0.5

    @property
    def watched_key(self) -> str:
        """Return the key of the signal or channel that the trigger examines.

        Return an empty string while the trigger is off.
        """
        if self.trigger_event.needs_level:
            return self.signal_key
        return {TriggerEvent.ALARM: "state", TriggerEvent.LINE: "line"}.get(self.trigger_event, "")

    def with_next_position(self) -> Trigger:
        """Return a copy with the next choice for the position of the event in the window."""
        at = (
            TRIGGER_POSITIONS.index(self.fraction_before_event)
            if self.fraction_before_event in TRIGGER_POSITIONS
            else -1
        )
        return replace(self, fraction_before_event=TRIGGER_POSITIONS[(at + 1) % len(TRIGGER_POSITIONS)])

    def find_trigger_time(
        self, times: FloatArray, values: FloatArray, alarm_values: frozenset[int]
    ) -> float | None:
        """Return the time of the first sample that fires the trigger, or None if no sample fires it.

        The first sample is only the previous value for the second one, so it cannot fire the trigger.
        ``alarm_values`` contains the values of the channel ``state`` that mean an alarm or an E-stop.
        """
        if self.trigger_event is TriggerEvent.OFF or len(values) < 2:
            return None
        with np.errstate(invalid="ignore"):
            on = self._on(values, alarm_values)
        known = np.isfinite(values)
        edges = np.flatnonzero(on[1:] & ~on[:-1] & known[1:] & known[:-1])
        return float(times[edges[0] + 1]) if len(edges) else None

    def _on(self, values: FloatArray, alarmed: frozenset[int]) -> npt.NDArray[np.bool_]:
        if self.trigger_event is TriggerEvent.RISES_ABOVE:
            return np.asarray(values >= self.trigger_level)
        if self.trigger_event is TriggerEvent.FALLS_BELOW:
            return np.asarray(values <= self.trigger_level)
        if self.trigger_event is TriggerEvent.EXCEEDS:
            return np.asarray(np.abs(values) > abs(self.trigger_level))
        if self.trigger_event is TriggerEvent.LINE:
            return np.asarray(values == self.line_number)
        return np.isin(values, sorted(alarmed))
