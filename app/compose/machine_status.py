"""What everybody is told of a machine, whoever asks: its parts by name, and the status file that is kept."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from app.shopfloor.floor_reading import UNKNOWN, FloorReader
from app.shopfloor.status_file import NAME, StatusFile, StatusKeeper, status_of
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.store.store_rows import utc_now
from drivers.mtconnect.mtconnect_items import Category, Component, Layout, machine_items

AGENTS = "mtconnect"  # the table of a machine that tells agents about itself; what does is loaded with it


def keep_status(machine: Machine, snapshot: Callable[[], Snapshot], folder: Path) -> Callable[[], None]:
    """Begin to keep the status file in this folder; returns how to end it."""
    reader = FloorReader(machine, conditions_of_device(device_of(machine, machine.name)), time.monotonic)
    keeper = StatusKeeper(
        StatusFile(folder / NAME, utc_now),
        lambda: status_of(machine.name, reader.look(snapshot())),
        status_of(machine.name, UNKNOWN),
    )
    keeper.start()
    return keeper.close


def device_of(machine: Machine, name: str) -> Component:
    """What is told of this machine under a name.

    On a lathe the spindle is the C axis too, unless C has its own drive.
    """
    lathe = machine.kind == "lathe"
    one = lathe and machine.spindle_is_c
    linear = tuple(axis.name for axis in machine.axes if not axis.rotary)
    rotary = tuple(axis.name for axis in machine.axes if axis.rotary and not (one and axis.name == "C"))
    layout = Layout(linear, rotary, "C" if one else "S", one, lathe)
    return machine_items(layout, name)


def conditions_of_device(device: Component) -> frozenset[str]:
    """The keys of its conditions."""
    return frozenset(item.key for item in device.all_items() if item.category is Category.CONDITION)
