"""Hands that hold, start, turn the pot and reset at any time: the drives never get a jump."""

from __future__ import annotations

import random

import pytest

from core.executor.commands import Command, CycleStart, FeedHold, Reset
from drivers.simulators.canopen_axis_drive import AxisDrive
from tests.drivers.canopen.bench import can_machine
from tests.drivers.canopen.test_executor import BusRig

PART = "G90G94F300\nX0Z0\nG01F300\nX.2Z-1\nX.4\nZ-2\nX0Z0\nM30"
PRESSES: tuple[tuple[Command, ...], ...] = ((FeedHold(),), (CycleStart(),), (Reset(), CycleStart()), ())


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_random_operator_actions_never_exceed_axis_limits_in_the_drives(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    dice, seen = random.Random(seed), [0.0, 0.0]
    step = AxisDrive.advance

    def watched(drive: AxisDrive, dt: float) -> None:
        before, playing = drive.setpoint_velocity, drive.is_playing
        step(drive, dt)
        if playing and drive.is_playing:
            seen[0] = max(seen[0], abs(drive.setpoint_velocity))
            seen[1] = max(seen[1], abs(drive.setpoint_velocity - before))

    monkeypatch.setattr(AxisDrive, "advance", watched)
    rig = BusRig(can_machine(("two_hand_start = true", "two_hand_start = false")))
    rig.start(PART)
    for _ in range(12):
        rig.post(*dice.choice(PRESSES))
        rig.bench.peers.machine.set_feed_pot(dice.choice([0.0, 0.3, 1.0, 1.5]))
        rig.run(dice.choice([0.01, 0.05, 0.11, 0.14, 0.3]))
    assert rig.shot.alarms == ()
    assert seen[0] < 127.0 * 1.01
    # amax for a millisecond, twice where a corner adds its own
    assert seen[1] < 2 * 3.048
    rig.bench.close()
