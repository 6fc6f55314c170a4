"""Diagnostics as they come up while a program is gone through."""

from __future__ import annotations

from collections.abc import Iterable

from core.language.diagnostics import Diagnostic, Severity

MOST_OF_A_KIND = 100


class Log:
    """Keeps each finding once (by line, code and column), at most 100 errors and 100 others."""

    def __init__(self, first: Iterable[Diagnostic] = ()) -> None:
        self.found: list[Diagnostic] = list(first)
        self.errors = [each for each in self.found if each.severity is Severity.ERROR]
        self._known = {(each.line, each.code, each.column) for each in self.found}
        self._others = len(self.found) - len(self.errors)

    @property
    def full(self) -> bool:
        """Whether there are so many errors that going on tells nothing more."""
        return len(self.errors) >= MOST_OF_A_KIND

    @property
    def silent(self) -> bool:
        """Whether there are so many warnings and notes that no further one is kept."""
        return self._others >= MOST_OF_A_KIND

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
        else:
            self._others += 1
        self._known.add(key)
        self.found.append(found)

    def warn(self, line: int, column: int, code: str, message: str, hint: str = "") -> None:
        """Keep a warning."""
        self.add(Diagnostic(line, column, Severity.WARNING, code, message, hint))


def refusal(line: int, column: int, code: str, message: str, hint: str = "") -> Diagnostic:
    """An error diagnostic."""
    return Diagnostic(line, column, Severity.ERROR, code, message, hint)
