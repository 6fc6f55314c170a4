"""The interpreter of Klartext: a program and its circumstances to elementary blocks, one after the other."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from core.geometry.rotary_axes import Kinematics
from core.interpreter.actions import ProgramEnd, ProgramStop
from core.interpreter.diagnostic_log import Log
from core.interpreter.elementary_blocks import Block
from core.interpreter.interpretation import MOST_BLOCKS, MOST_LINES, MOST_LINES_WITHOUT_BLOCK, Interpretation
from core.interpreter.job_setup import Setup
from core.interpreter.klartext import m_functions, q_functions, tip_control, word_values
from core.interpreter.klartext.coordinate_transformations import datum, transform
from core.interpreter.klartext.cycles import Cycles
from core.interpreter.klartext.klartext_program import Flow, Program
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.path_functions import PathRunner
from core.interpreter.klartext.plane_functions import plane
from core.interpreter.klartext.tool_call import define_tool, tool_call
from core.interpreter.modal_state import Modal
from core.language.diagnostics import ProgramError
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext.klartext_faults import FILE_MISSING
from core.language.klartext.structure_blocks import MOST_REPEATS


class Interpreter(Interpretation):
    """One pass through a Klartext program."""

    def __init__(self, program: Program, setup: Setup, kinematics: Kinematics) -> None:
        super().__init__(Log(program.problems))
        self._program = program
        self._state = State(setup, kinematics, self._log, inch=program.inch)
        self._state.blank = program.corners
        self._flow = Flow(program)
        self._path = PathRunner(self._state)
        self._cycles = Cycles(self._state)

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
        flow = self._flow
        left, idle, made = MOST_LINES, 0, 0
        while (line := flow.next()) is not None:
            left -= 1
            idle, made = (idle + 1, made) if self._state.blocks == made else (0, self._state.blocks)
            if left < 0 or idle > MOST_LINES_WITHOUT_BLOCK or self._state.blocks >= MOST_BLOCKS:
                self._stop_endless(line.number, "Lower the counts of the repeats.")
                return
            for block in self._guarded(line):
                if not self._stopped:
                    yield block
            if self._stopped and (to_first_error or self._log.full):
                return
        if not self._stopped and not flow.ended_by_code:
            yield from self._end_of_program()

    def _end_of_program(self) -> Iterator[Block]:
        """END PGM, which ends as M30 does."""
        state, end = self._state, self._program.end
        if end >= len(self._program.lines):
            return
        state.line, state.text = end + 1, self._program.text(self._program.lines[end])
        try:
            yield from self._path.end()
        except ProgramError as problem:
            self._log.add(problem.diagnostic)
            self._stopped = True
            return
        yield m_functions.end(state)

    def _guarded(self, line: nodes.KlartextLine) -> Iterator[Block]:
        """The blocks of a line; an error of it is kept and ends them."""
        if line.skip and self._state.setup.block_delete:
            return
        if line.error is not None:
            self._log.add(self._flow.located(line.error))
            self._stopped = True
            return
        try:
            yield from self._line(line)
        except ProgramError as problem:
            self._log.add(problem.diagnostic)
            self._stopped = True

    def _line(self, line: nodes.KlartextLine) -> Iterator[Block]:
        state, node = self._state, line.node
        state.line, state.text = self._flow.shown_line(line.number), self._flow.program.text(line)
        match node:
            case nodes.Move():
                yield from self._move(node, line.comment or "")
            case nodes.Codes() | nodes.Stop() | nodes.CycleCall():
                yield from self._called(node, line.comment or "")
            case nodes.Corner():
                self._path.corner(node)
            case nodes.Pole():
                self._path.pole(node)
            case nodes.Label() | nodes.Call() | nodes.Jump():
                self._go_on(line.number, node)
            case nodes.Assign() | nodes.SystemRead() | nodes.ErrorMessage() | nodes.Unheeded():
                _reckon(state, node)
            case None | nodes.Begin() | nodes.End() | nodes.BlankForm() | nodes.Heading():
                pass
            case _:
                yield from self._path.finish(1, state.text.split(" ")[0])
                yield from self._coordinates(node)

    def _coordinates(self, node: nodes.Node) -> Iterator[Block]:
        """Blocks that change what coordinates mean, tools and cycles: nothing may wait before them."""
        state = self._state
        match node:
            case nodes.Plane():
                yield from plane(state, node)
            case nodes.ToolCall():
                yield from tool_call(state, node, self._tools)
            case nodes.ToolDef():
                define_tool(state, node)
            case nodes.Datum():
                datum(state, node)
            case nodes.Transform():
                transform(state, node)
            case nodes.TipControl():
                tip_control.switch(state, on=node.on)
            case nodes.Cycle():
                yield from self._cycles.define(node)
            case nodes.CycleLine():
                yield from self._cycles.line(node)
            case nodes.ProgramCall():
                self._call_program(node.name, node.column)

    def _go_on(self, line: int, node: nodes.Label | nodes.Call | nodes.Jump) -> None:
        """Labels, calls and jumps: where the program goes on."""
        if isinstance(node, nodes.Label):
            self._flow.label(node)
        elif isinstance(node, nodes.Call):
            repeat = node.repeat or nodes.Value(0.0)
            times = word_values.number(self._state, repeat, "REP", MOST_REPEATS, 0.0)
            self._flow.call(line, node, math.floor(times))
        elif q_functions.jumps(self._state, node):
            self._flow.jump(node)

    def _call_program(self, name: str, column: int) -> None:
        called = self._flow.call_program(name, self._state.line)
        if called is None:
            text = f"The program {name} is not beside this one."
            raise self._state.refuse(column, FILE_MISSING, text, "Put it into the same folder.")

    # --- moves, M functions, cycles -----------------------------------------------------------------------

    def _move(self, node: nodes.Move, comment: str) -> Iterator[Block]:
        """A path function with the M functions before and behind it, and the cycle that M99 or M89 calls."""
        state, path = self._state, self._path
        m_functions.check(state, node.codes)
        if any(code.number in m_functions.BEFORE for code in node.codes):
            yield from path.between(lambda: m_functions.before(state, node.codes))
        machine = any(code.number == m_functions.M91 for code in node.codes)
        yield from path.move(node, machine=machine, corner_behind=self._corner_is_next())
        yield from self._behind(node.codes, comment)
        moved = any(word.axis in "XY" for word in node.axes) or bool(node.words)
        yield from self._with_cycle(node.codes, node.column, moved=moved)

    def _called(self, node: nodes.Codes | nodes.Stop | nodes.CycleCall, comment: str) -> Iterator[Block]:
        """M functions alone, STOP, CYCL CALL."""
        state, path = self._state, self._path
        m_functions.check(state, node.codes)
        yield from path.between(lambda: m_functions.before(state, node.codes))
        if isinstance(node, nodes.CycleCall):
            yield from path.finish(node.column, "CYCL CALL")
            yield from self._cycles.call_at(node) if node.axes else self._run_cycle(node.column)
        if isinstance(node, nodes.Stop):
            stop = ProgramStop(optional=False, message=comment)
            yield from path.between(lambda: iter((state.action(stop),)))
        yield from self._behind(node.codes, comment)
        if not isinstance(node, nodes.CycleCall):
            yield from self._with_cycle(node.codes, 1, moved=False)

    def _behind(self, codes: Sequence[nodes.MCode], comment: str) -> Iterator[Block]:
        state = self._state
        if any(code.number in m_functions.ENDS for code in codes):
            yield from self._path.end()
        elif not any(code.number not in m_functions.BEFORE for code in codes):
            return
        for block in self._path.between(lambda: m_functions.behind(state, codes, comment)):
            yield block
            if isinstance(block.action, ProgramEnd):
                self._flow.end_all()  # behind END PGM: nothing ends twice

    def _with_cycle(self, codes: Sequence[nodes.MCode], column: int, *, moved: bool) -> Iterator[Block]:
        """M99 runs the cycle here, M89 from here on behind every move in the plane, up to M99."""
        numbers = {code.number for code in codes}
        wanted = self._cycles.modal and moved
        if m_functions.M89 in numbers:
            self._cycles.modal = wanted = True
        if m_functions.M99 in numbers:
            self._cycles.modal, wanted = False, True
        if not wanted:
            return
        yield from self._path.finish(column, "A cycle")
        yield from self._run_cycle(column)

    def _run_cycle(self, column: int) -> Iterator[Block]:
        """The machining cycle where the tool stands, or the program that cycle 12 has named."""
        if self._cycles.program:
            self._call_program(self._cycles.program, column)
        else:
            yield from self._cycles.call(column)

    def _corner_is_next(self) -> bool:
        """Whether the next block is RND or CHF, for which an element has to wait."""
        return isinstance(self._flow.next_node(), nodes.Corner)


def _reckon(
    state: State, node: nodes.Assign | nodes.SystemRead | nodes.ErrorMessage | nodes.Unheeded
) -> None:
    """Q parameters and FN functions. Raises ProgramError, and for FN 14 always."""
    match node:
        case nodes.Assign():
            q_functions.assign(state, node)
        case nodes.SystemRead():
            q_functions.read_system(state, node)
        case nodes.ErrorMessage():
            raise q_functions.own_error(state, node)
        case nodes.Unheeded():
            state.unheeded(node.what, node.column)
