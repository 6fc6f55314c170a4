"""What is refused, by the name the control gives it, and that nothing has moved or changed then."""

from __future__ import annotations

import pytest

from core.geometry.rotary_axes import Kinematics
from tests.klartext.running import TOOL, run, run_file, whole
from tests.klartext.table import AC, ORIGIN, SLIDES, A

ANGLE = "Entered angle not permitted"
INPUT = "Input value incorrect"
PLANE = "Plane wrongly defined"
SYNTAX = "Syntax error"
FEED = "Feed rate is missing"
UNSUPPORTED = "Not supported"
COMPENSATION = "Radius compensation not permitted here"
MISSING = "Cycle incomplete"
ARC = "Circle end point incorrect"
DIRECTION = "Direction of rotation not defined"
TAIL = "TURN MB MAX FMAX"
FLAT = "P1X+0 P1Y+0 P1Z+0 P2X+1 P2Y+0 P2Z+0"


def points(*third: object) -> str:
    x, y, z = third
    return f"PLANE POINTS {FLAT} P3X{x} P3Y{y} P3Z{z} {TAIL}"


@pytest.mark.parametrize(
    ("block", "code", "names"),
    [
        (f"PLANE POINTS P1X+0 P1Y+0 P1Z+0 P2X+1 P2Y+0 P3X+0 P3Y+1 P3Z+1 {TAIL}", SYNTAX, "P2Z is missing"),
        (f"PLANE POINTS {FLAT} P3X+0 P3Y+1 P3Z+1", SYNTAX, "MOVE, TURN or STAY"),
        (f"PLANE POINTS P1X+1 P1Y+1 P1Z+1 P2X+1 P2Y+1 P2Z+1 P3X+0 P3Y+1 P3Z+1 {TAIL}", PLANE, "second"),
        (points("+0", "+0", "+0"), PLANE, "third"),
        (f"PLANE POINTS {FLAT.replace('P2X+1', 'P2X+0')} P3X+0 P3Y+0 P3Z+0 {TAIL}", PLANE, "same"),
        (points("+5", "+0", "+0"), PLANE, "one straight line"),
        (points("-5", "+0", "+0"), PLANE, "one straight line"),
        (points("+1000", "+0.0001", "+0"), PLANE, "one straight line"),
        (points("+0", "-1", "+0"), ANGLE, "this plane"),
        (points("+0", "+1", "+1").replace("P1X+0", "P1X+1000000000"), INPUT, "P1X"),
        (f"{points('+0', '+1', '-1')} SYM+ SEQ-", SYNTAX, "SYM or SEQ"),
        (f"{points('+0', '+1', '-1')} COORD ROT TABLE ROT", SYNTAX, "COORD ROT"),
        ("PLANE AXIAL TURN FMAX", SYNTAX, "axis angle"),
        ("PLANE AXIAL B+10 TURN FMAX", "Wrong axis programmed", "B"),
        ("PLANE AXIAL A+45 A+30 TURN FMAX", SYNTAX, "A is programmed twice"),
        ("PLANE AXIAL A+45 IA+30 TURN FMAX", SYNTAX, "IA is programmed twice"),
        ("PLANE AXIAL A+121 TURN FMAX", ANGLE, "A +121"),
        ("PLANE AXIAL A+100000000 TURN FMAX", INPUT, "A "),
        ("PLANE AXIAL C-100000000 TURN FMAX", INPUT, "C "),
        (f"PLANE AXIAL A+45 {TAIL} SYM+ SEQ-", SYNTAX, "SYM or SEQ"),
        ("PLANE AXIAL A+45 STAY MB MAX", SYNTAX, "MB"),
        ("PLANE AXIAL A+45 STAY FMAX", SYNTAX, "F"),
        ("PLANE AXIAL A+45 STAY DIST50", SYNTAX, "DIST"),
        ("PLANE AXIAL A+45 TURN DIST50 FMAX", SYNTAX, "DIST"),
        ("PLANE AXIAL A+45 TURN MOVE FMAX", SYNTAX, "MOVE"),
        ("PLANE AXIAL A+45 FMAX", SYNTAX, "MOVE, TURN or STAY"),
        ("PLANE AXIAL A+45 TURN MB FMAX", SYNTAX, "MB has no number"),
        ("PLANE AXIAL A+45 TURN F0", INPUT, "F"),
        ("PLANE AXIAL A+45 TURN MB-5 FMAX", INPUT, "MB"),
        ("PLANE AXIAL A+45 MOVE DIST-5 FMAX", INPUT, "DIST"),
        ("PLANE AXIAL A+45 TURN FMAX Q5", SYNTAX, "Q5"),
        ("PLANE AXIAL A+Q7 TURN FMAX", "Q parameter not defined", "Q7"),
        ("PLANE SPATIAL SPA+45 SPC+0 TURN FMAX", SYNTAX, "SPB is missing"),
        ("PLANE SPATIAL SPA+360 SPB+0 SPC+0 TURN FMAX", INPUT, "SPA"),
        ("PLANE RELATIV TURN FMAX", SYNTAX, "one of SPA"),
        ("PLANE RELATIV SPA+1 SPB+1 TURN FMAX", SYNTAX, "one of SPA"),
        ("PLANE RESET SYM+", SYNTAX, "MOVE, TURN or STAY"),
        ("PLANE RESET TURN FMAX SYM+", SYNTAX, "SYM+"),
        ("PLANE TURN FMAX", SYNTAX, "AXIAL"),
        ("PLANE VECTOR BX+0 BY+0 BZ+1 NX+0 NY+0 NZ+1 TURN FMAX", PLANE, "parallel"),
        ("PLANE VECTOR BX+0 BY+0 BZ+0 NX+0 NY+0 NZ+1 TURN FMAX", PLANE, "zero length"),
        ("PLANE VECTOR BX+0 BY+0 NX+0 NY+0 NZ+1 TURN FMAX", SYNTAX, "BZ is missing"),
        ("PLANE EULER EULPR+1 EULNU+1 TURN FMAX", SYNTAX, "EULROT is missing"),
        ("PLANE PROJECTED PROPR+90 PROMIN+1 ROT+1 TURN FMAX", PLANE, "90 degrees"),
        ("L B+10 FMAX", "Wrong axis programmed", "B"),
        ("L X+100000 FMAX", INPUT, "X"),
        ("L X+10 RL F100\nPLANE RESET STAY", COMPENSATION, "PLANE"),
        ("L X+10 RL F100\nL X+20\nL X+30 RR", COMPENSATION, "RL is active"),
        ("L X+10 RL F100\nL X+20\nL A+5", COMPENSATION, "rotary axis"),
        ("L X+10 RL F100\nCYCL DEF 9.0 DWELL", COMPENSATION, "CYCL"),
        ("L X+10 F AUTO M128\nM3 M4", "Contradictory entry", "spindle"),
        ("L X+10 FMAX M3 M8 M5 M9 M30", SYNTAX, "more than 4"),
        ("L X+10 FMAX M3 M3", SYNTAX, "M3 is programmed twice"),
        ("L X+10 FMAX M89", MISSING, "No machining cycle"),
        ("L X+10 FMAX M92", "M function not defined", "M92"),
        ("M7", "M function not defined", "M7"),
        ("M104", UNSUPPORTED, "M104"),
        ("TOOL CALL 5.1 Z S100", "Tool not defined", "does not contain tool 5.1"),
        ("TOOL DEF 5.1", "Tool not defined", "does not contain tool 5.1"),
        ("TCH PROBE 412 DATUM INSIDE CIRCLE ~\nQ321=+0", "No touch probe", "TCH PROBE 412"),
        ("TCH PROBE 0.0 REF. PLANE Q5 X-", "No touch probe", "TCH PROBE 0.0"),
        ("CYCL DEF 392 ATC ~\n Q240=0", "Cycle not defined", "392"),
        ("TOOL CALL Q5 Z S100", "Q parameter not defined", "Q5"),
        ("BLK FORM CYLINDER Z R50", SYNTAX, "and L"),
        ("BLK FORM CYLINDER Z R50 R40 L10", SYNTAX, "R is programmed twice"),
        ("BLK FORM CYLINDER Z R50 L10 HIGH", SYNTAX, "HIGH"),
        ("LP PR+10 PA+0 FMAX", "CC missing", "CC"),
        ("CYCL DEF 275 TROCHOIDAL", UNSUPPORTED, "CYCL DEF 275"),
        ("CYCL DEF 251 POCKET\nCYCL CALL", MISSING, "Q218"),
        ("CYCL CALL", MISSING, "No machining cycle"),
        ("CYCL DEF 200 DRILLING\nCYCL CALL", MISSING, "Q201"),
        ("CALL PGM TNC:\\X.H", "Program not found", "X.H"),
        ("FN 1: Q5 = +Q1 + +2", "Q parameter not defined", "Q1"),
        ("FN 4: Q5 = +2 DIV +0", "Arithmetical error", "zero"),
        ("FN 17: SYSWRITE ID1 NR1 = +0", UNSUPPORTED, "FN 17"),
        ("FN 18: SYSREAD Q1 = ID9999 NR1", UNSUPPORTED, "ID9999"),
        ("FN 14: ERROR = 1005", "Error raised by the program", "1005"),
        ("FN 20: WAIT FOR I95==0", UNSUPPORTED, "PLC"),
        ("FN 29: PLC = +1", UNSUPPORTED, "PLC"),
        ("FN 37: EXPORT Q1", UNSUPPORTED, "EXPORT"),
        ("FN 9: IF +1 EQU +1 GOTO LBL 9", "Label not found", "LBL 9"),
        ("Q5 = +2 * ", SYNTAX, "number or a parameter"),
        ("Q5 = (2 + 3", SYNTAX, "closing parenthesis"),
        ("Q5 = 2 3", SYNTAX, "operator"),
        ("Q5 = SQRT -4", "Arithmetical error", "square root"),
        ("Q2000 = 1", SYNTAX, "Q1999"),
        ("TOOL CALL 2 X S100", UNSUPPORTED, "tool axis X"),
        ('TOOL CALL "MILL" Z S100', "Tool not defined", "MILL"),
        ("TOOL CALL 2 Z S20000", "Wrong rpm", "S20000"),
        ("TOOL CALL 0 Z S0\nM3", "Wrong rpm", "M3"),
        ("TRANS DATUM X+10", SYNTAX, "AXIS or RESET"),
        ("CALL LBL 7", "Label not found", "LBL 7"),
        ("LBL 3\nCALL LBL 3\nLBL 0", "Excessive nesting", "LBL 3"),
        ("LBL 3\nM8\nCALL LBL 3", SYNTAX, "no LBL 0"),
        ("LBL 3\nLBL 3", "Label defined twice", "LBL 3"),
        ("FOO X+1", SYNTAX, "FOO"),
        ("M128\nPLANE AXIAL A+45 TURN FMAX", "PLANE not permitted with M128", "M129"),
        ("M128\nTOOL CALL 2 Z S100", "Not permitted with M128", "TOOL CALL"),
        ("M128\nL Z-10 FMAX M91", "Not permitted with M128", "M91"),
        ("M128\nL Z-10 FMAX M92", "Not permitted with M128", "M92"),
        ("C X+10 Y+0 DR+ FMAX", "CC missing", "CC"),
        ("CC X+10 Y+0\nC X+5 Y+0 DR+ FMAX", ARC, "5 mm from the pole"),
        ("L X+0 Y+0 FMAX\nCC X+10 Y+0\nC X+20 Y+0 FMAX", DIRECTION, "DR+"),
        ("CC X+0 Y+0\nL X+0 Y+0 FMAX\nCP IPA+90 DR+ FMAX", ARC, "on the pole"),
        ("CC X+10 Y+0\nCP IPA+90 DR- FMAX", DIRECTION, "IPA"),
        ("CR X+10 Y+0 R+4 DR+ FMAX", ARC, "cannot connect two points"),
        ("CR X+10 Y+0 DR+ FMAX", SYNTAX, "CR needs R"),
        ("L X+10 DR+ FMAX", SYNTAX, "L does not accept DR"),
        ("CT X+10 Y+10 FMAX", "Path function not possible here", "direction"),
        ("RND R5", "Rounding not possible", "must follow a path"),
        ("L X+10 FMAX\nRND R5", "Rounding not possible", "must be followed by a path"),
        ("L X+10 FMAX\nRND R5\nL Z+5 FMAX", "Rounding not possible", "must be followed by a path"),
        ("L X+10 RR F99\nL Y+60\nRND R2\nL X+30 R0", "Rounding not possible", "must be followed by a path"),
        ("L X+10 RR F99\nL Y+60\nCHF 2\nDEP LT LEN10", "Rounding not possible", "must be followed by a path"),
        ("L X+0 Y+0 FMAX\nL X+10 FMAX\nRND R20\nL Y+10 FMAX", "Rounding not possible", "too short"),
        ("L Z-5 FMAX M91 M92", "Contradictory entry", "different datums"),
        ("L X+0 Y+0 FMAX\nL X+10 FMAX\nCHF 20\nL Y+10 FMAX", "Rounding not possible", "too short"),
        ("FUNCTION TCPM F TCP AXIS SPAT PATHCTRL AXIS", UNSUPPORTED, "AXIS SPAT"),
        ("FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR", UNSUPPORTED, "VECTOR"),
        ("FUNCTION TCPM FOO", SYNTAX, "FOO"),
        ("M138", UNSUPPORTED, "M138"),
        ("M144", UNSUPPORTED, "M144"),
        ("TRANS SCALE SCL0", INPUT, "factor"),
        ("TRANS FOO", SYNTAX, "MIRROR"),
        ("PLANE AXIAL A+45 TURN F AUTO\nTOOL CALL 1 Z S100\nPLANE AXIAL A+50 TURN F AUTO", FEED, "TOOL CALL"),
    ],
)
def test_invalid_block_is_rejected(block: str, code: str, names: str) -> None:
    ran = run(block)
    assert ran.codes[:1] == [code]
    assert names in ran.errors[0].message + ran.errors[0].hint
    assert ran.errors[0].message.startswith(code)


