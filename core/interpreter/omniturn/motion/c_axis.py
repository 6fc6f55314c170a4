"""C axis: M19, M89 and G89 lock the spindle as the C axis; CA, CI and C move it."""

from __future__ import annotations

from collections.abc import Iterator
from math import copysign, hypot

from core.interpreter.omniturn.codes.code_entry import CodeEntry
from core.interpreter.omniturn.codes.code_rules import (
    check_conditions,
    check_word_groups,
    check_word_number,
    number,
)
from core.interpreter.omniturn.codes.code_table import LETTER_ENTRIES
from core.interpreter.omniturn.motion.feeds import check_move_feed
from core.interpreter.omniturn.motion.straight_moves import (
    check_move_after_tool,
    round_to_resolution,
    set_position,
    warn_about_unintended_rapid,
)
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.setup.spindle_and_dwell import record_c_rotation_time, warn_about_short_dwell
from core.interpreter.shared.actions import SpindleLock
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.omniturn import Word

C_AXIS_WORDS = ("C", "CA", "CI")
_TURN = 360.0
_SAME = 1e-9  # degrees, mm


def has_c_axis_speed(state: State, statement: Statement) -> bool:
    """Return whether S on this line is the speed of the C axis instead of the spindle speed."""
    return statement.locks_spindle or (statement.has_c_word and state.modal.c_locked)


