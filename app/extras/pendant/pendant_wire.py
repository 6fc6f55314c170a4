"""Pendant of a machine file: its device is opened and read in addition to the machine's ports."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace

from app.compose.backends.backend_entry import Connected, Row
from app.extras.pendant.driver.input_devices import EventSource, KernelDevice, chosen, entries
from app.extras.pendant.driver.pendant_station import Pendant, PendantIO, PendantStation
from app.extras.pendant.driver.pendant_table import (
    AT_PENDANT,
    STOPS,
    Control,
    PendantModel,
    button_of,
    wheel_of,
)
from core.machine.machine_model import Machine
from core.ports import DriverError

WHEEL = "handwheel"
Find = Callable[[PendantModel, Mapping[str, Control]], Sequence[EventSource]]


def wired(machine: Machine) -> Machine:
    """Return the machine without the inputs and the handwheel of the pendant, as its backend is wired."""
    inputs = {name: each for name, each in machine.inputs.items() if not _at_pendant(each.terminal)}
    pots = {name: each for name, each in machine.hardware.analog.items() if not _at_pendant(each.terminal)}
    return replace(machine, inputs=inputs, hardware=replace(machine.hardware, analog=pots))


def open_devices(model: PendantModel, wanted: Mapping[str, Control]) -> Sequence[EventSource]:
    """Open the nodes of the matching device. Raises DriverError with the remedy."""
    if sys.platform != "linux":
        raise DriverError("a USB pendant works only on Linux; remove [pendant] from the machine file")
    devices: list[KernelDevice] = []
    with ExitStack() as opened:
        for node in chosen(model.device, model.serial, wanted, entries()):
            devices.append(KernelDevice(node))
            opened.callback(devices[-1].close)
        opened.pop_all()
    return devices


def with_pendant(machine: Machine, connected: Connected, find: Find | None = None) -> Connected:
    """Return the machine with its pendant, if configured.

    A missing pendant is reported and searched for.
    """
    model = machine.hardware.table(PendantModel)
    if model is None:
        return connected
    bound, wheel = _bound(machine), _wheel(machine)
    wanted = {**bound, **({WHEEL: wheel} if wheel is not None else {})}
    look, ports = find or open_devices, connected.ports
    pendant = Pendant(
        bound,
        frozenset(STOPS),
        wheel,
        lambda: look(model, wanted),
        time.monotonic,
        place=model.counts == "place",
        ring=ports.wakeup.ring if ports.wakeup is not None else lambda: None,
    )
    pendant.start()
    away = pendant.state().away
    station = PendantStation(
        ports.station,
        pendant,
        stops=any(name in bound for name in STOPS),
        wheel=wheel is not None or any(name.startswith("wheel_") for name in bound),
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

    def rows() -> Iterable[Row]:
        yield Row("pendant", model.device, "no answer" if station.away else "ok", station.away)

    def measured() -> Iterable[str]:
        if not station.away:
            yield from ("pendant", *(f"input {name}" for name in bound))

    return replace(connected, ports=ports, close=close, more_rows=rows, measured=measured)


def _at_pendant(terminal: str) -> bool:
    return terminal.startswith(AT_PENDANT)


def _bound(machine: Machine) -> dict[str, Control]:
    found = {
        name: button_of(each.terminal.removeprefix(AT_PENDANT))
        for name, each in machine.inputs.items()
        if _at_pendant(each.terminal)
    }
    return {name: control for name, control in found.items() if control is not None}


def _wheel(machine: Machine) -> Control | None:
    model = machine.hardware.analog.get(WHEEL)
    if model is None or not _at_pendant(model.terminal):
        return None
    return wheel_of(model.terminal.removeprefix(AT_PENDANT))
