"""Where a program goes next: into subprograms by name, back at M17, and its end."""

from __future__ import annotations

from dataclasses import dataclass, field

from core.interpreter.interpretation import DEEPEST_CALL
from core.interpreter.sinumerik.control_structures import belonging, follow
from core.interpreter.sinumerik.sinumerik_state import State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import Diagnostic, ProgramError
from core.language.sinumerik.program_jumps import Jump, Steering
from core.language.sinumerik.sinumerik_alarms import fault
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import Line
from core.language.sinumerik.subprogram_files import Section, program_name, sections
from core.language.source import Source


@dataclass(slots=True)
class Routine:
    """One program of one file. ``shown`` names it in findings where it is of another file."""

    source: Source
    lines: range
    shown: str = ""
    lines_read: dict[int, Line] = field(default_factory=dict)  # of what may run many times
    repeats: bool = False  # lines of it have been run again
    _partners: dict[int, tuple[int, ...]] | None = None

    def partners(self) -> dict[int, tuple[int, ...]]:
        """The lines of each IF, WHILE, FOR, LOOP and REPEAT that belong together, by each of their indices.

        Raises ProgramError where one has no end, or an end no beginning.
        """
        if self._partners is None:
            self._partners = belonging(self.line(at) for at in self.lines)
        return self._partners

    def line(self, at: int) -> Line:
        """The line with this index."""
        if at in self.lines_read:
            return self.lines_read[at]
        return lex_line(at + 1, self.source.lines[at])


@dataclass(slots=True)
class _Call:
    routine: Routine
    at: int  # index of the line to go on with
    passes: int
    place: int  # line of the main file from which it was called, for what is shown


class Flow:
    """The place in a program and its subprograms."""

    def __init__(self, source: Source) -> None:
        found = sections(source)
        self._known = {name: Routine(source, lines) for name, lines in found[1:] if name}
        for each in source.subprograms:
            first: Section = sections(each)[0]
            routine = Routine(each, first.lines, each.name)
            self._known.setdefault(program_name(each), routine)
        self._calls = [_Call(Routine(source, found[0].lines), found[0].lines.start, 1, 0)]

    @property
    def called(self) -> bool:
        """Whether the place is in a subprogram."""
        return len(self._calls) > 1

    @property
    def running(self) -> Routine:
        """The program that is being executed."""
        return self._calls[-1].routine

    def next(self) -> Line | None:
        """The next line; None where the whole program is at its end."""
        while self._calls:
            call = self._calls[-1]
            if call.at < call.routine.lines.stop:
                at, call.at = call.at, call.at + 1
                line = call.routine.line(at)
                if self.called or call.routine.repeats:
                    call.routine.lines_read[at] = line
                return line
            self.back()
        return None

    def back(self) -> None:
        """M17, or the last line of a subprogram: again, or on behind the call."""
        call = self._calls[-1]
        call.passes -= 1
        if call.passes > 0:
            call.at = call.routine.lines.start
        else:
            self._calls.pop()

    def end(self) -> None:
        """M2 or M30: nothing comes any more."""
        self._calls.clear()

    def call(self, line: Line) -> None:
        """Go to the subprogram that the line names. Raises ProgramError where there is none, or too deep."""
        routine = self._known.get(line.call)
        if routine is None:
            text = f"the subprogram {line.call} does not exist."
            hint = f"Put {line.call}.spf beside the main program, or %_N_{line.call}_SPF into its file."
            raise _refused(line, "subprogram-missing", text, hint)
        if len(self._calls) > DEEPEST_CALL:
            text = f"subprograms call each other more than {DEEPEST_CALL} deep."
            raise _refused(line, "recursion", text, "A subprogram must not call itself.")
        self._calls.append(_Call(routine, routine.lines.start, line.passes, self.shown_line(line.number)))

    def steer(self, line: Line, jump: Jump, state: State) -> None:
        """A line of GOTO, IF, WHILE, FOR, LOOP, REPEAT, DEF or MSG. Raises ProgramError."""
        call = self._calls[-1]
        at = follow(line, jump, state, call.routine, call.at - 1)
        if jump.steering is Steering.RETURN:
            self.back()
        elif at is not None:
            call.routine.repeats = call.routine.repeats or at <= call.at
            call.at = at

    def shown_line(self, number: int) -> int:
        """The line of the main file that stands for line ``number`` of the running program."""
        call = self._calls[-1] if self._calls else None
        return call.place if call is not None and call.routine.shown else number

    def located(self, found: Diagnostic) -> Diagnostic:
        """A finding in a subprogram of another file: told at its call, with the file and line in its text."""
        shown = self._calls[-1].routine.shown if self._calls else ""
        if not shown:
            return found
        message = f"{shown} line {found.line}: {found.message}"
        place = self.shown_line(found.line)
        return Diagnostic(place, 0, found.severity, found.code, message, found.hint)


def ends_main(statement: Statement, *, called: bool) -> bool:
    """Whether the block ends the whole program; M17 ends a subprogram. Raises ProgramError."""
    for code in (2, 30):
        if called and code in statement.m:
            text = f"M{code} ends a main program, and this is a subprogram."
            raise statement.refuse(statement.m[code], "end-in-subprogram", text, "Write M17.")
    return statement.ends and not called


def _refused(line: Line, code: str, text: str, hint: str) -> ProgramError:
    return ProgramError(fault(line.number, line.call_column, code, line.block, text, hint))
