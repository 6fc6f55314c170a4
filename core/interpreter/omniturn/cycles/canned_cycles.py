"""Common functions of all canned cycles: their checks, and the elementary blocks of their motions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot

from core.geometry.lines_and_arcs import Arc, Line, Point, arc_length
from core.interpreter.omniturn.codes.code_rules import check_when, checked
from core.interpreter.omniturn.motion.feeds import check_move
from core.interpreter.omniturn.motion.move_words import move_words
from core.interpreter.omniturn.motion.straight_moves import on_step
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared import units
from core.interpreter.shared.contour_passes import Move
from core.interpreter.shared.elementary_blocks import Block, Kind

LIFT = 0.02 * units.MM_PER_INCH
"""How far a tool is drawn off the cut before it goes back, mm."""

MOST_PASSES = 10_000
_SAME = 1e-9  # mm


def name(statement: Statement) -> str:
    """Return the code of the cycle for messages, such as G75."""
    return f"G{statement.one_shot}"


def check_ready(state: State, statement: Statement) -> None:
    """Raise ProgramError if the start point or feed is unknown, or if nose compensation is active."""
    check_when(state, statement, statement.entry)


def length(state: State, statement: Statement, letter: str) -> float:
    """Return a length word in mm, or 0 without the word. Raises ProgramError if its rule rejects it."""
    return checked(state, statement, letter, on_step(state, statement, letter)) or 0.0


def check_count(statement: Statement, letter: str, count: int, what: str) -> None:
    """Raise ProgramError if a cycle has too many passes; ``what`` is the plural noun for the message."""
    if count > MOST_PASSES:
        raise statement.refuse(
            letter,
            "cycle-passes",
            "{text} would make {count} {what}; the maximum is {most_passes}.",
            "Look for a missing decimal point in {letter}.",
            text=name(statement),
            count=f"{count:,}",
            what=what,
            most_passes=f"{MOST_PASSES:,}",
            letter=letter,
        )


def blocks_of_moves(state: State, statement: Statement, moves: Sequence[Move]) -> Iterator[Block]:
    """Yield the motions as blocks, without those of zero length. All are checked before the first is yielded.

    Raises ProgramError without a valid feed, or if the feed is per revolution and the spindle is stopped.
    """
    kept: list[Move] = []
    at = state.x, state.z
    for move in moves:
        if move.centre is None and hypot(move.x - at[0], move.z - at[1]) <= _SAME:
            continue
        kept.append(move)
        if move.rapid is None:
            check_move(state, statement.line, at[0], move.x, _length(at, move))
        at = move.x, move.z
    for move in kept:
        yield _block(state, statement, move)


def _length(start: Point, move: Move) -> float:
    if move.centre is None:
        return hypot(move.x - start[0], move.z - start[1])
    return arc_length(start, (move.x, move.z), move.centre, clockwise=move.clockwise)


def _block(state: State, statement: Statement, move: Move) -> Block:
    kind = Kind.RAPID if move.rapid is not None else Kind.FEED if move.centre is None else Kind.ARC
    start, text = (state.x, state.z, state.c), _text(state, move)
    state.x, state.z = move.x, move.z
    state.px, state.pz = state.x - state.dx, state.z - state.dz
    return state.move(
        kind, statement.line, text, start, state.feed if move.rapid is None else move.rapid,
        per_rev=move.rapid is None and state.per_rev, rpm=state.rpm_at(move.x), css=state.modal.css_speed,
        centre=move.centre or (0.0, 0.0), clockwise=move.clockwise,
    )  # fmt: skip


def _text(state: State, move: Move) -> str:
    """Return the motion as a program line in the active mode and unit."""
    start, end = (state.x, state.z), (move.x, move.z)
    if move.centre is not None:
        return move_words(state.modal, Arc(start, end, move.centre, move.clockwise))
    return ("" if move.rapid is None else "G00") + move_words(state.modal, Line(start, end))
