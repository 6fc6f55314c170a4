"""Cycles of the source program, selected by G code and control."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from core.extras.convert.contour_cycles import (
    Roughing,
    allowances,
    depth_of_pass,
    passes,
    repeats,
    roughing_words,
)
from core.extras.convert.hole_cycles import HOLES, hole_cycle
from core.extras.convert.path_steps import MOVES, Kind, Step
from core.extras.convert.reasons import refuse
from core.extras.convert.single_cycles import Peck, facing_box, peck_cycle, turning_box
from core.extras.convert.source_flow import Flow
from core.extras.convert.source_lines import Statement, Word
from core.extras.convert.source_state import SourceState
from core.extras.convert.thread_cycles import (
    FanucThread,
    is_first_line,
    linuxcnc_thread_cycle,
    thread_box,
    thread_cycle,
)

Execute = Callable[[Statement], None]
_BOXES: Mapping[int, Callable[[SourceState, Statement, Word], None]] = {
    90: turning_box,
    92: thread_box,
    94: facing_box,
}
_BOXES_OF_B: Mapping[int, Callable[[SourceState, Statement, Word], None]] = {
    77: turning_box,
    78: thread_box,
    79: facing_box,
}
_WORDS = {
    70: "PQFSUWD", 71: "PQUWDRFSIK", 72: "PQUWDRFSIK", 73: "PQUWRFSD", 74: "RXZUWPQFIKD", 75: "RXZUWPQFIKD",
    76: "PQRXZUWFKDAIEHJL",
}  # fmt: skip


class Cycles:
    """The cycles of one pass through a source program, with the values that their first lines store."""

    def __init__(self, state: SourceState, flow: Flow, execute: Execute) -> None:
        self._state, self._flow, self._execute = state, flow, execute
        self._rough = Roughing()
        self._thread = FanucThread()
        self._peck = Peck()

    def is_modal(self, code: float) -> bool:
        """Return whether this G code remains active on further lines with axis words."""
        return code in self._boxes() or code in self._holes()

    def is_hole(self, code: float) -> bool:
        """Return whether this G code is a hole cycle."""
        return code in self._holes()

    def _boxes(self) -> Mapping[int, Callable[[SourceState, Statement, Word], None]]:
        if not self._state.control.is_fanuc:
            return {}
        return _BOXES if self._state.control.has_system_a else _BOXES_OF_B

    def _holes(self) -> frozenset[int]:
        return HOLES - {73} if self._state.control.is_fanuc else HOLES

    def modal(self, statement: Statement, code: Word) -> None:
        """Execute a line of the active modal cycle. Raises ProgramError."""
        number = round(self._state.motion)
        code = code._replace(value=number)
        extra = "RIKFE" if number in self._boxes() else "RQPFKL"
        self._check(statement, "XZUWGMSTN" + extra)
        if number in self._boxes():
            self._boxes()[number](self._state, statement, code)
        else:
            if self._state.plane == 18 and not self._state.control.is_fanuc:
                raise refuse(code.line, code.column, "hole-plane", word=f"G{number}")
            hole_cycle(self._state, statement, code)

    def one_shot(self, statement: Statement, code: Word) -> bool:
        """Execute a cycle that is active only on its own line; return whether the code is such a cycle."""
        state, number = self._state, code.value
        if not state.control.is_fanuc:
            if number != 76:
                return False
            linuxcnc_thread_cycle(state, statement, code)
            return True
        if number not in _WORDS:
            return False
        self._check(statement, "GMNST" + _WORDS[round(number)])
        if number in {70, 71, 72, 73}:
            self._contour(statement, code)
        elif number in {74, 75}:
            peck_cycle(state, statement, code, self._peck)
        elif is_first_line(statement):
            self._thread.set(state, statement)
        else:
            thread_cycle(state, statement, code, self._thread)
        return True

    def _check(self, statement: Statement, letters: str) -> None:
        for word in statement.words:
            if word.letter not in letters:
                raise refuse(word.line, word.column, "code-unknown", word=word.text)

    def _contour(self, statement: Statement, code: Word) -> None:
        state = self._state
        if code.value != 70 and roughing_words(state, statement, code, self._rough):
            return
        p, q = statement.word("P"), statement.word("Q")
        if p is None or q is None:
            raise refuse(code.line, code.column, "cycle-word", word="P" if p is None else "Q")
        lines, after = self._flow.contour(p.value, q.value, self._flow.at)
        start = state.here(code)
        if code.value == 70:
            for each in lines:
                self._execute(each)
            state.rapid(code.line, *start)
            return
        contour = self._trace(lines)
        allowance = allowances(state, statement)
        if code.value == 73:
            repeats(state, code, contour, self._rough, allowance)
        else:
            depth = depth_of_pass(state, statement, code, self._rough)
            passes(state, code, contour, depth, self._rough.retract, allowance)
        self._flow.at = after

    def _trace(self, lines: Sequence[Statement]) -> list[Step]:
        """Return the moves of a contour without its final rapids, and restore the state."""
        state = self._state
        saved = (state.steps, state.x, state.z, state.feed, state.motion, state.nose, state.comment)
        spindle, warnings = state.spindle, list(state.warnings)
        state.steps, state.feed = [], state.feed or 1.0
        for each in lines:
            self._execute(each)
        found = [each for each in state.steps if each.kind in MOVES]
        state.steps, state.x, state.z, state.feed, state.motion, state.nose, state.comment = saved
        state.spindle, state.warnings = spindle, warnings
        while len(found) > 1 and found[-1].kind is Kind.RAPID:
            found.pop()
        return found
