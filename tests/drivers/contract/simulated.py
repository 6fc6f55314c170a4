"""The simulated lathe in process, and the same through the driver host's messages."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import ClassVar

from app.compose.backends.simulated_backend import create_simulation
from app.compose.machine.machine_files import load_machine
from core.machine.machine_model import InputModel, Machine
from core.ports import ALL_UNKNOWN_PARTS, DriverError, MachinePorts
from drivers.driver_host.host_connection import HostConnection, HostLink, InProcessLink, clear_drive_faults
from drivers.driver_host.host_messages import Message
from drivers.driver_host.host_ports import create_host_ports
from drivers.driver_host.host_server import DriverBundle, DriverHost
from drivers.simulators.plant_controls import PlantControls
from drivers.wakeups import ConnectionAttempt, ManualClock
from tests.drivers.contract.rig import Fault, Rig
from tests.drivers.contract.world import SimWorld

_TRIP = Fault(told=0.02, rests=0.1, code="axis", names="X: ")
_INSIDE = "the simulated machine is in this process: there is no wire"


def unhomed(machine: Machine) -> Machine:
    """With a Z that only counts and has to be homed."""
    x, z, c = machine.axes
    z = dataclasses.replace(z, is_position_absolute=False, home_speed=20.0, home_order=1)
    return dataclasses.replace(machine, axes=(x, z, c))


def with_probe(machine: Machine) -> Machine:
    """With the input of a touch probe."""
    wired = InputModel("probe", "IN-7")
    return dataclasses.replace(machine, inputs={**machine.inputs, "probe": wired})


class Simulated(Rig):
    """In process."""

    faults: ClassVar[Mapping[str, Fault]] = {
        "drive fault": _TRIP,
        "following error": Fault(0.07, 0.15, "following", "X: "),
    }
    missing: ClassVar[Mapping[str, str]] = {
        "cable out": _INSIDE,
        "silence": _INSIDE,
        "garbage": _INSIDE,
        "late answers": _INSIDE,
        "node reboot": "it has no drives of their own that could restart",
        "bus-off": _INSIDE,
        "dead reader": "nobody reads: the plant is advanced by whoever looks at it",
        "two masters": _INSIDE,
        "blocks": "its motion is planned here",
    }
    hold = 0.15

    def __init__(self, machine: Machine | None = None, *, homing: bool = False) -> None:
        self.machine = with_probe(machine or load_machine(None))
        if homing:
            self.machine = unhomed(self.machine)
        self.clock = self.make_clock()
        sim = create_simulation(self.machine, self.clock)
        self.ports, self.hands = sim.ports, sim.machine
        self.world = SimWorld(sim.machine, sim.ports.io.get_outputs)

    def make_clock(self) -> ManualClock:
        """Moved by the test."""
        return ManualClock()

    def alone(self, dt: float) -> None:
        """The plant is brought up to its clock by whoever looks."""
        self.clock.advance(dt)

    def acts(self) -> Mapping[str, Callable[[], None]]:
        """The hammer."""
        return {
            "drive fault": lambda: self.hands.drive_fault("X"),
            "following error": lambda: self.hands.jam("X"),
        }

    def mend(self) -> None:
        """The slide is free."""
        self.hands.jam("X", False)

    @property
    def slides(self) -> PlantControls:
        """The simulated ones."""
        return self.hands

    def switch_output(self, name: str, on: bool) -> None:
        """At the terminal."""
        self.hands.switch_output(name, on)

    def close(self) -> None:
        """Nothing to let go."""


class BrokenLink(InProcessLink):
    """A link whose other end can go away, or take its time."""

    why = ""
    late: Callable[[], None] | None = None

    def send_request(self, message: Message) -> Message:
        if self.why:
            gone = self.why == HOST_WORDS["dead reader"]
            raise DriverError(self.why, "feeder-gone" if gone else "feeder-silent")
        answer = super().send_request(message)
        if self.late is not None:
            self.late()
        return answer


def simulation_driven(ports: MachinePorts, hands: object | None) -> DriverBundle:
    """The simulation as the driver host owns it."""
    return DriverBundle(ports, run_cycle=ports.axes.sample, close=lambda: None, station_controls=hands)


# A driver host that no longer hears its control ends the queue (1.0 s here), then takes the power.
HOST_WORDS = {
    "dead reader": "the driver host has ended",
    "silence": "the driver host has not answered",
    "garbage": "the driver host's socket received an invalid message",
}
HOST_FAULTS = {
    fault: Fault(
        told=0.02,
        rests=1.5,
        code="feeder-gone" if fault == "dead reader" else "feeder-silent",
        names=words,
        unknown=ALL_UNKNOWN_PARTS,
    )
    for fault, words in HOST_WORDS.items()
}
HOST_MISSING = {
    "cable out": "the driver host hangs on a socket pair inside one computer",
    "node reboot": "a driver host is not started again: its end is a dead reader",
    "two masters": "the driver host's socket pair belongs to the control that made it; nobody else opens it",
}


class Fed(Simulated):
    """Through the driver host."""

    faults: ClassVar[Mapping[str, Fault]] = {**Simulated.faults, **HOST_FAULTS}
    harmless: ClassVar[tuple[str, ...]] = ("late answers",)
    watched = True
    missing: ClassVar[Mapping[str, str]] = {
        **HOST_MISSING,
        "bus-off": "a socket pair has no such state",
        "blocks": Simulated.missing["blocks"],
    }

    def __init__(self, machine: Machine | None = None, *, homing: bool = False) -> None:
        super().__init__(machine, homing=homing)
        self.inner, self._mended = self.ports, False
        self.host = DriverHost(simulation_driven(self.ports, self.hands))
        self.link = BrokenLink(self.host)
        self.ports = create_host_ports(HostConnection(self.link, self.clock, self._again))

    def alone(self, dt: float) -> None:
        """The driver host's loop goes on."""
        self.clock.advance(dt)
        self.host.run_cycle()

    def _again(self) -> ConnectionAttempt[HostLink]:
        """Another one on the same machine; as long as nothing is mended it does not come up."""

        def begun() -> HostLink:
            if not self._mended:
                raise DriverError("the driver host does not start", "feeder-gone")
            self.host = DriverHost(simulation_driven(self.inner, self.hands))
            self.link = BrokenLink(self.host)
            return clear_drive_faults(self.link)

        return ConnectionAttempt(begun, synchronous=True)

    def mend(self) -> None:
        """Another driver host can be started."""
        super().mend()
        self._mended = True

    def host_stands(self, seconds: float) -> None:
        """Its process is stopped for so long, and the control waits for its answer."""
        self.clock.advance(seconds)
        self.host.record_wakeup_delay(seconds)

    def acts(self) -> Mapping[str, Callable[[], None]]:
        """What the socket can do."""
        return {
            **super().acts(),
            **{fault: self._gone(why) for fault, why in HOST_WORDS.items()},
            "late answers": self._late,
        }

    def _gone(self, why: str) -> Callable[[], None]:
        def break_it() -> None:
            self.link.why = why
            self.host.is_orphaned = True

        return break_it

    def _late(self) -> None:
        """Each answer takes 5 ms; the executor asks several questions a tick."""
        self.link.late = lambda: self.alone(0.005)
