"""Findings that only follow from a line that was refused: the refusal alone is reported."""

from __future__ import annotations

import re
from collections.abc import Sequence

from core.language.diagnostics import Diagnostic, refusal
from core.message import Message

_CENTER = re.compile(r"\s*((?:[IKR][-+]?[\d.]+\s*)+)(?:\(.*)?$")  # the rest of an arc, on a line of its own
_BARE_ARC = re.compile(r"[^(IKR]*(?P<arc>G0[23])[^(IKR]*(?:\(.*)?$")
_SHORT_END = re.compile(r"M2\b")


def without_follow_ups(problems: Sequence[Diagnostic], lines: Sequence[str]) -> list[Diagnostic]:
    """Return the findings without those that another one explains.

    An arc whose center is on the next line is one mistake. After a refused M2 nothing is after the end.
    """
    ends = any(each.code == "m-digits" and _SHORT_END.match(each.message) for each in problems)
    rest = [each for each in problems if not (ends and each.code == "after-end")]
    return [_divided_arc(each, lines) or each for each in rest]


def _divided_arc(found: Diagnostic, lines: Sequence[str]) -> Diagnostic | None:
    """Return the finding about the arc whose center words are those that the next line cannot use."""
    if found.code != "word-unused" or found.line < 2:
        return None
    arc, center = _BARE_ARC.match(lines[found.line - 2]), _CENTER.match(lines[found.line - 1])
    if arc is None or center is None:
        return None
    text = "The arc center is programmed on the next line."
    hint = Message("Write {word} on the same line as the arc.", word=center.group(1).strip())
    return refusal(found.line - 1, arc.start("arc") + 1, "arc-centre-missing", text, hint)
