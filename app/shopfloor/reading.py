"""A snapshot as data items: keys of ``drivers.mtconnect.items``, in mm, degrees, mm/s, rpm, per cent."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.machine_status import SilenceWatch
from app.shopfloor.conditions import Condition, conditions_of
from app.shopfloor.execution import Execution, mode_of
from core.executor.interrupted_job import InterruptedJob
from core.executor.snapshot import Alarm, Snapshot, State
from core.machine.model import Machine

Value = str | float | None  # None: not known

_STANDS = 0.2  # mm/s; an encoder that trembles by a count within a tick reads as .13
_STILL = 1.0  # rpm
_AVAILABLE, _UNAVAILABLE = "AVAILABLE", "UNAVAILABLE"


@dataclass(frozen=True, slots=True)
class Reading:
    """One look at the machine; without ``conditions`` and values nothing is known of it."""

    values: Mapping[str, Value]
    conditions: Mapping[str, tuple[Condition, ...]] = field(default_factory=dict)
    interrupted: InterruptedJob | None = None
    alarms: tuple[Alarm, ...] = ()  # what the catalogue says of what is active

    def alarm(self, code: str) -> Alarm | None:
        """Of a condition, by its code; None: it is none of the catalogue."""
        return next((alarm for alarm in self.alarms if str(alarm.number) == code), None)

    @property
    def available(self) -> bool:
        """Whether the control speaks."""
        return self.values.get("avail") == _AVAILABLE


UNKNOWN = Reading({"avail": _UNAVAILABLE})


@dataclass(slots=True)
class FloorReader:
    """Looks at snapshots of one machine; ``clock`` in s tells when they no longer come."""

    machine: Machine
    keys: frozenset[str]  # of the conditions that there are
    clock: Callable[[], float]
    _execution: Execution = field(init=False)
    _pulse: SilenceWatch = field(default_factory=SilenceWatch)

    def __post_init__(self) -> None:
        wired = self.machine.inputs
        terminals = (each.terminal for each in wired.values() if each.terminal)
        self._execution = Execution(frozenset((*wired, *terminals)))

    def look(self, snapshot: Snapshot) -> Reading:
        """What is true now. Of a control that is silent nothing is known but that."""
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
        return Reading(values, conditions_of(snapshot, self.keys), snapshot.interrupted, alarms)

    def _axes(self, snapshot: Snapshot) -> dict[str, Value]:
        """Machine frame, X a radius; an axis that has no home does not know where it is."""
        at = zip(snapshot.axes, snapshot.actual, snapshot.homed, strict=True)
        return {
            f"{name}abs": actual if homed and (name != "C" or self.machine.c_enabled) else None
            for name, actual, homed in at
        }

    def _spindle(self, snapshot: Snapshot) -> dict[str, Value]:
        turning = abs(snapshot.rpm_actual)
        held = (
            turning >= self.machine.spindle.stop_below and not self.machine.interlocks.unclamp_while_turning
        )
        return {
            "Srpm": turning if turning >= _STILL else 0.0,
            "Scmd": abs(snapshot.spindle_asked),
            "Sovr": 100.0 * snapshot.spindle_override,
            "rotmode": "CONTOUR" if snapshot.modal.c_locked and self.machine.spindle_is_c else "SPINDLE",
            "chuckil": "ACTIVE" if held else "INACTIVE",
        }

    def _wired(self, snapshot: Snapshot) -> dict[str, Value]:
        """Of what is a switch; where none is wired nothing is known."""

        def told(name: str, on: str, off: str) -> Value:
            if name not in self.machine.inputs:
                return None
            return on if name in snapshot.inputs else off

        opened = "UNLATCHED" if "collet" in snapshot.outputs else "OPEN"  # told to close and not there yet
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
    return {
        "Fact": snapshot.velocity if snapshot.velocity >= _STANDS else 0.0,
        "Fovr": 100.0 * snapshot.feed_override,
    }
