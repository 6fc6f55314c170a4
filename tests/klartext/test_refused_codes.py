"""Codes that no real program uses are refused by name: one error with its place, and what to use instead."""

from __future__ import annotations

import pytest

from core.language.klartext.klartext_faults import (
    CONTOUR_FORMULAS,
    CYCLE_ALTERNATIVES,
    FREE_TABLES,
    STRING_FUNCTIONS,
)
from tests.klartext.running import run

CONTOURS = "\nCYCL DEF 20 DATA Q1=-5 Q2=+1\nCYCL DEF 22 ROUGH-OUT Q10=-5 Q11=150 Q12=400\nCYCL CALL"


@pytest.mark.parametrize(
    ("text", "line", "column", "instead"),
    [
        ('DECLARE CONTOUR QC1 = "ROUND"\nQC10 = QC1 | QC1' + CONTOURS, 3, 1, CONTOUR_FORMULAS.alternative),
        ("QC10 = ( QC1 | QC2 ) \\ QC3" + CONTOURS, 3, 1, CONTOUR_FORMULAS.alternative),
        ('SEL CONTOUR "MODEL"' + CONTOURS, 3, 1, CONTOUR_FORMULAS.alternative),
        ("CONTOUR DEF P1 = QC1" + CONTOURS, 3, 18, CONTOUR_FORMULAS.alternative),
        (
            'DECLARE STRING QS1 = "HOLE"\nQS2 = QS1 || " 5"\nTOOL CALL QS2 Z S500',
            3,
            1,
            STRING_FUNCTIONS.alternative,
        ),
        ("QS5 = SYSSTR( ID10321 NR0 )\nCALL PGM QS5", 3, 1, STRING_FUNCTIONS.alternative),
        ("Q5 = TONUMB( SRC_QS1 )\nL X+Q5 FMAX", 3, 6, STRING_FUNCTIONS.alternative),
        ("Q5 = STRLEN( SRC_QS1 )", 3, 6, STRING_FUNCTIONS.alternative),
        ("Q5 = INSTR( SRC_QS1 SEA_QS2 )", 3, 6, STRING_FUNCTIONS.alternative),
        ("Q5 = STRCOMP( SRC_QS1 SEA_QS2 )", 3, 6, STRING_FUNCTIONS.alternative),
        ('FN 9: IF QS1 EQU "A" GOTO LBL 1\nLBL 1', 3, 10, STRING_FUNCTIONS.alternative),
        ('FN 10: IF "A" NE QS1 GOTO LBL 1\nLBL 1', 3, 11, STRING_FUNCTIONS.alternative),
        ("FN 9: IF +1 EQU +1 GOTO LBL QS7", 3, 29, STRING_FUNCTIONS.alternative),
        ("CALL LBL QS1\nCALL LBL QS2", 3, 10, STRING_FUNCTIONS.alternative),
        ("SEL PGM QS5\nCALL SELECTED PGM", 3, 9, STRING_FUNCTIONS.alternative),
        ("CALL PGM QS5", 3, 10, STRING_FUNCTIONS.alternative),
        ("TOOL CALL QS1 Z S100\nL X+5 F AUTO", 3, 11, STRING_FUNCTIONS.alternative),
        ("TOOL DEF QS1 L+0 R+5", 3, 10, STRING_FUNCTIONS.alternative),
        (
            'FN 26: TABOPEN T.TAB\nFN 28: TABREAD Q1 = 5/"X"\nFN 27: TABWRITE 5/"X" = Q1\nL X+Q1 FMAX',
            3,
            1,
            FREE_TABLES.alternative,
        ),
        *(
            (
                f"CYCL DEF {number}.0 NAME\nCYCL DEF {number}.1 SET UP2\nCYCL CALL",
                3,
                1,
                CYCLE_ALTERNATIVES[number],
            )
            for number in (6, 15, 16)
        ),
        *(
            (f"CYCL DEF {number} NAME Q207=+500\nCYCL CALL", 3, 1, CYCLE_ALTERNATIVES[number])
            for number in CYCLE_ALTERNATIVES
            if number >= 200
        ),
    ],
)
def test_unsupported_code_gives_one_error_with_place_and_remedy(
    text: str, line: int, column: int, instead: str
) -> None:
    (error,) = run(text).errors
    assert (error.code, error.line, error.column) == ("Not supported", line, column)
    assert error.hint == instead


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("QC1 = QC2", "QC"),
        ("QS1 = QS2", "QS"),
        ("FN 26: TABOPEN A.TAB", "FN 26"),
        *((f"CYCL DEF {number} X", f"CYCL DEF {number}") for number in CYCLE_ALTERNATIVES if number >= 200),
    ],
)
def test_the_error_names_the_code(text: str, code: str) -> None:
    (error,) = run(text).errors
    assert code in error.message


def test_contour_labels_and_quoted_names_are_accepted() -> None:
    assert run('CONTOUR DEF P1 = LBL 1 I2 = "ROUND.H"\nM30\nLBL 1\nLBL 0').codes == []
    assert run('CALL LBL "SIDE"\nM30\nLBL "SIDE"\nLBL 0').codes == []
    assert run('FN 20: WAIT FOR SYNC\nFN 38: SEND /"%f" / +Q1').codes == []
