"""Control structures of SINUMERIK: jumps, IF, CASE, loops, REPEAT, DEF, MSG and SETAL."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from math import prod

from core.interpreter.sinumerik.flow.variables import LARGEST_ARRAY, MOST_DIMENSIONS
from core.interpreter.sinumerik.sinumerik_state import State
from core.language.formulas import Formula, Parameter
from core.language.sinumerik.program_jumps import Defined, Jump, Steering
from core.language.sinumerik.sinumerik_alarms import FIRST_INDEX, NESTING, NO_TARGET, NOT_DEFINED
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import OWN, Line
from core.language.source import Source
from core.message import Message

_ENDS = {
    Steering.END_IF: Steering.IF,
    Steering.END_WHILE: Steering.WHILE,
    Steering.END_FOR: Steering.FOR,
    Steering.END_LOOP: Steering.LOOP,
    Steering.UNTIL: Steering.REPEAT,
}
_BEGINS = frozenset(_ENDS.values())
_ASKED = frozenset({Steering.IF, Steering.WHILE, Steering.UNTIL})
_BACK = frozenset({Steering.END_WHILE, Steering.END_LOOP})
_SAME = 1e-12  # values of CASE with a smaller difference are equal
_GOTO = frozenset({Steering.GOTO, Steering.GOTO_BACK, Steering.GOTO_FORWARD, Steering.GOTO_START})


@dataclass(slots=True)
class Routine:
    """One program of a file. ``shown`` is its name in findings if it is in another file."""

    source: Source
    lines: range
    shown: str = ""
    third_axis: str = OWN  # name of the third axis on this machine
    repeats: bool = False  # lines may be executed repeatedly, so they are stored after reading
    _read: dict[int, Line] = field(default_factory=dict)
    _labelled: dict[str, tuple[int, ...]] = field(default_factory=dict)
    _partners: dict[int, tuple[int, ...]] | None = None

    def partners(self) -> dict[int, tuple[int, ...]]:
        """Return the line indices of each control structure, by the index of each of its lines.

        Raises ProgramError if a structure has no end or no start.
        """
        if self._partners is None:
            self._partners = belonging(self.line(at) for at in self.lines)
        return self._partners

    def line(self, at: int) -> Line:
        """Return the line with this index."""
        line = self._read.get(at)
        if line is None:
            line = lex_line(at + 1, self.source.lines[at], self.third_axis)
            if self.repeats:
                self._read[at] = line
        return line

    def labelled(self, label: str) -> tuple[int, ...]:
        """Return the indices, in ascending order, of the lines with this label or block number."""
        if label not in self._labelled:
            self._labelled[label] = tuple(at for at in self.lines if self._bears(at, label))
        return self._labelled[label]

    def _bears(self, at: int, label: str) -> bool:
        """Return whether a line has this label; only lines that contain its letters are read."""
        if label not in self.source.lines[at].upper():
            return False
        line = self.line(at)
        return label in {line.label, line.block}

    def heading(self) -> Jump | None:
        """Return the PROC statement of the first line, or None."""
        first = self.first()
        jump = None if first is None else first.jump
        return jump if jump is not None and jump.steering is Steering.PROCEDURE else None

    def first(self) -> Line | None:
        """Return the first line with more than a comment, or None."""
        lines = (self.line(at) for at in self.lines)
        return next((line for line in lines if line.executable), None)


def belonging(lines: Iterable[Line]) -> dict[int, tuple[int, ...]]:
    """Return the line indices of each structure, by each of these indices. Raises ProgramError.

    A structure without a start or an end is an error.
    """
    found: dict[int, tuple[int, ...]] = {}
    opened: list[tuple[Line, Jump, list[int]]] = []
    for line in lines:
        jump = line.jump
        if jump is None:
            continue
        at = line.number - 1
        if jump.steering in _BEGINS and not jump.target:
            opened.append((line, jump, [at]))
        elif jump.steering is Steering.ELSE and opened and opened[-1][1].steering is Steering.IF:
            opened[-1][2].append(at)
        elif jump.steering is Steering.ELSE or jump.steering in _ENDS:
            if not opened or opened[-1][1].steering is not _ENDS.get(jump.steering):
                text = Message("{steering} has no matching start.", steering=jump.steering)
                raise line.refuse(jump.column, NESTING, text, "Check the start of the control structure.")
            places = (*opened.pop()[2], at)
            found.update(dict.fromkeys(places, places))
    if opened:
        line, jump, _ = opened[-1]
        text = Message("{steering} has no matching end.", steering=jump.steering)
        raise line.refuse(jump.column, NESTING, text, "Add the matching end statement.")
    return found


def follow(line: Line, jump: Jump, state: State, program: Routine, at: int) -> int | None:
    """Execute a control statement, and return the index of the next line; None for the following line.

    Raises ProgramError for an invalid statement.
    """
    steering = jump.steering
    if steering in _GOTO:
        if jump.condition is None or _worth(line, jump, state, jump.condition):
            return _target(line, jump, program, at)
        return None if jump.other is None else follow(line, jump.other, state, program, at)
    if steering is Steering.CASE:
        return _case(line, jump, state, program, at)
    if steering is Steering.DEFINE:
        _define(line, jump, state)
    elif steering is Steering.MESSAGE:
        state.adopt(state.modal._replace(comment=_message(line, jump, state)))
    elif steering is Steering.ALARM:
        number = _worth(line, jump, state, jump.condition)
        text = Message("the program itself triggers alarm {number}.", number=f"{number:g}")
        raise line.refuse(jump.column, "program-alarm", text, "Check the preceding blocks for the cause.")
    elif steering in _BEGINS or steering in _ENDS or steering is Steering.ELSE:
        return _structure(line, jump, state, program, program.partners()[at])
    return None


def _structure(line: Line, jump: Jump, state: State, program: Routine, places: tuple[int, ...]) -> int | None:
    """Return the index of the line that follows a line of IF, WHILE, FOR, LOOP or REPEAT in execution.

    The result is None if execution continues with the next line. ``places`` are the lines of the structure.
    Raises ProgramError.
    """
    first, last, steering = places[0], places[-1], jump.steering
    if steering is Steering.END_FOR:
        begin = program.line(first).jump
        assert begin is not None
        value = state.variables.number(begin.name) + 1.0
        return first + 1 if _counts(line, jump, begin, state, value) else None
    if steering is Steering.FOR:
        value = _worth(line, jump, state, jump.first)
        return None if _counts(line, jump, jump, state, value) else last + 1
    if steering in _ASKED:
        elsewhere = first if steering is Steering.UNTIL else places[1]
        return None if _worth(line, jump, state, jump.condition) else elsewhere + 1
    if steering is Steering.ELSE:
        return last + 1
    return first if steering in _BACK else None


def _counts(line: Line, jump: Jump, begin: Jump, state: State, value: float) -> bool:
    """Set the variable of FOR, and return whether it is not above the end value. Raises ProgramError."""
    if not state.variables.keep(begin.name, value):
        text = Message("the name {jump} is not defined with DEF.", jump=begin.name)
        hint = Message("Write DEF INT {jump} before this block.", jump=begin.name)
        raise line.refuse(begin.column, NOT_DEFINED, text, hint)
    return value <= _worth(line, jump, state, begin.last)


def _case(line: Line, jump: Jump, state: State, program: Routine, at: int) -> int | None:
    """Return the target of the first branch with the value of CASE, or of DEFAULT."""
    value = _worth(line, jump, state, jump.condition)
    for formula, steering, target in jump.choices:
        if formula is None or abs(_worth(line, jump, state, formula) - value) <= _SAME:
            return _target(line, jump._replace(steering=steering, target=target), program, at)
    return None


def _define(line: Line, jump: Jump, state: State) -> None:
    """Execute DEF: numbers, arrays, and strings for MSG."""
    scope = state.variables.scope
    for each in jump.defined:
        if each.kind == "STRING":
            scope.texts[each.name] = each.text
            continue
        first = 0.0 if each.formula is None else _worth(line, jump, state, each.formula)
        scope.define(each.name, first, _sizes(line, jump, state, each))
        if each.values is not None:
            left = state.variables.fill(each.name, scope.elements(each.name)[0], each.values,
                                        lambda asked: _worth(line, jump, state, asked))  # fmt: skip
            if left:
                told = Message(
                    "array {item} needs {left} more elements for this list.", item=each.name, left=left
                )
                raise line.refuse(
                    jump.column, "array-values", told, "Shorten the list, or enlarge the array."
                )


def _sizes(line: Line, jump: Jump, state: State, each: Defined) -> tuple[int, ...]:
    """Return the dimensions of an array. Raises ProgramError if a dimension or the size is invalid."""
    sizes = tuple(int(_worth(line, jump, state, size)) for size in each.sizes)
    if len(sizes) > MOST_DIMENSIONS or min(sizes, default=1) < 1 or prod(sizes) > LARGEST_ARRAY:
        told = Message(
            "{item}{sizes}: an array must have 1 to {largest_array} elements.",
            item=each.name,
            sizes=list(sizes),
            largest_array=f"{LARGEST_ARRAY:,}",
        )
        hint = Message(
            "Correct the array sizes; at most {most_dimensions} dimensions are allowed.",
            most_dimensions=MOST_DIMENSIONS,
        )
        raise line.refuse(jump.column, FIRST_INDEX, told, hint)
    return sizes


def _message(line: Line, jump: Jump, state: State) -> str:
    """Return the text of MSG, with numbers without trailing zeros."""
    shown = []
    for piece in jump.pieces:
        if isinstance(piece, str):
            shown.append(piece)
        elif isinstance(piece, Parameter) and piece.letters in state.variables.scope.texts:
            shown.append(state.variables.scope.texts[piece.letters])
        else:
            shown.append(f"{_worth(line, jump, state, piece):.6g}")
    return "".join(shown)


def _worth(line: Line, jump: Jump, state: State, formula: Formula | None) -> float:
    assert formula is not None
    return state.worth(formula, lambda code, text, hint: line.refuse(jump.column, code, text, hint))


def _target(line: Line, jump: Jump, program: Routine, at: int) -> int:
    """Return the index of the target label.

    GOTOF searches after the line, GOTOB before it, and GOTO after and then before it. Raises ProgramError if
    the label does not exist there.
    """
    if jump.steering is Steering.GOTO_START:
        return program.lines.start
    place = find_label(jump.steering, jump.target, program, at)
    if place is None:
        text = Message(
            "label {target} was not found in the search direction of {steering}.",
            target=jump.target,
            steering=jump.steering,
        )
        raise line.refuse(jump.column, NO_TARGET, text, "Correct the label or the direction of the jump.")
    return place


def find_label(steering: Steering, target: str, program: Routine, at: int) -> int | None:
    """Return the index of the line with this label or number in the jump's search direction, or None."""
    places = program.labelled(target)
    behind = next((place for place in places if place > at), None)
    before = next((place for place in reversed(places) if place <= at), None)
    if steering is Steering.GOTO_BACK or (steering is Steering.GOTO and behind is None):
        return before
    return behind
