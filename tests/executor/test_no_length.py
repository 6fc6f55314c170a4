"""Programs full of blocks that go nowhere, proved out: single block on and off anywhere."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.executor.commands import CycleStart, FeedHold, SetFeedOverride, SetSwitch
from core.executor.snapshot import MachineState
from core.interpreter.shared.job_setup import ToolOffset
from tests.executor.rig import INCH, Rig

TOOLS = {1: ToolOffset(), 2: ToolOffset()}
_PLACES = [(0.0, 0.0), (0.5, -0.2), (0.50005, -0.2), (0.5001, -0.20005), (0.7, -0.4)]  # in, some a step apart
_STOPPED = {MachineState.SINGLE_BLOCK_STOP, MachineState.HOLD, MachineState.PROGRAM_STOP}


@st.composite
def programs(draw: st.DrawFn) -> tuple[str, tuple[float, float]]:
    """Text, and where it ends (in): moves to where the tool stands, actions and dwells between them."""
    lines, at = ["G90G94F300", "G01F60", "G00"], (0.0, 0.0)
    for what in draw(st.lists(st.sampled_from(_LINES), min_size=2, max_size=14)):
        if what in {"move", "stay", "T1", "T2"}:
            at = draw(st.sampled_from(_PLACES)) if what == "move" else at
            word = draw(st.sampled_from(["", "", "G00", "G01"])) if what in {"move", "stay"} else f"{what}\n"
            lines.append(f"{word}X{at[0]:.5f}Z{at[1]:.5f}")
        elif what == "circle":
            radius = draw(st.sampled_from([0.0001, 0.03]))
            lines.append(f"G02X{at[0]:.5f}Z{at[1]:.5f}I{at[0] + radius:.5f}K{at[1]:.5f}\nG00")
        else:
            lines.append(what)
    return "\n".join([*lines, "M30\n"]), at


_LINES = [
    *["move"] * 4,
    *["stay"] * 5,
    "circle",
    "T1",
    "T2",
    "M08",
    "M09",
    "G04F.1",
    "M03S1000",
    "M05",
    "M00",
    "M01",
    "M26",
    "M27",
    "M12",
    "M05\nM19\nC0\nC10\nC10\nM05",
]


def prove_out(rig: Rig, chance: Random | None) -> int:
    """To the end by Cycle Start wherever it stops; with ``chance`` under switches, holds and overrides.

    After 300 s of them nobody disturbs any more: a hold at every tick would never let it end.
    """
    starts, last = 1, rig.clock.now()
    rig.post(CycleStart())
    while rig.state not in {MachineState.IDLE, MachineState.FAULT}:
        assert rig.clock.now() < 600.0, f"still {rig.state} in line {rig.shot.line}"
        if chance is not None and rig.clock.now() > 300.0:
            chance = None
            rig.post(SetFeedOverride(1.0))
        if rig.state in _STOPPED and rig.clock.now() - last > 0.31:
            last, starts = rig.clock.now(), starts + 1
            rig.post(CycleStart())
            continue
        draw = chance.random() if chance is not None else 1.0
        if chance is not None and draw < 0.08:
            rig.post(SetSwitch("single_block", chance.random() < 0.5))
        elif chance is not None and draw < 0.1:
            rig.post(FeedHold())
        elif chance is not None and draw < 0.2:
            rig.post(SetFeedOverride(chance.choice([0.0, 0.1, 1.0, 1.0, 1.0, 1.5])))
        rig.tick()
    return starts


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(programs(), st.randoms(use_true_random=False), st.booleans())
@pytest.mark.long
def test_program_with_zero_length_moves_ends_at_programmed_position(
    program: tuple[str, tuple[float, float]], chance: Random, single: bool
) -> None:
    text, end = program
    rig = Rig()
    rig.ready()
    rig.run(0.4)
    rig.load(text, TOOLS)
    rig.post(SetSwitch("single_block", single))
    prove_out(rig, chance)
    assert rig.shot.alarms == ()
    assert rig.shot.parts == 1
    assert rig.shot.demand[:2] == pytest.approx((end[0] * INCH, end[1] * INCH), abs=1e-6)


def test_zero_length_first_move_runs_after_single_block_is_switched_off() -> None:
    """Two starts in single block, single block off, Cycle Start: the rest joins a path of no length."""
    rig = Rig()
    rig.ready()
    rig.run(0.4)
    rig.load("G90G94F300\nX0Z0\nM03S1000\nX.5\nG01F20Z-.5\nX.7\nM30\n")
    rig.post(SetSwitch("single_block", True))
    for _ in range(2):
        rig.post(CycleStart())
        rig.until(MachineState.SINGLE_BLOCK_STOP)
        rig.run(0.4)
    rig.post(SetSwitch("single_block", False))
    rig.post(CycleStart())
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert rig.shot.alarms == ()
    assert rig.shot.demand[:2] == pytest.approx((0.7 * INCH, -0.5 * INCH), abs=1e-6)


@pytest.mark.parametrize("at", range(8))
def test_single_block_can_be_switched_at_every_block(at: int) -> None:
    """On for the blocks before ``at``, off from there, and the other way round."""
    text = "G90G94F300\nX0Z0\nX0Z0\nM08\nX.5\nX.5\nM03S500\nG01F60X.5Z-.1\nX.5Z-.1\nM30\n"
    for first in (True, False):
        rig = Rig()
        rig.ready()
        rig.run(0.4)
        rig.load(text)
        rig.post(SetSwitch("single_block", first))
        seen: list[int] = []

        def switch(_: object, rig: Rig = rig, seen: list[int] = seen, first: bool = first) -> None:
            if rig.shot.block not in seen[-1:]:
                seen.append(rig.shot.block)
                if len(seen) == at + 1:
                    rig.executor.post(SetSwitch("single_block", not first))

        rig.watch.append(switch)
        prove_out(rig, None)
        assert rig.shot.alarms == ()
        assert rig.shot.parts == 1
        assert rig.shot.demand[:2] == pytest.approx((0.5 * INCH, -0.1 * INCH), abs=1e-6)
