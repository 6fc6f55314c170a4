"""Check of a connected machine and of the state of every node, drive, input and output."""

from __future__ import annotations

from collections.abc import Iterator

from app.compose.backends.backend_entry import (
    FAILED_STATES,
    MISSING,
    NOT_CHECKED,
    ConnectedMachine,
    MachineCheckResults,
    MachineCheckRow,
    find_backend,
    has_inverter,
    is_simulated,
)
from app.compose.backends.connection import connect_machine, needs_real_time, remove_feature_inputs
from app.compose.control.process_rights_check import USES_OWN_PROCESS, check_rights
from app.compose.optional_features import extras
from core.key_declaration import FileUnit, format_value
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.ports import Clock, DriverError, MachinePorts, StationState
from drivers.canopen.canopen_table import CanopenTable
from drivers.grblhal.grblhal_config import HARDWARE
from drivers.inverter.inverter_spindle import InverterSpindle
from drivers.inverter.inverter_table import InverterTable
from drivers.wakeups import ManualClock, RealClock

_SETTLING_TIME_S = 0.3  # s after which pots and inputs that are reported occasionally are known
_MAX_WAIT_S = 3.0  # s for inputs that are read one after the other
_CHECK_INTERVAL_S = 0.02  # s


def check_machine(machine: Machine) -> MachineCheckResults:
    """Check each node, drive, spindle, station, input, output and pot.

    Driver errors become results of the check. Nothing is switched on, and nothing moves.
    """
    clock: Clock = RealClock() if needs_real_time(machine) else ManualClock()
    answers = MachineCheckResults()
    try:
        _check_nodes(machine, clock, answers)
        if not answers.faults:
            _ask_ports(machine, clock, answers)
    except DriverError as error:
        answers.rows.append(MachineCheckRow(_device_name(machine), "", "no answer", str(error)))
        answers.faults.append(str(error))
    answers.process_rights = check_rights() if USES_OWN_PROCESS else ()
    for extra in extras().values():
        extra.add_check_rows(machine, answers)
    return answers


def _check_nodes(machine: Machine, clock: Clock, results: MachineCheckResults) -> None:
    """Query every node of a real bus separately, so that a missing node does not hide the other nodes."""
    survey = find_backend(machine).survey_nodes
    if survey is None or is_simulated(machine):
        return
    for name, at, error_text, detail in survey(machine, clock):
        state = "no answer" if "no answer" in error_text else "wrong" if error_text else "ok"
        results.rows.append(MachineCheckRow(name, at, state, detail))
        if error_text:
            results.faults.append(error_text)


def _ask_ports(machine: Machine, clock: Clock, answers: MachineCheckResults) -> None:
    connected = connect_machine(machine, clock)
    try:
        if needs_real_time(machine):
            _wait_until_settled(clock, connected.ports, machine)
        measured = _measured_names(machine, connected)
        rows = [row.mark_unchecked(measured) for row in _rows(machine, connected)]
        row_details = {row.detail for row in rows}
        answers.warnings += [each for each in connected.ports.warnings if each not in row_details]
    finally:
        connected.close()
    if (word := find_backend(machine).device_name) in measured:
        answers.rows.append(MachineCheckRow(word, "", "ok", ""))
    answers.rows += rows
    answers.faults += [
        Message("{row}: {state}; {detail}", row=row.name, state=row.state, detail=row.detail)
        if row.detail
        else Message("{row}: {state}", row=row.name, state=row.state)
        for row in rows
        if row.state in FAILED_STATES
    ]


def _measured_names(machine: Machine, connected: ConnectedMachine) -> set[str]:
    """Return the names of the rows with values that hardware has reported."""
    names = (
        set()
        if is_simulated(machine)
        else set(find_backend(machine).list_measured_row_names(remove_feature_inputs(machine)))
    )
    if has_inverter(machine):
        names.add("spindle")
    return names.union(connected.list_measured_row_names())


