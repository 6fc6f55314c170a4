"""C axis: M19, M89 and G89 lock the spindle as the C axis, and CA, CI and C move it."""

from __future__ import annotations

from collections.abc import Iterator
from math import copysign, hypot

from core.interpreter.omniturn.codes.code_entry import Code
from core.interpreter.omniturn.codes.code_rules import check_together, check_when, checked, number
from core.interpreter.omniturn.codes.code_table import LETTERS
from core.interpreter.omniturn.motion.feeds import check_move
from core.interpreter.omniturn.motion.straight_moves import check_tool, go, on_step, warn_of_title_rapid
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.setup.spindle_and_dwell import expect_arrival, warn_of_short_dwell
from core.interpreter.shared.actions import SpindleLock
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.language.omniturn import Word

C_WORDS = ("C", "CA", "CI")
_TURN = 360.0
_SAME = 1e-9  # degrees, mm


def positions(state: State, statement: Statement) -> bool:
    """Return whether S on this line is the speed of the C axis instead of the spindle speed."""
    return statement.locks or (statement.turns and state.modal.c_locked)


def lock(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the blocks of M19, M89 or G89, which stop and lock the spindle; M19 then turns C to 0."""
    word = statement.m_word if statement.m in {19, 89} else statement.code
    code = statement.m_code if statement.m_code is not None and statement.m in {19, 89} else statement.entry
    check_when(state, statement, code, word=word)
    if statement.one_shot == 89:
        check_when(state, statement, statement.entry, word=word)
    rpm = speed_of_c(state, statement, code)
    modal = state.modal
    state.adopt(modal._replace(spindle=0, c_locked=True, c_rpm=rpm))
    yield state.action(statement.line, statement.part("m"), SpindleLock(orient=statement.m == 19))
    if statement.m == 19:
        yield from _to_zero(state, statement)


def _entry(state: State, statement: Statement) -> Code:
    """Return the entry of the word that moves C; C alone acts like CA under G90 and like CI under G91."""
    return LETTERS[
        "CI" if "CI" in statement.words or ("C" in statement.words and not state.absolute) else "CA"
    ]


def speed_of_c(state: State, statement: Statement, code: Code) -> float | None:
    """Return S of the line in rpm, unsigned, or None. Raises ProgramError above the limit of C."""
    speed = statement.value("S")
    return None if speed is None else checked(state, statement, "S", abs(speed), code)


def _to_zero(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the turn of C to 0 in the direction of the sign of S, or by the shorter distance without S.

    C then counts from 0 again.
    """
    at = state.c + state.modal.offset_c
    over = at % _TURN
    if min(over, _TURN - over) <= _SAME:
        over = 0.0
    sign = statement.value("S") or 0.0
    back = sign < 0.0 or (sign == 0.0 and over < _TURN / 2)
    whole = at - over + (0.0 if back or over == 0.0 else _TURN)
    offset = round(whole / _TURN) * _TURN
    state.adopt(state.modal._replace(offset_c=offset))
    state.c = at - offset
    if over:
        yield rotation(state, statement.line, statement.part("m"), 0.0)
    state.c = 0.0


def c_move(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the move of a line with C, alone or together with X and Z."""
    word = _c_word(state, statement)
    warn_of_short_dwell(state)
    c0, x0, z0 = state.c, state.x, state.z
    goal = _goal(state, statement, word)
    if statement.moves:
        x, z = on_step(state, statement, "X"), on_step(state, statement, "Z")
        go(state, x, z)
        check_tool(state, statement.line, x, z)
    rpm = speed_of_c(state, statement, _entry(state, statement))
    if rpm is not None:
        state.adopt(state.modal._replace(c_rpm=rpm))
    way = hypot(state.x - x0, state.z - z0)
    if way <= _SAME:
        yield rotation(state, statement.line, statement.part("move"), goal)
        expect_arrival(state, statement.line, word.column, abs(goal - c0))
        return
    state.c = goal
    if state.per_rev and state.modal.feed is not None:
        _check_turns(state, statement, word, way, abs(goal - c0))
        rpm = copysign(state.modal.c_rpm or 0.0, goal - c0)
    else:
        check_move(state, statement.line, x0, state.x, way)
        rpm = 0.0
    warn_of_title_rapid(state, statement.line)
    start, text = (x0, z0, c0), statement.part("move")
    yield state.move(state.kind, statement.line, text, start, state.feed, per_rev=state.per_rev, rpm=rpm)


def rotation(state: State, line: int, text: str, goal: float) -> Block:
    """Return the block that turns C alone to ``goal`` (degrees) at the active speed, and update the state."""
    rpm = state.modal.c_rpm or state.setup.limits.c_max_rpm
    c0, state.c = state.c, goal
    start = state.x, state.z, c0
    return state.move(Kind.ROTATE, line, text, start, rpm * 6.0, rpm=copysign(rpm, goal - c0))


def _c_word(state: State, statement: Statement) -> Word:
    code = _entry(state, statement)
    check_together(statement, code)
    word = next(statement.words[letter] for letter in C_WORDS if letter in statement.words)
    check_when(state, statement, code, word=word)
    if word.letter == "C":
        number(state, statement, "C", code)
    return word


def _goal(state: State, statement: Statement, word: Word) -> float:
    """Return the target of C in degrees, rounded to its step."""
    step, value = state.setup.limits.c_step, word.value or 0.0
    count = round(value / step)
    if abs(value / step - count) > 1e-6:
        state.log.warn(
            statement.line,
            word.column,
            "finer-than-step",
            "{word} is finer than the resolution of {step} degrees; {count} is used.",
            "Round the number.",
            word=word.text,
            step=step,
            count=count * step,
        )
        value = count * step
    absolute = word.letter == "CA" or (word.letter == "C" and state.absolute)
    return value if absolute else state.c + value


def _check_turns(state: State, statement: Statement, word: Word, way: float, turn: float) -> None:
    """Check a move with feed per revolution of C. Raises ProgramError.

    C must turn far enough for the move, and its speed must be programmed.
    """
    modal, limits = state.modal, state.setup.limits
    feed = modal.feed or 0.0
    if modal.c_rpm is None:
        text = "The feed is per revolution of C, but the speed of C is not programmed with S."
        raise statement.refuse(word, "speed-missing", text, "Write S on this line.")
    needed = way / feed * _TURN
    if turn < needed * (1.0 - 1e-9):
        text = (
            "C is programmed to turn {turn} degrees, but at this feed the move needs {needed} degrees of C "
            "rotation."
        )
        hint = "Turn C farther, or increase F; otherwise the axes stop before the end point."
        raise statement.refuse(word, "c-too-little", text, hint, turn=turn, needed=round(needed, 4))
    speed = feed * modal.c_rpm / 60.0
    if speed > limits.max_feed * (1.0 + 1e-9):
        shown = modal.feed_text(speed, per_rev=False)
        most = modal.feed_text(limits.max_feed, per_rev=False)
        text = "At a C speed of {c_rpm} rpm this feed is {value}; the maximum is {maximum}."
        hint = "Lower F or S."
        raise statement.refuse(0, "feed-over-speed", text, hint, c_rpm=modal.c_rpm, value=shown, maximum=most)
