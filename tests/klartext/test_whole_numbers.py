"""Whole numbers: codes and counts of cycles, points of patterns, tools, table rows and system values."""

from __future__ import annotations

import pytest

from core.interpreter.shared.actions import CoolantSwitch
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import ToolOffset
from tests.klartext import test_circular_slots, test_contour_cycles, test_pocket_cycles
from tests.klartext.running import Ran, run

WRONG = "Input value incorrect"
START = "TOOL DEF 5 L+0 R+4\nTOOL CALL 5 Z S1000 F500\nL X+0 Y+0 Z+50 R0 FMAX M3\n"
HOLE = "CYCL DEF {} HOLE ~\n Q200=2 ~\n Q201=-5 ~\n Q202=5 ~\n Q203=+0 ~\n Q204=50 ~\n Q206=100"
CIRCLE = "CYCL DEF 220 POLAR ~\n Q216=0 ~\n Q217=0 ~\n Q244=20 ~\n Q245=0 ~\n Q246=360 ~\n Q241={}"
ROWS = "CYCL DEF 221 ROWS ~\n Q225=0 ~\n Q226=0 ~\n Q237=1 ~\n Q238=1 ~\n Q242={} ~\n Q243={}"


def _run(text: str) -> Ran:
    return run(text, tool=START)


def _drill(text: str, number: int = 200) -> Ran:
    return _run(f"{HOLE.format(number)}\n{text}")


def _bottoms(ran: Ran) -> list[tuple[object, object]]:
    assert ran.codes == []
    return [
        (pytest.approx(block.swivel.end[0]), pytest.approx(block.swivel.end[1]))
        for block in ran.blocks
        if block.kind is BlockKind.FEED and block.swivel and block.swivel.end[2] < 0.0
    ]


def _error(ran: Ran) -> str:
    assert ran.codes == [WRONG]
    return ran.errors[0].message


@pytest.mark.parametrize(
    ("number", "parameter"),
    [
        (203, "Q213=2.5"),
        (240, "Q343=0.9"),
        (240, "Q343=2"),
        (241, "Q426=3.9"),
        (241, "Q429=8.5"),
        (241, "Q429=0.9"),
        (208, "Q351=0.5"),
        (208, "Q351=2"),
    ],
)
def test_invalid_code_of_a_hole_is_rejected(number: int, parameter: str) -> None:
    """Q429=+8.5 once switched the coolant on, and Q343=0.9 selected the depth."""
    rest = " ~\n Q253=500 ~\n Q208=300 ~\n Q334=0.5 ~\n Q335=12"
    ran = _run(f"{HOLE.format(number)}{rest} ~\n {parameter}\nCYCL CALL")
    assert parameter.split("=", maxsplit=1)[0] in _error(ran)
    assert not any(isinstance(block.action, CoolantSwitch) for block in ran.blocks)


@pytest.mark.parametrize("name", ["q215", "q351", "q366", "q367"])
@pytest.mark.parametrize("number", [251, 253])
def test_invalid_code_of_a_pocket_is_rejected(number: int, name: str) -> None:
    """Codes are whole numbers; Q366=0.9 once plunged straight down. Only Q367 has codes above 2."""
    for value in (0.9, 5.0, -2.0):
        assert name.upper() in _error(test_pocket_cycles.milled(number, **{name: value}))


@pytest.mark.parametrize(
    ("name", "value"),
    [("q215", 0.5), ("q215", 3.0), ("q366", 1.5), ("q367", 2.5), ("q377", 1.5), ("q377", 0.0), ("q351", 0.5)],
)
def test_invalid_code_of_a_circular_slot_is_rejected(name: str, value: float) -> None:
    assert name.upper() in _error(test_circular_slots.milled(254, **{name: value}))


@pytest.mark.parametrize(
    ("cycle", "name", "value"), [(22, "q9", 0.5), (22, "q9", 2.0), (25, "q15", 0.5), (21, "q13", 5.5)]
)
def test_invalid_code_of_a_contour_cycle_is_rejected(cycle: int, name: str, value: float) -> None:
    """Q13 is the number of the tool that clears the area later."""
    assert name.upper() in _error(test_contour_cycles.milled(cycle, **{name: value}))


