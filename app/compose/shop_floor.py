"""The MTConnect adapter of a machine, and the device model that fits it."""

from __future__ import annotations

import time
from collections.abc import Callable
from datetime import datetime

from app.compose.machine_status import conditions_of_device, device_of
from app.shopfloor.floor_reading import FloorReader, Reading
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from drivers.mtconnect.agent_links import Active, Report, listening
from drivers.mtconnect.mtconnect_adapter import Adapter, AdapterThread, devices_xml, utc_now
from drivers.mtconnect.mtconnect_table import MtconnectTable
from drivers.waiting import RealClock


def open_shop_floor(
    machine: Machine, snapshot: Callable[[], Snapshot], tell: Callable[[str], None]
) -> Callable[[], None]:
    """Begin to tell agents about the machine, where its file wants that; returns how to end it.

    A port that cannot be opened is told, and the machine runs all the same.
    """
    model = machine.hardware.table(MtconnectTable)
    if model is None or not model.enabled:
        return _nothing
    thread = AdapterThread(adapter_of(machine, model, snapshot))
    try:
        thread.start()
    except DriverError as error:
        tell(str(error))
        return _nothing
    return thread.close


def told_to_agents(machine: Machine) -> bool:
    """Whether its file wants agents to be told of it."""
    model = machine.hardware.table(MtconnectTable)
    return model is not None and model.enabled


def try_shop_floor(machine: Machine, model: MtconnectTable) -> None:
    """Open the port and close it again, make the model and throw it away. Raises DriverError."""
    listening(model.bind, model.port).close()
    device_model(machine, utc_now())


def adapter_of(machine: Machine, model: MtconnectTable, snapshot: Callable[[], Snapshot]) -> Adapter:
    """The adapter on real time; it looks at snapshots and at nothing else."""
    device = device_of(machine, model.device)
    reader = FloorReader(machine, conditions_of_device(device), time.monotonic)
    return Adapter(model, tuple(device.all_items()), lambda: _report(reader.look(snapshot())), RealClock())


def device_model(machine: Machine, at: datetime) -> str:
    """``Devices.xml`` for the agent. Raises DriverError without an [mtconnect] table or for a bad name."""
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


def _report(reading: Reading) -> Report:
    conditions = {key: tuple(Active(*each) for each in found) for key, found in reading.conditions.items()}
    return Report(reading.values, conditions)


def _nothing() -> None:
    """What is not open need not be closed."""
