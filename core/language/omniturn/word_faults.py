"""Diagnostics for syntax errors in OmniTurn words, each with a code, a message and a hint."""

from __future__ import annotations

from collections.abc import Callable

from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.language.omniturn import other_controls
from core.language.omniturn.omniturn_words import VALUE_RANGES, WHOLE_NUMBER_LETTERS, Word
from core.message import Message

_MAX_DIGITS = 15
_MAX_DISPLAYED = 40  # characters of a text
_SIGNS = {
    ",": ("comma", "Commas are not allowed in a program.", "Write a decimal point."),
    ")": ("comment-close", "')' has no opening parenthesis.", "Add '(' or remove ')'."),
    "/": (
        "block-delete-place",
        "'/' is allowed only at the start of a line.",
        ("Move '/' to the start of the line."),
    ),
}
_AFTER_NUMBER = {
    ".": ("two-points", "The number has two decimal points.", "Remove one of the two."),
    "+": (
        "sign-inside",
        "A sign is in the middle of a number.",
        ("Write two words, each with its own letter."),
    ),
    "-": (
        "sign-inside",
        "A sign is in the middle of a number.",
        ("Write two words, each with its own letter."),
    ),
}

_ERROR_TEXTS = {
    "comment-open": ("The comment has no closing parenthesis.", "Add ')'."),
    "comment-nested": ("A comment is inside another comment.", "Remove the inner parentheses."),
    # This covers X1E5, and also E005 from a misread print of F.005.
    "exponent": (
        "A number cannot have an exponent.",
        ("Write the number without an exponent; use F for a feed."),
    ),
}


def make_line_length_error(line: int, length: int) -> Diagnostic:
    """Return the error for a line that is too long."""
    return make_error_diagnostic(
        line,
        0,
        "line-too-long",
        Message("The line is too long ({text_count} characters).", text_count=length),
        "Split the line into shorter lines.",
    )


def make_stray_text_error(line: int, column: int, text: str) -> Diagnostic:
    """Return the error for text outside parentheses."""
    shown = text if len(text) <= _MAX_DISPLAYED else f"{text[:_MAX_DISPLAYED]}…"
    message = Message("'{value}' is text outside parentheses.", value=shown)
    return make_error_diagnostic(
        line, column, "text-outside", message, Message("Write ({value}).", value=shown)
    )


def make_fixed_message_error(line: int, column: int, code: str) -> Diagnostic:
    """Return the error for a code whose message is always the same."""
    return make_error_diagnostic(line, column, code, *_ERROR_TEXTS[code])


def make_letter_o_error(line: int, column: int, word: str) -> Diagnostic:
    """Return the error for a letter O instead of a zero, such as GO2, MO5 or XO."""
    message = Message("{word}: letter O in a number.", word=word)
    return make_error_diagnostic(
        line, column, "letter-o", message, Message("Write {name}.", name=word.upper().replace("O", "0"))
    )


def make_missing_number_error(line: int, column: int, letter: str, next_character: str) -> Diagnostic:
    """Return the error for a letter that is not followed by a valid number."""
    if next_character in {"+", "-"}:
        return make_error_diagnostic(
            line,
            column,
            "lone-sign",
            Message("{letter} has a sign but no number.", letter=letter),
            "Write a number after the sign.",
        )
    if next_character == ".":
        return make_error_diagnostic(
            line,
            column,
            "lone-point",
            Message("{letter} has a decimal point but no digits.", letter=letter),
            "Write the digits of the number.",
        )
    if letter not in VALUE_RANGES and letter not in {"LF", "RF", "O"}:
        return _unknown_letter(line, column, letter)
    return make_error_diagnostic(
        line,
        column,
        "number-missing",
        Message("{letter} has no number.", letter=letter),
        Message("Write a number after {letter}.", letter=letter),
    )


def make_invalid_character_error(
    line: int, column: int, character: str, *, is_after_number: bool
) -> Diagnostic:
    """Return the error for a character that cannot start a word."""
    fixed = _SIGNS.get(character) or (_AFTER_NUMBER.get(character) if is_after_number else None)
    if fixed is not None:
        return make_error_diagnostic(line, column, *fixed)
    if character in "0123456789+-.":
        return make_error_diagnostic(
            line,
            column,
            "letter-missing",
            "A number has no letter in front of it.",
            "Write a letter before the number.",
        )
    shown = character if character.isprintable() else f"U+{ord(character):04X}"
    habit = other_controls.explain_character(character)
    if habit is not None:
        what, hint = habit
        return make_error_diagnostic(
            line, column, "character", Message("'{value}' is {what}.", value=shown, what=what), hint
        )
    return make_error_diagnostic(
        line,
        column,
        "character",
        Message("'{value}' is not valid in a program for this control.", value=shown),
        "Put comments in parentheses.",
    )


