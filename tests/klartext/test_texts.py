"""Texts (QS): what they are made of, numbers found in them, names that go by them; free tables."""

from __future__ import annotations

from typing import Any

import pytest

from core.interpreter.job_setup import ToolOffset
from core.language.klartext.called_programs import called_programs
from core.language.source import Source
from tests.klartext.running import Ran, run, run_source, whole


def texts(text: str, **setup: Any) -> dict[int, str | None]:
    ran = run(text, **setup)
    assert not ran.errors
    return ran.state.texts


def test_texts_are_joined_in_their_order() -> None:
    """The manual's example of a piece number, by hand."""
    made = texts(
        'DECLARE STRING QS12 = "Workpiece", QS13 = "OK"\nQS10 = QS12 || " " || QS13\nQS10 = QS10 || "!"'
    )
    assert made[10] == "Workpiece OK!"


@pytest.mark.parametrize(
    ("written", "made"),
    [
        ("TOCHAR ( DAT+Q50 DECIMALS3 )", "12.346"),  # 12.3456 rounded
        ("TOCHAR( DAT+Q50 DECIMALS0 )", "12"),
        ("TOCHAR(DAT-2.5 DECIMALS1)", "-2.5"),
        ("SUBSTR ( SRC_QS1 BEG2 LEN4 )", "CDEF"),  # the first sign is at place 0
        ("SUBSTR( SRC_QS1 BEG6 )", "GH"),
        ('"M" || TOCHAR( DAT+8 ) || "x1"', "M8x1"),
    ],
)
def test_functions_that_make_a_text(written: str, made: str) -> None:
    assert texts(f'Q50 = 12.3456\nQS1 = "ABCDEFGH"\nQS5 = {written}')[5] == made


@pytest.mark.parametrize(
    ("written", "number"),
    [
        ("STRLEN( SRC_QS1 )", 8.0),
        ("STRLEN( SRC_QS99 )", -1.0),  # never given (manual)
        ("INSTR( SRC_QS1 SEA_QS2 )", 2.0),
        ("INSTR( SRC_QS1 SEA_QS2 BEG3 )", 6.0),
        ("INSTR( SRC_QS1 SEA_QS3 )", 8.0),  # not found: its length (manual)
        ("STRCOMP( SRC_QS1 SEA_QS1 )", 0.0),
        ("STRCOMP( SRC_QS1 SEA_QS3 )", -1.0),  # before it in the alphabet
        ("STRCOMP( SRC_QS3 SEA_QS1 )", 1.0),
        ("TONUMB( SRC_QS4 )", 2.75),
    ],
)
def test_functions_that_find_a_number(written: str, number: float) -> None:
    ran = run(f'QS1 = "ABCDEFCD"\nQS2 = "CD"\nQS3 = "XY"\nQS4 = " 2,75"\nQ5 = {written}')
    assert not ran.errors
    assert ran.state.q[5] == pytest.approx(number)


def test_a_jump_goes_by_two_texts() -> None:
    text = 'QS1 = "A"\nFN {0}: IF QS1 {1} "{2}" GOTO LBL 1\nL X+7 R0 F100\nLBL 1'
    jumped = {key: run(text.format(*key)).state.programmed[0] < 1.0
              for key in ((9, "EQU", "A"), (9, "EQU", "B"), (10, "NE", "A"), (10, "NE", "B"))}  # fmt: skip
    assert list(jumped.values()) == [True, False, False, True]


def test_names_go_by_a_text() -> None:
    """Tool, label and program."""
    main = whole('TOOL CALL 1 Z S1000 F500\nL X+0 R0 FMAX\nQS1 = "MILL " || TOCHAR(DAT+10)\n'
                 'TOOL CALL QS1 Z S500\nQS2 = "SLOT.H"\n'
                 'CALL PGM QS2\nQS3 = "SIDE"\nCALL LBL QS3\nSEL PGM QS2\nCALL SELECTED PGM\nM30\n'
                 'LBL "SIDE"\nL IX+100 R0 F100\nLBL 0')  # fmt: skip
    slot = Source("SLOT.H", "BEGIN PGM SLOT MM\nL IX+5 R0 F300\nEND PGM SLOT MM\n")
    ran = run_source(Source("T.H", main, subprograms=(slot,)), tools={1: ToolOffset(), 7: ToolOffset()},
                     tool_names={"MILL 10": 7})  # fmt: skip
    assert not ran.errors
    assert ran.state.modal.tool == 7
    assert ran.state.programmed[0] == pytest.approx(110.0)


