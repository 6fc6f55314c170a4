"""Log of the diagnostics of one pass through a program."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace

from core.language.diagnostics import Diagnostic, Severity
from core.message import worded

MOST_OF_A_KIND = 100
MOST_COUNTED = 10_000

REPEATS = frozenset({"finer-than-step", "dwell-too-short", "comment-in-loop", "n-word"})
"""What is wrong in the same way in line after line: told once, where it is first, with its count."""

_HABITS = frozenset({"g-digits", "m-digits", "tool-number", "g-unknown", "m-unknown", "unknown-letter",
    "other-control", "character", "comma", "letter-o", "letter-l"})  # fmt: skip
"""Habits of an author: from ``_FEW`` on of one form, they are one finding with its count."""

_FEW = 5
_DIGITS = re.compile(r"[0-9.]+")


def without_repeats(found: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the findings with each repeated finding only at its first location, with its count."""
    each_once = list(
        {(each.code, each.severity, each.line, each.column, each.message): each for each in found}.values()
    )
    often = Counter(_form(each) for each in each_once)
    kept: dict[object, Diagnostic] = {}
    for place, each in enumerate(each_once):
        repeats = each.code in REPEATS or (each.code in _HABITS and often[_form(each)] >= _FEW)
        key: object = _form(each) if repeats else place
        known = kept.get(key)
        kept[key] = each if known is None else replace(known, count=known.count + each.count)
    return list(kept.values())


def _form(found: Diagnostic) -> object:
    """Return a key that is equal for findings that differ only in location and numbers."""
    text = "" if found.code in REPEATS else _DIGITS.sub("", found.message)
    return found.code, found.severity, text


class Log:
    """Log of findings.

    Each combination of line, code and column is stored once, up to 100 errors and 100 others.
    """

    def __init__(self, first: Iterable[Diagnostic] = ()) -> None:
        self.found: list[Diagnostic] = list(first)
        self._repeated: dict[str, int] = {}  # code → index in ``found``
        self._counted = 0
        self.errors = [each for each in self.found if each.severity is Severity.ERROR]
        self._known = {(each.line, each.code, each.column) for each in self.found}
        self._others = len(self.found) - len(self.errors)

    @property
    def full(self) -> bool:
        """Whether the log has so many errors that the pass can end."""
        return len(self.errors) >= MOST_OF_A_KIND

    @property
    def silent(self) -> bool:
        """Whether the log has reached its limit of warnings and notes."""
        return self._others >= MOST_OF_A_KIND or self._counted >= MOST_COUNTED

    def add(self, found: Diagnostic) -> None:
        """Store a finding, unless it is already in the log or the limit of its kind is reached."""
        key = (found.line, found.code, found.column)
        if key in self._known:
            return
        if found.severity is Severity.ERROR:
            if self.full:
                return
            self.errors.append(found)
        elif self.silent:
            return
        elif found.code in REPEATS:
            self._known.add(key)
            self._once(found)
            return
        else:
            self._others += 1
        self._known.add(key)
        self.found.append(found)

    def _once(self, found: Diagnostic) -> None:
        at = self._repeated.get(found.code)
        if at is None:
            self._repeated[found.code] = len(self.found)
            self._others += 1
            self.found.append(found)
        else:
            self._counted += 1
            self.found[at] = replace(self.found[at], count=self.found[at].count + 1)

    def again(self, found: Diagnostic) -> None:
        """Replace the text and increase the count of the earlier finding with the same code.

        The finding remains at its first location.
        """
        key = (found.line, found.code, found.column)
        if key in self._known:
            return
        self._known.add(key)
        for at, each in enumerate(self.found):
            if each.code == found.code:
                self.found[at] = replace(found, line=each.line, column=each.column, count=each.count + 1)
                return
        self._others += 1
        self.found.append(found)

    def warn(self, line: int, column: int, code: str, text: str, hint: str = "", /, **values: object) -> None:
        """Store a warning; ``values`` are the values for the placeholders of ``text`` and ``hint``."""
        found = Diagnostic(line, column, Severity.WARNING, code, worded(text, values), worded(hint, values))
        self.add(found)
