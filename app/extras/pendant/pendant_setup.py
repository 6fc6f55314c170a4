"""Setup of the pendant, which TurnDesk reads in addition to the inputs of the machine."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace

from app.compose.backends.backend_entry import ConnectedMachine, MachineCheckRow
from app.extras.pendant.driver.input_devices import (
    EventSource,
    KernelDevice,
    list_input_devices,
    select_device_nodes,
)
from app.extras.pendant.driver.pendant_station import PendantIO, PendantReader, PendantStation
from app.extras.pendant.driver.pendant_table import (
    PENDANT_PREFIX,
    STOP_INPUTS,
    PendantControl,
    PendantModel,
    parse_button_name,
    parse_wheel_name,
)
from core.machine.machine_model import Machine
from core.ports import DriverError

WHEEL_INPUT = "handwheel"
DeviceFinder = Callable[[PendantModel, Mapping[str, PendantControl]], Sequence[EventSource]]


def remove_pendant(machine: Machine) -> Machine:
    """Return the machine without the inputs and the handwheel of the pendant.

    The machine backend uses only the remaining inputs.
    """
    inputs = {name: each for name, each in machine.inputs.items() if not _at_pendant(each.terminal)}
    pots = {
        name: each for name, each in machine.hardware.analog_inputs.items() if not _at_pendant(each.terminal)
    }
    return replace(machine, inputs=inputs, hardware=replace(machine.hardware, analog_inputs=pots))


def open_devices(
    model: PendantModel, required_controls: Mapping[str, PendantControl]
) -> Sequence[EventSource]:
    """Open the matching input device and return its nodes.

    Raises DriverError, with the remedy, if the device cannot be opened.
    """
    if sys.platform != "linux":
        raise DriverError("a USB pendant works only on Linux; remove [pendant] from the machine file")
    devices: list[KernelDevice] = []
    with ExitStack() as opened:
        for node in select_device_nodes(model.device, model.serial, required_controls, list_input_devices()):
            devices.append(KernelDevice(node))
            opened.callback(devices[-1].close)
        opened.pop_all()
    return devices


def add_pendant(
    machine: Machine, connected: ConnectedMachine, find_devices: DeviceFinder | None = None
) -> ConnectedMachine:
    """Return the connected machine with its pendant, or unchanged if no pendant is configured.

    If the pendant is missing or cannot be opened, the fault is reported and the search for the pendant
    continues.
    """
    model = machine.hardware.find_driver_table(PendantModel)
    if model is None:
        return connected
    bound, wheel = _bound(machine), _wheel(machine)
    wanted = {**bound, **({WHEEL_INPUT: wheel} if wheel is not None else {})}
    look, ports = find_devices or open_devices, connected.ports
    pendant = PendantReader(
        bound,
        frozenset(STOP_INPUTS),
        wheel,
        lambda: look(model, wanted),
        time.monotonic,
        has_absolute_wheel=model.counts == "place",
        report_change=ports.wakeup.request_poll if ports.wakeup is not None else lambda: None,
    )
    pendant.start()
    away = pendant.get_state().missing_reason
    station = PendantStation(
        ports.station,
        pendant,
        has_stops=any(name in bound for name in STOP_INPUTS),
        has_wheel=wheel is not None or any(name.startswith("wheel_") for name in bound),
    )
    ports = replace(
        ports,
        station=station,
        io=PendantIO(ports.io, pendant),
        warnings=(*ports.warnings, *([away] if away else [])),
    )

    def close() -> None:
        connected.close()
        pendant.close()

    def make_check_rows() -> Iterable[MachineCheckRow]:
        yield MachineCheckRow(
            "pendant", model.device, "no answer" if station.missing_reason else "ok", station.missing_reason
        )

    def list_measured_rows() -> Iterable[str]:
        if not station.missing_reason:
            yield from ("pendant", *(f"input {name}" for name in bound))

    return replace(
        connected,
        ports=ports,
        close=close,
        list_extra_check_rows=make_check_rows,
        list_measured_row_names=list_measured_rows,
    )


def _at_pendant(terminal: str) -> bool:
    return terminal.startswith(PENDANT_PREFIX)


def _bound(machine: Machine) -> dict[str, PendantControl]:
    found = {
        name: parse_button_name(each.terminal.removeprefix(PENDANT_PREFIX))
        for name, each in machine.inputs.items()
        if _at_pendant(each.terminal)
    }
    return {name: control for name, control in found.items() if control is not None}


def _wheel(machine: Machine) -> PendantControl | None:
    model = machine.hardware.analog_inputs.get(WHEEL_INPUT)
    if model is None or not _at_pendant(model.terminal):
        return None
    return parse_wheel_name(model.terminal.removeprefix(PENDANT_PREFIX))
