"""Common functions of all canned cycles: checks, and elementary blocks for their motion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot

from core.geometry.lines_and_arcs import Arc, Line, Point, compute_arc_length
from core.interpreter.omniturn.codes.code_rules import check_conditions, check_word_number
from core.interpreter.omniturn.motion.feeds import check_move_feed
from core.interpreter.omniturn.motion.move_words import format_move
from core.interpreter.omniturn.motion.straight_moves import round_to_resolution
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared import units
from core.interpreter.shared.contour_passes import CycleMove
from core.interpreter.shared.elementary_blocks import Block, BlockKind

LIFT_MM = 0.02 * units.MM_PER_INCH
"""Distance in mm by which the tool moves off the cut before it returns."""

MAX_PASS_COUNT = 10_000
_TOLERANCE_MM = 1e-9  # mm


def get_cycle_code(statement: Statement) -> str:
    """Return the code of the cycle as text for messages, such as G75."""
    return f"G{statement.one_shot_code}"


def check_cycle_start(state: State, statement: Statement) -> None:
    """Raise ProgramError if a cycle cannot start.

    A cycle cannot start if the start point or the feed is unknown, or if nose compensation is active.
    """
    check_conditions(state, statement, statement.code_entry)


def read_length_mm(state: State, statement: Statement, letter: str) -> float:
    """Return a length word in mm, or 0 if the line lacks an optional word.

    Raises ProgramError if the rule of the word rejects its number, or if a required word is missing.
    """
    return check_word_number(state, statement, letter, round_to_resolution(state, statement, letter)) or 0.0


def check_pass_count(statement: Statement, letter: str, count: int, description: str) -> None:
    """Raise ProgramError if a cycle has too many passes.

    ``description`` is the plural noun for the passes in the message.
    """
    if count > MAX_PASS_COUNT:
        raise statement.make_error(
            letter,
            "cycle-passes",
            "{text} would make {count} {what}; the maximum is {most_passes}.",
            "Look for a missing decimal point in {letter}.",
            text=get_cycle_code(statement),
            count=f"{count:,}",
            what=description,
            most_passes=f"{MAX_PASS_COUNT:,}",
            letter=letter,
        )


def make_move_blocks(state: State, statement: Statement, moves: Sequence[CycleMove]) -> Iterator[Block]:
    """Yield the motions as blocks, without motions of zero length.

    All motions are checked before the first block is yielded. Raises ProgramError if the feed is invalid or
    missing, or if it is a feed per revolution and the spindle is stopped.
    """
    kept: list[CycleMove] = []
    at = state.x, state.z
    for move in moves:
        if move.center is None and hypot(move.x - at[0], move.z - at[1]) <= _TOLERANCE_MM:
            continue
        kept.append(move)
        if move.rapid_rate_mm_s is None:
            check_move_feed(state, statement.line, at[0], move.x, _length(at, move))
        at = move.x, move.z
    for move in kept:
        yield _block(state, statement, move)


def _length(start: Point, move: CycleMove) -> float:
    if move.center is None:
        return hypot(move.x - start[0], move.z - start[1])
    return compute_arc_length(start, (move.x, move.z), move.center, is_clockwise=move.is_clockwise)


def _block(state: State, statement: Statement, move: CycleMove) -> Block:
    kind = (
        BlockKind.RAPID
        if move.rapid_rate_mm_s is not None
        else BlockKind.FEED
        if move.center is None
        else BlockKind.ARC
    )
    start, text = (state.x, state.z, state.c), _text(state, move)
    state.x, state.z = move.x, move.z
    state.px, state.pz = state.x - state.secondary_x, state.z - state.secondary_z
    return state.move(
        kind,
        statement.line,
        text,
        start,
        state.feed if move.rapid_rate_mm_s is None else move.rapid_rate_mm_s,
        is_feed_per_rev=move.rapid_rate_mm_s is None and state.per_rev,
        rpm=state.compute_rpm_at(move.x),
        surface_speed=state.modal.active_surface_speed,
        center=move.center or (0.0, 0.0),
        is_clockwise=move.is_clockwise,
    )


def _text(state: State, move: CycleMove) -> str:
    """Return the motion as text of a program line, in the active mode and unit."""
    start, end = (state.x, state.z), (move.x, move.z)
    if move.center is not None:
        return format_move(state.modal, Arc(start, end, move.center, move.is_clockwise))
    return ("" if move.rapid_rate_mm_s is None else "G00") + format_move(state.modal, Line(start, end))
