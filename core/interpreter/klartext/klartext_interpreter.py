"""The interpreter of Klartext: a program and its circumstances to elementary blocks, one after the other."""

from __future__ import annotations

from collections.abc import Iterator

from core.geometry.rotary_axes import Kinematics
from core.geometry.rotation_frames import Vector
from core.interpreter.actions import ProgramEnd, ProgramStop
from core.interpreter.diagnostic_log import Log
from core.interpreter.elementary_blocks import Block
from core.interpreter.interpretation import MOST_BLOCKS, MOST_LINES, Interpretation
from core.interpreter.job_setup import Setup
from core.interpreter.klartext import m_functions, word_values
from core.interpreter.klartext.klartext_program import Flow, Program
from core.interpreter.klartext.klartext_state import ORIGIN, SLIDES, State
from core.interpreter.klartext.l_moves import move
from core.interpreter.klartext.plane_functions import plane
from core.interpreter.klartext.tool_call import tool_call
from core.interpreter.modal_state import Modal
from core.language.diagnostics import ProgramError
from core.language.klartext import klartext_nodes as nodes

MOST_Q = 999_999_999.999999


class Interpreter(Interpretation):
    """One pass through a Klartext program."""

    def __init__(self, program: Program, setup: Setup, kinematics: Kinematics) -> None:
        super().__init__(Log(program.problems))
        self._program = program
        self._state = State(setup, kinematics, self._log, inch=program.inch)
        self._state.blank = program.corners
        self._flow = Flow(program)

    @property
    def source_blocks(self) -> int:
        """Lines that hold more than a comment."""
        return self._program.blocks

    @property
    def state(self) -> State:
        """Where everything stands after the last block that was taken."""
        return self._state

    @property
    def modal(self) -> Modal:
        """The state after the last block that was taken."""
        return self._state.modal

    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """The elementary blocks, made as they are asked for. To be called once."""
        flow, lines = self._flow, self._program.lines
        left = MOST_LINES
        while flow.at < flow.end:
            line = lines[flow.at]
            flow.at += 1
            left -= 1
            if left < 0 or self._state.blocks >= MOST_BLOCKS:
                self._stop_endless(line.number, "Lower the counts of the repeats.")
                return
            for block in self._guarded(line):
                if not self._stopped:
                    yield block
            if self._stopped and (to_first_error or self._log.full):
                return
        if not self._stopped and flow.at == flow.end < len(lines):
            self._state.line, self._state.text = flow.end + 1, self._program.text(lines[flow.end])
            yield m_functions.end(self._state)

    def _guarded(self, line: nodes.KlartextLine) -> Iterator[Block]:
        """The blocks of a line; an error of it is kept and ends them."""
        if line.skip and self._state.setup.block_delete:
            return
        if line.error is not None:
            self._stopped = True
            return
        try:
            yield from self._line(line)
        except ProgramError as problem:
            self._log.add(problem.diagnostic)
            self._stopped = True

    def _line(self, line: nodes.KlartextLine) -> Iterator[Block]:
        state, node = self._state, line.node
        state.line, state.text = line.number, self._program.text(line)
        match node:
            case nodes.Move() | nodes.Codes():
                yield from self._with_codes(node, line.comment or "")
            case nodes.Plane():
                yield from plane(state, node)
            case nodes.ToolCall():
                yield from tool_call(state, node, self._tools)
            case nodes.Datum():
                _datum(state, node)
            case nodes.Label():
                self._flow.label(node)
            case nodes.Call():
                self._flow.call(line.number, node)
            case nodes.Assign():
                state.q[node.q] = word_values.number(state, node.value, f"Q{node.q}", MOST_Q)
            case nodes.Stop():
                yield state.action(ProgramStop(optional=False, message=line.comment or ""))

    def _with_codes(self, node: nodes.Move | nodes.Codes, comment: str) -> Iterator[Block]:
        """The M functions of a block, and between them its move where it has one."""
        state = self._state
        m_functions.check(state, node.codes)
        yield from m_functions.before(state, node.codes)
        if isinstance(node, nodes.Move):
            machine = any(code.number == m_functions.M91 for code in node.codes)
            yield from move(state, node, machine=machine)
        for block in m_functions.behind(state, node.codes, comment):
            yield block
            if isinstance(block.action, ProgramEnd):
                self._flow.at = len(self._program.lines)  # behind END PGM: nothing ends twice


def _datum(state: State, node: nodes.Datum) -> None:
    """TRANS DATUM and cycle 7: in the workpiece's system, within the plane while one is in force."""
    if node.reset:
        state.datum = state.shift = ORIGIN
    elif node.axes:
        now = dict(zip(SLIDES, state.shift if state.plane is not None else state.datum, strict=True))
        for word in node.axes:
            value = word_values.coordinate(state, word)
            now[word.axis] = now[word.axis] + value if word.incremental else value
        made: Vector = (now["X"], now["Y"], now["Z"])
        if state.plane is not None:
            state.shift = made
        else:
            state.datum = made
    state.derive()
