"""Program flow of SINUMERIK: calls of subprograms, M17, REPEAT and the program end.

A call passes values, VAR references and defaults to PROC. SAVE restores the modal state after the call.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from itertools import chain, repeat

from core.interpreter.shared.control_flow import ENDLESS, ControlFlow, Frame, LoopWatch
from core.interpreter.shared.interpretation import DEEPEST_CALL
from core.interpreter.shared.job_setup import ZeroOffset
from core.interpreter.shared.modal_state import Modal
from core.interpreter.sinumerik.flow.control_structures import Routine, find_label, follow
from core.interpreter.sinumerik.flow.variables import Scope, place_name
from core.interpreter.sinumerik.setup.programmed_frame import ProgrammedFrame
from core.interpreter.sinumerik.sinumerik_state import Motion, State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.formulas import Parameter as Variable
from core.language.sinumerik.call_arguments import Argument, Parameter
from core.language.sinumerik.cycle_names import CYCLES_OUTSIDE
from core.language.sinumerik.program_jumps import Jump, Steering
from core.language.sinumerik.sinumerik_alarms import NESTING, NO_TARGET
from core.language.sinumerik.sinumerik_words import Line
from core.language.sinumerik.subprogram_files import program_name, sections
from core.language.source import Source
from core.message import Message

TOO_MANY = 12330
"""The alarm of a call whose arguments do not fit the parameters."""

NO_VARIABLE = 12320
OTHER_SIZE = 12360
"""Those of an argument of VAR that is no variable, and of an array with other sizes; recalled as 12330 is."""

_GROUPS = ("absolute", "metric", "diameter", "per_rev", "feed", "settable")


@dataclass(frozen=True, slots=True)
class Saved:
    """Modal G functions and frame at the call of a program with SAVE."""

    modal: Modal
    motion: Motion
    plane: int
    settable: ZeroOffset
    programmed: ProgrammedFrame

    @classmethod
    def of(cls, state: State) -> Saved:
        """Return a copy of the active functions and frame."""
        return cls(state.modal, state.motion, state.plane, state.settable, state.programmed)

    def bring_back(self, state: State) -> None:
        """Restore the G functions and the frame; F, S and M remain as the program has set them."""
        state.motion, state.plane = self.motion, self.plane
        state.settable, state.programmed = self.settable, self.programmed
        kept = {name: getattr(self.modal, name) for name in _GROUPS}
        if self.modal.per_rev == state.modal.per_rev:
            kept["feed"] = state.modal.feed
        state.adopt(state.modal._replace(**kept, rapid=self.motion == 0))
        state.derive_offsets()


def handed_over(state: State, line: Line, heading: Jump | None) -> tuple[Scope, list[tuple[str, str]]]:
    """Return the variables of the called program, and its VAR parameters with the caller's variables.

    Raises ProgramError if the arguments do not match the parameters.
    """
    parameters = () if heading is None else heading.parameters
    arguments = line.arguments or ()
    if len(arguments) > len(parameters):
        text = Message(
            "{call} accepts {parameters_count}, but the call passes {arguments_count}.",
            call=line.call,
            parameters_count=_count(len(parameters)),
            arguments_count=len(arguments),
        )
        hint = "Correct the call, or the PROC line of the subprogram."
        raise line.refuse(arguments[len(parameters)].column, TOO_MANY, text, hint)
    made = _HandOver(state, line)
    left_out = Argument(None, None, line.call_column)
    for parameter, argument in zip(parameters, chain(arguments, repeat(left_out)), strict=False):
        (made.array if parameter.sizes else made.value)(parameter, argument)
    return made.scope, made.references


class _HandOver:
    """Transfer of the arguments of a call to the parameters."""

    def __init__(self, state: State, line: Line) -> None:
        self._state, self._line = state, line
        self.scope = Scope()
        self.references: list[tuple[str, str]] = []

    def value(self, parameter: Parameter, argument: Argument) -> None:
        """Set a number or a string; an omitted argument is 0 or an empty string. Raises ProgramError."""
        given = argument if argument.given else parameter.default
        name = parameter.name
        if parameter.by_reference:
            self.references.append((name, self._place(parameter, argument)))
        if given is None:
            if parameter.kind in {"STRING", "AXIS"}:
                self.scope.texts[name] = ""
            else:
                self.scope.numbers[name] = 0.0
        elif given.text is not None:
            self.scope.texts[name] = given.text
        elif given.formula is not None:
            value = self._state.worth(given.formula, partial(self._line.refuse, given.column))
            whole = parameter.kind != "INT" or value.is_integer()
            self.scope.numbers[name] = value if whole else float(round(value))

    def array(self, parameter: Parameter, argument: Argument) -> None:
        """Copy a VAR array, whose elements are copied back after the call. Raises ProgramError."""
        line, outer, formula = self._line, self._state.variables.scope, argument.formula
        name = formula.letters if isinstance(formula, Variable) and formula.number is None else ""
        sizes = outer.sizes.get(name, ())
        if not sizes:
            text = Message(
                "{parameter} of {call} is a VAR array, so the call must pass an array.",
                parameter=parameter.name,
                call=line.call,
            )
            raise line.refuse(
                argument.column, NO_VARIABLE, text, "Pass the name of an array without an index."
            )
        asked = tuple(
            size if each is None else each for each, size in zip(parameter.sizes, sizes, strict=False)
        )
        if asked != sizes or len(parameter.sizes) != len(sizes):
            text = Message(
                "{name} has {text} elements, but this size does not match the dimensions of {parameter}.",
                name=name,
                text=" by ".join(map(str, sizes)),
                parameter=parameter.name,
            )
            hint = "Use the array sizes given in the PROC line."
            raise line.refuse(argument.column, OTHER_SIZE, text, hint)
        self.scope.define(parameter.name, 0.0, sizes)
        for inside, outside in zip(self.scope.elements(parameter.name), outer.elements(name), strict=True):
            self.scope.numbers[inside] = outer.numbers[outside]
            self.references.append((inside, outside))

    def _place(self, parameter: Parameter, argument: Argument) -> str:
        """Return the caller's variable to which VAR writes back. Raises ProgramError."""
        state, line, formula = self._state, self._line, argument.formula
        if not isinstance(formula, Variable):
            text = Message(
                "{parameter} of {call} is a VAR parameter, so the call must pass a variable.",
                parameter=parameter.name,
                call=line.call,
            )
            raise line.refuse(argument.column, TOO_MANY, text, "Pass a variable or an R parameter.")
        refuse = partial(line.refuse, line.call_column)
        return place_name(formula.letters, formula.number, lambda index: state.worth(index, refuse), refuse)


