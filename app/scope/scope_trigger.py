"""Trigger of the scope: at which sample the curves are frozen. A level, an edge, an alarm or a line."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
import numpy.typing as npt

from app.desk.translation import tr

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
