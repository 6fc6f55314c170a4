"""Subroutines that nothing calls: they are read, and never proved."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.dialects import ReadProgram
from core.interpreter.omniturn.omniturn_program import Program
from core.language.diagnostics import Diagnostic, Severity


def uncalled(reading: ReadProgram) -> Iterator[Diagnostic]:
    """A note for each subroutine that no line of the main program leads to."""
    program = reading.program
    if program is None or not program.structure.subroutines:
        return
    reached = _reached(program)
    for number, at in sorted(program.structure.subroutines.items()):
        if number not in reached:
            text = f"Subroutine {number} is called from nowhere, so it was not proved."
            hint = f"Call it with M98P{number}, or take it out."
            yield Diagnostic(
                at + 1, 0, Severity.NOTE, "unreached-branch", text, hint, check="unreached-branch"
            )


def _reached(program: Program) -> set[int]:
    structure = program.structure
    calls: dict[int, set[int]] = {}
    for line, number in program.calls:
        calls.setdefault(_home(program, line - 1), set()).add(number)
    reached: set[int] = set()
    todo = [0]
    while todo:
        for number in calls.get(todo.pop(), ()):
            if number in structure.subroutines and number not in reached:
                reached.add(number)
                todo.append(number)
    return reached


def _home(program: Program, at: int) -> int:
    """The subroutine in which the line with this index stands; 0: the main program."""
    structure = program.structure
    if at < structure.main_end:
        return 0
    starts = [(start, number) for number, start in structure.subroutines.items() if start <= at]
    return max(starts)[1] if starts else 0
