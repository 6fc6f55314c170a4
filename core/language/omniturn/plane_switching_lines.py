"""Lines of a coordinate transformation (plane switching), written as statements in parentheses.

They extend from (~PLXC) or (~PLZC) to (END). The checker of the original control does not know these
statements, so programs write them like comments.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from core.language.diagnostics import make_program_error
from core.language.omniturn.omniturn_words import Word
from core.message import Message

_ENTRY = re.compile(r"\s*\(\s*~\s*(PLXC|PLZC)\s*\)\s*", re.IGNORECASE)
_BARE_ENTRY = re.compile(r"\s*\(\s*PL[XZ]C\s*\)\s*", re.IGNORECASE)
_FIRST_WORD = re.compile(r"\s*\(\s*[XYZFGHD]\s*[+-]?\s*[0-9.]", re.IGNORECASE)
_STATEMENT = re.compile(r"\s*\(([^()]*)\)\s*")
_WORD = re.compile(r"([A-Z])\s*([+-]?\s*(?:[0-9][0-9\s]*(?:\.[0-9\s]*)?|\.\s*[0-9][0-9\s]*))\s*")
_END = re.compile(r"\s*M(?:30|02)\s*(?:\([^()]*\)\s*)?", re.IGNORECASE)
_LETTERS = frozenset("XYZFGIJHD")
_MAX_VALUE = 10_000.0
_MAX_FEED = 100_000.0
_HINT = "Between (~PLXC) or (~PLZC) and (END), write only (X Y Z F), (G02 or G03 X Y I J), (H) and (D)."


class PlaneSwitchingLine(NamedTuple):
    """One line of a coordinate transformation (plane switching).

    ``name`` is PLXC, PLZC or END, or empty for a statement with ``words``. ``arc_code`` is 2 for G02, 3 for
    G03 and 0 otherwise. The numbers of the words are in program units.
    """

    name: str
    words: dict[str, Word]
    arc_code: int = 0


def parse_plane_switching_start(text: str) -> PlaneSwitchingLine | None:
    """Return the line if it starts a coordinate transformation (plane switching), otherwise None."""
    match = _ENTRY.fullmatch(text) if "~" in text else None
    return PlaneSwitchingLine(match[1].upper(), {}) if match else None


def is_missing_tilde(text: str, following_lines: Iterable[str]) -> bool | None:
    """Return whether a line such as (PLXC) lacks the ~ with which plane switching starts.

    The control treats a line without ~ as a comment. True means that the next line in ``following_lines``
    is a statement of the virtual mill. False means that the line may be a comment. Returns None for any
    other line.
    """
    if _BARE_ENTRY.fullmatch(text) is None:
        return None
    for line in following_lines:
        if line.strip():
            return _FIRST_WORD.match(line) is not None
    return False


def is_program_end(text: str) -> bool:
    """Return whether a line is M30 or M02, which means that (END) is missing."""
    return _END.fullmatch(text) is not None


def lex_plane_switching_line(number: int, text: str) -> PlaneSwitchingLine:
    """Read a line of a coordinate transformation (plane switching), up to and including (END).

    Raises ProgramError for a statement that is not allowed.
    """
    match = _STATEMENT.fullmatch(text) if text.isascii() else None
    if match is None:
        raise make_program_error(
            number, 1, "plane-line", "This line is not a statement in parentheses.", _HINT
        )
    inside = match[1].upper()
    if inside.strip() == "END":
        return PlaneSwitchingLine("END", {})
    words: dict[str, Word] = {}
    at, base = len(inside) - len(inside.lstrip()), match.start(1) + 1
    while at < len(inside):
        word_match = _WORD.match(inside, at)
        if word_match is None:
            shown = inside[at : at + 8].strip()
            message = Message(
                "'{value}' is not allowed in a statement between (~PLXC) or (~PLZC) and (END).", value=shown
            )
            raise make_program_error(number, base + at, "plane-word", message, _HINT)
        word = _word(number, base + at, word_match)
        if word.letter in words:
            message = Message("The line contains {letter} twice.", letter=word.letter)
            raise make_program_error(number, word.column, "word-twice", message, "Remove one of the two.")
        words[word.letter] = word
        at = word_match.end()
    return _sorted(number, words)


def _word(number: int, column: int, match: re.Match[str]) -> Word:
    letter, digits = match[1], re.sub(r"\s", "", match[2])
    word = Word(letter, float(digits[:32]), column, letter + digits)
    if letter not in _LETTERS:
        raise make_program_error(
            number,
            column,
            "plane-word",
            Message("{word} is not allowed between (~PLXC) or (~PLZC) and (END).", word=word.text),
            _HINT,
        )
    value = word.value or 0.0
    if letter == "G" and digits not in {"02", "03"}:
        message = Message(
            "{word}: between (~PLXC) or (~PLZC) and (END), the only G codes allowed are G02 and G03.",
            word=word.text,
        )
        raise make_program_error(number, column, "plane-word", message, _HINT)
    if len(digits) > 16 or abs(value) > (_MAX_FEED if letter == "F" else _MAX_VALUE):
        raise make_program_error(
            number,
            column,
            "out-of-range",
            Message("{word} is out of range.", word=word.text),
            "Look for a missing decimal point.",
        )
    return word


def _sorted(number: int, words: dict[str, Word]) -> PlaneSwitchingLine:
    if not words:
        raise make_program_error(number, 1, "plane-word", "The statement is empty.", _HINT)
    for letter in ("H", "D"):
        if letter in words and len(words) > 1:
            message: str = Message("{letter} cannot be combined with other words.", letter=letter)
            raise make_program_error(
                number,
                words[letter].column,
                "not-alone",
                message,
                Message("Write ({letter}n) alone on a line.", letter=letter),
            )
    code = words.get("G")
    for letter in ("I", "J"):
        if letter in words and code is None:
            message = Message(
                "{words} is an arc center word, but the line has no G02 or G03.", words=words[letter].text
            )
            raise make_program_error(
                number,
                words[letter].column,
                "word-unused",
                message,
                "Write G02 or G03 on the line; both are one-shot codes.",
            )
        if code is not None and letter not in words:
            message = Message(
                "{letter} is missing: I and J are the coordinates of the arc center.", letter=letter
            )
            raise make_program_error(
                number,
                code.column,
                "arc-coordinate-missing",
                message,
                Message("Add {letter}.", letter=letter),
            )
    if code is not None and "Z" in words:
        message = "Between (~PLXC) or (~PLZC) and (END), an arc can move only X and Y."
        raise make_program_error(
            number, words["Z"].column, "word-unused", message, "Write the Z move on another line."
        )
    return PlaneSwitchingLine("", words, int(code.value or 0) if code else 0)
