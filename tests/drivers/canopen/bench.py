"""A machine and its peers on python-can's virtual bus, on a clock that the test moves."""

from __future__ import annotations

import itertools
import queue
from collections.abc import Callable, Mapping
from types import SimpleNamespace

import can
import can.interfaces.virtual
from can.interfaces.virtual import VirtualBus

import resources
from app.compose.backends.canopen_backend import connect_canopen_machine, create_simulated_devices
from app.compose.machine.machine_files import parse_machine
from core.machine.machine_model import Machine
from drivers.canopen.canopen_machine import CanopenMachine
from drivers.simulators.canopen_devices import CanopenDevices
from drivers.simulators.canopen_node import NodeDevice
from drivers.wakeups import ManualClock

TICK = 0.005
_channels = itertools.count()
SHIPPED = resources.read_machine_file("gt75-canopen.toml")


def _without_locks(_maxsize: int = 0) -> queue.SimpleQueue[can.Message]:
    """Make a queue of the virtual bus: both ends of a bench are on one thread."""
    return queue.SimpleQueue()


def _recv(bus: VirtualBus, _timeout: float | None = None) -> can.Message | None:
    """Return the next frame at once, None where there is none: time passes only between two rounds."""
    bus._check_if_open()
    return None if bus.queue.empty() else bus.queue.get()


# The virtual bus of python-can, without what only threads need; nobody here writes into a frame of another.
_QUEUES = SimpleNamespace(Queue=_without_locks, Empty=queue.Empty, Full=queue.Full)
setattr(can.interfaces.virtual, "queue", _QUEUES)  # noqa: B010
setattr(can.interfaces.virtual, "deepcopy", lambda frame: frame)  # noqa: B010
setattr(VirtualBus, "recv", _recv)  # noqa: B010


def can_machine(*changes: tuple[str, str], absolute: bool = True) -> Machine:
    """The shipped machine on a virtual bus of its own; ``absolute`` slides need no homing."""
    text = SHIPPED.replace('interface = "socketcan"', 'interface = "virtual"')
    text = text.replace('channel = "can0"', f'channel = "bench-{next(_channels)}"')
    if absolute:
        text = text.replace("absolute = false", "absolute = true")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    return parse_machine(text, "bench.toml")


def cyclic(mode: str = "csp", *changes: tuple[str, str], drive: str = "cia402", **how: bool) -> Machine:
    """The same with a setpoint every 4 ms, in ``mode``."""
    return can_machine(
        ('mode = "pvt"', f'mode = "{mode}"'),
        ('drive = "epos2"', f'drive = "{drive}"'),
        ("sync_ms = 10 ", "sync_ms = 4 "),
        ("commit_ms = 140", "commit_ms = 30"),
        ("low_water_ms = 200", "low_water_ms = 80"),
        *(() if drive == "epos4" else ((", counts_per_rev = 4000", ""),)),
        *changes,
        **how,
    )


class SaysOtherwise:
    """A device some of whose objects, by index and sub-index, have other values than its own."""

    def __init__(self, device: NodeDevice, values: Mapping[tuple[int, int], int]) -> None:
        self._device, self._values = device, values

    def read(self, index: int, subindex: int) -> int | None:
        """What is said instead, or its own."""
        own = self._device.read(index, subindex)
        return self._values.get((index, subindex), own)

    def write(self, index: int, subindex: int, value: int) -> None:
        """As its own."""
        self._device.write(index, subindex, value)

    def handle_host_loss(self) -> None:
        """As its own."""
        self._device.handle_host_loss()

    def reset(self) -> None:
        """As its own."""
        self._device.reset()


def says(peers: CanopenDevices, name: str, values: Mapping[tuple[int, int], int]) -> None:
    """From now on that node answers so."""
    node = peers.nodes[name]
    node.device = SaysOtherwise(node.device, values)


class CanBench:
    """Both ends of the bus; ``tick`` lets time pass on both."""

    def __init__(self, machine: Machine | None = None) -> None:
        self.model = machine or can_machine()
        self.clock = ManualClock()
        self.peers: CanopenDevices = create_simulated_devices(self.model, self.clock)
        try:
            self.machine: CanopenMachine = connect_canopen_machine(
                self.model, self.clock, self.peers.process_frames
            )
        except Exception:
            self.peers.close()
            raise

    def tick(self, dt: float = TICK) -> None:
        self.clock.advance(dt)
        self.machine.run_cycle()
        self.peers.process_frames()

    def run(self, seconds: float) -> None:
        end = self.clock.now() + seconds
        while self.clock.now() < end - 1e-9:
            self.tick()

    def until(self, ready: Callable[[], bool], limit: float = 10.0) -> float:
        """Run until ``ready``; how long it took."""
        began = self.clock.now()
        while not ready():
            assert self.clock.now() - began < limit, f"not within {limit} s: {self.machine.axes.sample()}"
            self.tick()
        return self.clock.now() - began

    def close(self) -> None:
        self.machine.bus.close()
        self.peers.close()
