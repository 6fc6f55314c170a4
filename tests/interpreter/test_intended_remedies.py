"""One finding for each mistake, at its place, with the word that its author meant."""

from __future__ import annotations

import pytest

from core.language.diagnostics import Diagnostic
from tests.interpreter.programs import passed

HEAD = "G90G94F300\nT1\nX.6Z.1\n"


def findings(text: str) -> list[Diagnostic]:
    """Return what the interpreter finds in a program."""
    return list(passed(text).interpreter.diagnostics)


@pytest.mark.parametrize(
    ("line", "column", "code", "remedy"),
    [
        ("G04P500", 1, "other-control", "G04F.5."),
        ("G04P1.5", 1, "other-control", "G04F1.5."),
        ("G04X.5", 1, "other-control", "G04F.5."),
        ("G04U2", 1, "other-control", "G04F2."),
        ("G71U.05R.02", 1, "other-control", "G75InUnFn"),
        ("G72W.05R.02", 1, "other-control", "G75InUnFn"),
        ("G73U.1W.1R3", 1, "other-control", "G75InUnFn"),
        ("G70P10Q20", 1, "other-control", "G75"),
        ("G76P010060Q50", 1, "other-control", "G33XnZnInKn"),
        ("G76X.4Z-.5P500Q100F.05", 1, "other-control", "G33XnZnInKn"),
        ("G74R.02", 1, "other-control", "G83ZnKnFn"),
        ("G75R.02", 1, "other-control", "G74"),
        ("G83Z-.5Q.1F5", 1, "other-control", "K.1"),
        ("G92S2500", 1, "other-control", "G77S2500"),
        ("M98P1L2", 1, "other-control", "LS2"),
        ("X1/2Z1", 1, "other-control", "X.5."),
        ("Z-.1X3/8", 5, "other-control", "X.375."),
        ("G7", 1, "other-control", "G72."),
        ("G28U0W0", 1, "g-unknown", "Move to an X and Z position clear of the part."),
        ("X1G54", 3, "g-unknown", "G10XnZn"),
        ("XlZ1", 2, "letter-l", "X1."),
        ("X.lZ1", 3, "letter-l", "X.1."),
        ("X.5Z1l", 6, "letter-l", "Z11."),
        ("G9O", 3, "letter-o", "G90."),
        ("MO5", 2, "letter-o", "M05."),
        ("X1.O5", 4, "letter-o", "X1.05."),
        ("X.5F-.003", 4, "out-of-range", "sign"),
        ("T33", 1, "tool-number", "T0"),
        ("%", 1, "transfer-line", "Delete"),
        ("X.5(OUT (SIDE) CUT)", 9, "comment-nested", "inner"),
        ("M2\nX.7", 1, "m-digits", "M02."),
        ("G02X1.2Z-.1\nI.05K0", 1, "arc-centre-missing", "I.05K0"),
        ("G90G03X1.2Z-.1(ARC)\nI0K.05(CENTER)", 4, "arc-centre-missing", "I0K.05"),
    ],
)
def test_line_gets_one_error_with_code_of_intended_word(
    line: str, column: int, code: str, remedy: str
) -> None:
    errors = [each for each in findings(f"{HEAD}{line}\nM30\n") if each.severity == "error"]
    assert [(each.line, each.column, each.code) for each in errors] == [(4, column, code)]
    assert remedy in errors[0].hint


@pytest.mark.parametrize(
    ("lines", "codes"),
    [
        ("G02X1.2Z-.1\nX.7I.05", ["arc-centre-missing", "word-unused"]),
        ("G02X1.2Z-.1I.1\nK.05", ["arc-coordinate-missing", "word-unused"]),
        ("M30\nX.7", ["after-end"]),
    ],
)
def test_second_error_is_not_suppressed_as_consequential(lines: str, codes: list[str]) -> None:
    found = findings(f"{HEAD}{lines}\nM30\n")
    errors = [each.code for each in found if each.severity == "error"]
    assert sorted(errors) == codes


