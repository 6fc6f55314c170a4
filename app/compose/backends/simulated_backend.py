"""Backend for the simulated lathe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.compose.backends.backend_entry import Backend, Connected, axis_figures, has_inverter
from core.machine.machine_model import Axis, Machine
from core.machine.setter_table import SetterModel
from core.ports import Clock
from drivers.simulated.simulated_machine import Simulation, build_simulation
from drivers.simulated.simulated_table import SimulatedTable
from drivers.simulators.plant_config import (
    SimAxis,
    SimCollet,
    SimConfig,
    SimOutput,
    SimSetter,
    SimSpindle,
)

if TYPE_CHECKING:
    from drivers.driver_host.host_server import Driven


def simulated(machine: Machine, clock: Clock) -> Simulation:
    """Return the ports and the simulated operator station of a simulated lathe on this clock."""
    return build_simulation(sim_config(machine), clock)


def sim_config(machine: Machine) -> SimConfig:
    """Return the configuration of the simulation."""
    spindle, sim = machine.spindle, machine.hardware.table(SimulatedTable) or SimulatedTable()
    return SimConfig(
        axes=tuple(_axis(axis, machine) for axis in machine.axes),
        spindle=SimSpindle(
            rpm_max=spindle.rpm_max,
            accel=spindle.accel,
            decel=spindle.decel,
            ppr=spindle.encoder_ppr,
            orients=spindle.oriented,
            orient_rpm=spindle.orient_rpm,
        ),
        collet=SimCollet(open_time=machine.collet.open_time, close_time=machine.collet.close_time),
        outputs={
            name: SimOutput(safe=output.safe, initial=name == "collet")
            for name, output in machine.outputs.items()
        },
        inputs=tuple(machine.inputs),
        commit=machine.timing.commit,
        faults=sim.faults,
        seed=sim.seed,
        setter=_setter(machine, sim.tips),
        measures_load="spindle_load" in machine.hardware.analog,
    )


def _setter(machine: Machine, tips: tuple[tuple[float, float], ...]) -> SimSetter | None:
    """Return the simulated tool setter if the machine file has one with tool tips, or None."""
    model = machine.hardware.table(SetterModel)
    return SimSetter(model.x, model.z, model.width, tips) if model is not None and tips else None


def _axis(axis: Axis, machine: Machine) -> SimAxis:
    return SimAxis(**axis_figures(axis, machine), own_drive=not machine.spindle_is_c)


def _driven(machine: Machine, clock: Clock) -> Driven:
    """Return the simulated machine for the driver host; the simulation also runs while no client polls it."""
    from drivers.driver_host.host_server import RESTS, Driven

    ports, hands = simulated(machine, clock)
    wakeup = ports.wakeup
    assert wakeup is not None

    def idle(asleep: bool) -> float:
        return RESTS if asleep and wakeup.settled() else 0.0

    return Driven(ports, ports.axes.sample, _nothing, hands, idle=idle)


def _in_process(machine: Machine, clock: Clock) -> Connected:
    """Connect the simulated machine in this process; its spindle may be a real inverter."""
    ports, hands = simulated(machine, clock)
    close = _nothing
    if has_inverter(machine):
        from app.compose.backends.inverter_backend import with_inverter

        ports, close = with_inverter(machine, ports, clock, close)
    return Connected(ports, hands, hands.set_input, close)


def _nothing() -> None:
    """Close nothing, because the simulation has no resources."""


BACKEND = Backend("feeder", driven=_driven, connect=_in_process, played=lambda _machine: True)
