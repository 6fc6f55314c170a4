"""State of a controller as its reports and settings have told it, and how long it may wait with an answer.

``spindle_control.c`` and ``coolant_control.c`` of grblHAL: M3, M4 and M5 wait for the measured speed where
the at-speed tolerance ($340) is set, at most for the delay of $394 (on) or $539 (off), or a minute where that
is 0; then comes ALARM:14. Without a tolerance they wait for the delay. M7 and M8 wait for $673. Meanwhile the
state is Idle, status reports are answered, and no later line is read.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Mapping

from core.ports import Clock
from drivers.grblhal.grblhal_config import GrblAxis, GrblConfig
from drivers.grblhal.grblhal_report import Identity, Report

_CONFIRMED = 0.25  # s at full speed, between a report that leaps and the one that confirms it
_LEAP = 1.0  # mm beyond what the slides can do between two reports
_VARIABLE = "V"  # among the letters of its build
_HOMING, _HOMED = 22, 1  # setting, and the bit of it that switches homing on

TOLERANCE, SPINDLE_ON, SPINDLE_OFF, COOLANT_ON = 340, 394, 539, 673
OLD_SPINDLE_ON = 392  # which firmware from before 2025 uses in the place of $394
AT_MOST = 60.0  # s; the firmware's limit where no delay is set
_SPINDLE = {3: SPINDLE_ON, 4: SPINDLE_ON, 5: SPINDLE_OFF}
_COOLANT = frozenset((7, 8))
_FUNCTION = re.compile(r"M0*(\d+)")


def longest_wait(line: str, settings: Mapping[int, str]) -> float:
    """Return the seconds that the firmware may wait before it acknowledges ``line``; 0 for most lines."""
    return max((_wait(int(number), settings) for number in _FUNCTION.findall(line)), default=0.0)


def _wait(function: int, settings: Mapping[int, str]) -> float:
    if function in _COOLANT:
        return _value(settings, COOLANT_ON)
    if function not in _SPINDLE:
        return 0.0
    number = _SPINDLE[function]
    delay = _value(settings, number if number in settings else OLD_SPINDLE_ON)
    return delay if _value(settings, TOLERANCE) <= 0.0 or delay > 0.0 else AT_MOST


def _value(settings: Mapping[int, str], number: int) -> float:
    return float(settings.get(number, "0"))


class ReportedState:
    """What a controller has told. Reports carry only a part each: the rest is kept from one to the next."""

    def __init__(self, config: GrblConfig, clock: Clock) -> None:
        self.config = config
        self.clock = clock
        self.identity: Identity | None = None
        self.settings: dict[int, str] = {}  # as read at the connection
        self.report: Report | None = None  # the last one
        self._before_alarm: Report | None = None  # the last one of a controller without an alarm
        self.reports = self.fulls = 0  # how many have come
        self.heard_at = clock.now()  # when the last one was read
        self._made_after = clock.now()  # and the earliest at which it can have been made
        self.position: dict[str, float] = {}  # mm by axis letter, X a radius, from home
        self.origin: dict[str, float] = {}  # where home lies in the controller's own frame
        self.homed: tuple[int, ...] | None = None  # as it reports it: all axes, and a bit for each
        self.offset: tuple[float, ...] = ()
        self.overrides: tuple[int, ...] | None = None
        self.overrides_told = 0  # how often they have been in a report
        self.accessories: tuple[float, str] | None = None  # when they were told, and what is on
        self.diameter: bool | None = None
        self.most_free = 0  # blocks of its planner when that is empty
        self.asked: deque[float] = deque()  # questions for a report that are open

    @property
    def state(self) -> str:
        """As the last report says it; nothing before the first."""
        return self.report.state if self.report is not None else ""

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
        self._made_after = self.asked.popleft() if self.asked else self.heard_at
        self.report, self.heard_at = report, self.clock.now()
        self._before_alarm = self._before_alarm if report.state == "Alarm" else report

    def plausible(self, report: Report) -> bool:
        """No slide leaps further than it can have gone since the last report was made.

        That may be long before it was read: a computer that looks away finds an old report on the wire.
        """
        if self.report is None or self.diameter:
            return True
        passed = self.clock.now() - self._made_after
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

    def has_pin(self, letter: str) -> bool:
        """Whether its board has an input of this letter, as far as it tells."""
        return self.identity is None or self.identity.has_pin(letter)

    @property
    def varies(self) -> bool:
        """Whether its firmware has a spindle of variable speed."""
        return self.identity is not None and _VARIABLE in self.identity.letters

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

    def wait_of(self, line: str) -> float:
        """Return the seconds that the controller may wait for spindle or coolant in a line."""
        return longest_wait(line, self.settings)

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

    def _confirms(self, report: Report, leapt: Report) -> bool:
        """Whether this one goes on from where that one leapt to: a controller that was late itself makes up
        for it, and stands where it says.
        """
        before, now = self._places(leapt), self._places(report)
        near = ((axis, now.get(axis.name), before.get(axis.name)) for axis in self.config.axes)
        return all(
            new is None or old is None or abs(new - old) <= _CONFIRMED * axis.vmax + _LEAP
            for axis, new, old in near
        )
