"""Characters of a program text: those that word processors put for simple ones, and capitals."""

from __future__ import annotations

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
    """What a character is, and what to type instead; None where it is none of these."""
    return _SIGNS.get(sign)


def ascii_upper(text: str) -> str:
    """In capitals, of the same length: ``ß`` and ``ı`` are nothing that could turn into words."""
    return text.upper() if text.isascii() else "".join(s.upper() if s.isascii() else s for s in text)
