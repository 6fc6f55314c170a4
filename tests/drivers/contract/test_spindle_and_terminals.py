"""What every driver promises of spindle, outputs, inputs and station."""

from __future__ import annotations

from functools import partial

import pytest

from core.ports import DriverError, Spindle
from tests.coded import raises_code
from tests.drivers.contract.rig import Rig


def _turns_at(spindle: Spindle, rpm: float) -> bool:
    return abs(spindle.speed() - rpm) < 2.0


def test_spindle_turns_both_directions_and_stops(rig: Rig) -> None:
    spindle = rig.ports.spindle
    for rpm in (-1200.0, 600.0, 1500.0, 0.0):
        spindle.set_speed(rpm)
        rig.until(partial(_turns_at, spindle, rpm), 6.0)
        rig.run(0.3)
        assert rig.world.rpm() == pytest.approx(rpm, abs=1.0)
    spindle.set_speed(600.0)
    rig.until(lambda: abs(spindle.speed() - 600.0) < 2.0)
    spindle.start_coasting()
    rig.until(lambda: abs(spindle.speed()) < 1.0)
    assert rig.stands()
    assert rig.world.rpm() == 0.0
    assert spindle.read_fault() == ""


def test_spindle_speed_is_limited_to_the_maximum_of_the_machine(rig: Rig) -> None:
    rig.ports.spindle.set_speed(-99999.0)
    rig.run(4.0)
    assert rig.world.rpm() == pytest.approx(-rig.machine.spindle.max_rpm, abs=1.0)
    assert rig.ports.spindle.read_fault() == ""


def test_last_of_many_speed_commands_applies(rig: Rig) -> None:
    """More of them than any line takes, as a surface speed makes them; and a stop behind them all."""
    for step in range(200):
        rig.ports.spindle.set_speed(500.0 + 5.0 * step)
        rig.ports.spindle.set_speed(400.0 + 5.0 * step)
        if step % 4 == 0:
            rig.tick()
    rig.run(2.0)
    assert rig.world.rpm() == pytest.approx(400.0 + 5.0 * 199, abs=1.0)
    rig.ports.spindle.set_speed(1500.0)
    rig.ports.spindle.set_speed(0.0)
    rig.run(2.0)
    assert rig.world.rpm() == 0.0
    assert rig.ports.spindle.read_fault() == ""


def test_outputs_are_switched_and_fall_to_their_safe_state(rig: Rig) -> None:
    io = rig.ports.io
    io.write("coolant", True)
    io.write("collet", True)
    rig.run(0.1)
    assert io.get_outputs()["coolant"]
    assert rig.world.outputs()["coolant"]
    io.switch_to_safe_state()
    rig.run(0.1)
    assert not io.get_outputs()["coolant"]
    assert not rig.world.outputs()["coolant"]
    assert io.get_outputs()["collet"]  # "keep"
    assert rig.world.outputs()["collet"]
    with raises_code(DriverError, "output", "'laser'"):
        io.write("laser", True)


def test_inputs_and_station_are_read(rig: Rig) -> None:
    rig.world.set_input("guard", True)
    rig.world.press_hold()
    rig.world.set_feed_pot(0.5)
    rig.world.set_spindle_auto(False)
    rig.run(0.5)  # auxiliary inputs of a controller are asked for one after the other
    assert rig.ports.io.inputs()["guard"]
    station = rig.ports.station.read_state()
    assert station.hold
    assert not station.start
    assert station.feed_pot == pytest.approx(0.5, abs=0.001)
    assert not station.spindle_auto
    assert station.age < 0.1
    rig.world.press_start()
    rig.run(0.05)
    assert rig.ports.station.read_state().start
