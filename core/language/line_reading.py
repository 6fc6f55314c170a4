"""Helpers for the readers of all languages: position, blanks, comments and numbers."""

from __future__ import annotations

import re

UNSIGNED = r"(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
"""Pattern of a number without a sign."""

SIGNED = rf"[+-]?{UNSIGNED}"


class LineReader:
    """A position in a line at which patterns are matched. ``upper`` is the line in capitals."""

    def __init__(self, upper: str, at: int = 0) -> None:
        self.upper = upper
        self.at = at

    @property
    def done(self) -> bool:
        """Whether only blanks follow."""
        return not self.upper[self.at :].strip()

    def blanks(self) -> None:
        """Move to the next character that is not a blank."""
        if self.upper[self.at : self.at + 1].isspace():
            self.at = after_blanks(self.upper, self.at)

    def take(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """Return the match of the pattern at this position and move past it; None without a match."""
        match = pattern.match(self.upper, self.at)
        if match is not None:
            self.at = match.end()
        return match


def after_blanks(text: str, at: int) -> int:
    """Return the index of the next character that is not a blank, or the length of the text."""
    end = len(text)
    while at < end and text[at].isspace():
        at += 1
    return at


def comment_start(text: str) -> int:
    """Return the index of the semicolon that begins the comment, or the length of the text without a comment.

    A semicolon in a quoted text does not begin a comment.
    """
    at = text.find(";")
    while at >= 0 and text.count('"', 0, at) % 2:
        at = text.find(";", at + 1)
    return len(text) if at < 0 else at


def after_signs(text: str, at: int, signs: int) -> int:
    """Return the index after this number of characters that are not blanks."""
    while signs and at < len(text):
        signs -= not text[at].isspace()
        at += 1
    return at


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


def typed(sign: str) -> tuple[str, str] | None:
    """Return the description of a typographic character and the text to type instead.

    Returns None for any other character.
    """
    return _SIGNS.get(sign)


def ascii_upper(text: str) -> str:
    """Return the text in capitals with the same length; non-ASCII characters such as ``ß`` are unchanged."""
    return text.upper() if text.isascii() else "".join(s.upper() if s.isascii() else s for s in text)
