"""Program flow of SINUMERIK: subprogram calls, M17, REPEAT and the program end.

A call passes values, VAR references and defaults to the parameters of PROC. With SAVE, the modal state is
restored after the call.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from itertools import chain, repeat

from core.interpreter.shared.control_flow import (
    ENDLESS_LOOP_CODE,
    ControlFlow,
    EndlessLoopDetector,
    FlowFrame,
)
from core.interpreter.shared.formula_values import convert_to_whole_number
from core.interpreter.shared.interpretation import MAX_CALL_DEPTH
from core.interpreter.shared.job_setup import ZeroOffset
from core.interpreter.shared.modal_state import ModalState
from core.interpreter.sinumerik.flow.control_structures import Routine, execute_control_line, find_label_index
from core.interpreter.sinumerik.flow.variables import VariableScope, format_variable_name
from core.interpreter.sinumerik.setup.programmed_frame import ProgrammedFrame
from core.interpreter.sinumerik.sinumerik_state import MotionKind, SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.formulas import Parameter as Variable
from core.language.sinumerik.call_arguments import CallArgument, ProcParameter
from core.language.sinumerik.control_statements import ControlKeyword, ControlStatement
from core.language.sinumerik.cycle_names import UNSUPPORTED_CYCLES
from core.language.sinumerik.sinumerik_alarms import JUMP_TARGET_MISSING, WRONG_NESTING
from core.language.sinumerik.sinumerik_words import LexedBlock
from core.language.sinumerik.subprogram_files import derive_program_name, split_sections
from core.language.source import ProgramSource
from core.message import Message

TOO_MANY_ARGUMENTS = 12330
"""Alarm number for a call whose arguments do not match the parameters."""

NOT_A_VARIABLE = 12320
WRONG_ARRAY_SIZE = 12360
"""Alarm number for a VAR argument that is an array of a different size."""

_GROUPS = ("absolute", "metric", "diameter", "per_rev", "feed", "settable")


@dataclass(frozen=True, slots=True)
class SavedModalFunctions:
    """The modal G functions and the frame that were active when a program with SAVE was called."""

    modal_state: ModalState
    motion_kind: MotionKind
    plane_code: int
    settable_offset: ZeroOffset
    programmed_frame: ProgrammedFrame

    @classmethod
    def from_state(cls, state: SinumerikState) -> SavedModalFunctions:
        """Return a copy of the active functions and frame."""
        return cls(state.modal, state.motion, state.plane, state.settable, state.programmed_frame)

    def restore_functions(self, state: SinumerikState) -> None:
        """Restore the G functions and the frame.

        F, S and M functions remain as the called program has set them.
        """
        state.motion, state.plane = self.motion_kind, self.plane_code
        state.settable, state.programmed_frame = self.settable_offset, self.programmed_frame
        kept = {name: getattr(self.modal_state, name) for name in _GROUPS}
        if self.modal_state.per_rev == state.modal.per_rev:
            kept["feed"] = state.modal.feed
        state.set_modal_state(state.modal._replace(**kept, rapid=self.motion_kind == 0))
        state.derive_offsets()


def pass_arguments(
    state: SinumerikState, line: LexedBlock, heading: ControlStatement | None
) -> tuple[VariableScope, list[tuple[str, str]]]:
    """Return the variables of the called program, initialized with the arguments of the call.

    Also returns pairs of a VAR parameter and the caller's variable that receives its value after the call.
    Raises ProgramError if the arguments do not match the parameters.
    """
    parameters = () if heading is None else heading.parameters
    arguments = line.arguments or ()
    if len(arguments) > len(parameters):
        text = Message(
            "{call} accepts {parameters_count}, but the call passes {arguments_count}.",
            call=line.called_name,
            parameters_count=_count(len(parameters)),
            arguments_count=len(arguments),
        )
        hint = "Correct the call, or the PROC line of the subprogram."
        raise line.make_error(arguments[len(parameters)].column, TOO_MANY_ARGUMENTS, text, hint)
    made = _ArgumentTransfer(state, line)
    left_out = CallArgument(None, None, line.call_column)
    for parameter, argument in zip(parameters, chain(arguments, repeat(left_out)), strict=False):
        (made.pass_array if parameter.dimensions else made.set_parameter)(parameter, argument)
    return made.scope, made.references


class _ArgumentTransfer:
    """Transfer of the arguments of a call to the parameters of the called program."""

    def __init__(self, state: SinumerikState, line: LexedBlock) -> None:
        self._state, self._line = state, line
        self.scope = VariableScope()
        self.references: list[tuple[str, str]] = []

    def set_parameter(self, parameter: ProcParameter, argument: CallArgument) -> None:
        """Set a parameter to a number or a string.

        An omitted argument gets the default of the parameter or, without a default, 0 or an empty string. A
        number for an INT parameter is rounded. A string is accepted for any type of parameter. Raises
        ProgramError if a VAR argument is not a variable or an argument cannot be evaluated.
        """
        given = argument if argument.is_specified else parameter.default
        name = parameter.name
        if parameter.is_by_reference:
            self.references.append((name, self._variable_name(parameter, argument)))
        if given is None:
            if parameter.type_name in {"STRING", "AXIS"}:
                self.scope.strings[name] = ""
            else:
                self.scope.numbers[name] = 0.0
        elif given.text is not None:
            self.scope.strings[name] = given.text
        elif given.formula is not None:
            value = self._state.evaluate_formula(given.formula, partial(self._line.make_error, given.column))
            whole = parameter.type_name != "INT" or value.is_integer()
            self.scope.numbers[name] = value if whole else float(round(value))

    def pass_array(self, parameter: ProcParameter, argument: CallArgument) -> None:
        """Copy a VAR array; its elements are copied back after the call.

        Raises ProgramError if the argument does not match the parameter.
        """
        line, outer, formula = self._line, self._state.variables.variable_scope, argument.formula
        name = formula.letters if isinstance(formula, Variable) and formula.number is None else ""
        sizes = outer.array_dimensions.get(name, ())
        if not sizes:
            text = Message(
                "{parameter} of {call} is a VAR array, so the call must pass an array.",
                parameter=parameter.name,
                call=line.called_name,
            )
            raise line.make_error(
                argument.column, NOT_A_VARIABLE, text, "Pass the name of an array without an index."
            )
        asked = tuple(
            size if each is None else each for each, size in zip(parameter.dimensions, sizes, strict=False)
        )
        if asked != sizes or len(parameter.dimensions) != len(sizes):
            text = Message(
                "{name} has {text} elements, but this size does not match the dimensions of {parameter}.",
                name=name,
                text=" by ".join(map(str, sizes)),
                parameter=parameter.name,
            )
            hint = "Use the array sizes given in the PROC line."
            raise line.make_error(argument.column, WRONG_ARRAY_SIZE, text, hint)
        self.scope.define_variable(parameter.name, 0.0, sizes)
        for inside, outside in zip(
            self.scope.list_element_names(parameter.name), outer.list_element_names(name), strict=True
        ):
            self.scope.numbers[inside] = outer.numbers[outside]
            self.references.append((inside, outside))

    def _variable_name(self, parameter: ProcParameter, argument: CallArgument) -> str:
        """Return the name of the caller's variable that receives the value of a VAR parameter.

        Raises ProgramError if the argument is not a variable or its index is invalid.
        """
        state, line, formula = self._state, self._line, argument.formula
        if not isinstance(formula, Variable):
            text = Message(
                "{parameter} of {call} is a VAR parameter, so the call must pass a variable.",
                parameter=parameter.name,
                call=line.called_name,
            )
            raise line.make_error(
                argument.column, TOO_MANY_ARGUMENTS, text, "Pass a variable or an R parameter."
            )
        refuse = partial(line.make_error, line.call_column)
        return format_variable_name(
            formula.letters, formula.number, lambda index: state.evaluate_formula(index, refuse), refuse
        )


def _count(count: int) -> str:
    if not count:
        return "no parameters"
    return Message("{count} parameter" if count == 1 else "{count} parameters", count=count)


@dataclass(slots=True)
class _Repeat:
    """Lines that REPEAT executes again, from ``start_index`` up to but not including ``end_index``.

    ``remaining_count`` is the number of remaining repeats, and ``return_index`` is the line at which
    execution then continues.
    """

    start_index: int
    end_index: int
    remaining_count: int
    return_index: int


@dataclass(slots=True)
class _Call(FlowFrame[Routine]):
    remaining_passes: int = 1
    is_modal: bool = False  # called by MCALL, directly or indirectly
    scope: VariableScope = field(default_factory=VariableScope)
    # VAR: name in this program, and name in the caller
    reference_parameters: list[tuple[str, str]] = field(default_factory=list)
    saved_functions: SavedModalFunctions | None = None  # state that SAVE restores
    repeats: list[_Repeat] = field(default_factory=list)
    started_loops: set[int] = field(default_factory=set)  # line indices of FOR

    @property
    def comparison_key(self) -> tuple[object, ...]:
        """Return the values that identify the execution position, for the detection of endless loops."""
        return (
            self.file_name,
            self.next_index,
            self.remaining_passes,
            [(each.start_index, each.remaining_count) for each in self.repeats],
        )


class SinumerikProgramFlow(ControlFlow[_Call]):
    """The execution position in a program and its subprograms."""

    def __init__(self, source: ProgramSource, state: SinumerikState) -> None:
        found, axis = split_sections(source), state.setup.limits.third_axis_name
        self._state = state
        self._known = {
            name: Routine(source, lines, third_axis_name=axis) for name, lines in found[1:] if name
        }
        for each in source.subprograms:
            routine = Routine(each, split_sections(each)[0].line_range, each.name, axis)
            self._known.setdefault(derive_program_name(each), routine)
        lines = found[0].line_range
        self._main = Routine(source, lines, third_axis_name=axis)
        super().__init__(_Call(self._main, lines.start, lines.stop, scope=state.variables.variable_scope))
        read = (source, *source.subprograms)
        self._loops = None if any(map(_reads_positions, read)) else EndlessLoopDetector()

    @property
    def known_routines(self) -> tuple[Routine, ...]:
        """Return all known programs, starting with the main program."""
        return self._main, *self._known.values()

    @property
    def is_in_modal_call(self) -> bool:
        """Return whether MCALL has called the active program; MCALL has no effect within it."""
        return self.active_frame.is_modal

    @property
    def active_routine(self) -> Routine:
        """Return the program that is being executed."""
        return self.active_frame.routine

    def read_next_line(self) -> LexedBlock | None:
        """Return the next line, or None at the end of the main program."""
        while True:
            here = self.active_frame
            if here.repeats and self.next_index == here.repeats[-1].end_index:
                self._repeat(here.repeats)
            elif self.next_index < self.end_index:
                self.next_index += 1
                return here.routine.get_line(self.next_index - 1)
            elif self.is_in_subprogram:
                self.end_subprogram()
            else:
                return None

    def _repeat(self, repeats: list[_Repeat]) -> None:
        """Jump back to the start of a REPEAT section, or continue after REPEAT if no repeats remain."""
        part = repeats[-1]
        part.remaining_count -= 1
        if part.remaining_count > 0:
            self.next_index = part.start_index
        else:
            repeats.pop()
            self.next_index = part.return_index

    def end_subprogram(self) -> None:
        """End a subprogram at M17, RET or its last line, and either repeat it or return to the caller."""
        call = self.active_frame
        call.remaining_passes -= 1
        call.repeats.clear()
        call.started_loops.clear()
        if call.remaining_passes > 0:
            self.next_index = call.routine.line_range.start
        elif not self.is_in_subprogram:
            self.end_program()
        else:
            self.return_to_caller()
            variables = self._state.variables
            variables.variable_scope = self.active_frame.scope
            for name, outer in call.reference_parameters:
                variables.set_value(outer, call.scope.numbers[name])
            if call.saved_functions is not None:
                call.saved_functions.restore_functions(self._state)

    def has_routine(self, name: str) -> bool:
        """Return whether a program with this name exists."""
        return name in self._known

    def find_routine(self, name: str) -> Routine | None:
        """Return the program with this name, or None if it does not exist."""
        return self._known.get(name)

    def call_subprogram(self, line: LexedBlock, *, is_modal: bool = False) -> None:
        """Enter the subprogram that the line calls.

        Raises ProgramError if the subprogram does not exist, if calls are nested too deeply, or if the
        arguments do not match the parameters.
        """
        routine = self._known.get(line.called_name)
        if routine is None:
            raise _missing(line)
        if len(self.frames) > MAX_CALL_DEPTH:
            text = Message(
                "subprogram calls are nested more than {deepest_call} levels deep.",
                deepest_call=MAX_CALL_DEPTH,
            )
            raise line.make_error(line.call_column, "recursion", text, "A subprogram must not call itself.")
        heading = routine.read_proc_statement()
        first = routine.find_first_line()
        # The error is reported when the line is executed. Its parameters are unknown.
        if first is not None and first.errors:
            line = line._replace(arguments=None)
        routine.has_repeats = True
        scope, references = pass_arguments(self._state, line, heading)
        frame = _Call(
            routine,
            routine.line_range.start,
            routine.line_range.stop,
            scope=scope,
            reference_parameters=references,
        )
        if routine.displayed_name:
            frame.file_name, frame.call_line = (
                routine.displayed_name,
                self.get_displayed_line(line.line_number),
            )
        frame.remaining_passes, frame.is_modal = line.execution_count, is_modal or self.is_in_modal_call
        if heading is not None and heading.has_save_keyword:
            frame.saved_functions = SavedModalFunctions.from_state(self._state)
        self.enter_subprogram(frame)
        self._state.variables.variable_scope = scope

    def execute_control_line(
        self, line: LexedBlock, control_statement: ControlStatement, state: SinumerikState
    ) -> None:
        """Execute a line with a control statement.

        Raises ProgramError for an invalid statement, for a jump that repeats forever, and for a FOR loop
        that a jump has entered without executing FOR.
        """
        if control_statement.keyword in _REPEAT_KEYWORDS and control_statement.target_label:
            self._begin_repeat(line, control_statement, state)
            return
        routine = self.active_routine
        if control_statement.keyword is ControlKeyword.FOR:
            self.active_frame.started_loops.add(self.next_index - 1)
        elif control_statement.keyword is ControlKeyword.END_FOR:
            self._check_loop_start(line, control_statement)
        at = execute_control_line(line, control_statement, state, routine, self.next_index - 1)
        if control_statement.keyword is ControlKeyword.RETURN:
            self.end_subprogram()
        elif at is not None:
            back = at < self.next_index
            routine.has_repeats = routine.has_repeats or back
            self.next_index = at
            if back and self._is_repeated_state():
                text = (
                    "this jump repeats forever because nothing in the loop changes the result of a jump "
                    "condition."
                )
                hint = (
                    "In the loop, change a variable that the condition uses; to make another part, use "
                    "Cycle Start instead."
                )
                raise line.make_error(control_statement.column, ENDLESS_LOOP_CODE, text, hint)

    def _check_loop_start(self, line: LexedBlock, end: ControlStatement) -> None:
        """Raise ProgramError if this line ends a FOR loop whose FOR has not been executed.

        The loop variable then has no start value, so the number of repeats is unknown.
        """
        start = self.active_routine.map_structures()[self.next_index - 1][0]
        if start not in self.active_frame.started_loops:
            text = Message("a jump entered this loop without executing FOR in line {line}.", line=start + 1)
            hint = "Jump to a label before FOR, or write a loop with WHILE."
            raise line.make_error(end.column, WRONG_NESTING, text, hint)

    def _is_repeated_state(self) -> bool:
        """Return whether a backward jump repeats an earlier state, so that the loop is endless."""
        if self._loops is None:
            return False
        state = self._state
        tool = state.modal.tool, state.modal.edge, state.modal.metric, state.edge, state.modal_call_line
        numbers = [each.scope.numbers for each in self.frames]
        return self._loops.is_repeated_state(self, tool, state.variables.r_parameters, numbers)

    def _begin_repeat(self, line: LexedBlock, jump: ControlStatement, state: SinumerikState) -> None:
        """Start REPEAT or REPEATB.

        The repeated section extends from one label to another label or to this line. For REPEATB, it is
        only the block with the label.
        """
        routine, repeats, here = self.active_routine, self.active_frame.repeats, self.next_index - 1
        start = find_label_index(ControlKeyword.GOTO, jump.target_label, routine, here)
        until = (
            find_label_index(ControlKeyword.GOTO, jump.end_label, routine, here) if jump.end_label else here
        )
        if start is None or until is None:
            text = Message(
                "label {missing}, which {steering} uses, is not in this program.",
                missing=jump.target_label if start is None else jump.end_label,
                steering=jump.keyword,
            )
            raise line.make_error(jump.column, JUMP_TARGET_MISSING, text, "Correct the label.")
        if jump.keyword is ControlKeyword.REPEAT_BLOCK:
            end = start + 1
        elif jump.end_label:
            end = until + 1
        else:
            end = _end_label(routine, start, here)
        if end <= start or (start <= here < end):
            text = Message(
                "the program section to be repeated contains the {steering} block or does not "
                "end before that block.",
                steering=jump.keyword,
            )
            hint = "Put the whole section to be repeated before or after this block."
            raise line.make_error(jump.column, WRONG_NESTING, text, hint)
        passes = 1.0
        if jump.repeat_count is not None:
            passes = state.evaluate_formula(jump.repeat_count, partial(line.make_error, jump.column))
        count = convert_to_whole_number(passes)
        if count is None or not 1 <= count <= _MAX_PASSES or len(repeats) >= MAX_CALL_DEPTH:
            text = Message("P{passes} is not a valid repeat count.", passes=f"{passes:g}")
            hint = Message("Write a repeat count from P1 to P{most_passes}.", most_passes=_MAX_PASSES)
            raise line.make_error(jump.column, "passes", text, hint)
        routine.has_repeats = True
        repeats.append(_Repeat(start, end, count, self.next_index))
        self.next_index = start


_REPEAT_KEYWORDS = frozenset({ControlKeyword.REPEAT, ControlKeyword.REPEAT_BLOCK})
_MAX_PASSES = 9999


def _end_label(routine: Routine, start: int, repeat_index: int) -> int:
    """Return the line index at which a REPEAT section with only a start label ends.

    The end is ENDLABEL, the line of REPEAT or the program end, whichever comes first.
    """
    for at in range(start, routine.line_range.stop):
        if at == repeat_index:
            return repeat_index
        if routine.get_line(at).label == "ENDLABEL":
            return at + 1
    return routine.line_range.stop


def _reads_positions(source: ProgramSource) -> bool:
    """Return whether a program reads axis positions, so that they may affect its jumps."""
    return any("$AA_I" in line.upper() or "$P_EP" in line.upper() for line in source.lines)


def is_main_program_end(statement: Statement, *, is_in_subprogram: bool) -> bool:
    """Return whether the block ends the whole program.

    In a subprogram, M2 and M30 act like M17.
    """
    return statement.ends_program and not is_in_subprogram


def _missing(line: LexedBlock) -> ProgramError:
    if reason := UNSUPPORTED_CYCLES.get(line.called_name):
        text = Message("{word}: {problem}.", word=line.called_name, problem=reason)
        return line.make_error(line.call_column, "not-in-subset", text, "Remove this text from the program.")
    text = Message("subprogram {call} does not exist.", call=line.called_name)
    hint = Message(
        "Put {named}.spf in the main program's folder, or add %_N_{named2}_SPF to the main program's file.",
        named=line.called_name,
        named2=line.called_name,
    )
    return line.make_error(line.call_column, "subprogram-missing", text, hint)
