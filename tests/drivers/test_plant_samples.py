"""What the simulated machine samples: every millisecond of a motion, whoever looks when; little at rest."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.ports import FloatArray, MotionSegments, StopMode
from drivers.port_checks import SampleRingBuffer
from drivers.simulated.simulated_machine import Simulation
from drivers.simulators import plant
from tests.drivers.machines import play, ramp, simulation

ZERO = (0.0, 0.0, 0.0)
T, DEMAND, ACTUAL, LOAD, SPEED, TURNS, SPINDLE_LOAD, QUEUE = 0, 1, 4, 7, 10, 11, 12, 13


def taken(sim: Simulation) -> FloatArray:
    assert sim.ports.samples is not None
    return sim.ports.samples.take_samples()


def test_motion_is_sampled_on_the_model_grid_with_the_expected_error() -> None:
    sim, clock = simulation()
    taken(sim)
    sim.ports.axes.splice(ramp(0.03, ZERO, 120.0, 0.2))
    play(sim, clock, 0.4)
    rows = taken(sim)
    moving = rows[(rows[:, T] > 0.0305) & (rows[:, T] < 0.25)]
    assert np.diff(moving[:, T]) == pytest.approx(0.001, abs=1e-9)
    cruising = moving[(moving[:, T] > 0.15) & (moving[:, T] < 0.22)]
    assert cruising[:, DEMAND] - cruising[:, ACTUAL] == pytest.approx(0.0955, abs=0.002)  # 2(1 - ff)v/wn
    for row in rows:
        assert sim.ports.axes.demand_at(row[T])[0] == tuple(row[DEMAND:ACTUAL])
    assert rows[0, QUEUE] == pytest.approx(0.0, abs=0.001) or rows[0, QUEUE] > 0.2
    assert not rows[:, SPINDLE_LOAD].any()  # it stands
    assert abs(rows[:, LOAD]).max() <= 100.0


@pytest.mark.parametrize("tick", [0.0013, 0.01, 0.2])
def test_samples_do_not_depend_on_polling_interval(tick: float) -> None:
    def sampled(every: float) -> FloatArray:
        sim, clock = simulation()
        taken(sim)
        sim.ports.axes.splice(ramp(0.03, ZERO, 120.0, 0.2))
        sim.ports.spindle.set_speed(900.0)
        rows = []
        while clock.now() < 0.5:
            clock.advance(every)
            sim.ports.axes.sample()
            rows.append(taken(sim))
        found = np.concatenate(rows)
        assert len(found) == pytest.approx(clock.now() / 0.001, abs=1)
        return found[:489]

    np.testing.assert_allclose(sampled(tick), sampled(0.003), rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("act", ["nothing", "push", "jam", "new setpoints", "drive fault"])
def test_predicted_motion_matches_stepped_motion(act: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def sampled() -> FloatArray:
        sim, clock = simulation()
        taken(sim)
        sim.ports.spindle.set_speed(900.0)
        sim.ports.axes.splice(ramp(0.03, ZERO, 60.0, 0.4))
        play(sim, clock, 0.2)
        if act == "push":
            sim.machine.push("X", 0.01)
        elif act == "jam":
            sim.machine.jam("X")
        elif act == "drive fault":
            sim.machine.drive_fault("X")
        elif act == "new setpoints":
            t = clock.now() + 0.05
            p, v = sim.ports.axes.demand_at(t)
            sim.ports.axes.splice(braking(t, p, v))
        play(sim, clock, 0.5)
        return taken(sim)

    foreseen = sampled()
    monkeypatch.setattr(plant, "predict_motion", lambda *_: None)
    np.testing.assert_allclose(foreseen, sampled(), rtol=0.0, atol=1e-9)


def braking(t: float, p: tuple[float, ...], v: tuple[float, ...]) -> MotionSegments:
    """To rest in 0.1 s."""
    a = [-each / 0.1 for each in v]
    return MotionSegments(np.array([t]), np.array([0.1]), np.array([p]), np.array([v]), np.array([a]))


def test_spindle_is_sampled_at_rest_with_its_known_ripple() -> None:
    sim, clock = simulation()
    taken(sim)
    sim.machine.spindle_wander(0.02, 0.25)
    sim.ports.spindle.set_speed(1200.0)
    play(sim, clock, 3.0)
    taken(sim)
    play(sim, clock, 1.0)
    rows = taken(sim)
    t = rows[:, T]
    assert len(rows) == pytest.approx(1000, abs=1)
    assert rows[:, SPEED] == pytest.approx(1200.0 * (1.0 + 0.02 * np.sin(2 * math.pi * t / 0.25)), abs=1e-6)
    # its integral, in steps of the encoder's 4096 edges
    swing = 0.02 * 0.25 / (2 * math.pi) * (1.0 - np.cos(2 * math.pi * t / 0.25))
    turned = 20.0 * (t + swing)
    assert rows[:, TURNS] - rows[0, TURNS] == pytest.approx(turned - turned[0], abs=1.1 / 4096)


def test_machine_at_rest_is_sampled_ten_times_a_second() -> None:
    sim, clock = simulation()
    taken(sim)
    play(sim, clock, 10.0)
    rows = taken(sim)
    assert len(rows) == pytest.approx(100, abs=2)
    assert not rows[:, DEMAND:LOAD].any()


def test_demand_without_power_follows_the_axis_position() -> None:
    sim, clock = simulation()
    taken(sim)
    sim.ports.axes.splice(ramp(0.03, ZERO, 120.0, 0.2))
    play(sim, clock, 0.15)
    sim.ports.axes.stop(StopMode.OFF)
    taken(sim)
    play(sim, clock, 0.2)
    rows = taken(sim)
    np.testing.assert_array_equal(rows[1:, DEMAND:ACTUAL], rows[1:, ACTUAL:LOAD])
    assert rows[-1, ACTUAL] > rows[1, ACTUAL]  # it rolls on


def test_unread_samples_are_limited_to_the_last_eight_seconds() -> None:
    sim, clock = simulation()
    sim.ports.spindle.set_speed(600.0)
    play(sim, clock, 1.0)
    assert taken(sim).shape == (0, 14)
    play(sim, clock, 20.0)
    rows = taken(sim)
    assert len(rows) == 8192
    assert rows[-1, T] == pytest.approx(21.0, abs=0.002)
    assert np.diff(rows[:, T]) == pytest.approx(0.001, abs=1e-9)


def test_sample_log_returns_each_row_once_oldest_first() -> None:
    log = SampleRingBuffer(0, capacity=4)
    for n in range(6):
        log.append_row(float(n), 0.0, 0.0, 0.0, 0.0)
    assert log.pop_rows(3)[:, T].tolist() == [2.0, 3.0, 4.0]
    log.append_row(6.0, 0.0, 0.0, 0.0, 0.0)
    assert log.pop_rows()[:, T].tolist() == [5.0, 6.0]
    assert log.pop_rows().shape == (0, 5)


def test_rows_added_as_a_block_match_rows_added_one_by_one() -> None:
    for count in (1, 3, 4, 5, 9):
        single, block = SampleRingBuffer(0, capacity=4), SampleRingBuffer(0, capacity=4)
        rows = np.arange(5.0 * count).reshape(count, 5)
        for log in (single, block):
            log.append_row(-2.0, 0.0, 0.0, 0.0, 0.0)
            log.append_row(-1.0, 0.0, 0.0, 0.0, 0.0)
            log.pop_rows(1)
        for row in rows:
            single.append_row(*row)
        block.append_rows(rows)
        assert block.newest_time_s == single.newest_time_s
        np.testing.assert_array_equal(block.pop_rows(), single.pop_rows())


def test_spindle_load_consists_of_friction_acceleration_and_cutting() -> None:
    """By the speed up to 10 %, 70 % more while it speeds up, 30 % more while a slide feeds."""
    sim, clock = simulation()
    taken(sim)
    sim.ports.spindle.set_speed(900.0)
    play(sim, clock, 0.25)
    early = taken(sim)[-1]
    assert 70.0 < early[SPINDLE_LOAD] < 80.0
    play(sim, clock, 6.0)
    top = taken(sim)[-1]
    share = 10.0 * 900.0 / sim.machine._plant.config.spindle.max_rpm
    assert (top[SPEED], top[SPINDLE_LOAD]) == pytest.approx((900.0, share))
    sim.ports.axes.splice(ramp(clock.now() + 0.05, ZERO, 5.0, 0.5))
    play(sim, clock, 0.4)
    assert taken(sim)[-1][SPINDLE_LOAD] == pytest.approx(share + 30.0)
    play(sim, clock, 1.0)
    assert taken(sim)[-1][SPINDLE_LOAD] == pytest.approx(share)


def test_sample_rate_matches_the_model_grid() -> None:
    sim, _ = simulation()
    assert sim.ports.samples is not None
    assert sim.ports.samples.sample_rate_hz == pytest.approx(1000.0)  # every millisecond
