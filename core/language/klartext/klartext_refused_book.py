"""The code book of Klartext: codes that are refused by name."""

from __future__ import annotations

from core.language.code_book import Entry
from core.language.klartext.refused_codes import (
    CONTOUR_FORMULA,
    FREE_TABLE,
    INSTEAD_OF_CYCLE,
    STRING,
    Refused,
)
from core.message import Message

_LINES: tuple[tuple[Refused, dict[str, str]], ...] = (
    (
        CONTOUR_FORMULA,
        {
            "DECLARE CONTOUR": 'DECLARE CONTOUR QC1 = "ROUND"',
            "QC": "QC10 = QC1 | QC2",
            "SEL CONTOUR": 'SEL CONTOUR "MODEL"',
        },
    ),
    (
        STRING,
        {
            "DECLARE STRING": 'DECLARE STRING QS1 = "HOLE"',
            "QS": 'QS2 = QS1 || " 5"',
            "TOCHAR": "QS5 = TOCHAR( DAT+Q1 DECIMALS2 )",
            "SUBSTR": "QS5 = SUBSTR( SRC_QS1 BEG1 LEN2 )",
            "SYSSTR": "QS5 = SYSSTR( ID10321 NR0 )",
            "TONUMB": "Q5 = TONUMB( SRC_QS1 )",
            "INSTR": "Q5 = INSTR( SRC_QS1 SEA_QS2 )",
            "STRLEN": "Q5 = STRLEN( SRC_QS1 )",
            "STRCOMP": "Q5 = STRCOMP( SRC_QS1 SEA_QS2 )",
        },
    ),
    (
        FREE_TABLE,
        {
            "FN 26": "FN 26: TABOPEN DEPTHS.TAB",
            "FN 27": 'FN 27: TABWRITE 1/"X,DEPTH" = Q5',
            "FN 28": 'FN 28: TABREAD Q5 = 1/"X,DEPTH"',
        },
    ),
)

_BY_PARAMETERS = 200  # the least number of a cycle that is told by Q parameters


def refused() -> tuple[Entry, ...]:
    """Codes without an example, since no program can use them."""
    codes = (_entry(head, codes.instead, line) for codes, lines in _LINES for head, line in lines.items())
    return *codes, *(_cycle(number, instead) for number, instead in INSTEAD_OF_CYCLE.items())


def _entry(head: str, instead: str, line: str) -> Entry:
    return Entry(head, "", Message("Rejected. {instead}", instead=instead), "", line, head)


def _cycle(number: int, instead: str) -> Entry:
    head = Message("CYCL DEF {number}", number=number)
    return _entry(head, instead, f"{head} NAME" if number >= _BY_PARAMETERS else f"{head}.0 NAME")
