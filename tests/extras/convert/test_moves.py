"""Moves, spindle, tools and M codes of other controls as OmniTurn lines, calculated by hand."""

from __future__ import annotations

import pytest

from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.proof.conversion_proof import prove
from core.interpreter.shared.job_setup import ControlLimits
from core.language.diagnostics import Severity
from tests.extras.convert.sources import LINUXCNC, converted, lines_after, refused


def test_small_fanuc_program_is_converted_line_by_line() -> None:
    done = converted(
        "%\nO1000(PIN)\nG20G40G99\nG28U0W0\nN10T0101\nG50S2500\nG96S400M03\nG00X2.1Z.1M08\n"
        "G01Z0F.01\nX-.06F.006\nG00Z.1M09\nG28U0W0\nM30\n%\n"
    )
    assert [each.text for each in done.lines] == [
        "G90G94F300G70G72", "T0", "G00X0Z0", "T1", "G77S2500", "G96M03S400", "M08", "X2.1Z.1",
        "G95F.01Z0", "G95F.006X-.06", "G00Z.1", "M09", "T0", "X0Z0", "M30",
    ]  # fmt: skip
    assert [each.source_line_number for each in done.lines] == [
        4,
        4,
        4,
        5,
        7,
        7,
        8,
        8,
        9,
        10,
        11,
        11,
        12,
        12,
        13,
    ]
    assert [(each.code, each.line, each.column) for each in done.findings] == [("no-change", 3, 4)]  # G40
    assert done.proof.rounded_move_count == 0


@pytest.mark.parametrize(
    ("source", "made"),
    [
        ("G01U-.5W-.1", "G95F.01X1.5Z0"),
        ("G01X1.W-.1", "G95F.01X1Z0"),
        ("G98G01Z0F10.", "G94F10Z0"),
        ("G04P500", "G04F.5"),
        ("G04X1.5", "G04F1.5"),
        ("M00(TURN THE PART)", "M00(TURN THE PART)"),
        ("M25", "M25"),
        ("G02X2.5Z-.15R.25", "G95F.01G03X2.5Z-.15I.25K0"),  # convex from the right: concave corner
        ("G03X2.5Z-.15I0K-.25", "G95F.01G02X2.5Z-.15I0K-.25"),
    ],
)
def test_fanuc_line_is_converted(source: str, made: str) -> None:
    assert lines_after(source) == [made]


def test_arcs_of_a_front_tool_post_retain_their_direction() -> None:
    assert lines_after("G02X2.5Z-.15I0K-.25", front=True) == ["G95F.01G02X2.5Z-.15I0K-.25"]


def test_linuxcnc_program_has_no_front_tool_post() -> None:
    """LinuxCNC calculates arcs in Z and X, whatever side the tool post is on."""
    done = converted(f"{LINUXCNC}G2X2.5Z-.15I0K-.25\nM2\n", "linuxcnc", front=True)
    assert [each.code for each in done.errors] == ["tool-post"]


def test_linuxcnc_radius_mode_is_doubled() -> None:
    assert lines_after("G8\nG1X.5\nG7\nG1Z0", "linuxcnc") == ["G95F.01X1", "Z0"]


def test_chamfer_and_radius_are_inserted_between_straight_moves() -> None:
    # From X2. Z.1 to Z-1., then to X3.: set back .05 on both lines, then an arc of .1 about (X2.8, Z-1.1)
    made = lines_after("G01Z-1.,C.05\nX3.,R.1\nZ-2.")
    assert made == ["G95F.01Z-.95", "X2.1Z-1", "X2.8", "G02X3Z-1.1I0K-.1", "Z-2"]


def test_metric_lengths_without_a_point_need_an_option() -> None:
    text = "G21G98\nT0101\nG97S500M03\nG00X50000Z2000\nG01Z-1500F100\nM30\n"
    (error,) = converted(text).errors
    assert (error.line, error.column, error.code) == (4, 4, "no-point")
    least = [each.text for each in converted(text, no_point=0.001).lines]
    assert least[3:5] == ["G00X50Z2", "G94F100Z-1.5"]


def test_fine_coordinates_are_rounded_and_counted() -> None:
    done = converted("G20G99\nT0101\nG97S500M03\nG00X1.00004Z.1\nG01Z0F.01\nM30\n")
    assert not done.errors
    assert done.proof.rounded_move_count == 2  # the start of the second move has the same X
    assert done.proof.max_rounding_mm == pytest.approx(0.00002 * 25.4)


