"""Words and blocks of SINUMERIK programs; values are numbers, R parameters or targets.

The machine builder defines the name of the third axis, such as B, Y or Q1 instead of C. TurnDesk parses the
words of this axis as words of C and displays them as written.
"""

from __future__ import annotations

import re
from enum import StrEnum
from functools import lru_cache
from typing import NamedTuple

from core.language.diagnostics import Diagnostic, ProgramError
from core.language.formulas import Formula
from core.language.sinumerik.block_reader import ValueList
from core.language.sinumerik.call_arguments import CallArgument
from core.language.sinumerik.control_statements import ControlStatement
from core.language.sinumerik.sinumerik_alarms import make_alarm_diagnostic
from core.language.sinumerik.unsupported_words import UNSUPPORTED_WORDS
from core.language.sinumerik.word_table import GROUP_BY_FUNCTION, VALUE_WORDS

MAX_LINE_LENGTH = 512


class PositionMode(StrEnum):
    """How a word specifies its position, such as AC or IC; with PLAIN, G90 or G91 determines this."""

    PLAIN = ""
    AC = "AC"
    IC = "IC"
    DC = "DC"
    ACP = "ACP"
    ACN = "ACN"


class Word(NamedTuple):
    """One word of a block.

    - ``name`` is in upper case.
    - ``value`` is the number of the word, or None if ``formula`` determines the value.
    - ``column`` is the column of the first character, from 1.
    - ``text`` is the word as written, without blanks.
    - ``quoted_name`` is a name in quotation marks, as in T="ROUGHER".
    - ``spindle_number`` is the spindle number, as in M1=3 or SPOS[1]=90, or 0 if it is not specified.
    """

    name: str
    value: float | None
    column: int
    text: str
    position_mode: PositionMode = PositionMode.PLAIN
    formula: Formula | None = None
    quoted_name: str = ""
    spindle_number: int = 0
    # index of R[ ] or of an array; ``name`` is then R0 or the name of the array
    element_index: Formula | None = None
    arguments: tuple[CallArgument, ...] = ()  # of TRANSMIT( ) and TRACYL( )
    values: ValueList | None = None  # SET( ) or REP( ), from ``element_index`` on


class LexedBlock(NamedTuple):
    """One block of a program, split into words; a block with ``errors`` must not be executed.

    - ``line_number`` is the line of the block, from 1. ``text`` is its code without number, label and
      comment.
    - ``block_name`` names the block in alarms: its N or : number, its label or its line.
    - ``skip_level`` is the level of ``/`` (0 without a digit), or None without ``/``.
    - ``called_name`` is the name of a subprogram or cycle, executed ``execution_count`` times.
    - ``arguments`` are the arguments of this call, or None without parentheses.
    - With ``is_modal_call`` (MCALL), the call is executed after each following move.
    """

    line_number: int
    block_name: str
    words: tuple[Word, ...] = ()
    label: str = ""
    skip_level: int | None = None
    called_name: str = ""
    call_column: int = 0
    execution_count: int = 1
    comment_column: int = 0
    text: str = ""
    errors: tuple[Diagnostic, ...] = ()
    control_statement: ControlStatement | None = None  # program control statement; such a line has no words
    arguments: tuple[CallArgument, ...] | None = None
    is_modal_call: bool = False

    @property
    def is_executable(self) -> bool:
        """Return whether the block has something to execute or an error to report."""
        return bool(
            self.words or self.called_name or self.errors or self.control_statement or self.is_modal_call
        )

    def make_error(self, column: int, code: int | str, text: str, hint: str) -> ProgramError:
        """Return an error at this column.

        ``code`` is an alarm number of the control, or a TurnDesk code in words.
        """
        return ProgramError(
            make_alarm_diagnostic(self.line_number, column, code, self.block_name, text, hint)
        )


# --- vocabulary: supported words, and known words that are not executed


AXIS_NAMES = ("X", "Y", "Z", "C")

G_GROUPS: dict[int, str] = {
    int(name[1:]): group for name, group in GROUP_BY_FUNCTION.items() if name[0] == "G" and name[1:].isdigit()
}
"""G codes by number, each with its group. Codes in a group exclude each other."""

NAMED_GROUPS: dict[str, str] = {
    name: group for name, group in GROUP_BY_FUNCTION.items() if name[0] != "G" or not name[1:].isdigit()
}
"""Named functions, each with its group."""

MAX_M_FUNCTION_COUNT = 5

