"""Interpreter of Klartext: generates the elementary blocks of a program for a setup."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.geometry.rotary_axes import Kinematics
from core.interpreter.klartext.consequent_faults import Consequences, ends_the_pass
from core.interpreter.klartext.cycles.contour_figures import ContourFigure, FigureRunner, copy_of
from core.interpreter.klartext.cycles.cycle_calls import Cycles
from core.interpreter.klartext.flow import mid_program_startup
from core.interpreter.klartext.flow.blocks_without_motion import Reckoned, go_on, reckon, refuse_endless
from core.interpreter.klartext.flow.mid_program_startup import Parts
from core.interpreter.klartext.klartext_program import Flow, Program
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion import feed_rates, plane_functions
from core.interpreter.klartext.motion.path_functions import PathRunner
from core.interpreter.klartext.motion.plane_functions import plane
from core.interpreter.klartext.setup import m_functions
from core.interpreter.klartext.setup.coordinate_transformations import datum, transform
from core.interpreter.klartext.setup.tool_call import define_tool, tool_call
from core.interpreter.shared.actions import ProgramEnd, ProgramStop
from core.interpreter.shared.checkpoint import Begin, Checkpoint
from core.interpreter.shared.control_flow import LoopWatch
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import MOST_LINES_WITHOUT_BLOCK, LinePass
from core.interpreter.shared.job_setup import Setup
from core.interpreter.shared.modal_state import Modal
from core.language.diagnostics import ProgramError
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext.canonical_text import name_text
from core.language.klartext.klartext_faults import FILE_MISSING, LABEL, unsupported
from core.language.klartext.named_files import Row
from core.message import Message


class Interpreter(LinePass[nodes.KlartextLine]):
    """One pass through a Klartext program."""

    def __init__(self, program: Program, setup: Setup, kinematics: Kinematics) -> None:
        super().__init__(Log(program.problems))
        self._program = program
        self._state = State(setup, kinematics, self._log, inch=program.inch)
        self._state.blank = program.corners
        self._flow = Flow(program)
        self._watch = None if self._flow.reads_the_control else LoopWatch()
        self._path = PathRunner(self._state)
        self._cycles = Cycles(self._state)
        self._setup = setup
        self._consequences = Consequences()
        if setup.begin is not None:
            self._go_on_from(setup.begin)

    @property
    def source_blocks(self) -> int:
        """Number of lines that contain more than a comment."""
        return self._program.blocks

    @property
    def state(self) -> State:
        """State after the last generated block."""
        return self._state

    @property
    def modal(self) -> Modal:
        """Modal state after the last generated block."""
        return self._state.modal

    @property
    def checkpoint(self) -> Checkpoint:
        """State that the next line inherits."""
        return mid_program_startup.checkpoint_of(self._parts, self._shared)

    @property
    def waits_for(self) -> str:
        """Reason why no other pass can continue from here; empty if one can."""
        return self._path.waits_for

    @property
    def _parts(self) -> Parts:
        return Parts(self._state, self._path, self._cycles, self._flow, self._taken)

    @property
    def _shared(self) -> tuple[object, ...]:
        program = self._program
        return self._setup, self._log, program, self._setup.kinematics, *program.called.values()

    def _go_on_from(self, begin: Begin) -> None:
        """Restore the state that the line of ``begin`` inherits, for MDI or for a restart."""
        kept = begin.checkpoint.kept
        if kept is not None:
            parts: Parts = kept.parts(self._setup, self._log)
            self._state, self._path, self._cycles = parts.state, parts.path, parts.cycles
            if not begin.single:
                self._flow, self._taken = parts.flow, parts.taken
        mid_program_startup.take_up(self._state, begin, inch=self._program.inch)
        self._approach = mid_program_startup.approach_blocks(self._state, begin)

    def _can_stop(self, line: nodes.KlartextLine) -> bool:
        return line.node is not None and not self._flow.outside

    def _never_ends(self, line: nodes.KlartextLine) -> None:
        self._stop_endless(line.number, "Reduce the repeat counts.")

    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """Return an iterator that generates the elementary blocks. Call this method once."""
        yield from self._approach
        self._made = self._state.blocks
        for line in self._lines(self._flow.next):
            for block in self._guarded(line):
                if not self._stopped:
                    yield block
            self._made = self._state.blocks
            if self._stopped and (to_first_error or self._log.full):
                return
        if not (self._stopped or self.stopped_before or self._flow.ended_by_code):
            yield from self._end_of_program()

    def _end_of_program(self) -> Iterator[Block]:
        """Yield the end of the program at END PGM, which acts like M30."""
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
        """Yield the blocks of a line; an error is logged and ends them."""
        if line.skip and self._state.setup.block_delete:
            return
        if line.error is not None:
            self._log.add(self._flow.located(line.error))
            self._stopped = True
            self._consequences.unreadable(line.code)
            return
        try:
            yield from self._line(line)
        except ProgramError as problem:
            if not self._consequences.follows(problem, line.node):
                self._log.add(problem.diagnostic)
            self._stopped = True
            if ends_the_pass(line.node):
                self._flow.end_all()

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
                go_on(state, self._flow, line.number, node)
                if isinstance(node, nodes.Jump) and self._watch is not None:
                    refuse_endless(state, self._flow, self._watch, line.number, node)
            case _ if isinstance(node, Reckoned):
                reckon(state, node)
            case (
                None | nodes.Begin() | nodes.End() | nodes.BlankForm() | nodes.RoundBlank() | nodes.Heading()
            ):
                pass
            case _:
                yield from self._path.finish(1, state.text.split(" ")[0])
                yield from self._coordinates(node)

    def _coordinates(self, node: nodes.Node) -> Iterator[Block]:
        """Yield the blocks of tools, cycles and coordinate changes.

        No element may be buffered before them.
        """
        state = self._state
        match node:
            case nodes.Plane():
                yield from plane(state, node)
            case nodes.ToolCall():
                yield from tool_call(state, node, self._tools)
            case nodes.ToolDef():
                define_tool(state, node)
            case nodes.Datum():
                self._shift(node)
            case nodes.Transform():
                transform(state, node)
            case nodes.TipControl():
                plane_functions.switch(state, on=node.on)
            case nodes.Cycle() | nodes.CycleLine() | nodes.PatternDef() | nodes.ContourDef():
                yield from self._cycles.told(node)
            case nodes.Selection():
                self._select(node)
            case nodes.ProgramCall():
                self._call_program(node.name or self._selected(node.column), node.column)

    def _shift(self, node: nodes.Datum) -> None:
        """Execute a datum shift, with a table if the block names one. Raises ProgramError."""
        if node.table:
            self._select(nodes.Selection("TABLE", node.table, node.column))
        datum(self._state, node)

    def _select(self, node: nodes.Selection) -> None:
        """Execute SEL TABLE, SEL PATTERN or SEL PGM. Raises ProgramError for a missing table."""
        if node.kind == "PGM":
            self._state.selected_program = node.name
            return
        rows = self._table(node.name, node.column)
        if node.kind == "TABLE":
            self._state.datum_table = rows
        else:
            self._cycles.select_points(rows)

    def _missing_program(self, name: str, column: int) -> ProgramError:
        text = Message("Program {name} is not in the same folder as this program.", name=name)
        return self._state.refuse(
            column, FILE_MISSING, text, "Put the file in the same folder as this program."
        )

    def _table(self, name: str, column: int) -> dict[int, Row]:
        rows = self._flow.table(name)
        if rows is None:
            text = Message("Table {name} is not in the same folder as this program.", name=name)
            raise self._state.refuse(
                column, FILE_MISSING, text, "Put the file in the same folder as this program."
            )
        return rows

    def _selected(self, column: int) -> str:
        """Return the program of SEL PGM. Raises ProgramError without one."""
        if not self._state.selected_program:
            text = "No program is selected."
            raise self._state.refuse(column, FILE_MISSING, text, "Write SEL PGM before this block.")
        return self._state.selected_program

    def _call_program(self, name: str, column: int) -> None:
        called = self._flow.call_program(name, self._state.line)
        if called is None:
            raise self._missing_program(name, column)

    # --- moves, M functions, cycles -----------------------------------------------------------------------

    def _move(self, node: nodes.Move, comment: str) -> Iterator[Block]:
        """Yield the blocks of a path function with its M functions.

        A cycle that M99 or M89 calls follows.
        """
        state, path = self._state, self._path
        m_functions.check(state, node.codes)
        feed_rates.switch(state, node.codes)
        if any(code.number in m_functions.BEFORE for code in node.codes):
            yield from path.between(lambda: m_functions.before(state, node.codes))
        datum = m_functions.datum(state, node.codes)
        yield from path.move(node, datum=datum, corner_behind=self._corner_is_next())
        yield from self._behind(node.codes, comment)
        moved = any(word.axis in "XY" for word in node.axes) or bool(node.words)
        yield from self._with_cycle(node.codes, node.column, moved=moved)

    def _called(self, node: nodes.Codes | nodes.Stop | nodes.CycleCall, comment: str) -> Iterator[Block]:
        """Yield the blocks of M functions alone, STOP or CYCL CALL."""
        state, path = self._state, self._path
        m_functions.check(state, node.codes)
        feed_rates.switch(state, node.codes)
        yield from path.between(lambda: m_functions.before(state, node.codes))
        if isinstance(node, nodes.CycleCall):
            yield from path.finish(node.column, "CYCL CALL")
            if node.pattern:
                yield from self._cycles.call_pattern(node)
            else:
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
                # the position is then after END PGM, so that the program does not end twice
                self._flow.end_all()

    def _with_cycle(self, codes: Sequence[nodes.MCode], column: int, *, moved: bool) -> Iterator[Block]:
        """Yield the cycle of M99, or of M89, which calls it after every move in the plane until M99."""
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
        """Yield the machining cycle at the tool position, or call the program of cycle 12."""
        if self._cycles.program:
            self._call_program(self._cycles.program, column)
            return
        figures = [self._figure(part, column) for part in self._cycles.contours]
        yield from self._cycles.call(column, figures)

    def _figure(self, part: nodes.ContourPart, column: int) -> ContourFigure:
        """Return the contour of a subprogram, which is executed with a copy of the state."""
        state = copy_of(self._state)
        if part.file:
            flow, name = self._flow.through_program(part.file), part.file
            if flow is None:
                raise self._missing_program(part.file, column)
        else:
            flow, name = (
                self._flow.through_subprogram(part.label),
                Message("LBL {part}", part=name_text(part.label)),
            )
        if flow is None:
            text = Message("{name} of the contour is not in the program or has no LBL 0.", name=name)
            raise self._state.refuse(column, LABEL, text, "Correct the label number, or add the label.")
        runner, lines = FigureRunner(state), MOST_LINES_WITHOUT_BLOCK
        while (line := flow.next()) is not None:
            lines -= 1
            if line.error is not None:
                raise ProgramError(self._flow.located(line.error))
            if lines < 0:
                raise self._state.refuse(
                    column, LABEL, Message("{name} never reaches its end.", name=name), "Correct the value."
                )
            if not (line.skip and state.setup.block_delete):
                state.line, state.text = self._flow.shown_line(line.number), flow.program.text(line)
                _draw(state, runner, flow, line)
        runner.close()
        return ContourFigure(name, runner.elements, runner.side, part.pocket)

    def _corner_is_next(self) -> bool:
        """Return whether the next block is RND or CHF, for which an element must be buffered."""
        return isinstance(self._flow.next_node(), nodes.Corner)


def _draw(state: State, runner: FigureRunner, flow: Flow, line: nodes.KlartextLine) -> None:
    """Execute a line of a contour's subprogram; feeds, M functions and tools have no effect."""
    match line.node:
        case nodes.Move():
            runner.draw(line.node)
        case nodes.Corner():
            runner.corner(line.node)
        case nodes.Pole():
            runner.pole(line.node)
        case nodes.Label() | nodes.Call() | nodes.Jump():
            go_on(state, flow, line.number, line.node)
        case node if isinstance(node, Reckoned):
            reckon(state, node)
        case nodes.Datum() | nodes.Transform() | nodes.Plane() | nodes.Cycle() | nodes.CycleLine():
            what = state.text.split("~")[0].strip()
            raise unsupported(state.line, 1, Message("{form} inside an SL cycle contour", form=what))
