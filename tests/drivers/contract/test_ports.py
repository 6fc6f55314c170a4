"""What every driver does and refuses, whatever wire is behind it."""

from __future__ import annotations

import numpy as np
import pytest

from core.ports import DriverError, Segments, Stop
from tests.drivers.contract.moves import start
from tests.drivers.contract.rigs import Rig

BRAKING = 120.0**2 / (2 * 3048.0)  # mm from 120 mm/s


def test_a_move_arrives_where_it_was_told(powered: Rig) -> None:
    powered.ports.axes.splice(start(powered, 120.0, 0.3))
    powered.run(0.3)
    powered.until(lambda: not powered.ports.axes.sample().moving)
    sample = powered.ports.axes.sample()
    assert sample.actual[0] == pytest.approx(120.0 * 0.34, abs=0.003)
    assert sample.fault == ""
    assert sample.following_error[0] == pytest.approx(0.0, abs=0.003)


def test_a_splice_goes_on_from_what_demand_at_foretells(moving: Rig) -> None:
    axes = moving.ports.axes
    at = axes.now() + axes.commit + 0.005
    p, v = axes.demand_at(at)
    assert v[0] == pytest.approx(120.0)
    stop = 120.0 / 3000.0
    zero = np.zeros((1, len(p)))
    speed, brake = zero.copy(), zero.copy()
    speed[0, 0], brake[0, 0] = 120.0, -3000.0
    axes.splice(Segments(np.array([at]), np.array([stop]), np.array([p]), speed, brake))
    moving.until(lambda: not axes.sample().moving)
    assert axes.sample().actual[0] == pytest.approx(p[0] + 120.0 * stop / 2, abs=0.003)


@pytest.mark.parametrize(
    ("what", "expected"),
    [
        ("early", "too early"),
        ("jump", "jump"),
        ("gap", "gap"),
        ("running", "do not end at rest"),
        ("nan", "no number"),
        ("backwards", "backwards"),
        ("fast", "faster than"),
        ("outside", "leave"),
    ],
)
def test_bad_setpoints_are_refused_and_the_old_ones_stay(moving: Rig, what: str, expected: str) -> None:
    axes = moving.ports.axes
    at = axes.now() + axes.commit + 0.005
    horizon = axes.horizon()
    p, v = axes.demand_at(at)
    n = len(p)
    good = Segments(
        np.array([at, at + 0.04]),
        np.array([0.04, 0.01]),
        np.vstack([p, p]),
        np.vstack([v, np.zeros(n)]),
        np.zeros((2, n)),
    )
    good.a[0] = -np.array(v) / 0.04
    good.p[1] = np.array(p) + np.array(v) * 0.02
    bad = {
        "early": good._replace(t=good.t - axes.commit - 0.05),
        "jump": good._replace(p=good.p + 1.0),
        "gap": good._replace(t=good.t + np.array([0.0, 0.01])),
        "running": Segments(*(part[:1] for part in good))._replace(a=np.zeros((1, n))),
        "nan": good._replace(a=good.a * np.nan),
        "backwards": good._replace(dt=-good.dt),
        "fast": good._replace(v=good.v * 1.2),
        "outside": good._replace(p=good.p + 500.0),
    }[what]
    with pytest.raises(DriverError, match=expected):
        axes.splice(bad)
    assert axes.horizon() == horizon
    moving.until(lambda: not axes.sample().moving)
    assert axes.sample().actual[0] == pytest.approx(120.0 * 0.74, abs=0.003)


def test_without_power_nothing_is_taken(rig: Rig) -> None:
    with pytest.raises(DriverError, match="drives are off"):
        rig.ports.axes.splice(start(rig, 60.0, 0.1))
    assert not rig.ports.axes.sample().enabled


@pytest.mark.parametrize("stall", [0.5, 5.0])
def test_a_stalled_host_leaves_slides_that_stop_at_the_end_of_their_queue(moving: Rig, stall: float) -> None:
    moving.run(stall)
    moving.until(lambda: not moving.ports.axes.sample().moving)
    sample = moving.ports.axes.sample()
    assert sample.fault == ""
    assert sample.actual[0] == pytest.approx(120.0 * 0.74, abs=0.003)


def test_hold_within_its_bound(moving: Rig) -> None:
    asked = moving.clock.now()
    moving.ports.axes.stop(Stop.RAMP_HOLD)
    moving.until(lambda: not moving.ports.axes.sample().moving)
    assert moving.clock.now() - asked < moving.hold
    assert moving.ports.axes.sample().enabled


