"""Drivers as one loop owns them: the simulated machine, or a bus with or without simulated peers on it."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from app.compose.canopen import canopen_machine, canopen_peers, own_process
from app.compose.inverter import WithInverter, has_inverter
from app.compose.simulated import simulated
from core.machine.model import Machine
from core.ports import Clock, DriverError, MachinePorts
from drivers.feeder.server import Driven
from drivers.panel_station import PanelStation

if TYPE_CHECKING:
    from drivers.canopen.peer.machine import Peers

STATION = ("start", "hold")  # a machine whose file has neither has no operator station of its own


def driven(machine: Machine, clock: Clock) -> Driven:
    """What the machine file's backend and its spindle are driven by. Raises DriverError."""
    inner = _backend(machine, clock)
    return WithInverter(inner, machine, clock) if has_inverter(machine) else inner


def _backend(machine: Machine, clock: Clock) -> Driven:
    if machine.backend == "sim":
        return SimDriven(machine, clock)
    if machine.backend == "canopen":
        return CanDriven(machine, clock)
    raise DriverError(f"{machine.source}: the feeder has no backend {machine.backend}")


def has_station(machine: Machine) -> bool:
    """Whether the machine has buttons of its own, or is operated by those on the screen."""
    return any(name in machine.inputs for name in STATION)


class SimDriven:
    """The simulated machine."""

    def __init__(self, machine: Machine, clock: Clock) -> None:
        simulation = simulated(machine, clock)
        self.ports: MachinePorts = simulation.ports
        self.hands: object | None = simulation.machine

    def tick(self) -> None:
        """The plant goes on also when nobody looks."""
        self.ports.axes.sample()

    def close(self) -> None:
        """Nothing to let go."""


class CanDriven:
    """The machine on its bus. On a virtual bus the other end is here too: there is none elsewhere."""

    def __init__(self, machine: Machine, clock: Clock) -> None:
        bus = machine.hardware.canopen
        self._peers: Peers | None = None
        if bus is not None and not own_process(bus):
            self._peers = canopen_peers(machine, clock)
        # A clock that stands waits for nobody: the peers are looked after in between.
        idle = self._peers.pump if self._peers is not None else None
        try:
            self._machine = canopen_machine(machine, clock, idle)
        except DriverError:
            if self._peers is not None:
                self._peers.close()
            raise
        ports = self._machine.ports
        self.hands: object | None = self._peers.machine if self._peers is not None else None
        if not has_station(machine):
            wired = ports.station if "handwheel" in machine.hardware.analog else None
            panel = PanelStation(clock, lambda: bool(ports.io.inputs().get("estop")), wired)
            self.hands, ports = self.hands or panel, dataclasses.replace(ports, station=panel)
        self.ports: MachinePorts = ports

    def tick(self) -> None:
        """One round of the bus."""
        if self._peers is not None:
            self._peers.pump()
        self._machine.tick()
        if self._peers is not None:
            self._peers.pump()

    def close(self) -> None:
        """Power off, and let the bus go."""
        self._machine.close()
        if self._peers is not None:
            self._peers.close()
