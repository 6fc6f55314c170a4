"""Slides on the bus: paths through the drives' queues, homing, single moves, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from core.ports import DriverError, MotionSegments, StopMode
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine
from tests.drivers.machines import ramp

ZERO = (0.0, 0.0, 0.0)


@pytest.fixture
def moving(bench: CanBench) -> CanBench:
    """X goes at 120 mm/s: up in 0.04 s from 0.14 s on."""
    bench.machine.axes.enable(True)
    bench.machine.axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 120.0, 0.6))
    bench.run(0.4)
    return bench


def test_path_is_followed_to_its_end(moving: CanBench) -> None:
    sample = moving.machine.axes.sample()
    assert sample.moving
    # 2(1 - .9)v/wn with wn = 2·pi·40 is 0.0955 mm; one step of the model more or less
    assert abs(sample.following_error[0]) < 0.25
    moving.run(0.8)
    sample = moving.machine.axes.sample()
    assert not sample.moving
    assert sample.actual[0] == pytest.approx(120.0 * 0.64, abs=0.00127)
    assert sample.fault == ""


def test_drive_interpolation_matches_the_path_within_one_count(bench: CanBench) -> None:
    """The peer's cubic against the setpoints' own parabola, at every millisecond."""
    axes, drive = bench.machine.axes, bench.peers.plant.axis_drives["X"]
    axes.enable(True)
    segments = ramp(bench.clock.now() + 0.14, ZERO, 120.0, 0.2)
    axes.splice(segments)
    start = bench.clock.now() + 0.14
    worst = 0.0
    for _ in range(600):
        bench.tick(0.001)
        t = bench.clock.now() - start
        up = min(max(t, 0.0), 0.04)
        even = min(max(t - 0.04, 0.0), 0.2)
        down = min(max(t - 0.24, 0.0), 0.04)
        path = 1500.0 * up * up + 120.0 * even + (120.0 - 1500.0 * down) * down
        worst = max(worst, abs(drive.setpoint_position - path))
    assert worst < 0.00127 + 1e-6 + 0.5 * 0.00127  # half a count of rounding in the records
    assert axes.follower.max_deviation_counts < 1.0


def test_feed_hold_from_full_speed_takes_a_quarter_second_at_most(moving: CanBench) -> None:
    axes = moving.machine.axes
    asked = moving.clock.now()
    axes.stop(StopMode.RAMP_HOLD)
    moving.until(lambda: not axes.sample().moving)
    # 140 ms in the drives and 120/3048 s of braking are 0.18 s
    assert moving.clock.now() - asked < 0.25
    assert axes.sample().enabled
    assert axes.sample().fault == ""


@pytest.mark.parametrize("before", [0.02, 0.06, 0.1, 0.139, 0.16, 0.18])
def test_feed_hold_at_the_end_of_a_move_causes_no_jump(bench: CanBench, before: float) -> None:
    """What is left is in the drives already, or as good as: no jump, wherever it comes."""
    axes, drive = bench.machine.axes, bench.peers.plant.axis_drives["X"]
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 120.0, 0.3))
    bench.run(0.14 + 0.38 - before)
    axes.stop(StopMode.RAMP_HOLD)
    fastest = 0.0
    for _ in range(400):
        bench.tick(0.001)
        fastest = max(fastest, abs(drive.setpoint_velocity))
    assert fastest < 120.5
    assert axes.sample().fault == ""
    assert axes.sample().actual[0] == pytest.approx(axes.sample().demand[0], abs=0.002)
    assert not axes.sample().moving


def test_feed_hold_at_a_reversal_point_does_not_start_the_return_move(bench: CanBench) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    there = ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.2)
    end = there.start_times_s[-1] + there.durations_s[-1]
    back = ramp(end, (60.0 * 0.22, 0.0, 0.0), -60.0, 0.2)
    both = type(there)(*(np.concatenate(pair) for pair in zip(there, back, strict=True)))
    axes.splice(both)
    bench.run(end - 0.14 - bench.clock.now())
    axes.stop(StopMode.RAMP_HOLD)
    bench.run(1.0)
    assert axes.sample().actual[0] == pytest.approx(60.0 * 0.22, abs=0.35)  # not back at 0
    assert not axes.sample().moving
    assert axes.sample().fault == ""


def test_a_stop_with_power_off_does_not_wait_for_the_queue(moving: CanBench) -> None:
    axes = moving.machine.axes
    before = moving.peers.machine.get_true_positions()[0]
    axes.stop(StopMode.RAMP_OFF)
    moving.run(0.2)
    assert not axes.sample().enabled
    # v²/2a is 2.4 mm, and a SYNC of way
    assert moving.peers.machine.get_true_positions()[0] - before < 2.4 + 1.3
    assert axes.sample().fault == ""


def test_second_move_is_executed_after_the_queues_have_ended(bench: CanBench) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.1))
    bench.run(2.0)  # at rest for longer than the queues are kept alive
    there = axes.sample().actual[0]
    assert not bench.peers.plant.axis_drives["X"].is_playing
    axes.splice(ramp(bench.clock.now() + 0.14, (axes.demand_at(1e9)[0][0], 0.0, 0.0), -60.0, 0.1))
    bench.run(1.0)
    assert axes.sample().fault == ""
    assert there == pytest.approx(60.0 * 0.12, abs=0.002)
    assert axes.sample().actual[0] == pytest.approx(0.0, abs=0.002)


@pytest.mark.parametrize("wait", [0.50, 0.56, 0.60, 0.62, 0.64, 0.66, 0.68, 0.70, 0.75])
def test_move_queued_while_the_queues_end_is_executed(bench: CanBench, wait: float) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.1))
    bench.run(0.14 + 0.14 + wait)
    axes.splice(ramp(bench.clock.now() + 0.14, (axes.demand_at(1e9)[0][0], 0.0, 0.0), -60.0, 0.1))
    bench.run(1.0)
    assert axes.sample().fault == ""
    assert axes.sample().actual[0] == pytest.approx(0.0, abs=0.002)


def test_drives_reject_setpoints_when_off_too_fast_or_outside_travel(bench: CanBench) -> None:
    axes = bench.machine.axes
    with raises_code(DriverError, "power-lost"):
        axes.splice(ramp(0.2, ZERO, 60.0, 0.1))
    axes.enable(True)
    start = bench.clock.now() + 0.15
    with raises_code(DriverError, "drive-limits", "X: ") as told:
        axes.splice(ramp(start, ZERO, 128.0, 0.1))
    assert told.value.reason == "too-fast"
    with raises_code(DriverError, "drive-limits", "X: ") as told:
        axes.splice(ramp(start, ZERO, 100.0, 1.2))
    assert told.value.reason == "leaves-travel"
    with raises_code(DriverError, "late") as told:
        axes.splice(ramp(bench.clock.now() + 0.05, ZERO, 60.0, 0.1))
    assert told.value.reason == "too-early"
    bench.run(0.5)
    assert bench.peers.machine.get_true_positions() == ZERO


def test_a_path_of_the_shortest_records_never_overfills_the_drives() -> None:
    """A shaking path, cut into 2 ms records, with 160 ms of it wanted in queues of 64."""
    bench = CanBench(
        can_machine(("commit_ms = 140", "commit_ms = 200"), ("lease_ms = 200", "lease_ms = 205"))
    )
    axes, drive = bench.machine.axes, bench.peers.plant.axis_drives["X"]
    axes.enable(True)
    n, most = 400, 0
    a = np.zeros((n, 3))
    a[:, 0] = np.tile([3000.0, -3000.0, -3000.0, 3000.0], n // 4)
    v = np.vstack([np.zeros(3), np.cumsum(a, axis=0)[:-1] * 0.003])
    step = v * 0.003 + a * 0.003**2 / 2
    p = np.vstack([np.zeros(3), np.cumsum(step, axis=0)[:-1]])
    t = np.asarray(bench.clock.now() + 0.21 + 0.003 * np.arange(n), dtype=np.float64)
    axes.splice(MotionSegments(t, np.full(n, 0.003), p, v, a))
    for _ in range(400):
        bench.tick()
        most = max(most, len(drive.record_queue))
    assert 40 < most <= 60
    assert axes.sample().fault == ""
    assert not axes.sample().moving
    bench.close()
