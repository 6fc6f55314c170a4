"""Screw threads with G33, G34 and G35, with constant or variable lead, single or as a chain.

The executor cuts a complete chain of threads, including its pull-out, in one pass, synchronized with the
measured spindle angle. For a start angle SF, the tool first moves back by the corresponding fraction of the
lead. The same spindle index then cuts a thread that is rotated by SF.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import sqrt

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.sinumerik.motion.linear_moves import (
    MIN_PATH_MM,
    AxisTravel,
    compute_axis_travel,
    make_rapid_block,
    make_travel_block,
)
from core.interpreter.sinumerik.sinumerik_state import MotionKind, SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import Word
from core.language.sinumerik.word_table import FEED_TYPE_GROUP, MOTION_GROUP

_ROUNDING = 1 + 1e-9
_STEEP = 0.5  # ratio of X to Z; a steeper move is a pull-out instead of a continuation
_SAME = 1e-9  # mm
_MIN_LEAD = 0.01  # mm


def generate_thread_blocks(state: SinumerikState, statement: Statement) -> Iterator[Block]:
    """Yield the thread block of G33, G34 or G35, preceded by the backward move if SF is programmed.

    Raises ProgramError for an invalid thread.
    """
    for name in ("CR", "AR", "I1", "K1"):
        if word := statement.words.get(name):
            text = "{word} cannot be used with G{motion}."
            hint = "Remove this text from the program."
            raise statement.make_error(
                word, "word-unused", text, hint, word=word.text, motion=int(state.motion)
            )
    travel = compute_axis_travel(state, statement)
    if abs(travel.z - travel.z0) < MIN_PATH_MM or travel.c_travel:
        text = "a thread is cut along Z in sync with the spindle, but this block does not move along Z."
        if travel.c_travel:
            text = "C cannot turn while a thread is cut."
        raise _refused(statement, "thread-length", text, "Enter Z of the end point and K.")
    lead = _lead(state, statement, travel)
    growth = _growth(state, statement)
    back = _start_angle(state, statement, travel, lead, growth)
    if back is not None:
        yield back
        travel, lead = travel._replace(x0=state.x, z0=state.z), lead - growth * state.start_revolutions
    mean, end = _mean_lead(statement, travel, lead, growth)
    check_thread_spindle(state, statement, max(lead, end))
    continues = _continues(state, statement, travel, lead)
    made = make_travel_block(state, statement, travel, BlockKind.THREAD, mean)
    made.per_rev, made.growth, made.continues = True, growth, continues
    state.threads, state.end_lead = (*state.threads, made), end
    yield made


def _growth(state: SinumerikState, statement: Statement) -> float:
    """Return the change of the lead per revolution, in mm/rev.

    The change is F with G34, minus F with G35, and 0 with G33.
    """
    if state.motion is MotionKind.THREAD:
        return 0.0
    if word := statement.words.get("F"):
        value = state.length(statement, word)
        text = "{word}: the lead change must be greater than 0."
        hint = "Use G34 to increase the lead and G35 to decrease it."
        statement.require_condition(value > 0.0, word, "not-positive", text, hint, word=word.text)
        state.lead_change = value
    if not state.lead_change:
        text = "G{motion} needs F, the lead change per revolution."
        hint = "Enter F as the lead change per revolution, in mm/rev."
        raise _refused(statement, "thread-lead-missing", text, hint, motion=int(state.motion))
    return state.lead_change if state.motion is MotionKind.THREAD_GROWING_LEAD else -state.lead_change


def _mean_lead(statement: Statement, travel: AxisTravel, lead: float, growth: float) -> tuple[float, float]:
    """Return the mean lead and the lead at the end, in mm/rev.

    Raises ProgramError if the lead decreases below 0.01 mm.
    """
    thread_length_mm = abs(travel.z - travel.z0)
    if not growth:
        return lead, lead
    square = lead * lead + 2.0 * growth * thread_length_mm
    end = sqrt(square) if square > 0.0 else 0.0
    if end < _MIN_LEAD:
        raise _refused(
            statement,
            "thread-lead-missing",
            "the lead decreases to 0 before the end of the thread.",
            "The lead of {lead} mm decreases by {growth} mm per revolution, so the thread can be only "
            "{lead2} mm long.",
            lead=lead,
            growth=-growth,
            lead2=f"{lead * lead / -growth / 2.0:.4g}",
        )
    return (lead + end) / 2.0, end


def _start_angle(
    state: SinumerikState, statement: Statement, travel: AxisTravel, lead: float, growth: float
) -> Block | None:
    """Return the backward move for the start angle SF, or None if SF is omitted or 0.

    The move delays the start of the thread by a fraction of a revolution.
    """
    word = statement.words.get("SF")
    angle = 0.0 if word is None else state.number(statement, word) % 360.0
    if word is None or not angle:
        return None
    text = "{word} is allowed only in the first block of a thread chain."
    hint = "Write this word in the first block of the thread chain."
    statement.require_condition(not state.threads, word, "word-unused", text, hint, word=word.text)
    state.start_revolutions = turns = angle / 360.0
    far = (lead - 0.5 * growth * turns) * turns
    text = "at this start point, the lead has already decreased to 0."
    statement.require_condition(
        lead - growth * turns >= _MIN_LEAD, word, "thread-lead-missing", text, "Lower F."
    )
    share = far / abs(travel.z - travel.z0)
    x, z = (a - (b - a) * share for a, b in ((travel.x0, travel.x), (travel.z0, travel.z)))
    return make_rapid_block(state, statement, travel._replace(x=x, z=z))


def _lead(state: SinumerikState, statement: Statement, travel: AxisTravel) -> float:
    """Return the lead along Z at the start, in mm/rev.

    Without K and I, it is the lead at the end of the previous thread. Raises ProgramError for an invalid
    lead.
    """
    along, across = statement.words.get("K"), statement.words.get("I")
    if along is None and across is None:
        if state.threads:
            return state.end_lead
        text = "G{motion} needs K, the lead along Z."
        raise _refused(statement, "thread-lead-missing", text, "Write K.", motion=int(state.motion))
    if along is not None and across is not None:
        text = "the thread has both a lead along X and a lead along Z."
        hint = "Write K for angles up to 45 degrees and I for larger angles."
        raise statement.make_error(across, "thread-lead-both", text, hint)
    word = along or across
    assert word is not None
    value = state.length(statement, word)
    text = "{word}: a lead must be greater than 0."
    statement.require_condition(value > 0.0, word, "not-positive", text, "Correct the value.", word=word.text)
    if along is not None:
        return value
    dx = abs(travel.x - travel.x0)
    text = "{word} is the lead along X, but X does not move."
    statement.require_condition(
        dx >= MIN_PATH_MM, word, "thread-lead-missing", text, "Write K.", word=word.text
    )
    return value * abs(travel.z - travel.z0) / dx


def check_thread_spindle(state: SinumerikState, statement: Statement, lead: float) -> None:
    """Raise ProgramError if the spindle is stopped, is under G96, or is too fast for this lead in mm/rev."""
    modal = state.modal
    if not modal.spindle or not state.rpm:
        text = "a thread needs the spindle running, but the spindle is stopped."
        raise _refused(statement, "g95-spindle-stopped", text, "Start the spindle with S and M3 or M4.")
    if modal.css:
        text = "G96 is active, but a thread needs the same spindle speed from the first pass to the last."
        word = statement.g_words.get(FEED_TYPE_GROUP) or statement.g_words.get(MOTION_GROUP)
        raise statement.make_error(word, "thread-under-css", text, "Write G97 with S before this block.")
    speed, most = lead * abs(state.rpm) / 60.0, state.setup.limits.max_feed_mm_s
    if speed > most * _ROUNDING:
        shown, limit = speed * 60.0, most * 60.0
        raise _refused(
            statement,
            "feed-over-speed",
            "at {rpm} rpm, this lead requires {value} mm/min; the maximum is {limit} mm/min.",
            "Lower S.",
            rpm=f"{abs(state.rpm):.0f}",
            value=f"{shown:.0f}",
            limit=f"{limit:.0f}",
        )


def _continues(state: SinumerikState, statement: Statement, travel: AxisTravel, lead: float) -> bool:
    """Return whether the block continues the previous thread instead of leaving the thread.

    Raises ProgramError if the block reverses along Z or follows a block that has left the thread.
    """
    if not state.threads:
        return False
    first, last = state.threads[0], state.threads[-1]
    way_x, way_z = travel.x - travel.x0, travel.z - travel.z0
    if way_z * (first.z - first.z0) <= 0.0:
        text = "this thread runs in the opposite Z direction to the previous thread."
        raise _refused(statement, "thread-chain", text, "End the thread chain with G0.")
    if last is not first and not last.continues:
        text = "the previous block moved out of the thread and ended the thread chain."
        raise _refused(statement, "thread-chain", text, "End the thread chain with G0.")
    leads_out = abs(way_x) >= _STEEP * abs(way_z) and abs(lead - state.end_lead) < _SAME and not last.growth
    return not leads_out or state.motion is not MotionKind.THREAD


def _refused(
    statement: Statement, code: int | str, text: str, hint: str, /, **values: object
) -> ProgramError:
    word: Word | None = statement.g_words.get(MOTION_GROUP) or next(iter(statement.words.values()), None)
    return statement.make_error(word, code, text, hint, **values)
