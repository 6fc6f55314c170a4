"""Detection of lines written for another control, with the OmniTurn codes to use instead.

Each pattern matches the code of a line in upper case, without blanks and comments. A matching line causes
one error. Its other words are not checked, because they also belong to the other control.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

from core.language.line_reading import SIGNED_NUMBER
from core.language.omniturn import other_controls
from core.message import Message


class ForeignCode(NamedTuple):
    """Code of another type of control, found in a line of a program.

    ``start_index`` is the index of its first character in the line. The other attributes describe the
    diagnostic.
    """

    start_index: int
    diagnostic_code: str
    message: str
    remedy: str


class _Pattern(NamedTuple):
    """Pattern of a code for another control, with the error message and a function for the remedy."""

    regex: str
    message: str
    make_remedy: Callable[[re.Match[str]], str]


def _always(hint: str) -> Callable[[re.Match[str]], str]:
    return lambda _: hint


def _dwell(match: re.Match[str]) -> str:
    """Return the remedy for a dwell in milliseconds (P) or seconds (X and U)."""
    seconds = float(match[2]) / (1000.0 if match[1] == "P" and "." not in match[2] else 1.0)
    return Message("Write G04F{seconds}.", seconds=_plain(seconds))


def _plain(value: float) -> str:
    """Return a number in program notation.

    The notation has no leading zero before the decimal point and no trailing zeros.
    """
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return text[1:] if text.startswith("0.") else text


def _decimal(match: re.Match[str]) -> str:
    letter, value = match.string[match.start() - 1], int(match[1]) / max(int(match[2]), 1)
    return Message("Write {letter}{plain}.", letter=letter, plain=_plain(value))


_ROUGHING = "Write G75InUnFn, then the contour and RF."
_THREAD = "Write G33XnZnInKn."
_PATTERNS = (
    _Pattern(
        r"^(?=O(?:<|[0-9]+(?:SUB|CALL|IF|WHILE|REPEAT|ENDSUB|ENDIF|ENDWHILE|ENDREPEAT|RETURN)))",
        "LinuxCNC O words are not supported. On this control, write a subroutine as }n … M99 "
        "and call it with M98Pn.",
        _always("Write the subroutine as }n … M99 and call it with M98Pn."),
    ),
    _Pattern(
        r"^(?=#<)",
        "Variables are not supported.",
        _always("Write the number in place of the variable."),
    ),
    _Pattern(
        r"(?=G[78](?![0-9]))",
        "On this control, G72 (diameter programming) and G73 (radius programming) "
        "replace the LinuxCNC codes G7 and G8.",
        lambda match: Message("Write {name}.", name="G72" if match.string[match.end() + 1] == "7" else "G73"),
    ),
    _Pattern(
        rf"(?<=G04)([PXU])({SIGNED_NUMBER})",
        "G04 takes seconds as F.",
        _dwell,
    ),
    _Pattern(
        r"(?<=G70)(?=.*[PQ])",
        "On this control, G70 selects inches; the last pass of G75 finishes a contour.",
        _always("Delete the line, because G75 ends with a pass along the contour."),
    ),
    _Pattern(
        r"(?<=G71)(?=.*[UWPQ])",
        "G71 selects metric here; roughing to a contour is G75.",
        _always(_ROUGHING),
    ),
    _Pattern(
        r"(?<=G72)(?=.*[UWPQ])",
        "On this control, G72 selects diameter programming; G75 roughs to a contour.",
        _always(_ROUGHING),
    ),
    _Pattern(
        r"(?<=G73)(?=.*[UWPQ])",
        "On this control, G73 selects radius programming; G75 roughs to a contour.",
        _always(_ROUGHING),
    ),
    _Pattern(
        r"(?<=G74)(?=.*[PQRW])",
        "On this control, G74 is the box roughing cycle; G83 drills in pecks.",
        _always("Write G83ZnKnFn."),
    ),
    _Pattern(
        r"(?<=G75)(?=.*[QRW])",
        "On this control, G75 roughs a contour; it does not peck a groove.",
        _always("Write separate moves for the groove, or use G74."),
    ),
    _Pattern(
        r"(?<=G76)(?=.*[PQRXZ])",
        "G76 is the minimum rpm for constant surface speed here; threads are G33.",
        _always(_THREAD),
    ),
    _Pattern(
        rf"(?<=G8[13])[^Q]*Q({SIGNED_NUMBER})",
        "The peck depth is K here.",
        lambda match: Message("Write K{word} in G83.", word=match[1]),
    ),
    _Pattern(
        r"(?<=G92)(?=S[0-9.]+$)",
        "On this control, G92 presets the position; use G77 to set the maximum rpm for "
        "constant surface speed.",
        lambda match: Message("Write G77{string}.", string=match.string[match.end() :]),
    ),
    _Pattern(
        r"(?<=M98)P[0-9]+L([0-9]+)",
        "M98 has no repeat count.",
        lambda match: Message("Write LS{word} before the call and LF after it.", word=match[1]),
    ),
    _Pattern(
        r"(?<=[XZIKRFU])([0-9]+)/([0-9]+)(?![0-9])",
        "Fractions are not read.",
        _decimal,
    ),
)


@cache
def _compiled() -> tuple[tuple[re.Pattern[str], str, Callable[[re.Match[str]], str]], ...]:
    """Return the compiled patterns.

    They are compiled only for the first line that may match, because many programs have no such line.
    """
    return tuple((re.compile(form), message, hint) for form, message, hint in _PATTERNS)


def find_foreign_code(code: str) -> ForeignCode | None:
    """Return the code of another control that a line contains, or None if it contains none."""
    for form, message, hint in _compiled():
        match = form.search(code)
        if match is not None:
            return ForeignCode(_start(code, match), "other-control", message, hint(match))
    for found in re.finditer(_CODE, code):
        habit = other_controls.explain_foreign_word(found[0])
        if habit is not None:
            message = Message(
                "{word} is not a valid code on this control. {habit}", word=found[0], habit=habit[0]
            )
            return ForeignCode(found.start(), "g-unknown", message, habit[1])
    return None


def _start(code: str, match: re.Match[str]) -> int:
    """Return the index of the code or letter that precedes the match of a pattern."""
    if match.start() == 0 or code[match.start()] in _SEPARATE_WORD_LETTERS:
        return match.start()
    return match.start() - (3 if re.search(_AFTER_CODE, code[: match.start()]) else 1)


_CODE = r"G[0-9]{2}(?![0-9.])"
_SEPARATE_WORD_LETTERS = "GO#"
_AFTER_CODE = r"[GM][0-9]{2}$"
_LETTER_L = r"(?<=[A-Za-z0-9.+-])l(?=[0-9.A-Za-z]|\s|$)"


def replace_letter_l(code: str) -> str:
    """Return the line with each letter l in a number replaced by the digit 1."""
    return re.sub(_LETTER_L, "1", code)
