"""Execution of one program line as elementary blocks, in the control's order of execution."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.interpreter.omniturn.codes.code_entry import ActionKind
from core.interpreter.omniturn.codes.code_table import load_handler
from core.interpreter.omniturn.cycles.canned_cycles import check_cycle_start, make_move_blocks
from core.interpreter.omniturn.motion.arc_moves import make_arc_block
from core.interpreter.omniturn.motion.c_axis import has_c_axis_speed, lock_spindle, move_c_axis
from core.interpreter.omniturn.motion.corners import check_radius_word, read_corner
from core.interpreter.omniturn.motion.feeds import (
    execute_coarse_feed,
    execute_feed_words,
    warn_about_high_feed,
)
from core.interpreter.omniturn.motion.straight_moves import execute_dimension_modes, make_statement_move
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import ExecutableLine, Statement
from core.interpreter.omniturn.setup.m_codes import execute_after_motion, execute_before_motion
from core.interpreter.omniturn.setup.spindle_and_dwell import (
    execute_speed_word,
    execute_spindle_modes,
    run_spindle,
)
from core.interpreter.omniturn.setup.tools_and_offsets import change_tool, select_secondary_offset
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import ToolUsage

FollowingLines = Sequence[ExecutableLine]
_ARC = ActionKind.ARC  # Read for every line.


def execute(
    state: State,
    statement: Statement,
    usage: ToolUsage,
    following_lines: FollowingLines,
    *,
    is_first_line: bool,
    contour: Sequence[Statement] = (),
) -> Iterator[Block]:
    """Yield the blocks of a line in the order of execution.

    The order is: modes, T, G10 or G92, spindle, starting M codes, motion, stopping M codes.
    ``following_lines`` are the next few lines. ``contour`` contains the lines that describe the contour of
    G75 or G78. Raises ProgramError at the first word that cannot be executed.
    """
    if statement.is_simple_move:
        execute_feed_words(state, statement, is_first_line=is_first_line)
        warn_about_high_feed(state, statement, following_lines)
        yield from _motion(state, statement)
        return
    if execute_coarse_feed(state, statement, following_lines):
        return
    execute_dimension_modes(state, statement)
    if statement.comment is not None:
        state.set_modal(state.modal._replace(comment=statement.comment))
    execute_feed_words(state, statement, is_first_line=is_first_line)
    execute_spindle_modes(state, statement)
    of_c = has_c_axis_speed(state, statement)
    if not of_c:
        execute_speed_word(state, statement)
    tool = statement.words.get("T")
    if tool is not None:
        yield change_tool(state, statement, tool, usage)
    else:
        select_secondary_offset(state, statement)
    if statement.code_entry.action_kind is ActionKind.FRAME:
        yield from load_handler(statement.code_entry)(state, statement)
    if not of_c:
        yield from run_spindle(state, statement)
    warn_about_high_feed(state, statement, following_lines)
    yield from _execute_before_motion(state, statement)
    yield from _motion(state, statement, contour)
    if statement.m_number is not None:
        yield from execute_after_motion(state, statement)


def _execute_before_motion(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the blocks of an M code that acts before the motion, other than M03 and M04."""
    if statement.locks_spindle:
        yield from lock_spindle(state, statement)
    elif statement.m_number is not None:
        yield from execute_before_motion(state, statement)


def _motion(state: State, statement: Statement, contour: Sequence[Statement] = ()) -> Iterator[Block]:
    acts = statement.code_entry.action_kind
    if acts is _ARC:
        yield make_arc_block(state, statement)
    elif acts is ActionKind.MOTION:
        yield from load_handler(statement.code_entry)(state, statement)
    elif acts is ActionKind.CYCLE or acts is ActionKind.CONTOUR:
        check_cycle_start(state, statement)
        described = (contour,) if acts is ActionKind.CONTOUR else ()
        yield from make_move_blocks(
            state, statement, load_handler(statement.code_entry)(state, statement, *described)
        )
    elif statement.has_c_word and (
        state.modal.c_locked or not statement.has_x_or_z_move or "C" not in statement.words
    ):
        check_radius_word(state, statement)
        yield from move_c_axis(state, statement)
    elif statement.has_x_or_z_move:
        block = make_statement_move(state, statement)
        read_corner(state, statement)
        yield block
    elif statement.one_shot_code is None:
        check_radius_word(state, statement)
