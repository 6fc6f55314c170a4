"""The guard, start and hold inputs of each shipped lathe, in a cycle."""

from __future__ import annotations

import dataclasses

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from core.executor.snapshot import MachineState
from core.machine.machine_model import Machine
from tests.executor.rig import Rig

SAMPLES = (
    "gt75",
    "gt75-bench",
    "gt75-canopen",
    "gt75-epos4",
    "gt75-ethercat",
    "gt75-hal",
    "gt75-mesa-7i76e",
    "gt75-mesa-7i97",
    "gt75-vfd",
)
CUT = "G90G94F50\nM03S1000\nX.5Z.2\nG01F10Z-2.\nM30\n"


def sample(name: str) -> Machine:
    """The machine of the file, with slides that are homed at power-on, on the simulated lathe."""
    machine = parse_machine(resources.read_machine_file(f"{name}.toml"), f"{name}.toml")
    axes = tuple(dataclasses.replace(axis, is_position_absolute=True, home_order=0) for axis in machine.axes)
    return dataclasses.replace(machine, axes=axes)


def cutting(name: str) -> Rig:
    """A cycle that the two-hand relay has started, in its cut."""
    rig = Rig(machine=sample(name))
    rig.load(CUT)
    rig.ready()
    rig.run(1.0)
    rig.sim.machine.press_start()
    rig.until_true(lambda shot: shot.line == 4 and shot.velocity > 0.0)
    return rig


@pytest.mark.parametrize("name", SAMPLES)
def test_open_guard_stops_the_cycle_on_each_sample_machine(name: str) -> None:
    rig = cutting(name)
    rig.sim.machine.set_input("guard", False)
    rig.until(MachineState.HOLD, limit=0.5)
    rig.until_true(lambda shot: shot.rpm_actual == 0.0, limit=4.0)
    assert rig.shot.stop is not None
    assert rig.shot.stop.code == "guard-open"
    rig.sim.machine.set_input("guard", True)
    rig.run(1.0)
    assert (rig.state, rig.shot.rpm_actual) == (MachineState.HOLD, 0.0)


@pytest.mark.parametrize("name", SAMPLES)
def test_hold_button_of_each_sample_machine_holds(name: str) -> None:
    rig = cutting(name)
    rig.sim.machine.press_hold()
    rig.until(MachineState.HOLD, limit=0.5)


def test_parallel_port_safety_circuit_with_guard_triggers_estop() -> None:
    rig = cutting("gt75-parport")
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP, limit=0.1)
    rig.until_true(lambda shot: shot.rpm_actual == 0.0, limit=4.0)