@pytest.mark.parametrize(
    "pattern",
    [CIRCLE.format(value) for value in ("4.9", "0", "10001")]
    + [ROWS.format(*values) for values in (("2.5", 2), (2, "2.5"), (500, 500), (10_000, 10_000), (101, 100))]
    + [CIRCLE.format(4) + f" ~\n Q301={value}" for value in ("0.5", "2")],
)
def test_invalid_count_of_a_pattern_cycle_is_rejected(pattern: str) -> None:
    """The maximum is 10 000 points in all; 500 x 500 and 10 000 x 10 000 were once made."""
    ran = _drill(pattern)
    assert _error(ran)
    assert not any(block.line > 7 and block.moves for block in ran.blocks)


def test_pattern_cycle_has_as_many_points_as_programmed() -> None:
    """Counts may have the rounding error of a formula: 0.1 * 30 is 3.0000000000000004."""
    drilled = _bottoms(_drill(f"Q1 = 0.1 * 30\n{ROWS.format('+Q1', 2)}"))
    assert drilled == [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)]


@pytest.mark.parametrize(
    "pattern",
    [
        "PAT1 (X+0 Y+0 DX+1 DY+1 NUMX+10000 NUMY+10000 ROT+0 ROTX+0 ROTY+0)",
        "PAT1 (X+0 Y+0 DX+1 DY+1 NUMX+101 NUMY+100 ROT+0 ROTX+0 ROTY+0)",
        "FRAME1 (X+0 Y+0 DX+1 DY+1 NUMX+5000 NUMY+5000 ROT+0 ROTX+0 ROTY+0)",
        "ROW1 (X+0 Y+0 D+1 NUM+9000 ROT+0) ROW2 (X+0 Y+9 D+1 NUM+1001 ROT+0)",
    ],
)
def test_pattern_with_too_many_points_is_rejected(pattern: str) -> None:
    assert "too many points" in _error(_drill(f"PATTERN DEF {pattern}"))


def test_border_of_a_frame_is_drilled_in_alternating_directions() -> None:
    """3 x 3 points without the one in the middle, and a frame of one column."""
    frame = "PATTERN DEF FRAME1 (X+0 Y+0 DX+1 DY+1 NUMX{:+} NUMY{:+})\nCYCL CALL PAT FMAX"
    square = [(0, 0), (1, 0), (2, 0), (2, 1), (0, 1), (0, 2), (1, 2), (2, 2)]
    assert _bottoms(_drill(frame.format(3, 3))) == square
    assert _bottoms(_drill(frame.format(1, 3))) == [(0, 0), (0, 1), (0, 2)]


def test_largest_frame_that_fits_is_accepted() -> None:
    """2 * (2500 + 2502) - 4 = 10 000 points."""
    ran = _run(f"{HOLE.format(200)}\nPATTERN DEF FRAME1 (X+0 Y+0 DX+1 DY+1 NUMX+2500 NUMY+2502)")
    assert ran.codes == []


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("Q1 = 5.5\nTOOL CALL Q1 Z S1000", "TOOL CALL"),
        ("Q1 = 50.5\nFN 18: SYSREAD Q2 = ID+Q1 NR1", "ID"),
        ("Q1 = 1.5\nFN 18: SYSREAD Q2 = ID50 NR+Q1 IDX5", "NR"),
        ("Q1 = 5.5\nFN 18: SYSREAD Q2 = ID50 NR1 IDX+Q1", "IDX"),
        ("Q1 = 4.5\nFN 17: SYSWRITE ID50 NR+Q1 IDX5 = +0", "NR"),
    ],
)
def test_number_that_is_not_whole_is_rejected(text: str, names: str) -> None:
    """TOOL CALL of 5.5 once called tool 6."""
    ran = run(text, tool=START, tools={5: ToolOffset(), 6: ToolOffset()})
    assert names in _error(ran)
