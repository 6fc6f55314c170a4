"""Both branches of conditional calls (M95, M97): a pass that is copied at an input for the other branch."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from copy import copy
from typing import Protocol

from core.interpreter.omniturn.flow.loops_and_subroutines import called_when, takes_call, terminal
from core.interpreter.omniturn.motion.corners import ContourModifier
from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_state import ContourState
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import ToolUse
from core.interpreter.shared.job_setup import Setup


class Guide(Protocol):
    """Record of the branches that have been executed."""

    def known(self, way: Branching) -> bool:
        """Return whether another pass was in this state, so that the rest has already been checked."""
        ...

    def asked(self, way: Branching, statement: Statement, takes: bool) -> None:
        """Record that a pass reads an input and continues with or without the call (``takes``)."""
        ...


class Branching(Interpreter):
    """A pass that a guide follows. ``other`` returns a copy that takes the other branch at the next input.

    An input is assumed to keep its state until an action occurs. ``unlikely`` is True if a branch contradicts
    this assumption.
    """

    def __init__(self, program: Program, setup: Setup, guide: Guide) -> None:
        super().__init__(program, setup)
        self._guide = guide
        self._approached = False  # a copy starts in the middle of the program
        self._fresh = False  # a copy whose first line must take the other branch
        self._choice: bool | None = None
        self._held: dict[str, bool] = {}  # states of inputs since the last action
        self._held_to = 0  # number of blocks at the last of these states
        self.merged = False  # the pass has reached the state of another pass
        self.unlikely = False  # an input has changed between two reads without an action between them

    @property
    def count(self) -> int:
        """Number of blocks so far, including the blocks of the pass that was copied."""
        return self._state.blocks

    @property
    def stopped(self) -> bool:
        """Whether an error has stopped the blocks."""
        return self._stopped

    @property
    def key(self) -> Hashable:
        """Key that is equal in two passes only if all later blocks are equal for equal inputs."""
        state = self._state
        return (
            self._flow.place,
            state.modal._replace(comment=""),
            (state.x, state.z, state.c, state.px, state.pz),
            (state.first_feed, state.tool_line, state.title_rapid, state.coarse_at, state.turning),
            frozenset(state.reported),
            tuple(sorted(self._held.items())) if self._held_to == state.blocks else (),
            self._stopped,
        )

    def other(self, statement: Statement, takes: bool) -> Branching:
        """Return a copy of this pass that takes the other branch at this line and has its own findings."""
        twin = copy(self)
        twin._log = Log()
        twin._state = state = copy(self._state)
        state.log, state.contour = twin._log, ContourState()
        state.reported, state.pending_shift = set(state.reported), dict(state.pending_shift)
        twin._modifier, twin._tools = ContourModifier(state), ToolUse()
        twin._flow = self._flow.twin()
        twin._flow.at = statement.line - 1
        twin._held = dict(self._held)
        twin._ahead = None
        twin._approached, twin._fresh, twin._choice = True, True, not takes
        twin.unlikely = self.unlikely or self._answer(statement) is not None
        return twin

    def _answer(self, statement: Statement) -> bool | None:
        """Return whether the input of the call is closed, as far as it is known.

        Returns None if the input was not read since the last action.
        """
        if self._held_to != self._state.blocks:
            self._held = {}
        return self._held.get(terminal(statement))

    def _statement(self, statement: Statement) -> Iterator[Block]:
        if not self._state.contour.active:
            self._flow.at = statement.line - 1
            if self._fresh:
                self._fresh = False
            elif self._guide.known(self):
                self.merged = True
                self._flow.stop()
                return
            elif statement.asks and not self._left_out(statement):
                self._choose(statement)
            self._flow.at = statement.line
        yield from super()._statement(statement)

    def _left_out(self, statement: Statement) -> bool:
        return statement.block_delete and self._state.setup.block_delete

    def _choose(self, statement: Statement) -> None:
        answer = self._answer(statement)
        takes = (
            takes_call(statement, self._state.setup.inputs)
            if answer is None
            else answer == called_when(statement)
        )
        self._choice = takes
        self._guide.asked(self, statement, takes)

    def _takes(self, statement: Statement) -> bool:
        takes, self._choice = bool(self._choice), None
        self._held[terminal(statement)] = takes == called_when(statement)
        self._held_to = self._state.blocks
        return takes

    def _approach(self) -> Iterator[Block]:
        return iter(()) if self._approached else super()._approach()

    def _end(self) -> Iterator[Block]:
        return iter(()) if self.merged else super()._end()
