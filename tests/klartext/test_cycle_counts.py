"""Counts and selections of cycles: whole numbers, and limits before the points are generated."""

from __future__ import annotations

import pytest

from core.interpreter.shared.actions import CoolantSwitch
from tests.klartext.test_klartext_cycles import COMMON, DRILL, cycle, ran_of

INCORRECT = "Input value incorrect"
CENTRE = f"{COMMON}CYCL DEF 240 CENTRE ~\n Q343=+0 ~\n Q201=-1\n"
CIRCLE = "CYCL DEF 220 POLAR ~\n Q216=+50 ~\n Q217=+40 ~\n Q244=+20 ~\n Q245=+0 ~\n Q246=+360 ~\n Q247=+0 ~\n"
ROWS = "CYCL DEF 221 ROWS ~\n Q225=+5 ~\n Q226=+6 ~\n Q237=+.01 ~\n Q238=+.01 ~\n Q224=+0 ~\n"


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (f"{CENTRE}{ROWS} Q242=+101 ~\n Q243=+100", "10100"),
        (f"{CENTRE}{ROWS} Q242=+10000 ~\n Q243=+10000", "100000000"),
        (f"{CENTRE}{ROWS} Q242=+0 ~\n Q243=+1", "Q242=0"),
        (f"{CENTRE}{ROWS} Q242=+2.5 ~\n Q243=+1", "Q242=2.5"),
        (f"{CENTRE}{CIRCLE} Q241=+4.9", "Q241=4.9"),
        (f"{DRILL}PATTERN DEF PAT1 (X+0 Y+0 DX+.01 DY+.01 NUMX10000 NUMY10000)\nCYCL CALL PAT", "100000000"),
        (f"{DRILL}PATTERN DEF FRAME1 (X+0 Y+0 DX+.01 DY+.01 NUMX5000 NUMY100)\nCYCL CALL PAT", "10196"),
        (cycle(241, q201=-5, q253=9, q429=8.5), "Q429=8.5"),
        (cycle(241, q201=-5, q253=9, q429=0.9), "Q429=0.9"),
        (cycle(241, q201=-5, q253=9, q426=3.2), "Q426=3.2"),
    ],
)
def test_invalid_count_or_selection_is_rejected(text: str, names: str) -> None:
    """A frame of 5000 by 100 points has 2 · (5000 + 100) - 4 = 10196 points."""
    ran = ran_of(text)
    assert ran.codes[:1] == [INCORRECT]
    assert names in ran.errors[0].message


def test_smaller_grid_is_accepted() -> None:
    ran = ran_of(f"{CENTRE}{ROWS} Q242=+40 ~\n Q243=+2")
    assert ran.codes == []


def test_coolant_is_switched_by_a_whole_number() -> None:
    ran = ran_of(cycle(241, q201=-5, q253=9, q429=8))
    assert ran.codes == []
    assert CoolantSwitch(on=True) in [block.action for block in ran.blocks]
