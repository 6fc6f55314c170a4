"""Whole programs: the chamfers of the manuals by axis angles and by points, flow, functions, inches."""

from __future__ import annotations

import numpy as np
import pytest

from core.interpreter.klartext.klartext_interpreter import Interpreter
from core.interpreter.klartext.klartext_program import read_program
from core.interpreter.shared.actions import (
    Action,
    CoolantSwitch,
    ProgramEnd,
    ProgramStop,
    SpindleRun,
    SpindleStop,
    ToolChange,
)
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ControlLimits, InterpreterSetup, ToolOffset
from core.language.klartext import parse_line
from core.language.klartext.canonical_text import format_block
from core.language.source import ProgramSource
from tests.klartext.chamfers import AXIAL, POINTS, SYM_MINUS
from tests.klartext.running import HOME, Ran, run, run_file, whole
from tests.klartext.table import AC
from tests.klartext.test_plane_frames import STANDS


def machine(ran: Ran) -> np.ndarray:
    rows = [block.travel.end for block in ran.blocks if block.travel is not None]
    return np.array(rows)


def rotary(block: Block) -> list[float]:
    """The rotary axes that are there, as shown."""
    assert block.swivel is not None
    return [angle for angle in block.swivel.rotary_angles if angle is not None]


def cuts(ran: Ran) -> list[tuple[np.ndarray, np.ndarray]]:
    """Start and end of every feed move on the workpiece."""
    found = []
    for block in ran.blocks:
        if block.kind is BlockKind.FEED and block.swivel is not None:
            r, o = np.array(block.swivel.system.frame), np.array(block.swivel.system.datum)
            found.append((o + r @ np.array(block.swivel.start), o + r @ np.array(block.swivel.end)))
    return found


def test_both_programs_follow_same_path_on_machine() -> None:
    axial, points = run_file(AXIAL), run_file(POINTS)
    assert not axial.diagnostics
    assert not points.diagnostics
    assert machine(axial) == pytest.approx(machine(points), abs=1e-9)
    assert [block.kind for block in axial.blocks] == [block.kind for block in points.blocks]


def test_cuts_start_and_end_at_positions_of_table() -> None:
    """With nothing left to turn, a point of the plane is the machine's place of the datum plus its words."""
    ran = run_file(AXIAL)
    feeds = [block for block in ran.blocks if block.kind is BlockKind.FEED]
    assert len(feeds) == 8
    for chamfer, (down, along) in enumerate(zip(feeds[::2], feeds[1::2], strict=True), start=1):
        (a, c, _), _, origin = STANDS[chamfer][0]
        for block, q in ((down, (-15.0, -7.071, 0.0)), (along, (115.0, -7.071, 0.0))):
            assert block.swivel is not None
            assert block.swivel.machine_position == pytest.approx(np.add(origin, q), abs=6e-5)
            assert rotary(block) == pytest.approx((a, c))
            assert block.swivel.end == pytest.approx(q, abs=1e-9)
    first = feeds[0].swivel
    assert first is not None
    assert first.machine_position == pytest.approx((215.0, 278.2843, -352.2183), abs=6e-5)


def test_other_solution_side_cuts_same_lines_of_workpiece() -> None:
    plus, minus = run_file(POINTS), run_file(SYM_MINUS)
    assert not minus.errors
    for here, there in zip(cuts(plus), cuts(minus), strict=True):
        assert np.allclose(here, there, atol=1e-9)
    feeds = [block for block in minus.blocks if block.kind is BlockKind.FEED]
    for chamfer in STANDS:
        swivel = feeds[2 * chamfer - 1].swivel
        (a, c, _), _, origin = STANDS[chamfer][1]
        assert swivel is not None
        assert rotary(feeds[2 * chamfer - 1]) == pytest.approx((a, c))
        turned = (-115.0, 7.071, 0.0)  # half a turn about the tool is left over
        assert swivel.machine_position == pytest.approx(np.add(origin, turned), abs=6e-5)


