"""Live states of drives, inputs, outputs and lamps.

Outputs can be switched manually only while the machine is at rest.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum

from app.desk.desk import Desk
from app.desk.late_presses import BlockedLateAction
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow, following
from app.desk.status import formats
from app.desk.status.machine_status import StatusTone
from app.desk.status.readouts import UNKNOWN_VALUE, Lamp, make_drives_lamp, make_lamps
from app.desk.translation import tr
from app.special.special_functions import SpecialFunction
from core.access.access_table import ProtectedChange
from core.executor.commands import ForceOutput
from core.executor.snapshot import Alarm, MachineState, Snapshot
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.ports import UnknownPart

SWITCH_REFUSAL = "SWITCH OUTPUTS ONLY WHEN NO PROGRAM RUNS AND NOTHING MOVES"
AT_REST_STATES = frozenset({MachineState.IDLE, MachineState.DISABLED})
# Users of an input: OmniTurn codes and functions of the control.
_PROGRAM_INPUT_USERS = {"TB2-5": "M91 M92", "TB2-7": "M93 M94", "TB2-9": "M95"}
_INPUT_USERS = {
    "estop": "E-STOP",
    "start": "CYCLE START",
    "hold": "FEED HOLD",
    "guard": "GUARD",
    "collet_closed": "COLLET",
}
STATION_SIGNALS = frozenset({"estop", "start", "hold", "collet_closed"})  # not switched on this page
_OWN_CODES = {"coolant": ("M8", "M9")}
_OWN_CODES_OF_OMNITURN = {"coolant": ("M08", "M09"), "collet": ("M12", "M13")}


class SignalListKind(StrEnum):
    """Lists of signals that the special function can show."""

    OUTPUTS = "OUTPUTS"
    INPUTS = "INPUTS"
    LAMPS = "MACHINE LAMPS"


class SignalsFunction(SpecialFunction):
    """Special function (F10) that lists inputs, outputs and lamps.

    F4 selects the list, and Enter switches an output after the operator confirms.
    """

    name = "INPUTS AND OUTPUTS"
    use = "live signals, manual outputs, lamps"

    def __init__(self, desk: Desk, machine_name: Machine) -> None:
        super().__init__(desk)
        self.machine = machine_name
        self.list_kind = SignalListKind.OUTPUTS
        self._codes = _map_codes(machine_name)

    @property
    def row_count(self) -> int:
        """Return the number of rows of the displayed list."""
        if self.list_kind is SignalListKind.OUTPUTS:
            return len(self.machine.outputs)
        return len(self.machine.inputs) if self.list_kind is SignalListKind.INPUTS else 0

    @property
    def _is_simulated(self) -> bool:
        """Return whether the machine is simulated, so that inputs can be switched."""
        return self.desk.desk_control.set_input is not None

    def make_table(self, snapshot: Snapshot) -> TableContent:
        """Return the table of the selected list, with all states from one snapshot."""
        if self.list_kind is SignalListKind.LAMPS:
            return self._lamps(snapshot)
        outputs = self.list_kind is SignalListKind.OUTPUTS
        on = snapshot.outputs if outputs else snapshot.inputs
        known = (UnknownPart.OUTPUTS if outputs else UnknownPart.INPUTS) not in snapshot.unknown
        models = self.machine.outputs if outputs else self.machine.inputs
        rows = tuple(
            TableRow(
                (
                    name,
                    model.terminal,
                    _state(name in on) if known else UNKNOWN_VALUE,
                    self._used(name, outputs),
                ),
                name in on and known,
                StatusTone.RUN if name in on else StatusTone.OFF,
            )
            for name, model in models.items()
        )
        heads = ("NAME", "TERMINAL", "STATE", "SWITCHED BY" if outputs else "READ BY")
        return TableContent(
            self.list_kind.value,
            heads,
            (0.34, 0.2, 0.16, 0.3),
            rows,
            self.marked,
            untranslated_columns=frozenset({0, 1}),
        )

    def _lamps(self, snapshot: Snapshot) -> TableContent:
        lamps = (
            *make_lamps(snapshot, is_table_rotary=self.machine.has_rotary_table),
            make_drives_lamp(snapshot),
            Lamp("ALARM", bool(snapshot.alarms), is_warning=True),
            Lamp("E-STOP", snapshot.state is MachineState.ESTOP, is_warning=True),
            Lamp("AXES HOMED", all(snapshot.homed)),
        )
        rows = tuple(
            TableRow(
                (lamp.label, _state(lamp.is_lit)),
                lamp.is_lit,
                StatusTone.PAUSE if lamp.is_warning else StatusTone.RUN,
            )
            for lamp in lamps
        )
        return TableContent(self.list_kind.value, ("LAMP", "STATE"), (0.6, 0.4), rows)

    def _used(self, name: str, output: bool) -> str:
        if output:
            return (
                tr("CONTROL (AUTOMATIC)") if name in self.machine.lamp_outputs else self._codes.get(name, "")
            )
        if name == "guard" and not self.machine.interlocks.guard_stops:
            # The guard stops nothing on this machine; its state is only reported to the shop floor.
            return ""
        if name in _INPUT_USERS or self.machine.mdi_language != "omniturn":
            return _INPUT_USERS.get(name, "")
        return _PROGRAM_INPUT_USERS.get(name, f"M97I{name}" if name.isdigit() else "")

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function key F4, which shows the next list."""
        labels = {
            SignalListKind.OUTPUTS: "OUTPUTS",
            SignalListKind.INPUTS: "INPUTS",
            SignalListKind.LAMPS: "LAMPS",
        }
        return {"F4": FunctionKey(labels[following(SignalListKind, self.list_kind)], self._go_on)}

    def _go_on(self) -> None:
        self.desk.clear_prompt_line()
        self.list_kind, self.marked = following(SignalListKind, self.list_kind), 0

    def activate_selected_row(self) -> bool:
        """Switch the selected output, or the selected input of a simulated machine."""
        if self.list_kind is SignalListKind.INPUTS and self._is_simulated:
            self._toggle_input()
        else:
            self._switch()
        return True

    def _toggle_input(self) -> None:
        """Switch a simulated input at any time, including while a program waits for it."""
        name = tuple(self.machine.inputs)[self.marked]
        if name in STATION_SIGNALS:
            self.desk.say(
                tr(
                    Message(
                        "{name} IS SET BY THE OPERATOR STATION OR MACHINE, NOT HERE",
                        name=name,
                    )
                )
            )
            return
        if self.desk.is_refused(ProtectedChange.INPUTS):
            return
        on = name not in self.desk.read_snapshot().inputs
        assert self.desk.desk_control.set_input is not None
        if self.desk.window_state.late_presses.refuse_late_press(BlockedLateAction.INPUT):
            return
        self.desk.desk_control.set_input(name, on)
        self.desk.user_access.persistence.log_change(
            Message("simulated input {name}: {ending}", name=name, ending="on" if on else "off")
        )
        words = tr("SIMULATED INPUT {name} IS ON") if on else tr("SIMULATED INPUT {name} IS OFF")
        self.desk.show_success(tr(Message(words, name=name)))

    def _switch(self) -> None:
        if self.list_kind is not SignalListKind.OUTPUTS:
            self.desk.say("ONLY OUTPUTS CAN BE SWITCHED. F4: SHOW OUTPUTS")
            return
        name = tuple(self.machine.outputs)[self.marked]
        snapshot = self.desk.read_snapshot()
        if snapshot.state not in AT_REST_STATES:
            self.desk.say(SWITCH_REFUSAL)
            return
        if name in self.machine.lamp_outputs:
            self.desk.post(ForceOutput(name, True))
            self.desk.show_success("LAMP TEST: ALL TOWER LAMPS ARE ON FOR 2 SECONDS")
            return
        if self.desk.is_refused(ProtectedChange.OUTPUTS):
            return
        on = name not in snapshot.outputs
        asked = (
            tr("PRESS Y TO SWITCH {name} ON, N TO LEAVE IT OFF")
            if on
            else tr("PRESS Y TO SWITCH {name} OFF, N TO LEAVE IT ON")
        )
        self.desk.ask_operator(tr(Message(asked, name=name)), lambda: self._force(name, on))

    def _force(self, name: str, on: bool) -> None:
        if not self.desk.is_refused(
            ProtectedChange.OUTPUTS
        ):  # The access level may have expired in the meantime.
            self.desk.post(ForceOutput(name, on))
            self.desk.user_access.persistence.log_change(
                Message(
                    "output {name} switched on by hand" if on else "output {name} switched off by hand",
                    name=name,
                )
            )

    def prompt_text(self) -> str:
        """Return the prompt that describes the function of the Enter key."""
        if self.list_kind is SignalListKind.INPUTS and self._is_simulated:
            return tr("ENTER OR TAP: SWITCH SIMULATED INPUT   F4: NEXT LIST")
        if self.list_kind is not SignalListKind.OUTPUTS:
            return "F4: NEXT LIST   ESC: BACK TO THE LIST OF FUNCTIONS"
        if self.desk.read_snapshot().state not in AT_REST_STATES:
            return SWITCH_REFUSAL
        return "CHECK THE MACHINE FIRST   ENTER OR TAP: SWITCH THE OUTPUT"


