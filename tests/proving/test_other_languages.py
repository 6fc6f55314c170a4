"""What is checked of cuts in every language, and what a proof says of names and of modulo axes."""

from __future__ import annotations

import copy
import pickle

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.proving.proof_pass import find_modulo_angle_range
from core.proving.proof_report import ProofReport
from core.proving.prove_program import prove
from core.tool_edges import (
    FIRST_NAMED_TOOL,
    NamedToolNumber,
    format_edge_name,
    get_tool_number,
    make_edge_row_number,
)

LATHE, MILL = load_shipped_machine("sinumerik-modulo"), load_shipped_machine("ac-table-mill")


def turned(text: str) -> ProofReport:
    """The proof of a SINUMERIK program with T1."""
    tools = {1: ToolOffset()}
    return prove(
        ProgramSource("a.mpf", text),
        create_power_up_setup(LATHE, tool_offsets=tools, secondary_offsets={}),
        LATHE,
    )


def milled(text: str) -> ProofReport:
    """The proof of a Klartext program with tool 1."""
    tools = {1: ToolOffset()}
    whole = f"BEGIN PGM A MM\n{text}\nEND PGM A MM\n"
    return prove(
        ProgramSource("a.h", whole),
        create_power_up_setup(MILL, tool_offsets=tools, secondary_offsets={}),
        MILL,
    )


def found(report: ProofReport, code: str) -> list[tuple[int, str]]:
    return [(each.line, str(each.severity)) for each in report.diagnostics if each.code == code]


CUT = "G0 X30 Z2\nG94 G1 Z-10 F100\n"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (f"S1000 M3\n{CUT}", [(3, "warning")]),
        (f"S1000 M3\n{CUT}T1 D1\n{CUT}", [(3, "error")]),
        (f"T1 D1\nS1000 M3\n{CUT}T0\n{CUT}", [(7, "error")]),
        (f"T1 D1\nS1000 M3\n{CUT}", []),
        ("S1000 M3\nG0 X30 Z2\nX60", []),
    ],
)
def test_turned_cut_without_tool_is_reported(text: str, told: list[tuple[int, str]]) -> None:
    assert found(turned(text), "no-tool") == told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("L Z+5 R0 FMAX\nL Z-5 F200", [(3, "warning")]),
        ("L Z+5 R0 FMAX\nL Z-5 F200\nTOOL CALL 1 Z S100\nL Z-9 M3", [(3, "error")]),
        ("TOOL CALL 1 Z S100\nL Z+5 R0 FMAX M3\nL Z-5 F200", []),
    ],
)
def test_milled_cut_without_tool_is_reported(text: str, told: list[tuple[int, str]]) -> None:
    assert found(milled(text), "no-tool") == told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (f"T1 D1\nS1000\n{CUT}", [(4, "warning")]),
        (f"T1 D1\nS1000 M3\nM5\n{CUT}", [(5, "warning")]),
        (f"T1 D1\nS1000 M3\n{CUT}", []),
        ("T1 D1\nSPOS=0\nG0 X30 Z2 C0\nG94 G1 C90 F100", []),
    ],
)
def test_missing_m3_is_reported(text: str, told: list[tuple[int, str]]) -> None:
    around = create_power_up_setup(LATHE, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    report = prove(ProgramSource("a.mpf", text), around, LATHE)
    assert found(report, "spindle-off") == told


def test_named_tool_is_shown_by_name() -> None:
    """Beyond copies, processes and edges: it is shown as the program writes it."""
    report = turned(f'T="Rough er" D1\nS1000 M3\n{CUT}')
    assert [format_edge_name(each) for each in report.tool_numbers] == ['T="Rough er"']
    tool = NamedToolNumber(FIRST_NAMED_TOOL, "ROUGH")
    for same in (
        copy.deepcopy(tool),
        pickle.loads(pickle.dumps(tool)),
        get_tool_number(make_edge_row_number(tool, 2)),
    ):
        assert (same, format_edge_name(same)) == (FIRST_NAMED_TOOL, 'T="ROUGH"')
    assert format_edge_name(make_edge_row_number(tool, 2)) == 'T="ROUGH" D2'
    assert (format_edge_name(3), format_edge_name(make_edge_row_number(3, 2))) == ("T3", "T3 D2")


@pytest.mark.parametrize(
    ("low", "high", "shown"),
    [
        (0.0, 90.0, (0.0, 90.0)),
        (-90.0, 0.0, (270.0, 360.0)),
        (-90.0, 10.0, (0.0, 360.0)),
        (360.0, 450.0, (0.0, 90.0)),
        (0.0, 1080.0, (0.0, 360.0)),
        (725.0, 725.0, (5.0, 5.0)),
    ],
)
def test_modulo_axis_angle_range_is_found(low: float, high: float, shown: tuple[float, float]) -> None:
    assert find_modulo_angle_range(low, high) == pytest.approx(shown)


def test_modulo_axes_are_reported_within_their_range() -> None:
    report = milled("TOOL CALL 1 Z S100\nL A+0 C+0 R0 FMAX\nL IC+810 FMAX")
    assert report.mill_results is not None
    assert dict(zip(report.mill_results.axis_names, report.mill_results.axis_ranges, strict=True))["C"] == (
        0.0,
        360.0,
    )
    assert turned("T1 D1\nG0 X30 Z2\nG0 C=IC(-400)").program_ranges.c_range == (0.0, 360.0)


@pytest.mark.parametrize(("text", "named"), [("T1 D1\nG0 X40 Z-9000", False)])
def test_soft_limit_hint_uses_words_of_program_language(text: str, named: bool) -> None:
    (error,) = turned(text).errors
    assert error.code == "soft-limit"
    assert ("G10" in error.hint, "G54" in error.hint) == (named, True)
