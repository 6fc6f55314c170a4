"""How a tool is taken out of the work: worked out by hand, one case for each way of standing in it."""

from __future__ import annotations

import pytest

from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_retract import plan_retract
from core.interpreter.restart.state_rebuild import OmniturnRestartSearch
from core.interpreter.restart.tool_retract import Retract, ToolPosition, ToolSituation
from core.interpreter.shared.job_setup import ControlLimits
from core.language.source import ProgramSource
from tests.interpreter.programs import INCH, OUTPUTS, setup

HEAD = "G90G94F300\nT1\nM03S900\n"
LIMITS = ControlLimits(m_code_outputs={**OUTPUTS, 27: ("mill", True)})


def cut_of(text: str) -> CutRecord:
    return OmniturnRestartSearch(
        ProgramSource("PART", f"{HEAD}{text}M30\n"), setup(limits=LIMITS), lambda _count: None
    ).cut_record


def standing(text: str, line: int, x: float, z: float, nth: int = 1) -> Retract:
    """The tip at (x, z), inches, on the ``nth`` move of this line of the text (the first is 4)."""
    cut = cut_of(text)
    rows = [row for row in range(len(cut)) if cut.line_numbers[row] == line]
    n = sorted({int(cut.block_numbers[row]) for row in rows})[nth - 1]
    return plan_retract(cut, ToolPosition(n, 1, x * INCH, z * INCH), n)


def hops(found: Retract) -> list[tuple[float, float]]:
    return [(round(hop.x / INCH, 3), round(hop.z / INCH, 3)) for hop in found.legs]


GROOVE = "X.5Z.1\nZ-.3\nG95F.002X.3\nG94F300X.5\nZ1\n"
BORE = "X.25Z.1\nG95F.004Z-.8\nX.24\nG94F300Z.1\nX1Z1\n"
BACK_BORE = "X.2Z.1\nZ-.8\nG95F.003X.35\nZ-.6\nX.2Z-.6\nG94F300Z.1\nX1Z1\n"
INSIDE_GROOVE = "X.2Z.1\nZ-.5\nG95F.002X.3\nG94F300X.2\nZ.1\nX1Z1\n"
FACE_GROOVE = "X.3Z.1\nG95F.002Z-.2\nG94F300Z.1\nX1Z1\n"
WIDENED = "X.3Z.1\nG95F.002Z-.2\nX.35\nG94F300Z.1\nX1Z1\n"
HOLE = "X0Z.1\nG95F.003Z-1\nG94F300Z.1\nX1Z1\n"
TURNED = "X.4Z.1\nG95F.005Z-.9\nG94F300X.55\nZ.1\nX1Z1\n"
FAR_SIDE = "X-.4Z.1\nG95F.005Z-.9\nG94F300X-.55\nZ.1\nX-1Z1\n"
TWO_WAYS = "X.5Z.1\nZ-.6\nG95F.003X.4\nZ-.2\nG94F300X.5\nZ1\n"  # enters behind, and turns towards Z+
FACED = "X.5Z.2\nG95F.003Z0\nX-.02\nG94F300Z.2\nX1Z1\n"
PARTED = "X.6Z-.5\nG95F.002X0\nG94F300X.6\nX1Z1\n"
THREAD = "X.5Z.3\nG33X.46Z-.6I.02K.05\nX.6\nZ1\n"
TAP = "X0Z.2\nG95F.05Z-.5\nM04S900\nZ.2\nG94F300Z1\n"
CROSS = "X.75Z1\nZ-.3\nM19\nCA30\nG94F5X.5\nF300X.75\nZ1\nM05\n"
ON_THE_SIDE = "X-1Z1\nZ-.1\nM27\nM19\n(~PLZC)\n(D.9)\n(Z.8F10)\n(X.4)\n(END)\nF300X-1\nZ1\nM05\n"
ON_THE_FACE = "X-.8Z1\nM27\nM19\nG94F10Z-.1\n(~PLXC)\n(X.4Y.3)\n(END)\nF300Z1\nM05\n"


