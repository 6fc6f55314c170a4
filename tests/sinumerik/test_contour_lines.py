"""Lines of a CYCLE95 contour: assignments, arcs and words have the same meaning as outside a contour."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.diagnostics import Severity
from core.language.source import Dialect, ProgramSource
from tests.sinumerik.lathe import Passed, good, refused, run, setup, source

START = "S500 M3 G95 F0.2\nG0 X100 Z5\nR0=33\nDEF REAL TAB[3]\n"
FINISHING = 'CYCLE95("{name}",1,,,,0.1,0.1,0.1,5)\n'


def _program(lines: str, after: str = "G0 X100") -> str:
    return f"{START}{FINISHING.format(name='LAA:LBB')}GOTOF LEE\nLAA:\n{lines}\nLBB:\nLEE:\n{after}\nM30"


def _corners(text: str) -> list[tuple[object, object]]:
    """Ends of the feeds of the cycle, which finishes the contour from its first point on."""
    cuts = [block for block in good(text) if block.line == 5 and block.kind is not BlockKind.RAPID]
    return [(pytest.approx(block.x), pytest.approx(block.z)) for block in cuts]


@pytest.mark.parametrize(
    ("assignment", "first", "second"),
    [
        ("R[5]=14", "R5", 7.0),
        ("R[2+3]=14", "R5", 7.0),
        ("R[R0-28]=14", "R5", 7.0),
        ("R[4]=SET(2,14)", "R5", 7.0),
        ("TAB[0]=14", "TAB[0]", 7.0),
        ("TAB[1]=SET(14,2)", "TAB[1]", 7.0),
        ("TAB[0]=REP(14)", "TAB[2]", 7.0),
    ],
)
def test_assignment_in_a_contour_uses_its_index(assignment: str, first: str, second: float) -> None:
    """Diameters 14, 33 and 40 are the radii 7, 16.5 and 20. An assignment once set R0 or nothing."""
    text = _program(f"{assignment}\nG1 X={first} Z2\nX=R0 Z0\nX40 Z-5")
    assert _corners(text)[-3:] == [(second, 2.0), (16.5, 0.0), (20.0, -5.0)]


def test_assignments_in_a_contour_end_with_it() -> None:
    """R0 is 33 and TAB[0] is 0 again: a radius of 16.5."""
    after = "G0 X=R0+TAB[0] Z5"
    blocks = good(_program("R0=8 TAB[0]=SET(1,2)\nG1 X=R0 Z2\nX40 Z0", after))
    assert blocks[-1].x == 16.5


def test_arc_without_end_point_belongs_to_the_contour() -> None:
    """From X20 Z0 about (radius 10, Z-5) by 90 degrees to X30 Z-5."""
    text = _program("G1 X0 Z2\nZ0\nX20\nG3 I0 K-5 AR=90\nG1 X40")
    assert _corners(text)[-3:] == [(10.0, 0.0), (15.0, -5.0), (20.0, -5.0)]


@pytest.mark.parametrize("word", ["RNDM=0", "OFFN=0", "RNDM=0 OFFN=0", "RNDM=R7"])
def test_word_that_cancels_an_inactive_function_is_accepted_in_a_contour(word: str) -> None:
    """R7 is 0, and RNDM=1 before the cycle does not apply in it. Diameter 20 is the radius 10."""
    text = _program(f"G1 X0 Z2\nZ0 {word}\nX20\nX40 Z-5").replace("R0=33", "R7=0 RNDM=1")
    assert _corners(text)[-4:] == [(0.0, 2.0), (0.0, 0.0), (10.0, 0.0), (20.0, -5.0)]


@pytest.mark.parametrize(
    ("lines", "code"),
    [
        ("ABC=7\nG1 X0 Z2\nX20", "12550"),
        ("TAB[3]=7\nG1 X0 Z2\nX20", "17020"),
        ("TAB[2]=SET(1,2)\nG1 X0 Z2\nX20", "array-values"),
        ("R[300]=7\nG1 X0 Z2\nX20", "17020"),
        ("R[1.5]=7\nG1 X0 Z2\nX20", "17020"),
        ("R7=-2\nG1 X0 Z2\nZ0 RND=R7\nX20", "out-of-range"),
        ("RNDM=2\nG1 X0 Z2\nZ0\nX20", "61605"),
        ("R7=2\nG1 X0 Z2\nZ0 RNDM=R7\nX20", "61605"),
        ("OFFN=0.5\nG1 X0 Z2\nZ0\nX20", "61605"),
        ("R7=-1\nG1 X0 Z2\nZ0 RNDM=R7\nX20", "out-of-range"),
        ("G1 X0 Z2\nZ0 Y5\nX20", "61605"),
        ("G1 X0 Z2\nT2\nX20", "61605"),
        ("G1 X0 Z2\nX20 SF=90", "61605"),
    ],
)
def test_invalid_line_of_a_contour_is_rejected(lines: str, code: str) -> None:
    passed = run(_program(lines))
    assert [each.code for each in passed.errors] == [code]
    assert all(block.line < 5 for block in passed.moves)


def _warnings(passed: Passed) -> list[tuple[int, str]]:
    assert passed.errors == []
    return [(each.line, each.code) for each in passed.found if each.severity is Severity.WARNING]


def test_contour_shows_its_warnings() -> None:
    """An unset R7 makes the contour begin at X0."""
    assert _warnings(run(_program("G1 X=R7 Z2\nX20 Z0"))) == [(8, "r-unset")]
    assert _warnings(run(_program("G1 X0 Z2\nX20 Z2 RND=1\nX40"))) == [(9, "corner-straight")]


def test_warning_of_a_contour_in_another_file_is_at_the_call() -> None:
    contour = ProgramSource("KONTUR.spf", "G1 X=R7 Z2\nX20 Z0\nM17", Dialect.SINUMERIK)
    passed = run(source(START + FINISHING.format(name="KONTUR"), contour))
    assert _warnings(passed) == [(5, "r-unset")]
    assert "KONTUR.spf line 1" in passed.found[0].message


@pytest.mark.parametrize("lines", ["G1 X0 Z2\nX20 Z0", "R5=0\nG1 AP=90 RP=R5\nAP=90 RP=10"])
def test_cycle_moves_to_programmed_positions_after_a_tool_change(lines: str) -> None:
    """T1 D1 changes the position of the tip, and the cycle then moves both axes: X is known again."""
    blocks = good(_program(lines, "G0 X=IC(2)").replace("TAB[3]", "TAB\nT1 D1"), with_tool())
    assert blocks[-1].x == pytest.approx(blocks[-2].x + 1.0)


def test_contour_after_a_tool_change_cannot_begin_with_a_distance() -> None:
    text = _program("G1 X=IC(2) Z2\nX20 Z0").replace("TAB[3]", "TAB\nT1 D1")
    assert refused(text, with_tool()).code == "distance-behind-tool"


def with_tool() -> InterpreterSetup:
    return replace(setup(), tools={1: ToolOffset(x=5.0, z=3.0, quadrant=3)})
