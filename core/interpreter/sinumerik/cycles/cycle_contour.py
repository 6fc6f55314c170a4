"""The contour that CYCLE95 names: a subprogram, or the lines between two labels "START:END"."""

from __future__ import annotations

import copy
from collections.abc import Iterable

from core.geometry.lines_and_arcs import Element
from core.interpreter.shared.contour_stage import element_of
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.flow.control_structures import Routine, find_label
from core.interpreter.sinumerik.flow.variables import Scope
from core.interpreter.sinumerik.motion.chamfers_and_rounds import Corners, corner_of
from core.interpreter.sinumerik.motion.linear_moves import straight
from core.interpreter.sinumerik.motion.sinumerik_arcs import arc
from core.interpreter.sinumerik.setup.modes_and_offsets import modes
from core.interpreter.sinumerik.sinumerik_state import ARCS, Motion, State
from core.interpreter.sinumerik.sinumerik_statement import Statement, statement_of
from core.language.diagnostics import ProgramError
from core.language.sinumerik.program_jumps import Steering
from core.language.sinumerik.sinumerik_alarms import fault
from core.language.sinumerik.sinumerik_words import Line
from core.language.sinumerik.word_table import ABSOLUTE, MOTION, PLANE, TRANSVERSE
from core.message import Message

WRONG_CONTOUR = 61605
_SAME = 1e-6  # mm
_MOTIONS = frozenset({0, 1, 2, 3})
_GROUPS = frozenset({MOTION, ABSOLUTE, PLANE, TRANSVERSE})
_TAKEN = frozenset({Steering.PROCEDURE, Steering.MESSAGE, Steering.STOP_READING, Steering.RETURN})
_END = frozenset({2, 17, 30})


def contour_lines(named: str, running: Routine, known: Routine | None) -> list[Line] | None:
    """The lines of a contour by its name; None where there is none."""
    if ":" in named:
        first, last = (part.strip() for part in named.split(":", 1))
        start = find_label(Steering.GOTO, first, running, running.lines.start - 1)
        end = None if start is None else find_label(Steering.GOTO_FORWARD, last, running, start)
        if start is None or end is None:
            return None
        return [running.line(at) for at in range(start, end + 1)]
    return None if known is None else [known.line(at) for at in known.lines]


def read_contour(state: State, lines: Iterable[Line]) -> list[Element]:
    """The lines and arcs of a contour in the program's frame, mm; its first move is its first point.

    The state in force stays as it is. Raises ProgramError for a line that no contour can hold.
    """
    reader = _Reader(state)
    for line in lines:
        if line.skip is not None and state.setup.block_delete:
            continue
        if line.executable and reader.take(line):
            break
    return reader.elements()


class _Reader:
    def __init__(self, state: State) -> None:
        own = copy.copy(state)
        own.log = Log()
        own.variables = copy.copy(state.variables)
        own.variables.scope = Scope(dict(state.variables.scope.numbers))
        own.variables.r = dict(state.variables.r)
        own.threads, own.rounding, own.motion = (), 0.0, Motion.LINE
        # Its feeds do not count, so that none is missing.
        own.adopt(state.modal._replace(feed=1.0, per_rev=False, css=False))
        self._state = own
        self._corners = Corners(own, own.log)
        self._blocks: list[Block] = []

    def take(self, line: Line) -> bool:
        """One line; whether it ends the contour. Raises ProgramError."""
        for found in line.errors:
            raise ProgramError(found)
        if line.call or line.modal_call or (line.jump is not None and line.jump.steering not in _TAKEN):
            raise _refused(line, "a contour can contain only moves, but this line contains a call or a jump")
        if line.jump is not None:
            return line.jump.steering is Steering.RETURN
        statement = statement_of(line)
        self._check(statement)
        for word in statement.sets:
            self._state.variables.keep(word.name, self._state.number(statement, word))
        if statement.g:
            modes(self._state, statement)
        if statement.moves:
            block = (arc if self._state.motion in ARCS else straight)(self._state, statement)
            corner = corner_of(self._state, statement, block)
            self._blocks += self._corners.take(block, corner)
        return bool(_END & statement.m.keys())

    def _check(self, statement: Statement) -> None:
        groups = statement.g.keys() - _GROUPS
        if groups:
            word = statement.g[min(groups)]
            raise _refused(statement.line, Message("{line} is not allowed in a contour", line=word.text))
        motion = statement.code(MOTION)
        if motion is not None and motion not in _MOTIONS:
            raise _refused(statement.line, "a contour can contain only G0, G1, G2 and G3")
        if "C" in statement.words or statement.frame_key is not None:
            raise _refused(statement.line, "C and frames are not allowed in a contour")

    def elements(self) -> list[Element]:
        """Everything behind the first move."""
        self._blocks += self._corners.end()
        elements = [element_of(block) for block in self._blocks[1:] if block.moves]
        return [each for each in elements if each.length > _SAME]


def _refused(line: Line, why: str) -> ProgramError:
    return ProgramError(
        fault(
            line.number,
            1,
            WRONG_CONTOUR,
            line.block,
            Message("{what}.", what=why),
            "Remove this text from the program.",
        )
    )
