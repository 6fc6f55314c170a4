"""Interpreter of OmniTurn programs, which converts a program to elementary blocks."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING

from core.interpreter.omniturn.block_execution import execute
from core.interpreter.omniturn.consequent_faults import ConsequentFaultFilter
from core.interpreter.omniturn.flow.loops_and_subroutines import Flow, get_input_terminal, is_call_made
from core.interpreter.omniturn.flow.program_size import check_program_size
from core.interpreter.omniturn.motion.corners import ContourBuffer
from core.interpreter.omniturn.motion.feeds import needs_following_lines
from core.interpreter.omniturn.motion.nose_compensation import (
    execute_compensation_code,
    get_compensation_code,
)
from core.interpreter.omniturn.motion.straight_moves import (
    make_plain_move_block,
    round_to_resolution,
    set_position,
)
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_state import State, make_checkpoint, restore_state
from core.interpreter.omniturn.omniturn_statement import (
    PLANE_FLOW,
    UNREADABLE_FLOW,
    ExecutableLine,
    Statement,
    make_statement,
)
from core.interpreter.omniturn.setup.m_codes import check_m_codes
from core.interpreter.omniturn.setup.tools_and_offsets import warn_about_unused_shifts
from core.interpreter.shared.actions import InputRead, ProgramEnd
from core.interpreter.shared.checkpoint import Checkpoint
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, StraightMoveSeries
from core.interpreter.shared.interpretation import (
    MAX_BLOCK_COUNT,
    MAX_LINE_COUNT,
    InterpreterPass,
    generate_lathe_approach,
)
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import ProgramError, make_error_diagnostic
from core.language.omniturn import lex_line

if TYPE_CHECKING:
    from core.interpreter.omniturn.motion.move_series import SeriesReader

# --- checks before the first block


def check_program_start(state: State, program: Program) -> tuple[int, bool]:
    """Return the number of the first line to execute, and whether the program is too large.

    The number is 0 if no line can be executed.
    """
    log = state.log
    check_m_codes(state, program.machine_m_code_lines)
    begin = state.setup.begin
    alone = begin is not None and begin.is_mdi_line
    first = 0 if alone else _first_line(program, log, block_delete=state.setup.block_delete)
    if begin is not None and alone and begin.checkpoint.modal.absolute is None:
        _log_mode_error(program, log)
    large = check_program_size(program, state.setup.inputs)
    if large is not None:
        log.add_finding(large)
    if state.setup.metric and not program.has_units_code and first:
        text = "The program has neither G70 nor G71, so it runs in the control's unit, millimeters."
        log.add_warning(first, 0, "units-unnamed", text, "Write G70 or G71 on the first line.")
    return first, large is not None


def _log_mode_error(program: Program, log: DiagnosticLog) -> None:
    """Log an error for an MDI move after power-up or M30, because neither G90 nor G91 is active."""
    step = program.executable_lines[0]
    named = isinstance(step, Statement) and {90, 91}.intersection(step.modal_codes)
    moves = isinstance(step, tuple) or (step is not None and {"X", "Z"}.intersection(step.words))
    if moves and not named:
        text = "Neither G90 (absolute) nor G91 (incremental) is active."
        log.add_finding(make_error_diagnostic(1, 1, "first-line", text, "Program G90 or G91 first."))


def _first_line(program: Program, log: DiagnosticLog, *, block_delete: bool) -> int:
    """Return the number of the first line to execute, or 0 if no line is executable.

    An error is logged if the line lacks G90 and G91.
    """
    for number, step in enumerate(program.executable_lines, start=1):
        if step is None:
            continue
        if isinstance(step, Statement):
            if not step.is_executable or (block_delete and step.has_block_delete):
                continue
            if step.flow_code == UNREADABLE_FLOW or {90, 91}.intersection(step.modal_codes):
                return number
        text = "The first line must contain G90 (absolute) or G91 (incremental)."
        log.add_finding(
            make_error_diagnostic(number, 1, "first-line", text, "Start the program with G90G94F300.")
        )
        return number
    return 0


_LOOKAHEAD_LINES = 8
LONG_PROGRAM_LINE_COUNT = 200
"""Minimum number of lines for which moves are made in series without a loop.

