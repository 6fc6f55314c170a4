"""Wear of the simulated machine: a loose gib, a slipping belt, a bad encoder, each as its formula says."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from core.ports import FloatArray
from drivers.simulated.simulated_machine import Simulation
from drivers.simulated.simulated_table import PlannedFault
from drivers.wakeups import ManualClock
from tests.drivers.machines import CONFIG, play, ramp, simulation

WN = 2.0 * math.pi * 40.0
COUNT = 0.00127
T, DEMAND, ACTUAL, SPEED, TURNS = 0, 1, 4, 10, 11


def moved(sim: Simulation, clock: ManualClock, speed: float, seconds: float) -> FloatArray:
    """X at an even speed; the samples of the last 60 % of the way."""
    assert sim.ports.samples is not None
    sim.ports.samples.take_samples()
    begin = sim.ports.axes.now() + 0.03
    sim.ports.axes.splice(ramp(begin, sim.ports.axes.demand_at(begin)[0], speed, seconds))
    play(sim, clock, seconds + 0.3)
    rows = sim.ports.samples.take_samples()
    ramped = abs(speed) / 3048.0 + 0.001
    first, last = begin + ramped + 0.4 * seconds, begin + ramped + seconds - 0.01
    return rows[(rows[:, T] > first) & (rows[:, T] < last)]


def error(rows: FloatArray) -> FloatArray:
    return np.asarray(rows[:, DEMAND] - rows[:, ACTUAL])


def trail(speed: float) -> float:
    """Of a healthy slide: 2(1 - ff)v/wn."""
    return 0.2 * speed / WN


def test_loose_gib_causes_backlash_at_a_reversal() -> None:
    sim, clock = simulation()
    sim.machine.loose_gib("X", 0.04)
    there = error(moved(sim, clock, 20.0, 0.5))
    back = error(moved(sim, clock, -20.0, 0.5))
    assert there == pytest.approx(trail(20.0) + 0.02, abs=COUNT)
    assert back == pytest.approx(-trail(20.0) - 0.02, abs=COUNT)
    assert there.mean() - back.mean() - 2 * trail(20.0) == pytest.approx(0.04, abs=COUNT)


def test_loose_gib_causes_stick_slip_at_creep_speed() -> None:
    sim, clock = simulation()
    sim.machine.loose_gib("X", 0.04)
    creeping = error(moved(sim, clock, 0.5, 2.0))
    assert creeping.max() - creeping.min() == pytest.approx(0.01, abs=1.5 * COUNT)  # a quarter of the play
    leaps = np.flatnonzero(np.diff(creeping) < -0.007)
    assert np.diff(leaps) == pytest.approx(20, abs=3)  # ms: .01 mm at .5 mm/s


def test_adjusted_gib_is_normal_again() -> None:
    sim, clock = simulation()
    sim.machine.loose_gib("X", 0.04)
    moved(sim, clock, 20.0, 0.5)
    sim.machine.loose_gib("X", 0.0)
    assert error(moved(sim, clock, 20.0, 0.5)) == pytest.approx(trail(20.0), abs=COUNT)


def test_eccentric_encoder_causes_the_expected_sine_error() -> None:
    """Through the loop of the drive: |s(s + 2wn)|/|s + wn|² of the encoder's own error, s = 2πi v/turn."""
    sim, clock = simulation()
    sim.machine.encoder_ripple("X", 0.05, 5.0)
    rows = moved(sim, clock, 60.0, 0.9)
    w = 2.0 * math.pi * 60.0 / 5.0
    wanted = 0.05 * w * math.hypot(w, 2.0 * WN) / (w * w + WN * WN)
    found = error(rows) - error(rows).mean()
    assert abs(found).max() == pytest.approx(wanted, rel=0.08)
    waves = np.abs(np.fft.rfft(found * np.hanning(len(found))))
    heard = np.fft.rfftfreq(len(found), 0.001)[waves.argmax()]
    assert heard == pytest.approx(60.0 / 5.0, abs=2.0)


def test_counts_missed_once_a_revolution_cause_a_step_of_that_size() -> None:
    sim, clock = simulation()
    sim.machine.encoder_missed("X", 0.03, 5.0)
    rows = moved(sim, clock, 50.0, 1.0)
    off = error(rows) - trail(50.0)
    steps = np.flatnonzero(np.diff(error(rows)) > 0.02)
    assert np.diff(steps) == pytest.approx(100, abs=2)  # ms: 5 mm at 50 mm/s
    assert off.max() == pytest.approx(0.03, abs=0.004)
    assert np.median(off) == pytest.approx(0.0, abs=2 * COUNT)  # the drive goes by it: the slide is wrong
    lost = sim.machine.get_true_positions()[0] - sim.ports.axes.sample().actual[0]
    assert lost == pytest.approx(0.03 * math.floor(sim.machine.get_true_positions()[0] / 5.0), abs=COUNT)


def test_belt_slips_only_in_a_cut_and_revolutions_match_the_speed() -> None:
    sim, clock = simulation()
    sim.machine.belt_slip(0.2)
    sim.ports.spindle.set_speed(1200.0)
    play(sim, clock, 2.0)
    assert sim.ports.spindle.speed() == pytest.approx(1200.0)
    rows = moved(sim, clock, 10.0, 2.0)
    assert rows[:, SPEED].max() == pytest.approx(1200.0, rel=1e-3)
    assert rows[:, SPEED].min() == pytest.approx(960.0, rel=1e-3)
    area = np.concatenate(([0.0], np.cumsum(0.5 * (rows[1:, SPEED] + rows[:-1, SPEED]) / 60.0 * 0.001)))
    assert rows[:, TURNS] - rows[0, TURNS] == pytest.approx(area, abs=0.003)
    play(sim, clock, 0.5)
    assert sim.ports.spindle.speed() == pytest.approx(1200.0)
    rapid = moved(sim, clock, 100.0, 0.3)
    assert rapid[:, SPEED] == pytest.approx(1200.0)


def test_planned_encoder_fault_ends_after_its_duration() -> None:
    fault = PlannedFault(0.0, "encoder_missed", "X", 0.03, 1.0, turn=2.0)
    sim, clock = simulation(dataclasses.replace(CONFIG, planned_faults=(fault,)))
    rows = moved(sim, clock, 50.0, 0.5)
    assert np.diff(np.flatnonzero(np.diff(error(rows)) > 0.02)) == pytest.approx(40, abs=2)
    play(sim, clock, 1.0)
    assert error(moved(sim, clock, 50.0, 0.5)) == pytest.approx(trail(50.0), abs=2 * COUNT)