def lock_spindle(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the blocks of M19, M89 or G89, which stop the spindle and lock it as the C axis.

    M19 also rotates C to 0.
    """
    word = statement.m_word if statement.m_number in {19, 89} else statement.code_word
    code = (
        statement.m_code_entry
        if statement.m_code_entry is not None and statement.m_number in {19, 89}
        else statement.code_entry
    )
    check_conditions(state, statement, code, word=word)
    if statement.one_shot_code == 89:
        check_conditions(state, statement, statement.code_entry, word=word)
    rpm = read_c_axis_rpm(state, statement, code)
    modal = state.modal
    state.set_modal(modal._replace(spindle=0, c_locked=True, c_rpm=rpm))
    yield state.action(
        statement.line, statement.get_block_text("m"), SpindleLock(orient=statement.m_number == 19)
    )
    if statement.m_number == 19:
        yield from _turn_to_zero(state, statement)


def _entry(state: State, statement: Statement) -> CodeEntry:
    """Return the code table entry for the word of a line that moves C.

    The letter C alone acts like CA under G90 and like CI under G91.
    """
    return LETTER_ENTRIES[
        "CI" if "CI" in statement.words or ("C" in statement.words and not state.absolute) else "CA"
    ]


def read_c_axis_rpm(state: State, statement: Statement, code: CodeEntry) -> float | None:
    """Return S of the line as unsigned rpm, or None if the line has no S.

    Raises ProgramError if S is 0 or exceeds the limit of the C axis.
    """
    speed = statement.get_value("S")
    return None if speed is None else check_word_number(state, statement, "S", abs(speed), code)


def _turn_to_zero(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the rotation of C to 0, from which C then counts.

    The sign of S determines the direction. Without S, C moves in the shorter direction.
    """
    at = state.c + state.modal.offset_c
    over = at % _TURN
    if min(over, _TURN - over) <= _SAME:
        over = 0.0
    sign = statement.get_value("S") or 0.0
    back = sign < 0.0 or (sign == 0.0 and over < _TURN / 2)
    whole = at - over + (0.0 if back or over == 0.0 else _TURN)
    offset = round(whole / _TURN) * _TURN
    state.set_modal(state.modal._replace(offset_c=offset))
    state.c = at - offset
    if over:
        yield rotate_c_axis(state, statement.line, statement.get_block_text("m"), 0.0)
    state.c = 0.0


def move_c_axis(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the move of a line with C, either alone or together with X and Z."""
    word = _c_word(state, statement)
    warn_about_short_dwell(state)
    c0, x0, z0 = state.c, state.x, state.z
    goal = _target(state, statement, word)
    if statement.has_x_or_z_move:
        x, z = round_to_resolution(state, statement, "X"), round_to_resolution(state, statement, "Z")
        set_position(state, x, z)
        check_move_after_tool(state, statement.line, x, z)
    rpm = read_c_axis_rpm(state, statement, _entry(state, statement))
    if rpm is not None:
        state.set_modal(state.modal._replace(c_rpm=rpm))
    distance_mm = hypot(state.x - x0, state.z - z0)
    if distance_mm <= _SAME:
        yield rotate_c_axis(state, statement.line, statement.get_block_text("move"), goal)
        record_c_rotation_time(state, statement.line, word.column, abs(goal - c0))
        return
    state.c = goal
    if state.per_rev and state.modal.feed is not None:
        _check_turns(state, statement, word, distance_mm, abs(goal - c0))
        rpm = copysign(state.modal.c_rpm or 0.0, goal - c0)
    else:
        check_move_feed(state, statement.line, x0, state.x, distance_mm)
        rpm = 0.0
    warn_about_unintended_rapid(state, statement.line)
    start, text = (x0, z0, c0), statement.get_block_text("move")
    yield state.move(
        state.kind, statement.line, text, start, state.feed, is_feed_per_rev=state.per_rev, rpm=rpm
    )


def rotate_c_axis(state: State, line: int, text: str, target_deg: float) -> Block:
    """Return the block that rotates C alone to ``target_deg`` at the active speed, and update the state."""
    rpm = state.modal.c_rpm or state.setup.limits.max_c_rpm
    c0, state.c = state.c, target_deg
    start = state.x, state.z, c0
    return state.move(BlockKind.ROTATE, line, text, start, rpm * 6.0, rpm=copysign(rpm, target_deg - c0))


def _c_word(state: State, statement: Statement) -> Word:
    code = _entry(state, statement)
    check_word_groups(statement, code)
    word = next(statement.words[letter] for letter in C_AXIS_WORDS if letter in statement.words)
    check_conditions(state, statement, code, word=word)
    if word.letter == "C":
        number(state, statement, "C", code)
    return word


def _target(state: State, statement: Statement, word: Word) -> float:
    """Return the target of C in degrees, rounded to the resolution of C."""
    step, value = state.setup.limits.c_resolution_deg, word.value or 0.0
    count = round(value / step)
    if abs(value / step - count) > 1e-6:
        state.log.add_warning(
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


def _check_turns(state: State, statement: Statement, word: Word, path_mm: float, c_travel_deg: float) -> None:
    """Raise ProgramError for an invalid move with a feed per revolution of C.

    C must rotate far enough for the move, the speed of C must be programmed, and the feed of the move must
    not exceed the machine's maximum feed.
    """
    modal, limits = state.modal, state.setup.limits
    feed = modal.feed or 0.0
    if modal.c_rpm is None:
        text = "The feed is per revolution of C, but the speed of C is not programmed with S."
        raise statement.make_error(word, "speed-missing", text, "Write S on this line.")
    needed = path_mm / feed * _TURN
    if c_travel_deg < needed * (1.0 - 1e-9):
        text = (
            "C is programmed to turn {turn} degrees, but at this feed the move needs {needed} degrees of C "
            "rotation."
        )
        hint = "Turn C farther, or increase F; otherwise the axes stop before the end point."
        raise statement.make_error(
            word, "c-too-little", text, hint, turn=c_travel_deg, needed=round(needed, 4)
        )
    speed = feed * modal.c_rpm / 60.0
    if speed > limits.max_feed_mm_s * (1.0 + 1e-9):
        shown = modal.format_feed(speed, is_per_rev=False)
        most = modal.format_feed(limits.max_feed_mm_s, is_per_rev=False)
        text = "At a C speed of {c_rpm} rpm this feed is {value}; the maximum is {maximum}."
        hint = "Lower F or S."
        raise statement.make_error(
            0, "feed-over-speed", text, hint, c_rpm=modal.c_rpm, value=shown, maximum=most
        )
