"""What the contract asks of a driver's bench: its ports, the machine behind it, a hammer for its wires."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from core.block_ports import BlockController
from core.faults import FaultCode
from core.machine.machine_model import Machine
from core.ports import MachinePorts, UnknownPart
from drivers.simulators.plant_controls import PlantControls
from drivers.wakeups import ManualClock
from tests.drivers.contract.moves import hand_over, start
from tests.drivers.contract.world import World

TICK = 0.01
STILL = 0.0013  # mm in a tick: one count
# What every driver has to answer for, by itself or with a word why its wires cannot have it.
NINE = (
    "cable out",
    "silence",
    "garbage",
    "late answers",
    "node reboot",
    "bus-off",
    "dead reader",
    "full queue",
    "two masters",
)


@dataclass(frozen=True, slots=True)
class Fault:
    """What may be counted on once something has gone wrong on a driver's wires.

    ``told`` and ``rests``: s until the driver reports it by its ``code``, in a text that ``names`` a value,
    and until every slide stands. ``spins``,
    ``flows``: why spindle or coolant stay on, where nothing can be said to them any more. ``homeless``:
    nobody knows any more where the slides are. ``unknown``: of what nothing is heard as long as it lasts;
    what is said of that is the last that was. Behind each of them Reset leads back.
    """

    told: float
    rests: float
    code: FaultCode
    names: str = ""
    spins: str = ""
    flows: str = ""
    homeless: bool = False
    unknown: frozenset[UnknownPart] = frozenset()


class Rig(ABC):
    """One machine behind one driver, on a clock that the test moves. A new driver is one more of these."""

    faults: ClassVar[Mapping[str, Fault]]  # each stops everything and is told
    harmless: ClassVar[tuple[str, ...]] = ()  # each goes by, and nobody notices
    missing: ClassVar[Mapping[str, str]] = {}  # of ``NINE`` and of demands: why not here
    hold: ClassVar[float]  # s from 127 mm/s to rest
    runs_on: ClassVar[float] = 0.0  # s that a jog let go still goes at its speed
    kept_in_estop: ClassVar[Mapping[str, str]] = {}  # outputs that only Reset switches off, and why
    heals: ClassVar[float] = 0.3  # s until it sees that a wire has been mended
    sees_output: ClassVar[float] = 0.05  # s until it tells of an output that somebody else has switched
    watched: ClassVar[bool] = False  # something switches off when the control is silent for 0.2 s at rest

    machine: Machine
    clock: ManualClock
    ports: MachinePorts
    world: World

    @abstractmethod
    def alone(self, dt: float) -> None:
        """Let time pass for the machine, and for what of the driver is in another thread or process."""

    @abstractmethod
    def acts(self) -> Mapping[str, Callable[[], None]]:
        """How each of ``faults`` and ``harmless`` is brought about."""

    @abstractmethod
    def mend(self) -> None:
        """Put right whatever was broken."""

    @abstractmethod
    def close(self) -> None:
        """Let everything go."""

    @property
    def slides(self) -> PlantControls:
        """What jams, pushes and drives away: ``missing["slides"]`` where the controller counts by itself."""
        raise NotImplementedError

    def switch_output(self, name: str, on: bool) -> None:
        """Somebody else does: ``missing["outputs told"]`` where no wire tells of it."""
        raise NotImplementedError(name, on)

    @property
    def blocks(self) -> BlockController | None:
        """The controller's planner, where it has one."""
        return self.ports.blocks

    @property
    def told(self) -> str:
        """What the driver says is wrong."""
        return self.ports.axes.sample().fault or self.ports.spindle.read_fault()

    def tick(self) -> None:
        """Let a tick pass, and look as the executor does."""
        self.alone(TICK)
        ports = self.ports
        for look in (ports.axes.sample, ports.io.inputs, ports.spindle.speed, ports.spindle.read_fault):
            look()
        ports.station.read_state()

    def run(self, seconds: float) -> None:
        """Let time pass."""
        end = self.clock.now() + seconds
        while self.clock.now() < end - 1e-9:
            self.tick()

    def until(self, ready: Callable[[], bool], limit: float = 20.0) -> float:
        """Run until ``ready``; how long it took."""
        began = self.clock.now()
        while not ready():
            assert self.clock.now() - began < limit, f"not within {limit} s: {self.ports.axes.sample()}"
            self.tick()
        return self.clock.now() - began

    def stands(self) -> bool:
        """Whether a tick moves nothing, by the machine itself."""
        before = self.world.place()
        self.tick()
        return math.dist(self.world.place(), before) < STILL

    def go(self, speed: float, cruise: float) -> float:
        """X moves from rest to rest, at ``speed`` for ``cruise`` seconds; where it will end.

        Raises DriverError.
        """
        if self.blocks is not None:
            return hand_over(self.blocks, self.ports.axes, speed, cruise)
        segments = start(self.ports.axes, speed, cruise)
        self.ports.axes.splice(segments)
        return float(segments.positions[-1, 0] + 0.5 * segments.velocities[-1, 0] * segments.durations_s[-1])

    def under_way(self) -> float:
        """Drives on, X at 120 mm/s with 0.4 s of way before it; where it will end."""
        self.ports.axes.enable(True)
        self.run(0.2)
        end = self.go(120.0, 0.7)
        self.run(0.4)
        assert self.ports.axes.sample().moving
        return end
