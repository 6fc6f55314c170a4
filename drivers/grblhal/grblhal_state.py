"""Reported state and settings of a grblHAL controller, and its longest acknowledgment delay.

Some lines make the controller wait before it acknowledges them:

- M3, M4 and M5 wait for the measured speed if the at-speed tolerance ($340) is set. The limit is the
  delay in $394 (on) or $539 (off), or one minute if the delay is 0; then ALARM:14 follows.
- Without a tolerance, M3, M4 and M5 wait for this delay (see ``spindle_control.c`` of grblHAL).
- M7 and M8 wait for the delay in $673 (see ``coolant_control.c``).

During a wait, the state is Idle, status reports are sent, and no further line is read.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Mapping

from core.ports import Clock
from drivers.grblhal.grblhal_config import GrblAxis, GrblConfig
from drivers.grblhal.grblhal_report import ControllerIdentity, StatusReport

_CONFIRMATION_TIME_S = (
    0.25  # Seconds at full speed between an implausible report and the report that confirms it.
)
_TRAVEL_TOLERANCE_MM = 1.0  # Tolerance in mm for the travel between two reports.
_VARIABLE = "V"  # A letter of the build options.
_HOMING, _HOMED = 22, 1  # Number of the setting, and its bit that enables homing.

TOLERANCE, SPINDLE_ON, SPINDLE_OFF, COOLANT_ON = 340, 394, 539, 673
LEGACY_SPINDLE_ON_SETTING = 392  # Firmware before 2025 uses this setting instead of $394.
MAX_FIRMWARE_WAIT_S = 60.0  # Seconds; the firmware's limit without a delay.
_SPINDLE = {3: SPINDLE_ON, 4: SPINDLE_ON, 5: SPINDLE_OFF}
_COOLANT = frozenset((7, 8))
_FUNCTION = re.compile(r"M0*(\d+)")


def get_firmware_wait_s(line: str, settings: Mapping[int, str]) -> float:
    """Return the seconds that the firmware may wait before it acknowledges ``line``.

    The result is 0 for most lines.
    """
    return max((_wait(int(number), settings) for number in _FUNCTION.findall(line)), default=0.0)


def _wait(function: int, settings: Mapping[int, str]) -> float:
    if function in _COOLANT:
        return _value(settings, COOLANT_ON)
    if function not in _SPINDLE:
        return 0.0
    number = _SPINDLE[function]
    delay = _value(settings, number if number in settings else LEGACY_SPINDLE_ON_SETTING)
    return delay if _value(settings, TOLERANCE) <= 0.0 or delay > 0.0 else MAX_FIRMWARE_WAIT_S


def _value(settings: Mapping[int, str], number: int) -> float:
    return float(settings.get(number, "0"))


class ReportedState:
    """State of a controller, assembled from several reports.

    Each report contains only a part of the state.
    """

    def __init__(self, config: GrblConfig, clock: Clock) -> None:
        self.config = config
        self.clock = clock
        self.identity: ControllerIdentity | None = None
        self.settings: dict[int, str] = {}  # As read when connecting.
        self.report: StatusReport | None = None  # Last report.
        self._before_alarm: StatusReport | None = None  # Last report without an alarm.
        self.report_count = self.full_report_count = 0  # Number of reports.
        self.last_report_s = clock.now()  # Time when the last report was read.
        self._made_after = clock.now()  # Earliest time when the last report can have been created.
        self.position: dict[str, float] = {}  # Position from home in mm by axis letter, X as a radius.
        self.home_origin: dict[str, float] = {}  # Home position in the controller's coordinates.
        self.homed_flags: tuple[int, ...] | None = None  # As reported: all axes, and one bit per axis.
        self.work_offset: tuple[float, ...] = ()
        self.overrides: tuple[int, ...] | None = None
        self.override_report_count = 0  # Number of reports with overrides.
        # Time of the report, and the accessories that are on.
        self.reported_accessories: tuple[float, str] | None = None
        self.is_diameter_mode: bool | None = None
        self.max_free_blocks = 0  # Free blocks of the empty planner.
        self.request_times: deque[float] = deque()  # Times of the pending report requests.

    @property
    def state_name(self) -> str:
        """Return the state in the last report, or an empty string before the first report."""
        return self.report.state if self.report is not None else ""

    def store_report(self, report: StatusReport) -> None:
        """Store the contents of a report."""
        self.report_count, self.full_report_count = (
            self.report_count + 1,
            self.full_report_count + report.full,
        )
        if report.diameter is not None:
            self.is_diameter_mode = report.diameter
        self.work_offset = report.offset if report.offset is not None else self.work_offset
        if report.overrides is not None:
            self.overrides, self.override_report_count = report.overrides, self.override_report_count + 1
        if report.accessories is not None or report.overrides is not None:
            self.reported_accessories = self.clock.now(), report.accessories or ""  # Omitted if all are off.
        self.homed_flags = report.homed if report.homed is not None else self.homed_flags
        if report.state == "Idle" and report.free is not None:
            self.max_free_blocks = max(self.max_free_blocks, report.free)
        if not self.is_diameter_mode:
            self.position = self._places(report) or self.position
        self._made_after = self.request_times.popleft() if self.request_times else self.last_report_s
        self.report, self.last_report_s = report, self.clock.now()
        self._before_alarm = self._before_alarm if report.state == "Alarm" else report

    def is_report_plausible(self, report: StatusReport) -> bool:
        """Return whether every axis could have reached its reported position since the last report.

        The available time starts when the last report was created, not when it was read. This computer may
        be delayed and read a report long after its creation.
        """
        if self.report is None or self.is_diameter_mode:
            return True
        passed = self.clock.now() - self._made_after
        places = self._places(report)
        for axis in self.config.axes:
            before, now = self.position.get(axis.name), places.get(axis.name)
            if before is None or now is None:
                continue
            if abs(now - before) > 1.5 * axis.max_velocity * passed + _TRAVEL_TOLERANCE_MM:
                return False
        return True

    @property
    def reported_axis_letters(self) -> str:
        """Return the axis letters in the order of the controller's reports and settings."""
        return self.identity.axis_letters if self.identity is not None else "XYZ"

    def has_input_pin(self, letter: str) -> bool:
        """Return whether the board has the input with this letter (``ControllerIdentity.has_input_pin``)."""
        return self.identity is None or self.identity.has_input_pin(letter)

    @property
    def has_variable_speed(self) -> bool:
        """Return whether the firmware supports a spindle with variable speed."""
        return self.identity is not None and _VARIABLE in self.identity.build_option_letters

    @property
    def wired_axes(self) -> tuple[GrblAxis, ...]:
        """Return the axes of the machine file that the controller moves."""
        return tuple(axis for axis in self.config.axes if axis.is_wired)

    def read_axis_setting(self, group_start: int, letter: str) -> float:
        """Return the setting of an axis, or 0 if it is not reported.

        ``group_start`` is the number of the first setting in the group of axis settings.
        """
        index = self.reported_axis_letters.find(letter)
        return float(self.settings.get(group_start + index, "0")) if index >= 0 else 0.0

    def get_max_axis_speed(self, letter: str) -> float:
        """Return the maximum speed of an axis in the controller's settings, in mm/s.

        Returns 0 if the speed is not reported.
        """
        return self.read_axis_setting(110, letter) / 60.0

    def get_line_wait_s(self, line: str) -> float:
        """Return the longest time in seconds that the controller may wait before it acknowledges a line.

        The controller may wait for the spindle or for the coolant.
        """
        return get_firmware_wait_s(line, self.settings)

    @property
    def homing_setting_bits(self) -> int:
        """Return the homing setting $22.

        Bit 0 enables homing, and bit 1 permits homing of single axes.
        """
        return int(float(self.settings.get(_HOMING, "0")))

    def is_axis_homed(self, letter: str) -> bool | None:
        """Return whether the controller has homed an axis.

        Returns None if homing is disabled in the controller, or if its state is unknown.
        """
        index = self.reported_axis_letters.find(letter)
        if not self.homing_setting_bits & _HOMED or self.homed_flags is None or index < 0:
            return None
        if len(self.homed_flags) > 1:
            return bool(self.homed_flags[1] >> index & 1)
        return bool(self.homed_flags[0])

    def _places(self, report: StatusReport) -> dict[str, float]:
        raw = zip(self.reported_axis_letters, report.position or (), strict=False)
        return {letter: place - self.home_origin.get(letter, 0.0) for letter, place in raw}

    def _confirms_jump(self, report: StatusReport, first_report: StatusReport) -> bool:
        """Return whether ``report`` continues from the implausible position in ``first_report``.

        If it does, the controller was only delayed and has caught up, and its position is correct.
        """
        before, now = self._places(first_report), self._places(report)
        near = ((axis, now.get(axis.name), before.get(axis.name)) for axis in self.config.axes)
        return all(
            new is None
            or old is None
            or abs(new - old) <= _CONFIRMATION_TIME_S * axis.max_velocity + _TRAVEL_TOLERANCE_MM
            for axis, new, old in near
        )
