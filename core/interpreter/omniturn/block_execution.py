"""Execution of one line: its elementary blocks, in the order in which the control acts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.interpreter.omniturn.codes.code_entry import Acts
from core.interpreter.omniturn.codes.code_table import carry_out
from core.interpreter.omniturn.cycles.canned_cycles import blocks_of_moves, check_ready
from core.interpreter.omniturn.motion.arc_moves import arc_move
from core.interpreter.omniturn.motion.c_axis import c_move, lock, positions
from core.interpreter.omniturn.motion.corners import read_corner, refuse_radius
from core.interpreter.omniturn.motion.feeds import coarse_line, feed_words, warn_of_crash_feed
from core.interpreter.omniturn.motion.straight_moves import geometry_modes, statement_move
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import ReadyLine, Statement
from core.interpreter.omniturn.setup.m_codes import after_motion, before_motion
from core.interpreter.omniturn.setup.spindle_and_dwell import run_block, speed_word, spindle_modes
from core.interpreter.omniturn.setup.tools_and_offsets import secondary, tool_change
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import ToolUse

Ahead = Sequence[ReadyLine]
_ARC = Acts.ARC  # Read for every line.


def execute(
    state: State,
    statement: Statement,
    use: ToolUse,
    ahead: Ahead,
    *,
    first: bool,
    contour: Sequence[Statement] = (),
) -> Iterator[Block]:
    """Yield the blocks of a line: modes, T, G10 or G92, spindle, starting M codes, motion, stopping M codes.

    ``ahead`` are the next few lines, and ``contour`` are the lines that describe the contour of G75 or G78.
    Raises ProgramError at the first word that cannot be executed.
    """
    if statement.simple:
        feed_words(state, statement, first=first)
        warn_of_crash_feed(state, statement, ahead)
        yield from _motion(state, statement)
        return
    if coarse_line(state, statement, ahead):
        return
    geometry_modes(state, statement)
    if statement.comment is not None:
        state.adopt(state.modal._replace(comment=statement.comment))
    feed_words(state, statement, first=first)
    spindle_modes(state, statement)
    of_c = positions(state, statement)
    if not of_c:
        speed_word(state, statement)
    tool = statement.words.get("T")
    if tool is not None:
        yield tool_change(state, statement, tool, use)
    else:
        secondary(state, statement)
    if statement.entry.acts is Acts.FRAME:
        yield from carry_out(statement.entry)(state, statement)
    if not of_c:
        yield from run_block(state, statement)
    warn_of_crash_feed(state, statement, ahead)
    yield from _start(state, statement)
    yield from _motion(state, statement, contour)
    if statement.m is not None:
        yield from after_motion(state, statement)


def _start(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the blocks of an M code that acts before the motion, other than M03 and M04."""
    if statement.locks:
        yield from lock(state, statement)
    elif statement.m is not None:
        yield from before_motion(state, statement)


def _motion(state: State, statement: Statement, contour: Sequence[Statement] = ()) -> Iterator[Block]:
    acts = statement.entry.acts
    if acts is _ARC:
        yield arc_move(state, statement)
    elif acts is Acts.MOTION:
        yield from carry_out(statement.entry)(state, statement)
    elif acts is Acts.CYCLE or acts is Acts.CONTOUR:
        check_ready(state, statement)
        described = (contour,) if acts is Acts.CONTOUR else ()
        yield from blocks_of_moves(state, statement, carry_out(statement.entry)(state, statement, *described))
    elif statement.turns and (state.modal.c_locked or not statement.moves or "C" not in statement.words):
        refuse_radius(state, statement)
        yield from c_move(state, statement)
    elif statement.moves:
        block = statement_move(state, statement)
        read_corner(state, statement)
        yield block
    elif statement.one_shot is None:
        refuse_radius(state, statement)
