"""Klartext errors, and errors for unsupported codes that suggest an alternative.

If the message of the original control is known, it is the code of the error.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from core.language.diagnostics import ProgramError, make_program_error
from core.message import Message

SYNTAX_ERROR = "Syntax error"
NOT_SUPPORTED = "Not supported"
TOOL_AXIS_MISSING = "Tool axis is missing"  # 1001
FEED_MISSING = "Feed rate is missing"  # 1010
INPUT_VALUE_INCORRECT = "Input value incorrect"  # 1011
ANGLE_NOT_PERMITTED = "Entered angle not permitted"  # 1013
CONTRADICTION = "Contradictory entry"  # 1016
PLANE_INCORRECT = "Plane wrongly defined"  # 1018
WRONG_AXIS = "Wrong axis programmed"  # 1019
WRONG_RPM = "Wrong rpm"  # 1020
EXCESSIVE_NESTING = "Excessive nesting"  # 1025
M128_ACTIVE = "PLANE not permitted with M128"
NOT_ALLOWED_WITH_M128 = "Not permitted with M128"
LABEL_NOT_FOUND = "Label not found"
LABEL_REPEATED = "Label defined twice"
Q_PARAMETER_UNDEFINED = "Q parameter not defined"
ARC_END_INCORRECT = "Circle end point incorrect"
DIRECTION_UNDEFINED = "Direction of rotation not defined"
POLE_MISSING = "CC missing"
PATH_FUNCTION_NOT_POSSIBLE = "Path function not possible here"
RADIUS_TOO_LARGE = "Tool radius too large"
COMPENSATION_NOT_PERMITTED = "Radius compensation not permitted here"
ROUNDING_NOT_POSSIBLE = "Rounding not possible"
ARITHMETIC_ERROR = "Arithmetical error"
CYCLE_MISSING = "Cycle incomplete"
PROGRAM_RAISED_ERROR = "Error raised by the program"
TOOL_UNKNOWN = "Tool not defined"
FILE_MISSING = "Program not found"
M_FUNCTION_UNDEFINED = "M function not defined"
PROBE_MISSING = "No touch probe"
CYCLE_UNKNOWN = "Cycle not defined"
DATUM_TABLE_MISSING = "Datum table missing"


def make_klartext_error(line: int, column: int, code: str, message: str, hint: str = "") -> ProgramError:
    """Return a ProgramError whose message starts with ``code``, the message of the original control."""
    text = message if message.startswith(code) else Message("{code}: {message}", code=code, message=message)
    return make_program_error(line, column, code, text, hint)


class MissingValueError(ProgramError):
    """Error for the use of a Q parameter that has no value.

    ``parameter`` is the kind (Q, QL or QR) and the number of the parameter.
    """

    def __init__(self, line: int, column: int, parameter: tuple[str, int]) -> None:
        name = f"{parameter[0]}{parameter[1]}"
        made = make_klartext_error(
            line,
            column,
            Q_PARAMETER_UNDEFINED,
            Message("{name} has no value yet.", name=name),
            Message("Write {name} = … in an earlier block.", name=name),
        )
        super().__init__(made.diagnostic)
        self.parameter = parameter


def make_syntax_error(line: int, column: int, message: str, hint: str = "") -> ProgramError:
    """Return the error for text that is missing or cannot be parsed."""
    return make_klartext_error(line, column, SYNTAX_ERROR, message, hint)


def make_unsupported_error(line: int, column: int, function: str, alternative: str = "") -> ProgramError:
    """Return the error for a function of the original control that TurnDesk does not support."""
    hint = "Use L moves and PLANE instead, or run the program on a control that supports this function."
    text = Message("{what} is not supported on this control.", what=function)
    return make_klartext_error(line, column, NOT_SUPPORTED, text, alternative or hint)


class UnsupportedCodes(NamedTuple):
    """A group of unsupported codes that are reported once per program, with their name and an alternative."""

    name: str
    alternative: str

    def make_error(self, line: int, column: int) -> ProgramError:
        """Return the error for one of these codes."""
        return make_unsupported_error(line, column, self.name, self.alternative)


CONTOUR_FORMULAS = UnsupportedCodes(
    "A contour formula (QC, DECLARE CONTOUR, SEL CONTOUR)",
    "List the pockets and islands with CONTOUR DEF or cycle 14.",
)
STRING_FUNCTIONS = UnsupportedCodes(
    "A string (QS, DECLARE STRING, TOCHAR, SUBSTR, SYSSTR, TONUMB, INSTR, STRLEN, STRCOMP)",
    "Write names in quotes, and use Q parameters for numbers.",
)
FREE_TABLES = UnsupportedCodes(
    "A freely definable table (FN 26, FN 27, FN 28)", "Assign the values to Q parameters in the program."
)

_FACE = "Mill the face with L moves, and repeat them with CALL LBL and REP."
_THREAD = "Mill the thread along a helix (CP with IPA and IZ), or cut it with a tapping cycle."
CYCLE_ALTERNATIVES: Mapping[int, str] = {
    6: "Use cycle 22 with the data of cycle 20.",
    15: "Use cycle 21 with the data of cycle 20.",
    16: "Use cycle 24 with the data of cycle 20.",
    **dict.fromkeys((230, 231, 232, 233), _FACE),
    **dict.fromkeys((262, 263, 264, 265, 267), _THREAD),
}
"""Replacements for unsupported cycles, by cycle number."""
