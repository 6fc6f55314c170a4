"""Suppression of errors that are only consequences of a rejected line.

The control stops at the first error. The interpreter continues, so that one pass reports all independent
errors. A rejected line may have been intended to start the spindle or to set the feed. Errors that may be
consequences of such a line are reported only after the line is corrected. The patterns are compiled only
when a line is rejected.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.message import Message

_SPINDLE = frozenset({"spindle-stopped", "speed-missing", "c-unlocked"})
_FEED = frozenset({"feed-missing"})
_PLACE = frozenset({
    "arc-radius", "arc-no-radius", "arc-no-chord", "thread-side", "thread-length", "thread-angle",
    "cycle-no-way", "cycle-start-near", "cycle-quadrant", "cycle-nothing", "cycle-depth",
})  # fmt: skip
_SETS = (
    (r"M0*[34](?![0-9])|M[O0]*[34]|S[0-9.]|M19|M89|G9[67]", _SPINDLE),
    (r"F[-+0-9.O]|G9[45]", _FEED),
    (r"T[0-9O]", frozenset({"tool-first-move", "no-tool"})),
    (r"G7[0-3]|G9[01O2]|[XZ]", _PLACE),
    (r"G0*[23](?![0-9])", frozenset({"corner-without-move"})),
    (r"G35", frozenset({"thread-lead-range", "coarse-order"})),
    (r"M1[23]", frozenset({"collet-open"})),
)
"""Patterns of words on a rejected line, with the errors that can follow on later lines."""


class ConsequentFaultFilter:
    """Filter for errors that may be consequences of lines rejected earlier in the same pass."""

    def __init__(self) -> None:
        self._uncertain: set[str] = set()

    def record_rejected_line(self, text: str, *, is_position_known: bool) -> None:
        """Record a rejected line, because later errors may be its consequences.

        If ``is_position_known`` is True, the position after the line is known, so later position errors are
        reported.
        """
        code = text.upper()
        for words, codes in _SETS:
            if re.search(words, code) and not (is_position_known and codes is _PLACE):
                self._uncertain |= codes

    def is_consequence(self, code: str) -> bool:
        """Return whether an error with this code may be a consequence of a rejected line."""
        return code in self._uncertain


# the center words of an arc on a separate line
_CENTER = r"\s*((?:[IKR][-+]?[\d.]+\s*)+)(?:\(.*)?$"
_BARE_ARC = r"[^(IKR]*(?P<arc>G0[23])[^(IKR]*(?:\(.*)?$"
_SHORT_END = r"M2\b"


def remove_consequent_findings(findings: Sequence[Diagnostic], lines: Sequence[str]) -> list[Diagnostic]:
    """Return the findings without those that are consequences of another finding.

    An arc whose center words are on the next line counts as one error. After a rejected M2, no line is
    reported as a line after the program end.
    """
    ends = any(each.code == "m-digits" and re.match(_SHORT_END, each.message) for each in findings)
    rest = [each for each in findings if not (ends and each.code == "after-end")]
    return [_divided_arc(each, lines) or each for each in rest]


def _divided_arc(finding: Diagnostic, lines: Sequence[str]) -> Diagnostic | None:
    """Return the finding for an arc with its center words on the next line, or None otherwise."""
    if finding.code != "word-unused" or finding.line < 2:
        return None
    arc, center = re.match(_BARE_ARC, lines[finding.line - 2]), re.match(_CENTER, lines[finding.line - 1])
    if arc is None or center is None:
        return None
    text = "The arc center is programmed on the next line."
    hint = Message("Write {word} on the same line as the arc.", word=center.group(1).strip())
    return make_error_diagnostic(finding.line - 1, arc.start("arc") + 1, "arc-centre-missing", text, hint)
