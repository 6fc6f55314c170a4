"""Where a SINUMERIK program goes on behind GOTO, IF, CASE, WHILE, FOR, LOOP, REPEAT; DEF and MSG."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import prod
from typing import Protocol

from core.interpreter.sinumerik.sinumerik_state import State
from core.interpreter.sinumerik.variables import LARGEST_ARRAY, MOST_DIMENSIONS
from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Parameter
from core.language.sinumerik.program_jumps import Defined, Jump, Steering
from core.language.sinumerik.sinumerik_alarms import FIRST_INDEX, NESTING, NO_TARGET, NOT_DEFINED, fault
from core.language.sinumerik.sinumerik_words import Line
from core.message import Message

_ENDS = {
    Steering.END_IF: Steering.IF,
    Steering.END_WHILE: Steering.WHILE,
    Steering.END_FOR: Steering.FOR,
    Steering.END_LOOP: Steering.LOOP,
    Steering.UNTIL: Steering.REPEAT,
}
_BEGINS = frozenset(_ENDS.values())
_SAME = 1e-12  # numbers of CASE that differ by less are equal
_GOTO = frozenset({Steering.GOTO, Steering.GOTO_BACK, Steering.GOTO_FORWARD, Steering.GOTO_START})


class Lines(Protocol):
    """The program in which a line stands."""

    lines: range

    def line(self, at: int) -> Line:
        """The line with this index."""
        ...

    def labelled(self, label: str) -> tuple[int, ...]:
        """Indices, rising, of the lines with this label or block number."""
        ...

    def partners(self) -> dict[int, tuple[int, ...]]:
        """Lines that belong together, by the index of each."""
        ...


def belonging(lines: Iterable[Line]) -> dict[int, tuple[int, ...]]:
    """Indices of the lines of each structure, by each of them. Raises ProgramError where one is not whole."""
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
                raise _refused(line, jump, NESTING, text, "Check the start of the control structure.")
            places = (*opened.pop()[2], at)
            found.update(dict.fromkeys(places, places))
    if opened:
        line, jump, _ = opened[-1]
        raise _refused(
            line,
            jump,
            NESTING,
            Message("{steering} has no matching end.", steering=jump.steering),
            "Add the matching end statement.",
        )
    return found


def follow(line: Line, jump: Jump, state: State, program: Lines, at: int) -> int | None:
    """Index of the line to go on with; None where it is the next one. Raises ProgramError."""
    steering = jump.steering
    if steering in _GOTO:
        wanted = jump.condition is None or _holds(line, jump, state, jump.condition)
        if not wanted and jump.other is not None:
            return follow(line, jump.other, state, program, at)
        return _target(line, jump, program, at) if wanted else None
    if steering is Steering.CASE:
        return _case(line, jump, state, program, at)
    if steering is Steering.DEFINE:
        _define(line, jump, state)
    elif steering is Steering.MESSAGE:
        state.adopt(state.modal._replace(comment=_message(line, jump, state)))
    elif steering is Steering.ALARM and jump.condition is not None:
        number = _worth(line, jump, state, jump.condition)
        text = Message("the program itself triggers alarm {number}.", number=f"{number:g}")
        raise _refused(line, jump, "program-alarm", text, "Check the preceding blocks for the cause.")
    elif (steering in _BEGINS or steering in _ENDS or steering is Steering.ELSE) and not jump.target:
        return _STEPS[steering](line, jump, state, program.partners()[at], program)
    return None


def _case(line: Line, jump: Jump, state: State, program: Lines, at: int) -> int | None:
    """The jump of the first branch with the value of CASE, or of DEFAULT."""
    assert jump.condition is not None
    value = _worth(line, jump, state, jump.condition)
    for formula, steering, target in jump.choices:
        if formula is None or abs(_worth(line, jump, state, formula) - value) <= _SAME:
            return _target(line, jump._replace(steering=steering, target=target), program, at)
    return None


def _define(line: Line, jump: Jump, state: State) -> None:
    """DEF: numbers, arrays, and texts that MSG shows."""
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
                raise _refused(line, jump, "array-values", told, "Shorten the list, or enlarge the array.")


def _sizes(line: Line, jump: Jump, state: State, each: Defined) -> tuple[int, ...]:
    """How many elements an array has in each dimension. Raises ProgramError for none, and for too many."""
    sizes = tuple(int(_worth(line, jump, state, size)) for size in each.sizes)
    if len(sizes) > MOST_DIMENSIONS or min(sizes, default=1) < 1 or prod(sizes) > LARGEST_ARRAY:
        told = Message(
            "{item}{sizes}: an array must have 1 to {largest_array} elements.",
            item=each.name,
            sizes=list(sizes),
            largest_array=f"{LARGEST_ARRAY:,}",
        )
        raise _refused(
            line,
            jump,
            FIRST_INDEX,
            told,
            Message(
                "Correct the array sizes; at most {most_dimensions} dimensions are allowed.",
                most_dimensions=MOST_DIMENSIONS,
            ),
        )
    return sizes


def _message(line: Line, jump: Jump, state: State) -> str:
    """The text of MSG: numbers as they are written, without needless zeros."""
    shown = []
    for piece in jump.pieces:
        if isinstance(piece, str):
            shown.append(piece)
        elif isinstance(piece, Parameter) and piece.letters in state.variables.scope.texts:
            shown.append(state.variables.scope.texts[piece.letters])
        else:
            shown.append(f"{_worth(line, jump, state, piece):.6g}")
    return "".join(shown)


Places = tuple[int, ...]
_Step = Callable[[Line, Jump, State, Places, Lines], int | None]


def _if(line: Line, jump: Jump, state: State, places: Places, _: Lines) -> int | None:
    """Behind ELSE, or ENDIF, where the condition does not hold."""
    assert jump.condition is not None
    return None if _holds(line, jump, state, jump.condition) else places[1] + 1


def _to_the_end(_line: Line, _jump: Jump, _state: State, places: Places, _: Lines) -> int | None:
    return places[-1] + 1


def _again(_line: Line, _jump: Jump, _state: State, places: Places, _: Lines) -> int | None:
    return places[0]


def _on(_line: Line, _jump: Jump, _state: State, _places: Places, _: Lines) -> int | None:
    return None


def _while(line: Line, jump: Jump, state: State, places: Places, _: Lines) -> int | None:
    assert jump.condition is not None
    return None if _holds(line, jump, state, jump.condition) else places[-1] + 1


def _until(line: Line, jump: Jump, state: State, places: Places, _: Lines) -> int | None:
    assert jump.condition is not None
    return None if _holds(line, jump, state, jump.condition) else places[0] + 1


def _for(line: Line, jump: Jump, state: State, places: Places, _: Lines) -> int | None:
    """The variable at its start; behind ENDFOR where the end lies below it."""
    assert jump.first is not None
    assert jump.last is not None
    _set(line, jump, state, _worth(line, jump, state, jump.first))
    done = _variable(jump, state) > _worth(line, jump, state, jump.last)
    return places[-1] + 1 if done else None


def _end_for(line: Line, jump: Jump, state: State, places: Places, program: Lines) -> int | None:
    """The variable one further; on behind FOR until it is over the end."""
    begin = program.line(places[0]).jump
    assert begin is not None
    assert begin.last is not None
    _set(line, begin, state, _variable(begin, state) + 1.0)
    return places[0] + 1 if _variable(begin, state) <= _worth(line, jump, state, begin.last) else None


_STEPS: dict[Steering, _Step] = {
    Steering.IF: _if,
    Steering.ELSE: _to_the_end,
    Steering.END_IF: _on,
    Steering.WHILE: _while,
    Steering.END_WHILE: _again,
    Steering.LOOP: _on,
    Steering.END_LOOP: _again,
    Steering.REPEAT: _on,
    Steering.UNTIL: _until,
    Steering.FOR: _for,
    Steering.END_FOR: _end_for,
}


def _set(line: Line, jump: Jump, state: State, value: float) -> None:
    if not state.variables.keep(jump.name, value):
        text = Message("the name {jump} is not defined with DEF.", jump=jump.name)
        raise _refused(
            line,
            jump,
            NOT_DEFINED,
            text,
            Message("Write DEF INT {jump} before this block.", jump=jump.name),
        )


def _variable(jump: Jump, state: State) -> float:
    variables = state.variables
    if jump.name in variables.scope.numbers:
        return variables.scope.numbers[jump.name]
    return variables.r[int(jump.name[1:])]


def _holds(line: Line, jump: Jump, state: State, condition: Formula) -> bool:
    return _worth(line, jump, state, condition) != 0.0


def _worth(line: Line, jump: Jump, state: State, formula: Formula) -> float:
    return state.worth(formula, lambda code, text, hint: _refused(line, jump, code, text, hint))


def _target(line: Line, jump: Jump, program: Lines, at: int) -> int:
    """The index of the label: GOTOF behind the line, GOTOB before it, GOTO behind and then before."""
    if jump.steering is Steering.GOTO_START:
        return program.lines.start
    place = find_label(jump.steering, jump.target, program, at)
    if place is None:
        text = Message(
            "label {target} was not found in the search direction of {steering}.",
            target=jump.target,
            steering=jump.steering,
        )
        raise _refused(line, jump, NO_TARGET, text, "Correct the label or the direction of the jump.")
    return place


def find_label(steering: Steering, target: str, program: Lines, at: int) -> int | None:
    """Index of the line with this label or number, where the jump looks for it; None without one."""
    places = program.labelled(target)
    behind = next((place for place in places if place > at), None)
    before = next((place for place in reversed(places) if place <= at), None)
    if steering is Steering.GOTO_BACK or (steering is Steering.GOTO and behind is None):
        return before
    return behind


def _refused(line: Line, jump: Jump, code: int | str, text: str, hint: str) -> ProgramError:
    return ProgramError(fault(line.number, jump.column, code, line.block, text, hint))