@pytest.mark.parametrize("how", [Stop.RAMP_OFF, Stop.OFF])
def test_stops_that_take_the_power(moving: Rig, how: Stop) -> None:
    before = moving.sim.true_position()[0]
    moving.ports.axes.stop(how)
    moving.run(0.4)
    sample = moving.ports.axes.sample()
    assert not sample.enabled
    assert not sample.moving
    # friction alone brakes half as hard; a round of the bus is 1.2 mm
    assert moving.sim.true_position()[0] - before < (2.0 if how is Stop.OFF else 1.0) * BRAKING + 1.5


def test_the_longest_plan_of_many_short_pieces(powered: Rig) -> None:
    """Two seconds in pieces of a millisecond: more than any drive's queue holds."""
    axes = powered.ports.axes
    at = axes.now() + axes.commit + 0.005
    rest, _ = axes.demand_at(1e9)
    n = 2000
    t = at + 0.001 * np.arange(n)
    v, a = np.zeros((n, len(rest))), np.zeros((n, len(rest)))
    speed = 20.0 * np.square(np.sin(np.linspace(0.0, np.pi, n + 1)))
    v[:, 0], a[:, 0] = speed[:-1], np.diff(speed) / 0.001
    p = np.tile(np.array(rest), (n, 1))
    p[1:, 0] += np.cumsum((speed[:-1] + speed[1:]) / 2 * 0.001)[:-1]
    axes.splice(Segments(np.asarray(t, dtype=np.float64), np.full(n, 0.001), p, v, a))
    powered.run(2.5)
    sample = axes.sample()
    assert sample.fault == ""
    assert sample.actual[0] == pytest.approx(20.0, abs=0.003)  # mean 10 mm/s for 2 s


def test_spindle_turns_and_stops(rig: Rig) -> None:
    spindle = rig.ports.spindle
    spindle.run(-1200.0)
    rig.until(lambda: abs(spindle.speed() + 1200.0) < 5.0)
    assert rig.sim.spindle_rpm() == pytest.approx(-1200.0, abs=1.0)
    spindle.run(0.0)
    rig.until(lambda: abs(spindle.speed()) < 1.0)
    spindle.run(600.0)
    rig.until(lambda: abs(spindle.speed() - 600.0) < 5.0)
    spindle.coast()
    rig.until(lambda: abs(spindle.speed()) < 1.0)
    assert spindle.fault() == ""


def test_outputs_go_out_and_fall_safe(rig: Rig) -> None:
    io = rig.ports.io
    io.write("coolant", True)
    io.write("collet", True)
    rig.run(0.1)
    assert io.outputs()["coolant"]
    io.safe()
    rig.run(0.1)
    assert not io.outputs()["coolant"]
    assert io.outputs()["collet"]  # "keep"
    with pytest.raises(DriverError, match="output 'laser' is not in the machine file"):
        io.write("laser", True)


def test_inputs_and_station_are_seen(rig: Rig) -> None:
    rig.sim.set_input("guard", True)
    rig.sim.press_hold()
    rig.sim.set_feed_pot(0.5)
    rig.sim.set_spindle_auto(False)
    rig.run(0.05)
    assert rig.ports.io.inputs()["guard"]
    station = rig.ports.station.snapshot()
    assert station.hold
    assert not station.start
    assert station.feed_pot == pytest.approx(0.5, abs=0.001)
    assert not station.spindle_auto
    assert station.age < 0.1
    rig.sim.press_start()
    rig.run(0.05)
    assert rig.ports.station.snapshot().start


def test_estop_takes_power_and_gives_nothing_back(moving: Rig) -> None:
    moving.ports.spindle.run(500.0)
    moving.run(0.3)
    assert moving.sim.spindle_rpm() > 50.0
    moving.sim.press_estop()
    moving.run(0.5)
    sample = moving.ports.axes.sample()
    assert moving.ports.station.snapshot().estop
    assert not sample.enabled
    assert not sample.moving
    with pytest.raises(DriverError, match="E-stop"):
        moving.ports.axes.enable(True)
    moving.sim.release_estop()
    moving.run(2.0)  # nobody has taken the spindle's command back
    assert not moving.ports.axes.sample().enabled
    assert moving.sim.spindle_rpm() == pytest.approx(0.0, abs=1.0)
    moving.ports.axes.enable(True)
    moving.run(0.3)
    assert moving.ports.axes.sample().enabled
    assert not moving.ports.axes.sample().moving
