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
            "Declares one or more string parameters.",
            'DECLARE STRING QS1 = "HOLE"\nQS2 = QS1 || " 5"',
            "DECLARE STRING QS1 = HOLE",
            "Expected a string",
        ),
        Entry(
            "QS",
            'n = "text"',
            (
                "Assigns a string to a string parameter; || joins strings. TOOL CALL, CALL PGM, SEL "
                "PGM, CALL LBL and GOTO LBL accept QSn as a name."
            ),
            'QS1 = "SIDE"\nCALL LBL QS1',
            'QS1 = "NONE"\nCALL LBL QS1',
            "Label not found",
            behind='LBL "SIDE"\nL IX+5 R0 F300\nLBL 0\n',
        ),
        Entry(
            "TOCHAR",
            "( DAT+Q1 DECIMALS2 )",
            "Converts a number to a string.",
            "Q1 = 5\nQS5 = TOCHAR( DAT+Q1 DECIMALS2 )",
            "QS5 = TOCHAR( +5 )",
            "DAT",
        ),
        makes(
            "SUBSTR",
            "( SRC_QS1 BEG1 LEN2 )",
            ("Returns part of a string; the first character is at position 0."),
            "( QS1 )",
            "SRC_",
        ),
        makes(
            "SYSSTR",
            "( ID10321 NR0 )",
            (
                "Reads a string from the control, such as the time. TurnDesk does not know the "
                "value of this string, so the program can print it but cannot depend on it."
            ),
            "( ID10321 NR0 )\nCALL PGM QS5",
            "QS5",
        ),
        reads("TONUMB", "( SRC_QS1 )", "Converts a string to a number.", "( SRC_QS1 )", "not a number"),
        reads(
            "STRLEN",
            "( SRC_QS1 )",
            "Returns the length of a string, or -1 if the string is not set.",
            "( QS1 )",
            "SRC_",
        ),
        reads(
            "INSTR",
            "( SRC_QS1 SEA_QS2 )",
            "Returns the position of one string within another.",
            "( SRC_QS1 )",
            "SEA_",
        ),
        reads(
            "STRCOMP",
            "( SRC_QS1 SEA_QS2 )",
            "Compares two strings. The result is 0 if they are equal, or -1 or 1 by alphabetical order.",
            "( SRC_QS1 )",
            "SEA_",
        ),
        Entry(
            "FN 20",
            ": WAIT FOR SYNC",
            (
                "Stops the look-ahead until all earlier blocks have run. TurnDesk does not "
                "need this wait and reports the block."
            ),
            "FN 20: WAIT FOR SYNC",
            "FN 20: WAIT FOR I95==0",
            "PLC",
        ),
        Entry(
            "FN 26",
            ": TABOPEN name.TAB",
            "Opens a freely definable table in the program's folder.",
            _OPEN,
            "FN 26: TABOPEN NONE.TAB",
            "not in the same folder",
            files=_TABLE,
        ),
        Entry(
            "FN 27",
            ': TABWRITE n/"X,DEPTH" = Q5',
            (
                "Writes Q5, Q6, ... into the cells of a table row for this run only. TurnDesk "
                "reports that the table file does not change."
            ),
            f'Q5 = 1\nQ6 = 2\n{_OPEN}\nFN 27: TABWRITE 1/"X,DEPTH" = Q5',
            'Q5 = 1\nFN 27: TABWRITE 1/"X" = Q5',
            "No table is open",
            files=_TABLE,
        ),
        Entry(
            "FN 28",
            ': TABREAD Q5 = n/"X,DEPTH"',
            "Reads cells of a table row into Q5, Q6, ...",
            f'{_OPEN}\nFN 28: TABREAD Q5 = 1/"X,DEPTH"\nL X+Q5 R0 F300',
            f'{_OPEN}\nFN 28: TABREAD Q5 = 7/"X"',
            "row 7",
            files=_TABLE,
        ),
        Entry(
            "FN 38",
            ": SEND",
            "Sends a string to the control's log. TurnDesk ignores this block and reports it.",
            'FN 38: SEND /"DEPTH %f" / +5',
        ),
    )