ARC_WORDS = frozenset({"I", "J", "K", "CR", "AR", "I1", "K1"})
CORNER_WORDS = frozenset({"CHF", "CHR", "RND"})
ADDRESS_LETTERS = frozenset({"G", "M", "X", "Y", "Z", "C", "I", "J", "K", "F", "S", "T", "D"})
"""Address letters that do not need an equals sign."""

POSITION_WORDS = frozenset({"X", "Y", "Z", "C", "RP", "AP", "ANG"})
"""Words that program a position or an angle."""

SPINDLE_WORDS = frozenset({"SETMS", "WAITS"})
"""Words with a spindle number in parentheses."""

WORDS_WITH_VALUE = VALUE_WORDS - SPINDLE_WORDS
"""Words with a value after an equals sign."""

FRAME_WORDS = frozenset({"TRANS", "ATRANS", "ROT", "AROT", "SCALE", "ASCALE", "MIRROR", "AMIRROR"})
NAMED_FUNCTIONS = frozenset(NAMED_GROUPS)
"""Named functions without a value."""

WORDS_WITHOUT_EQUALS = NAMED_FUNCTIONS | SPINDLE_WORDS
"""Words that an equals sign cannot follow."""

TARGET_FORMS = frozenset({"AC", "IC", "DC", "ACP", "ACN"})
FORMS_BY_WORD: dict[str, frozenset[str]] = {
    **dict.fromkeys((*AXIS_NAMES, "SPOS", "SPOSA"), TARGET_FORMS),
    **dict.fromkeys(("I", "J", "K"), frozenset({"AC"})),
    **dict.fromkeys(("RP", "AP"), frozenset({"AC", "IC"})),
}
"""Target forms that a word can have in brackets, by word."""

VOCABULARY = ADDRESS_LETTERS | WORDS_WITH_VALUE | NAMED_FUNCTIONS | SPINDLE_WORDS
"""Words that cannot be names of program variables."""

VALUE_RANGES: dict[str, tuple[float, float]] = {
    **dict.fromkeys(("X", "Y", "Z", "X1", "Z1", "RP"), (-100_000.0, 100_000.0)),
    **dict.fromkeys(("I", "J", "K", "CR", "I1", "K1"), (-100_000.0, 100_000.0)),
    "C": (-10_000_000.0, 10_000_000.0),
    **dict.fromkeys(("SPOS", "SPOSA"), (-10_000_000.0, 10_000_000.0)),
    **dict.fromkeys(("AR", "SF"), (0.0, 360.0)),
    **dict.fromkeys(("AP", "ANG", "RPL"), (-360.0, 360.0)),
    **dict.fromkeys((*CORNER_WORDS, "RNDM", "ADIS", "ADISPOS"), (0.0, 10_000.0)),
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
"""Lowest and highest value of each word."""

UNSUPPORTED_LETTERS = {
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
"""Letters that a program can contain but this control does not support, with the reason or remedy."""

UNSUPPORTED_NAMES = UNSUPPORTED_WORDS.keys() - WORDS_WITH_VALUE
"""Names in the SINUMERIK language that are not subprograms and that this control does not execute."""

UNSUPPORTED_REASONS = UNSUPPORTED_WORDS
"""Reason or remedy for each unsupported word."""


INTERNAL_AXIS_NAME = "C"


def rename_axis_words(text: str, axis_name: str) -> tuple[str, int]:
    """Return the code with the words of the axis ``axis_name`` changed to words of C at the same columns.

    ``text`` is in capitals. The second value is the index of an original C word, which is an error on this
    machine, or -1.
    """
    own = _pattern(INTERNAL_AXIS_NAME).search(text)
    pieces = text.split('"')  # every second piece is a quoted text
    pieces[::2] = [
        _pattern(axis_name).sub(INTERNAL_AXIS_NAME.ljust(len(axis_name)), piece) for piece in pieces[::2]
    ]
    return '"'.join(pieces), own.start() if own and text.count('"', 0, own.start()) % 2 == 0 else -1


@lru_cache(maxsize=16)
def _pattern(name: str) -> re.Pattern[str]:
    """Return a pattern for a word of the axis.

    The name must be followed by an equals sign, or by a number if the name is a single letter.
    """
    lookahead = r"\s*=(?!=)" if len(name) > 1 else r"(?:\s*=(?!=)|[-+]?\.?[0-9]+(?![0-9]*\s*=))"
    return re.compile(rf"(?<![A-Z_$]){name}(?={lookahead})")
