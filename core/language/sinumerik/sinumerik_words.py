"""Words and lines of SINUMERIK programs. A value is a number, an R parameter or a target in parentheses.

The machine builder defines the name of the third axis, such as B, Y or Q1 in place of C. TurnDesk reads its
words as words of C and shows them as they are written.
"""

from __future__ import annotations

import re
from enum import StrEnum
from functools import lru_cache
from typing import NamedTuple

from core.language.diagnostics import Diagnostic, ProgramError
from core.language.formulas import Formula
from core.language.sinumerik.block_reader import Values
from core.language.sinumerik.call_arguments import Argument
from core.language.sinumerik.outside_words import OUTSIDE
from core.language.sinumerik.program_jumps import Jump
from core.language.sinumerik.sinumerik_alarms import fault
from core.language.sinumerik.word_table import FUNCTIONS, WORDS

LONGEST_LINE = 512


class Form(StrEnum):
    """Meaning of a position for one word in one block; with PLAIN, G90 or G91 determines the meaning."""

    PLAIN = ""
    AC = "AC"
    IC = "IC"
    DC = "DC"
    ACP = "ACP"
    ACN = "ACN"


class Word(NamedTuple):
    """One word.

    ``name`` is in upper case. ``value`` is its number, or None if ``formula`` determines the value.

    ``column`` is the column of its first character, from 1, and ``text`` is the word as written, without
    blanks. ``string`` is a name in quotation marks, as in T="ROUGHER". ``spindle`` is the spindle number, as
    in M1=3 or SPOS[1]=90; 0 if it is not specified.
    """

    name: str
    value: float | None
    column: int
    text: str
    form: Form = Form.PLAIN
    formula: Formula | None = None
    string: str = ""
    spindle: int = 0
    # index of R[ ] or of an array; ``name`` is then R0 or the name of the array
    element: Formula | None = None
    arguments: tuple[Argument, ...] = ()  # of TRANSMIT( ) and TRACYL( )
    values: Values | None = None  # SET( ) or REP( ), from ``element`` on


class Line(NamedTuple):
    """One block of a program; ``number`` is its line, from 1.

    ``block`` is the name of the block in alarms: its N or : number, its label, or its line. ``skip`` is the
    level of ``/`` (0 without a digit), or None. ``call`` is the name of a subprogram or cycle, which is
    executed ``passes`` times with ``arguments`` (None without parentheses). With ``modal_call`` (MCALL), the
    call is executed after each following move. ``text`` is the code as written, without number, label and
    comment. A line with ``errors`` must not be executed.
    """

    number: int
    block: str
    words: tuple[Word, ...] = ()
    label: str = ""
    skip: int | None = None
    call: str = ""
    call_column: int = 0
    passes: int = 1
    comment_column: int = 0
    text: str = ""
    errors: tuple[Diagnostic, ...] = ()
    jump: Jump | None = None  # program control statement; such a line has no words
    arguments: tuple[Argument, ...] | None = None
    modal_call: bool = False

    @property
    def executable(self) -> bool:
        """Whether the line has anything to execute or an error to report."""
        return bool(self.words or self.call or self.errors or self.jump or self.modal_call)

    def refuse(self, column: int, code: int | str, text: str, hint: str) -> ProgramError:
        """Return the error to raise at this column.

        ``code`` is an alarm number of the control, or a TurnDesk code in words.
        """
        return ProgramError(fault(self.number, column, code, self.block, text, hint))


# --- vocabulary: supported words, and known words that are not executed


AXES = ("X", "Y", "Z", "C")

G_GROUPS: dict[int, str] = {
    int(name[1:]): group for name, group in FUNCTIONS.items() if name[0] == "G" and name[1:].isdigit()
}
"""G codes of this control by the group in which each excludes the others."""

NAMED_GROUPS: dict[str, str] = {
    name: group for name, group in FUNCTIONS.items() if name[0] != "G" or not name[1:].isdigit()
}
"""Functions that have a name, by their group."""

MOST_M = 5

ARC = frozenset({"I", "J", "K", "CR", "AR", "I1", "K1"})
CORNERS = frozenset({"CHF", "CHR", "RND"})
LETTERS = frozenset({"G", "M", "X", "Y", "Z", "C", "I", "J", "K", "F", "S", "T", "D"})
"""Words that may stand without =."""

PLACES = frozenset({"X", "Y", "Z", "C", "RP", "AP", "ANG"})
"""Words that move, or turn, something."""

OF_A_SPINDLE = frozenset({"SETMS", "WAITS"})
"""Words that take the number of a spindle in brackets."""