@pytest.mark.parametrize(
    ("text", "line", "x", "z", "way"),
    [
        pytest.param(GROOVE, 6, 0.42, -0.3, [(0.5, -0.3)], id="groove: X out of it"),
        pytest.param(GROOVE, 6, 0.3, -0.3, [(0.5, -0.3)], id="bottom of a groove"),
        pytest.param(BORE, 5, 0.25, -0.4, [(0.25, 0.1)], id="bore: Z out of it"),
        pytest.param(BORE, 6, 0.24, -0.8, [(0.24, 0.1)], id="drawn off the wall of the bore: Z"),
        pytest.param(BACK_BORE, 6, 0.3, -0.8, [(0.2, -0.8), (0.2, 0.1)], id="recess in a bore: X in, then Z"),
        pytest.param(
            BACK_BORE, 7, 0.35, -0.7, [(0.35, -0.8), (0.2, -0.8), (0.2, 0.1)], id="back-boring"
        ),
        pytest.param(INSIDE_GROOVE, 6, 0.26, -0.5, [(0.2, -0.5), (0.2, 0.1)], id="groove in a bore"),
        pytest.param(FACE_GROOVE, 5, 0.3, -0.15, [(0.3, 0.1)], id="groove in the face: Z"),
        pytest.param(WIDENED, 5, 0.3, -0.1, [(0.3, 0.1)], id="groove in the face, yet to be widened: Z"),
        pytest.param(WIDENED, 6, 0.33, -0.2, [(0.3, -0.2), (0.3, 0.1)], id="while it is widened: as it came"),
        pytest.param(HOLE, 5, 0.0, -0.7, [(0.0, 0.1)], id="drilled hole: Z"),
        pytest.param(TURNED, 5, 0.4, -0.5, [(0.55, -0.5), (0.55, 0.1)], id="turning: X off it, then Z"),
        pytest.param(FAR_SIDE, 5, -0.4, -0.5, [(-0.55, -0.5), (-0.55, 0.1)], id="far side: X-"),
        pytest.param(TWO_WAYS, 7, 0.4, -0.4, [(0.4, -0.6), (0.5, -0.6)], id="turning towards Z+"),
        pytest.param(FACED, 6, 0.2, 0.0, [(0.5, 0.0), (0.5, 0.2)], id="facing: back along the face"),
        pytest.param(PARTED, 5, 0.2, -0.5, [(0.6, -0.5)], id="parting off: X"),
    ],
)  # fmt: skip
def test_retract_path_matches_the_operation(
    text: str, line: int, x: float, z: float, way: list[tuple[float, float]]
) -> None:
    found = standing(text, line, x, z)
    assert found.tool_situation is ToolSituation.IN_PART
    assert hops(found) == way


def test_thread_retract_moves_x_first_and_never_back_along_z() -> None:
    # S is X.5, I .02 a side: it is drawn back to S + 3 I.
    found = standing(THREAD, 5, 0.5, -0.2)
    assert found.tool_situation is ToolSituation.IN_THREAD
    assert hops(found)[0] == (0.56, -0.2)


def test_tap_has_no_retract_by_the_axes() -> None:
    found = standing(TAP, 5, 0.0, -0.3)
    assert found.tool_situation is ToolSituation.IN_TAPPED_HOLE
    assert not found.is_known
    assert standing(TAP, 7, 0.0, -0.3).tool_situation is ToolSituation.IN_TAPPED_HOLE  # on its way back too


def test_a_live_drill_in_a_cross_hole_leaves_along_x() -> None:
    found = standing(CROSS, 8, 0.6, -0.3)
    assert (found.tool_situation, hops(found)) == (ToolSituation.MILLING, [(0.75, -0.3)])


def test_mill_retracts_along_its_own_axis() -> None:
    side = standing(ON_THE_SIDE, 11, -0.4, -0.2)
    assert side.tool_situation is ToolSituation.MILLING
    assert hops(side)[0][0] == -1.0  # X, away from the centre, as far as it has been
    face = standing(ON_THE_FACE, 9, -0.6, -0.1)
    assert (face.tool_situation, hops(face)) == (ToolSituation.MILLING, [(-0.6, 1.0)])


@pytest.mark.parametrize(
    ("text", "line", "x", "z"),
    [(GROOVE, 6, 0.42, -0.35), (BORE, 5, 0.3, -0.4), (TURNED, 5, 0.45, -0.5)],
)
def test_tool_not_moved_there_by_the_program_has_no_known_retract(
    text: str, line: int, x: float, z: float
) -> None:
    found = standing(text, line, x, z)
    assert (found.tool_situation, found.is_known) == (ToolSituation.UNKNOWN, False)


def test_opening_the_collet_invalidates_earlier_cuts() -> None:
    """The bar has been pulled: where the tool came through is metal now."""
    pulled = "X.5Z.1\nZ-.3\nM05\nM13\nF20Z.3\nM12\nF300Z1\nX1\n"
    found = standing(pulled, 8, 0.5, 0.0)
    assert not found.is_known


def test_largest_cut_of_a_bored_part_is_not_the_bar_diameter() -> None:
    """G74 inside: a wall stands around the last pass, however large that is."""
    found = standing("X.25Z.05\nG95F.004\nG74X.5Z-.5I.125\nG94F300X1Z1\n", 6, 0.5, -0.3, nth=6)
    assert hops(found) == [(0.48, -0.3), (0.48, 0.05)]  # .02 off the wall as the cycle is, and out along Z


def test_feed_off_pass_retracts_along_x_where_earlier_passes_made_room() -> None:
    rough = "X.46Z.1\nG95F.008Z-.9\nX.5\nG94F300Z.1\nX.42\nG95F.008Z-.9\nX.5\nG94F300Z.1\nX1Z1\n"  # .04 each
    first = standing(rough, 5, 0.46, -0.4)
    assert hops(first) == [(0.46, 0.1)]  # a groove in the face would be cut just so
    second = standing(rough, 9, 0.42, -0.4)
    assert hops(second) == [(0.5, -0.4), (0.5, 0.1)]
