"""MTConnect adapter of a machine, and its device model."""

from __future__ import annotations

import time
from collections.abc import Callable
from datetime import datetime

from app.extras.mtconnect.driver.agent_links import Active, Report, listening
from app.extras.mtconnect.driver.mtconnect_adapter import Adapter, AdapterThread, devices_xml, utc_now
from app.extras.mtconnect.driver.mtconnect_items import Component, Layout, machine_items
from app.extras.mtconnect.driver.mtconnect_table import MtconnectTable
from app.shopfloor.floor_reading import FloorReader, Reading
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from drivers.waiting import RealClock


def open_shop_floor(
    machine: Machine, snapshot: Callable[[], Snapshot], tell: Callable[[str], None]
) -> Callable[[], None] | None:
    """Start to report the machine to agents, and return a function that stops it.

    A port that cannot be opened is reported, and the machine runs anyway. Returns None if the adapter is not
    enabled or cannot run.
    """
    model = machine.hardware.table(MtconnectTable)
    if model is None or not model.enabled:
        return None
    thread = AdapterThread(adapter_of(machine, model, snapshot))
    try:
        thread.start()
    except DriverError as error:
        tell(str(error))
        return None
    return thread.close


def open_headless(
    machine: Machine, snapshot: Callable[[], Snapshot], say: Callable[[str], None], *, paced: bool
) -> Callable[[], None] | None:
    """Start to report a run without a screen, and return a function that stops it.

    A run that is faster than real time is not reported, because it would report parts that were not made.
    """

    def tell(why: str) -> None:
        say(Message("no data is reported to the shop floor: {why}", why=why))

    if told_to_agents(machine) and not paced:
        tell("this run is faster than real time; use --realtime")
        return None
    return open_shop_floor(machine, snapshot, tell)


def told_to_agents(machine: Machine) -> bool:
    """Return whether the machine file enables the adapter."""
    model = machine.hardware.table(MtconnectTable)
    return model is not None and model.enabled


def try_shop_floor(machine: Machine, model: MtconnectTable) -> None:
    """Check that the port can be opened and the device model can be made. Raises DriverError."""
    listening(model.bind, model.port).close()
    device_model(machine, utc_now())


def adapter_of(machine: Machine, model: MtconnectTable, snapshot: Callable[[], Snapshot]) -> Adapter:
    """Return the adapter on the real-time clock. Its data is from snapshots only."""
    device = device_of(machine, model.device)
    reader = FloorReader(machine, time.monotonic)
    return Adapter(model, tuple(device.all_items()), lambda: _report(reader.look(snapshot())), RealClock())


def device_model(machine: Machine, at: datetime) -> str:
    """Return ``Devices.xml`` for the agent.

    Raises DriverError without [mtconnect] or for an invalid name.
    """
    model = machine.hardware.table(MtconnectTable)
    if model is None:
        raise DriverError(
            "{source}: the [mtconnect] table is missing; add it to specify the name and port "
            "under which this machine reports to the shop floor",
            source=machine.source,
        )
    return devices_xml(
        device_of(machine, model.device),
        Message("{machine}, {kind}", machine=machine.name, kind=machine.kind),
        at,
    )


def device_of(machine: Machine, name: str) -> Component:
    """Return the device model of a machine under a name.

    On a lathe the spindle is also the C axis, unless C has a separate drive.
    """
    lathe = machine.kind == "lathe"
    one = lathe and machine.spindle_is_c
    linear = tuple(axis.name for axis in machine.axes if not axis.rotary)
    rotary = tuple(axis.name for axis in machine.axes if axis.rotary and not (one and axis.name == "C"))
    layout = Layout(linear, rotary, "C" if one else "S", one, lathe)
    return machine_items(layout, name)


def _report(reading: Reading) -> Report:
    conditions = {key: tuple(Active(*each) for each in found) for key, found in reading.conditions.items()}
    return Report(reading.values, conditions)
