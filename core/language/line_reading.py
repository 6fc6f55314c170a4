"""Helpers for the parsers of all dialects, which read positions, blanks, comments and numbers."""

from __future__ import annotations

import re

UNSIGNED_NUMBER = r"(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
"""Pattern of a number without a sign."""

SIGNED_NUMBER = rf"[+-]?{UNSIGNED_NUMBER}"


class LineReader:
    """Reader of a line, which matches patterns at its current position in the line.

    ``uppercase_text`` is the line in capitals.
    """

    def __init__(self, uppercase_text: str, index: int = 0) -> None:
        self.uppercase_text = uppercase_text
        self.index = index

    @property
    def is_at_end(self) -> bool:
        """Return whether only blanks follow the position."""
        return not self.uppercase_text[self.index :].strip()

    def skip_blanks(self) -> None:
        """Move to the next character that is not a blank."""
        if self.uppercase_text[self.index : self.index + 1].isspace():
            self.index = find_non_blank(self.uppercase_text, self.index)

    def match_pattern(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """Return the match of the pattern at this position, and move past it.

        Returns None if the pattern does not match.
        """
        match = pattern.match(self.uppercase_text, self.index)
        if match is not None:
            self.index = match.end()
        return match


def find_non_blank(text: str, index: int) -> int:
    """Return the index of the next character that is not a blank, or the length of the text."""
    end = len(text)
    while index < end and text[index].isspace():
        index += 1
    return index


def find_comment_start(text: str) -> int:
    """Return the index of the semicolon that starts the comment, or the length of a text without a comment.

    A semicolon in a quoted text does not start a comment.
    """
    at = text.find(";")
    while at >= 0 and text.count('"', 0, at) % 2:
        at = text.find(";", at + 1)
    return len(text) if at < 0 else at


def skip_characters(text: str, index: int, count: int) -> int:
    """Return the index after ``count`` characters that are not blanks."""
    while count and index < len(text):
        count -= not text[index].isspace()
        index += 1
    return index


_SIGNS: dict[str, tuple[str, str]] = {
    **dict.fromkeys("−–—‐‑‒﹣－", ("a special minus sign, not the one on the keyboard", "Type -.")),
    **dict.fromkeys("＋﹢", ("a special plus sign, not the one on the keyboard", "Type +.")),
    **dict.fromkeys(
        "．·‧", ("a special decimal point, not the one on the keyboard", "Type a decimal point.")
    ),
    **dict.fromkeys(
        "‘’‚“”„\"'",
        ("a quotation mark, which this control does not allow", ("Remove this text from the program.")),
    ),
    **dict.fromkeys("（［【", ("a special parenthesis, not the one on the keyboard", "Type (.")),
    **dict.fromkeys("）］】", ("a special parenthesis, not the one on the keyboard", "Type ).")),
    **dict.fromkeys(
        "\u200b\u200c\u200d\u2060\ufeff\u00ad",
        ("an invisible character", ("Remove this text from the program.")),
    ),
}


def describe_typographic_character(character: str) -> tuple[str, str] | None:
    """Return the description of a typographic character and the text to type instead.

    Returns None for any other character.
    """
    return _SIGNS.get(character)


def uppercase_ascii(text: str) -> str:
    """Return the text in capitals with the same length.

    Non-ASCII characters such as ``ß`` do not change.
    """
    return text.upper() if text.isascii() else "".join(s.upper() if s.isascii() else s for s in text)