def _count(count: int) -> str:
    if not count:
        return "no parameters"
    return Message("{count} parameter" if count == 1 else "{count} parameters", count=count)


@dataclass(slots=True)
class _Repeat:
    """Lines that REPEAT executes again, from ``start`` to before ``end``.

    ``left`` is the number of repeats that remain, and ``back`` is the line at which execution then continues.
    """

    start: int
    end: int
    left: int
    back: int


@dataclass(slots=True)
class _Call(Frame[Routine]):
    passes: int = 1
    modal: bool = False  # called by MCALL, directly or indirectly
    scope: Scope = field(default_factory=Scope)
    # VAR: name in this program, and name in the caller
    references: list[tuple[str, str]] = field(default_factory=list)
    saved: Saved | None = None  # state that SAVE restores
    repeats: list[_Repeat] = field(default_factory=list)

    @property
    def standing(self) -> tuple[object, ...]:
        """The next line, and the remaining passes and repeats, for comparison."""
        return self.file, self.at, self.passes, [(each.start, each.left) for each in self.repeats]


class Flow(ControlFlow[_Call]):
    """Position in a program and its subprograms."""

    def __init__(self, source: Source, state: State) -> None:
        found, axis = sections(source), state.setup.limits.third_axis
        self._state = state
        self._known = {name: Routine(source, lines, third_axis=axis) for name, lines in found[1:] if name}
        for each in source.subprograms:
            routine = Routine(each, sections(each)[0].lines, each.name, axis)
            self._known.setdefault(program_name(each), routine)
        lines = found[0].lines
        self._main = Routine(source, lines, third_axis=axis)
        super().__init__(_Call(self._main, lines.start, lines.stop, scope=state.variables.scope))
        read = (source, *source.subprograms)
        self._loops = None if any(map(_reads_positions, read)) else LoopWatch()

    @property
    def routines(self) -> tuple[Routine, ...]:
        """All known programs, the main program first."""
        return self._main, *self._known.values()

    @property
    def by_modal_call(self) -> bool:
        """Whether the position is in a program called by MCALL, in which MCALL has no effect."""
        return self.here.modal

    @property
    def running(self) -> Routine:
        """The program that is being executed."""
        return self.here.routine

    def next(self) -> Line | None:
        """Return the next line, or None at the end of the main program."""
        while True:
            here = self.here
            if here.repeats and self.at == here.repeats[-1].end:
                self._repeat(here.repeats)
            elif self.at < self.end:
                self.at += 1
                return here.routine.line(self.at - 1)
            elif self.called:
                self.back()
            else:
                return None

    def _repeat(self, repeats: list[_Repeat]) -> None:
        """Continue at the end of a REPEAT section: repeat it, or continue after the REPEAT."""
        part = repeats[-1]
        part.left -= 1
        if part.left > 0:
            self.at = part.start
        else:
            repeats.pop()
            self.at = part.back

    def back(self) -> None:
        """End a subprogram (M17, RET or its last line): repeat it, or return to the caller."""
        call = self.here
        call.passes -= 1
        call.repeats.clear()
        if call.passes > 0:
            self.at = call.routine.lines.start
        elif not self.called:
            self.end_all()
        else:
            self.leave()
            variables = self._state.variables
            variables.scope = self.here.scope
            for name, outer in call.references:
                variables.keep(outer, call.scope.numbers[name])
            if call.saved is not None:
                call.saved.bring_back(self._state)

    def knows(self, name: str) -> bool:
        """Return whether a program with this name exists."""
        return name in self._known

    def routine(self, name: str) -> Routine | None:
        """Return the program with this name, or None."""
        return self._known.get(name)

    def call(self, line: Line, *, modal: bool = False) -> None:
        """Enter the subprogram that the line calls.

        Raises ProgramError if it does not exist or if calls are nested too deeply.
        """
        routine = self._known.get(line.call)
        if routine is None:
            raise _missing(line)
        if len(self.frames) > DEEPEST_CALL:
            text = Message(
                "subprogram calls are nested more than {deepest_call} levels deep.", deepest_call=DEEPEST_CALL
            )
            raise line.refuse(line.call_column, "recursion", text, "A subprogram must not call itself.")
        heading = routine.heading()
        first = routine.first()
        # The error is reported when the line is executed. Its parameters are unknown.
        if first is not None and first.errors:
            line = line._replace(arguments=None)
        routine.repeats = True
        scope, references = handed_over(self._state, line, heading)
        frame = _Call(routine, routine.lines.start, routine.lines.stop, scope=scope, references=references)
        if routine.shown:
            frame.file, frame.place = routine.shown, self.shown_line(line.number)
        frame.passes, frame.modal = line.passes, modal or self.by_modal_call
        if heading is not None and heading.saves:
            frame.saved = Saved.of(self._state)
        self.enter(frame)
        self._state.variables.scope = scope

    def steer(self, line: Line, jump: Jump, state: State) -> None:
        """Execute a line with a control statement. Raises ProgramError."""
        if jump.steering in _AGAIN and jump.target:
            self._begin_repeat(line, jump, state)
            return
        routine = self.running
        at = follow(line, jump, state, routine, self.at - 1)
        if jump.steering is Steering.RETURN:
            self.back()
        elif at is not None:
            back = at < self.at
            routine.repeats = routine.repeats or back
            self.at = at
            if back and self._comes_round():
                text = (
                    "this jump repeats forever because nothing in the loop changes the result of a jump "
                    "condition."
                )
                hint = (
                    "In the loop, change a variable that the condition uses; to make another part, use "
                    "Cycle Start instead."
                )
                raise line.refuse(jump.column, ENDLESS, text, hint)

    def _comes_round(self) -> bool:
        """Return whether a jump back occurs in the same state as an earlier jump.

        The loop is then endless.
        """
        if self._loops is None:
            return False
        state = self._state
        tool = state.modal.tool, state.modal.edge, state.modal.metric, state.edge, state.modal_call
        numbers = [each.scope.numbers for each in self.frames]
        return self._loops.comes_round(self, tool, state.variables.r, numbers)

    def _begin_repeat(self, line: Line, jump: Jump, state: State) -> None:
        """Start REPEAT or REPEATB.

        The section extends from one label to another or to this line, or is the block of the label.
        """
        routine, repeats, here = self.running, self.here.repeats, self.at - 1
        start = find_label(Steering.GOTO, jump.target, routine, here)
        until = find_label(Steering.GOTO, jump.until, routine, here) if jump.until else here
        if start is None or until is None:
            text = Message(
                "label {missing}, which {steering} uses, is not in this program.",
                missing=jump.target if start is None else jump.until,
                steering=jump.steering,
            )
            raise line.refuse(jump.column, NO_TARGET, text, "Correct the label.")
        if jump.steering is Steering.REPEAT_BLOCK:
            end = start + 1
        elif jump.until:
            end = until + 1
        else:
            end = _end_label(routine, start, here)
        if end <= start or (start <= here < end):
            text = Message(
                "the program section to be repeated contains the {steering} block or does not "
                "end before that block.",
                steering=jump.steering,
            )
            hint = "Put the whole section to be repeated before or after this block."
            raise line.refuse(jump.column, NESTING, text, hint)
        passes = 1
        if jump.passes is not None:
            passes = int(state.worth(jump.passes, partial(line.refuse, jump.column)))
        if not 1 <= passes <= _MOST_PASSES or len(repeats) >= DEEPEST_CALL:
            text = Message("P{passes} is not a valid repeat count.", passes=passes)
            hint = Message("Write a repeat count from P1 to P{most_passes}.", most_passes=_MOST_PASSES)
            raise line.refuse(jump.column, "passes", text, hint)
        routine.repeats = True
        repeats.append(_Repeat(start, end, passes, self.at))
        self.at = start


