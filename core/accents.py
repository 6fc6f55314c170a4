"""Removal of accents from a text."""

from __future__ import annotations

from unicodedata import combining, normalize


def remove_accents(text: str) -> str:
    """Return a text in which letters with an accent are replaced with their base letters.

    Compatible forms, such as ligatures, are also replaced (Unicode normalization form NFKD).
    """
    return "".join(each for each in normalize("NFKD", text) if not combining(each))
