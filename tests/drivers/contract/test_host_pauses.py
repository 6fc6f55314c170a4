"""A busy computer looks away for a moment, again and again, while the slides go at full rapid."""

from __future__ import annotations

import random

import pytest

from tests.drivers.contract.rig import TICK, Rig

SPEED = 127.0  # mm/s, the rapid of the shipped lathes


@pytest.fixture
def powered(shipped: Rig) -> Rig:
    """As an executor gets it, drives on."""
    shipped.ports.axes.enable(True)
    shipped.run(0.2)
    return shipped


def look_away(rig: Rig, ticks: int) -> None:
    """The executor does; what of the driver is in another process goes on."""
    for _ in range(ticks):
        rig.alone(TICK)


@pytest.mark.parametrize("seed", range(4))
def test_short_host_pauses_at_full_rapid_cause_no_fault(powered: Rig, seed: int) -> None:
    rig, dice = powered, random.Random(seed)
    for way in (1.0, -1.0) * 3:
        end = rig.go(way * SPEED, 0.5)
        while abs(rig.world.place()[0] - end) > 0.01:
            look_away(rig, dice.randrange(6, 16))
            for _ in range(dice.randrange(1, 6)):
                rig.tick()
            assert rig.told == ""
        rig.run(0.1)
    assert rig.ports.axes.sample().enabled


def test_long_host_pause_is_not_mistaken_for_a_silent_device(powered: Rig) -> None:
    """What was asked before it has been answered meanwhile, or will be at once."""
    rig = powered
    if rig.watched:
        pytest.skip("whoever watches over the host has taken its silence for what it was: test_at_rest")
    for _ in range(12):
        for _ in range(7):
            rig.tick()
        look_away(rig, 300)
        rig.tick()
        assert rig.told == ""
    rig.run(20 * TICK)
    assert rig.told == ""
