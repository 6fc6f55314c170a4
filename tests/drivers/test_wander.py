"""A spindle whose speed swings: what its encoder counts is the area under the speed."""

from __future__ import annotations

import pytest

from drivers.simulated.simulated_machine import build_simulation
from drivers.wakeups import ManualClock
from tests.drivers.machines import CONFIG


def test_revolutions_follow_the_wandering_speed() -> None:
    clock = ManualClock()
    sim = build_simulation(CONFIG, clock)
    sim.machine.spindle_wander(0.02, 2.0)
    sim.ports.spindle.set_speed(600.0)
    clock.advance(2.0)
    area, before, began = 0.0, sim.machine.get_spindle_rpm(), sim.machine.spindle_turns()
    speeds = []
    for _ in range(4000):
        clock.advance(0.0005)
        speed = sim.machine.get_spindle_rpm()
        area += 0.5 * (before + speed) / 60.0 * 0.0005
        before = speed
        speeds.append(speed)
    assert sim.machine.spindle_turns() - began == pytest.approx(area, abs=1e-6)
    assert sim.machine.spindle_turns() - began == pytest.approx(20.0, abs=1e-6)  # a whole period
    assert (min(speeds), max(speeds)) == pytest.approx((588.0, 612.0), abs=1e-3)


def test_revolutions_do_not_depend_on_polling_interval() -> None:
    turns = []
    for step in (0.001, 0.25):
        clock = ManualClock()
        sim = build_simulation(CONFIG, clock)
        sim.machine.spindle_wander(0.05, 0.7)
        sim.ports.spindle.set_speed(-900.0)
        for _ in range(round(1.5 / step)):
            clock.advance(step)
            sim.ports.spindle.speed()
        turns.append(sim.machine.spindle_turns())
    # The ramp is a straight line under the swing: pieces of it differ by a hair.
    assert turns[0] == pytest.approx(turns[1], abs=0.01)


def test_spindle_without_wander_turns_uniformly() -> None:
    clock = ManualClock()
    sim = build_simulation(CONFIG, clock)
    sim.ports.spindle.set_speed(600.0)
    clock.advance(1.0)
    began = sim.machine.spindle_turns()
    clock.advance(0.37)
    assert sim.machine.spindle_turns() - began == pytest.approx(3.7, abs=1e-12)
