"""Execution of both branches of conditional calls (M95, M97), to check them in one run.

A copy of the pass executes the other branch.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from copy import copy
from typing import Protocol

from core.interpreter.omniturn.flow.loops_and_subroutines import (
    get_input_terminal,
    is_call_made,
    is_called_when_closed,
)
from core.interpreter.omniturn.motion.corners import ContourBuffer
from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_state import ContourState
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import ToolUsage
from core.interpreter.shared.job_setup import InterpreterSetup


class BranchRecord(Protocol):
    """Interface of a record of the branches that interpreter passes have executed."""

    def is_state_known(self, branch_pass: BranchingPass) -> bool:
        """Return whether another pass was already in the same state as this pass.

        If so, the rest of the program has already been checked.
        """
        ...

    def record_branch(self, branch_pass: BranchingPass, statement: Statement, is_call_made: bool) -> None:
        """Record that a pass reads an input, and whether the pass then makes the call."""
        ...


class BranchingPass(Interpreter):
    """An interpreter pass that can be copied at a conditional call to execute the other branch.

    ``copy_for_other_branch`` returns the copy. An input is assumed not to change until the next action.
    ``has_input_change`` is True if a branch contradicts this assumption.
    """

    def __init__(self, program: Program, setup: InterpreterSetup, branch_record: BranchRecord) -> None:
        super().__init__(program, setup)
        self._guide = branch_record
        self._approached = False  # a copy starts in the middle of the program
        self._fresh = False  # a copy whose first line must take the other branch
        self._choice: bool | None = None
        self._held: dict[str, bool] = {}  # states of inputs since the last action
        self._held_to = 0  # number of blocks at the last of these states
        self.is_merged = False  # the pass has reached the state of another pass
        self.has_input_change = False  # an input has changed between two reads without an action between them

    @property
    def block_count(self) -> int:
        """Return the number of blocks that this pass has generated.

        In a copy, the number includes the blocks of the original pass up to the time of the copy.
        """
        return self._state.blocks

    @property
    def is_stopped(self) -> bool:
        """Return whether an error has stopped the pass."""
        return self._stopped

    @property
    def state_key(self) -> Hashable:
        """Return a key for the state of the pass.

        Two passes have the same key only if they generate the same blocks from the same inputs.
        """
        state = self._state
        return (
            self._flow.position,
            state.modal._replace(comment=""),
            (state.x, state.z, state.c, state.px, state.pz),
            (state.first_feed, state.tool_line, state.title_rapid, state.coarse_start_point, state.turning),
            frozenset(state.reported),
            tuple(sorted(self._held.items())) if self._held_to == state.blocks else (),
            self._stopped,
        )

    def copy_for_other_branch(self, statement: Statement, is_call_made: bool) -> BranchingPass:
        """Return a copy of this pass that takes the other branch at this line.

        The copy has its own diagnostic log.
        """
        twin = copy(self)
        twin._log = DiagnosticLog()
        twin._state = state = copy(self._state)
        state.log, state.contour = twin._log, ContourState()
        state.reported, state.pending_shift = set(state.reported), dict(state.pending_shift)
        twin._modifier, twin._tools = ContourBuffer(state), ToolUsage()
        twin._flow = self._flow.copy_position()
        twin._flow.next_index = statement.line - 1
        twin._held = dict(self._held)
        twin._ahead = None
        twin._approached, twin._fresh, twin._choice = True, True, not is_call_made
        twin.has_input_change = self.has_input_change or self._known_input(statement) is not None
        return twin

    def _known_input(self, statement: Statement) -> bool | None:
        """Return whether the input of the conditional call is closed, or None if this is unknown.

        It is unknown if the input has not been read since the last action.
        """
        if self._held_to != self._state.blocks:
            self._held = {}
        return self._held.get(get_input_terminal(statement))

    def _statement(self, statement: Statement) -> Iterator[Block]:
        if not self._state.contour.is_buffering:
            self._flow.next_index = statement.line - 1
            if self._fresh:
                self._fresh = False
            elif self._guide.is_state_known(self):
                self.is_merged = True
                self._flow.stop_here()
                return
            elif statement.depends_on_input and not self._left_out(statement):
                self._choose(statement)
            self._flow.next_index = statement.line
        yield from super()._statement(statement)

    def _left_out(self, statement: Statement) -> bool:
        return statement.has_block_delete and self._state.setup.block_delete

    def _choose(self, statement: Statement) -> None:
        answer = self._known_input(statement)
        takes = (
            is_call_made(statement, self._state.setup.inputs)
            if answer is None
            else answer == is_called_when_closed(statement)
        )
        self._choice = takes
        self._guide.record_branch(self, statement, takes)

    def _is_call_made(self, statement: Statement) -> bool:
        takes, self._choice = bool(self._choice), None
        self._held[get_input_terminal(statement)] = takes == is_called_when_closed(statement)
        self._held_to = self._state.blocks
        return takes

    def _approach(self) -> Iterator[Block]:
        return iter(()) if self._approached else super()._approach()

    def _end(self) -> Iterator[Block]:
        return iter(()) if self.is_merged else super()._end()
