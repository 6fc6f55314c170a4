"""A bus between processes: the shipped CANopen lathe over UDP, its drives in the test's process."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

import resources
from app.compose.backends.canopen_backend import create_simulated_devices
from app.compose.machine.machine_files import load_machine
from core.ports import DriverError
from drivers.simulators.canopen_devices import CanopenDevices
from drivers.wakeups import ManualClock
from tests.late_computer import tell

# A bus whose times a loaded computer can keep: nothing here is about how fast Python is.
TIMES = (
    ("sync_ms = 10 ", "sync_ms = 100 "),
    ("heartbeat_ms = 100 ", "heartbeat_ms = 1000 "),
    ("commit_ms = 140", "commit_ms = 200"),
    ("low_water_ms = 200", "low_water_ms = 250"),
    ("lease_ms = 200", "lease_ms = 220"),
    ("clearance = 1.25", "clearance = 2"),
    ("absolute = false", "absolute = true"),
)


PATIENCE = 60.0  # s of a loaded computer
STALL = 0.08  # s; the drives hold not much more of setpoints


class SteadyClock(ManualClock):
    """Goes with the day, but never more than 5 ms at once: after a stall it catches up step by step.

    A stall in which drives may run dry is told: a test that fails then is played again.
    """

    def __init__(self) -> None:
        super().__init__()
        self._zero, self._epoch = time.monotonic(), time.time()
        self.stalled = False

    @property
    def patience(self) -> float:
        """How long to wait for anything, s: behind a stall what does not come will not come."""
        return 0.5 * PATIENCE if self.stalled else PATIENCE

    def arrival(self, stamp: float) -> float:
        """When a frame came, by this clock."""
        return stamp - self._epoch

    def step(self) -> bool:
        """On by one step; False when it has caught up."""
        late = time.monotonic() - self._zero - self.now()
        if late > STALL and not self.stalled:
            self.stalled = True
            tell("late")
        self.advance(min(max(late, 0.0), 0.005))
        return late > 0.005


def bus_file(folder: Path, *changes: tuple[str, str]) -> Path:
    """A machine file of that bus."""
    group = f"239.74.163.2:{20000 + os.getpid() % 20000}"  # two runs on one port would hear each other
    text = resources.read_machine_file("gt75-canopen.toml")
    channel = (('"socketcan"', '"udp_multicast"'), ('channel = "can0"', f'channel = "{group}"'))
    for old, new in (*channel, *TIMES, *changes):
        assert old in text, old
        text = text.replace(old, new)
    path = folder / "shop.toml"
    path.write_text(text)
    return path


def peers_on(path: Path, clock: SteadyClock) -> CanopenDevices:
    """Drives and terminals of the file; the test is skipped, and says so, where no bus is to be had."""
    try:
        peers = create_simulated_devices(load_machine(path), clock)
    except DriverError as error:
        pytest.skip(f"no bus between processes on this computer: {error}")
    peers.convert_arrival_time = clock.arrival
    return peers
