"""Cycles 202, 204 and 13 with M19 on a mill whose spindle is stopped at an angle."""

from __future__ import annotations

import pytest

from core.interpreter.shared.actions import ProgramEnd, ProgramStop, SpindlePositioning, SpindleRun
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ControlLimits
from tests.klartext.running import Ran, run

ABLE = ControlLimits(max_rpm=12000.0, can_orient_spindle=True)
BORE = (
    "CYCL DEF 202 BORING ~\n Q200=2 ~\n Q201=-8 ~\n Q206=99 ~\n Q211=0 ~\n Q208=0 ~\n Q203=0 ~\n Q204=9 ~\n"
    " Q214={} ~\n Q336=+90\nL X+10 Y+20 R0 FMAX M99\n"
)
BACK = {
    **{"Q200": 2.0, "Q249": 5.0, "Q250": 20.0, "Q251": 3.5, "Q252": 15.0, "Q253": 750.0, "Q254": 200.0},
    **{"Q255": 0.0, "Q203": 0.0, "Q204": 30.0, "Q214": 1.0, "Q336": 0.0},
}
START = "L Z+50 R0 FMAX M3\n"


def on(text: str) -> Ran:
    return run(START + text, limits=ABLE)


def back(**changes: float) -> Ran:
    lines = "".join(f" ~\n {name}={value:+g}" for name, value in {**BACK, **changes}.items())
    return on(f"CYCL DEF 204 BACK BORING{lines}\nL X+10 Y+20 R0 FMAX M99\n")


def told(block: Block) -> object:
    match block.action:
        case SpindlePositioning(angle=angle):
            return f"held {angle:g}"
        case SpindleRun():
            return "turns"
        case ProgramStop():
            return "stop"
        case ProgramEnd():
            return "end"
        case _:
            assert block.swivel is not None
            x, y, z = block.swivel.end
            return (round(x, 6), round(y, 6), round(z, 6))


@pytest.mark.parametrize(("direction", "x", "y"), [(1, 9.8, 20), (2, 10, 19.8), (3, 10.2, 20), (4, 10, 20.2)])
def test_boring_orients_spindle_and_retracts_from_wall(direction: int, x: float, y: float) -> None:
    ran = on(BORE.format(direction))
    assert ran.errors == []
    assert ran.warned == []
    assert [told(each) for each in ran.blocks][-7:] == [
        (10.0, 20.0, -8.0), "held 90", (x, y, -8.0), (x, y, 9.0), (10.0, 20.0, 9.0), "turns", "end",
    ]  # fmt: skip


@pytest.mark.parametrize(("direction", "x", "y"), [(1, 6.5, 20), (2, 10, 16.5), (3, 13.5, 20), (4, 10, 23.5)])
def test_back_boring_enters_and_leaves_on_same_side(direction: int, x: float, y: float) -> None:
    """Tip at 0 - 20 - 15 - 2 below the part, at 0 - 20 + 5 - 15 at the counterbore's end."""
    ran = back(Q214=direction)
    assert ran.errors == []
    ways = [told(each) for each in ran.blocks]
    first = ways.index("held 0")
    assert ways[first:] == [
        "held 0", (x, y, 2.0), (x, y, -37.0), (10.0, 20.0, -37.0), "turns", (10.0, 20.0, -30.0),
        (10.0, 20.0, -37.0), "held 0", (x, y, -37.0), (x, y, 2.0), (x, y, 30.0), (10.0, 20.0, 30.0), "turns",
        "end",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "names"),
    [
        ({"Q214": 0.0}, "Q214"),
        ({"Q214": 1.5}, "Q214"),
        ({"Q249": -5.0}, "Q249"),
        ({"Q254": 99999.0}, "Q254"),
        ({"Q336": 400.0}, "Q336"),
    ],
)
def test_invalid_back_boring_is_rejected(changes: dict[str, float], names: str) -> None:
    (error,) = back(**changes).errors
    assert names in error.message


def test_back_boring_of_zero_depth_only_moves_to_clearance() -> None:
    assert [told(each) for each in back(Q249=0.0).blocks][-2:] == [(10.0, 20.0, 2.0), "end"]


def test_cycle_13_sets_angle_of_m19_until_next_cycle_13() -> None:
    told_at = "CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE Q1\n"
    ran = on(f"M19\nQ1 = 45\n{told_at}L X+5 FMAX M19\nL X+6 FMAX M19\nM3\n")
    assert ran.errors == []
    held = [each.action.angle for each in ran.blocks if isinstance(each.action, SpindlePositioning)]
    assert held == [0.0, 45.0, 45.0]
    assert ran.state.modal.oriented is None


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("M19\n", "cannot be oriented"),
        ("CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 90\nM19\n", "cannot be oriented"),
    ],
)
def test_m19_without_oriented_spindle_names_machine_file_key(text: str, part: str) -> None:
    (error,) = run(START + text).errors
    assert part in error.message
    assert "oriented = true under [spindle]" in error.hint


def test_cycle_13_needs_its_angle() -> None:
    (error,) = on("CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1\n").errors
    assert "No angle is programmed in cycle 13" in error.message
