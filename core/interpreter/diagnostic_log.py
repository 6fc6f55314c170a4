"""Diagnostics as they come up in a pass through a program, and what every interpreter reports of its pass."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Protocol

from core.interpreter.job_setup import ToolOffset
from core.interpreter.modal_state import Modal
from core.language.diagnostics import Diagnostic, ProgramError, Severity

MOST_OF_A_KIND = 100
MOST_COUNTED = 10_000

REPEATS = frozenset({"finer-than-step", "dwell-too-short", "comment-in-loop", "n-word"})
"""What is wrong in the same way in line after line: told once, where it is first, with its count."""


def without_repeats(found: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Findings in which what repeats is told at its first place, with its count."""
    kept: dict[object, Diagnostic] = {}
    for each in found:
        repeats = each.code in REPEATS
        place = (each.line, each.column, each.message)
        key: object = (each.code, each.severity) if repeats else (each.code, each.severity, place)
        known = kept.get(key)
        kept[key] = each if known is None else replace(known, count=known.count + each.count * repeats)
    return list(kept.values())


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

    def warn(self, line: int, column: int, code: str, message: str, hint: str = "") -> None:
        """Keep a warning."""
        self.add(Diagnostic(line, column, Severity.WARNING, code, message, hint))


def refusal(line: int, column: int, code: str, message: str, hint: str = "") -> Diagnostic:
    """An error diagnostic."""
    return Diagnostic(line, column, Severity.ERROR, code, message, hint)


def program_error(line: int, column: int, code: str, message: str, hint: str = "") -> ProgramError:
    """The exception that carries an error diagnostic."""
    return ProgramError(refusal(line, column, code, message, hint))


MOST_BLOCKS = 5_000_000
MOST_LINES = 10_000_000
"""More of either is made by no program that anybody means to run."""

DEEPEST_CALL = 16
"""Subroutines that may call each other in a chain."""


class ToolUse:
    """Tool numbers asked for so far, in the order of first use, and those whose offset has never been set."""

    def __init__(self) -> None:
        self.used: list[int] = []
        self.missing: list[int] = []

    def offset(self, number: int, offsets: Mapping[int, ToolOffset]) -> ToolOffset | None:
        """The offset of this tool, which is used from now on; None where it has never been set."""
        if number not in self.used:
            self.used.append(number)
        if number not in offsets and number not in self.missing:
            self.missing.append(number)
        return offsets.get(number)


class HasModal(Protocol):
    """The state that the blocks of a pass leave behind."""

    modal: Modal


class PassReport:
    """What every interpreter reports of its pass; all of it grows while blocks are taken."""

    _state: HasModal  # each dialect has its own

    def __init__(self, log: Log) -> None:
        self._log = log
        self._tools = ToolUse()
        self._stopped = False  # an error has been met: no more blocks

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All findings so far, those of reading the program first."""
        return self._log.found

    @property
    def failed(self) -> bool:
        """Whether there is an error among the findings so far."""
        return bool(self._log.errors)

    @property
    def modal(self) -> Modal:
        """The state after the last block that was taken."""
        return self._state.modal

    @property
    def used_tools(self) -> list[int]:
        """Tool numbers asked for so far, in the order of first use."""
        return self._tools.used

    @property
    def missing_tools(self) -> list[int]:
        """Those of them whose offset has never been set."""
        return self._tools.missing

    def _stop_endless(self, line: int, hint: str) -> None:
        """A program that makes more than anybody runs ends at this line."""
        self._stopped = True
        text = f"The program makes more than {MOST_BLOCKS:,} blocks or {MOST_LINES:,} executed lines."
        self._log.add(refusal(line, 0, "too-many-blocks", text, hint))
