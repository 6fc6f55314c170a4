"""Typographic characters that word processors and web pages put where a keyboard has simple ones."""

from __future__ import annotations

_SIGNS: dict[str, tuple[str, str]] = {
    **dict.fromkeys("−–—‐‑‒﹣－", ("no minus sign of the keyboard", "Type -.")),
    **dict.fromkeys("＋﹢", ("no plus sign of the keyboard", "Type +.")),
    **dict.fromkeys("．·‧", ("no decimal point of the keyboard", "Type a point.")),
    **dict.fromkeys("‘’‚“”„\"'", ("a quotation mark, and there are none here", "Take it out.")),
    **dict.fromkeys("（［【", ("no parenthesis of the keyboard", "Type (.")),
    **dict.fromkeys("）］】", ("no parenthesis of the keyboard", "Type ).")),
    **dict.fromkeys("\u200b\u200c\u200d\u2060\ufeff\u00ad", ("a sign that nobody sees", "Take it out.")),
}


def typed(sign: str) -> tuple[str, str] | None:
    """What a character is, and what to type instead; None where it is none of these."""
    return _SIGNS.get(sign)