@pytest.mark.parametrize(
    "block",
    [
        points("+1000", "+0.01", "+0"),
        "PLANE AXIAL A+45 TURN SYM- TABLE ROT FMAX",
        "PLANE AXIAL A+120 TURN FMAX",  # the end of the range is inside
        "PLANE RESET",
        "PLANE RESET STAY",
        "plane axial a+45 c-10,5 turn mb50 fmax",
        "PLANE AXIAL A+45 MOVE DIST 10 MB MAX F AUTO",
        "PLANE SPATIAL SPA+359.9999 SPB+0 SPC+0 TURN FMAX",
        "M128\nM129\nPLANE AXIAL A+45 TURN FMAX",
        "M126",
        "M127",
        "CYCLE DEF 9.0 DWELL TIME\nCYCLE DEF 9.1 5",
        "CYCL DEF9 .0 DWELL\nCYCL DEF9.1 DWELL5",
        ";A comment that is longer ~\n than a line holds ~\n and goes on",
        "Q5 = 1\nTOOL CALL Q5 Z S100",
        "BLK FORM ROTATION Z DIM_R LBL1",
    ],
)
def test_valid_block_is_accepted(block: str) -> None:
    assert run(block).codes == []


def test_plane_needs_tool_axis_and_plane_reset_does_not() -> None:
    assert run("M129\nM140 MB MAX\nPLANE RESET STAY\nCYCL DEF 19.0 PLANE\nCYCL DEF 19.1", tool="").codes == []
    assert run("PLANE AXIAL A+45 TURN FMAX", tool="").codes == ["Tool axis is missing"]
    assert run("PLANE AXIAL A+45 TURN FMAX", tool="TOOL CALL 1 S100\n").codes == ["Tool axis is missing"]


