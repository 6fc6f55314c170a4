"""Control structures of SINUMERIK: jumps, IF, CASE, loops, REPEAT, DEF, MSG and SETAL."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import partial
from math import prod

from core.interpreter.shared.formula_values import convert_to_whole_number
from core.interpreter.sinumerik.flow.variables import MAX_ARRAY_SIZE, MAX_DIMENSIONS
from core.interpreter.sinumerik.sinumerik_state import SinumerikState
from core.language.formulas import Formula, Parameter
from core.language.sinumerik.control_statements import ControlKeyword, ControlStatement, VariableDefinition
from core.language.sinumerik.sinumerik_alarms import (
    JUMP_TARGET_MISSING,
    NAME_NOT_DEFINED,
    WRONG_FIRST_INDEX,
    WRONG_NESTING,
)
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import INTERNAL_AXIS_NAME, LexedBlock
from core.language.source import ProgramSource
from core.message import Message

_END_KEYWORDS = {
    ControlKeyword.END_IF: ControlKeyword.IF,
    ControlKeyword.END_WHILE: ControlKeyword.WHILE,
    ControlKeyword.END_FOR: ControlKeyword.FOR,
    ControlKeyword.END_LOOP: ControlKeyword.LOOP,
    ControlKeyword.UNTIL: ControlKeyword.REPEAT,
}
_START_KEYWORDS = frozenset(_END_KEYWORDS.values())
_CONDITIONAL_KEYWORDS = frozenset({ControlKeyword.IF, ControlKeyword.WHILE, ControlKeyword.UNTIL})
_BACKWARD_JUMPS = frozenset({ControlKeyword.END_WHILE, ControlKeyword.END_LOOP})
_SAME = 1e-12  # values of CASE with a smaller difference are equal
_GOTO = frozenset(
    {ControlKeyword.GOTO, ControlKeyword.GOTO_BACK, ControlKeyword.GOTO_FORWARD, ControlKeyword.GOTO_START}
)


@dataclass(slots=True)
class Routine:
    """One program of a file. Findings include its ``displayed_name`` if it is in another file."""

    source: ProgramSource
    line_range: range
    displayed_name: str = ""
    third_axis_name: str = INTERNAL_AXIS_NAME  # name of the third axis on this machine
    has_repeats: bool = False  # lines may be executed repeatedly, so they are stored after reading
    _read: dict[int, LexedBlock] = field(default_factory=dict)
    _labelled: dict[str, tuple[int, ...]] = field(default_factory=dict)
    _partners: dict[int, tuple[int, ...]] | None = None

    def map_structures(self) -> dict[int, tuple[int, ...]]:
        """Return a map from each line index of a control structure to all line indices of the structure.

        Raises ProgramError if a structure lacks its start or its end.
        """
        if self._partners is None:
            self._partners = match_structures(self.get_line(at) for at in self.line_range)
        return self._partners

    def get_line(self, index: int) -> LexedBlock:
        """Return the line with this index."""
        line = self._read.get(index)
        if line is None:
            line = lex_line(index + 1, self.source.lines[index], self.third_axis_name)
            if self.has_repeats:
                self._read[index] = line
        return line

    def find_label_lines(self, label: str) -> tuple[int, ...]:
        """Return the indices, in ascending order, of the lines with this label or block number."""
        if label not in self._labelled:
            self._labelled[label] = tuple(at for at in self.line_range if self._has_label(at, label))
        return self._labelled[label]

    def _has_label(self, index: int, label: str) -> bool:
        """Return whether a line has this label.

        Only lines whose text contains the label are parsed.
        """
        if label not in self.source.lines[index].upper():
            return False
        line = self.get_line(index)
        return label in {line.label, line.block_name}

    def read_proc_statement(self) -> ControlStatement | None:
        """Return the PROC statement of the first line, or None if this line has no PROC statement."""
        first = self.find_first_line()
        jump = None if first is None else first.control_statement
        return jump if jump is not None and jump.keyword is ControlKeyword.PROCEDURE else None

    def find_first_line(self) -> LexedBlock | None:
        """Return the first line that contains more than a comment, or None if no line does."""
        lines = (self.get_line(at) for at in self.line_range)
        return next((line for line in lines if line.is_executable), None)


def match_structures(lines: Iterable[LexedBlock]) -> dict[int, tuple[int, ...]]:
    """Return a map from each line index of a control structure to all line indices of the structure.

    Raises ProgramError if a structure lacks its start or its end.
    """
    found: dict[int, tuple[int, ...]] = {}
    opened: list[tuple[LexedBlock, ControlStatement, list[int]]] = []
    for line in lines:
        jump = line.control_statement
        if jump is None:
            continue
        at = line.line_number - 1
        if jump.keyword in _START_KEYWORDS and not jump.target_label:
            opened.append((line, jump, [at]))
        elif jump.keyword is ControlKeyword.ELSE and opened and opened[-1][1].keyword is ControlKeyword.IF:
            opened[-1][2].append(at)
        elif jump.keyword is ControlKeyword.ELSE or jump.keyword in _END_KEYWORDS:
            if not opened or opened[-1][1].keyword is not _END_KEYWORDS.get(jump.keyword):
                text = Message("{steering} has no matching start.", steering=jump.keyword)
                raise line.make_error(
                    jump.column, WRONG_NESTING, text, "Check the start of the control structure."
                )
            places = (*opened.pop()[2], at)
            found.update(dict.fromkeys(places, places))
    if opened:
        line, jump, _ = opened[-1]
        text = Message("{steering} has no matching end.", steering=jump.keyword)
        raise line.make_error(jump.column, WRONG_NESTING, text, "Add the matching end statement.")
    return found


def execute_control_line(
    line: LexedBlock, control_statement: ControlStatement, state: SinumerikState, program: Routine, index: int
) -> int | None:
    """Execute a control statement, and return the index of the next line to execute.

    Returns None if execution continues with the following line. Raises ProgramError for an invalid
    statement.
    """
    steering = control_statement.keyword
    if steering in _GOTO:
        if control_statement.condition is None or _worth(
            line, control_statement, state, control_statement.condition
        ):
            return _target(line, control_statement, program, index)
        return (
            None
            if control_statement.else_jump is None
            else execute_control_line(line, control_statement.else_jump, state, program, index)
        )
    if steering is ControlKeyword.CASE:
        return _case(line, control_statement, state, program, index)
    if steering is ControlKeyword.DEFINE:
        _execute_def(line, control_statement, state)
    elif steering is ControlKeyword.MESSAGE:
        state.set_modal_state(state.modal._replace(comment=_format_message(line, control_statement, state)))
    elif steering is ControlKeyword.ALARM:
        number = _worth(line, control_statement, state, control_statement.condition)
        text = Message("the program itself triggers alarm {number}.", number=f"{number:g}")
        raise line.make_error(
            control_statement.column, "program-alarm", text, "Check the preceding blocks for the cause."
        )
    elif steering in _START_KEYWORDS or steering in _END_KEYWORDS or steering is ControlKeyword.ELSE:
        return _structure(line, control_statement, state, program, program.map_structures()[index])
    return None


def _structure(
    line: LexedBlock,
    jump: ControlStatement,
    state: SinumerikState,
    program: Routine,
    structure_lines: tuple[int, ...],
) -> int | None:
    """Execute a line of IF, WHILE, FOR, LOOP or REPEAT, and return the index of the next line to execute.

    Returns None if execution continues with the following line. ``structure_lines`` are the lines of the
    structure. Raises ProgramError for an invalid statement.
    """
    first, last, steering = structure_lines[0], structure_lines[-1], jump.keyword
    if steering is ControlKeyword.END_FOR:
        begin = program.get_line(first).control_statement
        assert begin is not None
        value = state.variables.get_number(begin.identifier) + 1.0
        return first + 1 if _execute_for(line, jump, begin, state, value) else None
    if steering is ControlKeyword.FOR:
        value = _worth(line, jump, state, jump.start_value)
        return None if _execute_for(line, jump, jump, state, value) else last + 1
    if steering in _CONDITIONAL_KEYWORDS:
        elsewhere = first if steering is ControlKeyword.UNTIL else structure_lines[1]
        return None if _worth(line, jump, state, jump.condition) else elsewhere + 1
    if steering is ControlKeyword.ELSE:
        return last + 1
    return first if steering in _BACKWARD_JUMPS else None


def _execute_for(
    line: LexedBlock, jump: ControlStatement, begin: ControlStatement, state: SinumerikState, value: float
) -> bool:
    """Set the loop variable of FOR, and return whether the loop body must be executed.

    The body is executed while the variable does not exceed the end value. Raises ProgramError if the
    variable is not defined or the end value cannot be evaluated.
    """
    if not state.variables.set_value(begin.identifier, value):
        text = Message("the name {jump} is not defined with DEF.", jump=begin.identifier)
        hint = Message("Write DEF INT {jump} before this block.", jump=begin.identifier)
        raise line.make_error(begin.column, NAME_NOT_DEFINED, text, hint)
    return value <= _worth(line, jump, state, begin.end_value)


def _case(
    line: LexedBlock, jump: ControlStatement, state: SinumerikState, program: Routine, index: int
) -> int | None:
    """Return the jump target of the first CASE branch with a matching value, or of DEFAULT.

    Returns None if no branch matches and DEFAULT is missing.
    """
    value = _worth(line, jump, state, jump.condition)
    for formula, steering, target in jump.case_branches:
        if formula is None or abs(_worth(line, jump, state, formula) - value) <= _SAME:
            return _target(line, jump._replace(keyword=steering, target_label=target), program, index)
    return None


def _execute_def(line: LexedBlock, jump: ControlStatement, state: SinumerikState) -> None:
    """Execute DEF, which defines numbers, arrays, and strings for MSG."""
    scope = state.variables.variable_scope
    for each in jump.definitions:
        if each.type_name == "STRING":
            scope.define_string(each.name, each.text)
            continue
        first = 0.0 if each.formula is None else _worth(line, jump, state, each.formula)
        scope.define_variable(each.name, first, _sizes(line, jump, state, each))
        if each.values is not None:
            left = state.variables.assign_values(
                each.name,
                scope.list_element_names(each.name)[0],
                each.values,
                lambda asked: _worth(line, jump, state, asked),
                partial(line.make_error, jump.column),
            )
            if left:
                text = Message(
                    "array {item} needs {left} more elements for this list.", item=each.name, left=left
                )
                raise line.make_error(
                    jump.column, "array-values", text, "Shorten the list, or enlarge the array."
                )


def _sizes(
    line: LexedBlock, jump: ControlStatement, state: SinumerikState, each: VariableDefinition
) -> tuple[int, ...]:
    """Return the dimensions of an array. Raises ProgramError if a dimension or the size is invalid."""
    sizes = [_worth(line, jump, state, size) for size in each.dimensions]
    whole = [size for size in map(convert_to_whole_number, sizes) if size is not None and size >= 1]
    if len(sizes) > MAX_DIMENSIONS or len(whole) < len(sizes) or prod(whole) > MAX_ARRAY_SIZE:
        text = Message(
            "{item}{sizes}: an array must have 1 to {largest_array} elements.",
            item=each.name,
            sizes=f"[{', '.join(f'{size:g}' for size in sizes)}]",
            largest_array=f"{MAX_ARRAY_SIZE:,}",
        )
        hint = Message(
            "Correct the array sizes; at most {most_dimensions} dimensions are allowed.",
            most_dimensions=MAX_DIMENSIONS,
        )
        raise line.make_error(jump.column, WRONG_FIRST_INDEX, text, hint)
    return tuple(whole)


def _format_message(line: LexedBlock, jump: ControlStatement, state: SinumerikState) -> str:
    """Return the text of MSG. Numbers in the text have no trailing zeros."""
    shown = []
    for piece in jump.message_parts:
        if isinstance(piece, str):
            shown.append(piece)
        elif isinstance(piece, Parameter) and piece.letters in state.variables.variable_scope.strings:
            shown.append(state.variables.variable_scope.strings[piece.letters])
        else:
            shown.append(f"{_worth(line, jump, state, piece):.6g}")
    return "".join(shown)


def _worth(line: LexedBlock, jump: ControlStatement, state: SinumerikState, formula: Formula | None) -> float:
    assert formula is not None
    return state.evaluate_formula(
        formula, lambda code, text, hint: line.make_error(jump.column, code, text, hint)
    )


def _target(line: LexedBlock, jump: ControlStatement, program: Routine, index: int) -> int:
    """Return the line index of the target label.

    GOTOF searches after the line, and GOTOB searches before the line. GOTO searches after the line and then
    before it. Raises ProgramError if the label is not found.
    """
    if jump.keyword is ControlKeyword.GOTO_START:
        return program.line_range.start
    place = find_label_index(jump.keyword, jump.target_label, program, index)
    if place is None:
        text = Message(
            "label {target} was not found in the search direction of {steering}.",
            target=jump.target_label,
            steering=jump.keyword,
        )
        raise line.make_error(
            jump.column, JUMP_TARGET_MISSING, text, "Correct the label or the direction of the jump."
        )
    return place


def find_label_index(
    jump_keyword: ControlKeyword, label: str, program: Routine, start_index: int
) -> int | None:
    """Return the index of the line with this label or block number.

    Returns None if no such line exists in the search direction of the jump.
    """
    places = program.find_label_lines(label)
    next_hit = next((place for place in places if place > start_index), None)
    before = next((place for place in reversed(places) if place <= start_index), None)
    if jump_keyword is ControlKeyword.GOTO_BACK or (jump_keyword is ControlKeyword.GOTO and next_hit is None):
        return before
    return next_hit