def test_files_that_a_text_names_are_read_with_the_program() -> None:
    source = Source(
        "T.H", whole('QS1 = "TNC:\\\\PARTS\\\\SLOT.H"\nFN 26: TABOPEN TNC:\\T\\D.TAB\nCYCL DEF 12.1 %50')
    )
    assert list(called_programs(source)) == ["SLOT.H", "D.TAB", "50.H"]


TABLE = "BEGIN D .TAB MM\nNR X DEPTH\n0 1 2\n5 2.5 -8\n[END]\n"


def of_table(text: str, table: str = TABLE) -> Ran:
    source = Source("T.H", whole("TOOL CALL 1 Z S1000\n" + text), subprograms=(Source("D.TAB", table),))
    return run_source(source)


def test_a_free_table_is_read_and_what_is_written_is_read_back() -> None:
    ran = of_table('FN 26: TABOPEN D.TAB\nFN 28: TABREAD Q10 = 5/"X,DEPTH"\nQ20 = 9\n'
                   'FN 27: TABWRITE 0/"X" = Q20\n'
                   'FN 28: TABREAD Q1 = 0/"X"')  # fmt: skip
    assert not ran.errors
    assert [ran.state.q[q] for q in (10, 11, 1)] == pytest.approx([2.5, -8.0, 9.0])
    assert any("TABWRITE" in each.message for each in ran.diagnostics)


def test_cells_of_an_inch_table_are_what_they_are() -> None:
    ran = of_table('FN 26: TABOPEN D.TAB\nFN 28: TABREAD Q10 = 5/"X"', TABLE.replace(" MM", " INCH"))
    assert ran.state.q[10] == pytest.approx(2.5)


@pytest.mark.parametrize(
    ("text", "code", "names"),
    [
        ("CALL PGM QS5", "Q parameter not defined", "QS5"),
        ("QS1 = SYSSTR( ID10321 NR0 )\nCALL PGM QS1", "Not supported", "QS1"),
        ('QS1 = "NONE.H"\nCALL PGM QS1', "Program not found", "NONE.H"),
        ('QS1 = "NONE"\nTOOL CALL QS1 Z S100', "Tool not defined", "NONE"),
        ('QS1 = "NONE"\nCALL LBL QS1', "Label not found", "NONE"),
        ('QS1 = "ABC"\nQ1 = TONUMB( SRC_QS1 )', "Input value incorrect", "is not a number"),
        ('QS1 = "' + "A" * 200 + '"\nQS2 = QS1 || QS1', "Input value incorrect", "400 characters"),
        ("QS1 = TOCHAR( DAT+1 DECIMALS12 )", "Input value incorrect", "DECIMALS"),
        ("QS1 = TOCHAR( +1 )", "Syntax error", "DAT"),
        ('QS1 = "A" "B"', "Syntax error", "Unexpected word after a string"),
        ("Q1 = STRLEN( SRC_QS1 ) + 1", "Syntax error", "cannot be part of a longer formula"),
        ("QS2000 = QS1", "Syntax error", "QS1999"),
        ("DECLARE STRING QS1 = HOLE", "Syntax error", "Expected a string"),
        ('DECLARE STRING Q1 = "HOLE"', "Syntax error", "Expected a string parameter"),
        ('QS1 = "A" ||', "Syntax error", "Expected a string"),
        ("FN 9: IF +1 EQU +1 GOTO LBL QS7", "Q parameter not defined", "QS7"),
        ('FN 28: TABREAD Q1 = 5/"X"', "Program not found", "No table is open"),
        ("FN 26: TABOPEN N.TAB", "Program not found", "N.TAB"),
        ("FN 29: PLC = +1", "Not supported", "PLC"),
        ("FN 37: EXPORT Q1", "Not supported", "EXPORT"),
        ("FN 20: WAIT FOR I95==0", "Not supported", "PLC"),
    ],
)
def test_refused(text: str, code: str, names: str) -> None:
    ran = run(text)
    assert ran.codes == [code]
    assert names in ran.errors[0].message


@pytest.mark.parametrize(
    ("text", "names"), [('FN 28: TABREAD Q1 = 7/"X"', "row 7"), ('FN 28: TABREAD Q1 = 5/"WIDTH"', "WIDTH")]
)
def test_cells_that_are_not_there_are_refused(text: str, names: str) -> None:
    ran = of_table("FN 26: TABOPEN D.TAB\n" + text)
    assert ran.codes == ["Input value incorrect"]
    assert names in ran.errors[0].message


@pytest.mark.parametrize(
    "text", ["FN 20: WAIT FOR SYNC", 'FN 38: SEND /"%f" / +Q1', "QS1 = CFGREAD( KEY_QS11 )"]
)
def test_what_does_nothing_here_is_told(text: str) -> None:
    ran = run(text)
    assert not ran.errors
    assert "unheeded" in [each.code for each in ran.diagnostics]
