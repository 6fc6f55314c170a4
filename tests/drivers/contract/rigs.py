"""One machine behind each backend, on a clock that the test moves. A new driver adds its maker to RIGS."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from app.compose.simulated import simulated
from core.machine.load import load_machine
from core.machine.model import Machine
from core.ports import DriverError, MachinePorts
from drivers.feeder.client import Line
from drivers.feeder.links import LoopLink
from drivers.feeder.ports import feeder_ports
from drivers.feeder.server import Feeder
from drivers.feeder.wire import Message
from drivers.simulated import SimMachine, StepClock
from tests.drivers.canopen.bench import TICK, CanBench, can_machine


@dataclass
class Rig:
    """``faults`` are those that this backend's wires can have; each must stop everything and be told."""

    name: str
    machine: Machine
    clock: StepClock
    ports: MachinePorts
    sim: SimMachine
    tick: Callable[[], None]
    hold: float  # s from 127 mm/s to rest
    faults: Mapping[str, Callable[[], None]] = field(default_factory=dict)
    mend: Callable[[], None] = lambda: None
    final: frozenset[str] = frozenset()  # faults after which the control has to be started again
    close: Callable[[], None] = lambda: None

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


def plain() -> Rig:
    """The simulated lathe in process."""
    machine, clock = load_machine(None), StepClock()
    sim = simulated(machine, clock)

    def tick() -> None:
        clock.advance(0.01)
        sim.ports.axes.sample()

    faults = {"drive fault": lambda: sim.machine.drive_fault("X")}
    return Rig("simulated", machine, clock, sim.ports, sim.machine, tick, 0.15, faults)


class BrokenLink(LoopLink):
    """A link whose other end can go away."""

    why = ""

    def ask(self, message: Message) -> Message:
        if self.why:
            raise DriverError(self.why)
        return super().ask(message)


@dataclass
class SimDriven:
    """The simulation as the feeder owns it."""

    ports: MachinePorts
    hands: object | None

    def tick(self) -> None:
        self.ports.axes.sample()

    def close(self) -> None:
        """Nothing to let go."""


def fed() -> Rig:
    """The simulated lathe through the feeder's messages."""
    machine, clock = load_machine(None), StepClock()
    sim = simulated(machine, clock)
    feeder = Feeder(SimDriven(sim.ports, sim.machine))
    link = BrokenLink(feeder)
    ports = feeder_ports(Line(link, clock))

    def tick() -> None:
        clock.advance(0.01)
        feeder.tick()
        ports.axes.sample()

    def gone(why: str) -> Callable[[], None]:
        def break_it() -> None:
            link.why = why
            feeder.orphaned = True

        return break_it

    faults = {
        "drive fault": lambda: sim.machine.drive_fault("X"),
        "dead reader": gone("the feeder process has ended"),
        "silence": gone("the feeder has not answered"),
        "garbage": gone("the feeder's socket carries something that is no message"),
    }
    final = frozenset(("dead reader", "silence", "garbage"))
    return Rig("fed", machine, clock, ports, sim.machine, tick, 0.15, faults, final=final)


def canopen() -> Rig:
    """CiA 402 and 401 peers on python-can's virtual bus."""
    bench = CanBench(can_machine())
    peers = bench.peers

    def off_the_bus() -> None:
        bench.machine.bus.lost("bus-off: the CAN controller has switched itself off")

    def other_master() -> None:
        peers.network.send_message(0x77F, b"\x05")

    def closed() -> None:
        assert bench.machine.bus.bus is not None
        bench.machine.bus.bus.shutdown()

    def mend() -> None:
        peers.cable(out=False)

    faults = {
        "drive fault": lambda: peers.machine.drive_fault("X"),
        "cable out": lambda: peers.cable(out=True),
        "silence": lambda: setattr(peers.nodes["Z"], "silent", True),
        "silent terminals": lambda: setattr(peers.nodes["io"], "silent", True),
        "node reboot": peers.nodes["X"].boot,
        "terminals reboot": peers.nodes["io"].boot,
        "NMT stop": lambda: setattr(peers.nodes["Z"], "state", 4),
        "bus-off": off_the_bus,
        "two masters": other_master,
        "dead reader": closed,
    }
    final = frozenset(("bus-off", "two masters", "dead reader"))
    return Rig(
        "canopen",
        bench.model,
        bench.clock,
        bench.machine.ports,
        peers.machine,
        lambda: bench.tick(TICK),
        0.25,
        faults,
        mend,
        final,
        bench.close,
    )


RIGS: dict[str, Callable[[], Rig]] = {"simulated": plain, "fed": fed, "canopen": canopen}
# The faults that each backend's wires can have, for tests that run once for each; Rig.faults makes them.
FAULTS = (
    ("simulated", "drive fault"),
    *(("fed", fault) for fault in ("drive fault", "dead reader", "silence", "garbage")),
    *(
        ("canopen", fault)
        for fault in (
            *("drive fault", "cable out", "silence", "silent terminals", "node reboot"),
            *("terminals reboot", "NMT stop", "bus-off", "two masters", "dead reader"),
        )
    ),
)
