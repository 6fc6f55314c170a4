"""Diagnostics as they come up in a pass through a program, and the errors that end one."""

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
    """Findings in which what repeats is told at its first place, with its count."""
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
    """What findings have in common that differ in place and numbers alone."""
    text = "" if found.code in REPEATS else _DIGITS.sub("", found.message)
    return found.code, found.severity, text


class Log:
    """Keeps each finding once (by line, code and column), at most 100 errors and 100 others."""

    def __init__(self, first: Iterable[Diagnostic] = ()) -> None:
        self.found: list[Diagnostic] = list(first)
        self._repeated: dict[str, int] = {}  # code → place in what was found
        self._counted = 0
        self.errors = [each for each in self.found if each.severity is Severity.ERROR]
        self._known = {(each.line, each.code, each.column) for each in self.found}
        self._others = len(self.found) - len(self.errors)

    @property
    def full(self) -> bool:
        """Whether there are so many errors that going on tells nothing more."""
        return len(self.errors) >= MOST_OF_A_KIND

    @property
    def silent(self) -> bool:
        """Whether there are so many warnings and notes that no further one is kept or counted."""
        return self._others >= MOST_OF_A_KIND or self._counted >= MOST_COUNTED

    def add(self, found: Diagnostic) -> None:
        """Keep a finding unless it is known or there are too many."""
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
        """The same as has been told, at another place: it stays where it was, with a new text and count."""
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
        """Keep a warning; ``values`` fill the holes of ``text`` and ``hint``."""
        found = Diagnostic(line, column, Severity.WARNING, code, worded(text, values), worded(hint, values))
        self.add(found)
