"""Time window of the scope with two cursors, and the trigger that freezes the curves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import numpy.typing as npt

from app.desk.translation import tr

SPANS = (
    *(0.01, 0.02, 0.05, 0.1, 0.2, 0.5),
    *(1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 300.0),
)  # zoom steps in seconds
LEAST = SPANS[0]
PAN = 0.1  # ratio of the window per step


@dataclass(slots=True)
class Window:
    """Time window in seconds relative to instant 0 of the record, or to the newest sample when live.

    ``most`` is the largest possible window: the start and end of the record.
    """

    begin: float = -10.0
    end: float = 0.0
    most: tuple[float, float] = (-300.0, 0.0)

    @property
    def span(self) -> float:
        """Width of the window in seconds."""
        return self.end - self.begin

    @property
    def middle(self) -> float:
        """Middle of the window in seconds."""
        return 0.5 * (self.begin + self.end)

    def zoom(self, steps: int, at: float | None = None) -> None:
        """Zoom in (positive steps) or out through round spans. The time ``at`` stays in place."""
        near = [each for each in SPANS if each < self.span * 0.999]
        far = [each for each in SPANS if each > self.span * 1.001]
        for _ in range(abs(steps)):
            row = near if steps > 0 else far
            span = (row.pop() if steps > 0 else row.pop(0)) if row else self.span
            self.magnify(self.span / span, at)

    def magnify(self, factor: float, at: float | None = None) -> None:
        """Magnify by a factor around a time, or around the middle."""
        at = self.middle if at is None else at
        whole = self.most[1] - self.most[0]
        span = min(max(self.span / factor, LEAST), max(whole, LEAST))
        share = (at - self.begin) / self.span if self.span else 0.5
        self.begin = at - share * span
        self.end = self.begin + span
        self._stay()

    def pan(self, by: float) -> None:
        """Move the window by a number of seconds, within the record."""
        self.begin, self.end = self.begin + by, self.end + by
        self._stay()

    def whole(self) -> None:
        """Show the whole record."""
        self.begin, self.end = self.most
        if self.span < LEAST:
            self.begin = self.end - LEAST

    def show(self, instant: float) -> None:
        """Pan as far as necessary to show a time."""
        if not self.begin <= instant <= self.end:
            self.pan(instant - self.middle)

    def _stay(self) -> None:
        span = self.span
        self.begin = max(self.most[0], min(self.begin, self.most[1] - span))
        self.end = self.begin + span


@dataclass(slots=True)
class Cursors:
    """Two cursors in seconds.

    ``at`` is the index of the cursor that keys move, or -1 while hidden.
    """

    times: tuple[float, float] = (0.0, 0.0)
    at: int = -1

    @property
    def shown(self) -> bool:
        """Whether the cursors are shown."""
        return self.at >= 0

    @property
    def apart(self) -> float:
        """Time from the first to the second cursor in seconds."""
        return self.times[1] - self.times[0]

    def put_into(self, window: Window) -> None:
        """Place the cursors at one quarter and three quarters of the window."""
        quarter = 0.25 * window.span
        self.times, self.at = (window.begin + quarter, window.end - quarter), 0

    def move(self, to: float, which: int | None = None) -> None:
        """Move a cursor to a time. The default is the active cursor."""
        self.at = self.at if which is None else which
        self.times = (to, self.times[1]) if self.at == 0 else (self.times[0], to)

    def other(self) -> None:
        """Activate the other cursor."""
        if self.shown:
            self.at = 1 - self.at


FloatArray = npt.NDArray[np.float64]


class When(Enum):
    """Trigger event."""

    OFF = tr("OFF: CURVES KEEP UPDATING")
    RISES = tr("SIGNAL RISES ABOVE LEVEL")
    FALLS = tr("SIGNAL FALLS BELOW LEVEL")
    BEYOND = tr("SIGNAL EXCEEDS ± LEVEL")
    ALARM = tr("ALARM OR E-STOP")
    LINE = tr("A PROGRAM LINE STARTS")

    @property
    def by_level(self) -> bool:
        """Whether the event depends on a signal and a level."""
        return self in {When.RISES, When.FALLS, When.BEYOND}


SHARES = (0.1, 0.5, 0.9)  # shares of the window before the trigger


@dataclass(frozen=True, slots=True)
class Trigger:
    """Trigger of the scope.

    ``signal`` is the key of a signal, ``level`` is in internal units, and ``before`` is the share of the
    window before the event.
    """

    when: When = When.OFF
    signal: str = ""
    level: float = 0.0
    line: int = 1
    before: float = 0.5

    @property
    def wants(self) -> str:
        """Key of the signal or channel that the trigger examines, or an empty string while it is off."""
        if self.when.by_level:
            return self.signal
        return {When.ALARM: "state", When.LINE: "line"}.get(self.when, "")

    def following_share(self) -> Trigger:
        """Return a copy with the next position in the window."""
        at = SHARES.index(self.before) if self.before in SHARES else -1
        return replace(self, before=SHARES[(at + 1) % len(SHARES)])

    def released(self, times: FloatArray, values: FloatArray, alarmed: frozenset[int]) -> float | None:
        """Return the time of the first sample that fires the trigger, or None.

        The first sample cannot fire the trigger. ``alarmed`` contains the values of the channel ``state``
        that mean an alarm or an E-stop.
        """
        if self.when is When.OFF or len(values) < 2:
            return None
        with np.errstate(invalid="ignore"):
            on = self._on(values, alarmed)
        known = np.isfinite(values)
        edges = np.flatnonzero(on[1:] & ~on[:-1] & known[1:] & known[:-1])
        return float(times[edges[0] + 1]) if len(edges) else None

    def _on(self, values: FloatArray, alarmed: frozenset[int]) -> npt.NDArray[np.bool_]:
        if self.when is When.RISES:
            return np.asarray(values >= self.level)
        if self.when is When.FALLS:
            return np.asarray(values <= self.level)
        if self.when is When.BEYOND:
            return np.asarray(np.abs(values) > abs(self.level))
        if self.when is When.LINE:
            return np.asarray(values == self.line)
        return np.isin(values, sorted(alarmed))