def test_single_pass_threads_become_g33_with_o() -> None:
    made = lines_after("G00X1.2Z.2\nX.9\nG32Z-1.F.05\nG00X1.2\nZ.2\nX.88\nG32Z-1.\nG00X1.2\nZ.2")
    assert made == ["X1.2Z.2", "X1.1997", "G33X.9Z-1I.0001K.05O", "G33X.88Z-1I.0001K.05O"]


def test_the_first_moves_after_a_tool_are_joined_with_a_warning() -> None:
    done = converted("G20G99\nT0101\nG97S500M03\nG00X2.\nZ.1\nG01Z0F.01\nM30\n")
    assert [each.text for each in done.lines][3] == "G00X2Z.1"
    assert [(each.line, each.code, each.severity) for each in done.findings] == [
        (4, "approach-joined", Severity.WARNING)
    ]


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("G01X1.Z", (1, 8, "expression")),
        ("G12.1", (1, 1, "c-axis")),
        ("G01X1.C30.H2.", (1, 11, "c-axis")),
        ("G37Z0", (1, 1, "code-unknown")),
        ("M77", (1, 1, "m-code")),
        ("G54\nG55", (2, 1, "work-offset")),
        ("G02X2.1Z0", (1, 1, "arc-centre")),
        ("G02X3.Z0R.1", (1, 9, "arc-too-small")),
        ("G02X3.Z0I.1K0", (1, 1, "arc-radius")),
        ("G01Z-1.,R3.\nX3.", (1, 8, "corner")),
        ("T4000", (1, 1, "tool-number")),
        ("G32Z-1.F.1\nG01X3.", (1, 1, "thread-chain")),
        ("X#500", (1, 2, "variable")),
        ("X[1/0]", (1, 2, "division")),
        ("M98P2000", (1, 4, "subprogram")),
        ("GOTO99", (1, 5, "label")),
        ("(NO END", (1, 1, "parentheses")),
        ("G01Z0F12", (1, 6, "feed-no-point")),
    ],
)
def test_unconvertible_word_is_reported_with_its_position(source: str, found: tuple[int, int, str]) -> None:
    assert refused(source) == found


def test_an_increment_from_an_unknown_position_is_rejected() -> None:
    (error,) = converted("G20G99\nT0101\nG97S500M03\nG01U.1F.01\nM30\n").errors
    assert (error.line, error.column, error.code) == (4, 4, "position")


def test_a_program_without_a_unit_is_rejected_unless_the_unit_is_given() -> None:
    text = "G99\nT0101\nG97S500M03\nG00X2.Z.1\nG01Z0F.01\nM30\n"
    assert [each.code for each in converted(text).errors] == ["unit"]
    assert "G71" in converted(text, metric=True).lines[0].text


def test_an_error_of_the_target_is_reported_at_the_source_line() -> None:
    done = converted(
        "G20G99\nT0101\nG97S500M03\nG00X2.Z.1\nG01Z0F.01\nG00X2.2Z.2\nX1.9\nG32Z-1.F.5\nG00X2.2\nM30\n"
    )
    assert [(each.line, each.code) for each in done.errors] == [(8, "target")]


def test_proof_detects_a_difference() -> None:
    """The proof must not depend on the writer: with another step, it fails."""
    text = "G90G94F300G70G72\nG00X1Z.1\nM30\n"
    steps = [PathStep(StepKind.RAPID, 7, 12.7, 2.54), PathStep(StepKind.END, 8, number=30)]
    assert prove(text, [7, 7, 8], steps, ControlLimits(), is_metric=False).errors == ()
    steps[0] = PathStep(StepKind.RAPID, 7, 12.71, 2.54)
    (error,) = prove(text, [7, 7, 8], steps, ControlLimits(), is_metric=False).errors
    assert (error.line, error.code) == (7, "proof-differs")
    steps[:1] = [PathStep(StepKind.RAPID, 7, 12.7, 2.54), PathStep(StepKind.RAPID, 7, 12.8, 2.54)]
    assert prove(text, [7, 7, 8], steps, ControlLimits(), is_metric=False).errors


def test_surface_speed_before_the_unit_is_known_is_rejected() -> None:
    """S300 is 300 ft/min or 300 m/min; the G21 of a later line does not decide which."""
    text = "G99\nT0101\nG96S300M03\nG21\nG00X50.Z2.\nG01Z-5.F.1\nM30\n"
    (error,) = converted(text).errors
    assert (error.line, error.column, error.code) == (3, 4, "unit")
