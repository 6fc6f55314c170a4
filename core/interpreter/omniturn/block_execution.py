"""One line → its blocks, in the order in which the control acts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.interpreter.actions import Dwell
from core.interpreter.diagnostic_log import refusal
from core.interpreter.elementary_blocks import Block
from core.interpreter.omniturn import code_table
from core.interpreter.omniturn.arc_moves import arc_move
from core.interpreter.omniturn.c_axis import c_move, lock, positions
from core.interpreter.omniturn.coarse_feeds import coarse_line
from core.interpreter.omniturn.corners import read_corner, refuse_radius
from core.interpreter.omniturn.dwell import note_dwell
from core.interpreter.omniturn.feeds import feed_words, warn_of_crash_feed
from core.interpreter.omniturn.m_codes import after_motion, before_motion
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import ReadyLine, Statement
from core.interpreter.omniturn.spindle_speed import rpm_at, run_block, speed_word, spindle_modes
from core.interpreter.omniturn.straight_moves import geometry_modes, statement_move
from core.interpreter.omniturn.tools_and_offsets import ToolUse, frame, secondary, tool_change
from core.language.diagnostics import ProgramError

_SHORTEST_DWELL = 0.1  # s
_LONGEST_DWELL = 3600.0

Ahead = Sequence[ReadyLine]


def execute(
    state: State,
    made: Statement,
    use: ToolUse,
    ahead: Ahead,
    *,
    first: bool,
    contour: Sequence[Statement] = (),
) -> Iterator[Block]:
    """Modes, then T, G10 or G92, spindle, M functions that start, motion, M functions that stop.

    ``ahead``: the next few lines; ``contour``: those that describe the contour of G75 or G78.
    Raises ProgramError at the first word that cannot be executed.
    """
    if made.simple:
        feed_words(state, made, first=first)
        warn_of_crash_feed(state, made, ahead)
        yield from _motion(state, made)
        return
    if coarse_line(state, made, ahead):
        return
    geometry_modes(state, made)
    if made.comment is not None:
        state.adopt(state.modal._replace(comment=made.comment))
    feed_words(state, made, first=first)
    spindle_modes(state, made)
    of_c = positions(state, made)
    if not of_c:
        speed_word(state, made)
    tool = made.words.get("T")
    if tool is not None:
        yield tool_change(state, made, tool, use)
    else:
        secondary(state, made)
    if made.one_shot in code_table.FRAME:
        yield frame(state, made)
    spindle = None if of_c else run_block(state, made)
    if spindle is not None:
        yield spindle
    warn_of_crash_feed(state, made, ahead)
    yield from _start(state, made)
    yield from _motion(state, made, contour)
    if made.m is not None:
        block = after_motion(state, made)
        if block is not None:
            yield block


def _start(state: State, made: Statement) -> Iterator[Block]:
    """What an M code does before the motion, M03 and M04 apart."""
    if made.locks:
        yield from lock(state, made)
    elif made.m is not None:
        block = before_motion(state, made)
        if block is not None:
            yield block


def _motion(state: State, made: Statement, contour: Sequence[Statement] = ()) -> Iterator[Block]:
    if made.one_shot in code_table.ARCS:
        yield arc_move(state, made)
    elif made.one_shot in code_table.CYCLES:
        from core.interpreter.omniturn.canned_cycles import (
            cycle_blocks,  # most programs have none: 20 ms of their start
        )

        yield from cycle_blocks(state, made, contour)
    elif made.one_shot in code_table.THREADS:
        from core.interpreter.omniturn.threading_cycles import thread_blocks

        yield from thread_blocks(state, made)
    elif made.one_shot == 4:
        yield _dwell(state, made)
    elif made.turns and (state.modal.c_locked or not made.moves or "C" not in made.words):
        refuse_radius(made)
        yield from c_move(state, made)
    elif made.moves:
        block = statement_move(state, made)
        read_corner(state, made)
        yield block
    elif made.one_shot is None:
        refuse_radius(made)


def _dwell(state: State, made: Statement) -> Block:
    seconds = made.value("F")
    if seconds is None:
        column = made.code.column if made.code else 0
        text = "G04 does not say how long."
        raise ProgramError(refusal(made.line, column, "word-missing", text, "Write G04Fn, n in seconds."))
    if not _SHORTEST_DWELL <= seconds <= _LONGEST_DWELL:
        text = f"A dwell of {seconds:g} s is out of range: 0.1 s to an hour."
        raise ProgramError(refusal(made.line, made.column("F"), "dwell-range", text, "Correct F."))
    note_dwell(state, seconds)
    return state.action(made.line, made.part("move"), Dwell(seconds), rpm_at(state, state.x))