def test_move_without_feed_is_rejected() -> None:
    no_feed = "TOOL CALL 1 Z S3000\n"
    assert run("PLANE AXIAL A+45 TURN", tool=no_feed).codes == [FEED]
    assert run("PLANE AXIAL A+45 MOVE", tool=no_feed).codes == [FEED]
    assert run("PLANE RESET TURN", tool=no_feed).codes == [FEED]
    assert run("PLANE AXIAL A+45 STAY", tool=no_feed).codes == []
    assert run("L X+1 F100\nPLANE AXIAL A+45 TURN", tool=no_feed).codes == []
    assert run("L X+1", tool=no_feed).codes == [FEED]
    assert run("L X+1 FMAX\nL X+2", tool=no_feed).codes == [FEED]  # FMAX holds for its own block


def test_rejected_plane_leaves_active_plane_and_axes_unchanged() -> None:
    ran = run("PLANE AXIAL A+100 TURN FMAX\nPLANE AXIAL IA+30 TURN MB MAX FMAX")
    assert ran.codes == [ANGLE]
    assert ran.errors[0].line == 4
    assert ran.state.position_by_axis["A"] == 100.0
    assert ran.state.q_values[120] == 100.0
    assert ran.state.active_plane is not None
    assert ran.state.active_plane.line_number == 3
    assert len(ran.planes) == 1


