"""What the reports of one controller have told, and whether a new one can be true."""

from __future__ import annotations

from core.ports import Clock
from drivers.grblhal.config import GrblAxis, GrblConfig
from drivers.grblhal.identity import Identity
from drivers.grblhal.report import Report

_LEAP = 1.0  # mm beyond what the slides can do between two reports
_HOMING, _HOMED = 22, 1  # setting, and the bit of it that switches homing on


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
        self.position: dict[str, float] = {}  # mm by axis letter, X a radius, from home
        self.origin: dict[str, float] = {}  # where home lies in the controller's own frame
        self.homed: tuple[int, ...] | None = None  # as it reports it: all axes, and a bit for each
        self.offset: tuple[float, ...] = ()
        self.overrides: tuple[int, ...] | None = None
        self.overrides_told = 0  # how often they have been in a report
        self.accessories: tuple[float, str] | None = None  # when they were told, and what is on
        self.diameter: bool | None = None
        self.most_free = 0  # blocks of its planner when that is empty

    def keep(self, report: Report) -> None:
        """Take over what a report carries."""
        self.reports, self.fulls = self.reports + 1, self.fulls + report.full
        if report.diameter is not None:
            self.diameter = report.diameter
        self.offset = report.offset if report.offset is not None else self.offset
        if report.overrides is not None:
            self.overrides, self.overrides_told = report.overrides, self.overrides_told + 1
        if report.accessories is not None or report.overrides is not None:
            self.accessories = self.clock.now(), report.accessories or ""  # left out where nothing is on
        self.homed = report.homed if report.homed is not None else self.homed
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

    @property
    def letters(self) -> str:
        """The controller's axes in the order of its reports and settings."""
        return self.identity.axes if self.identity is not None else "XYZ"

    @property
    def wired(self) -> tuple[GrblAxis, ...]:
        """The machine file's axes that the controller moves."""
        return tuple(axis for axis in self.config.axes if axis.wired)

    def figure(self, first: int, letter: str) -> float:
        """A setting that there is once for each axis, from ``first`` on; 0 where it is not told."""
        index = self.letters.find(letter)
        return float(self.settings.get(first + index, "0")) if index >= 0 else 0.0

    def speed_of(self, letter: str) -> float:
        """The controller's own greatest speed of an axis, mm/s; 0 where it does not tell."""
        return self.figure(110, letter) / 60.0

    @property
    def homing(self) -> int:
        """How the controller homes, its setting $22: bit 0 at all, bit 1 one axis alone."""
        return int(float(self.settings.get(_HOMING, "0")))

    def is_homed(self, letter: str) -> bool | None:
        """Whether the controller itself has homed an axis; None where homing is off in it."""
        index = self.letters.find(letter)
        if not self.homing & _HOMED or self.homed is None or index < 0:
            return None
        if len(self.homed) > 1:
            return bool(self.homed[1] >> index & 1)
        return bool(self.homed[0])

    def _places(self, report: Report) -> dict[str, float]:
        raw = zip(self.letters, report.position or (), strict=False)
        return {letter: place - self.origin.get(letter, 0.0) for letter, place in raw}
