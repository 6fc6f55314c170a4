"""Setup of the MTConnect adapter of a machine, and of its device model."""

from __future__ import annotations

import time
from collections.abc import Callable
from datetime import datetime

from app.extras.mtconnect.driver.agent_links import ActiveCondition, MachineReport, open_listening_socket
from app.extras.mtconnect.driver.mtconnect_adapter import (
    AdapterThread,
    MtconnectAdapter,
    get_utc_now,
    make_devices_xml,
)
from app.extras.mtconnect.driver.mtconnect_items import Component, MachineLayout, make_machine_items
from app.extras.mtconnect.driver.mtconnect_table import MtconnectTable
from app.shopfloor.machine_reading import MachineReader, MachineReading
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from drivers.wakeups import RealClock


def start_adapter(
    machine: Machine, read_snapshot: Callable[[], Snapshot], report_error: Callable[[str], None]
) -> Callable[[], None] | None:
    """Start reporting the machine state to MTConnect agents, and return a function that stops it.

    If the port cannot be opened, the error is reported and the machine runs without the adapter. Returns
    None if the adapter is not enabled or cannot run.
    """
    model = machine.hardware.find_driver_table(MtconnectTable)
    if model is None or not model.enabled:
        return None
    thread = AdapterThread(make_adapter(machine, model, read_snapshot))
    try:
        thread.start()
    except DriverError as error:
        report_error(str(error))
        return None
    return thread.close


def start_headless_adapter(
    machine: Machine,
    read_snapshot: Callable[[], Snapshot],
    report_error: Callable[[str], None],
    *,
    is_real_time: bool,
) -> Callable[[], None] | None:
    """Start the MTConnect adapter for a run without a screen, and return a function that stops it.

    A run that is faster than real time is not reported, because its parts are not made on a machine.
    Returns None if the adapter is not started.
    """

    def report_adapter_error(why: str) -> None:
        report_error(Message("no data is reported to the shop floor: {why}", why=why))

    if is_adapter_enabled(machine) and not is_real_time:
        report_adapter_error("this run is faster than real time; use --realtime")
        return None
    return start_adapter(machine, read_snapshot, report_adapter_error)


def is_adapter_enabled(machine: Machine) -> bool:
    """Return whether the machine file enables the adapter."""
    model = machine.hardware.find_driver_table(MtconnectTable)
    return model is not None and model.enabled


def check_adapter(machine: Machine, table: MtconnectTable) -> None:
    """Check that the port can be opened and that the device model is valid.

    Raises DriverError if one of these checks fails.
    """
    open_listening_socket(table.bind, table.port).close()
    make_devices_document(machine, get_utc_now())


def make_adapter(
    machine: Machine, table: MtconnectTable, read_snapshot: Callable[[], Snapshot]
) -> MtconnectAdapter:
    """Return an MTConnect adapter that uses the real-time clock.

    The adapter gets all its data from snapshots of the machine state.
    """
    device = make_device_component(machine, table.device)
    reader = MachineReader(machine, time.monotonic)
    return MtconnectAdapter(
        table,
        tuple(device.iterate_items()),
        lambda: _report(reader.make_reading(read_snapshot())),
        RealClock(),
    )


def make_devices_document(machine: Machine, creation_time: datetime) -> str:
    """Return the document ``Devices.xml`` for the agent.

    Raises DriverError if the [mtconnect] table is missing or the device name is invalid.
    """
    model = machine.hardware.find_driver_table(MtconnectTable)
    if model is None:
        raise DriverError(
            "{source}: the [mtconnect] table is missing; add it to specify the name and port "
            "under which this machine reports to the shop floor",
            source=machine.source,
        )
    return make_devices_xml(
        make_device_component(machine, model.device),
        Message("{machine}, {kind}", machine=machine.name, kind=machine.kind),
        creation_time,
    )


def make_device_component(machine: Machine, name: str) -> Component:
    """Return the device model of a machine, with the given device name.

    On a lathe, the spindle is also the C axis unless C has a separate drive.
    """
    lathe = machine.kind == "lathe"
    one = lathe and machine.is_spindle_c_axis
    linear = tuple(axis.name for axis in machine.axes if not axis.is_rotary)
    rotary = tuple(axis.name for axis in machine.axes if axis.is_rotary and not (one and axis.name == "C"))
    layout = MachineLayout(linear, rotary, "C" if one else "S", one, lathe)
    return make_machine_items(layout, name)


def _report(reading: MachineReading) -> MachineReport:
    conditions = {
        key: tuple(ActiveCondition(*each) for each in found) for key, found in reading.conditions.items()
    }
    return MachineReport(reading.values, conditions)
