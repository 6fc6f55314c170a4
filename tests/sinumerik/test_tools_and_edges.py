"""T and D: what they make of positions, by hand; the table that they read; and what is refused."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.interpreter.dialects import interpret_program
from core.interpreter.shared.actions import ToolChange
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset, ZeroOffset
from core.language.diagnostics import Severity
from core.tool_edges import make_edge_row_number
from tests.sinumerik.lathe import good, refused, run, setup, source

TOOLS = {
    1: ToolOffset(30.0, 40.0, 0.8, 3, "ROUGHER"),
    make_edge_row_number(1, 2): ToolOffset(31.0, 36.0, 0.2, 4),
    2: ToolOffset(-5.0, 12.5, 0.4, 2, "Bore 12"),
}


def around(zero: ZeroOffset | None = None) -> InterpreterSetup:
    return replace(setup(zero={54: zero or ZeroOffset(0.0, -200.0)}), tools=TOOLS, start=(100.0, 100.0, 0.0))


def ends(text: str) -> list[tuple[float, float]]:
    return [(block.mx, block.mz) for block in good(text, around())]


def test_tool_length_and_zero_offset_are_added() -> None:
    """X20 is a radius of 10; the slide stands 30 further, and Z -200 + 40 from where Z5 is."""
    assert ends("G54 T1 D1\nG0 X20 Z5") == [(40.0, 5.0 - 200.0 + 40.0)]


def test_t_activates_d1_and_d_selects_another_edge() -> None:
    assert ends("T1\nG0 X20 Z5\nD2\nX20 Z5\nD0\nX20 Z5") == [(40.0, 45.0), (41.0, 41.0), (10.0, 5.0)]


def test_t_and_d_alone_cause_no_motion() -> None:
    """Only the words behind it go to the new place: Z stays where it was."""
    assert ends("T1\nG0 X20 Z5\nT2\nX20") == [(40.0, 45.0), (5.0, 45.0)]


@pytest.mark.parametrize("word", ['T="ROUGHER"', 'T="rougher"', "T=1", "R1=1 T=R1", "T1 D1", "T01"])
def test_tool_can_be_called_in_several_forms(word: str) -> None:
    assert ends(f"{word}\nG0 X20 Z5") == [(40.0, 45.0)]


def test_g53_retains_tool_offset_and_d0_cancels_it() -> None:
    assert ends("G54 T1\nG53 G0 X20 Z5\nSUPA G0 X20 Z5 D0") == [(40.0, 45.0), (10.0, 5.0)]


def test_t0_cancels_the_tool() -> None:
    assert ends("T1\nT0\nG0 X20 Z5") == [(10.0, 5.0)]


def test_used_cutting_edges_are_listed() -> None:
    passed = run("T1\nG0 X20\nD2\nX22\nT2 D1", around())
    assert [block.action.tool for block in passed.blocks if isinstance(block.action, ToolChange)] == [
        1, make_edge_row_number(1, 2), 2,
    ]  # fmt: skip
    program = interpret_program(source("T1\nD2\nT2"), around())
    list(program.generate_blocks())
    assert program.used_tools == [1, make_edge_row_number(1, 2), 2]


@pytest.mark.parametrize("word", ["T7", 'T="NOBODY"'])
def test_tool_without_offset_is_reported_and_blocks_start(word: str) -> None:
    program = interpret_program(source(f"G0 X50\nN20 {word}\nG0 X20"), around())
    list(program.generate_blocks())
    (found,) = program.diagnostics
    assert (found.severity, found.code, found.line) == (Severity.WARNING, "tool-offset-missing", 2)
    assert "the machine will not start" in found.message
    assert "F8" in found.hint
    assert len(program.tools_without_offset) == 1


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("T1\nN30 D3", "17180"),
        ("T1\nD0\nN30 T2 D2", "17180"),
        ("G0 X1\nN30 D1", "17180"),
        ("G0 X1\nN30 T=1/2", "17190"),
        ("R1=32001\nN30 T=R1", "17190"),
        ("R1=-1\nN30 T=R1", "17190"),
        ("T1 R1=10\nN30 D=R1", "17180"),
        ("T1\nN30 D=3/2", "17180"),
        ("T1\nN30 G91 X5", None),
    ],
)
def test_invalid_tools_and_edges_are_rejected(text: str, code: str | None) -> None:
    if code is None:
        assert refused(f"G0 {text}", around()).code == "distance-behind-tool"
        return
    error = refused(text, around())
    assert (error.code, error.line) == (code, text.count("\n") + 1)
    assert error.hint


def test_tool_and_edge_from_a_formula_ignore_its_rounding_error() -> None:
    """0.1 + 0.2 is 0.30000000000000004, so T is 1.0000000000000004 and D is 2.0000000000000004.

    T1 D2 is at radius 10 + 31 and Z5 + 36.
    """
    assert ends("R1=0.1+0.2\nT=R1*10-2 D=R1*10-1\nG0 X20 Z5") == [(41.0, 41.0)]


def test_incremental_move_after_absolute_move_is_accepted() -> None:
    assert ends("T1\nG0 X20 Z5\nG91 X2 Z1") == [(40.0, 45.0), (41.0, 46.0)]


# --- what a program reads of its tool


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("T3 D2\nR1=$P_TOOLNO", 3.0),
        ("T3 D2\nR1=$P_TOOL", 2.0),
        ("T3 D2\nR1=$P_TOOLR", 0.8),
        ("T3 D1\nR1=2*$P_TOOLR", 0.8),
        ("T3 D2\nD0\nR1=$P_TOOLR+$P_TOOL", 0.0),
        ("T3 D2\nT0\nR1=$P_TOOLNO", 0.0),
        ("R1=$P_TOOLNO", 0.0),
    ],
)
def test_program_reads_tool_data(text: str, value: float) -> None:
    tools = {3: ToolOffset(nose_radius=0.4), make_edge_row_number(3, 2): ToolOffset(nose_radius=0.8)}
    ran = run(f"{text}\nG0 Z=R1", replace(setup(), tools=tools))
    assert ran.found == []
    assert ran.moves[-1].z == value


@pytest.mark.parametrize(
    "text", ["R1=$P_TOOLL[1]", "R1=$AA_IM[X]", "R1=$P_AXN1", "G70\nR1=$P_TOOLR", 'T="SOME"\nR1=$P_TOOLNO']
)
def test_other_system_variables_are_refused_by_name(text: str) -> None:
    error = refused(text)
    assert error.code == "system-variable"
    assert text.rpartition("=")[2] in error.message