@pytest.mark.parametrize(
    "line",
    [
        "G04F4000",
        "G75I.05U.01F5P1",
        "G74X.2Z-.5I.05U.01F5",
        "G83Z-.5K.1F5",
        "G92X.5Z0",
        "X.5(A) (B)",
        "(1/2 IN) X.5",
    ],
)
def test_the_codes_of_this_control_are_not_mistaken_for_others(line: str) -> None:
    found = findings(f"{HEAD}{line}\nM30\n}}1\nX.2Z0\nZ-.5\nX.6\nM99\n")
    assert [each.code for each in found if each.severity == "error"] == []


@pytest.mark.parametrize(
    ("lines", "error"),
    [
        (("MO3S500", "T1", "X0Z1", "G95F.01Z.9"), (2, 2, "letter-o")),
        (("M3S500", "T1", "X0Z1", "G95F.01Z.9"), (2, 1, "m-digits")),
        (("T1", "X.5Z1", "LS2", "X.1", "X0LF"), (6, 1, "not-alone")),
        (("T1", "X.6Z.1", "G75I.05U.01F5", "X.2Z0", "Z-.5", "X.5"), (4, 1, "contour-open")),
        (("T1", "X.5Z1", "G02X.6Z.8", "R.1"), (4, 1, "arc-centre-missing")),
    ],
)
def test_consequences_of_rejected_line_are_not_reported(
    lines: tuple[str, ...], error: tuple[int, int, str]
) -> None:
    found = findings("\n".join(("G90G94F300", *lines, "M30", "")))
    assert [(each.line, each.column, each.code) for each in found if each.severity == "error"] == [error]


def test_unrelated_error_after_rejected_line_is_reported() -> None:
    found = findings(HEAD + "MO3S500\nX.5R\nS9000\nM30\n")
    assert [(each.line, each.code) for each in found if each.severity == "error"] == [
        (4, "letter-o"), (5, "number-missing"), (6, "speed-range"),
    ]  # fmt: skip


@pytest.mark.parametrize("end", ["M2", "M99"])
def test_program_end_of_another_control_is_one_error(end: str) -> None:
    found = findings(f"{HEAD}{end}\n")
    assert [each.line for each in found if each.severity == "error"] == [4]


def test_arc_mismatch_in_diameters_suggests_g72() -> None:
    arc = "X.25F5\nZ-.3\nG03X.35Z-.35R.05\nM30\n"
    radii = findings(HEAD + arc)
    assert [(each.line, each.code, "G72" in each.hint) for each in radii if each.severity == "error"] == [
        (6, "arc-radius", True)
    ]
    diameters = findings("G72" + HEAD + arc)
    assert [each.code for each in diameters if each.severity == "error"] == []


@pytest.mark.parametrize(
    ("lines", "control"),
    [
        (("%", "O1000", "N10G50S2000"), "Fanuc"),
        (("O<a> sub", "G90"), "LinuxCNC"),
        (("G90.1", "G0X1"), "Mach"),
        (("G154P1", "G90"), "Haas"),
        (("G90G94F300", "T1", "X1Z"), ""),
        (("G90G94F300", "T0101", "X1Z1"), ""),
    ],
)
def test_other_control_is_named_once_in_findings(lines: tuple[str, ...], control: str) -> None:
    found = findings("\n".join((*lines, "M30", "")))
    named = [each for each in found if each.code == "other-control-program"]
    assert len(named) == bool(control)
    assert all(control in each.message for each in named)


@pytest.mark.parametrize(
    ("line", "errors"),
    [
        ("G33X.5Z-.5I.01K.001O", []),
        ("G33X.5Z-.5I.01K.00099O", ["thread-lead-range"]),
        ("G33X.5Z-.5I.05K.05", []),
        ("G33X.5Z-.5I.0501K.05", ["thread-depth"]),
        ("G33X.5Z-.5I9999K.05", ["thread-depth"]),
        ("G33X.5Z-.5I.2K.05O", []),
        ("G33X.2938Z-.5I.01K.05", []),  # (.3062 / .01 + 1)^2 = 999.8 passes
        ("G33X.2936Z-.5I.01K.05", ["thread-passes"]),  # 1001.1
    ],
)
def test_thread_depth_and_lead_outside_limits_are_rejected(line: str, errors: list[str]) -> None:
    found = findings(f"{HEAD}M03S500\n{line}\nM30\n")
    assert [each.code for each in found if each.severity == "error"] == errors
