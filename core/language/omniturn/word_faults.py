"""What can be wrong with a word as text: one code, one sentence and one hint for each fault."""

from __future__ import annotations

from collections.abc import Callable

from core.language.diagnostics import Diagnostic, refusal
from core.language.omniturn import other_controls
from core.language.omniturn.omniturn_words import COUNTING, RANGES, Word

_MOST_DIGITS = 15
_MOST_SHOWN = 40  # characters of a text
_SIGNS = {
    ",": ("comma", "A comma is not allowed anywhere.", "Write a decimal point."),
    ")": ("comment-close", "')' closes no comment.", "Add '(' or take it out."),
    "/": ("block-delete-place", "'/' may only stand first on a line.", "Move it to the front."),
}
_AFTER_NUMBER = {
    ".": ("two-points", "The number has two decimal points.", "Take one out."),
    "+": ("sign-inside", "A sign stands inside a number.", "Split it into two words."),
    "-": ("sign-inside", "A sign stands inside a number.", "Split it into two words."),
}

_SLIPS = {
    "comment-open": ("The comment has no closing parenthesis.", "Add ')'."),
    "comment-nested": ("A comment is inside another comment.", "Remove the inner parentheses."),
    # X1E5, and E005 where a print of F.005 was read.
    "exponent": ("Numbers have no exponent here.", "Write the number out; a feed is F."),
}


def too_long(line: int, length: int) -> Diagnostic:
    """More on one line than a program line can hold."""
    return refusal(line, 0, "line-too-long", f"The line has {length} characters.", "Break it into lines.")


def text_outside(line: int, column: int, text: str) -> Diagnostic:
    """Words for a reader that stand among those for the control."""
    shown = text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}…"
    message = f"'{shown}' is text outside parentheses."
    return refusal(line, column, "text-outside", message, f"Write ({shown}).")


def slip(line: int, column: int, code: str) -> Diagnostic:
    """What has one sentence wherever it stands."""
    return refusal(line, column, code, *_SLIPS[code])


def letter_o(line: int, column: int, word: str) -> Diagnostic:
    """A letter O for a zero: GO2, MO5, XO."""
    message = f"{word}: letter O in a number."
    return refusal(line, column, "letter-o", message, f"Write {word.upper().replace('O', '0')}.")


def no_number(line: int, column: int, letter: str, follower: str) -> Diagnostic:
    """A letter and nothing that is a number."""
    if follower in {"+", "-"}:
        return refusal(
            line, column, "lone-sign", f"{letter} has a sign and no number.", "Write the number after it."
        )
    if follower == ".":
        return refusal(
            line, column, "lone-point", f"{letter} has a decimal point and no digit.", "Write the digits."
        )
    if letter not in RANGES and letter not in {"LF", "RF", "O"}:
        return _unknown_letter(line, column, letter)
    return refusal(line, column, "number-missing", f"{letter} has no number.", f"Write it after {letter}.")


def of_sign(line: int, column: int, sign: str, *, after_number: bool) -> Diagnostic:
    """A character that starts no word."""
    fixed = _SIGNS.get(sign) or (_AFTER_NUMBER.get(sign) if after_number else None)
    if fixed is not None:
        return refusal(line, column, *fixed)
    if sign in "0123456789+-.":
        return refusal(
            line, column, "letter-missing", "A number stands without a letter.", "Write its letter."
        )
    shown = sign if sign.isprintable() else f"U+{ord(sign):04X}"
    habit = other_controls.sign(sign)
    if habit is not None:
        what, hint = habit
        return refusal(line, column, "character", f"'{shown}' is {what}.", hint)
    return refusal(
        line, column, "character", f"'{shown}' is no part of the language.", "Comments go in parentheses."
    )


def of_word(line: int, word: Word, digits: str | None) -> Diagnostic | None:
    """What is wrong with the letter or the size of a word, or None."""
    letter, value, column, _ = word
    if letter not in RANGES and letter not in {"LF", "RF", "O"}:
        return _unknown_letter(line, column, letter)
    if digits is None or value is None:
        return None
    if letter in {"G", "M"}:
        return _two_digits(line, word, digits)
    if letter not in RANGES:
        return refusal(line, column, "number-unwanted", f"{letter} takes no number.", "Take it out.")
    if sum(sign.isdigit() for sign in digits) > _MOST_DIGITS:
        return refusal(
            line, column, "number-too-long", f"{letter} has over {_MOST_DIGITS} digits.", "Round the number."
        )
    return _size(line, word, digits)


def _tool(text: str, _value: float) -> tuple[str, str, str]:
    habit = other_controls.tool(text)
    return (
        "tool-number",
        *(habit or (f"{text}: tools are T1 to T32.", "Correct the tool number; T0 cancels the tool.")),
    )


def _offset(text: str, _value: float) -> tuple[str, str, str]:
    return "offset-number", f"{text}: offsets go from 1 to 32.", "D0 cancels."


def _no_feed(text: str, value: float) -> tuple[str, str, str] | None:
    if value < 0:
        return "out-of-range", f"{text}: a feed rate cannot be negative.", "Remove the sign."
    if value:
        return None
    return "out-of-range", f"{text}: a feed of 0 moves nothing; a rapid is G00 here.", "Write the feed."


_SIZES: dict[str, Callable[[str, float], tuple[str, str, str] | None]] = {
    "T": _tool,
    "D": _offset,
    "F": _no_feed,
}


def _size(line: int, word: Word, digits: str) -> Diagnostic | None:
    letter, value, column, text = word
    least, most = RANGES[letter]
    if letter in COUNTING and not digits.isdigit():
        return refusal(
            line, column, "whole-number", f"{text} must be a whole number without a sign.", "Round it."
        )
    if value is None or least <= value <= most:
        return None
    special = _SIZES.get(letter)
    if special is not None and (fault := special(text, value)) is not None:
        return refusal(line, column, *fault)
    if letter == "LS":
        message = f"{text} is out of range: a loop runs {least:g} to {most:,.0f} times."
        return refusal(line, column, "loop-count", message, "Correct the count.")
    return refusal(
        line,
        column,
        "out-of-range",
        f"{text} is out of range: {letter} goes from {least:g} to {most:g}.",
        "Look for a lost decimal point.",
    )


def _two_digits(line: int, word: Word, digits: str) -> Diagnostic | None:
    if len(digits) == 2 and digits.isdigit():
        return None
    code = f"{word.letter.lower()}-digits"
    value = word.value if word.value is not None and 0 <= word.value < 10 else None
    hint = (
        f"Write {word.letter}{int(value):02d}."
        if value is not None and digits.isdigit()
        else "Write two digits."
    )
    return refusal(line, word.column, code, f"{word.text}: {word.letter} takes exactly two digits.", hint)


def _unknown_letter(line: int, column: int, letter: str) -> Diagnostic:
    if letter == "N":
        return refusal(
            line, column, "n-word", "Lines have no numbers here: N is not allowed.", "Take the N word out."
        )
    habit = other_controls.meaning_here(letter)
    if habit is not None:
        return refusal(
            line, column, "unknown-letter", f"{letter} is no word of the language. {habit[0]}", habit[1]
        )
    said = f"{letter} is no word of the language."
    return refusal(line, column, "unknown-letter", said, other_controls.LOOK_UP)
