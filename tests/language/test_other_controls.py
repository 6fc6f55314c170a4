"""Text outside parentheses, and what other controls write: one sentence for each, saying what it is here."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_machine, load_named_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.diagnostics import Diagnostic
from core.language.omniturn import lex_line
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from tests.texts import text


def errors(*lines: str, name: str = "A", machine: str | None = None) -> list[Diagnostic]:
    on = load_named_machine(machine)
    source = ProgramSource(name, "\n".join((*lines, "")))
    return list(
        prove(
            source, create_power_up_setup(on, tool_offsets={1: ToolOffset()}, secondary_offsets={}), on
        ).errors
    )


@pytest.mark.parametrize(("text", "column", "shown", "words"), [
    ("THIS IS A PROGRAM FOR THE SMALL PIN", 1, "THIS IS A PROGRAM FOR THE SMALL PIN", []),
    ("G00X1 RETRACT THE TOOL", 7, "RETRACT THE TOOL", ["G00", "X1"]),
    ("G00X1RETRACT", 6, "RETRACT", ["G00", "X1"]),
    ("M30 END OF IT", 5, "END OF IT", ["M30"]),
    ("TOOL 5, 1/4 DRILL X1", 1, "TOOL 5, 1/4 DRILL", ["X1"]),
    ("X.5(OK) TOOL NO 5 HERE", 9, "TOOL NO 5 HERE", ["X.5"]),
    ("/X.5 SKIP ME", 6, "SKIP ME", ["X.5"]),
    ("tool change T1", 1, "tool change", ["T1"]),
    ("PART1234", 1, "PART1234", []),
    ("Größe prüfen", 1, "Größe prüfen", []),
])  # fmt: skip
def test_text_outside_comment_is_one_error(text: str, column: int, shown: str, words: list[str]) -> None:
    line = lex_line(1, text)
    assert [(error.code, error.column) for error in line.errors] == [("text-outside", column)]
    assert line.errors[0].message == f"'{shown}' is text outside parentheses."
    assert line.errors[0].hint == f"Write ({shown})."
    assert [word.text for word in line.words] == words


def test_two_separate_texts_are_two_errors() -> None:
    assert [error.column for error in lex_line(1, "TURN T1 ROUGH OD").errors] == [1, 9]


@pytest.mark.parametrize("text", [
    "G33X.2Z-.5I.01K.05PCO", "G33 X.2 Z-.5 I.01 K.05 P C O", "LS5", "LF", "RF", "CA90X.5", "G01 X1 Z.5 F.003",
    "X.5(THE TOOL IS HERE)", "x1z2f3", "G34Z-.5I.01K.05P",
])  # fmt: skip
def test_code_is_not_reported_as_text(text: str) -> None:
    assert lex_line(1, text).errors == ()


@pytest.mark.parametrize("text", ["GO2X1", "MO5", "XO", "GOOX1", "XOZO"])
def test_letter_o_for_zero_is_not_reported_as_text(text: str) -> None:
    assert {error.code for error in lex_line(1, text).errors} == {"letter-o"}


HEAD = ("G90G94F300", "T1", "X.5Z.1")


@pytest.mark.parametrize(("line", "code", "says"), [
    ("G54", "g-unknown", "in the tool offset"), ("G59", "g-unknown", "in the tool offset"),
    ("G20", "g-unknown", "G70 selects inches"), ("G21", "g-unknown", "G71 selects metric"),
    ("G98", "g-unknown", "G94 selects feed per minute"),
    ("G99", "g-unknown", "G95 selects feed per revolution"),
    ("G28", "g-unknown", "reference point"), ("G50S2000", "g-unknown", "G77Sn"),
    ("G32X.2Z-.5F.05", "g-unknown", "G33"), ("G80", "g-unknown", "its own line"),
    ("%", "transfer-line", "transfer"), ("O1234", "program-number", "the file name"),
    (":1234", "program-number", "the file name"),
    ("X.4U.1", "word-unused", "G91"), ("W.2", "unknown-letter", "G91"),
    ("X.4H1", "unknown-letter", "T selects the tool offset"),
    ("N10X.4", "n-word", "does not use line numbers"), ("X\u2212.5", "character", "special minus sign"),
    ("X.5\u2013.2", "character", "special minus sign"), ("X\u201c.5\u201d", "character", "quotation mark"),
    ("X.5;TURN", "character", "comment"), ("X#1", "character", "variable"),
    ("X[1+2]", "character", "calculations"),
    ("X.4F0", "out-of-range", text("findings.rapid-is-g00", word="F0")),
    ("T0101", "tool-number", "T1 selects tool 1"),
    ("T0102", "tool-number", "D2"), ("M06", "m-unknown", "T alone"), ("M17", "m-unknown", "M99"),
    ("M50", "m-disabled", "not enabled"), ("M10", "m-disabled", "not enabled"),
    ("G33X.3Z-.5I.01K.05C-1", "thread-angle", "0 to 30"),
])  # fmt: skip
def test_notation_of_other_control_is_explained(line: str, code: str, says: str) -> None:
    found = errors(*HEAD, "M03S500", line, "M30")
    assert [(each.line, each.code) for each in found] == [(5, code)]
    assert says in f"{found[0].message} {found[0].hint}"
    assert found[0].hint


def test_disabled_loader_codes_of_shipped_lathe_are_reported() -> None:
    machine = load_machine(None)
    assert machine.disabled_m_codes == {10, 11, 43, 47, 48, 50, 51, 52, 53, 59}


def test_program_end_with_trailing_text_is_not_missing() -> None:
    assert [each.code for each in errors(*HEAD, "M30 END")] == ["text-outside"]


@pytest.mark.parametrize(
    ("behind", "weight"), [("(X.25Y0)", "error"), ("(END)", "warning"), ("X.4", "warning")]
)
def test_plane_comment_without_its_sign_is_reported(behind: str, weight: str) -> None:
    machine = load_machine(None)
    text = "\n".join((*HEAD, "(PLXC)", "", behind, "(END)", "M30", ""))
    report = prove(
        ProgramSource("A", text),
        create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={}),
        machine,
    )
    found = [each for each in report.diagnostics if each.code == "plane-sign"]
    assert [(each.line, str(each.severity), each.hint) for each in found] == [(4, weight, "Write (~PLXC).")]


@pytest.mark.parametrize("comment", ["(PLXC IS NEXT)", "(THE PLZC)", "(plx)"])
def test_other_comments_are_not_reported_as_planes(comment: str) -> None:
    assert errors(*HEAD, comment, "(X.25Y0)", "M30") == []


KLARTEXT = ("0 BEGIN PGM A MM", "1 TOOL CALL 1 Z S1000")


@pytest.mark.parametrize(("line", "column"), [
    ("2 L X+40 Y+30 Z+120 R0 FMAX M3 THIS IS MY COMMENT", 32),
    ("2 THIS IS TEXT WITHOUT ITS SIGN", 3),
    ("2 PLANE AXIAL A+30 C+0 TURN MB MAX FMAX THE FRONT SLOPE", 41),
    ("2 PLANE RESET STAY (BACK TO ZERO)", 20),
])  # fmt: skip
def test_klartext_comment_without_its_sign_is_one_error(line: str, column: int) -> None:
    (found,) = errors(*KLARTEXT, line, "3 END PGM A MM", name="a.h", machine="ac-table-mill")
    assert (found.line, found.column) == (3, column)
    assert found.hint.endswith(text("findings.comment-sign", hint="").strip())


@pytest.mark.parametrize(("line", "column"), [
    ("N10 G0 X52 Z3 THIS IS TEXT WITHOUT ITS SIGN", 15), ("N10 M30 END OF PROGRAM", 9),
])  # fmt: skip
def test_sinumerik_comment_without_its_sign_is_one_error(line: str, column: int) -> None:
    found = errors("N5 G90 G18", line, "N20 M30", name="a.mpf")
    assert [(each.line, each.column) for each in found] == [(2, column)]
    assert ";" in found[0].hint


def test_typographic_minus_is_reported_in_every_language() -> None:
    (found,) = errors(
        *KLARTEXT, "2 L X\u22125 R0 FMAX", "3 END PGM A MM", name="a.h", machine="ac-table-mill"
    )
    assert found.hint == "Type -."
    (found,) = errors("N5 G90 G18", "N10 G0 X\u22125", "N20 M30", name="a.mpf")
    assert found.hint == "Type -."


def test_feed_per_revolution_is_checked_in_its_unit() -> None:
    (found,) = errors(*HEAD, "M03S3000", "G95F.15X.4", "M30")
    assert (found.code, found.message) == (
        "feed-over-speed",
        text(
            "findings.feed-over-maximum",
            feed="0.15 in/rev",
            per_rev="0.1 in/rev",
            rpm=3000,
            limit="300 in/min",
        ),
    )
    (found,) = errors(*HEAD, "M03S3000", "G95F6X.4", "M30")
    assert "0.00005 in/rev to 0.2 in/rev" in found.message
