"""A fault is told once: what only follows from it, and what repeats it, is not."""

from __future__ import annotations

import pytest

from tests.klartext.running import TOOL, run, run_file, whole

ON = TOOL + "L X+0 Y+0 Z+50 R0 FMAX M3\n"


def told(text: str, tool: str = ON) -> list[tuple[int, str]]:
    return [(each.line, each.code) for each in run(text, tool=tool).errors]


def test_undefined_tool_is_only_error_of_blocks_that_need_it() -> None:
    text = 'TOOL CALL "NOBODY" Z S1000\nL X+0 Y+0 R0 F100 M3\nPLANE AXIAL A+10 TURN FMAX\nL Z-1 F100'
    assert told(text, tool="") == [(2, "Tool not defined")]


def test_rejected_plane_causes_no_error_for_q120() -> None:
    assert told("PLANE AXIAL B+10 STAY\nL A+Q120 C+Q122 R0 FMAX") == [(4, "Wrong axis programmed")]


def test_arc_after_rejected_block_causes_no_error_for_start_point() -> None:
    assert told("L X+Q7 Y+0 F100\nCC X+0 Y+0\nC X+0 Y+10 DR+") == [(4, "Q parameter not defined")]
    assert told("L X+20 Y+0 F100\nCC X+0 Y+0\nC X+0 Y+10 DR+") == [(6, "Circle end point incorrect")]


def test_undefined_parameter_is_reported_once() -> None:
    assert told("Q2 = Q1 + 1\nQ3 = Q2 * 2\nL X+Q3 F100\nL Y+Q1\nL Z+Q9") == [
        (4, "Q parameter not defined"),
        (8, "Q parameter not defined"),
    ]


def test_blocks_after_jump_without_value_report_no_errors() -> None:
    """Q5 is unknown: whether L X+Q6 is run at all is, too."""
    assert told("FN 9: IF +Q5 EQU +1 GOTO LBL 9\nL X+Q6 F100\nLBL 9") == [(4, "Q parameter not defined")]


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("FPOL X+0 Y+0\nFL X+0 Y+50\nFC DR+ R15\nFSELECT 1", 1),
        ("TCH PROBE 0.0 REF.\nTCH PROBE 0.1 X-2 Y+3", 1),
        ("CYCL DEF 30.0 3D DATA\nCYCL DEF 30.1 PGM A\nCYCL DEF 30.2 X+0 Y+0", 1),
        ("L M55\nL X+1 M55\nL X+2 M56", 2),
        ("CYCL DEF 9.1 V.TIME\nL X+Q5 F100\nSTOP X", 2),
        ("TCH PROBE 0.0 REF.\nTCH PROBE 0.1 X-2\nTCH PROBE 411 RECTANGLE", 2),
    ],
)
def test_one_construct_causes_one_error(text: str, count: int) -> None:
    assert len(told(text)) == count


def test_independent_errors_are_all_reported() -> None:
    assert told("L X+Q1 F100\nL M55\nPLANE AXIAL A+200 TURN FMAX\nL Z+Q2") == [
        (4, "Q parameter not defined"),
        (5, "M function not defined"),
        (6, "Entered angle not permitted"),
        (7, "Q parameter not defined"),
    ]


def test_unreadable_block_suppresses_errors_that_depend_on_it() -> None:
    ran = run_file(whole("TOOL CALL 1 Z W5 S1000\nL X+0 Y+0 R0 F100 M3\nL X+Q1 F100"))
    assert [each.line for each in ran.errors] == [2, 4]
