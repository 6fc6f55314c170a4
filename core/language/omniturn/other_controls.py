"""What other controls write and this one does not: for each habit, what it is here."""

from __future__ import annotations

import re

from core.language.typography import typed

LOOK_UP = "See the list of codes: Shift+F1 in the editor."
"""The remedy where no other one can be named; in the editor, Shift+F1 opens the list."""

_HERE: dict[str, tuple[str, str]] = {
    "G05": ("High-speed modes have no code here.", "Take it out."),
    "G07": ("Milling round the part is (~PLZC) here.", "Write (~PLZC) … (END)."),
    "G12": ("Milling of the face is (~PLXC) here.", "Write (~PLXC) … (END)."),
    "G13": ("Milling of the face ends with (END) here.", "Write (END)."),
    "G17": ("The plane is always that of X and Z here.", "Take it out."),
    "G18": ("The plane is always that of X and Z here.", "Take it out."),
    "G19": ("The plane is always that of X and Z here.", "Take it out."),
    "G20": ("Inch is G70 here.", "Write G70."),
    "G21": ("Metric is G71 here.", "Write G71."),
    "G27": ("There is no reference point to move to here.", "Move to a clear X and Z."),
    "G28": ("There is no reference point to move to here.", "Move to a clear X and Z."),
    "G30": ("There is no reference point to move to here.", "Move to a clear X and Z."),
    "G32": ("A thread is G33 here, with all its passes.", "Write G33XnZnInKn."),
    "G43": ("The offset of a tool is T here.", "Write T and the tool's number."),
    "G49": ("T0 takes the tool's offset away here.", "Write T0."),
    "G50": (
        "The highest speed under G96 is G77Sn here, and a preset of the position G92.",
        "Write G77Sn or G92.",
    ),
    "G53": ("Machine coordinates are those of T0 here.", "Write T0 before the move."),
    "G54": (
        "Part zero is in the tool's offset here, and a work shift is G10.",
        "Write T, or G10XnZn before it.",
    ),
    "G61": ("The way of going round corners has no code here.", "Take it out."),
    "G64": ("The way of going round corners has no code here.", "Take it out."),
    "G65": ("There are no macros here; a subroutine is M98Pn.", "Write M98Pn."),
    "G66": ("There are no macros here; a subroutine is M98Pn.", "Write M98Pn."),
    "G80": ("Cycles act on their own line here, and nothing has to end them.", "Take it out."),
    "G82": ("Drilling is G81 here, in pecks G83, and a dwell is G04.", "Write G81 or G83."),
    "G84": ("Tapping is written out here: G95, in, M04, out.", "Write the moves."),
    "G85": ("Boring is written out here.", "Write the moves."),
    "G98": ("Feed per minute is G94 here.", "Write G94."),
    "G99": ("Feed per revolution is G95 here.", "Write G95."),
    "M06": ("T alone changes the tool here.", "Take M06 out."),
    "M07": ("Coolant is M08 here.", "Write M08."),
    "M17": ("A subroutine ends with M99 here.", "Write M99."),
    "M29": ("Tapping is written out here: G95, in, M04, out.", "Take it out."),
    "M60": ("A stop is M00 here.", "Write M00."),
    "H": ("The offset of a tool is T here, and a second one D.", "Write T or D."),
    "Q": (
        "Q is a word of other controls' cycles; here they are G33, G74, G75, G81 and G83.",
        LOOK_UP,
    ),
    "U": ("Incremental moves are X and Z under G91 here.", "Write G91 and X."),
    "W": ("Incremental moves are X and Z under G91 here.", "Write G91 and Z."),
    "E": ("A feed is F here, and the lead of a thread K.", "Write F or K."),
}
_HERE |= {f"G{number}": _HERE["G54"] for number in range(55, 60)}

_SIGNS: dict[str, tuple[str, str]] = {
    "，": ("a comma, and there are none here", "Type a point."),
    ";": ("how a comment or a line's end is written elsewhere", "Put a comment in parentheses."),
    "#": ("a variable of other controls, and there are none here", "Write the number."),
    "[": ("how other controls calculate, and this one does not", "Write the number."),
    "]": ("how other controls calculate, and this one does not", "Write the number."),
    "*": ("how other controls calculate, and this one does not", "Write the number."),
    "=": ("how other controls calculate, and this one does not", "Write the number."),
    "%": ("the mark at the ends of a transfer", "Delete it."),
    "$": ("a word of other controls", "Take it out."),
    ":": ("how other controls number programs; here the file has a name", "Take it out."),
}

_TRANSFER = re.compile(r"\s*%.*")
_NUMBERED = re.compile(r"\s*[Oo:]\s*[0-9]{1,8}\s*")
_TOOL = re.compile(r"T0*([0-9]{1,2})([0-9]{2})")


def meaning_here(word: str) -> tuple[str, str] | None:
    """What a code or a letter of other controls is here, and what to write; None where it is no habit."""
    return _HERE.get(word)


def sign(character: str) -> tuple[str, str] | None:
    """What a character is that no program of this control holds, and what to type."""
    return _SIGNS.get(character) or typed(character)


def whole_line(code: str) -> tuple[str, str, str] | None:
    """Code, sentence and hint for a line that has a meaning for other controls alone."""
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
            f"{shown} numbers a program elsewhere; here the file has a name.",
            "Take it out.",
        )
    return None


def tool(text: str) -> tuple[str, str] | None:
    """Sentence and hint for ``T0101``, by which others call tool and wear offset; None for any other."""
    match = _TOOL.fullmatch(text)
    if match is None:
        return None
    number, wear = int(match[1]), int(match[2])
    if not 1 <= number <= 32:
        return None
    also = f", and a second offset is D{wear}" if wear not in {0, number} else ""
    return f"{text}: T{number} takes tool {number} with its offset here{also}.", f"Write T{number}."
