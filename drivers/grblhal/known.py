"""What the reports of one controller have told, and whether a new one can be true."""

from __future__ import annotations

from core.ports import Clock
from drivers.grblhal.config import GrblConfig
from drivers.grblhal.identity import Identity
from drivers.grblhal.report import Report

_LEAP = 1.0  # mm beyond what the slides can do between two reports


class Known:
    """Kept from report to report: each carries only a part."""

    def __init__(self, config: GrblConfig, clock: Clock) -> None:
        self.config = config
        self.clock = clock
        self.identity: Identity | None = None
        self.settings: dict[int, str] = {}  # as read at the connection
        self.report: Report | None = None  # the last one
        self.reports = self.fulls = 0  # how many have come
        self.heard_at = clock.now()
        self.position: dict[str, float] = {}  # mm by axis letter, X a radius
        self.offset: tuple[float, ...] = ()
        self.overrides: tuple[int, ...] | None = None
        self.diameter: bool | None = None
        self.most_free = 0  # blocks of its planner when that is empty

    def keep(self, report: Report) -> None:
        """Take over what a report carries."""
        self.reports, self.fulls = self.reports + 1, self.fulls + report.full
        if report.diameter is not None:
            self.diameter = report.diameter
        self.offset = report.offset if report.offset is not None else self.offset
        self.overrides = report.overrides if report.overrides is not None else self.overrides
        if report.state == "Idle" and report.free is not None:
            self.most_free = max(self.most_free, report.free)
        if not self.diameter:
            self.position = self._places(report) or self.position
        self.report, self.heard_at = report, self.clock.now()

    def plausible(self, report: Report) -> bool:
        """No slide leaps further than it can have gone since the last report."""
        if self.report is None or self.diameter:
            return True
        passed = self.clock.now() - self.heard_at
        places = self._places(report)
        for axis in self.config.axes:
            before, now = self.position.get(axis.name), places.get(axis.name)
            if before is None or now is None:
                continue
            if abs(now - before) > 1.5 * axis.vmax * passed + _LEAP:
                return False
        return True

    def _places(self, report: Report) -> dict[str, float]:
        axes = self.identity.axes if self.identity is not None else "XYZ"
        return dict(zip(axes, report.position or (), strict=False))
