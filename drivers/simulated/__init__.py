"""The simulated lathe: default backend, test peer, and the machine of everyone who has none."""

from __future__ import annotations

from typing import NamedTuple

from core.ports import Clock, MachinePorts
from drivers.simulated.clocks import RealClock, StepClock
from drivers.simulated.config import PlannedFault, SimAxis, SimCollet, SimConfig, SimOutput, SimSpindle
from drivers.simulated.machine import SimMachine
from drivers.simulated.plant import Plant
from drivers.simulated.ports import SimAxes, SimGear, SimIO, SimStation
from drivers.simulated.ports import SimSpindle as _SpindlePort
from drivers.simulated.schedule import Schedule

__all__ = [
    "PlannedFault",
    "RealClock",
    "SimAxis",
    "SimCollet",
    "SimConfig",
    "SimMachine",
    "SimOutput",
    "SimSpindle",
    "Simulation",
    "StepClock",
    "build_ports",
    "build_simulation",
]


class Simulation(NamedTuple):
    """The ports for the executor, and the handle for whoever plays the operator."""

    ports: MachinePorts
    machine: SimMachine


def build_simulation(config: SimConfig, clock: Clock) -> Simulation:
    """One simulated machine on ``clock``: its ports and its handle."""
    plant = Plant(config, clock)
    ports = MachinePorts(
        clock=clock,
        axes=SimAxes(plant),
        spindle=_SpindlePort(plant),
        io=SimIO(plant),
        station=SimStation(plant),
        gear=SimGear(plant),
        halt=plant.halt,
    )
    machine = SimMachine(plant)
    if config.faults:
        plant.due = Schedule(machine, config.faults).due
    return Simulation(ports, machine)


def build_ports(config: SimConfig, clock: Clock) -> MachinePorts:
    """The ports alone."""
    return build_simulation(config, clock).ports