def test_cuts_are_on_the_chamfers() -> None:
    """Chamfer 1 runs at y 5, z -5 from x -15 to 115; the others are that line about the block's centre."""
    ends = [np.array((-15.0, 5.0, -5.0)), np.array((115.0, 5.0, -5.0))]
    quarter = np.array(((0, -1, 0), (1, 0, 0), (0, 0, 1)))
    centre = np.array((50.0, 50.0, 0.0))
    for start, end in cuts(run_file(AXIAL))[1::2]:
        assert np.allclose((start, end), ends, atol=1e-4)  # 7.071 for 7.0710678
        ends = [centre + quarter @ (each - centre) for each in ends]


def test_program_with_m30_before_end_pgm_ends_once() -> None:
    ran = run_file(AXIAL)
    assert sum(isinstance(block.action, ProgramEnd) for block in ran.blocks) == 1
    assert ran.state.position_by_axis["C"] == pytest.approx(360.0)
    assert ran.state.position_by_axis["A"] == 0.0


def test_every_line_is_written_as_it_is_read() -> None:
    for text in (*AXIAL.splitlines(), *POINTS.splitlines()):
        line = parse_line(1, text)
        again = parse_line(1, format_block(line))
        assert again.error is None
        assert format_block(again) == format_block(line)


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("TOOL CALL 5 Z S(VC = 120) F500 DR2:+0.1 DR-0.5", "TOOL CALL 5 Z F500 DR-0.5 DR2:+0.1 S(VC = 120)"),
        ("TOOL CALL Q5 Z S900 FU0.1 DL+Q1 DR2-0.05", "TOOL CALL Q5 Z S900 FU0.1 DL+Q1 DR2:-0.05"),
    ],
)
def test_all_words_of_a_tool_call_are_written(text: str, written: str) -> None:
    assert format_block(parse_line(1, text)) == written
    assert format_block(parse_line(1, written)) == written


# --- flow ------------------------------------------------------------------------------------------------


def xs(ran: Ran) -> list[float]:
    return [round(ran.axes(block)["X"] - 230.0, 6) for block in ran.blocks if block.kind is BlockKind.RAPID]


def test_a_section_is_repeated() -> None:
    ran = run("LBL 5\nL IX+10 FMAX\nCALL LBL 5 REP 3", start=(230.0, 0.0, 0.0, 0.0, 0.0))
    assert xs(ran) == [10.0, 20.0, 30.0, 40.0]


def test_repeats_in_subprogram_restart_at_each_call() -> None:
    text = 'CALL LBL "ROW"\nCALL LBL "ROW"\nM30\nLBL "ROW"\nLBL 5\nL IX+10 FMAX\nCALL LBL 5 REP 1\nLBL 0'
    ran = run(text, start=(230.0, 0.0, 0.0, 0.0, 0.0))
    assert xs(ran) == [10.0, 20.0, 30.0, 40.0]


def test_subprogram_calls_subprogram() -> None:
    text = "CALL LBL 1\nM30\nLBL 1\nL X+1 FMAX\nCALL LBL 2\nL X+3 FMAX\nLBL 0\nLBL 2\nL X+2 FMAX\nLBL 0"
    assert xs(run(text)) == [1.0, 2.0, 3.0]


def test_blocks_with_slash_are_skipped_under_block_delete() -> None:
    text = "/L X+1 FMAX\n/ 12 L X+2 FMAX\n13 / L X+3 FMAX\nL X+4 FMAX"
    assert xs(run(text)) == [1.0, 2.0, 3.0, 4.0]
    assert xs(run(text, block_delete=True)) == [4.0]


def test_q_parameters_set_positions() -> None:
    ran = run("Q1 = +10\nFN 0: Q2 = -Q1\nL X+Q1 Y-Q2 FMAX\nL XQ2 FMAX")
    assert xs(ran) == [10.0, -10.0]
    assert ran.state.position_by_axis["Y"] == pytest.approx(220.0)


def test_structure_items_and_comments_have_no_effect() -> None:
    ran = run("* - FIRST SIDE ; really\n; only a comment\n\nL X+1 FMAX ; go")
    assert xs(ran) == [1.0]


# --- tools, spindle, functions ---------------------------------------------------------------------------


def actions(ran: Ran) -> list[Action]:
    return [block.action for block in ran.blocks if block.action is not None]