def test_rejected_plane_without_feed_leaves_q120_unset() -> None:
    ran = run("PLANE AXIAL A+45 TURN", tool="TOOL CALL 1 Z S3000\n")
    assert 120 not in ran.state.q_values
    assert ran.state.active_plane is None


def test_chamfers_across_a_single_axis_are_refused() -> None:
    single = Kinematics(SLIDES, (A,), ORIGIN, axis_order=("X", "Y", "Z", "A"))
    ran = run(f"PLANE POINTS P1X+0 P1Y+0 P1Z+0 P2X+0 P2Y+1 P2Z+0 P3X-1 P3Y+0 P3Z+1 {TAIL}", single)
    assert ran.codes == [ANGLE]


def test_syntax_error_has_line_and_column() -> None:
    text = "BEGIN PGM T MM\n" + TOOL + "  12 PLANE AXIAL A+45 TURN MB MAX FMAX SYM+ SEQ-\nEND PGM T MM\n"
    (error,) = run_file(text, AC).errors
    assert (error.line, error.column) == (3, 45)


@pytest.mark.parametrize(
    ("text", "names", "line"),
    [
        ("L X+1 FMAX\nEND PGM T MM\n", "BEGIN PGM", 1),
        ("BEGIN PGM T MM\nM5\n", "END PGM", 2),
        ("BEGIN PGM T\nEND PGM T MM\n", "MM or INCH", 1),
        ("BEGIN PGM T MM\nEND PGM T INCH\n", "different units", 2),
        ("BEGIN PGM T MM\nBEGIN PGM T MM\nEND PGM T MM\n", "twice", 2),
        ("BEGIN PGM T MM\nEND PGM T MM\nM5\n", "after END PGM", 3),
    ],
)
def test_program_without_begin_or_end_is_rejected(text: str, names: str, line: int) -> None:
    (error,) = run_file(text).errors
    assert error.code == SYNTAX
    assert names in error.message
    assert error.line == line


