"""Recognition of ISO codes and tool kinds in the remarks of tool tables.

An example is ``CNMG 120408 MCLNR 2020K12 rough``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import pairwise

from core.part.insert_codes import InsertCodeError, decode_insert_code, parse_holder
from core.part.tool_shape import ROUND_TOOLS

ROUND_KINDS = frozenset(kind.value for kind in ROUND_TOOLS)
_INSERT = re.compile(r"[A-Z]{3,4}-?\d[\dTSM.]{2,6}[A-Z]{0,3}(?:-[A-Z0-9]+)?")
_HOLDER = re.compile(r"(?:[ACES]\d\d[A-Z]?-?)?[CDMPSWX][CDEKMPRSTVWHO][A-Y][A-Z]([RLN])[-\dA-Z]*")
_BAR = re.compile(r"[ACES]\d\d")
_HANDS = {"R": "right", "L": "left", "N": "neutral"}
_KIND_WORDS: tuple[tuple[str, str], ...] = (
    (r"cent(?:er|re)[\s-]?drill", "centre-drill"),
    (r"spot[\s-]?drill|drill", "drill"),
    (r"end[\s-]?mill|slot\s?drill", "end-mill"),
    (r"ream(?:er)?", "reamer"),
    (r"tap", "tap"),
    (r"thread(?:ing)?", "threading"),
    (r"part(?:ing)?[\s-]?off|parting|cut[\s-]?off", "parting"),
    (r"groov(?:e|ing)", "grooving"),
    (r"bor(?:e|ing)(?:[\s-]?bar)?", "boring"),
)
_KINDS = tuple((re.compile(rf"\b(?:{words})\b", re.IGNORECASE), kind) for words, kind in _KIND_WORDS)


def recognize_shape_fields(text: str) -> dict[str, str]:
    """Return the tool fields that the ISO codes and other words of a remark specify, by field name."""
    words = text.upper().replace(",", " ").replace(";", " ").split()
    candidates = [*(f"{one}{two}" for one, two in pairwise(words)), *words]
    insert = next(_inserts(candidates), "")
    holder, hand = next(_holders(candidates), ("", ""))
    kind = recognize_tool_kind(text) or _kind_of(insert, holder)
    if kind in ROUND_KINDS:
        return {"kind": kind}
    found = {"kind": kind, "hand": hand, "insert": insert, "holder": holder}
    return {name: value for name, value in found.items() if value}


def recognize_tool_kind(text: str) -> str:
    """Return the kind of tool that a remark mentions, or an empty string if it mentions none."""
    return next((kind for words, kind in _KINDS if words.search(text)), "")


def is_insert_code(code: str) -> bool:
    """Return whether a text is a valid code of an insert."""
    try:
        decode_insert_code(code)
    except InsertCodeError:
        return False
    return True


def _inserts(words: list[str]) -> Iterator[str]:
    return (word for word in words if _INSERT.fullmatch(word) and is_insert_code(word))


def _holders(words: list[str]) -> Iterator[tuple[str, str]]:
    for word in words:
        match = _HOLDER.fullmatch(word)
        if match and parse_holder(word) is not None:
            yield word, _HANDS[match[1]]


def _kind_of(insert: str, holder: str) -> str:
    """Return the kind of tool that the ISO codes imply.

    A round boring bar implies boring; otherwise the kind is turning.
    """
    if holder and _BAR.match(holder):
        return "boring"
    return "turning" if insert or holder else ""


def get_tool_hand(letter: str) -> str:
    """Return the hand of the tool for the letter R, L or N, or an empty string for any other letter."""
    hands: Mapping[str, str] = _HANDS
    return hands.get(letter.strip().upper(), "")
