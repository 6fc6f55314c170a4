"""RL, RR, APPR and DEP: where the tool's centre goes, by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from tests.klartext.running import Ran, run
from tests.klartext.test_path_functions import on_the_way

TOOL = "TOOL DEF 5 L+0 R+5\nTOOL CALL 5 Z S3000 F500\n"
HERE = "L X-20 Y-20 Z+0 FMAX M3\n"


def ran_of(text: str) -> Ran:
    return run(HERE + text, tool=TOOL)


def ends(text: str) -> list[tuple[float, float]]:
    """Ends in X and Y of the moves behind the first one."""
    return [end(block) for block in moves(text)]


def moves(text: str) -> list[Block]:
    ran = ran_of(text)
    assert ran.codes == []
    return [block for block in ran.blocks if block.moves][1:]


def end(block: Block) -> tuple[float, float]:
    assert block.swivel is not None
    x, y, _ = block.swivel.end
    return x, y


def about(*wanted: tuple[float, float]) -> list[object]:
    return [pytest.approx(each, abs=1e-9) for each in wanted]


def test_square_is_cut_outside_with_rl() -> None:
    """Clockwise round a square of 20: the tool of R 5 keeps 5 mm off, and goes round each corner."""
    text = "L X+0 Y+0 RL F100\nL Y+20\nL X+20\nL Y+0\nL X+0\nL X-20 Y-20 R0 FMAX"
    wanted = [(-5, 0), (-5, 20), (0, 25), (20, 25), (25, 20), (25, 0), (20, -5), (0, -5), (-20, -20)]
    assert ends(text) == about(*wanted)
    arcs = [block for block in moves(text) if block.kind is BlockKind.PLANE_ARC]
    assert [arc.length for arc in arcs] == pytest.approx([2.5 * math.pi] * 3)


def test_square_is_cut_inside_with_rr() -> None:
    text = "L X+0 Y+10 RR F100\nL Y+20\nL X+20\nL Y+0\nL X+0\nL Y+10\nL X+10 R0"
    assert ends(text) == about((5, 10), (5, 15), (15, 15), (15, 5), (5, 5), (5, 10), (10, 10))


def test_start_in_inside_corner_is_rejected() -> None:
    ran = ran_of("L X+0 Y+0 RR F100\nL Y+20\nL X+20\nL Y+0\nL X+0\nL X+10 Y+10 R0")
    assert ran.codes == ["Tool radius too large"]


def test_the_feed_of_each_element_is_its_own() -> None:
    blocks = moves("L X+0 Y+0 RL F100\nL Y+20 F200\nL X+20 F300\nL X+40 Y+40 R0 FMAX")
    assert [round(block.feed * 60.0) for block in blocks[:4]] == [100, 200, 200, 300]
    assert blocks[-1].kind is BlockKind.RAPID


def test_z_moves_in_contour_stay_at_compensated_position() -> None:
    blocks = moves("L X+0 Y+0 RL F100\nL Z-3\nL Y+20\nL Z-6\nL Y+40\nL Z+10 R0 FMAX")
    points = [block.swivel.end for block in blocks if block.swivel is not None]
    wanted = [(-5, 0, 0), (-5, 0, -3), (-5, 20, -3), (-5, 20, -6), (-5, 40, -6), (-5, 40, 10)]
    assert points == [pytest.approx(each, abs=1e-9) for each in wanted]


def test_m_functions_stay_in_order_within_contour() -> None:
    ran = ran_of("L X+0 Y+0 RL F100\nL Y+20 M8\nL Y+40\nM9\nL Y+60\nL X-20 R0 FMAX")
    assert ran.codes == []
    told = [(block.kind.value, block.line) for block in ran.blocks if block.line >= 6]
    assert told[:5] == [("action", 6), ("feed", 6), ("feed", 7), ("action", 8), ("feed", 9)]


def test_a_rounding_inside_is_smaller_by_the_tool() -> None:
    blocks = moves("L X+0 Y+0 RR F100\nL Y+40\nRND R8\nL X+40\nL X+20 Y+20 R0")
    (arc,) = (block for block in blocks if block.kind is BlockKind.PLANE_ARC)
    points = on_the_way(arc)
    assert np.hypot(points[:, 0] - 8.0, points[:, 1] - 32.0) == pytest.approx(3.0)


def test_rounding_smaller_than_tool_is_rejected_at_its_line() -> None:
    ran = ran_of("L X+0 Y+0 RR F100\nL Y+40\nRND R4\nL X+40\nL X+20 Y+20 R0")
    assert ran.codes == ["Tool radius too large"]
    assert ran.errors[0].line == 8


def test_dr_of_tool_call_increases_tool_radius() -> None:
    thick = "TOOL DEF 5 L+0 R+5\nTOOL CALL 5 Z S3000 F500 DR+0.3\n"
    ran = run(HERE + "L X+0 Y+0 RL F100\nL Y+20\nL X-20 R0 FMAX", tool=thick)
    assert end([block for block in ran.blocks if block.moves][1]) == pytest.approx((-5.3, 0.0))


def test_a_mirrored_contour_is_the_mirror_image() -> None:
    text = "L X+0 Y+0 RL F100\nL Y+20\nL X+20\nL X+40 Y+40 R0 FMAX"
    plain, mirrored = ends(text), ends(f"TRANS MIRROR AXIS X\n{text}")
    assert mirrored == about(*((-x, y) for x, y in plain))


def test_scaled_contour_uses_unscaled_tool_radius() -> None:
    blocks = ends("TRANS SCALE SCL2\nL X+0 Y+0 RL F100\nL Y+20\nL X+20\nL X+40 Y+40 R0 FMAX")
    assert blocks[:4] == about((-5, 0), (-5, 40), (0, 45), (40, 45))


def test_program_ending_with_compensation_on_causes_warning() -> None:
    ran = ran_of("L X+0 Y+0 RL F100\nL Y+20")
    assert ran.warned == ["compensation-left-on"]
    assert end([block for block in ran.blocks if block.moves][-1]) == pytest.approx((-5.0, 20.0))


# --- APPR and DEP: the contour begins at (0, 0) and runs up, the tool of R 5 on its left at x -5 ----------


BEHIND = "\nL Y+20\nL X-20 Y+40 R0 FMAX"


def test_appr_lt_is_tangent_to_contour() -> None:
    assert ends(f"APPR LT X+0 Y+0 LEN10 RL F100{BEHIND}")[:3] == about((-5, -10), (-5, 0), (-5, 20))


def test_appr_ln_is_perpendicular_to_contour() -> None:
    assert ends(f"APPR LN X+0 Y+0 LEN10 RL F100{BEHIND}")[:3] == about((-15, 0), (-5, 0), (-5, 20))


def test_appr_ct_is_an_arc() -> None:
    """R 12 for the contour is 7 for the centre of the tool: a quarter about (-12, 0)."""
    blocks = moves(f"APPR CT X+0 Y+0 CCA90 R+12 RL F100{BEHIND}")
    assert [end(block) for block in blocks[:3]] == about((-12, -7), (-5, 0), (-5, 20))
    points = on_the_way(blocks[1])
    assert np.hypot(points[:, 0] + 12.0, points[:, 1]) == pytest.approx(7.0)


def test_appr_ct_with_negative_radius_starts_on_workpiece_side() -> None:
    blocks = moves(f"APPR CT X+0 Y+0 CCA90 R-12 RL F100{BEHIND}")
    assert [end(block) for block in blocks[:2]] == about((12, -17), (-5, 0))


def test_appr_lct_line_is_tangent_to_arc() -> None:
    """The line from (-20, -20) touches the circle of 7 about (-12, 0) in its own sense."""
    blocks = moves(f"APPR LCT X+0 Y+0 R12 RL F100{BEHIND}")
    x, y = end(blocks[0])
    assert math.hypot(x + 12.0, y) == pytest.approx(7.0)
    line = np.array((x + 20.0, y + 20.0))
    assert np.dot(line, (x + 12.0, y)) == pytest.approx(0.0, abs=1e-9)
    # Counter-clockwise at that point runs the way of the line.
    assert np.dot(line, (-y, x + 12.0)) > 0.0
    assert end(blocks[1]) == pytest.approx((-5.0, 0.0))


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        ("DEP LT LEN10 F100", [(-5, 30)]),
        ("DEP LN LEN10 F100", [(-15, 20)]),
        ("DEP CT CCA90 R+12 F100", [(-12, 27)]),
        ("DEP CT CCA180 R+12 F100", [(-19, 20)]),
    ],
)
def test_departure_ends_at_its_point(words: str, wanted: list[tuple[float, float]]) -> None:
    assert ends(f"L X+0 Y+0 RL F100\nL Y+20\n{words}")[2:] == about(*wanted)


def test_dep_lct_line_is_tangent_to_arc() -> None:
    blocks = moves("L X+0 Y+0 RL F100\nL Y+20\nDEP LCT X-40 Y+40 R12 F100")
    arc, line = blocks[2:]
    x, y = end(arc)
    assert math.hypot(x + 12.0, y - 20.0) == pytest.approx(7.0)
    assert np.dot((-40.0 - x, 40.0 - y), (x + 12.0, y - 20.0)) == pytest.approx(0.0, abs=1e-9)
    assert end(line) == pytest.approx((-40.0, 40.0))


def test_approach_and_departure_run_without_compensation() -> None:
    wanted = [(0, -10), (0, 0), (0, 20), (0, 30)]
    assert ends("APPR LT X+0 Y+0 LEN10 R0 F100\nL Y+20\nDEP LT LEN10") == about(*wanted)


def test_polar_approach_starts_from_pole() -> None:
    wanted = [(-5, -10), (-5, 0), (-5, 20)]
    assert ends(f"CC X+10 Y+0\nAPPR PLT PR+10 PA+180 LEN10 RL F100{BEHIND}")[:3] == about(*wanted)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("APPR CT X+0 Y+0 CCA90 R+4 RL F100", "Tool radius too large"),
        ("APPR LT X+0 Y+0 RL F100", "Syntax error"),
        ("L X+0 Y+0 RL F100\nL Y+20\nAPPR LT X+0 Y+0 LEN10 RL", "Radius compensation not permitted here"),
        ("APPR LCT X+0 Y+0 R60 RL F100", "Input value incorrect"),
        ("L X+0 Y+0 RL F100\nL Y+20\nL Y+5\nL X-20 R0", "Tool radius too large"),
    ],
)
def test_invalid_compensation_is_rejected(text: str, code: str) -> None:
    ran = ran_of(f"{text}{BEHIND}")
    assert ran.codes[:1] == [code]
