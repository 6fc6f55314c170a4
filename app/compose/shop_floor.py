"""The shop floor's view of a machine: its MTConnect adapter and the device model that fits it."""

from __future__ import annotations

import time
from collections.abc import Callable
from datetime import datetime

from app.shopfloor.reading import FloorReader, Reading
from core.executor.snapshot import Snapshot
from core.machine.hardware.model import MtconnectModel
from core.machine.model import Machine
from core.ports import DriverError
from drivers.mtconnect.adapter import Adapter, Settings
from drivers.mtconnect.items import Category, Component, Layout, machine_items
from drivers.mtconnect.keeper import Keeper
from drivers.mtconnect.lines import Active, Report
from drivers.mtconnect.probe import devices_xml
from drivers.simulated import RealClock


def open_shop_floor(
    machine: Machine, snapshot: Callable[[], Snapshot], tell: Callable[[str], None]
) -> Callable[[], None]:
    """Begin to tell agents about the machine, where its file wants that; returns how to end it.

    A port that cannot be opened is told, and the machine runs all the same.
    """
    model = machine.hardware.mtconnect
    if model is None or not model.enabled:
        return _nothing
    keeper = Keeper(adapter_of(machine, model, snapshot))
    try:
        keeper.start()
    except DriverError as error:
        tell(str(error))
        return _nothing
    return keeper.close


def adapter_of(machine: Machine, model: MtconnectModel, snapshot: Callable[[], Snapshot]) -> Adapter:
    """The adapter on real time; it looks at snapshots and at nothing else."""
    items = tuple(device_of(machine, model).all_items())
    conditions = frozenset(item.key for item in items if item.category is Category.CONDITION)
    reader = FloorReader(machine, conditions, time.monotonic)
    settings = Settings(model.bind, model.port, model.heartbeat)
    return Adapter(settings, items, lambda: _report(reader.look(snapshot())), RealClock())


def device_of(machine: Machine, model: MtconnectModel) -> Component:
    """What is told of this machine. On a lathe the spindle is the C axis too, unless C has its own drive."""
    lathe = machine.kind == "lathe"
    one = lathe and machine.spindle_is_c
    linear = tuple(axis.name for axis in machine.axes if not axis.rotary)
    rotary = tuple(axis.name for axis in machine.axes if axis.rotary and not (one and axis.name == "C"))
    layout = Layout(linear, rotary, "C" if one else "S", one, lathe)
    return machine_items(layout, model.device)


def device_model(machine: Machine, at: datetime) -> str:
    """``Devices.xml`` for the agent. Raises DriverError without an [mtconnect] table or for a bad name."""
    model = machine.hardware.mtconnect
    if model is None:
        raise DriverError(
            f"{machine.source}: there is no [mtconnect] table; it says under which name and port "
            "this machine tells the shop floor about itself"
        )
    return devices_xml(device_of(machine, model), f"{machine.name}, {machine.kind}", at)


def _report(reading: Reading) -> Report:
    conditions = {key: tuple(Active(*each) for each in found) for key, found in reading.conditions.items()}
    return Report(reading.values, conditions)


def _nothing() -> None:
    """What is not open need not be closed."""
