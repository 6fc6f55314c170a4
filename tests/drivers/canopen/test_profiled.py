"""Drives that plan single moves: the mode for single moves."""

from __future__ import annotations

import pytest

from core.ports import DriverError, StopMode
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine
from tests.drivers.machines import ramp

ZERO = (0.0, 0.0, 0.0)


def profiled() -> CanBench:
    return CanBench(can_machine(('mode = "pvt"', 'mode = "pp"')))


def test_profile_position_moves_to_the_end_of_the_queue() -> None:
    bench = profiled()
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.5))
    bench.run(1.5)
    assert axes.sample().fault == ""
    assert axes.sample().actual[0] == pytest.approx(60.0 * 0.52, abs=0.003)
    bench.close()


def test_profile_position_brakes_where_the_queue_brakes() -> None:
    bench = profiled()
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.8))
    bench.run(0.5)
    axes.stop(StopMode.RAMP_HOLD)
    bench.run(0.6)
    sample = axes.sample()
    assert not sample.moving
    assert sample.actual[0] < 35.0  # 60 mm/s for half a second, and the ramps; not the 49 of the whole move
    assert sample.actual[0] == pytest.approx(sample.demand[0], abs=0.003)
    bench.close()


def test_profile_position_refuses_a_corner() -> None:
    bench = profiled()
    axes = bench.machine.axes
    axes.enable(True)
    segments = ramp(bench.clock.now() + 0.15, ZERO, 60.0, 0.5)
    bent = segments.positions.copy()
    bent[1:, 1] = 1.0
    with raises_code(DriverError, "drive-limits") as told:
        axes.splice(segments._replace(positions=bent))
    assert told.value.reason == "one-move-only"
    bench.close()


def test_profile_position_drives_do_not_run_drive_tests() -> None:
    bench = profiled()
    assert 'mode = "pp"' in bench.machine.ports.untraced
    bench.close()
    other = CanBench(can_machine())
    assert other.machine.ports.untraced == ""
    other.close()