def test_end_pgm_with_other_name_causes_warning() -> None:
    assert run_file("BEGIN PGM T MM\nM5\nEND PGM U MM\n").warned == ["program-name"]


def test_no_block_follows_an_error_and_all_errors_are_reported() -> None:
    ran = run("PLANE AXIAL B+1 TURN FMAX\nL X+1 FMAX\nPLANE AXIAL A+121 TURN FMAX")
    assert ran.codes == ["Wrong axis programmed", ANGLE]
    assert [block.line for block in ran.blocks] == [2]


def test_lower_case_and_decimal_commas_are_accepted() -> None:
    ran = run_file(whole(TOOL + "l x+1,5 r0 fmax").lower())
    assert not ran.errors
    assert ran.state.position_by_axis["X"] == pytest.approx(231.5)


@pytest.mark.parametrize(
    "first", ["%PART G71 *", "% 12 G70 *", "N10 G30 G17 X+0 Y+0 Z-40 *", "N5 T1 G17 S500 *"]
)
def test_din_iso_program_is_reported_once(first: str) -> None:
    ran = run_file(f"\n{first}\nN20 G31 X+100 Y+100 Z+0 *\nN30 G00 Z+50 *\nN99 %PART G71 *\n")
    assert [(error.line, error.code) for error in ran.errors] == [(2, UNSUPPORTED)]
    assert "DIN/ISO" in ran.errors[0].message
    assert not ran.blocks
