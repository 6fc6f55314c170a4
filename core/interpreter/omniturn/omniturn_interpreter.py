"""Interpreter of OmniTurn: generates the elementary blocks of a program for a setup."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING

from core.interpreter.omniturn.block_execution import execute
from core.interpreter.omniturn.consequent_faults import Consequences
from core.interpreter.omniturn.flow.loops_and_subroutines import Flow, takes_call, terminal
from core.interpreter.omniturn.flow.program_size import refuse_too_large
from core.interpreter.omniturn.motion.corners import ContourModifier
from core.interpreter.omniturn.motion.feeds import looks_ahead
from core.interpreter.omniturn.motion.nose_compensation import nose_code, switch
from core.interpreter.omniturn.motion.straight_moves import go, on_step, plain_move
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_state import State, checkpoint_of, restore
from core.interpreter.omniturn.omniturn_statement import PLANE, UNREADABLE, ReadyLine, Statement, statement_of
from core.interpreter.omniturn.setup.m_codes import check_m_codes
from core.interpreter.omniturn.setup.tools_and_offsets import warn_of_idle_shifts
from core.interpreter.shared.actions import AskInput, ProgramEnd
from core.interpreter.shared.checkpoint import Checkpoint
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block, Series
from core.interpreter.shared.interpretation import MOST_BLOCKS, MOST_LINES, Interpretation, approach_blocks
from core.interpreter.shared.job_setup import Setup
from core.interpreter.shared.modal_state import Modal
from core.language.diagnostics import ProgramError, refusal
from core.language.omniturn import lex_line

if TYPE_CHECKING:
    from core.interpreter.omniturn.motion.move_series import SeriesLookAhead

# --- checks before the first block


def check_opening(state: State, program: Program) -> tuple[int, bool]:
    """Return the number of the first line to execute (0 for none), and whether the program is too large."""
    log = state.log
    check_m_codes(state, program.m_codes)
    begin = state.setup.begin
    alone = begin is not None and begin.single
    first = 0 if alone else _first_line(program, log, block_delete=state.setup.block_delete)
    if begin is not None and alone and begin.checkpoint.modal.absolute is None:
        _refuse_move(program, log)
    large = refuse_too_large(program, state.setup.inputs)
    if large is not None:
        log.add(large)
    if state.setup.metric and not program.names_units and first:
        text = "The program has neither G70 nor G71, so it runs in the control's unit, millimeters."
        log.warn(first, 0, "units-unnamed", text, "Write G70 or G71 on the first line.")
    return first, large is not None


def _refuse_move(program: Program, log: Log) -> None:
    """Log an error for a move in MDI after power-up or M30, because neither G90 nor G91 is active."""
    step = program.ready[0]
    named = isinstance(step, Statement) and {90, 91}.intersection(step.modal)
    moves = isinstance(step, tuple) or (step is not None and {"X", "Z"}.intersection(step.words))
    if moves and not named:
        text = "Neither G90 (absolute) nor G91 (incremental) is active."
        log.add(refusal(1, 1, "first-line", text, "Program G90 or G91 first."))


def _first_line(program: Program, log: Log, *, block_delete: bool) -> int:
    """Return the number of the first line to execute, or 0; log an error if it lacks G90 and G91."""
    for number, step in enumerate(program.ready, start=1):
        if step is None:
            continue
        if isinstance(step, Statement):
            if not step.executable or (block_delete and step.block_delete):
                continue
            if step.flow == UNREADABLE or {90, 91}.intersection(step.modal):
                return number
        text = "The first line must contain G90 (absolute) or G91 (incremental)."
        log.add(refusal(number, 1, "first-line", text, "Start the program with G90G94F300."))
        return number
    return 0


_AHEAD = 8
LONG = 200
"""Lines from which on moves are made in series where there is no loop either; fewer gain nothing."""


class Interpreter(Interpretation):
    """One pass through an OmniTurn program or through one line of MDI."""

    def __init__(self, program: Program, setup: Setup) -> None:
        super().__init__(Log(program.diagnostics))
        self._program = program
        self._state = State(setup, self._log)
        self._modifier = ContourModifier(self._state)
        self._flow = Flow(program.structure)
        self._ahead: SeriesLookAhead | None = None
        self._consequences = Consequences()
        self._first, self._refused = check_opening(self._state, program)
        if setup.begin is not None:
            restore(self._state, setup.begin)
            self._flow.resume(setup.begin.line, setup.begin.checkpoint.flow)

    @property
    def source_blocks(self) -> int:
        """Number of lines that contain more than a comment."""
        return self._program.blocks

    @property
    def modal(self) -> Modal:
        """Modal state after the last generated block."""
        return self._state.modal

    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """Return an iterator that generates the elementary blocks. Call this method once."""
        for each in chain(self._approach(), self._pass()):
            if self._stopped:
                if to_first_error:
                    return
            elif isinstance(each, Series):
                yield from each
            else:
                yield each

    def series(self) -> Iterator[Block | Series]:
        """Return the same blocks, with straight moves combined in series where possible."""
        if self._program.structure.loop_ends or len(self._program.ready) >= LONG:
            from core.interpreter.omniturn.motion.move_series import SeriesLookAhead

            self._ahead = SeriesLookAhead(self._state, self._program, self._flow)
        return (each for each in chain(self._approach(), self._pass()) if not self._stopped)

    @property
    def checkpoint(self) -> Checkpoint:
        """State that the next line inherits."""
        return checkpoint_of(self._state)._replace(flow=self._flow.place)

    def _approach(self) -> Iterator[Block]:
        state, begin = self._state, self._state.setup.begin
        if begin is None or self._refused:
            return iter(())
        return approach_blocks(begin, state.modal, state.setup.start, state.rpm_at)

    def _pass(self) -> Iterator[Block | Series]:
        if self._refused:
            return
        yield from self._lines()
        yield from self._end()

    def _end(self) -> Iterator[Block]:
        yield from self._released(self._modifier.end())
        warn_of_idle_shifts(self._state)

    def _lines(self) -> Iterator[Block | Series]:
        ready, flow, state, ahead = self._program.ready, self._flow, self._state, self._ahead
        texts = self._program.source.lines
        left = MOST_LINES
        while flow.at < flow.end:
            if ahead is not None and state.fast:
                taken = ahead.take(left, MOST_BLOCKS - state.blocks)
                if taken is not None:
                    left -= taken[1]
                    yield taken[0]
                    continue
            at = flow.at
            flow.at = at + 1
            line = ready[at]
            left -= 1
            if left < 0 or state.blocks >= MOST_BLOCKS:
                self._stop_endless(at + 1, "Reduce the loop counts.")
                break
            try:
                if isinstance(line, tuple):
                    block = plain_move(state, at + 1, texts[at], line)
                    if block is None:
                        line = ready[at] = statement_of(lex_line(at + 1, texts[at]))
                    elif state.contour.active:
                        yield from self._modified(block)
                    else:
                        yield block
                if isinstance(line, Statement):
                    yield from self._statement(line)
            except ProgramError as problem:
                self._recover(problem, line)

    def _statement(self, statement: Statement) -> Iterator[Block]:
        contour = self._contour(statement) if statement.contour_cycle else ()
        if contour is None or (statement.block_delete and self._state.setup.block_delete):
            return
        if statement.flow == UNREADABLE:
            self._stopped = True
            self._modifier.drop()  # The buffered blocks are invalid without this line.
            self._skip(statement)
        elif statement.calls:
            self._modifier.check(statement)
            yield from self._call(statement)
        elif statement.flow == PLANE:
            self._modifier.check(statement)
            # This module is large and rarely needed.
            from core.interpreter.omniturn.motion.plane_switching import plane_line

            for block in plane_line(self._state, statement):
                yield from self._modified(block)
        elif statement.flow:
            self._flow.steer(statement)
        else:
            self._modifier.check(statement)
            if nose_code(statement):
                yield from self._nose(statement)
            first = statement.line == self._first
            ahead = (
                self._program.ready[statement.line : statement.line + _AHEAD]
                if looks_ahead(statement)
                else ()
            )
            for block in execute(self._state, statement, self._tools, ahead, first=first, contour=contour):
                yield from self._modified(block)
                if isinstance(block.action, ProgramEnd):
                    self._flow.stop()

    def _contour(self, statement: Statement) -> list[Statement] | None:
        """Return the lines that describe the contour of a cycle; None if the contour has no end.

        These lines are skipped even if the cycle does not run.
        """
        lines = self._flow.contour(statement)
        if lines is None:
            self._stopped = True
            return [] if "P" in statement.words else None
        found = [self._program.statement(index + 1) for index in lines]
        return [each for each in found if each is not None]

    def _nose(self, statement: Statement) -> Iterator[Block]:
        """Yield the blocks that G41, G42 or G40 releases."""
        found = switch(self._state, statement, nose_code(statement), called=self._flow.called)
        if found is not None:
            yield from self._released(self._modifier.switch(found))

    def _modified(self, block: Block) -> Iterator[Block]:
        """Yield the block, or with a corner or nose compensation the blocks that no later line can change."""
        if self._state.contour.active:
            yield from self._released(self._modifier.take(block))
        else:
            yield block

    def _released(self, blocks: Iterator[Block]) -> Iterator[Block]:
        try:
            yield from blocks
        except ProgramError as problem:
            self._refuse(problem)

    def _refuse(self, problem: ProgramError) -> None:
        """Log the error unless it is a consequence of another error, and discard buffered blocks."""
        if not self._consequences.includes(problem.diagnostic.code):
            self._log.add(problem.diagnostic)
        self._stopped = True
        self._modifier.drop()
        self._state.fast = False

    def _call(self, statement: Statement) -> Iterator[Block]:
        state = self._state
        if statement.asks:
            asked = AskInput(terminal(statement))
            yield from self._modified(state.action(statement.line, statement.text, asked))
            if not self._takes(statement):
                return
        self._flow.call(statement)

    def _takes(self, statement: Statement) -> bool:
        """Return whether a conditional call is made, which depends on the present state of its input."""
        return takes_call(statement, self._state.setup.inputs)

    def _recover(self, problem: ProgramError, line: ReadyLine) -> None:
        """Log the error and set the position at the end of its line.

        Later lines are then checked from the correct position.
        """
        self._refuse(problem)
        if problem.diagnostic.code == "recursion" or self._log.full:
            self._flow.stop()
        if isinstance(line, Statement):
            self._skip(line)

    def _skip(self, statement: Statement) -> None:
        """Continue after a rejected line."""
        self._arrive(statement)
        self._consequences.note(statement.text, place_known=statement.moves and self._state.absolute)

    def _arrive(self, statement: Statement) -> None:
        """Set the position at the end of the line."""
        state = self._state
        if statement.moves and state.absolute:
            go(state, on_step(state, statement, "X"), on_step(state, statement, "Z"))
            state.tool_line = 0


# --- A pass up to a line, with which SEARCHTO rebuilds the state


class PassToLine(Interpreter):
    """A pass that can stop before any line, in each loop pass and call, and continue from there."""

    def before(self, line: int) -> Iterator[Block]:
        """Yield the blocks before the next execution of this line (from 1); ``at_line`` is then True.

        The method may be called again with a later line. At the first error, the blocks end and ``failed`` is
        True.
        """
        self._flow.until(line)
        return self._until_stop()

    def once_more(self, line: int) -> Iterator[Block]:
        """Yield the blocks from this line until the same line is next again."""
        self._flow.until(line)
        self._flow.pass_stop()
        return self._until_stop()

    def _until_stop(self) -> Iterator[Block]:
        for each in self._lines():
            if self._stopped:
                return
            assert isinstance(each, Block)  # only ``series`` generates series
            yield each

    @property
    def at_line(self) -> bool:
        """Whether the requested line is next."""
        return self._flow.stopped and not self._stopped

    @property
    def setup(self) -> Setup:
        """The setup of the pass."""
        return self._state.setup

    @property
    def next_line(self) -> int:
        """Number of the next line, from 1."""
        return self._flow.at + 1

    @property
    def called(self) -> bool:
        """Whether a subroutine is active."""
        return self._flow.called

    @property
    def holds_moves(self) -> bool:
        """Whether moves are buffered because a corner or nose compensation needs later lines."""
        return self._state.contour.active or self._state.modal.nose_comp != 40