def _wait_until_settled(clock: Clock, ports: MachinePorts, machine: Machine) -> None:
    """Poll the axes until all inputs are known.

    Polling is necessary because a controller may read auxiliary inputs one at a time.
    """
    began = clock.now()
    while (waited := clock.now() - began) < _MAX_WAIT_S:
        ports.axes.sample()
        if waited >= _SETTLING_TIME_S and machine.inputs.keys() <= ports.io.inputs().keys():
            return
        clock.sleep_until(clock.now() + _CHECK_INTERVAL_S)


def _device_name(machine: Machine) -> str:
    """Return the name of the device that could not be reached."""
    word = find_backend(machine).device_name
    return "spindle" if word == "feeder" and has_inverter(machine) else word


def _rows(machine: Machine, connected: ConnectedMachine) -> Iterator[MachineCheckRow]:
    ports = connected.ports
    sample, terminals = ports.axes.sample(), _terminals(machine)
    for name, homed, at in zip(ports.axes.axes, sample.homed, sample.actual, strict=True):
        detail = Message(
            "{choice}, at {name}",
            choice="homed" if homed else "not homed",
            name=_place(machine.find_axis(name), at, machine),
        )
        yield MachineCheckRow(
            name, _node_address(machine, name), "fault" if sample.fault else "ok", sample.fault or detail
        )
    yield _spindle(machine, ports)
    station = ports.station.read_state()
    yield MachineCheckRow("station", "", "E-stop" if station.estop else "ok", _hands(station))
    yield from connected.list_extra_check_rows()
    for kind, states in (("input", ports.io.inputs()), ("output", ports.io.get_outputs())):
        for name, on in states.items():
            yield MachineCheckRow(
                Message("{kind} {name}", kind=kind, name=name),
                terminals.pop(Message("{kind} {name}", kind=kind, name=name), ""),
                "on" if on else "off",
                "",
            )
    for name, terminal in terminals.items():
        if terminal == HARDWARE:
            yield MachineCheckRow(
                name,
                terminal,
                NOT_CHECKED,
                "the signal cuts power directly in hardware; its state is not reported",
            )
            continue
        yield MachineCheckRow(name, terminal, MISSING, "the machine does not have this terminal")


def _spindle(machine: Machine, ports: MachinePorts) -> MachineCheckRow:
    fault, spindle = ports.spindle.read_fault(), ports.spindle
    detail = Message("{speed} rpm", speed=f"{spindle.speed():.0f}")
    if isinstance(spindle, InverterSpindle):
        detail = Message("{details}, {status}", details=detail, status=spindle.describe_status())
    return MachineCheckRow(
        "spindle", _node_address(machine, "spindle"), "fault" if fault else "ok", fault or detail
    )


def _hands(station: StationState) -> str:
    spindle = Message(
        "spindle {choice} {spindle_pot}",
        choice="AUTO" if station.spindle_auto else "OFF",
        spindle_pot=f"{station.spindle_pot:.0%}",
    )
    return Message("feed override {feed_pot}, {spindle}", feed_pot=f"{station.feed_pot:.0%}", spindle=spindle)


def _place(axis: Axis, at: float, machine: Machine) -> str:
    return format_value(at, FileUnit.DEGREES if axis.is_rotary else FileUnit.LENGTH, machine.is_inch)


def _node_address(machine: Machine, name: str) -> str:
    """Return the node of a drive or the port of an inverter as text."""
    hardware = machine.hardware
    inverter, can = hardware.find_driver_table(InverterTable), hardware.find_driver_table(CanopenTable)
    if name == "spindle" and hardware.spindle_driver == "vfd" and inverter is not None:
        return inverter.port
    if machine.backend != "canopen" or can is None:
        return ""
    return next((f"node {node.id}" for node in can.nodes if node.name == name), "")


def _terminals(machine: Machine) -> dict[str, str]:
    wired = {f"input {name}": each.terminal for name, each in machine.inputs.items()}
    return wired | {f"output {name}": each.terminal for name, each in machine.outputs.items()}
