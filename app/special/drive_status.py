"""What each drive does: power, home, demand, actual, following error, fault; and the spindle."""

from __future__ import annotations

from app.desk.desk import Desk
from app.desk.pages.sheet import Row, Sheet
from app.desk.status import formats
from app.desk.status.machine_status import Tone
from app.desk.status.readouts import UNKNOWN
from app.special.special_functions import SpecialFunction
from core.executor.snapshot import Alarm, Snapshot
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.ports import Unknown

OF_DRIVES = frozenset({"axis", "following", "in-position", "driver"})
HOW = {"lathe": "POSITIONS FROM HOME, X AS A RADIUS", "mill": "FROM HOME"}
AXES = frozenset("XYZABC")
OF_SPINDLE = frozenset({"spindle", "at-speed", "ignores-stop", "spindle-still", "thread-lost"})


class DriveStatus(SpecialFunction):
    """Machine coordinates from home, X a radius, in the unit that the figures are shown in."""

    name = "DRIVE STATUS"
    use = "power, home, following error, faults"

    def __init__(self, desk: Desk, machine: Machine) -> None:
        super().__init__(desk)
        self.machine = machine

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """One row an axis, one for the spindle."""
        metric = self.desk.settings.units.metric(snapshot.modal.metric)
        on = snapshot.powered
        rows = [self._axis(snapshot, number, metric, on) for number in range(len(snapshot.axes))]
        unit = "MM" if metric else "INCH"
        largest = formats.length(snapshot.max_following_error, metric)
        return Sheet(
            Message("DRIVE STATUS  ·  {unit}  ·  {method}", unit=unit, method=HOW[self.machine.kind]),
            ("AXIS", "POWER", "HOME", "DEMAND", "ACTUAL", "FOLLOWING ERROR", "ALLOWED", "FAULT"),
            (0.08, 0.1, 0.12, 0.16, 0.16, 0.15, 0.13, 0.1),
            (*rows, self._spindle(snapshot)),
            notes=(
                Message("Largest following error since startup: {largest}", largest=largest),
                Message("The setpoint queue ran low {underruns} times", underruns=snapshot.underruns),
            ),
            figures=frozenset({3, 4, 5, 6}),
        )

    def _axis(self, snapshot: Snapshot, number: int, metric: bool, on: bool) -> Row:
        axis = self.machine.axis(snapshot.axes[number])
        values = (
            snapshot.demand[number],
            snapshot.actual[number],
            snapshot.following_error[number],
            axis.following_window,
        )
        write = formats.angle if axis.rotary else lambda value: formats.length(value, metric)
        fault = _fault(snapshot.alarms, OF_DRIVES, axis)
        home = "HOMED" if snapshot.homed[number] else "NOT HOMED"
        power = "ON" if on else "OFF"
        known = Unknown.SLIDES not in snapshot.unknown
        figures = [write(value) if known else f"{write(value)} {UNKNOWN}" for value in values[:3]]
        cells = (axis.name, power if known else UNKNOWN, home, *figures, write(values[3]), fault)
        return Row(cells, on and known and fault == formats.NOTHING, Tone.RUN)

    def _spindle(self, snapshot: Snapshot) -> Row:
        fault = _fault(snapshot.alarms, OF_SPINDLE, None)
        band = abs(snapshot.rpm_command) * self.machine.spindle.at_speed
        off = snapshot.rpm_actual - snapshot.rpm_command
        known = Unknown.SPINDLE not in snapshot.unknown
        cells = (
            "S",
            "AUTO" if snapshot.spindle_auto else "OFF",
            "rpm",
            formats.fixed(snapshot.rpm_command, 0),
            formats.fixed(snapshot.rpm_actual, 0) if known else UNKNOWN,
            formats.fixed(off, 0) if known else UNKNOWN,
            formats.fixed(band, 0),
            fault,
        )
        return Row(cells, snapshot.spindle_auto and known and fault == formats.NOTHING, Tone.RUN)

    def prompt(self) -> str:
        """Where alarms are found, for the prompt line."""
        return "F7: ALARMS WITH CAUSE AND REMEDY   ESC: BACK TO THE LIST"


def _fault(alarms: tuple[Alarm, ...], codes: frozenset[str], axis: Axis | None) -> str:
    """The number of the alarm that concerns it; one that names no axis concerns all."""
    for alarm in reversed(alarms):
        named = AXES & set(alarm.cause.split())
        if alarm.code in codes and (axis is None or not named or axis.name in named):
            return str(alarm.number)
    return formats.NOTHING
