"""Characters of a program text: those that word processors put for simple ones, and capitals."""

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


def ascii_upper(text: str) -> str:
    """In capitals, of the same length: ``ß`` and ``ı`` are nothing that could turn into words."""
    return text.upper() if text.isascii() else "".join(s.upper() if s.isascii() else s for s in text)