Shorter programs gain nothing.
"""


class Interpreter(InterpreterPass):
    """One pass through an OmniTurn program or through one MDI line."""

    def __init__(self, program: Program, setup: InterpreterSetup) -> None:
        super().__init__(DiagnosticLog(program.diagnostics))
        self._program = program
        self._state = State(setup, self._log)
        self._modifier = ContourBuffer(self._state)
        self._flow = Flow(program.structure)
        self._ahead: SeriesReader | None = None
        self._consequences = ConsequentFaultFilter()
        self._first, self._refused = check_program_start(self._state, program)
        if setup.begin is not None:
            restore_state(self._state, setup.begin)
            self._flow.restore_position(setup.begin.line_number, setup.begin.checkpoint.flow)

    @property
    def source_block_count(self) -> int:
        """Return the number of program lines that contain more than a comment."""
        return self._program.block_count

    @property
    def modal_state(self) -> ModalState:
        """Return the modal state after the last generated block."""
        return self._state.modal

    def generate_blocks(self, *, stops_at_first_error: bool = False) -> Iterator[Block]:
        """Generate the elementary blocks of the program. Call this method only once."""
        for each in chain(self._approach(), self._pass()):
            if self._stopped:
                if stops_at_first_error:
                    return
            elif isinstance(each, StraightMoveSeries):
                yield from each
            else:
                yield each

    def generate_series(self) -> Iterator[Block | StraightMoveSeries]:
        """Generate the same blocks as ``generate_blocks``, with straight moves combined into series.

        Only moves that need no individual treatment are combined.
        """
        if (
            self._program.structure.loop_ends
            or len(self._program.executable_lines) >= LONG_PROGRAM_LINE_COUNT
        ):
            from core.interpreter.omniturn.motion.move_series import SeriesReader

            self._ahead = SeriesReader(self._state, self._program, self._flow)
        return (each for each in chain(self._approach(), self._pass()) if not self._stopped)

    @property
    def checkpoint(self) -> Checkpoint:
        """Return a checkpoint with the state at the start of the next line."""
        return make_checkpoint(self._state)._replace(flow=self._flow.position)

    def _approach(self) -> Iterator[Block]:
        state, begin = self._state, self._state.setup.begin
        if begin is None or self._refused:
            return iter(())
        return generate_lathe_approach(begin, state.modal, state.setup.start, state.compute_rpm_at)

    def _pass(self) -> Iterator[Block | StraightMoveSeries]:
        if self._refused:
            return
        yield from self._lines()
        yield from self._end()

    def _end(self) -> Iterator[Block]:
        yield from self._released(self._modifier.check_program_end())
        warn_about_unused_shifts(self._state)

    def _lines(self) -> Iterator[Block | StraightMoveSeries]:
        ready, flow, state, ahead = self._program.executable_lines, self._flow, self._state, self._ahead
        texts = self._program.source.lines
        left = MAX_LINE_COUNT
        while flow.next_index < flow.end_index:
            if ahead is not None and state.fast:
                taken = ahead.read_next_series(left, MAX_BLOCK_COUNT - state.blocks)
                if taken is not None:
                    left -= taken[1]
                    yield taken[0]
                    continue
            at = flow.next_index
            flow.next_index = at + 1
            line = ready[at]
            left -= 1
            if left < 0 or state.blocks >= MAX_BLOCK_COUNT:
                self._stop_endless(at + 1, "Reduce the loop counts.")
                break
            try:
                if isinstance(line, tuple):
                    block = make_plain_move_block(state, at + 1, texts[at], line)
                    if block is None:
                        line = ready[at] = make_statement(lex_line(at + 1, texts[at]))
                    elif state.contour.is_buffering:
                        yield from self._apply_stages(block)
                    else:
                        yield block
                if isinstance(line, Statement):
                    yield from self._statement(line)
            except ProgramError as problem:
                self._recover(problem, line)

    def _statement(self, statement: Statement) -> Iterator[Block]:
        contour = self._contour(statement) if statement.is_contour_cycle else ()
        if contour is None or (statement.has_block_delete and self._state.setup.block_delete):
            return
        if statement.flow_code == UNREADABLE_FLOW:
            self._stopped = True
            self._modifier.discard_blocks()  # The buffered blocks are invalid without this line.
            self._skip(statement)
        elif statement.calls_subroutine:
            self._modifier.check_line(statement)
            yield from self._call(statement)
        elif statement.flow_code == PLANE_FLOW:
            self._modifier.check_line(statement)
            # This module is large and rarely needed.
            from core.interpreter.omniturn.motion.plane_switching import execute_plane_line

            for block in execute_plane_line(self._state, statement):
                yield from self._apply_stages(block)
        elif statement.flow_code:
            self._flow.execute_flow_line(statement)
        else:
            self._modifier.check_line(statement)
            if get_compensation_code(statement):
                yield from self._nose(statement)
            first = statement.line == self._first
            ahead = (
                self._program.executable_lines[statement.line : statement.line + _LOOKAHEAD_LINES]
                if needs_following_lines(statement)
                else ()
            )
            for block in execute(
                self._state, statement, self._tools, ahead, is_first_line=first, contour=contour
            ):
                yield from self._apply_stages(block)
                if isinstance(block.action, ProgramEnd):
                    self._flow.stop_here()

    def _contour(self, statement: Statement) -> list[Statement] | None:
        """Return the lines that describe the contour of a cycle, or None if the contour has no end.

        These lines are skipped even if the cycle is not executed.
        """
        lines = self._flow.skip_contour(statement)
        if lines is None:
            self._stopped = True
            return [] if "P" in statement.words else None
        found = [self._program.get_statement(index + 1) for index in lines]
        return [each for each in found if each is not None]

    def _nose(self, statement: Statement) -> Iterator[Block]:
        """Execute G41, G42 or G40, and yield the buffered blocks that later lines can no longer change."""
        found = execute_compensation_code(
            self._state,
            statement,
            get_compensation_code(statement),
            is_in_subroutine=self._flow.is_in_subprogram,
        )
        if found is not None:
            yield from self._released(self._modifier.switch_compensation(found))

    def _apply_stages(self, block: Block) -> Iterator[Block]:
        """Yield the block after corners and nose compensation have been applied.

        While a corner or nose compensation is active, the block is buffered. Instead, the buffered blocks
        that no later line can change are yielded.
        """
        if self._state.contour.is_buffering:
            yield from self._released(self._modifier.accept_block(block))
        else:
            yield block

    def _released(self, blocks: Iterator[Block]) -> Iterator[Block]:
        try:
            yield from blocks
        except ProgramError as problem:
            self._log_error(problem)

    def _log_error(self, problem: ProgramError) -> None:
        """Log the error unless it is a consequence of another error, and discard buffered blocks."""
        if not self._consequences.is_consequence(problem.diagnostic.code):
            self._log.add_finding(problem.diagnostic)
        self._stopped = True
        self._modifier.discard_blocks()
        self._state.fast = False

    def _call(self, statement: Statement) -> Iterator[Block]:
        state = self._state
        if statement.depends_on_input:
            asked = InputRead(get_input_terminal(statement))
            yield from self._apply_stages(state.action(statement.line, statement.text, asked))
            if not self._is_call_made(statement):
                return
        self._flow.call_subroutine(statement)

    def _is_call_made(self, statement: Statement) -> bool:
        """Return whether a conditional call is made in the current state of its input."""
        return is_call_made(statement, self._state.setup.inputs)

    def _recover(self, problem: ProgramError, line: ExecutableLine) -> None:
        """Log the error of a rejected line, and set the position to the end point of the line.

        Later lines are then checked from the correct position.
        """
        self._log_error(problem)
        if problem.diagnostic.code == "recursion" or self._log.is_full:
            self._flow.stop_here()
        if isinstance(line, Statement):
            self._skip(line)

    def _skip(self, statement: Statement) -> None:
        """Skip a rejected line, and set the state so that the pass can continue."""
        self._set_end_position(statement)
        self._consequences.record_rejected_line(
            statement.text, is_position_known=statement.has_x_or_z_move and self._state.absolute
        )

    def _set_end_position(self, statement: Statement) -> None:
        """Set the position to the end point of the line."""
        state = self._state
        if statement.has_x_or_z_move and state.absolute:
            set_position(
                state, round_to_resolution(state, statement, "X"), round_to_resolution(state, statement, "Z")
            )
            state.tool_line = 0


# --- A pass up to a line, with which SEARCHTO rebuilds the state


class StoppablePass(Interpreter):
    """An interpreter pass that can stop before any line and then continue.

    The pass can also stop in a particular execution of a loop or subroutine.
    """

    def run_to_line(self, line: int) -> Iterator[Block]:
        """Yield the blocks up to the next execution of this line, counted from 1.

        After the last block, ``is_at_line`` is True. The method can then be called again with a later line.
        The iterator ends at the first error, and ``has_errors`` is then True.
        """
        self._flow.stop_before(line)
        return self._until_stop()

    def run_to_next_visit(self, line: int) -> Iterator[Block]:
        """Yield the blocks from this line until execution reaches the same line again."""
        self._flow.stop_before(line)
        self._flow.skip_stop_once()
        return self._until_stop()

    def _until_stop(self) -> Iterator[Block]:
        for each in self._lines():
            if self._stopped:
                return
            assert isinstance(each, Block)  # only ``generate_series`` generates series
            yield each

    @property
    def is_at_line(self) -> bool:
        """Return whether the pass has stopped before the line at which it was requested to stop."""
        return self._flow.is_at_stop_line and not self._stopped

    @property
    def setup(self) -> InterpreterSetup:
        """Return the setup of the pass."""
        return self._state.setup

    @property
    def next_line(self) -> int:
        """Return the number of the next line, from 1."""
        return self._flow.next_index + 1

    @property
    def is_in_subroutine(self) -> bool:
        """Return whether a subroutine is active."""
        return self._flow.is_in_subprogram

    @property
    def has_buffered_moves(self) -> bool:
        """Return whether moves are buffered because a corner or nose compensation needs later lines."""
        return self._state.contour.is_buffering or self._state.modal.compensation_code != 40
