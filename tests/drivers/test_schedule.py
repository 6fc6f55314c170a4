"""Faults of a machine file: they come at their time, whoever looks when, and go when they should."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import pytest

from app.compose.machine.machine_files import load_machine, parse_machine
from core.faults import get_fault_code
from core.ports import DriverError
from core.table_schema import MachineFileError
from drivers.simulated.simulated_machine import SimAxes, Simulation, build_simulation
from drivers.simulated.simulated_table import FAULT_KINDS, PlannedFault, SimulatedTable
from drivers.simulators.plant import SimulatedPlant
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.machines import CONFIG, play, ramp, simulation


def broken(*faults: PlannedFault) -> tuple[Simulation, ManualClock]:
    return simulation(dataclasses.replace(CONFIG, planned_faults=faults))


def test_planned_jam_occurs_during_a_move() -> None:
    sim, clock = broken(PlannedFault(0.3, "jam", "X"))
    sim.ports.axes.splice(ramp(0.03, (0.0, 0.0, 0.0), 60.0, 1.0))
    play(sim, clock, 0.29)
    assert sim.ports.axes.sample().fault == ""
    play(sim, clock, 0.2)
    fault = sim.ports.axes.sample().fault
    assert get_fault_code(fault, "driver") == "following"
    assert fault.startswith("X: ")


def test_temporary_fault_ends_after_its_duration() -> None:
    sim, clock = broken(PlannedFault(0.1, "station_silent", seconds=0.5))
    play(sim, clock, 0.3)
    assert sim.ports.station.read_state().age > 0.1
    play(sim, clock, 0.5)
    assert sim.ports.station.read_state().age == 0.0


def test_slowed_spindle_recovers_its_speed() -> None:
    sim, clock = broken(PlannedFault(3.0, "spindle_bog", value=0.4, seconds=2.0))
    sim.ports.spindle.set_speed(1000.0)
    play(sim, clock, 4.9)
    assert sim.ports.spindle.speed() == pytest.approx(400.0)
    play(sim, clock, 2.0)
    assert sim.ports.spindle.speed() == pytest.approx(1000.0)


@pytest.mark.parametrize("what", FAULT_KINDS)
def test_every_fault_kind_of_the_machine_file_can_be_simulated(what: str) -> None:
    sim, clock = broken(PlannedFault(0.05, what, "Z", 0.1, 0.05))
    play(sim, clock, 0.3)


def test_an_unknown_fault_is_refused() -> None:
    config = dataclasses.replace(CONFIG, planned_faults=(PlannedFault(1.0, "rust"),))
    with raises_code(DriverError, "driver", "'rust'"):
        build_simulation(config, ManualClock())


# --- their table in the machine file ------------------------------------------------------------------------


def table_with(lines: str) -> SimulatedTable:
    """[sim] of the shipped lathe with these lines. Raises MachineFileError."""
    text = load_machine().text.replace("[sim]\n", f"[sim]\n{lines}\n", 1)
    table = parse_machine(text, "lathe.toml").hardware.find_driver_table(SimulatedTable)
    assert table is not None
    return table


def test_faults_and_tips_are_read_in_order() -> None:
    table = table_with(
        'faults = [{ at = 12, what = "jam", axis = "Z" }, { at = 1, what = "estop" }]\n'
        "tips = [{ x = 1.0, z = 2.0 }, { x = -1.0, z = 0.0 }]"
    )
    assert table.faults == (PlannedFault(12.0, "jam", "Z"), PlannedFault(1.0, "estop"))
    assert table.tips == ((25.4, 50.8), (-25.4, 0.0))  # the lathe's file counts in inches
    assert table_with("").faults == ()


@pytest.mark.parametrize(
    ("lines", "path", "value"),
    [
        ("faults = 3", "sim.faults", "3"),
        ('faults = { at = 1, what = "estop" }', "sim.faults", "{'at': 1, 'what': 'estop'}"),
        ('tips = "X"', "sim.tips", '"X"'),
        ('faults = [{ at = 1, what = "jam" }]', "sim.faults.1.axis", '""'),
        (
            'faults = [{ at = 1, what = "estop", axis = "X" }]',
            "sim.faults.1.axis",
            '"X"',
        ),
        (
            'faults = [{ at = 1, what = "estop" }, { at = 1, what = "jam", axis = "Q" }]',
            "sim.faults.2.axis",
            '"Q"',
        ),
        ('faults = [{ at = 1, axis = "Q" }]', "sim.faults.1.what", ""),  # and of its axis nothing is said
    ],
)
def test_invalid_planned_fault_is_rejected_at_its_location(lines: str, path: str, value: str) -> None:
    with pytest.raises(MachineFileError) as told:
        table_with(lines)
    (finding,) = told.value.findings
    assert (finding.path, finding.value) == (path, value)


# --- what the ports tell ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("speed", "moving"), [(0.5, True), (-0.02, True), (0.005, False)])
def test_axis_counts_as_moving_from_a_hundredth_millimeter_per_second(speed: float, moving: bool) -> None:
    plant = SimulatedPlant(CONFIG, ManualClock())
    plant.servos[0].v = speed
    assert SimAxes(plant).sample().moving is moving


@pytest.mark.parametrize("measures", [True, False])
def test_spindle_load_is_reported_only_with_a_load_input(measures: bool) -> None:
    sim, clock = simulation(dataclasses.replace(CONFIG, has_spindle_load_input=measures))
    play(sim, clock, 0.1)
    assert (sim.ports.station.read_state().spindle_load is not None) is measures


# --- what the ports refuse ----------------------------------------------------------------------------------

ORIENTS = dataclasses.replace(CONFIG, spindle=dataclasses.replace(CONFIG.spindle, can_orient=True))


@pytest.mark.parametrize("broken", [False, True])
def test_spindle_neither_turns_nor_orients_in_estop_or_with_a_fault(broken: bool) -> None:
    sim, clock = simulation(ORIENTS)
    assert sim.ports.orientation is not None
    sim.ports.orientation.orient_spindle(90.0)
    play(sim, clock, 3.0)
    assert sim.ports.orientation.is_oriented()
    sim.ports.orientation.release_spindle()
    assert not sim.ports.orientation.is_oriented()
    if broken:
        sim.machine.spindle_fault("over-current")
    else:
        sim.machine.press_estop()
    why = "over-current" if broken else "E-stop"
    orientation = sim.ports.orientation
    acts: tuple[Callable[[], None], ...] = (
        lambda: orientation.orient_spindle(0.0),
        lambda: sim.ports.spindle.set_speed(100.0),
    )
    for act in acts:
        with raises_code(DriverError, "spindle-off", why):
            act()
    sim.ports.spindle.set_speed(0.0)  # to stop is always taken
    assert (sim.ports.spindle.read_fault() == "over-current") is broken


def test_missing_encoder_gives_no_angle_and_missing_setter_no_touch() -> None:
    sim, _ = simulation(
        dataclasses.replace(CONFIG, spindle=dataclasses.replace(CONFIG.spindle, pulses_per_rev=0))
    )
    assert sim.ports.spindle.read_angle() is None
    assert (sim.ports.touch, sim.ports.orientation) == (None, None)


def test_unknown_axes_and_outputs_are_reported_by_name() -> None:
    sim, _ = simulation()
    with raises_code(DriverError, "driver", "'Q'") as told:
        sim.ports.axes.home("Q")
    assert told.value.reason == "no-axis"
    with raises_code(DriverError, "output", "'no such'"):
        sim.ports.io.write("no such", True)


def test_sample_rate_matches_the_step_time() -> None:
    sim, _ = simulation()
    assert sim.ports.samples is not None
    assert sim.ports.samples.sample_rate_hz == pytest.approx(1.0 / CONFIG.model_step_s)
