"""What every driver promises at its ports, whatever wire is behind it."""

from __future__ import annotations

import pytest

from core.ports import DriverError, StopMode
from tests.coded import raises_code
from tests.drivers.contract.conftest import need
from tests.drivers.contract.rig import Rig

BRAKING = 120.0**2 / (2 * 3000.0)  # mm from 120 mm/s


def test_connecting_switches_nothing_on(rig: Rig) -> None:
    before = rig.world.place()
    rig.run(0.5)
    sample = rig.ports.axes.sample()
    assert (sample.enabled, sample.moving, sample.fault) == (False, False, "")
    assert rig.ports.spindle.speed() == rig.world.rpm() == 0.0
    assert rig.ports.spindle.read_fault() == ""
    assert not any(on for name, on in rig.world.outputs().items() if name != "collet")
    assert rig.world.place() == before
    assert sample.actual[:2] == pytest.approx(before, abs=0.002)


def test_move_arrives_at_its_commanded_position(powered: Rig) -> None:
    end = powered.go(120.0, 0.3)
    powered.run(0.3)
    powered.until(lambda: not powered.ports.axes.sample().moving)
    sample = powered.ports.axes.sample()
    assert sample.actual[0] == pytest.approx(end, abs=0.003)
    assert powered.world.place()[0] == pytest.approx(end, abs=0.003)
    assert sample.fault == ""
    assert sample.following_error[0] == pytest.approx(0.0, abs=0.003)
    assert powered.stands()


def test_setpoints_are_rejected_without_power(rig: Rig) -> None:
    with raises_code(DriverError, "power-lost"):
        rig.go(60.0, 0.1)
    assert not rig.ports.axes.sample().enabled
    assert rig.stands()


@pytest.mark.parametrize("stall", [0.5, 5.0])
def test_stalled_host_leaves_axes_that_stop_at_the_end_of_their_queue(rig: Rig, stall: float) -> None:
    end = rig.under_way()
    for _ in range(round(stall / 0.01)):
        rig.alone(0.01)
    rig.until(lambda: not rig.ports.axes.sample().moving)
    sample = rig.ports.axes.sample()
    assert sample.fault == ""
    assert sample.actual[0] == pytest.approx(end, abs=0.003)
    assert rig.stands()


def test_feed_hold_stops_within_its_time_limit(moving: Rig) -> None:
    asked = moving.clock.now()
    moving.ports.axes.stop(StopMode.RAMP_HOLD)
    before = (0.0, 0.0)
    while moving.world.place() != before:
        assert moving.clock.now() - asked < moving.hold + 0.01
        before = moving.world.place()
        moving.tick()
    moving.until(lambda: not moving.ports.axes.sample().moving, 1.0)
    assert moving.ports.axes.sample().enabled


@pytest.mark.parametrize("how", [StopMode.RAMP_OFF, StopMode.OFF])
def test_stop_modes_that_remove_power_reject_further_moves(moving: Rig, how: StopMode) -> None:
    before = moving.world.place()[0]
    moving.ports.axes.stop(how)
    moving.until(lambda: not moving.ports.axes.sample().moving, 1.0)
    assert not moving.ports.axes.sample().enabled
    # friction alone brakes half as hard; a round of the bus is 1.2 mm
    assert moving.world.place()[0] - before < (2.0 if how is StopMode.OFF else 1.0) * BRAKING + 1.5
    assert moving.stands()
    with raises_code(DriverError, "power-lost"):
        moving.go(-60.0, 0.1)


def test_stopped_move_is_discarded_when_power_returns(moving: Rig) -> None:
    """Power that comes back finds no rest of the old way."""
    moving.ports.axes.stop(StopMode.RAMP_OFF)
    moving.run(1.0)
    stood = moving.world.place()
    moving.ports.axes.enable(True)
    moving.run(1.0)
    assert moving.world.place() == pytest.approx(stood, abs=0.002)
    end = moving.go(-60.0, 0.2)
    moving.until(lambda: abs(moving.world.place()[0] - end) < 0.003, 2.0)


def test_homing_finds_home_for_one_axis_and_needs_power(lost: Rig) -> None:
    axes = lost.ports.axes
    z = axes.axes.index("Z")
    lost.run(0.1)
    assert not axes.sample().homed[z]
    with raises_code(DriverError, "driver", "'B'") as told:
        axes.home("B")
    assert told.value.reason == "no-axis"
    with raises_code(DriverError, "power-lost"):
        axes.home("Z")
    axes.enable(True)
    lost.run(0.2)
    axes.home("Z")
    lost.tick()
    assert not axes.sample().homed[z]
    with pytest.raises(DriverError):
        lost.go(60.0, 0.1)
    assert lost.until(lambda: axes.sample().homed[z]) > 0.05  # not by what stood there before
    lost.run(0.1)
    assert not axes.sample().moving
    assert axes.sample().actual[z] == pytest.approx(0.0, abs=0.002)
    end = lost.go(60.0, 0.1)
    lost.until(lambda: abs(lost.world.place()[0] - end) < 0.003, 2.0)
    assert lost.told == ""


def test_estop_removes_power_and_its_release_restores_nothing(moving: Rig) -> None:
    axes, spindle = moving.ports.axes, moving.ports.spindle
    spindle.set_speed(500.0)
    moving.run(0.2)
    moving.world.press_estop()
    moving.run(0.5)
    assert moving.ports.station.read_state().estop
    assert not axes.sample().enabled
    assert not axes.sample().moving
    with raises_code(DriverError, "no-power", "E-stop"):
        axes.enable(True)
    stood = moving.world.place()
    moving.run(2.0)
    assert moving.world.rpm() == 0.0
    moving.world.release_estop()
    moving.run(2.0)  # nobody has taken the spindle's command back
    assert not axes.sample().enabled
    assert moving.world.rpm() == 0.0
    if moving.told:
        axes.clear_fault()
        moving.run(4.0)
    assert not axes.sample().enabled
    axes.enable(True)
    moving.run(0.5)
    assert axes.sample().enabled
    assert moving.world.place() == pytest.approx(stood, abs=0.01)
    assert moving.world.rpm() == 0.0


def test_stop_with_power_off_leaves_nothing_moving(moving: Rig) -> None:
    """What a control that ends in good order does: it stops, then it closes."""
    moving.ports.spindle.set_speed(0.0)
    moving.ports.axes.stop(StopMode.RAMP_OFF)
    moving.run(1.0)
    assert moving.stands()


def test_estop_loses_home_of_incremental_axes(lost: Rig) -> None:
    need(lost, "home in E-stop")
    axes = lost.ports.axes
    z = axes.axes.index("Z")
    axes.enable(True)
    lost.run(0.2)
    axes.home("Z")
    lost.until(lambda: axes.sample().homed[z])
    lost.run(0.3)
    lost.world.press_estop()
    lost.run(1.0)
    assert not axes.sample().homed[z]
    lost.world.release_estop()
    lost.run(1.0)
    assert not axes.sample().homed[z]
