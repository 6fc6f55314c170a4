"""The time window of the scope with two cursors, and the trigger that stops the curves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import numpy.typing as npt

from app.desk.translation import tr

SPANS = (
    *(0.01, 0.02, 0.05, 0.1, 0.2, 0.5),
    *(1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 300.0),
)  # s: steps of zooming
LEAST = SPANS[0]
PAN = 0.1  # of the window, a step


@dataclass(slots=True)
class Window:
    """Seconds from ``begin`` to ``end``, counted from instant 0 of the record; live the newest sample is 0.

    ``most`` is the whole of it: where a record begins and ends.
    """

    begin: float = -10.0
    end: float = 0.0
    most: tuple[float, float] = (-300.0, 0.0)

    @property
    def span(self) -> float:
        """Seconds that are seen."""
        return self.end - self.begin

    @property
    def middle(self) -> float:
        """Its middle."""
        return 0.5 * (self.begin + self.end)

    def zoom(self, steps: int, at: float | None = None) -> None:
        """Nearer (positive) or farther by steps of round spans; ``at`` stays where it is."""
        near = [each for each in SPANS if each < self.span * 0.999]
        far = [each for each in SPANS if each > self.span * 1.001]
        for _ in range(abs(steps)):
            row = near if steps > 0 else far
            span = (row.pop() if steps > 0 else row.pop(0)) if row else self.span
            self.magnify(self.span / span, at)

    def magnify(self, factor: float, at: float | None = None) -> None:
        """Nearer by a factor about an instant, the middle without one."""
        at = self.middle if at is None else at
        whole = self.most[1] - self.most[0]
        span = min(max(self.span / factor, LEAST), max(whole, LEAST))
        share = (at - self.begin) / self.span if self.span else 0.5
        self.begin = at - share * span
        self.end = self.begin + span
        self._stay()

    def pan(self, by: float) -> None:
        """So many seconds later; it stays on the record."""
        self.begin, self.end = self.begin + by, self.end + by
        self._stay()

    def whole(self) -> None:
        """All of it."""
        self.begin, self.end = self.most
        if self.span < LEAST:
            self.begin = self.end - LEAST

    def show(self, instant: float) -> None:
        """Look aside as far as is needed to see an instant."""
        if not self.begin <= instant <= self.end:
            self.pan(instant - self.middle)

    def _stay(self) -> None:
        span = self.span
        self.begin = max(self.most[0], min(self.begin, self.most[1] - span))
        self.end = self.begin + span


@dataclass(slots=True)
class Cursors:
    """Two instants; ``at`` is the one that keys move, 0 or 1, and -1 while none is shown."""

    times: tuple[float, float] = (0.0, 0.0)
    at: int = -1

    @property
    def shown(self) -> bool:
        """Whether they are there."""
        return self.at >= 0

    @property
    def apart(self) -> float:
        """Seconds from the first to the second."""
        return self.times[1] - self.times[0]

    def put_into(self, window: Window) -> None:
        """A quarter and three quarters into the window."""
        quarter = 0.25 * window.span
        self.times, self.at = (window.begin + quarter, window.end - quarter), 0

    def move(self, to: float, which: int | None = None) -> None:
        """One of them, else the one that keys move, to an instant."""
        self.at = self.at if which is None else which
        self.times = (to, self.times[1]) if self.at == 0 else (self.times[0], to)

    def other(self) -> None:
        """Keys move the other one."""
        if self.shown:
            self.at = 1 - self.at


FloatArray = npt.NDArray[np.float64]


class When(Enum):
    """What releases it."""

    OFF = tr("OFF: CURVES KEEP UPDATING")
    RISES = tr("SIGNAL RISES ABOVE LEVEL")
    FALLS = tr("SIGNAL FALLS BELOW LEVEL")
    BEYOND = tr("SIGNAL EXCEEDS ± LEVEL")
    ALARM = tr("ALARM OR E-STOP")
    LINE = tr("A PROGRAM LINE STARTS")

    @property
    def by_level(self) -> bool:
        """Whether it looks at a signal and a level."""
        return self in {When.RISES, When.FALLS, When.BEYOND}


SHARES = (0.1, 0.5, 0.9)  # of the window that lies before it


@dataclass(frozen=True, slots=True)
class Trigger:
    """``signal`` is a signal's key, ``level`` in units inside, ``before`` the share of the window before."""

    when: When = When.OFF
    signal: str = ""
    level: float = 0.0
    line: int = 1
    before: float = 0.5

    @property
    def wants(self) -> str:
        """The signal or channel that it looks at; empty while it is off."""
        if self.when.by_level:
            return self.signal
        return {When.ALARM: "state", When.LINE: "line"}.get(self.when, "")

    def following_share(self) -> Trigger:
        """The next choice of where it lies in the window."""
        at = SHARES.index(self.before) if self.before in SHARES else -1
        return replace(self, before=SHARES[(at + 1) % len(SHARES)])

    def released(self, times: FloatArray, values: FloatArray, alarmed: frozenset[int]) -> float | None:
        """The time of the first sample that releases it, None: none does. The very first cannot.

        ``alarmed`` are the figures of the channel ``state`` that mean an alarm or E-stop.
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
