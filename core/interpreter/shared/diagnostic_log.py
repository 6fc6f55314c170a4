"""Log of the diagnostics of one pass through a program."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace

from core.language.diagnostics import Diagnostic, Severity
from core.message import fill_template

MAX_FINDINGS_PER_KIND = 100
MAX_REPEAT_COUNT = 10_000

REPEATABLE_CODES = frozenset({"finer-than-step", "dwell-too-short", "comment-in-loop", "n-word"})
"""Codes of findings that recur on many lines.

Each is reported once, at its first line, with the number of occurrences.
"""

_STYLE_CODES = frozenset({"g-digits", "m-digits", "tool-number", "g-unknown", "m-unknown", "unknown-letter",
    "other-control", "character", "comma", "letter-o", "letter-l"})  # fmt: skip
"""Codes of programming habits.

From ``_FEW`` findings of the same form on, they are reported as one finding with a count.
"""

_FEW = 5
_DIGITS = re.compile(r"[0-9.]+")


def merge_repeated_findings(findings: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the findings, with repeated findings merged at their first location and counted."""
    each_once = list(
        {(each.code, each.severity, each.line, each.column, each.message): each for each in findings}.values()
    )
    often = Counter(_form(each) for each in each_once)
    kept: dict[object, Diagnostic] = {}
    for place, each in enumerate(each_once):
        repeats = each.code in REPEATABLE_CODES or (each.code in _STYLE_CODES and often[_form(each)] >= _FEW)
        key: object = _form(each) if repeats else place
        known = kept.get(key)
        kept[key] = (
            each
            if known is None
            else replace(known, occurrence_count=known.occurrence_count + each.occurrence_count)
        )
    return list(kept.values())


def _form(finding: Diagnostic) -> object:
    """Return a key for merging findings: equal if two findings differ only in location and numbers."""
    text = "" if finding.code in REPEATABLE_CODES else _DIGITS.sub("", finding.message)
    return finding.code, finding.severity, text


class DiagnosticLog:
    """Log of findings.

    The log stores each combination of line, code and column once, up to 100 errors and 100 other findings.
    """

    def __init__(self, initial_findings: Iterable[Diagnostic] = ()) -> None:
        self.findings: list[Diagnostic] = list(initial_findings)
        self._repeated: dict[str, int] = {}  # code → index in ``found``
        self._counted = 0
        self.error_findings = [each for each in self.findings if each.severity is Severity.ERROR]
        self._known = {(each.line, each.code, each.column, "") for each in self.findings}
        self._others = len(self.findings) - len(self.error_findings)

    def make_stand_in(self) -> DiagnosticLog:
        """Return an empty log, which replaces this log in a saved pass."""
        return DiagnosticLog()

    @property
    def is_full(self) -> bool:
        """Return whether the log contains so many errors that the pass can end."""
        return len(self.error_findings) >= MAX_FINDINGS_PER_KIND

    @property
    def is_warning_limit_reached(self) -> bool:
        """Return whether the log has reached its limit of warnings and notes."""
        return self._others >= MAX_FINDINGS_PER_KIND or self._counted >= MAX_REPEAT_COUNT

    def add_finding(self, finding: Diagnostic, original: Diagnostic | None = None) -> None:
        """Store a finding, unless the log already contains it or the limit of its kind is reached.

        ``original`` is the finding before its location was changed from another file to the line of the
        call. Because all findings of that file have this line, their original locations distinguish them.
        """
        place = "" if original is None or finding is original else f"{original.line}:{original.column}"
        key = (finding.line, finding.code, finding.column, place)
        if key in self._known:
            return
        if finding.severity is Severity.ERROR:
            if self.is_full:
                return
            self.error_findings.append(finding)
        elif self.is_warning_limit_reached:
            return
        elif finding.code in REPEATABLE_CODES:
            self._known.add(key)
            self._once(finding)
            return
        else:
            self._others += 1
        self._known.add(key)
        self.findings.append(finding)

    def _once(self, found: Diagnostic) -> None:
        at = self._repeated.get(found.code)
        if at is None:
            self._repeated[found.code] = len(self.findings)
            self._others += 1
            self.findings.append(found)
        else:
            self._counted += 1
            self.findings[at] = replace(
                self.findings[at], occurrence_count=self.findings[at].occurrence_count + 1
            )

    def count_repeated_finding(self, finding: Diagnostic) -> None:
        """Increase the count of the earlier finding with the same code, and replace its text.

        The finding remains at its first location.
        """
        key = (finding.line, finding.code, finding.column, "")
        if key in self._known:
            return
        self._known.add(key)
        for at, each in enumerate(self.findings):
            if each.code == finding.code:
                self.findings[at] = replace(
                    finding, line=each.line, column=each.column, occurrence_count=each.occurrence_count + 1
                )
                return
        self._others += 1
        self.findings.append(finding)

    def add_warning(
        self, line: int, column: int, code: str, text: str, hint: str = "", /, **values: object
    ) -> None:
        """Store a warning.

        ``values`` are the values for the placeholders of ``text`` and ``hint``.
        """
        found = Diagnostic(
            line, column, Severity.WARNING, code, fill_template(text, values), fill_template(hint, values)
        )
        self.add_finding(found)
