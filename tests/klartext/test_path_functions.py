"""Path functions by hand: where they end, how long they are, and that every point lies on what was meant."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.geometry.working_plane import HelixMove
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.source import ProgramSource
from tests.klartext.running import Ran, run, run_file, run_source, whole

HERE = "L X+0 Y+0 Z+0 FMAX M3\n"


def ways(text: str, begin: str = HERE) -> list[Block]:
    """The moves behind the first one."""
    ran = run(begin + text)
    assert ran.codes == []
    return [block for block in ran.blocks if block.moves][begin.count("L X") :]


def end(block: Block) -> tuple[float, ...]:
    assert block.swivel is not None
    return block.swivel.end


def on_the_way(block: Block, count: int = 33) -> np.ndarray:
    """Points of the working plane along an arc."""
    assert block.travel is not None
    way = block.travel.curved_move
    assert isinstance(way, HelixMove)
    return way.compute_workpiece_points(way.compute_machine_positions(np.linspace(0.0, 1.0, count)))


@pytest.mark.parametrize(
    ("text", "centre", "radius", "length", "stop"),
    [
        ("CC X+10 Y+0\nC X+20 Y+0 DR- F100", (10, 0), 10.0, 10 * math.pi, (20, 0, 0)),
        ("CC X+10 Y+0\nC X+10 Y+10 DR+ F100", (10, 0), 10.0, 15 * math.pi, (10, 10, 0)),
        ("CC X+10 Y+0\nC X+0 Y+0 DR+ F100", (10, 0), 10.0, 20 * math.pi, (0, 0, 0)),  # a full circle
        ("CR X+10 Y+10 R+10 DR+ F100", (0, 10), 10.0, 5 * math.pi, (10, 10, 0)),
        ("CR X+10 Y+10 R-10 DR+ F100", (10, 0), 10.0, 15 * math.pi, (10, 10, 0)),
        ("CR X+10 Y+10 R+10 DR- F100", (10, 0), 10.0, 5 * math.pi, (10, 10, 0)),
        ("CR X+10 Y+10 R-10 DR- F100", (0, 10), 10.0, 15 * math.pi, (10, 10, 0)),
        ("CC X+10 Y+0\nCP IPA-90 DR- F100", (10, 0), 10.0, 5 * math.pi, (10, 10, 0)),
        ("CC X+10 Y+0\nCP PA+90 DR- F100", (10, 0), 10.0, 5 * math.pi, (10, 10, 0)),
        ("CC X+10 Y+0\nCP PA+90 DR+ F100", (10, 0), 10.0, 15 * math.pi, (10, 10, 0)),
        ("CC X+10 Y+0\nCP IPA+90 IZ-5 DR+ F100", (10, 0), 10.0, math.hypot(5 * math.pi, 5), (10, -10, -5)),
    ],
)
def test_arc_ends_at_its_point_in_its_direction(
    text: str, centre: tuple[float, float], radius: float, length: float, stop: tuple[float, float, float]
) -> None:
    (arc,) = ways(text)
    assert arc.kind is BlockKind.PLANE_ARC
    assert not arc.has_angular_feed
    assert arc.length == pytest.approx(length)
    assert end(arc) == pytest.approx(stop, abs=1e-9)
    points = on_the_way(arc)
    assert np.hypot(points[:, 0] - centre[0], points[:, 1] - centre[1]) == pytest.approx(radius)
    assert points[0] == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert points[-1] == pytest.approx(stop, abs=1e-9)
    middle = points[16]
    turned = math.atan2(points[1][1] - centre[1], points[1][0] - centre[0])
    first = math.atan2(points[0][1] - centre[1], points[0][0] - centre[0])
    way = (turned - first + math.pi) % (2 * math.pi) - math.pi
    assert (way > 0.0) == ("DR+" in text)
    assert middle[2] == pytest.approx(stop[2] / 2.0)


def test_cp_ipa_makes_helix_of_three_and_a_half_turns() -> None:
    arcs = ways("CC X+10 Y+0\nCP IPA-1260 IZ-7 DR- F100")
    assert [arc.kind for arc in arcs] == [BlockKind.PLANE_ARC] * 4
    assert [end(arc)[2] for arc in arcs] == pytest.approx([-2.0, -4.0, -6.0, -7.0])
    assert end(arcs[-1])[:2] == pytest.approx((20.0, 0.0))
    assert sum(arc.length for arc in arcs) == pytest.approx(math.hypot(70 * math.pi, 7.0))


def test_arc_without_dr_uses_direction_of_previous_arc() -> None:
    first, second = ways("CC X+10 Y+0\nC X+20 Y+0 DR- F100\nCC X+30 Y+0\nC X+40 Y+0")
    assert on_the_way(first, 3)[1][:2] == pytest.approx((10.0, 10.0))
    assert on_the_way(second, 3)[1][:2] == pytest.approx((30.0, 10.0))


def test_tangential_arc_continues_in_previous_direction() -> None:
    """Along +X, then to (20, 10): the centre lies above (10, 0) and is as far from both: R 10."""
    line, arc = ways("L X+10 F100\nCT X+20 Y+10")
    points = on_the_way(arc)
    assert np.hypot(points[:, 0] - 10.0, points[:, 1] - 10.0) == pytest.approx(10.0)
    assert arc.length == pytest.approx(5 * math.pi)
    assert end(line)[:2] == pytest.approx((10.0, 0.0))


def test_tangential_arc_straight_ahead_is_a_line() -> None:
    blocks = ways("L X+10 F100\nCT X+20")
    assert [block.kind for block in blocks] == [BlockKind.FEED, BlockKind.FEED]


def test_polar_coordinates_are_relative_to_pole() -> None:
    blocks = ways("CC X+10 Y+10\nLP PR+10 PA+0 F100\nLP PA+90\nLP IPA+90\nLP IPR+5\nLP PR+2 PA-90")
    wanted = [(20, 10), (10, 20), (0, 10), (-5, 10), (10, 8)]
    assert [end(block)[:2] for block in blocks] == [pytest.approx(each, abs=1e-9) for each in wanted]


def test_pole_may_be_current_or_incremental_position() -> None:
    blocks = ways("L X+5 Y+5 F100\nCC\nLP PR+3 PA+0\nCC IX+1 IY+1\nLP PR+2 PA+90")
    assert end(blocks[1])[:2] == pytest.approx((8.0, 5.0))
    assert end(blocks[2])[:2] == pytest.approx((9.0, 8.0))


def test_a_rounding_touches_both_lines() -> None:
    blocks = ways("L X+20 F100\nRND R5 F50\nL Y+20 F100")
    line, arc, last = blocks
    assert end(line)[:2] == pytest.approx((15.0, 0.0))
    assert end(arc)[:2] == pytest.approx((20.0, 5.0))
    assert arc.length == pytest.approx(2.5 * math.pi)
    assert arc.feed == pytest.approx(50.0 / 60.0)
    assert end(last)[:2] == pytest.approx((20.0, 20.0))
    assert [block.line for block in blocks] == [4, 6, 6]


def test_a_chamfer_is_measured_along_each_leg() -> None:
    line, cut, _ = ways("L X+20 F100\nCHF 3\nL Y+20")
    assert end(line)[:2] == pytest.approx((17.0, 0.0))
    assert end(cut)[:2] == pytest.approx((20.0, 3.0))


def test_element_may_have_corner_at_both_ends() -> None:
    blocks = ways("L X+20 F100\nRND R5\nL Y+20\nRND R5\nL X+0")
    assert [end(block)[:2] for block in blocks] == [
        pytest.approx(each) for each in ((15, 0), (20, 5), (20, 15), (15, 20), (0, 20))
    ]


def test_actions_before_corner_run_before_it() -> None:
    blocks = [block for block in run(f"{HERE}L X+20 F100 M8\nRND R5\nL Y+20 M9").blocks if block.line >= 4]
    kinds = [(block.line, block.kind) for block in blocks]
    assert kinds[:3] == [(4, BlockKind.ACTION), (4, BlockKind.FEED), (6, BlockKind.PLANE_ARC)]


# --- transformations -------------------------------------------------------------------------------------


def test_rotation_turns_about_the_datum() -> None:
    (line,) = ways("TRANS DATUM AXIS X+10\nTRANS ROTATION ROT+90\nL X+5 Y+0 FMAX")
    assert end(line)[:2] == pytest.approx((0.0, 5.0), abs=1e-9)  # the datum's own coordinates
    assert line.swivel is not None
    assert line.swivel.machine_position[:2] == pytest.approx((230.0 + 10.0, 210.0 + 5.0))


def test_mirroring_reverses_arc_direction() -> None:
    (arc,) = ways("TRANS MIRROR AXIS X\nCC X+10 Y+0\nC X+20 Y+0 DR- F100")
    points = on_the_way(arc)
    assert points[-1][:2] == pytest.approx((-20.0, 0.0), abs=1e-9)
    assert points[16][:2] == pytest.approx((-10.0, 10.0), abs=1e-9)


def test_scaling_applies_until_cancelled() -> None:
    blocks = ways(
        "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.5\nL X+20 Z-4 FMAX\nTRANS SCALE RESET\nL X+20 FMAX"
    )
    assert [end(block) for block in blocks] == [pytest.approx((10, 0, -2)), pytest.approx((20, 0, -2))]


def test_cycl_def_and_trans_give_same_transformation() -> None:
    old = "CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 X Y\nCYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+30\n"
    new = "TRANS MIRROR AXIS X Y\nTRANS ROTATION ROT+30\n"
    assert end(ways(f"{old}L X+7 Y+3 FMAX")[0]) == pytest.approx(end(ways(f"{new}L X+7 Y+3 FMAX")[0]))


def test_preset_cancels_shift_and_rotation() -> None:
    (line,) = ways(
        "TRANS DATUM AXIS X+10\nTRANS ROTATION ROT+90\nCYCL DEF 247 PRESET ~\n  Q339=+1 ;NUMBER\nL X+5 FMAX"
    )
    assert end(line)[:2] == pytest.approx((5.0, 0.0))


# --- whole programs --------------------------------------------------------------------------------------


def ran_of(text: str) -> Ran:
    return run(HERE + text)


def test_error_in_block_of_several_lines_has_its_line_and_column() -> None:
    ran = ran_of("PLANE SPATIAL SPA+45 ~\n   SPB+0 SPC+0 ~\n   TURN FOO")
    assert [(error.line, error.column) for error in ran.errors] == [(6, 9)]


def test_repeats_in_old_notation() -> None:
    ran = ran_of("LBL 5\nL IX+1 FMAX\nCALL LBL 5 REP 3/3")
    assert ran.codes == []
    assert ran.state.programmed_position[0] == pytest.approx(4.0)


def test_repeat_count_may_be_a_parameter() -> None:
    ran = ran_of("Q106 = 2.9\nLBL 5\nL IX+1 FMAX\nCALL LBL 5 REP Q106")
    assert ran.codes == []
    assert ran.state.programmed_position[0] == pytest.approx(3.0)


def test_errors_of_called_program_are_reported_at_call() -> None:
    hole = ProgramSource(
        "HOLE.H", "0 BEGIN PGM HOLE MM\n1 LBL 1\n2 L IX+5 FMAX\n3 CALL LBL 1 REP 1\n4 END PGM HOLE MM\n"
    )
    text = whole("TOOL CALL 1 Z S100\nL X+0 FMAX\nCALL PGM TNC:\\PARTS\\hole\nL IX+1 FMAX")
    ran = run_source(ProgramSource("T.H", text, subprograms=(hole,)))
    assert ran.codes == []
    assert ran.state.programmed_position[0] == pytest.approx(11.0)
    assert [block.line for block in ran.blocks if block.moves] == [3, 4, 4, 5]
    bad = ProgramSource("HOLE.H", "0 BEGIN PGM HOLE MM\n1 L X+1 FOO\n2 END PGM HOLE MM\n")
    (error,) = run_source(ProgramSource("T.H", text, subprograms=(bad,))).errors
    assert error.line == 4
    assert "HOLE.H line 2" in error.message


def test_recursive_program_call_is_rejected() -> None:
    text = whole("TOOL CALL 1 Z S100\nCALL PGM T")
    ran = run_source(ProgramSource("T.H", text, subprograms=(ProgramSource("T.H", text),)))
    assert ran.codes == ["Excessive nesting"]


def test_a_program_may_have_no_name() -> None:
    ran = run_file("BEGIN PGM MM\nTOOL CALL 1 Z S100\nL X+1 FMAX\nEND PGM MM\n")
    assert ran.codes == []
