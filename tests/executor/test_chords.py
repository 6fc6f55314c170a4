"""Curves in chords whose points are rounded to the control's step: no alarm, whatever is pressed."""

from __future__ import annotations

import math
import random

import pytest

from core.executor.commands import CycleStart, FeedHold, SetFeedOverride, SetSwitch
from core.executor.snapshot import MachineState
from tests.executor.rig import INCH, Rig

RADIUS = 0.5  # in
CHORDS = 1500


def half_circle(places: int) -> str:
    """A half circle in chords of about .001 in, the points written with so many places."""
    lines = ["G90G94F300", f"X0Z{RADIUS:.{places}f}", "F150"]
    for k in range(1, CHORDS + 1):
        angle = math.pi * k / CHORDS
        lines.append(f"X{RADIUS * math.sin(angle):.{places}f}Z{RADIUS * math.cos(angle):.{places}f}")
    return "\n".join([*lines, "M30"]) + "\n"


@pytest.mark.parametrize("places", [4, 5])
@pytest.mark.parametrize("seed", [1, 2])
def test_rounded_chords_run_through_holds_and_overrides_without_underrun(places: int, seed: int) -> None:
    chance = random.Random(seed)
    rig = Rig()
    rig.start(half_circle(places))
    for _ in range(12):
        rig.run(chance.uniform(0.05, 0.3))
        rig.post(
            chance.choice(
                [
                    FeedHold(),
                    SetFeedOverride(chance.uniform(0.2, 1.5)),
                    SetSwitch("single_block", False),
                    CycleStart(),
                ]
            )
        )
    rig.post(SetFeedOverride(1.0))
    rig.run(0.5)
    if rig.state is MachineState.HOLD:
        rig.post(CycleStart())
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=120)
    assert rig.shot.alarms == ()
    assert rig.shot.underruns == 0
    assert rig.shot.demand[:2] == pytest.approx((0.0, -RADIUS * INCH), abs=1e-6)
