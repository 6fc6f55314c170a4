"""Homing on HAL, on the step clock: behind home setpoints go on where HAL's are, not where a slide lags."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from core.ports import DriverError
from drivers.setpoint_queue import plan_axis_move
from tests.coded import raises_code
from tests.drivers.contract.hal import Hal

X, Z = 0, 1
NEAR = 0.03  # mm before its home, where the slide sticks


@pytest.fixture
def rig() -> Iterator[Hal]:
    made = Hal(homing=True)
    made.ports.axes.enable(True)
    yield made
    made.close()


def sticks_before_home(rig: Hal) -> None:
    """Z looks for home, and sticks on its last hundredths of a millimetre there."""
    axes = rig.driver.axes
    axes.home("Z")
    rig.until(lambda: axes.home_positions[Z] != 0.0, limit=30.0)
    rig.until(lambda: abs(axes.read_hal_position(Z) - axes.home_positions[Z]) < NEAR, limit=10.0)
    rig.far.plant_controls.jam("Z")
    rig.until(lambda: axes.active_homing is None, limit=2.0)


def test_demand_after_homing_is_the_setpoint_that_hal_plays(rig: Hal) -> None:
    sticks_before_home(rig)
    axes = rig.ports.axes
    sample = axes.sample()
    assert sample.homed[Z]
    assert abs(sample.actual[Z]) > 0.001  # it lags
    assert sample.demand[Z] == pytest.approx(0.0, abs=1e-6)
    assert axes.demand_at(rig.clock.now())[0][Z] == pytest.approx(0.0, abs=1e-6)


def test_setpoints_that_start_at_the_lagging_position_are_rejected(rig: Hal) -> None:
    sticks_before_home(rig)
    axes = rig.ports.axes
    lags = axes.sample().actual
    with raises_code(DriverError, "driver", "Z: ", "position") as told:
        axes.splice(
            plan_axis_move(rig.clock.now() + 0.3, lags, X, target=lags[X] - 1.0, speed=10.0, accel=100.0)
        )
    assert told.value.reason == "jump"
