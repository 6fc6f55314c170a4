"""What a driver that takes setpoints does with good and bad ones; and a planner with its blocks."""

from __future__ import annotations

import numpy as np
import pytest

from core.block_ports import LineOperation
from core.ports import DriverError, MotionSegments
from tests.coded import raises_code
from tests.drivers.contract.conftest import need
from tests.drivers.contract.moves import start
from tests.drivers.contract.rig import Rig


def test_spliced_path_continues_from_the_predicted_demand(rig: Rig) -> None:
    need(rig, "setpoints")
    rig.under_way()
    axes = rig.ports.axes
    at = axes.now() + axes.commit + 0.005
    p, v = axes.demand_at(at)
    assert v[0] == pytest.approx(120.0)
    stop = 120.0 / 3000.0
    zero = np.zeros((1, len(p)))
    speed, brake = zero.copy(), zero.copy()
    speed[0, 0], brake[0, 0] = 120.0, -3000.0
    axes.splice(MotionSegments(np.array([at]), np.array([stop]), np.array([p]), speed, brake))
    rig.until(lambda: not axes.sample().moving)
    assert axes.sample().actual[0] == pytest.approx(p[0] + 120.0 * stop / 2, abs=0.003)


def stopping(rig: Rig) -> MotionSegments:
    """A good stop from full speed, in 40 ms, and a moment of rest."""
    axes = rig.ports.axes
    at = axes.now() + axes.commit + 0.005
    p, v = (np.array(each) for each in axes.demand_at(at))
    still = np.zeros(len(p))
    return MotionSegments(
        np.array([at, at + 0.04]),
        np.array([0.04, 0.01]),
        np.vstack([p, p + v * 0.02]),
        np.vstack([v, still]),
        np.vstack([-v / 0.04, still]),
    )


def test_invalid_setpoints_are_rejected_and_the_queue_is_unchanged(rig: Rig) -> None:
    need(rig, "setpoints")
    end = rig.under_way()
    axes = rig.ports.axes
    horizon, good = axes.horizon(), stopping(rig)
    bad = {
        "too-early": good._replace(start_times_s=good.start_times_s - axes.commit - 0.05),
        "jump": good._replace(positions=good.positions + 1.0),
        "gap": good._replace(start_times_s=good.start_times_s + np.array([0.0, 0.01])),
        "moves-at-end": MotionSegments(*(part[:1] for part in good))._replace(
            accelerations=0.0 * good.accelerations[:1]
        ),
        "no-number": good._replace(accelerations=good.accelerations * np.nan),
        "backwards": good._replace(durations_s=-good.durations_s),
        "too-fast": good._replace(velocities=good.velocities * 1.2),
        "leaves-travel": good._replace(positions=good.positions + 500.0),
    }
    for reason, segments in bad.items():
        with pytest.raises(DriverError) as told:
            axes.splice(segments)
        # A driver host refuses values that are not numbers before its driver sees them.
        assert told.value.reason.replace("damaged", "no-number") == reason
        assert axes.horizon() == horizon
    rig.until(lambda: not axes.sample().moving)
    assert axes.sample().actual[0] == pytest.approx(end, abs=0.003)


def test_longest_plan_of_many_short_pieces_is_executed(powered: Rig) -> None:
    """Full queue: two seconds in pieces of a millisecond, more than any drive's queue holds."""
    need(powered, "setpoints")
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
    axes.splice(MotionSegments(np.asarray(t, dtype=np.float64), np.full(n, 0.001), p, v, a))
    powered.run(2.5)
    sample = axes.sample()
    assert sample.fault == ""
    assert sample.actual[0] == pytest.approx(20.0, abs=0.003)  # mean 10 mm/s for 2 s


def test_block_controller_rejects_setpoints(powered: Rig) -> None:
    need(powered, "blocks")
    with raises_code(DriverError, "driver") as told:
        powered.ports.axes.splice(start(powered.ports.axes, 60.0, 0.1))
    assert told.value.reason == "blocks-only"


def test_full_block_controller_rejects_blocks_and_runs_each_ticket_once(powered: Rig) -> None:
    need(powered, "blocks")
    sink = powered.blocks
    assert sink is not None
    taken: list[int] = []
    full = 0
    while len(taken) < 200:
        ticket = sink.submit_block(LineOperation(0.1 * (len(taken) + 1), 0.0, 50.0))
        if ticket is None:
            full += 1
            powered.tick()
        else:
            taken.append(ticket)
    assert full
    assert taken == list(range(taken[0], taken[0] + 200))
    done, places = [], []
    while sink.state().last_completed_ticket < taken[-1]:
        powered.tick()
        done.append(sink.state().last_completed_ticket)
        places.append(powered.world.place()[0])
    assert done == sorted(done)
    assert places == sorted(places)
    assert powered.world.place()[0] == pytest.approx(20.0, abs=1e-4)
    assert powered.told == ""
