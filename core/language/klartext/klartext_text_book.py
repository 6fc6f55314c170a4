"""The code book of Klartext: texts (QS) and free tables."""

from __future__ import annotations

from core.language.code_book import Entry

_TABLE = (("DEPTHS.TAB", "BEGIN DEPTHS .TAB MM\nNR X DEPTH\n0 10 -4\n1 20 -6\n[END]\n"),)
_OPEN = "FN 26: TABOPEN DEPTHS.TAB"


def texts() -> tuple[Entry, ...]:
    """DECLARE STRING, QS, the functions of texts, FN 20, 26, 27, 28 and 38."""

    def reads(head: str, words: str, what: str, refused: str, why: str) -> Entry:
        example = f'QS1 = "8.5"\nQS2 = "."\nQ5 = {head}{words}\nL X+Q5 R0 F300'
        return Entry(head, words, what, example, f'QS1 = "A"\nQ5 = {head}{refused}', why)

    def makes(head: str, words: str, what: str, refused: str, why: str) -> Entry:
        example = f'QS1 = "ABCD"\nQS5 = {head}{words}'
        return Entry(head, words, what, example, f'QS1 = "A"\nQS5 = {head}{refused}', why)

    return (
        Entry(
            "DECLARE STRING",
            'QSn = "text"',
            "Declares a text, or several.",
            'DECLARE STRING QS1 = "HOLE"\nQS2 = QS1 || " 5"',
            "DECLARE STRING QS1 = HOLE",
            "A text was expected",
        ),
        Entry(
            "QS",
            'n = "text"',
            "Gives a text to a text parameter; parts are joined by ||. TOOL CALL, CALL PGM, SEL PGM, "
            "CALL LBL and GOTO LBL take QSn for a name.",
            'QS1 = "SIDE"\nCALL LBL QS1',
            'QS1 = "NONE"\nCALL LBL QS1',
            "Label not found",
            behind='LBL "SIDE"\nL IX+5 R0 F300\nLBL 0\n',
        ),
        Entry(
            "TOCHAR",
            "( DAT+Q1 DECIMALS2 )",
            "A number as a text.",
            "Q1 = 5\nQS5 = TOCHAR( DAT+Q1 DECIMALS2 )",
            "QS5 = TOCHAR( +5 )",
            "DAT",
        ),
        makes(
            "SUBSTR", "( SRC_QS1 BEG1 LEN2 )", "A part of a text; the first sign is at 0.", "( QS1 )", "SRC_"
        ),
        makes(
            "SYSSTR",
            "( ID10321 NR0 )",
            "A text of the control, such as its time: not known here; it may be printed, and nothing can "
            "go by it.",
            "( ID10321 NR0 )\nCALL PGM QS5",
            "QS5",
        ),
        reads("TONUMB", "( SRC_QS1 )", "A text as a number.", "( SRC_QS1 )", "no number"),
        reads("STRLEN", "( SRC_QS1 )", "How many signs a text has; -1 of none.", "( QS1 )", "SRC_"),
        reads("INSTR", "( SRC_QS1 SEA_QS2 )", "Where a text stands in another one.", "( SRC_QS1 )", "SEA_"),
        reads(
            "STRCOMP",
            "( SRC_QS1 SEA_QS2 )",
            "0 where two texts agree, -1 and 1 by the alphabet.",
            "( SRC_QS1 )",
            "SEA_",
        ),
        Entry(
            "FN 20",
            ": WAIT FOR SYNC",
            "Waits for what is read ahead: nothing to wait for here, which is said.",
            "FN 20: WAIT FOR SYNC",
            "FN 20: WAIT FOR I95==0",
            "PLC",
        ),
        Entry(
            "FN 26",
            ": TABOPEN name.TAB",
            "Opens a free table beside the program.",
            _OPEN,
            "FN 26: TABOPEN NONE.TAB",
            "not beside",
            files=_TABLE,
        ),
        Entry(
            "FN 27",
            ': TABWRITE n/"X,DEPTH" = Q5',
            "Writes Q5, Q6, ... into cells of a row, for this pass: the file stays as it is, which is said.",
            f'Q5 = 1\nQ6 = 2\n{_OPEN}\nFN 27: TABWRITE 1/"X,DEPTH" = Q5',
            'Q5 = 1\nFN 27: TABWRITE 1/"X" = Q5',
            "No table is open",
            files=_TABLE,
        ),
        Entry(
            "FN 28",
            ': TABREAD Q5 = n/"X,DEPTH"',
            "Reads cells of a row into Q5, Q6, ...",
            f'{_OPEN}\nFN 28: TABREAD Q5 = 1/"X,DEPTH"\nL X+Q5 R0 F300',
            f'{_OPEN}\nFN 28: TABREAD Q5 = 7/"X"',
            "row 7",
            files=_TABLE,
        ),
        Entry(
            "FN 38",
            ": SEND",
            "Hands a text to the control's log: nothing is done here, which is said.",
            'FN 38: SEND /"DEPTH %f" / +5',
        ),
    )