def _state(on: bool) -> str:
    return "ON" if on else "OFF"


def _map_codes(machine: Machine) -> dict[str, str]:
    """Return the M codes that switch each output, in the notation of the machine's language.

    For each output, the codes that switch it on come first.
    """
    omniturn = machine.mdi_language == "omniturn"
    own = _OWN_CODES_OF_OMNITURN if omniturn else _OWN_CODES
    form = "M{:02d}" if omniturn else "M{}"
    found = {name: list(codes) for name, codes in own.items()}
    for code, (output, _on) in sorted(
        machine.m_code_outputs.items(), key=lambda entry: (not entry[1][1], entry[0])
    ):
        found.setdefault(output, []).append(form.format(code))
    return {name: " ".join(codes) for name, codes in found.items()}


DRIVE_ALARMS = frozenset({"axis", "following", "in-position", "driver"})
POSITION_NOTES = {"lathe": "POSITIONS FROM HOME, X AS A RADIUS", "mill": "FROM HOME"}
AXIS_LETTERS = frozenset("XYZABC")
SPINDLE_ALARMS = frozenset({"spindle", "at-speed", "ignores-stop", "spindle-still", "thread-lost"})


class DriveStatusFunction(SpecialFunction):
    """Special function (F10) that shows the state of the drives.

    Positions are distances from home in machine coordinates, with X as a radius.
    """

    name = "DRIVE STATUS"
    use = "power, home, following error, faults"

    def __init__(self, desk: Desk, machine_name: Machine) -> None:
        super().__init__(desk)
        self.machine = machine_name

    def make_table(self, snapshot: Snapshot) -> TableContent:
        """Return the table with one row per axis and one row for the spindle."""
        metric = self.desk.settings_store.display_units.metric(snapshot.modal.metric)
        on = snapshot.powered
        rows = [self._axis(snapshot, number, metric, on) for number in range(len(snapshot.axes))]
        unit = "MM" if metric else "INCH"
        largest = formats.format_length(snapshot.max_following_error, metric)
        return TableContent(
            Message(
                "DRIVE STATUS  ·  {unit}  ·  {method}", unit=unit, method=POSITION_NOTES[self.machine.kind]
            ),
            ("AXIS", "POWER", "HOME", "DEMAND", "ACTUAL", "FOLLOWING ERROR", "ALLOWED", "FAULT"),
            (0.08, 0.1, 0.12, 0.16, 0.16, 0.15, 0.13, 0.1),
            (*rows, self._spindle(snapshot)),
            notes=(
                Message("Largest following error since startup: {largest}", largest=largest),
                Message("The setpoint queue ran low {underruns} times", underruns=snapshot.underruns),
            ),
            numeric_columns=frozenset({3, 4, 5, 6}),
        )

    def _axis(self, snapshot: Snapshot, number: int, metric: bool, on: bool) -> TableRow:
        axis = self.machine.find_axis(snapshot.axes[number])
        values = (
            snapshot.demand[number],
            snapshot.actual[number],
            snapshot.following_error[number],
            axis.following_error_window,
        )
        write = formats.format_angle if axis.is_rotary else lambda value: formats.format_length(value, metric)
        fault = _find_fault(snapshot.alarms, DRIVE_ALARMS, axis)
        home = "HOMED" if snapshot.homed[number] else "NOT HOMED"
        power = "ON" if on else "OFF"
        known = UnknownPart.AXES not in snapshot.unknown
        value_texts = [write(value) if known else f"{write(value)} {UNKNOWN_VALUE}" for value in values[:3]]
        cells = (axis.name, power if known else UNKNOWN_VALUE, home, *value_texts, write(values[3]), fault)
        return TableRow(cells, on and known and fault == formats.NO_VALUE, StatusTone.RUN)

    def _spindle(self, snapshot: Snapshot) -> TableRow:
        fault = _find_fault(snapshot.alarms, SPINDLE_ALARMS, None)
        band = abs(snapshot.rpm_command) * self.machine.spindle.at_speed_tolerance
        off = snapshot.rpm_actual - snapshot.rpm_command
        known = UnknownPart.SPINDLE not in snapshot.unknown
        cells = (
            "S",
            "AUTO" if snapshot.spindle_auto else "OFF",
            "rpm",
            formats.format_fixed(snapshot.rpm_command, 0),
            formats.format_fixed(snapshot.rpm_actual, 0) if known else UNKNOWN_VALUE,
            formats.format_fixed(off, 0) if known else UNKNOWN_VALUE,
            formats.format_fixed(band, 0),
            fault,
        )
        return TableRow(cells, snapshot.spindle_auto and known and fault == formats.NO_VALUE, StatusTone.RUN)

    def prompt_text(self) -> str:
        """Return the prompt, which names the key for the alarms."""
        return "F7: ALARMS WITH CAUSE AND REMEDY   ESC: BACK TO THE LIST"


def _find_fault(alarms: tuple[Alarm, ...], codes: frozenset[str], axis: Axis | None) -> str:
    """Return the number of an alarm for an axis or the spindle, or a placeholder if none is active.

    An alarm that names no axis applies to all axes.
    """
    for alarm in reversed(alarms):
        named = AXIS_LETTERS & set(alarm.cause.split())
        if alarm.code in codes and (axis is None or not named or axis.name in named):
            return str(alarm.number)
    return formats.NO_VALUE
