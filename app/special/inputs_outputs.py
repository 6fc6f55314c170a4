"""Live states of drives, inputs, outputs and lamps.

Outputs can be switched manually at rest only.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum

from app.desk.desk import Desk
from app.desk.late_presses import Starting
from app.desk.pages.sheet import Key, Row, Sheet, following
from app.desk.status import formats
from app.desk.status.machine_status import Tone
from app.desk.status.readouts import UNKNOWN, Lamp, drives_lamp, lamps_of
from app.desk.translation import tr
from app.special.special_functions import SpecialFunction
from core.access.access_table import Act
from core.executor.commands import ForceOutput
from core.executor.snapshot import Alarm, Snapshot, State
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.ports import Unknown

NOT_NOW = "SWITCH OUTPUTS ONLY WHEN NO PROGRAM RUNS AND NOTHING MOVES"
AT_REST = frozenset({State.IDLE, State.DISABLED})
# Users of an input: OmniTurn codes and functions of the control.
_ASKED_IN_PROGRAMS = {"TB2-5": "M91 M92", "TB2-7": "M93 M94", "TB2-9": "M95"}
_ASKED_BY = {
    "estop": "E-STOP",
    "start": "CYCLE START",
    "hold": "FEED HOLD",
    "guard": "GUARD",
    "collet_closed": "COLLET",
}
OF_STATION = frozenset({"estop", "start", "hold", "collet_closed"})  # not switched on this page
_OWN_CODES = {"coolant": ("M8", "M9")}
_OWN_CODES_OF_OMNITURN = {"coolant": ("M08", "M09"), "collet": ("M12", "M13")}


class Kind(StrEnum):
    """List of signals."""

    OUTPUTS = "OUTPUTS"
    INPUTS = "INPUTS"
    LAMPS = "MACHINE LAMPS"


class InputsOutputs(SpecialFunction):
    """Special function for signals: F4 selects the list, and Enter switches an output after confirmation."""

    name = "INPUTS AND OUTPUTS"
    use = "live signals, manual outputs, lamps"

    def __init__(self, desk: Desk, machine: Machine) -> None:
        super().__init__(desk)
        self.machine = machine
        self.kind = Kind.OUTPUTS
        self._codes = _codes(machine)

    @property
    def count(self) -> int:
        """Number of rows of the displayed list."""
        if self.kind is Kind.OUTPUTS:
            return len(self.machine.outputs)
        return len(self.machine.inputs) if self.kind is Kind.INPUTS else 0

    @property
    def _simulated(self) -> bool:
        """Whether inputs can be switched, as on a simulated machine."""
        return self.desk.control.set_input is not None

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """Return the table of the list, with all states from one snapshot."""
        if self.kind is Kind.LAMPS:
            return self._lamps(snapshot)
        outputs = self.kind is Kind.OUTPUTS
        on = snapshot.outputs if outputs else snapshot.inputs
        known = (Unknown.OUTPUTS if outputs else Unknown.INPUTS) not in snapshot.unknown
        models = self.machine.outputs if outputs else self.machine.inputs
        rows = tuple(
            Row(
                (name, model.terminal, _state(name in on) if known else UNKNOWN, self._used(name, outputs)),
                name in on and known,
                Tone.RUN if name in on else Tone.OFF,
            )
            for name, model in models.items()
        )
        heads = ("NAME", "TERMINAL", "STATE", "SWITCHED BY" if outputs else "READ BY")
        return Sheet(self.kind.value, heads, (0.34, 0.2, 0.16, 0.3), rows, self.marked, raw=frozenset({0, 1}))

    def _lamps(self, snapshot: Snapshot) -> Sheet:
        lamps = (
            *lamps_of(snapshot, table=self.machine.table_turns),
            drives_lamp(snapshot),
            Lamp("ALARM", bool(snapshot.alarms), warn=True),
            Lamp("E-STOP", snapshot.state is State.ESTOP, warn=True),
            Lamp("AXES HOMED", all(snapshot.homed)),
        )
        rows = tuple(
            Row((lamp.word, _state(lamp.lit)), lamp.lit, Tone.PAUSE if lamp.warn else Tone.RUN)
            for lamp in lamps
        )
        return Sheet(self.kind.value, ("LAMP", "STATE"), (0.6, 0.4), rows)

    def _used(self, name: str, output: bool) -> str:
        if output:
            return tr("CONTROL (AUTOMATIC)") if name in self.machine.lamps else self._codes.get(name, "")
        if name == "guard" and not self.machine.interlocks.guard_stops:
            # The guard stops nothing on this machine; its state is only reported to the shop floor.
            return ""
        if name in _ASKED_BY or self.machine.language != "omniturn":
            return _ASKED_BY.get(name, "")
        return _ASKED_IN_PROGRAMS.get(name, f"M97I{name}" if name.isdigit() else "")

    def keys(self) -> Mapping[str, Key]:
        """Return F4, which shows the next list."""
        labels = {Kind.OUTPUTS: "OUTPUTS", Kind.INPUTS: "INPUTS", Kind.LAMPS: "LAMPS"}
        return {"F4": Key(labels[following(Kind, self.kind)], self._go_on)}

    def _go_on(self) -> None:
        self.desk.clear()
        self.kind, self.marked = following(Kind, self.kind), 0

    def act(self) -> bool:
        """Switch the selected output, or the selected input of a simulated machine."""
        if self.kind is Kind.INPUTS and self._simulated:
            self._switch_input()
        else:
            self._switch()
        return True

    def _switch_input(self) -> None:
        """Switch a simulated input at any time, including while a program waits for it."""
        name = tuple(self.machine.inputs)[self.marked]
        if name in OF_STATION:
            self.desk.say(
                tr(
                    Message(
                        "{name} IS SET BY THE OPERATOR STATION OR MACHINE, NOT HERE",
                        name=name,
                    )
                )
            )
            return
        if self.desk.refused(Act.INPUTS):
            return
        on = name not in self.desk.snapshot().inputs
        assert self.desk.control.set_input is not None
        if self.desk.window.late.refuses(Starting.INPUT):
            return
        self.desk.control.set_input(name, on)
        self.desk.access.persistence.note_change(
            Message("simulated input {name}: {ending}", name=name, ending="on" if on else "off")
        )
        words = tr("SIMULATED INPUT {name} IS ON") if on else tr("SIMULATED INPUT {name} IS OFF")
        self.desk.done(tr(Message(words, name=name)))

    def _switch(self) -> None:
        if self.kind is not Kind.OUTPUTS:
            self.desk.say("ONLY OUTPUTS CAN BE SWITCHED. F4: SHOW OUTPUTS")
            return
        name = tuple(self.machine.outputs)[self.marked]
        snapshot = self.desk.snapshot()
        if snapshot.state not in AT_REST:
            self.desk.say(NOT_NOW)
            return
        if name in self.machine.lamps:
            self.desk.post(ForceOutput(name, True))
            self.desk.done("LAMP TEST: ALL TOWER LAMPS ARE ON FOR 2 SECONDS")
            return
        if self.desk.refused(Act.OUTPUTS):
            return
        on = name not in snapshot.outputs
        asked = (
            tr("PRESS Y TO SWITCH {name} ON, N TO LEAVE IT OFF")
            if on
            else tr("PRESS Y TO SWITCH {name} OFF, N TO LEAVE IT ON")
        )
        self.desk.ask(tr(Message(asked, name=name)), lambda: self._force(name, on))

    def _force(self, name: str, on: bool) -> None:
        if not self.desk.refused(Act.OUTPUTS):  # The access level may have expired in the meantime.
            self.desk.post(ForceOutput(name, on))
            self.desk.access.persistence.note_change(
                Message(
                    "output {name} switched on by hand" if on else "output {name} switched off by hand",
                    name=name,
                )
            )

    def prompt(self) -> str:
        """Return the prompt about Enter."""
        if self.kind is Kind.INPUTS and self._simulated:
            return tr("ENTER OR TAP: SWITCH SIMULATED INPUT   F4: NEXT LIST")
        if self.kind is not Kind.OUTPUTS:
            return "F4: NEXT LIST   ESC: BACK TO THE LIST OF FUNCTIONS"
        if self.desk.snapshot().state not in AT_REST:
            return NOT_NOW
        return "CHECK THE MACHINE FIRST   ENTER OR TAP: SWITCH THE OUTPUT"


def _state(on: bool) -> str:
    return "ON" if on else "OFF"


def _codes(machine: Machine) -> dict[str, str]:
    """Return the M codes of each output, on before off, in the notation of the machine's language."""
    omniturn = machine.language == "omniturn"
    own = _OWN_CODES_OF_OMNITURN if omniturn else _OWN_CODES
    form = "M{:02d}" if omniturn else "M{}"
    found = {name: list(codes) for name, codes in own.items()}
    for code, (output, _on) in sorted(machine.m_codes.items(), key=lambda entry: (not entry[1][1], entry[0])):
        found.setdefault(output, []).append(form.format(code))
    return {name: " ".join(codes) for name, codes in found.items()}


