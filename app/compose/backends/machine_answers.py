"""Check of a connected machine: state of every node, drive, input and output."""

from __future__ import annotations

from collections.abc import Iterator

from app.compose.backends.backend_entry import (
    FAILED,
    MISSING,
    NOT_CHECKED,
    Answers,
    Connected,
    Row,
    backend_of,
    has_inverter,
    played,
)
from app.compose.backends.connection import connect, real_time, wired
from app.compose.control.rights import OWN_PROCESS, check_rights
from app.compose.extra import extras
from core.key_declaration import Unit, shown
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.ports import Clock, DriverError, MachinePorts, StationState
from drivers.canopen.canopen_table import CanopenTable
from drivers.grblhal.grblhal_config import HARDWARE
from drivers.inverter.inverter_spindle import InverterSpindle
from drivers.inverter.inverter_table import InverterTable
from drivers.waiting import RealClock, StepClock

_SETTLED = 0.3  # s after which pots and inputs that are reported occasionally are known
_LONGEST = 3.0  # s for inputs that are read one after the other
_LOOK = 0.02  # s


def check_ports(machine: Machine) -> Answers:
    """Check each node, drive, spindle, station, input, output and pot. Driver errors become results.

    Nothing is switched on and nothing moves.
    """
    clock: Clock = RealClock() if real_time(machine) else StepClock()
    answers = Answers()
    try:
        _ask_nodes(machine, clock, answers)
        if not answers.trouble:
            _ask_ports(machine, clock, answers)
    except DriverError as error:
        answers.rows.append(Row(_blamed(machine), "", "no answer", str(error)))
        answers.trouble.append(str(error))
    answers.rights = check_rights() if OWN_PROCESS else ()
    for extra in extras().values():
        extra.check(machine, answers)
    return answers


def _ask_nodes(machine: Machine, clock: Clock, answers: Answers) -> None:
    """Ask every node of a real bus separately, so that a missing node does not hide the others."""
    survey = backend_of(machine).survey
    if survey is None or played(machine):
        return
    for name, at, trouble, detail in survey(machine, clock):
        state = "no answer" if "no answer" in trouble else "wrong" if trouble else "ok"
        answers.rows.append(Row(name, at, state, detail))
        if trouble:
            answers.trouble.append(trouble)


def _ask_ports(machine: Machine, clock: Clock, answers: Answers) -> None:
    connected = connect(machine, clock)
    try:
        if real_time(machine):
            _settle(clock, connected.ports, machine)
        measured = _measured(machine, connected)
        rows = [row.checked(measured) for row in _rows(machine, connected)]
        told = {row.detail for row in rows}
        answers.warnings += [each for each in connected.ports.warnings if each not in told]
    finally:
        connected.close()
    if (word := backend_of(machine).word) in measured:
        answers.rows.append(Row(word, "", "ok", ""))
    answers.rows += rows
    answers.trouble += [
        Message("{row}: {state}; {detail}", row=row.name, state=row.state, detail=row.detail)
        if row.detail
        else Message("{row}: {state}", row=row.name, state=row.state)
        for row in rows
        if row.state in FAILED
    ]


def _measured(machine: Machine, connected: Connected) -> set[str]:
    """Return the names of the rows whose values hardware has reported."""
    names = set() if played(machine) else set(backend_of(machine).measured(wired(machine)))
    if has_inverter(machine):
        names.add("spindle")
    return names.union(connected.measured())


def _settle(clock: Clock, ports: MachinePorts, machine: Machine) -> None:
    """Poll the axes until all inputs are known, as a controller may read auxiliary inputs one by one."""
    began = clock.now()
    while (waited := clock.now() - began) < _LONGEST:
        ports.axes.sample()
        if waited >= _SETTLED and machine.inputs.keys() <= ports.io.inputs().keys():
            return
        clock.sleep_until(clock.now() + _LOOK)


def _blamed(machine: Machine) -> str:
    """Return the name of the part that could not be reached."""
    word = backend_of(machine).word
    return "spindle" if word == "feeder" and has_inverter(machine) else word


def _rows(machine: Machine, connected: Connected) -> Iterator[Row]:
    ports = connected.ports
    sample, terminals = ports.axes.sample(), _terminals(machine)
    for name, homed, at in zip(ports.axes.axes, sample.homed, sample.actual, strict=True):
        detail = Message(
            "{choice}, at {name}",
            choice="homed" if homed else "not homed",
            name=_place(machine.axis(name), at, machine),
        )
        yield Row(name, _node(machine, name), "fault" if sample.fault else "ok", sample.fault or detail)
    yield _spindle(machine, ports)
    station = ports.station.snapshot()
    yield Row("station", "", "E-stop" if station.estop else "ok", _hands(station))
    yield from connected.more_rows()
    for kind, states in (("input", ports.io.inputs()), ("output", ports.io.outputs())):
        for name, on in states.items():
            yield Row(
                Message("{kind} {name}", kind=kind, name=name),
                terminals.pop(Message("{kind} {name}", kind=kind, name=name), ""),
                "on" if on else "off",
                "",
            )
    for name, terminal in terminals.items():
        if terminal == HARDWARE:
            yield Row(
                name,
                terminal,
                NOT_CHECKED,
                "the signal cuts power directly in hardware; its state is not reported",
            )
            continue
        yield Row(name, terminal, MISSING, "the machine does not have this terminal")


def _spindle(machine: Machine, ports: MachinePorts) -> Row:
    fault, spindle = ports.spindle.fault(), ports.spindle
    told = Message("{speed} rpm", speed=f"{spindle.speed():.0f}")
    if isinstance(spindle, InverterSpindle):
        told = Message("{details}, {status}", details=told, status=spindle.status())
    return Row("spindle", _node(machine, "spindle"), "fault" if fault else "ok", fault or told)


def _hands(station: StationState) -> str:
    spindle = Message(
        "spindle {choice} {spindle_pot}",
        choice="AUTO" if station.spindle_auto else "OFF",
        spindle_pot=f"{station.spindle_pot:.0%}",
    )
    return Message("feed override {feed_pot}, {spindle}", feed_pot=f"{station.feed_pot:.0%}", spindle=spindle)


def _place(axis: Axis, at: float, machine: Machine) -> str:
    return shown(at, Unit.DEGREES if axis.rotary else Unit.LENGTH, machine.inch)


def _node(machine: Machine, name: str) -> str:
    """Return the node of a drive, or the port of an inverter."""
    hardware = machine.hardware
    inverter, can = hardware.table(InverterTable), hardware.table(CanopenTable)
    if name == "spindle" and hardware.spindle_driver == "vfd" and inverter is not None:
        return inverter.port
    if machine.backend != "canopen" or can is None:
        return ""
    return next((f"node {node.id}" for node in can.nodes if node.name == name), "")


def _terminals(machine: Machine) -> dict[str, str]:
    wired = {f"input {name}": each.terminal for name, each in machine.inputs.items()}
    return wired | {f"output {name}": each.terminal for name, each in machine.outputs.items()}
