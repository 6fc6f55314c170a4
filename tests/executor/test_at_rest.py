"""A machine at rest: everything is looked at in every tick, and shown as soon as anything happens."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from core.executor.commands import EnableDrives, Jog, SetSwitch
from core.executor.snapshot import State
from tests.executor.rig import Rig


def rested(*, powered: bool = True) -> Rig:
    """Nothing has happened for two seconds."""
    rig = Rig()
    if powered:
        rig.post(EnableDrives())
    rig.run(2.0)
    return rig


def shown(rig: Rig, ticks: int) -> int:
    """In how many ticks a snapshot is made."""
    made = {id(rig.shot): rig.shot}
    before = len(made)
    for _ in range(ticks):
        rig.tick()
        made[id(rig.shot)] = rig.shot
    return len(made) - before


@pytest.mark.parametrize("powered", [True, False])
def test_it_is_shown_twenty_times_a_second_once_it_has_rested_for_one(powered: bool) -> None:
    rig = Rig()
    if powered:
        rig.post(EnableDrives())
    assert shown(rig, 90) == 90
    rig.run(1.0)
    assert shown(rig, 100) == 20
    assert rig.shot.t > rig.clock.now() - 0.051
    assert rig.executor.ticks > 290  # the watchdog sees each of them


@pytest.mark.parametrize(
    ("happens", "seen"),
    [
        (lambda rig: rig.sim.machine.press_estop(), lambda rig: rig.state is State.ESTOP),
        (lambda rig: rig.sim.machine.drive_fault("X"), lambda rig: rig.state is State.FAULT),
        (lambda rig: rig.sim.machine.set_input("TB2-5", True), lambda rig: "TB2-5" in rig.shot.inputs),
        (lambda rig: rig.sim.machine.set_feed_pot(0.5), lambda rig: rig.shot.feed_override == 0.5),
        (lambda rig: rig.sim.machine.push("X", 0.5), lambda rig: abs(rig.shot.following_error[0]) > 0.01),
        (lambda rig: rig.executor.post(SetSwitch("single_block", True)), lambda rig: rig.shot.single_block),
        (lambda rig: rig.executor.post(Jog("X", 5.0, 0.2)), lambda rig: rig.state is State.JOG),
    ],
)
@pytest.mark.parametrize("phase", range(5))
def test_whatever_happens_is_shown_by_the_tick_that_sees_it(
    phase: int, happens: Callable[[Rig], None], seen: Callable[[Rig], bool]
) -> None:
    rig = rested()
    for _ in range(phase):
        rig.tick()
    happens(rig)
    rig.tick()
    assert seen(rig)
    assert rig.shot.t == rig.clock.now()


def test_what_goes_on_is_shown_every_time() -> None:
    rig = rested()
    rig.post(Jog("X", 5.0, 0.5))
    assert shown(rig, 30) == 30


def test_a_late_tick_at_rest_is_still_told() -> None:
    rig = rested()
    late: list[float] = []
    rig.executor._tell = lambda tick: late.append(tick.late)
    rig.tick(0.07)
    rig.run(0.1)
    assert max(late) == pytest.approx(0.06)
