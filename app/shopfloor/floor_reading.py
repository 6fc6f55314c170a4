"""A snapshot in the terms of MTConnect: execution, conditions and values in mm, degrees, mm/s, rpm and %."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.status.machine_status import SilenceWatch
from core.alarms import CATALOGUE, Code, Reaction
from core.executor.snapshot import LINES, Alarm, InterruptedJob, Snapshot, State
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import Unknown

# --- Conditions of alarms: axis, spindle drive, communication, interlocks, program, control.


FAULT, WARNING = "FAULT", "WARNING"
Condition = tuple[str, str, str]  # level, code, text
SPINDLE, COMMS, LOGIC, SYSTEM, MOTION = "Sdrive", "comms", "logic", "system", "motion"

# Conditions by the first digit of the alarm's number, and exceptions by code. The condition of an axis begins
# with the name of the axis and ends in ``servo`` or ``travel``.
_SERVO, _TRAVEL = "servo", "travel"
SUBJECTS = {1: _SERVO, 2: SPINDLE, 3: LOGIC, 4: MOTION, 5: COMMS}
PLACES: dict[Code, str] = {
    **{"driver": COMMS, "travel": _TRAVEL},
    **{"spindle-still": MOTION, "c-is-spindle": MOTION},
}
_NOWHERE = {_SERVO: SYSTEM, _TRAVEL: MOTION}  # conditions of alarms that do not name an axis


def condition_keys(machine: Machine) -> frozenset[str]:
    """Return the names of all conditions of a machine: those of each axis with its own drive, and the others.

    On a lathe the spindle is also the C axis, unless C has its own drive.
    """
    turns_c = machine.kind == "lathe" and machine.spindle_is_c
    axes = [axis.name for axis in machine.axes if not (turns_c and axis.rotary and axis.name == "C")]
    own = (f"{name}{kind}" for name in axes for kind in (_SERVO, _TRAVEL))
    return frozenset((*own, SPINDLE, COMMS, LOGIC, SYSTEM, MOTION))


def conditions_of(snapshot: Snapshot, keys: frozenset[str]) -> Mapping[str, tuple[Condition, ...]]:
    """Return the active entries of each condition; () means normal.

    A hold that the operator did not request is a warning of the system, with the reason shown on the screen.
    """
    active: dict[str, list[Condition]] = {key: [] for key in keys}
    for alarm in snapshot.alarms:
        active[_place(alarm, keys)].append(
            (FAULT, str(alarm.number), Message("{alarm}: {cause}", alarm=alarm.text, cause=alarm.cause))
        )
    if snapshot.interrupted is not None:
        active[SYSTEM].append((WARNING, "interrupted", snapshot.interrupted.words))
    stop = snapshot.stop
    if snapshot.state is State.HOLD and stop is not None and CATALOGUE[stop.code].reaction is Reaction.HOLD:
        active[SYSTEM].append((WARNING, str(stop.number), stop.text))
    return {key: tuple(found) for key, found in active.items()}


def _place(alarm: Alarm, keys: frozenset[str]) -> str:
    place = PLACES.get(alarm.code) or SUBJECTS.get(alarm.number // 100, SYSTEM)
    if place not in _NOWHERE:
        return place
    for word in re.findall(r"\b[A-Z]\b", alarm.cause):
        if f"{word}{place}" in keys:
            return f"{word}{place}"
        if word == "C" and place == _SERVO:
            return SPINDLE  # the spindle is the C axis
    return _NOWHERE[place]


# --- Execution and controller mode in the terms of MTConnect, from successive snapshots.


AUTOMATIC, MANUAL, MDI, SINGLE = "AUTOMATIC", "MANUAL", "MANUAL_DATA_INPUT", "SEMI_AUTOMATIC"
READY, ACTIVE, WAIT, STOPPED = "READY", "ACTIVE", "WAIT", "STOPPED"
FEED_HOLD, INTERRUPTED = "FEED_HOLD", "INTERRUPTED"
PROGRAM_STOPPED, OPTIONAL_STOP, COMPLETED = "PROGRAM_STOPPED", "OPTIONAL_STOP", "PROGRAM_COMPLETED"

_COLLET = "COLLET"  # a wait for a device that handles material, like the inputs of a bar feeder or loader
# States in which the program waits for an action of the operator.
_KEPT = {
    "FEED OVERRIDE AT 0": FEED_HOLD,
    "SPINDLE SWITCH OFF": INTERRUPTED,
    "GUARD OPEN": INTERRUPTED,
    "SPINDLE OVERRIDE AT 0": INTERRUPTED,
    "SPINDLE STOPPED": INTERRUPTED,
}
_BY_STATE = {
    State.ESTOP: STOPPED,
    State.FAULT: STOPPED,
    State.DISABLED: STOPPED,  # not ready, because no program can be started
    State.RUN: ACTIVE,
    State.HOLDING: FEED_HOLD,
    State.BLOCK_END: INTERRUPTED,
    State.JOG: READY,
    State.HOME: READY,
}


@dataclass(slots=True)
class Execution:
    """State machine that also detects the end of a program.

    ``inputs`` are the names and terminals of inputs for which a program can wait. Other waits of a cycle,
    such as a dwell, the spindle or a proof, count as active execution.
    """

    inputs: frozenset[str] = frozenset()
    _ends: int | None = None
    _program: str = ""
    _lines: int = 0
    _completed: bool = False

    def look(self, snapshot: Snapshot) -> str:
        """Return the execution state; call it for every published snapshot."""
        ended = self._ends is not None and snapshot.ends > self._ends
        elsewhere = (snapshot.program, snapshot.lines) != (self._program, self._lines)
        if ended:
            self._completed = True
        elif snapshot.state is not State.IDLE or elsewhere:
            self._completed = False
        self._ends, self._program, self._lines = snapshot.ends, snapshot.program, snapshot.lines
        # both occurred between two snapshots; the end is reported first
        if ended and snapshot.state is State.DISABLED:
            return COMPLETED
        return self._of(snapshot)

    def _of(self, snapshot: Snapshot) -> str:
        match snapshot.state:
            case State.WAIT:
                return self._waiting(snapshot.waiting_for)
            case State.HOLD:
                return INTERRUPTED if snapshot.waiting_for else FEED_HOLD
            case State.PROGRAM_STOP:
                return OPTIONAL_STOP if snapshot.optionally_stopped else PROGRAM_STOPPED
            case State.IDLE:
                if self._completed:
                    return COMPLETED
                return STOPPED if snapshot.interrupted_line else READY
            case state:
                return _BY_STATE[state]

    def _waiting(self, what: str) -> str:
        if what == _COLLET or what in self.inputs:
            return WAIT
        return _KEPT.get(what, ACTIVE)


def mode_of(snapshot: Snapshot) -> str:
    """Return the controller mode: the kind of run that Cycle Start begins. The control has no mode switch."""
    if snapshot.state in {State.JOG, State.HOME}:
        return MANUAL
    if snapshot.starts in LINES:
        return MDI
    return SINGLE if snapshot.single_block else AUTOMATIC


Value = str | float | None  # None means unknown

_STANDS = 0.2  # mm/s; an encoder that toggles by one count per tick reads as 0.13
_STILL = 1.0  # rpm
_AVAILABLE, _UNAVAILABLE = "AVAILABLE", "UNAVAILABLE"


@dataclass(frozen=True, slots=True)
class Reading:
    """Values and conditions of the machine at one time; empty if nothing is known."""

    values: Mapping[str, Value]
    conditions: Mapping[str, tuple[Condition, ...]] = field(default_factory=dict)
    interrupted: InterruptedJob | None = None
    alarms: tuple[Alarm, ...] = ()  # catalog entries of the active alarms

    def alarm(self, code: str) -> Alarm | None:
        """Return the alarm of a condition by its code; None if the catalog does not contain it."""
        return next((alarm for alarm in self.alarms if str(alarm.number) == code), None)

    @property
    def available(self) -> bool:
        """Whether the control responds."""
        return self.values.get("avail") == _AVAILABLE


UNKNOWN = Reading({"avail": _UNAVAILABLE})


@dataclass(slots=True)
class FloorReader:
    """Converter of the snapshots of one machine; ``clock`` in s detects that snapshots stop."""

    machine: Machine
    clock: Callable[[], float]
    _keys: frozenset[str] = field(init=False)  # names of the conditions of this machine
    _execution: Execution = field(init=False)
    _pulse: SilenceWatch = field(default_factory=SilenceWatch)

    def __post_init__(self) -> None:
        wired = self.machine.inputs
        terminals = (each.terminal for each in wired.values() if each.terminal)
        self._execution = Execution(frozenset((*wired, *terminals)))
        self._keys = condition_keys(self.machine)

    def look(self, snapshot: Snapshot) -> Reading:
        """Return the present values and conditions; UNKNOWN if the control is silent."""
        if self._pulse.silent(snapshot.t, self.clock()):
            return UNKNOWN
        values: dict[str, Value] = {
            "avail": _AVAILABLE,
            "estop": "TRIGGERED" if snapshot.state is State.ESTOP else "ARMED",
            "mode": mode_of(snapshot),
            "execution": self._execution.look(snapshot),
            **_program(snapshot),
            **self._axes(snapshot),
            **_motion(snapshot),
            **self._spindle(snapshot),
            **self._wired(snapshot),
        }
        stop = (snapshot.stop,) if snapshot.stop is not None else ()
        alarms = (*snapshot.alarms, *stop)
        return Reading(values, conditions_of(snapshot, self._keys), snapshot.interrupted, alarms)

    def _axes(self, snapshot: Snapshot) -> dict[str, Value]:
        """Return the axis positions in machine coordinates, X as a radius.

        The position of an axis that is not homed is None.
        """
        known = Unknown.SLIDES not in snapshot.unknown
        at = zip(snapshot.axes, snapshot.actual, snapshot.homed, strict=True)
        return {
            f"{name}abs": actual if known and homed and (name != "C" or self.machine.c_enabled) else None
            for name, actual, homed in at
        }

    def _spindle(self, snapshot: Snapshot) -> dict[str, Value]:
        known, turning = Unknown.SPINDLE not in snapshot.unknown, abs(snapshot.rpm_actual)
        held = (
            turning >= self.machine.spindle.stop_below and not self.machine.interlocks.unclamp_while_turning
        )
        return {
            "Srpm": None if not known else turning if turning >= _STILL else 0.0,
            "Scmd": abs(snapshot.spindle_asked),
            "Sovr": 100.0 * snapshot.spindle_override,
            "Sload": snapshot.spindle_load if known else None,
            "rotmode": "CONTOUR" if snapshot.modal.c_locked and self.machine.spindle_is_c else "SPINDLE",
            "chuckil": None if not known else "ACTIVE" if held else "INACTIVE",
        }

    def _wired(self, snapshot: Snapshot) -> dict[str, Value]:
        """Return the states of switches; None if a switch is not wired."""

        def told(name: str, on: str, off: str) -> Value:
            if name not in self.machine.inputs or Unknown.INPUTS in snapshot.unknown:
                return None
            return on if name in snapshot.inputs else off

        # commanded to close but not closed yet
        opened = "UNLATCHED" if "collet" in snapshot.outputs else "OPEN"
        return {
            "chuck": told("collet_closed", "CLOSED", opened),
            "door": told("guard", "CLOSED", "OPEN"),
            "endbar": told("end_of_bar", "YES", "NO"),
            "part": told("part", "PRESENT", "NOT_PRESENT"),
        }


def _program(snapshot: Snapshot) -> dict[str, Value]:
    return {
        "program": Path(snapshot.program).name or None,
        "line": str(snapshot.line) if snapshot.line else None,
        "block": snapshot.block_text.strip() or None,
        "toolnum": str(snapshot.modal.tool),
        "pcount": str(snapshot.parts),
    }


def _motion(snapshot: Snapshot) -> dict[str, Value]:
    known = Unknown.SLIDES not in snapshot.unknown
    return {
        "Fact": None if not known else snapshot.velocity if snapshot.velocity >= _STANDS else 0.0,
        "Fovr": 100.0 * snapshot.feed_override,
    }
