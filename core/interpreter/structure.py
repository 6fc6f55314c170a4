"""Loops, subroutines and the end of a program, found once before anything runs."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from core.interpreter import codes
from core.interpreter.statement import UNREADABLE, Statement
from core.language.diagnostics import Diagnostic, Severity

_CONTOUR_CYCLE = re.compile(r"G7[58](?![0-9])", re.IGNORECASE)


class Structure(NamedTuple):
    """Where the flow of a program goes; all positions are indices of lines, from 0."""

    loop_ends: dict[int, int]  # index of LS → index of its LF
    loop_starts: dict[int, int]
    subroutines: dict[int, int]  # number → index of its }n
    subroutine_ends: dict[int, int]  # number → index of its M99
    main_end: int  # one past the last line of the main program
    contours: dict[int, int]  # index of a G75 or G78 without P → index of its RF


class _Finder:
    """Goes once through the statements that matter for structure."""

    def __init__(self, length: int) -> None:
        self.found = Structure({}, {}, {}, {}, length, {})
        self.problems: list[Diagnostic] = []
        self._loops: list[Statement] = []
        self._inside: int | None = None  # subroutine being read
        self._job_end: int | None = None  # M30 or M02 in it after which nothing else has come, index of line
        self._ended = False
        self._stray = False  # a line that nothing reaches has been told
        self._contour: Statement | None = None  # G75 or G78 whose RF is still to come
        self._contour_lost = False  # it is on a line that cannot be read

    def take(self, made: Statement) -> None:
        if self._in_contour(made):
            return
        if made.flow == "}":
            self._open_subroutine(made)
            return
        ends_job = _ends(made) and not made.block_delete
        self._job_end = made.line - 1 if ends_job and self._inside is not None else None
        if made.flow == "M99":
            self._close_subroutine(made)
        elif self._ended and self._inside is None:
            self._unreachable(made)
        elif made.flow == "LS" or _unread(made, "LS"):
            self._loops.append(made)
        elif made.flow == "LF":
            self._close_loop(made)
        elif _unread(made, "LF") and self._loops:
            self._loops.pop()
        elif self._inside is None and ends_job:
            self._end_main(made.line)

    def _in_contour(self, made: Statement) -> bool:
        """Whether the line is one of a contour, or its RF; it steers nothing then."""
        if made.flow == "RF":
            if self._contour is None and not self._contour_lost:
                self._refuse(made, "rf-alone", "RF ends no contour here.", "Add G75 or G78, or take it out.")
            elif self._contour is not None:
                self.found.contours[self._contour.line - 1] = made.line - 1
            self._contour, self._contour_lost = None, False
            return True
        if made.flow == UNREADABLE and _CONTOUR_CYCLE.search(made.text):
            self._contour_lost = True  # told already; its RF is no second mistake
        if made.flow in {"}", "M99"} or made.m in codes.ENDS:
            self._open_contour()
        inside = self._contour is not None
        if not inside and made.one_shot in codes.CONTOUR_CYCLES and "P" not in made.words:
            self._contour = made
        return inside

    def _open_contour(self) -> None:
        made, self._contour = self._contour, None
        if made is not None:
            text = f"The contour of G{made.one_shot} has no RF."
            hint = "Write RF alone on the line after it, or P with the number of a subroutine."
            self._refuse(made, "contour-open", text, hint)

    def _end_main(self, line: int) -> None:
        self._ended = True
        self._unclosed_loops()
        self.found = self.found._replace(main_end=min(line, self.found.main_end))

    def _open_subroutine(self, made: Statement) -> None:
        if self._inside is not None and not self._closed_by_job_end(self._inside):
            self._refuse(
                made, "subroutine-open", f"}}{self._inside} has no M99 before this line.", "Add M99."
            )
        elif not self._ended:
            self._no_end(made.line - 1)
        self._unclosed_loops()
        self._job_end = None
        number = int(made.value("}") or 0)
        if number in self.found.subroutines:
            first = self.found.subroutines[number] + 1
            text = f"Subroutine {number} begins on line {first} already."
            self._refuse(made, "subroutine-twice", text, "Give it another number.")
        else:
            self.found.subroutines[number] = made.line - 1
        self._inside, self._stray = number, False

    def _close_subroutine(self, made: Statement) -> None:
        if self._inside is None:
            self._refuse(made, "m99-outside", "M99 ends no subroutine here.", "Take it out.")
            return
        self._unclosed_loops()
        self.found.subroutine_ends.setdefault(self._inside, made.line - 1)
        self._inside = None

    def _closed_by_job_end(self, number: int) -> bool:
        """An M30 or M02 ends the job from inside a subroutine, so one that ends with it needs no M99."""
        if self._job_end is None:
            return False
        self.found.subroutine_ends.setdefault(number, self._job_end)
        return True

    def _close_loop(self, made: Statement) -> None:
        if not self._loops:
            self._refuse(made, "loop-unopened", "LF ends no loop.", "Add LS with a count, or take it out.")
            return
        start = self._loops.pop().line - 1
        self.found.loop_ends[start] = made.line - 1
        self.found.loop_starts[made.line - 1] = start

    def _unclosed_loops(self) -> None:
        for made in self._loops:
            if made.flow == UNREADABLE:
                continue  # told already
            self._refuse(made, "loop-open", f"{made.text} has no LF.", "Add LF where the loop ends.")
        self._loops.clear()

    def _unreachable(self, made: Statement) -> None:
        late_end = made.m in codes.ENDS and any(each.code == "no-end" for each in self.problems)
        if not self._stray and not late_end:
            self._stray = True
            text = "This line stands after the end of the program and is in no subroutine."
            self._refuse(made, "after-end", text, "Move it before M30, or start a subroutine with }n.")

    def _no_end(self, line: int) -> None:
        self._ended = True
        text = "The main program ends without M30 or M02."
        self.problems.append(
            Diagnostic(line, 0, Severity.ERROR, "no-end", text, "M30 goes before the subroutines.")
        )
        self.found = self.found._replace(main_end=line)

    def finish(self, length: int) -> None:
        self._open_contour()
        self._unclosed_loops()
        if not self._ended:
            self._no_end(length)
        elif self._inside is not None and not self._closed_by_job_end(self._inside):
            text = f"Subroutine {self._inside} has no M99."
            line = self.found.subroutines[self._inside] + 1
            self.problems.append(
                Diagnostic(line, 1, Severity.ERROR, "subroutine-open", text, "Add M99 at its end.")
            )

    def _refuse(self, made: Statement, code: str, text: str, hint: str) -> None:
        self.problems.append(Diagnostic(made.line, 1, Severity.ERROR, code, text, hint))


def _ends(made: Statement) -> bool:
    """Whether the line ends the job, or was meant to."""
    return made.m in codes.ENDS or _unread(made, "M30") or _unread(made, "M02")


def _unread(made: Statement, word: str) -> bool:
    """Whether a line that cannot be read was meant as this: what follows from it is no second mistake."""
    return made.flow == UNREADABLE and made.text.lstrip(" /").upper().startswith(word)


def find_structure(statements: Iterable[Statement], length: int) -> tuple[Structure, list[Diagnostic]]:
    """The structure of a program of ``length`` lines, and what is wrong with it.

    ``statements``: its lines that are more than X and Z, in order.
    """
    finder = _Finder(length)
    calls: list[Statement] = []
    for made in statements:
        finder.take(made)
        if made.flow in codes.CALLS or (made.one_shot in codes.CONTOUR_CYCLES and made.value("P")):
            calls.append(made)
    finder.finish(length)
    for made in calls:
        number = call_target(made)
        if number not in finder.found.subroutines:
            column = made.column("P") or 1
            text = f"Subroutine {number} is called, and no }}{number} begins it."
            finder.problems.append(
                Diagnostic(
                    made.line, column, Severity.ERROR, "subroutine-missing", text, "Write it after M30."
                )
            )
    return finder.found, finder.problems


def call_target(made: Statement) -> int:
    """Number of the subroutine that a call names; M95 always means 1."""
    return 1 if made.flow == "M95" else int(made.value("P") or 0)
