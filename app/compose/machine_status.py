"""The status file of a machine, put together."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from app.shopfloor.floor_reading import UNKNOWN, FloorReader
from app.shopfloor.status_file import NAME, StatusFile, StatusKeeper, status_of
from core.executor.snapshot import Snapshot
from core.machine.machine_model import Machine
from core.store.store_rows import utc_now


def keep_status(machine: Machine, snapshot: Callable[[], Snapshot], folder: Path) -> Callable[[], None]:
    """Begin to keep the status file in this folder; returns how to end it."""
    reader = FloorReader(machine, time.monotonic)
    keeper = StatusKeeper(
        StatusFile(folder / NAME, utc_now),
        lambda: status_of(machine.name, reader.look(snapshot())),
        status_of(machine.name, UNKNOWN),
    )
    keeper.start()
    return keeper.close
