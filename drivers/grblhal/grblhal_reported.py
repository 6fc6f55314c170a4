"""Reported state and settings of a grblHAL controller, and the longest wait before an acknowledgment.

In grblHAL's ``spindle_control.c``, M3, M4 and M5 wait for the measured speed if the at-speed tolerance ($340)
is set. The limit is the delay of $394 (on) or $539 (off), or one minute if the delay is 0; then ALARM:14
follows. Without a tolerance, they wait for the delay. In ``coolant_control.c``, M7 and M8 wait for $673.
During a wait, the state is Idle, status reports are sent, and no later line is read.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Mapping

from core.ports import Clock
from drivers.grblhal.grblhal_config import GrblAxis, GrblConfig
from drivers.grblhal.grblhal_report import Identity, Report

_CONFIRMED = 0.25  # Seconds at full speed between an implausible report and the report that confirms it.
_LEAP = 1.0  # Tolerance in mm for the travel between two reports.
_VARIABLE = "V"  # A letter of the build options.
_HOMING, _HOMED = 22, 1  # Number of the setting, and its bit that enables homing.

TOLERANCE, SPINDLE_ON, SPINDLE_OFF, COOLANT_ON = 340, 394, 539, 673
OLD_SPINDLE_ON = 392  # Firmware before 2025 uses this setting instead of $394.
AT_MOST = 60.0  # Seconds; the firmware's limit without a delay.
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
    """State of a controller, assembled from reports that each contain only a part of it."""

    def __init__(self, config: GrblConfig, clock: Clock) -> None:
        self.config = config
        self.clock = clock
        self.identity: Identity | None = None
        self.settings: dict[int, str] = {}  # As read when connecting.
        self.report: Report | None = None  # Last report.
        self._before_alarm: Report | None = None  # Last report without an alarm.
        self.reports = self.fulls = 0  # Number of reports.
        self.heard_at = clock.now()  # Time when the last report was read.
        self._made_after = clock.now()  # Earliest time when the last report can have been created.
        self.position: dict[str, float] = {}  # Position from home in mm by axis letter, X as a radius.
        self.origin: dict[str, float] = {}  # Home position in the controller's coordinates.
        self.homed: tuple[int, ...] | None = None  # As reported: all axes, and one bit per axis.
        self.offset: tuple[float, ...] = ()
        self.overrides: tuple[int, ...] | None = None
        self.overrides_told = 0  # Number of reports with overrides.
        # Time of the report, and the accessories that are on.
        self.accessories: tuple[float, str] | None = None
        self.diameter: bool | None = None
        self.most_free = 0  # Free blocks of the empty planner.
        self.asked: deque[float] = deque()  # Times of the pending report requests.

    @property
    def state(self) -> str:
        """The state in the last report, or an empty text before the first report."""
        return self.report.state if self.report is not None else ""

    def keep(self, report: Report) -> None:
        """Store the contents of a report."""
        self.reports, self.fulls = self.reports + 1, self.fulls + report.full
        if report.diameter is not None:
            self.diameter = report.diameter
        self.offset = report.offset if report.offset is not None else self.offset
        if report.overrides is not None:
            self.overrides, self.overrides_told = report.overrides, self.overrides_told + 1
        if report.accessories is not None or report.overrides is not None:
            self.accessories = self.clock.now(), report.accessories or ""  # Omitted if all are off.
        self.homed = report.homed if report.homed is not None else self.homed
        if report.state == "Idle" and report.free is not None:
            self.most_free = max(self.most_free, report.free)
        if not self.diameter:
            self.position = self._places(report) or self.position
        self._made_after = self.asked.popleft() if self.asked else self.heard_at
        self.report, self.heard_at = report, self.clock.now()
        self._before_alarm = self._before_alarm if report.state == "Alarm" else report

    def plausible(self, report: Report) -> bool:
        """Return whether no axis has moved further than possible since the last report was created.

        A report may be created long before it is read, because this computer may be delayed.
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
        """The axis letters in the order of the controller's reports and settings."""
        return self.identity.axes if self.identity is not None else "XYZ"

    def has_pin(self, letter: str) -> bool:
        """Return whether the board has an input with this letter, as far as it is reported."""
        return self.identity is None or self.identity.has_pin(letter)

    @property
    def varies(self) -> bool:
        """Whether the firmware supports a spindle with variable speed."""
        return self.identity is not None and _VARIABLE in self.identity.letters

    @property
    def wired(self) -> tuple[GrblAxis, ...]:
        """The axes of the machine file that the controller moves."""
        return tuple(axis for axis in self.config.axes if axis.wired)

    def figure(self, first: int, letter: str) -> float:
        """Return a setting of an axis from the group that starts at ``first``, or 0 if it is not reported."""
        index = self.letters.find(letter)
        return float(self.settings.get(first + index, "0")) if index >= 0 else 0.0

    def speed_of(self, letter: str) -> float:
        """Return the controller's maximum speed of an axis in mm/s, or 0 if it is not reported."""
        return self.figure(110, letter) / 60.0

    def wait_of(self, line: str) -> float:
        """Return the seconds that the controller may wait for the spindle or coolant in a line."""
        return longest_wait(line, self.settings)

    @property
    def homing(self) -> int:
        """The homing setting $22: bit 0 enables homing, bit 1 permits homing of single axes."""
        return int(float(self.settings.get(_HOMING, "0")))

    def is_homed(self, letter: str) -> bool | None:
        """Return whether the controller has homed an axis, or None if its homing is off."""
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
        """Return whether ``report`` continues from the implausible position of ``leapt``.

        A delayed controller catches up, so that its position is correct.
        """
        before, now = self._places(leapt), self._places(report)
        near = ((axis, now.get(axis.name), before.get(axis.name)) for axis in self.config.axes)
        return all(
            new is None or old is None or abs(new - old) <= _CONFIRMED * axis.vmax + _LEAP
            for axis, new, old in near
        )
