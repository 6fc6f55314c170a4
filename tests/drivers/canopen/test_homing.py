"""The drives' own homing: what ends it, what does not, and where the path goes on afterwards."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from core.ports import DriverError, StopMode
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine
from tests.drivers.machines import ramp

ZERO = (0.0, 0.0, 0.0)


@pytest.fixture
def lost() -> Iterator[CanBench]:
    """Slides that have to be homed."""
    found = CanBench(can_machine(absolute=False))
    yield found
    found.close()


def test_homing_ends_at_the_switch_and_not_by_stale_bits(lost: CanBench) -> None:
    axes, servo = lost.machine.axes, lost.peers.plant.servos[1]
    servo.switch = 12.0
    assert axes.sample().homed == (False, False, True)
    axes.enable(True)
    axes.home("Z")
    with raises_code(DriverError, "driver", "Z") as told:
        axes.splice(ramp(lost.clock.now() + 0.2, ZERO, 60.0, 0.1))
    assert told.value.reason == "homing"
    lost.run(0.3)
    assert not axes.sample().homed[1]  # target reached was set when it began
    took = lost.until(lambda: axes.sample().homed[1])
    assert 0.3 + took == pytest.approx(12.0 / 25.4, abs=0.2)  # 60 in/min
    assert axes.sample().actual[1] == pytest.approx(0.0, abs=0.00127)
    assert not axes.sample().moving
    # now that it knows where home is, the drive has its limits: 6 in
    assert lost.peers.plant.axis_drives["Z"].values[0x607D, 1] == round(-152.4 / 0.00127)
    axes.splice(ramp(lost.clock.now() + 0.15, (axes.sample().demand[0], 0.0, 0.0), 60.0, 0.1))
    lost.run(1.0)
    assert axes.sample().fault == ""


def test_homing_is_rejected_without_power_in_motion_or_for_unknown_axis(lost: CanBench) -> None:
    axes = lost.machine.axes
    with raises_code(DriverError, "power-lost"):
        axes.home("Z")
    axes.enable(True)
    with raises_code(DriverError, "driver", "'B'") as told:
        axes.home("B")
    assert told.value.reason == "no-axis"
    axes.splice(ramp(lost.clock.now() + 0.15, ZERO, 60.0, 0.6))
    lost.run(0.3)
    with raises_code(DriverError, "homing", "Z") as told:
        axes.home("Z")
    assert told.value.reason == "axis-moves"


def test_interrupted_homing_leaves_the_axis_unhomed(lost: CanBench) -> None:
    axes = lost.machine.axes
    lost.peers.plant.servos[1].switch = 50.0
    axes.enable(True)
    axes.home("Z")
    lost.run(0.5)
    axes.stop(StopMode.RAMP_HOLD)
    assert axes.sample().moving
    with raises_code(DriverError, "driver", "Z") as told:
        axes.splice(ramp(lost.clock.now() + 0.2, ZERO, 60.0, 0.1))
    assert told.value.reason == "homing"
    lost.run(0.5)
    sample = axes.sample()
    assert not sample.homed[1]
    assert not sample.moving
    # the path goes on from where the drive has stopped, not from where the homing began
    assert sample.actual[1] > 5.0
    assert sample.demand == pytest.approx(sample.actual)
    axes.splice(ramp(lost.clock.now() + 0.15, (0.0, sample.demand[1], 0.0), 60.0, 0.1))
    lost.run(1.0)
    assert axes.sample().fault == ""
    assert axes.sample().actual[1] == pytest.approx(sample.actual[1], abs=0.002)