OF_DRIVES = frozenset({"axis", "following", "in-position", "driver"})
HOW = {"lathe": "POSITIONS FROM HOME, X AS A RADIUS", "mill": "FROM HOME"}
AXES = frozenset("XYZABC")
OF_SPINDLE = frozenset({"spindle", "at-speed", "ignores-stop", "spindle-still", "thread-lost"})


class DriveStatus(SpecialFunction):
    """Special function for the drives, in machine coordinates from home with X as a radius."""

    name = "DRIVE STATUS"
    use = "power, home, following error, faults"

    def __init__(self, desk: Desk, machine: Machine) -> None:
        super().__init__(desk)
        self.machine = machine

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """Return the table with one row per axis and one for the spindle."""
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
        """Return the prompt, which refers to the alarms."""
        return "F7: ALARMS WITH CAUSE AND REMEDY   ESC: BACK TO THE LIST"


def _fault(alarms: tuple[Alarm, ...], codes: frozenset[str], axis: Axis | None) -> str:
    """Return the number of the alarm of an axis or the spindle.

    An alarm without an axis applies to all.
    """
    for alarm in reversed(alarms):
        named = AXES & set(alarm.cause.split())
        if alarm.code in codes and (axis is None or not named or axis.name in named):
            return str(alarm.number)
    return formats.NOTHING
