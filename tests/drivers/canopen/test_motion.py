"""Slides on the bus: paths through the drives' queues, homing, single moves, and what is refused."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from core.ports import DriverError, Segments, Stop
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


def test_a_path_is_followed_and_arrives(moving: CanBench) -> None:
    sample = moving.machine.axes.sample()
    assert sample.moving
    # 2(1 - .9)v/wn with wn = 2·pi·40 is 0.0955 mm; one step of the model more or less
    assert abs(sample.following_error[0]) < 0.25
    moving.run(0.8)
    sample = moving.machine.axes.sample()
    assert not sample.moving
    assert sample.actual[0] == pytest.approx(120.0 * 0.64, abs=0.00127)
    assert sample.fault == ""


def test_the_drive_passes_where_the_path_is_to_a_count(bench: CanBench) -> None:
    """The peer's cubic against the setpoints' own parabola, at every millisecond."""
    axes, drive = bench.machine.axes, bench.peers.plant.drives["X"]
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
        worst = max(worst, abs(drive.p - path))
    assert worst < 0.00127 + 1e-6 + 0.5 * 0.00127  # half a count of rounding in the records
    assert axes.follower.off_path < 1.0


def test_hold_from_full_speed_within_a_quarter_second(moving: CanBench) -> None:
    axes = moving.machine.axes
    asked = moving.clock.now()
    axes.stop(Stop.RAMP_HOLD)
    moving.until(lambda: not axes.sample().moving)
    # 140 ms in the drives and 120/3048 s of braking are 0.18 s
    assert moving.clock.now() - asked < 0.25
    assert axes.sample().enabled
    assert axes.sample().fault == ""


@pytest.mark.parametrize("before", [0.02, 0.06, 0.1, 0.139, 0.16, 0.18])
def test_hold_at_the_end_of_a_move_changes_nothing_in_the_drives(bench: CanBench, before: float) -> None:
    """What is left is in the drives already, or as good as: no jump, wherever it comes."""
    axes, drive = bench.machine.axes, bench.peers.plant.drives["X"]
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 120.0, 0.3))
    bench.run(0.14 + 0.38 - before)
    axes.stop(Stop.RAMP_HOLD)
    fastest = 0.0
    for _ in range(400):
        bench.tick(0.001)
        fastest = max(fastest, abs(drive.v))
    assert fastest < 120.5
    assert axes.sample().fault == ""
    assert axes.sample().actual[0] == pytest.approx(axes.sample().demand[0], abs=0.002)
    assert not axes.sample().moving


def test_hold_at_a_turning_point_does_not_go_on(bench: CanBench) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    there = ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.2)
    end = there.t[-1] + there.dt[-1]
    back = ramp(end, (60.0 * 0.22, 0.0, 0.0), -60.0, 0.2)
    both = type(there)(*(np.concatenate(pair) for pair in zip(there, back, strict=True)))
    axes.splice(both)
    bench.run(end - 0.14 - bench.clock.now())
    axes.stop(Stop.RAMP_HOLD)
    bench.run(1.0)
    assert axes.sample().actual[0] == pytest.approx(60.0 * 0.22, abs=0.35)  # not back at 0
    assert not axes.sample().moving
    assert axes.sample().fault == ""


def test_a_stop_with_power_off_does_not_wait_for_the_queue(moving: CanBench) -> None:
    axes = moving.machine.axes
    before = moving.peers.machine.true_position()[0]
    axes.stop(Stop.RAMP_OFF)
    moving.run(0.2)
    assert not axes.sample().enabled
    # v²/2a is 2.4 mm, and a SYNC of way
    assert moving.peers.machine.true_position()[0] - before < 2.4 + 1.3
    assert axes.sample().fault == ""


def test_a_second_move_after_the_queues_have_ended(bench: CanBench) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.1))
    bench.run(2.0)  # at rest for longer than the queues are kept alive
    there = axes.sample().actual[0]
    assert not bench.peers.plant.drives["X"].playing
    axes.splice(ramp(bench.clock.now() + 0.14, (axes.demand_at(1e9)[0][0], 0.0, 0.0), -60.0, 0.1))
    bench.run(1.0)
    assert axes.sample().fault == ""
    assert there == pytest.approx(60.0 * 0.12, abs=0.002)
    assert axes.sample().actual[0] == pytest.approx(0.0, abs=0.002)


@pytest.mark.parametrize("wait", [0.50, 0.56, 0.60, 0.62, 0.64, 0.66, 0.68, 0.70, 0.75])
def test_a_move_that_comes_while_the_queues_end(bench: CanBench, wait: float) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.1))
    bench.run(0.14 + 0.14 + wait)
    axes.splice(ramp(bench.clock.now() + 0.14, (axes.demand_at(1e9)[0][0], 0.0, 0.0), -60.0, 0.1))
    bench.run(1.0)
    assert axes.sample().fault == ""
    assert axes.sample().actual[0] == pytest.approx(0.0, abs=0.002)


def test_drives_refuse_when_off_too_fast_or_outside(bench: CanBench) -> None:
    axes = bench.machine.axes
    with pytest.raises(DriverError, match="drives are off"):
        axes.splice(ramp(0.2, ZERO, 60.0, 0.1))
    axes.enable(True)
    start = bench.clock.now() + 0.15
    with pytest.raises(DriverError, match="faster than"):
        axes.splice(ramp(start, ZERO, 128.0, 0.1))
    with pytest.raises(DriverError, match="leave"):
        axes.splice(ramp(start, ZERO, 100.0, 1.2))
    with pytest.raises(DriverError, match="too early"):
        axes.splice(ramp(bench.clock.now() + 0.05, ZERO, 60.0, 0.1))
    bench.run(0.5)
    assert bench.peers.machine.true_position() == ZERO


def test_a_path_of_the_shortest_records_never_overfills_the_drives() -> None:
    """A shaking path, cut into 2 ms records, with 160 ms of it wanted in queues of 64."""
    bench = CanBench(
        can_machine(("commit_ms = 140", "commit_ms = 200"), ("lease_ms = 200", "lease_ms = 205"))
    )
    axes, drive = bench.machine.axes, bench.peers.plant.drives["X"]
    axes.enable(True)
    n, most = 400, 0
    a = np.zeros((n, 3))
    a[:, 0] = np.tile([3000.0, -3000.0, -3000.0, 3000.0], n // 4)
    v = np.vstack([np.zeros(3), np.cumsum(a, axis=0)[:-1] * 0.003])
    step = v * 0.003 + a * 0.003**2 / 2
    p = np.vstack([np.zeros(3), np.cumsum(step, axis=0)[:-1]])
    t = np.asarray(bench.clock.now() + 0.21 + 0.003 * np.arange(n), dtype=np.float64)
    axes.splice(Segments(t, np.full(n, 0.003), p, v, a))
    for _ in range(400):
        bench.tick()
        most = max(most, len(drive.queue))
    assert 40 < most <= 60
    assert axes.sample().fault == ""
    assert not axes.sample().moving
    bench.close()


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
    with pytest.raises(DriverError, match="homing"):
        axes.splice(ramp(lost.clock.now() + 0.2, ZERO, 60.0, 0.1))
    lost.run(0.3)
    assert not axes.sample().homed[1]  # target reached was set when it began
    took = lost.until(lambda: axes.sample().homed[1])
    assert 0.3 + took == pytest.approx(12.0 / 25.4, abs=0.2)  # 60 in/min
    assert axes.sample().actual[1] == pytest.approx(0.0, abs=0.00127)
    assert not axes.sample().moving
    # now that it knows where home is, the drive has its limits: 6 in
    assert lost.peers.plant.drives["Z"].values[0x607D, 1] == round(-152.4 / 0.00127)
    axes.splice(ramp(lost.clock.now() + 0.15, (axes.sample().demand[0], 0.0, 0.0), 60.0, 0.1))
    lost.run(1.0)
    assert axes.sample().fault == ""


def test_homing_refuses_without_power_while_moving_and_an_unknown_axis(lost: CanBench) -> None:
    axes = lost.machine.axes
    with pytest.raises(DriverError, match="drives are off"):
        axes.home("Z")
    axes.enable(True)
    with pytest.raises(DriverError, match="no axis 'B'"):
        axes.home("B")
    axes.splice(ramp(lost.clock.now() + 0.15, ZERO, 60.0, 0.6))
    lost.run(0.3)
    with pytest.raises(DriverError, match="standstill"):
        axes.home("Z")


def test_a_homing_that_is_stopped_leaves_the_axis_unhomed(lost: CanBench) -> None:
    axes = lost.machine.axes
    lost.peers.plant.servos[1].switch = 50.0
    axes.enable(True)
    axes.home("Z")
    lost.run(0.5)
    axes.stop(Stop.RAMP_HOLD)
    assert axes.sample().moving
    with pytest.raises(DriverError, match="homing"):
        axes.splice(ramp(lost.clock.now() + 0.2, ZERO, 60.0, 0.1))
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


def profiled() -> CanBench:
    return CanBench(can_machine(('mode = "pvt"', 'mode = "pp"')))


def test_profile_position_goes_where_the_queue_ends() -> None:
    bench = profiled()
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.5))
    bench.run(1.5)
    assert axes.sample().fault == ""
    assert axes.sample().actual[0] == pytest.approx(60.0 * 0.52, abs=0.003)
    bench.close()


def test_profile_position_brakes_where_the_queue_does() -> None:
    bench = profiled()
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.8))
    bench.run(0.5)
    axes.stop(Stop.RAMP_HOLD)
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
    bent = segments.p.copy()
    bent[1:, 1] = 1.0
    with pytest.raises(DriverError, match="single straight moves only"):
        axes.splice(segments._replace(p=bent))
    bench.close()


def test_csp_follows_where_the_machine_file_dares() -> None:
    bench = CanBench(can_machine(('mode = "pvt"', 'mode = "csp"\nexperimental = true')))
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.14, ZERO, 60.0, 0.3))
    bench.run(1.0)
    assert axes.sample().fault == ""
    assert axes.sample().actual[0] == pytest.approx(60.0 * 0.32, abs=0.003)
    bench.close()