def test_m_functions_run_before_or_after_motion() -> None:
    ran = run("L X+1 FMAX M3 M8\nL X+2 FMAX M5 M9")
    kinds = [block.kind if block.action is None else type(block.action).__name__ for block in ran.blocks]
    wanted = [
        "ToolChange",
        "SpindleRun",
        "CoolantSwitch",
        "rapid",
        "rapid",
        "SpindleStop",
        "CoolantSwitch",
        "ProgramEnd",
    ]
    assert kinds == wanted


def test_second_tool_stops_spindle_and_waits_for_operator() -> None:
    tools = {1: ToolOffset(), 2: ToolOffset(z=80.0)}
    ran = run("L Z+100 FMAX M13\nTOOL CALL 2 Z S1000 DL+0.5\nL Z+100 FMAX", tools=tools)
    assert actions(ran) == [
        ToolChange(1),
        SpindleRun(3000.0),
        CoolantSwitch(on=True),
        SpindleStop(),
        ToolChange(2),
        ProgramStop(optional=False, message="TOOL 2"),
        ProgramEnd(reset=True),
    ]
    assert ran.state.position_by_axis["Z"] == pytest.approx(-350.0 + 100.0 + 80.5)


def test_a_call_without_a_tool_changes_the_speed_of_the_running_spindle() -> None:
    ran = run("L X+1 FMAX M4\nTOOL CALL S1500")
    assert actions(ran)[1:3] == [SpindleRun(-3000.0), SpindleRun(-1500.0)]


def test_tool_without_offset_causes_warning() -> None:
    ran = run("L X+1 FMAX", tools={})
    assert ran.warned == ["tool-offset-missing"]


def test_stop_m1_and_m0_stop_with_message() -> None:
    ran = run("STOP ; TURN THE PART\nM1 ; LOOK\nM0 ; WAIT")
    stops = [action for action in actions(ran) if isinstance(action, ProgramStop)]
    assert stops == [
        ProgramStop(optional=False, message="TURN THE PART"),
        ProgramStop(optional=True, message="LOOK"),
        ProgramStop(optional=False, message="WAIT"),
    ]


def test_m91_uses_machine_positions_for_one_block() -> None:
    ran = run("PLANE AXIAL A+45 TURN FMAX\nL Z-5 R0 FMAX M91\nL X+100 Y+20 FMAX M91\nL X+0 Y+0 Z+0 FMAX")
    moves = [ran.axes(block) for block in ran.blocks if block.kind is BlockKind.RAPID]
    assert [moves[0][axis] for axis in "XYZ"] == [0.0, 0.0, -5.0]
    assert [moves[1][axis] for axis in "XYZ"] == [100.0, 20.0, -5.0]
    assert [moves[2][axis] for axis in "XYZ"] == pytest.approx((230.0, 278.2843, -345.1472), abs=6e-5)


def test_m140_retracts_along_tool() -> None:
    ran = run("PLANE AXIAL A+45 TURN FMAX\nL Z+10 FMAX\nL IX+5 FMAX M140 MB 30\nM140 MB MAX F6000")
    z = [ran.axes(block)["Z"] for block in ran.blocks if block.moves]
    assert z[2] - z[1] == pytest.approx(30.0)
    assert z[-1] == pytest.approx(-0.001)
    assert ran.blocks[-2].feed == pytest.approx(100.0)


def test_cut_with_stopped_spindle_causes_one_warning() -> None:
    assert run("L X+1 F100\nL X+2").warned == ["spindle-stopped"]


# --- rotary axes by L, inches ----------------------------------------------------------------------------


def test_absolute_rotary_moves_use_short_path_and_incremental_full_path() -> None:
    ran = run("L C+270 FMAX\nL IC+450 FMAX\nL A+10 C+0 FMAX")
    assert [ran.axes(block)["C"] for block in ran.blocks if block.moves] == [-90.0, 360.0, 360.0]


def test_m127_rotary_moves_follow_displayed_angles() -> None:
    """From 350 to 10: +20 the short way, -340 by the figures; from 370, which is shown as 10, to 350 +340."""
    ran = run("L C+350 FMAX\nM127\nL C+10 FMAX\nM126\nL C+350 FMAX")
    assert [ran.axes(block)["C"] for block in ran.blocks if block.moves] == [-10.0, -350.0, -370.0]