_AGAIN = frozenset({Steering.REPEAT, Steering.REPEAT_BLOCK})
_MOST_PASSES = 9999


def _end_label(routine: Routine, start: int, here: int) -> int:
    """Return the end of a REPEAT section with one label: ENDLABEL, the REPEAT, or the program end."""
    for at in range(start, routine.lines.stop):
        if at == here:
            return here
        if routine.line(at).label == "ENDLABEL":
            return at + 1
    return routine.lines.stop


def _reads_positions(source: Source) -> bool:
    """Return whether a program reads axis positions, on which its jumps may then depend."""
    return any("$AA_I" in line.upper() or "$P_EP" in line.upper() for line in source.lines)


def ends_main(statement: Statement, *, called: bool) -> bool:
    """Return whether the block ends the whole program; in a subprogram, M2 and M30 act like M17."""
    return statement.ends and not called


def _missing(line: Line) -> ProgramError:
    if reason := CYCLES_OUTSIDE.get(line.call):
        text = Message("{word}: {problem}.", word=line.call, problem=reason)
        return line.refuse(line.call_column, "not-in-subset", text, "Remove this text from the program.")
    text = Message("subprogram {call} does not exist.", call=line.call)
    hint = Message(
        "Put {named}.spf in the main program's folder, or add %_N_{named2}_SPF to the main program's file.",
        named=line.call,
        named2=line.call,
    )
    return line.refuse(line.call_column, "subprogram-missing", text, hint)