def find_word_error(line: int, word: Word, digits: str | None) -> Diagnostic | None:
    """Return the error for the letter or the value of a word, or None if the word is valid."""
    letter, value, column, _ = word
    if letter not in VALUE_RANGES and letter not in {"LF", "RF", "O"}:
        return _unknown_letter(line, column, letter)
    if digits is None or value is None:
        return None
    if letter in {"G", "M"}:
        return _two_digits(line, word, digits)
    if letter not in VALUE_RANGES:
        return make_error_diagnostic(
            line,
            column,
            "number-unwanted",
            Message("{letter} does not accept a number.", letter=letter),
            "Remove this text from the program.",
        )
    if sum(sign.isdigit() for sign in digits) > _MAX_DIGITS:
        return make_error_diagnostic(
            line,
            column,
            "number-too-long",
            Message("{letter} has more than {most_digits} digits.", letter=letter, most_digits=_MAX_DIGITS),
            "Round the number.",
        )
    return _size(line, word, digits)


def _tool(text: str, _value: float) -> tuple[str, str, str]:
    habit = other_controls.explain_foreign_tool(text)
    return (
        "tool-number",
        *(
            habit
            or (
                Message("{text}: tools are T1 to T32.", text=text),
                "Correct the tool number; T0 cancels the tool.",
            )
        ),
    )


def _offset(text: str, _value: float) -> tuple[str, str, str]:
    return (
        "offset-number",
        Message("{text}: offset numbers are 1 to 32.", text=text),
        ("Correct the offset number; D0 cancels the offset."),
    )


def _no_feed(text: str, value: float) -> tuple[str, str, str] | None:
    if value < 0:
        return (
            "out-of-range",
            Message("{text}: a feed rate cannot be negative.", text=text),
            "Remove the sign.",
        )
    if value:
        return None
    return (
        "out-of-range",
        Message("{text}: the axes do not move at a feed rate of 0; G00 programs a rapid.", text=text),
        ("Write the feed rate."),
    )


_SIZES: dict[str, Callable[[str, float], tuple[str, str, str] | None]] = {
    "T": _tool,
    "D": _offset,
    "F": _no_feed,
}


def _size(line: int, word: Word, digits: str) -> Diagnostic | None:
    letter, value, column, text = word
    least, most = VALUE_RANGES[letter]
    if letter in WHOLE_NUMBER_LETTERS and not digits.isdigit():
        return make_error_diagnostic(
            line,
            column,
            "whole-number",
            Message("{text} must be a whole number without a sign.", text=text),
            "Round the number and remove any sign.",
        )
    if value is None or least <= value <= most:
        return None
    special = _SIZES.get(letter)
    if special is not None and (fault := special(text, value)) is not None:
        return make_error_diagnostic(line, column, *fault)
    if letter == "LS":
        message = Message(
            "{text} is out of range: the loop count must be from {minimum} to {maximum}.",
            text=text,
            minimum=f"{least:g}",
            maximum=f"{most:,.0f}",
        )
        return make_error_diagnostic(line, column, "loop-count", message, "Correct the loop count.")
    return make_error_diagnostic(
        line,
        column,
        "out-of-range",
        Message(
            "{text} is out of range: {letter} must be from {minimum} to {maximum}.",
            text=text,
            letter=letter,
            minimum=f"{least:g}",
            maximum=f"{most:g}",
        ),
        "Look for a missing decimal point.",
    )


def _two_digits(line: int, word: Word, digits: str) -> Diagnostic | None:
    if len(digits) == 2 and digits.isdigit():
        return None
    code = f"{word.letter.lower()}-digits"
    value = word.value if word.value is not None and 0 <= word.value < 10 else None
    hint = (
        Message("Write {letter}{plain}.", letter=word.letter, plain=f"{int(value):02d}")
        if value is not None and digits.isdigit()
        else "Write two digits."
    )
    return make_error_diagnostic(
        line,
        word.column,
        code,
        Message("{word}: {letter} must have exactly two digits.", word=word.text, letter=word.letter),
        hint,
    )


def _unknown_letter(line: int, column: int, letter: str) -> Diagnostic:
    if letter == "N":
        return make_error_diagnostic(
            line,
            column,
            "n-word",
            "This control does not use line numbers: N is not allowed.",
            "Remove the N word.",
        )
    habit = other_controls.explain_foreign_word(letter)
    if habit is not None:
        return make_error_diagnostic(
            line,
            column,
            "unknown-letter",
            Message("{letter} is not a valid word on this control. {habit}", letter=letter, habit=habit[0]),
            habit[1],
        )
    said = Message("{letter} is not a valid word on this control.", letter=letter)
    return make_error_diagnostic(line, column, "unknown-letter", said, other_controls.CODE_LIST_HINT)