ASSIGNED = WORDS - OF_A_SPINDLE
"""Words that take a value behind =."""

FRAMES = frozenset({"TRANS", "ATRANS", "ROT", "AROT", "SCALE", "ASCALE", "MIRROR", "AMIRROR"})
KEYS = frozenset(NAMED_GROUPS)
"""Words without a value."""

WITHOUT_EQUALS = KEYS | OF_A_SPINDLE
"""Words that no equals sign can follow."""

TARGETS = frozenset({"AC", "IC", "DC", "ACP", "ACN"})
FORMS: dict[str, frozenset[str]] = {
    **dict.fromkeys((*AXES, "SPOS", "SPOSA"), TARGETS),
    **dict.fromkeys(("I", "J", "K"), frozenset({"AC"})),
    **dict.fromkeys(("RP", "AP"), frozenset({"AC", "IC"})),
}
"""Which words take a target in brackets."""

VOCABULARY = LETTERS | ASSIGNED | KEYS | OF_A_SPINDLE
"""Words that are no variable of the program."""

REACH: dict[str, tuple[float, float]] = {
    **dict.fromkeys(("X", "Y", "Z", "X1", "Z1", "RP"), (-100_000.0, 100_000.0)),
    **dict.fromkeys(("I", "J", "K", "CR", "I1", "K1"), (-100_000.0, 100_000.0)),
    "C": (-10_000_000.0, 10_000_000.0),
    **dict.fromkeys(("SPOS", "SPOSA"), (-10_000_000.0, 10_000_000.0)),
    **dict.fromkeys(("AR", "SF"), (0.0, 360.0)),
    **dict.fromkeys(("AP", "ANG", "RPL"), (-360.0, 360.0)),
    **dict.fromkeys((*CORNERS, "RNDM", "ADIS", "ADISPOS"), (0.0, 10_000.0)),
    "OFFN": (-1000.0, 1000.0),
    **dict.fromkeys(("DITS", "DITE"), (-1.0, 1000.0)),
    **dict.fromkeys(("F", "FB", "FRC", "FRCM"), (-1_000_000.0, 1_000_000.0)),
    "OVR": (1.0, 200.0),
    **dict.fromkeys(("S", "LIMS"), (-1_000_000.0, 1_000_000.0)),
    "FP": (1.0, 4.0),
    "T": (0.0, 32_000.0),
    "D": (0.0, 9.0),
    "R": (-1e9, 1e9),
}
"""Between what a number must lie to be meant at all."""

MOST_R = 299
LETTERS_OUTSIDE = {
    "H": "this control does not support the H functions of SINUMERIK",
    "L": "L needs a whole number to call a subprogram",
    "A": "this lathe has no A axis",
    "B": "this lathe has no B axis",
    "U": "this lathe has no U axis; write incremental values with IC( ), as in X=IC(1)",
    "W": "this lathe has no W axis; write incremental values with IC( ), as in Z=IC(1)",
    "P": "P is allowed only after a subprogram name",
    "R": (
        "an R parameter must follow an equals sign or be assigned a value, as in R1=10; "
        "write a radius as CR= and a rounding as RND="
    ),
}
"""Letters that a program of the trade may hold, and what to do about them here."""

NAMES_OUTSIDE = OUTSIDE.keys() - ASSIGNED
"""Names of the language that are no subprograms, and that this control does not execute."""

WHY_OUTSIDE = OUTSIDE
"""What to do instead."""


OWN = "C"


def words_as_c(text: str, name: str) -> tuple[str, int]:
    """Return the code with the words of axis ``name`` changed to words of C at the same columns.

    ``text`` is in capitals. The second value is the index of an original C word, which is an error on this
    machine, or -1.
    """
    own = _pattern(OWN).search(text)
    pieces = text.split('"')  # every second piece is a quoted text
    pieces[::2] = [_pattern(name).sub(OWN.ljust(len(name)), piece) for piece in pieces[::2]]
    return '"'.join(pieces), own.start() if own and text.count('"', 0, own.start()) % 2 == 0 else -1


@lru_cache(maxsize=16)
def _pattern(name: str) -> re.Pattern[str]:
    """Return a pattern for a word of the axis: with = after it, or with a number after a single letter."""
    behind = r"\s*=(?!=)" if len(name) > 1 else r"(?:\s*=(?!=)|[-+]?\.?[0-9]+(?![0-9]*\s*=))"
    return re.compile(rf"(?<![A-Z_$]){name}(?={behind})")
