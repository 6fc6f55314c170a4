"""Codes and characters of other controls, with their OmniTurn equivalents.

This module also detects programs that were written for other controls.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from core.language.diagnostics import Diagnostic, Severity
from core.language.line_reading import describe_typographic_character
from core.message import Message

CODE_LIST_HINT = "For the list of codes, press Shift+F1 in the editor."
"""General remedy if TurnDesk has no other. Shift+F1 opens the list of codes in the editor."""

_EQUIVALENTS: dict[str, tuple[str, str]] = {
    "G05": ("This control has no code for high-speed modes.", "Remove this text from the program."),
    "G07": (
        "On this control, (~PLZC) starts milling around the part.",
        ("Put the contour between (~PLZC) and (END)."),
    ),
    "G12": ("On this control, (~PLXC) starts face milling.", ("Put the contour between (~PLXC) and (END).")),
    "G13": ("On this control, (END) ends face milling.", "Write (END)."),
    **dict.fromkeys(
        ("G17", "G18", "G19"),
        ("On this control, the plane is always XZ.", "Remove this text from the program."),
    ),
    "G20": ("On this control, G70 selects inches.", "Write G70."),
    "G21": ("On this control, G71 selects metric units.", "Write G71."),
    **dict.fromkeys(
        ("G27", "G28", "G30"),
        (
            "This control has no code that moves to a reference point.",
            "Move to an X and Z position clear of the part.",
        ),
    ),
    "G32": ("On this control, one G33 line cuts all passes of a thread.", "Write G33XnZnInKn."),
    "G43": ("On this control, T selects the tool offset.", "Write T and the tool number."),
    "G49": ("On this control, T0 cancels the tool offset.", "Write T0."),
    "G50": (
        "On this control, G77Sn sets the maximum rpm under G96, and G92 presets the position.",
        "Write G77Sn for the maximum rpm, or G92 to preset the position.",
    ),
    "G53": ("On this control, T0 selects machine coordinates.", "Write T0 before the move."),
    **dict.fromkeys(
        ("G54", "G55", "G56", "G57", "G58", "G59"),
        (
            "On this control, part zero is in the tool offset, and G10 sets a work shift.",
            "Write T; for a work shift, write G10XnZn before T.",
        ),
    ),
    **dict.fromkeys(
        ("G61", "G64"),
        ("This control has no code for the cornering mode.", "Remove this text from the program."),
    ),
    **dict.fromkeys(
        ("G65", "G66"), ("This control has no macros; M98Pn calls a subroutine.", "Write M98Pn.")
    ),
    "G80": (
        "On this control, a cycle is active only on its own line and does not need a cancel code.",
        ("Remove this text from the program."),
    ),
    "G82": ("On this control, G81 drills, G83 drills in pecks and G04 dwells.", "Write G81 or G83."),
    "G84": (
        ("This control has no tapping cycle; tapping is programmed as G95, feed in, M04 and feed out."),
        "Write separate moves instead.",
    ),
    "G85": (
        "This control has no boring cycle; boring is programmed as separate moves.",
        "Write separate moves instead.",
    ),
    "G98": ("On this control, G94 selects feed per minute.", "Write G94."),
    "G99": ("On this control, G95 selects feed per revolution.", "Write G95."),
    "M06": ("On this control, T alone changes the tool.", "Remove M06."),
    "M07": ("On this control, M08 turns on the coolant.", "Write M08."),
    "M17": ("On this control, M99 ends a subroutine.", "Write M99."),
    "M29": (
        ("This control has no tapping cycle; tapping is programmed as G95, feed in, M04 and feed out."),
        "Remove this text from the program.",
    ),
    "M60": ("On this control, M00 stops the program.", "Write M00."),
    "H": ("On this control, T selects the tool offset, and D selects a secondary offset.", "Write T or D."),
    "Q": (
        ("Q belongs to cycles of other controls; the cycles of this control are G33, G74, G75, G81 and G83."),
        CODE_LIST_HINT,
    ),
    "U": ("On this control, incremental moves are X and Z with G91.", "Write G91 and X."),
    "W": ("On this control, incremental moves are X and Z with G91.", "Write G91 and Z."),
    "E": ("On this control, F is the feed and K is the lead of a thread.", "Write F or K."),
}

_SIGNS: dict[str, tuple[str, str]] = {
    "，": ("a comma, which this control does not allow", "Type a decimal point."),
    ";": (
        "the character that other controls use for a comment or the end of a line",
        "Put the comment in parentheses.",
    ),
    "#": ("the symbol for variables; this control does not support variables", "Write the actual number."),
    **dict.fromkeys(
        "[]*=",
        (
            "a symbol for calculations; this control does not support calculations",
            "Write the actual number.",
        ),
    ),
    "%": ("the mark at the start and end of a program transfer", "Delete the character."),
    "$": ("a character that only other controls use", "Remove this text from the program."),
    ":": (
        ("the character that other controls use for program numbers; this control uses the file name"),
        ("Remove this text from the program."),
    ),
}

_TRANSFER = re.compile(r"\s*%.*")
_NUMBERED = re.compile(r"\s*[Oo:]\s*[0-9]{1,8}\s*")
_TOOL = re.compile(r"T0*([0-9]{1,2})([0-9]{2})")


def explain_foreign_word(word: str) -> tuple[str, str] | None:
    """Return the explanation and the remedy for a code or letter of other controls.

    Returns None for any other word.
    """
    return _EQUIVALENTS.get(word)


def explain_character(character: str) -> tuple[str, str] | None:
    """Return the description and the remedy for a character that is not valid in a program.

    Returns None for an unknown character.
    """
    return _SIGNS.get(character) or describe_typographic_character(character)


def explain_foreign_line(code: str) -> tuple[str, str, str] | None:
    """Return code, message and hint for a line that is useful only on other controls, otherwise None."""
    if _TRANSFER.fullmatch(code):
        return (
            "transfer-line",
            "% marks the ends of a transfer.",
            "Delete the line.",
        )
    if _NUMBERED.fullmatch(code):
        shown = code.strip()
        return (
            "program-number",
            Message(
                "{value} is a program number for another control; on this control, the file name is "
                "the program name.",
                value=shown,
            ),
            "Remove this text from the program.",
        )
    return None


def explain_foreign_tool(text: str) -> tuple[str, str] | None:
    """Return the message and hint for a word such as ``T0101``, or None for any other word.

    On other controls, ``T0101`` selects a tool and its wear offset.
    """
    match = _TOOL.fullmatch(text)
    if match is None:
        return None
    number, wear = int(match[1]), int(match[2])
    if not 1 <= number <= 32:
        return None
    also = Message(", and D{wear} selects a second offset", wear=wear) if wear not in {0, number} else ""
    return (
        Message(
            "{text}: on this control, T{number} selects tool {number2} with its offset{also}.",
            text=text,
            number=number,
            number2=number,
            also=also,
        ),
        Message("Write T{number}.", number=number),
    )


_COMMENT = re.compile(r"\([^)]*\)?")
OTHER_CONTROL_CODE = "other-control-program"  # Code of the warning that names the control.
_MAX_LINES = 400  # The first lines of a program show its control.

_CONTROL_MARKERS = (
    ("LinuxCNC", re.compile(r"O<|O\d+(?:SUB|CALL|IF|WHILE|REPEAT)|#<|G64P|G[78](?![0-9])")),
    ("Mach", re.compile(r"G9[01]\.1|M1030")),
    ("Haas", re.compile(r"G154|G187|G103|M97P[0-9]{2,}|G53G0*X0")),
)
"""Patterns by name of control, of which one match identifies the control."""

_FANUC = (
    re.compile(r"^[O:][0-9]{1,8}$"),
    re.compile(r"^N[0-9]+"),
    re.compile(r"G50S"),
    re.compile(r"G28[UWXZ]"),
    re.compile(r"T[0-9]{4}(?![0-9])"),
    re.compile(r"G9[89](?![0-9])"),
    re.compile(r"G7[0-3](?!.*G7[458]).*[UWPQ]|G76P[0-9]{6}"),  # not modal codes before G74, G75 or G78
    re.compile(r"#[0-9]+|\["),
    re.compile(r"G[0-3](?![0-9])"),
)
"""Patterns of the Fanuc language. A single match can be a typing error, so two patterns must match."""


def recognize_control(lines: Sequence[str]) -> Diagnostic | None:
    """Return a warning that names the control for which a program was written.

    Returns None for an OmniTurn program.
    """
    codes = [_COMMENT.sub("", line).replace(" ", "").upper() for line in lines[:_MAX_LINES]]
    control = next((name for name, form in _CONTROL_MARKERS if any(map(form.search, codes))), "")
    if not control and sum(any(map(form.search, codes)) for form in _FANUC) > 1:
        control = "Fanuc"
    if not control:
        return None
    message = Message(
        "This program was written for a {control} control. TurnDesk runs OmniTurn programs.", control=control
    )
    hint = "Rewrite the program with the codes of this control; each message below names the code to use."
    return Diagnostic(1, 0, Severity.WARNING, OTHER_CONTROL_CODE, message, hint)
