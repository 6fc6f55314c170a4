"""Assignments of R parameters and variables in a block, including SET and REP of an array."""

from __future__ import annotations

from functools import partial

from core.interpreter.sinumerik.flow.variables import format_variable_name
from core.interpreter.sinumerik.sinumerik_state import SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_alarms import NAME_NOT_DEFINED
from core.language.sinumerik.sinumerik_words import Word
from core.message import Message


def set_parameters(state: SinumerikState, statement: Statement) -> None:
    """Execute the assignments of a block to R parameters and variables.

    Raises ProgramError for an undefined name, an invalid index, an array that is too short, and a value
    that cannot be evaluated.
    """
    for word in statement.assignments:
        name = _variable_name(state, statement, word)
        if word.values is not None:
            _execute_set(state, statement, word, name)
        elif not state.variables.set_value(name, state.number(statement, word)):
            raise _no_place(state, statement, word, name)


def _no_place(state: SinumerikState, statement: Statement, word: Word, name: str) -> ProgramError:
    if word.name in state.variables.variable_scope.array_dimensions:
        return statement.make_error(word, *state.variables.describe_missing_value(word.name, name))
    text = Message(
        "the name {name} is not defined: it is neither a word nor a variable of this program.", name=name
    )
    return statement.make_error(
        word, NAME_NOT_DEFINED, text, Message("Write DEF REAL {word} before this block.", word=word.name)
    )


def _execute_set(state: SinumerikState, statement: Statement, word: Word, name: str) -> None:
    """Execute SET or REP, starting at an element of an array.

    Raises ProgramError if the array element does not exist, if the array is too short, or if the number of
    elements of REP is invalid.
    """
    letters = "R" if word.name == "R0" else word.name
    if name not in state.variables.variable_scope.numbers and letters != "R":
        raise _no_place(state, statement, word, name)

    assert word.values is not None
    refuse = partial(statement.make_error, word)
    left = state.variables.assign_values(
        letters, name, word.values, lambda asked: state.evaluate_formula(asked, refuse), refuse
    )
    if left:
        text = Message(
            "{word}: the array needs {left} more elements for this list.", word=word.text, left=left
        )
        raise refuse("array-values", text, "Shorten the list.")


def _variable_name(state: SinumerikState, statement: Statement, word: Word) -> str:
    """Return the name of the variable that the word assigns, such as R7, LENGTH or an array element."""
    if word.element_index is None:
        return word.name
    refuse = partial(statement.make_error, word)
    letters = "R" if word.name == "R0" else word.name
    return format_variable_name(
        letters, word.element_index, lambda index: state.evaluate_formula(index, refuse), refuse
    )
