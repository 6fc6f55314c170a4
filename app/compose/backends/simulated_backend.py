"""Backend for the simulated lathe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.compose.backends.backend_entry import Backend, ConnectedMachine, get_axis_arguments, has_inverter
from core.machine.machine_model import Axis, Machine
from core.machine.setter_table import ToolSetterModel
from core.ports import Clock
from drivers.simulated.simulated_machine import Simulation, build_simulation
from drivers.simulated.simulated_table import SimulatedTable
from drivers.simulators.plant_config import (
    SimAxis,
    SimCollet,
    SimConfig,
    SimOutput,
    SimSpindle,
    SimToolSetter,
)

if TYPE_CHECKING:
    from drivers.driver_host.host_server import DriverBundle


def create_simulation(machine: Machine, clock: Clock) -> Simulation:
    """Return the ports and the simulated operator station of a simulated lathe that uses this clock."""
    return build_simulation(create_sim_config(machine), clock)


def create_sim_config(machine: Machine) -> SimConfig:
    """Return the configuration of the simulation."""
    spindle, sim = machine.spindle, machine.hardware.find_driver_table(SimulatedTable) or SimulatedTable()
    return SimConfig(
        axes=tuple(_axis(axis, machine) for axis in machine.axes),
        spindle=SimSpindle(
            max_rpm=spindle.max_rpm,
            acceleration_rpm_per_s=spindle.acceleration_rpm_s,
            deceleration_rpm_per_s=spindle.deceleration_rpm_s,
            pulses_per_rev=spindle.encoder_ppr,
            can_orient=spindle.oriented,
            orientation_rpm=spindle.orient_rpm,
        ),
        collet=SimCollet(open_time_s=machine.collet.open_time_s, close_time_s=machine.collet.close_time_s),
        outputs={
            name: SimOutput(safe_state=output.safe_state, power_up_state=name == "collet")
            for name, output in machine.outputs.items()
        },
        inputs=tuple(machine.inputs),
        commit_time_s=machine.timing.commit_time_s,
        planned_faults=sim.faults,
        random_seed=sim.seed,
        setter=_tool_setter(machine, sim.tips),
        has_spindle_load_input="spindle_load" in machine.hardware.analog_inputs,
    )


def _tool_setter(machine: Machine, tips: tuple[tuple[float, float], ...]) -> SimToolSetter | None:
    """Return the simulated tool setter, or None if the machine has no tool setter or tool tips."""
    model = machine.hardware.find_driver_table(ToolSetterModel)
    return SimToolSetter(model.x, model.z, model.width, tips) if model is not None and tips else None


def _axis(axis: Axis, machine: Machine) -> SimAxis:
    return SimAxis(**get_axis_arguments(axis, machine), own_drive=not machine.is_spindle_c_axis)


def _create_drivers(machine: Machine, clock: Clock) -> DriverBundle:
    """Return the simulated machine for the driver host.

    The simulation also runs while no client polls the driver host.
    """
    from drivers.driver_host.host_server import MAX_SLEEP_CYCLE_S, DriverBundle

    ports, hands = create_simulation(machine, clock)
    wakeup = ports.wakeup
    assert wakeup is not None

    def get_idle_time(asleep: bool) -> float:
        return MAX_SLEEP_CYCLE_S if asleep and wakeup.can_rely_on_wakeups() else 0.0

    return DriverBundle(ports, ports.axes.sample, _do_nothing, hands, get_idle_time=get_idle_time)


def _connect_in_process(machine: Machine, clock: Clock) -> ConnectedMachine:
    """Connect the simulated machine in this process. A configured inverter for the spindle is real."""
    ports, hands = create_simulation(machine, clock)
    close = _do_nothing
    if has_inverter(machine):
        from app.compose.backends.inverter_backend import add_inverter

        ports, close = add_inverter(machine, ports, clock, close)
    return ConnectedMachine(ports, hands, hands.set_input, close)


def _do_nothing() -> None:
    """Do nothing on closing, because the simulation has no resources to release."""


BACKEND = Backend(
    "feeder", create_drivers=_create_drivers, connect=_connect_in_process, is_simulated=lambda _machine: True
)
