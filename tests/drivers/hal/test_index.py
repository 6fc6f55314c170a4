"""The spindle's index on HAL, on the step clock: no angle is told before it, that it misses is told."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from core.faults import get_fault_code
from tests.drivers.contract.hal import Hal

INDEX = 0.3  # turns of the simulated spindle at its index


@pytest.fixture
def rig() -> Iterator[Hal]:
    made = Hal()
    made.ports.axes.enable(True)
    yield made
    made.close()


def angle(rig: Hal) -> tuple[float, float]:
    found = rig.ports.spindle.read_angle()
    assert found is not None
    return found


def test_spindle_angle_is_invalid_until_the_index_has_passed(rig: Hal) -> None:
    first = angle(rig)
    rig.ports.spindle.set_speed(300.0)
    rig.until(lambda: rig.far.plant.spindle.counted_revolutions > 0.25)
    assert angle(rig) == first
    rig.until(lambda: angle(rig) != first, limit=2.0)
    rig.run(0.5)
    t, turns = angle(rig)
    behind = 5.0 * (rig.clock.now() - t)  # turns since that sample
    true = rig.far.plant.spindle.counted_revolutions - behind - INDEX
    assert math.remainder(turns - true, 1.0) == pytest.approx(0.0, abs=0.01)


def test_missing_spindle_index_is_reported_and_reset_retries(rig: Hal) -> None:
    rig.far.has_encoder_index = False
    rig.ports.spindle.set_speed(300.0)
    rig.run(0.5)
    assert rig.ports.spindle.read_fault() == ""
    rig.until(lambda: bool(rig.ports.spindle.read_fault()), limit=2.0)
    assert get_fault_code(rig.ports.spindle.read_fault(), "driver") == "spindle-encoder"
    assert "hal.spindle.index_enable" in rig.ports.spindle.read_fault()
    rig.far.has_encoder_index = True
    rig.ports.axes.clear_fault()
    assert rig.ports.spindle.read_fault() == ""
    rig.ports.spindle.set_speed(300.0)
    old = angle(rig)
    rig.until(lambda: angle(rig) != old, limit=2.0)
