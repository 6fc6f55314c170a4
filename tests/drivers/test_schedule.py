"""Faults of a machine file: they come at their time, whoever looks when, and go when they should."""

from __future__ import annotations

import dataclasses

import pytest

from core.ports import DriverError
from drivers.clocks import StepClock
from drivers.lookalikes.plant_config import PlannedFault
from drivers.simulated.simulated_machine import Simulation, build_simulation
from drivers.simulated.simulated_table import FAULTS
from tests.drivers.machines import CONFIG, play, ramp, simulation


def broken(*faults: PlannedFault) -> tuple[Simulation, StepClock]:
    return simulation(dataclasses.replace(CONFIG, faults=faults))


def test_a_jam_comes_in_the_middle_of_a_move() -> None:
    sim, clock = broken(PlannedFault(0.3, "jam", "X"))
    sim.ports.axes.splice(ramp(0.03, (0.0, 0.0, 0.0), 60.0, 1.0))
    play(sim, clock, 0.29)
    assert sim.ports.axes.sample().fault == ""
    play(sim, clock, 0.2)
    assert sim.ports.axes.sample().fault == "X: following error"


def test_what_lasts_is_mended() -> None:
    sim, clock = broken(PlannedFault(0.1, "station_silent", seconds=0.5))
    play(sim, clock, 0.3)
    assert sim.ports.station.snapshot().age > 0.1
    play(sim, clock, 0.5)
    assert sim.ports.station.snapshot().age == 0.0


def test_a_bogged_spindle_gets_its_speed_back() -> None:
    sim, clock = broken(PlannedFault(3.0, "spindle_bog", value=0.4, seconds=2.0))
    sim.ports.spindle.run(1000.0)
    play(sim, clock, 4.9)
    assert sim.ports.spindle.speed() == pytest.approx(400.0)
    play(sim, clock, 2.0)
    assert sim.ports.spindle.speed() == pytest.approx(1000.0)


@pytest.mark.parametrize("what", FAULTS)
def test_whatever_a_machine_file_may_name_the_simulation_can_break(what: str) -> None:
    sim, clock = broken(PlannedFault(0.05, what, "Z", 0.1, 0.05))
    play(sim, clock, 0.3)


def test_an_unknown_fault_is_refused() -> None:
    config = dataclasses.replace(CONFIG, faults=(PlannedFault(1.0, "rust"),))
    with pytest.raises(DriverError, match="cannot break 'rust'"):
        build_simulation(config, StepClock())
