"""Where a program goes next: into subprograms with their parameters, back at M17, REPEAT, and its end."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field

from core.interpreter.endless_loops import ENDLESS, LoopWatch
from core.interpreter.interpretation import DEEPEST_CALL
from core.interpreter.sinumerik.control_structures import belonging, find_label, follow
from core.interpreter.sinumerik.parameter_passing import Saved, handed_over
from core.interpreter.sinumerik.sinumerik_state import State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.interpreter.sinumerik.variables import Scope
from core.language.diagnostics import Diagnostic, ProgramError
from core.language.sinumerik.cycle_names import CYCLES_OUTSIDE
from core.language.sinumerik.program_jumps import Jump, Steering
from core.language.sinumerik.sinumerik_alarms import NESTING, NO_TARGET, fault
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import Line
from core.language.sinumerik.subprogram_files import Section, program_name, sections
from core.language.sinumerik.third_axis_name import OWN
from core.language.source import Source
from core.message import Message


@dataclass(slots=True)
class Routine:
    """One program of one file. ``shown`` names it in findings where it is of another file."""

    source: Source
    lines: range
    shown: str = ""
    third_axis: str = OWN  # its name at this machine
    repeats: bool = False  # lines of it may run many times, and are kept once they are read
    _read: dict[int, Line] = field(default_factory=dict)
    _labelled: dict[str, tuple[int, ...]] = field(default_factory=dict)
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
        line = self._read.get(at)
        if line is None:
            line = lex_line(at + 1, self.source.lines[at], self.third_axis)
            if self.repeats:
                self._read[at] = line
        return line

    def labelled(self, label: str) -> tuple[int, ...]:
        """Indices, rising, of the lines with this label or block number; looked for once."""
        if label not in self._labelled:
            self._labelled[label] = tuple(at for at in self.lines if self._bears(at, label))
        return self._labelled[label]

    def _bears(self, at: int, label: str) -> bool:
        """Only a line that holds the letters of the label is worth being read for it."""
        if label not in self.source.lines[at].upper():
            return False
        line = self.line(at)
        return label in {line.label, line.block}

    def heading(self) -> Jump | None:
        """Its PROC, which stands before everything else; None without one."""
        first = self.first()
        jump = None if first is None else first.jump
        return jump if jump is not None and jump.steering is Steering.PROCEDURE else None

    def first(self) -> Line | None:
        """Its first line that holds more than a comment."""
        lines = (self.line(at) for at in self.lines)
        return next((line for line in lines if line.executable), None)


@dataclass(slots=True)
class _Repeat:
    """Lines that REPEAT runs again: ``start`` to before ``end``, ``left`` times more; then on at ``back``."""

    start: int
    end: int
    left: int
    back: int


@dataclass(slots=True)
class _Call:
    routine: Routine
    at: int  # index of the line to go on with
    passes: int
    place: int  # line of the main file from which it was called, for what is shown
    modal: bool = False  # MCALL has called it, or a program that has
    scope: Scope = field(default_factory=Scope)
    references: list[tuple[str, str]] = field(default_factory=list)  # VAR: its name here, and the caller's
    saved: Saved | None = None  # what SAVE brings back
    repeats: list[_Repeat] = field(default_factory=list)


class Flow:
    """The place in a program and its subprograms."""

    def __init__(self, source: Source, state: State) -> None:
        found, axis = sections(source), state.setup.limits.third_axis
        self._state = state
        self._known = {name: Routine(source, lines, third_axis=axis) for name, lines in found[1:] if name}
        for each in source.subprograms:
            first: Section = sections(each)[0]
            routine = Routine(each, first.lines, each.name, axis)
            self._known.setdefault(program_name(each), routine)
        self._main = Routine(source, found[0].lines, third_axis=axis)
        start = found[0].lines.start
        self._calls = [_Call(self._main, start, 1, 0, scope=state.variables.scope)]
        read = (source, *source.subprograms)
        self._loops = None if any(map(_reads_positions, read)) else LoopWatch()

    @property
    def called(self) -> bool:
        """Whether the place is in a subprogram."""
        return len(self._calls) > 1

    @property
    def outside(self) -> bool:
        """Whether the place is in a subprogram of another file."""
        return bool(self._calls and self._calls[-1].routine.shown)

    @property
    def routines(self) -> tuple[Routine, ...]:
        """All programs that are known, the main one first."""
        return self._main, *self._known.values()

    @property
    def by_modal_call(self) -> bool:
        """Whether the place is in what MCALL has called, which calls nothing by itself."""
        return bool(self._calls) and self._calls[-1].modal

    @property
    def running(self) -> Routine:
        """The program that is being executed."""
        return self._calls[-1].routine

    def next(self) -> Line | None:
        """The next line; None where the whole program is at its end."""
        while self._calls:
            call = self._calls[-1]
            if call.repeats and call.at == call.repeats[-1].end:
                self._repeat(call)
            elif call.at < call.routine.lines.stop:
                at, call.at = call.at, call.at + 1
                return call.routine.line(at)
            else:
                self.back()
        return None

    def _repeat(self, call: _Call) -> None:
        """The end of what REPEAT runs: again, or on behind it."""
        part = call.repeats[-1]
        part.left -= 1
        if part.left > 0:
            call.at = part.start
        else:
            call.repeats.pop()
            call.at = part.back

    def back(self) -> None:
        """M17, RET, or the last line of a subprogram: again, or on behind the call."""
        call = self._calls[-1]
        call.passes -= 1
        call.repeats.clear()
        if call.passes > 0:
            call.at = call.routine.lines.start
            return
        self._calls.pop()
        if self._calls:
            self._return_to(self._calls[-1], call)

    def _return_to(self, caller: _Call, call: _Call) -> None:
        variables = self._state.variables
        variables.scope = caller.scope
        for name, outer in call.references:
            variables.keep(outer, call.scope.numbers[name])
        if call.saved is not None:
            call.saved.bring_back(self._state)

    def end(self) -> None:
        """M2 or M30: nothing comes any more."""
        self._calls.clear()

    def knows(self, name: str) -> bool:
        """Whether there is a program of this name."""
        return name in self._known

    def routine(self, name: str) -> Routine | None:
        """The program of this name; None where there is none."""
        return self._known.get(name)

    def call(self, line: Line, *, modal: bool = False) -> None:
        """Go to the subprogram that the line names. Raises ProgramError where there is none, or too deep."""
        routine = self._known.get(line.call)
        if routine is None:
            raise _missing(line)
        if len(self._calls) > DEEPEST_CALL:
            text = Message(
                "subprogram calls are nested more than {deepest_call} levels deep.", deepest_call=DEEPEST_CALL
            )
            raise _refused(line, "recursion", text, "A subprogram must not call itself.")
        heading = routine.heading()
        first = routine.first()
        if first is not None and first.errors:  # told when it is run; nobody knows what it takes
            line = line._replace(arguments=None)
        routine.repeats = True
        scope, references = handed_over(self._state, line, heading)
        saved = Saved.of(self._state) if heading is not None and heading.saves else None
        place = self.shown_line(line.number)
        modal = modal or self.by_modal_call
        self._calls.append(
            _Call(routine, routine.lines.start, line.passes, place, modal, scope, references, saved)
        )
        self._state.variables.scope = scope

    def steer(self, line: Line, jump: Jump, state: State) -> None:
        """A line of GOTO, IF, CASE, WHILE, FOR, LOOP, REPEAT, DEF or MSG. Raises ProgramError."""
        call = self._calls[-1]
        if jump.steering in _AGAIN and jump.target:
            self._begin_repeat(call, line, jump, state)
            return
        at = follow(line, jump, state, call.routine, call.at - 1)
        if jump.steering is Steering.RETURN:
            self.back()
        elif at is not None:
            back = at < call.at
            call.routine.repeats = call.routine.repeats or back
            call.at = at
            if back and self._comes_round():
                text = (
                    "this jump repeats forever because nothing in the loop changes the result of a jump "
                    "condition."
                )
                hint = (
                    "In the loop, change a variable that the condition uses; to make another part, use "
                    "Cycle Start instead."
                )
                raise _steering_fault(line, jump, ENDLESS, text, hint)

    def _comes_round(self) -> bool:
        """Whether a jump back has met all that jumps go by before: places, variables, tool and edge."""
        if self._loops is None:
            return False
        state = self._state
        places = [
            (id(call.routine), call.at, call.passes, [(part.start, part.left) for part in call.repeats])
            for call in self._calls
        ]
        tool = state.modal.tool, state.modal.edge, state.modal.metric, state.edge, state.modal_call
        held: list[dict[int, float] | dict[str, float]] = [state.variables.r]
        held += [call.scope.numbers for call in self._calls]
        return self._loops.comes_round((places, tool, held), lambda: (places, tool, deepcopy(held)))

    def _begin_repeat(self, call: _Call, line: Line, jump: Jump, state: State) -> None:
        """REPEAT and REPEATB: the lines from one label to another, or to here; or the block of the label."""
        here = call.at - 1
        start = find_label(Steering.GOTO, jump.target, call.routine, here)
        until = find_label(Steering.GOTO, jump.until, call.routine, here) if jump.until else here
        missing = jump.target if start is None else jump.until if until is None else ""
        if start is None or until is None:
            text = Message(
                "label {missing}, which {steering} uses, is not in this program.",
                missing=missing,
                steering=jump.steering,
            )
            raise _steering_fault(line, jump, NO_TARGET, text, "Correct the label.")
        if jump.steering is Steering.REPEAT_BLOCK:
            end = start + 1
        elif jump.until:
            end = until + 1
        else:
            end = _end_label(call.routine, start, here)
        if end <= start or (start <= here < end):
            text = Message(
                "the program section to be repeated contains the {steering} block or does not "
                "end before that block.",
                steering=jump.steering,
            )
            raise _steering_fault(
                line,
                jump,
                NESTING,
                text,
                "Put the whole section to be repeated before or after this block.",
            )
        passes = 1
        if jump.passes is not None:
            passes = int(state.worth(jump.passes, lambda c, t, h: _steering_fault(line, jump, c, t, h)))
        if not 1 <= passes <= _MOST_PASSES or len(call.repeats) >= DEEPEST_CALL:
            text = Message("P{passes} is not a valid repeat count.", passes=passes)
            raise _steering_fault(
                line,
                jump,
                "passes",
                text,
                Message("Write a repeat count from P1 to P{most_passes}.", most_passes=_MOST_PASSES),
            )
        call.routine.repeats = True
        call.repeats.append(_Repeat(start, end, passes, call.at))
        call.at = start

    def shown_line(self, number: int) -> int:
        """The line of the main file that stands for line ``number`` of the running program."""
        call = self._calls[-1] if self._calls else None
        return call.place if call is not None and call.routine.shown else number

    def located(self, found: Diagnostic) -> Diagnostic:
        """A finding in a subprogram of another file: told at its call, with the file and line in its text."""
        shown = self._calls[-1].routine.shown if self._calls else ""
        if not shown:
            return found
        message = Message("{source} line {line}: {value}", source=shown, line=found.line, value=found.message)
        place = self.shown_line(found.line)
        return Diagnostic(place, 0, found.severity, found.code, message, found.hint)


_AGAIN = frozenset({Steering.REPEAT, Steering.REPEAT_BLOCK})
_MOST_PASSES = 9999


def _end_label(routine: Routine, start: int, here: int) -> int:
    """Where the part of REPEAT with one label ends: at ENDLABEL, at the REPEAT itself, with the program."""
    for at in range(start, routine.lines.stop):
        if at == here:
            return here
        if routine.line(at).label == "ENDLABEL":
            return at + 1
    return routine.lines.stop


def _reads_positions(source: Source) -> bool:
    """Whether a program asks where the axes stand, so that jumps may go by what no variable shows."""
    return any("$AA_I" in line.upper() or "$P_EP" in line.upper() for line in source.lines)


def ends_main(statement: Statement, *, called: bool) -> bool:
    """Whether the block ends the whole program; in a subprogram M2 and M30 lead back as M17 does."""
    return statement.ends and not called


def _missing(line: Line) -> ProgramError:
    if reason := CYCLES_OUTSIDE.get(line.call):
        return _refused(
            line,
            "not-in-subset",
            Message("{word}: {problem}.", word=line.call, problem=reason),
            "Remove this text from the program.",
        )
    text = Message("subprogram {call} does not exist.", call=line.call)
    hint = Message(
        "Put {named}.spf in the main program's folder, or add %_N_{named2}_SPF to the main program's file.",
        named=line.call,
        named2=line.call,
    )
    return _refused(line, "subprogram-missing", text, hint)


def _refused(line: Line, code: str, text: str, hint: str) -> ProgramError:
    return ProgramError(fault(line.number, line.call_column, code, line.block, text, hint))


def _steering_fault(line: Line, jump: Jump, code: int | str, text: str, hint: str) -> ProgramError:
    return ProgramError(fault(line.number, jump.column, code, line.block, text, hint))