def test_feed_of_rotary_move_is_in_degrees_per_minute() -> None:
    ran = run("M3\nL A+30 C+40 F600")
    block = ran.blocks[-2]
    assert block.travel is not None
    assert block.feed == pytest.approx(10.0)
    assert block.travel.length == pytest.approx(50.0)
    mixed = run("M3\nL X+0 Y+0 Z+100 FMAX\nL IX+30 IY+40 C+90 F600").blocks[-2]
    assert mixed.travel is not None
    assert mixed.feed == pytest.approx(10.0)
    assert mixed.travel.length == pytest.approx(50.0)


def test_inch_program_lengths_are_inches_and_feeds_tenths_per_minute() -> None:
    ran = run("L X+1 Y+0 Z+0 FMAX M3\nL IX+1 F100\nPLANE AXIAL A+45 TURN MB 2 F600\nL A+0 F300", unit="INCH")
    moves = [block for block in ran.blocks if block.moves]
    assert ran.axes(moves[0])["X"] == pytest.approx(230.0 + 25.4)
    assert moves[1].feed == pytest.approx(10.0 * 25.4 / 60.0)  # 100 tenths of an inch are 10 in/min
    assert ran.axes(moves[2])["Z"] == pytest.approx(-350.0 + 50.8)
    assert moves[3].feed == pytest.approx(10.0)  # degrees stay degrees
    assert moves[4].feed == pytest.approx(5.0)
    assert not ran.state.modal.metric


def test_points_and_datum_in_inch_program() -> None:
    ran = run("TRANS DATUM AXIS X+1\nL X+0 Y+0 Z+0 FMAX", unit="INCH")
    assert ran.state.position_by_axis["X"] == pytest.approx(255.4)


@pytest.mark.parametrize(
    ("second", "unit", "corners"),
    [
        ("X+4 Y+2 Z+0", "MM", ((0.0, 0.0, -1.0), (4.0, 2.0, 0.0))),
        ("X+4 Y+2 Z+0", "INCH", ((0.0, 0.0, -25.4), (101.6, 50.8, 0.0))),
        ("IX+4 IY+2 IZ+1", "MM", ((0.0, 0.0, -1.0), (4.0, 2.0, 0.0))),
        ("X+4 Y+2 Z-1", "MM", None),  # no height
        ("X+Q1 Y+2 Z+0", "MM", None),
    ],
)
def test_blank_is_known_when_given_in_numbers(
    second: str, unit: str, corners: tuple[tuple[float, ...], tuple[float, ...]] | None
) -> None:
    ran = run(f"BLK FORM 0.1 Z X+0 Y+0 Z-1\nBLK FORM 0.2 {second}", unit=unit)
    assert not ran.errors
    if corners is None:
        assert ran.state.blank_corners is None
    else:
        assert ran.state.blank_corners is not None
        assert np.allclose(ran.state.blank_corners, corners)


def test_cylinder_blank_is_drawn_as_its_bounding_box() -> None:
    blank = run("BLK FORM CYLINDER Z D100 L80 DIST+5 RI10").state.blank_corners
    assert blank is not None
    assert np.allclose(blank, ((-50.0, -50.0, -75.0), (50.0, 50.0, 5.0)))
    lying = run("BLK FORM CYLINDER X R1 L2", unit="INCH").state.blank_corners
    assert lying is not None
    assert np.allclose(lying, ((-50.8, -25.4, -25.4), (0.0, 25.4, 25.4)))


def test_tool_def_tool_is_used_and_not_missing() -> None:
    """TOOL DEF tells length and radius, the tool table none: it is used all the same, and not missing."""
    text = whole("TOOL DEF 7 L+0 R+4\nTOOL CALL 7 Z S100 DR2:+0.05\nTOOL CALL 1 Z")
    program = read_program(ProgramSource("T.H", text))
    setup = InterpreterSetup(
        kinematics=AC, start=HOME, limits=ControlLimits(max_rpm=12000.0), tools={1: ToolOffset()}
    )
    interpreter = Interpreter(program, setup, AC)
    list(interpreter.generate_blocks())
    assert (interpreter.used_tools, interpreter.tools_without_offset) == ([7, 1], [])
    assert interpreter.diagnostics == []
