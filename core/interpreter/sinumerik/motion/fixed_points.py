"""Rapids to machine home (G74) or to a fixed point (G75) in machine coordinates."""

from __future__ import annotations

from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.motion.linear_moves import AxisTravel, make_rapid_block
from core.interpreter.sinumerik.sinumerik_state import SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import Word
from core.language.sinumerik.word_table import MOTION_GROUP, NON_MODAL_GROUP
from core.message import Message

_AXES = frozenset({"X", "Z", "X1", "Z1"})


def make_home_move(state: SinumerikState, statement: Statement) -> Block:
    """Return the rapid of G74 that moves the named axes (X1=0 Z1=0) to home.

    Raises ProgramError for other words, for values other than 0, for a block without axes, and while G41 or
    G42 is active.
    """
    named = _axis_words(state, statement, _AXES)
    for word in named:
        if state.number(statement, word) != 0.0:
            text = "{word}: G74 always moves to machine home."
            raise statement.make_error(
                word, "word-unused", text, Message("Write {word}=0.", word=word.name), word=word.text
            )
    return _make_rapid(state, statement, dict.fromkeys((word.name[0] for word in named), 0.0))


def make_fixed_point_move(state: SinumerikState, statement: Statement) -> Block:
    """Return the rapid of G75 that moves the named axes to fixed point FP, from 1 (the default) to 4.

    The values of the axis words have no effect. The machine file defines the points in machine coordinates.
    Raises ProgramError if a point is not defined, for other words, for a block without axes, and while G41
    or G42 is active.
    """
    named = _axis_words(state, statement, _AXES | {"FP"})
    number = _number(state, statement)
    ends = {}
    for word in named:
        axis = word.name[0]
        points = state.setup.limits.fixed_points.get(axis, ())
        if number > len(points):
            raise _missing(statement, axis, number, len(points))
        ends[axis] = points[number - 1]
        if state.number(statement, word) != 0.0:
            _warn_ignored_value(state, statement, word, ends[axis])
    return _make_rapid(state, statement, ends)


def _axis_words(state: SinumerikState, statement: Statement, words: frozenset[str]) -> list[Word]:
    """Return the axis words of the block.

    Raises ProgramError if the block contains other words or no axis word, and while G41 or G42 is active.
    """
    word = statement.g_words[NON_MODAL_GROUP]
    named = [each for name, each in statement.words.items() if name in _AXES]
    others = statement.words.keys() - words or statement.m_words or statement.assignments
    if not named or others or statement.g_words.keys() - {NON_MODAL_GROUP, MOTION_GROUP}:
        text = "{word} must be in a block that contains only the axes to move, each programmed as 0."
        raise statement.make_error(word, "own-block", text, "Write {word} X1=0 Z1=0.", word=word.text)
    if (code := state.modal.compensation_code) != 40:
        text = "{word} moves the tool off the contour and cannot be used while G{code} is active."
        hint = "Write G40 and a move before this block."
        raise statement.make_error(word, "comp-with", text, hint, word=word.text, code=code)
    return named


def _number(state: SinumerikState, statement: Statement) -> int:
    """Return the number of the fixed point (FP), which is 1 by default."""
    word = statement.words.get("FP")
    if word is None:
        return 1
    number = state.number(statement, word)
    if number not in {1, 2, 3, 4}:
        text = "{word} is not a valid fixed point."
        raise statement.make_error(
            word, "fixed-point", text, "Write a value from FP=1 to FP=4.", word=word.text
        )
    return int(number)


def _missing(statement: Statement, axis: str, number: int, known: int) -> ProgramError:
    key = Message("fixed_points under [axis.{axis}] in the machine file", axis=axis)
    word = statement.words.get("FP") or statement.g_words[NON_MODAL_GROUP]
    if known:
        text = Message(
            "{word}: the machine file defines {known} fixed points for {axis}, but number "
            "{number} is programmed.",
            word=word.text,
            known=known,
            axis=axis,
            number=number,
        )
        return statement.make_error(
            word, "fixed-point", text, Message("Correct FP, or add the point to {key}.", key=key)
        )
    text = Message(
        "{word}: the machine file does not define a fixed point for {axis}.", word=word.text, axis=axis
    )
    hint = Message("Add {key}, or write SUPA G0 D0 with machine coordinates X and Z.", key=key)
    return statement.make_error(word, "fixed-point", text, hint)


def _warn_ignored_value(state: SinumerikState, statement: Statement, word: Word, end: float) -> None:
    """Log a warning that the value of an axis word has no effect."""
    text = Message(
        "{word} has no effect with G75: the axis moves to machine position {end} mm.",
        word=word.text,
        end=f"{end:g}",
    )
    state.log_finding(
        statement.make_warning(word, "fixed-point-value", text, Message("Write {word}0.", word=word.name[0]))
    )


def _make_rapid(state: SinumerikState, statement: Statement, targets: dict[str, float]) -> Block:
    """Return a rapid to these machine coordinates in which all axes arrive at the same time."""
    state.threads = ()
    x, z = targets.get("X", state.x), targets.get("Z", state.z)
    modal = state.modal
    travel = AxisTravel(state.x, state.z, state.c, x, z, state.c, modal, modal.offset_x, modal.offset_z)
    return make_rapid_block(state, statement, travel)
