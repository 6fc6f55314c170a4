"""What a SINUMERIK line is made of: words with a number, an R parameter, or a target in brackets."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

from core.language.diagnostics import Diagnostic
from core.language.formulas import Formula
from core.language.sinumerik.program_jumps import Jump

LONGEST_LINE = 512


class Form(StrEnum):
    """How a position is meant, for one word and one block; plain: as G90 or G91 says."""

    PLAIN = ""
    AC = "AC"
    IC = "IC"
    DC = "DC"
    ACP = "ACP"
    ACN = "ACN"


class Word(NamedTuple):
    """One word. ``name`` is upper case; ``value`` its number, or None where a ``formula`` gives it.

    ``column`` is that of its first sign, from 1; ``text`` as written, without blanks.
    """

    name: str
    value: float | None
    column: int
    text: str
    form: Form = Form.PLAIN
    formula: Formula | None = None


class Line(NamedTuple):
    """One block of source; ``number`` is its line, from 1.

    ``block`` is what alarms call it: its N or : number, its label, or its line. ``skip`` is the level of
    ``/`` (0 for a bare one), None without. ``call`` names a subprogram, run ``passes`` times. ``text`` is the
    code as written without number, label and comment. ``errors`` tells what could not be read; such a line
    must not run.
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
    jump: Jump | None = None  # what steers the program; it has no words beside it

    @property
    def executable(self) -> bool:
        """Whether there is anything to do in it."""
        return bool(self.words or self.call or self.errors or self.jump)


# --- vocabulary: what this control knows, and what it knows of but does not execute


AXES = ("X", "Z", "C")

G_GROUPS: dict[int, str] = {
    **dict.fromkeys((0, 1, 2, 3), "motion"),
    4: "dwell",
    **dict.fromkeys((17, 18), "plane"),
    53: "suppression of offsets",
    **dict.fromkeys((54, 55, 56, 57, 58, 59, 500), "settable offset"),
    **dict.fromkeys((70, 71), "unit of length"),
    **dict.fromkeys((90, 91), "absolute or incremental"),
    **dict.fromkeys((94, 95), "kind of feed"),
    **dict.fromkeys((96, 97), "kind of spindle speed"),
}
"""G codes of this control by the group in which each excludes the others."""

M_CODES = frozenset({0, 1, 2, 3, 4, 5, 7, 8, 9, 17, 30})
MOST_M = 5

ARC = frozenset({"I", "K", "CR", "AR"})
SPINDLE = frozenset({"S", "LIMS"})
CORNERS = frozenset({"CHF", "CHR", "RND"})
LETTERS = frozenset({"G", "M", "X", "Z", "C", "I", "K", "F", "S"})
"""Words that may stand without =."""

ASSIGNED = frozenset({"X", "Z", "C", "I", "K", "F", "S", "CR", "AR", "CHF", "CHR", "RND", "LIMS"})
"""Words that take a value behind =."""

KEYS = frozenset({"DIAMON", "DIAMOF", "TRANS", "ATRANS"})
"""Words without a value."""

FORMS: dict[str, frozenset[str]] = {
    **dict.fromkeys(AXES, frozenset({"AC", "IC", "DC", "ACP", "ACN"})),
    "I": frozenset({"AC"}),
    "K": frozenset({"AC"}),
}
"""Which words take a target in brackets."""

VOCABULARY = LETTERS | ASSIGNED | KEYS
"""Words that are no variable of the program."""

REACH: dict[str, tuple[float, float]] = {
    **dict.fromkeys(("X", "Z", "I", "K", "CR"), (-100_000.0, 100_000.0)),
    "C": (-10_000_000.0, 10_000_000.0),
    "AR": (0.0, 360.0),
    **dict.fromkeys(CORNERS, (0.0, 10_000.0)),
    "F": (-1_000_000.0, 1_000_000.0),
    **dict.fromkeys(("S", "LIMS"), (-1_000_000.0, 1_000_000.0)),
    "R": (-1e9, 1e9),
}
"""Between what a number must lie to be meant at all."""

MOST_R = 299
LETTERS_OUTSIDE = {
    "T": "tools are not part of this control's SINUMERIK subset; put the offset into G54 to G59",
    "D": "tool offsets are not part of this control's SINUMERIK subset; use G54 to G59",
    "H": "H functions are not part of this control's SINUMERIK subset",
    "L": "L is a subprogram only as L with a whole number",
    "Y": "this lathe has no axis Y",
    "A": "this lathe has no axis A",
    "B": "this lathe has no axis B",
    "U": "incremental words are written with IC( ), such as X=IC(1)",
    "W": "incremental words are written with IC( ), such as Z=IC(1)",
    "J": "an arc in G18 has I and K",
    "P": "P stands only behind the name of a subprogram",
    "R": "an R parameter stands behind = or is set with =, such as R1=10",
}
"""Letters that a program of the trade may hold, and what to do about them here."""

_OUTSIDE = """
    AMIRROR AROT AROTS ASCALE ASPOS BRISK CALL CASE CFC CFIN CFTCP CIP CT CYCLE DEFAULT DEFINE DIAM90
    DIAMCYCOF ENDPROC EXTERN FFWOF FFWON FRC FRCM G5 GOTOC GOTOS INVCCW INVCW MCALL MIRROR OEMIPO OFFN POLF
    POS POSA PROC REPEATB REPOS RNDM ROT ROTS SAVE SBLOF SBLON SCALE SETAL SETMS SOFT SPCOF SPCON SPOS SUPA
    TRACYL TRAFOOF TRANSMIT TURN VELOLIM WAITM WAITP WAITS WORKPIECE
"""
NAMES_OUTSIDE = frozenset(_OUTSIDE.split())
"""Names of the language that are no subprograms, and that this control does not execute."""
