"""Conversion of snapshots to the terms of MTConnect: execution, conditions and values.

Values are in mm, degrees, mm/s, rpm and %.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.status.machine_status import ControlSilenceDetector
from core.alarms import CATALOG, AlarmCode, AlarmReaction
from core.executor.snapshot import MDI_ACTIONS, Alarm, InterruptedJob, MachineState, Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import UnknownPart

# --- Conditions of alarms: axis, spindle drive, communication, interlocks, program, control.


FAULT, WARNING = "FAULT", "WARNING"
ConditionEntry = tuple[str, str, str]  # level, code, text
SPINDLE, COMMS, LOGIC, SYSTEM, MOTION = "Sdrive", "comms", "logic", "system", "motion"

# Conditions by the first digit of the alarm's number, and exceptions by code. The condition of an axis begins
# with the name of the axis and ends in ``servo`` or ``travel``.
_SERVO, _TRAVEL = "servo", "travel"
CONDITION_SUBJECTS = {1: _SERVO, 2: SPINDLE, 3: LOGIC, 4: MOTION, 5: COMMS}
CONDITION_PLACES: dict[AlarmCode, str] = {
    **{"driver": COMMS, "travel": _TRAVEL},
    **{"spindle-still": MOTION, "c-is-spindle": MOTION},
}
_DEFAULT_CONDITIONS = {_SERVO: SYSTEM, _TRAVEL: MOTION}  # conditions of alarms that do not name an axis


def list_condition_keys(machine: Machine) -> frozenset[str]:
    """Return the keys of all MTConnect conditions of a machine.

    Each axis with its own drive has conditions. The other conditions belong to no axis. On a lathe the
    spindle is also the C axis, unless C has its own drive.
    """
    turns_c = machine.kind == "lathe" and machine.is_spindle_c_axis
    axes = [axis.name for axis in machine.axes if not (turns_c and axis.is_rotary and axis.name == "C")]
    own = (f"{name}{kind}" for name in axes for kind in (_SERVO, _TRAVEL))
    return frozenset((*own, SPINDLE, COMMS, LOGIC, SYSTEM, MOTION))


def find_conditions(snapshot: Snapshot, keys: frozenset[str]) -> Mapping[str, tuple[ConditionEntry, ...]]:
    """Return the active entries of each MTConnect condition.

    An empty tuple means normal. If the control started a feed hold without a request, the system condition
    has a warning with the reason that the screen shows.
    """
    active: dict[str, list[ConditionEntry]] = {key: [] for key in keys}
    for alarm in snapshot.alarms:
        active[_place(alarm, keys)].append(
            (FAULT, str(alarm.number), Message("{alarm}: {cause}", alarm=alarm.text, cause=alarm.cause))
        )
    if snapshot.interrupted is not None:
        active[SYSTEM].append((WARNING, "interrupted", snapshot.interrupted.words))
    stop = snapshot.stop
    if (
        snapshot.state is MachineState.HOLD
        and stop is not None
        and CATALOG[stop.code].reaction is AlarmReaction.HOLD
    ):
        active[SYSTEM].append((WARNING, str(stop.number), stop.text))
    return {key: tuple(found) for key, found in active.items()}


def _place(alarm: Alarm, keys: frozenset[str]) -> str:
    place = CONDITION_PLACES.get(alarm.code) or CONDITION_SUBJECTS.get(alarm.number // 100, SYSTEM)
    if place not in _DEFAULT_CONDITIONS:
        return place
    for word in re.findall(r"\b[A-Z]\b", alarm.cause):
        if f"{word}{place}" in keys:
            return f"{word}{place}"
        if word == "C" and place == _SERVO:
            return SPINDLE  # the spindle is the C axis
    return _DEFAULT_CONDITIONS[place]


# --- Execution and controller mode in the terms of MTConnect, from successive snapshots.


AUTOMATIC, MANUAL, MDI, SINGLE = "AUTOMATIC", "MANUAL", "MANUAL_DATA_INPUT", "SEMI_AUTOMATIC"
READY, ACTIVE, WAIT, STOPPED = "READY", "ACTIVE", "WAIT", "STOPPED"
FEED_HOLD, INTERRUPTED = "FEED_HOLD", "INTERRUPTED"
PROGRAM_STOPPED, OPTIONAL_STOP, COMPLETED = "PROGRAM_STOPPED", "OPTIONAL_STOP", "PROGRAM_COMPLETED"

_MATERIAL_WAIT = (
    "COLLET"  # a wait for a device that handles material, like the inputs of a bar feeder or loader
)
# States in which the program waits for an action of the operator.
_KEPT = {
    "FEED OVERRIDE AT 0": FEED_HOLD,
    "SPINDLE SWITCH OFF": INTERRUPTED,
    "GUARD OPEN": INTERRUPTED,
    "SPINDLE OVERRIDE AT 0": INTERRUPTED,
    "SPINDLE STOPPED": INTERRUPTED,
}
_MODE_BY_STATE = {
    MachineState.ESTOP: STOPPED,
    MachineState.FAULT: STOPPED,
    MachineState.DISABLED: STOPPED,  # not ready, because no program can be started
    MachineState.RUN: ACTIVE,
    MachineState.STOPPING: FEED_HOLD,
    MachineState.SINGLE_BLOCK_STOP: INTERRUPTED,
    MachineState.JOG: READY,
    MachineState.HOMING: READY,
}


@dataclass(slots=True)
class ExecutionTracker:
    """Tracker of the MTConnect execution state, which also detects the end of a program.

    ``input_names`` are the names and terminals of the inputs for which a program can wait. Other waits of a
    cycle, such as a dwell, the spindle or a proof, are reported as active execution.
    """

    input_names: frozenset[str] = frozenset()
    _ends: int | None = None
    _program: str = ""
    _lines: int = 0
    _completed: bool = False

    def update(self, snapshot: Snapshot) -> str:
        """Return the MTConnect execution state for a snapshot.

        Call this for every published snapshot.
        """
        ended = self._ends is not None and snapshot.ends > self._ends
        elsewhere = (snapshot.program, snapshot.lines) != (self._program, self._lines)
        if ended:
            self._completed = True
        elif snapshot.state is not MachineState.IDLE or elsewhere:
            self._completed = False
        self._ends, self._program, self._lines = snapshot.ends, snapshot.program, snapshot.lines
        # both occurred between two snapshots; the end is reported first
        if ended and snapshot.state is MachineState.DISABLED:
            return COMPLETED
        return self._of(snapshot)

    def _of(self, snapshot: Snapshot) -> str:
        match snapshot.state:
            case MachineState.WAIT:
                return self._waiting(snapshot.waiting_for)
            case MachineState.HOLD:
                return INTERRUPTED if snapshot.waiting_for else FEED_HOLD
            case MachineState.PROGRAM_STOP:
                return OPTIONAL_STOP if snapshot.is_optional_stop else PROGRAM_STOPPED
            case MachineState.IDLE:
                if self._completed:
                    return COMPLETED
                return STOPPED if snapshot.interrupted_line else READY
            case state:
                return _MODE_BY_STATE[state]

    def _waiting(self, what: str) -> str:
        if what == _MATERIAL_WAIT or what in self.input_names:
            return WAIT
        return _KEPT.get(what, ACTIVE)


def find_controller_mode(snapshot: Snapshot) -> str:
    """Return the MTConnect controller mode, which is the kind of run that Cycle Start begins.

    It is derived from the machine state, because the control has no mode switch.
    """
    if snapshot.state in {MachineState.JOG, MachineState.HOMING}:
        return MANUAL
    if snapshot.starts in MDI_ACTIONS:
        return MDI
    return SINGLE if snapshot.single_block else AUTOMATIC


ReadingValue = str | float | None  # None means unknown

_STILL_SPEED_MM_S = 0.2  # mm/s; an encoder that toggles by one count per tick reads as 0.13
_STILL_RPM = 1.0  # rpm
_AVAILABLE, _UNAVAILABLE = "AVAILABLE", "UNAVAILABLE"


@dataclass(frozen=True, slots=True)
class MachineReading:
    """Values and conditions of the machine at one time.

    Both are empty if the machine state is unknown.
    """

    values: Mapping[str, ReadingValue]
    conditions: Mapping[str, tuple[ConditionEntry, ...]] = field(default_factory=dict)
    interrupted_job: InterruptedJob | None = None
    alarms: tuple[Alarm, ...] = ()  # catalog entries of the active alarms

    def find_alarm(self, code: str) -> Alarm | None:
        """Return the alarm with this number, or None if it is not active in this reading."""
        return next((alarm for alarm in self.alarms if str(alarm.number) == code), None)

    @property
    def is_available(self) -> bool:
        """Return whether the control responds."""
        return self.values.get("avail") == _AVAILABLE


UNKNOWN_READING = MachineReading({"avail": _UNAVAILABLE})


@dataclass(slots=True)
class MachineReader:
    """Converter of the snapshots of one machine to readings.

    ``get_time_s`` returns the time in seconds. It is used to detect that no new snapshots arrive.
    """

    machine: Machine
    get_time_s: Callable[[], float]
    _keys: frozenset[str] = field(init=False)  # names of the conditions of this machine
    _execution: ExecutionTracker = field(init=False)
    _pulse: ControlSilenceDetector = field(default_factory=ControlSilenceDetector)

    def __post_init__(self) -> None:
        wired = self.machine.inputs
        terminals = (each.terminal for each in wired.values() if each.terminal)
        self._execution = ExecutionTracker(frozenset((*wired, *terminals)))
        self._keys = list_condition_keys(self.machine)

    def make_reading(self, snapshot: Snapshot) -> MachineReading:
        """Return the current values and conditions.

        The result is ``UNKNOWN_READING`` if the control no longer responds.
        """
        if self._pulse.check_silence(snapshot.t, self.get_time_s()):
            return UNKNOWN_READING
        values: dict[str, ReadingValue] = {
            "avail": _AVAILABLE,
            "estop": "TRIGGERED" if snapshot.state is MachineState.ESTOP else "ARMED",
            "mode": find_controller_mode(snapshot),
            "execution": self._execution.update(snapshot),
            **_program(snapshot),
            **self._read_axes(snapshot),
            **_motion(snapshot),
            **self._spindle(snapshot),
            **self._read_wired(snapshot),
        }
        stop = (snapshot.stop,) if snapshot.stop is not None else ()
        alarms = (*snapshot.alarms, *stop)
        return MachineReading(values, find_conditions(snapshot, self._keys), snapshot.interrupted, alarms)

    def _read_axes(self, snapshot: Snapshot) -> dict[str, ReadingValue]:
        """Return the axis positions in machine coordinates, with X as a radius.

        The position of an axis that is not homed is None.
        """
        known = UnknownPart.AXES not in snapshot.unknown
        at = zip(snapshot.axes, snapshot.actual, snapshot.homed, strict=True)
        return {
            f"{name}abs": actual if known and homed and (name != "C" or self.machine.is_c_enabled) else None
            for name, actual, homed in at
        }

    def _spindle(self, snapshot: Snapshot) -> dict[str, ReadingValue]:
        known, turning = UnknownPart.SPINDLE not in snapshot.unknown, abs(snapshot.rpm_actual)
        held = (
            turning >= self.machine.spindle.stop_below and not self.machine.interlocks.unclamp_while_turning
        )
        return {
            "Srpm": None if not known else turning if turning >= _STILL_RPM else 0.0,
            "Scmd": abs(snapshot.requested_rpm),
            "Sovr": 100.0 * snapshot.spindle_override,
            "Sload": snapshot.spindle_load if known else None,
            "rotmode": "CONTOUR" if snapshot.modal.c_locked and self.machine.is_spindle_c_axis else "SPINDLE",
            "chuckil": None if not known else "ACTIVE" if held else "INACTIVE",
        }

    def _read_wired(self, snapshot: Snapshot) -> dict[str, ReadingValue]:
        """Return the states of the machine's switches.

        The state of a switch is None if it is not wired or its input is unknown.
        """

        def read_signal(name: str, on: str, off: str) -> ReadingValue:
            if name not in self.machine.inputs or UnknownPart.INPUTS in snapshot.unknown:
                return None
            return on if name in snapshot.inputs else off

        # commanded to close but not closed yet
        opened = "UNLATCHED" if "collet" in snapshot.outputs else "OPEN"
        return {
            "chuck": read_signal("collet_closed", "CLOSED", opened),
            "door": read_signal("guard", "CLOSED", "OPEN"),
            "endbar": read_signal("end_of_bar", "YES", "NO"),
            "part": read_signal("part", "PRESENT", "NOT_PRESENT"),
        }


def _program(snapshot: Snapshot) -> dict[str, ReadingValue]:
    return {
        "program": Path(snapshot.program).name or None,
        "line": str(snapshot.line) if snapshot.line else None,
        "block": snapshot.block_text.strip() or None,
        "toolnum": str(snapshot.modal.tool),
        "pcount": str(snapshot.parts),
    }


def _motion(snapshot: Snapshot) -> dict[str, ReadingValue]:
    known = UnknownPart.AXES not in snapshot.unknown
    return {
        "Fact": None if not known else snapshot.velocity if snapshot.velocity >= _STILL_SPEED_MM_S else 0.0,
        "Fovr": 100.0 * snapshot.feed_override,
    }
