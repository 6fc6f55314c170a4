"""Codes of the control that are refused by name, and what to use instead: no real program has used them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_faults import unsupported


class Refused(NamedTuple):
    """Codes that are told together, once for a program: their name, and what does the same."""

    name: str
    instead: str

    def error(self, line: int, column: int) -> ProgramError:
        """The error to raise where one of them stands."""
        return unsupported(line, column, self.name, self.instead)


CONTOUR_FORMULA = Refused(
    "A contour formula (QC, DECLARE CONTOUR, SEL CONTOUR)",
    "List the pockets and islands with CONTOUR DEF or cycle 14.",
)
STRING = Refused(
    "A string (QS, DECLARE STRING, TOCHAR, SUBSTR, SYSSTR, TONUMB, INSTR, STRLEN, STRCOMP)",
    "Write names in quotes, and use Q parameters for numbers.",
)
FREE_TABLE = Refused(
    "A freely definable table (FN 26, FN 27, FN 28)", "Assign the values to Q parameters in the program."
)

_FACE = "Mill the face with L moves, and repeat them with CALL LBL and REP."
_THREAD = "Mill the thread along a helix (CP with IPA and IZ), or cut it with a tapping cycle."
INSTEAD_OF_CYCLE: Mapping[int, str] = {
    6: "Use cycle 22 with the data of cycle 20.",
    15: "Use cycle 21 with the data of cycle 20.",
    16: "Use cycle 24 with the data of cycle 20.",
    **dict.fromkeys((230, 231, 232, 233), _FACE),
    **dict.fromkeys((262, 263, 264, 265, 267), _THREAD),
}
"""What to use instead of a cycle that is refused by its number."""
