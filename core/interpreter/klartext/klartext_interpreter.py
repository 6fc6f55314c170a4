"""Interpreter of Klartext, which converts a program to elementary blocks for a setup."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.geometry.rotary_axes import Kinematics
from core.interpreter.klartext.consequent_faults import ConsequentFaultFilter, makes_flow_unknown
from core.interpreter.klartext.cycles.cycle_calls import ActiveCycle
from core.interpreter.klartext.cycles.sl_contours import ContourCollector, SlContour, copy_state
from core.interpreter.klartext.flow import mid_program_startup
from core.interpreter.klartext.flow.blocks_without_motion import (
    CalculationNode,
    check_endless_loop,
    execute_calculation,
    execute_flow_block,
)
from core.interpreter.klartext.flow.mid_program_startup import InterpreterParts
from core.interpreter.klartext.klartext_program import Flow, Program
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion import feed_rates, plane_functions
from core.interpreter.klartext.motion.path_functions import PathRunner
from core.interpreter.klartext.motion.plane_functions import plane
from core.interpreter.klartext.setup import m_functions
from core.interpreter.klartext.setup.coordinate_transformations import (
    execute_datum_shift,
    execute_transformation,
)
from core.interpreter.klartext.setup.tool_call import define_tool, execute_tool_call
from core.interpreter.shared.actions import ProgramEnd, ProgramStop
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.control_flow import EndlessLoopDetector
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import MAX_LINE_COUNT_WITHOUT_BLOCK, LinePass
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import ProgramError
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext import klartext_words
from core.language.klartext.canonical_text import format_name
from core.language.klartext.klartext_faults import FILE_MISSING, LABEL_NOT_FOUND, make_unsupported_error
from core.language.klartext.named_files import TableRow
from core.message import Message


class Interpreter(LinePass[nodes.KlartextLine]):
    """One pass through a Klartext program."""

    def __init__(self, program: Program, setup: InterpreterSetup, kinematics: Kinematics) -> None:
        super().__init__(DiagnosticLog(program.diagnostics))
        self._program = program
        self._state = State(setup, kinematics, self._log, is_inch=program.is_inch)
        self._state.blank_corners = program.blank_corners
        self._flow = Flow(program)
        self._watch = None if self._flow.has_system_reads else EndlessLoopDetector()
        self._path = PathRunner(self._state)
        self._cycles = ActiveCycle(self._state)
        self._setup = setup
        self._consequences = ConsequentFaultFilter()
        if setup.begin is not None:
            self._restore_from(setup.begin)

    @property
    def source_block_count(self) -> int:
        """Return the number of program lines that contain more than a comment."""
        return self._program.block_count

    @property
    def state(self) -> State:
        """Return the state after the last generated block."""
        return self._state

    @property
    def modal_state(self) -> ModalState:
        """Return the modal state after the last generated block."""
        return self._state.modal

    @property
    def checkpoint(self) -> Checkpoint:
        """Return a checkpoint with the state at the start of the next line."""
        return mid_program_startup.make_checkpoint(self._parts, self._shared)

    @property
    def blocking_reason(self) -> str:
        """Return the reason why another pass cannot continue from the current line.

        The result is an empty string if another pass can continue.
        """
        return self._path.blocking_reason

    @property
    def _parts(self) -> InterpreterParts:
        return InterpreterParts(self._state, self._path, self._cycles, self._flow, self._taken)

    @property
    def _shared(self) -> tuple[object, ...]:
        program = self._program
        return self._setup, self._log, program, self._setup.kinematics, *program.called_programs.values()

    def _restore_from(self, start: PassStart) -> None:
        """Restore the state at the start line, for MDI or for a mid-program startup."""
        kept = start.checkpoint.kept
        if kept is not None:
            parts: InterpreterParts = kept.copy_parts(self._setup, self._log)
            self._state, self._path, self._cycles = parts.state, parts.path_runner, parts.active_cycle
            if not start.is_mdi_line:
                self._flow, self._taken = parts.program_flow, parts.pending_line
        mid_program_startup.restore_state(self._state, start, is_inch=self._program.is_inch)
        self._approach = mid_program_startup.generate_mill_approach(self._state, start)

    def _can_stop(self, line: nodes.KlartextLine) -> bool:
        return line.node is not None and not self._flow.is_in_other_file

    def _report_limit(self, line: nodes.KlartextLine) -> None:
        self._stop_endless(line.line_number, "Reduce the repeat counts.")

    def generate_blocks(self, *, stops_at_first_error: bool = False) -> Iterator[Block]:
        """Generate the elementary blocks of the program. Call this method only once."""
        yield from self._approach
        self._made = self._state.block_count
        for line in self._lines(self._flow.read_next_line):
            for block in self._execute_line_safely(line):
                if not self._stopped:
                    yield block
            self._made = self._state.block_count
            if self._stopped and (stops_at_first_error or self._log.is_full):
                return
        if not (self._stopped or self.has_stopped_before_line or self._flow.is_ended_by_code):
            yield from self._end_of_program()

    def _end_of_program(self) -> Iterator[Block]:
        """Yield the blocks of END PGM, which acts like M30."""
        state, end = self._state, self._program.end_index
        if end >= len(self._program.lines):
            return
        state.line_number, state.text = end + 1, self._program.text(self._program.lines[end])
        try:
            yield from self._path.finish_program()
        except ProgramError as problem:
            self._log.add_finding(problem.diagnostic)
            self._stopped = True
            return
        yield m_functions.execute_program_end(state)

    def _execute_line_safely(self, line: nodes.KlartextLine) -> Iterator[Block]:
        """Yield the blocks of a line until an error occurs, and log the error."""
        if line.is_skippable and self._state.setup.block_delete:
            return
        if line.error is not None:
            self._log.add_finding(self._flow.relocate_finding(line.error))
            self._stopped = True
            self._consequences.record_unreadable_block(line.block_text)
            return
        try:
            yield from self._line(line)
        except ProgramError as problem:
            if not self._consequences.is_consequence(problem, line.node):
                self._log.add_finding(problem.diagnostic)
            self._stopped = True
            if makes_flow_unknown(line.node):
                self._flow.end_program()

    def _line(self, line: nodes.KlartextLine) -> Iterator[Block]:
        state, node = self._state, line.node
        state.line_number, state.text = (
            self._flow.get_displayed_line(line.line_number),
            self._flow.program.text(line),
        )
        match node:
            case nodes.PathFunction():
                yield from self._move(node, line.comment or "")
            case nodes.MFunctionBlock() | nodes.StopBlock() | nodes.CycleCall():
                yield from self._execute_codes_or_cycle(node, line.comment or "")
            case nodes.CornerBlock():
                self._path.add_corner(node)
            case nodes.Pole():
                self._path.set_pole(node)
            case nodes.Label() | nodes.LabelCall() | nodes.ConditionalJump():
                execute_flow_block(state, self._flow, line.line_number, node)
                if isinstance(node, nodes.ConditionalJump) and self._watch is not None:
                    check_endless_loop(state, self._flow, self._watch, line.line_number, node)
            case _ if isinstance(node, CalculationNode):
                execute_calculation(state, node)
            case (
                None
                | nodes.BeginBlock()
                | nodes.EndBlock()
                | nodes.BlankCorner()
                | nodes.CylinderBlank()
                | nodes.HeadingLine()
            ):
                pass
            case _:
                yield from self._path.flush_blocks_before(1, state.text.split(" ")[0])
                yield from self._coordinates(node)

    def _coordinates(self, node: nodes.Node) -> Iterator[Block]:
        """Yield the blocks of tool calls, cycles and coordinate transformations.

        All buffered path elements must have been executed before.
        """
        state = self._state
        match node:
            case nodes.PlaneBlock():
                yield from plane(state, node)
            case nodes.ToolCall():
                yield from execute_tool_call(state, node, self._tools)
            case nodes.ToolDefinition():
                define_tool(state, node)
            case nodes.DatumShift():
                self._shift(node)
            case nodes.CoordinateTransform():
                execute_transformation(state, node)
            case nodes.TcpmSwitch():
                plane_functions.set_tcpm_active(state, is_active=node.is_on)
            case (
                nodes.CycleDefinition()
                | nodes.CycleLine()
                | nodes.PatternDefinition()
                | nodes.ContourDefinition()
            ):
                yield from self._cycles.execute_definition(node)
            case nodes.SelectionBlock():
                self._select(node)
            case nodes.ProgramCall():
                self._call_program(node.name or self._selected_program(node.column), node.column)

    def _shift(self, node: nodes.DatumShift) -> None:
        """Execute a datum shift, and select the datum table if the block names one.

        Raises ProgramError for a missing table or row, for an invalid value, and for a shift of a rotary
        axis.
        """
        if node.table_name:
            self._select(nodes.SelectionBlock("TABLE", node.table_name, node.column))
        execute_datum_shift(self._state, node)

    def _select(self, node: nodes.SelectionBlock) -> None:
        """Execute SEL TABLE, SEL PATTERN or SEL PGM. Raises ProgramError for a missing table."""
        if node.selected_kind == "PGM":
            self._state.selected_program = node.name
            return
        rows = self._table(node.name, node.column)
        if node.selected_kind == "TABLE":
            self._state.datum_table_rows = rows
        else:
            self._cycles.select_points(rows)

    def _missing_program(self, name: str, column: int) -> ProgramError:
        text = Message("Program {name} is not in the same folder as this program.", name=name)
        return self._state.make_error(
            column, FILE_MISSING, text, "Put the file in the same folder as this program."
        )

    def _table(self, name: str, column: int) -> dict[int, TableRow]:
        rows = self._flow.read_table(name)
        if rows is None:
            text = Message("Table {name} is not in the same folder as this program.", name=name)
            raise self._state.make_error(
                column, FILE_MISSING, text, "Put the file in the same folder as this program."
            )
        return rows

    def _selected_program(self, column: int) -> str:
        """Return the name of the program selected with SEL PGM.

        Raises ProgramError if no program is selected.
        """
        if not self._state.selected_program:
            text = "No program is selected."
            raise self._state.make_error(column, FILE_MISSING, text, "Write SEL PGM before this block.")
        return self._state.selected_program

    def _call_program(self, name: str, column: int) -> None:
        called = self._flow.call_program(name, self._state.line_number)
        if called is None:
            raise self._missing_program(name, column)

    # --- moves, M functions, cycles -----------------------------------------------------------------------

    def _move(self, node: nodes.PathFunction, comment: str) -> Iterator[Block]:
        """Yield the blocks of a path function with its M functions.

        If M99 or M89 calls a cycle, the blocks of the cycle follow.
        """
        state, path = self._state, self._path
        m_functions.check(state, node.m_functions)
        feed_rates.execute_feed_codes(state, node.m_functions)
        if any(code.number in m_functions.CODES_BEFORE_MOTION for code in node.m_functions):
            yield from path.execute_between_elements(
                lambda: m_functions.execute_before_motion(state, node.m_functions)
            )
        datum = m_functions.read_machine_datum(state, node.m_functions)
        yield from path.execute_move(node, machine_datum=datum, has_corner_after=self._corner_is_next())
        yield from self._behind(node.m_functions, comment)
        moved = any(word.axis in "XY" for word in node.axis_words) or bool(node.words)
        yield from self._with_cycle(node.m_functions, node.column, has_moved=moved)

    def _execute_codes_or_cycle(
        self, node: nodes.MFunctionBlock | nodes.StopBlock | nodes.CycleCall, comment: str
    ) -> Iterator[Block]:
        """Yield the blocks of STOP, CYCL CALL or a block with only M functions."""
        state, path = self._state, self._path
        m_functions.check(state, node.m_functions)
        feed_rates.execute_feed_codes(state, node.m_functions)
        yield from path.execute_between_elements(
            lambda: m_functions.execute_before_motion(state, node.m_functions)
        )
        if isinstance(node, nodes.CycleCall):
            yield from path.flush_blocks_before(node.column, "CYCL CALL")
            if node.is_pattern_call:
                yield from self._cycles.call_pattern(node)
            else:
                yield from (
                    self._cycles.call_at_position(node) if node.axis_words else self._run_cycle(node.column)
                )
        if isinstance(node, nodes.StopBlock):
            stop = ProgramStop(optional=False, message=comment)
            yield from path.execute_between_elements(lambda: iter((state.make_action_block(stop),)))
        yield from self._behind(node.m_functions, comment)
        if not isinstance(node, nodes.CycleCall):
            yield from self._with_cycle(node.m_functions, 1, has_moved=False)

    def _behind(self, codes: Sequence[klartext_words.MFunction], comment: str) -> Iterator[Block]:
        state = self._state
        if any(code.number in m_functions.PROGRAM_END_CODES for code in codes):
            yield from self._path.finish_program()
        elif not any(code.number not in m_functions.CODES_BEFORE_MOTION for code in codes):
            return
        for block in self._path.execute_between_elements(
            lambda: m_functions.execute_after_motion(state, codes, comment)
        ):
            yield block
            if isinstance(block.action, ProgramEnd):
                # the position is then after END PGM, so that the program does not end twice
                self._flow.end_program()

    def _with_cycle(
        self, codes: Sequence[klartext_words.MFunction], column: int, *, has_moved: bool
    ) -> Iterator[Block]:
        """Yield the blocks of the cycle that M99 or M89 calls.

        M89 calls the cycle after every move in the plane until M99.
        """
        numbers = {code.number for code in codes}
        wanted = self._cycles.is_modal and has_moved
        if m_functions.M89 in numbers:
            self._cycles.is_modal = wanted = True
        if m_functions.M99 in numbers:
            self._cycles.is_modal, wanted = False, True
        if not wanted:
            return
        yield from self._path.flush_blocks_before(column, "A cycle")
        yield from self._run_cycle(column)

    def _run_cycle(self, column: int) -> Iterator[Block]:
        """Yield the blocks of the machining cycle at the tool position, or call the program of cycle 12."""
        if self._cycles.called_program:
            self._call_program(self._cycles.called_program, column)
            return
        contours = [self._read_contour(part, column) for part in self._cycles.contours]
        yield from self._cycles.call_cycle(column, contours)

    def _read_contour(self, part: nodes.ContourPart, column: int) -> SlContour:
        """Return the contour of a subprogram, which is executed on a copy of the state."""
        state = copy_state(self._state)
        if part.file_name:
            flow, name = self._flow.make_program_flow(part.file_name), part.file_name
            if flow is None:
                raise self._missing_program(part.file_name, column)
        else:
            flow, name = (
                self._flow.make_subprogram_flow(part.label_name),
                Message("LBL {part}", part=format_name(part.label_name)),
            )
        if flow is None:
            text = Message("{name} of the contour is not in the program or has no LBL 0.", name=name)
            raise self._state.make_error(
                column, LABEL_NOT_FOUND, text, "Correct the label number, or add the label."
            )
        runner, lines = ContourCollector(state), MAX_LINE_COUNT_WITHOUT_BLOCK
        while (line := flow.read_next_line()) is not None:
            lines -= 1
            if line.error is not None:
                raise ProgramError(self._flow.relocate_finding(line.error))
            if lines < 0:
                raise self._state.make_error(
                    column,
                    LABEL_NOT_FOUND,
                    Message("{name} never reaches its end.", name=name),
                    "Correct the value.",
                )
            if not (line.is_skippable and state.setup.block_delete):
                state.line_number, state.text = (
                    self._flow.get_displayed_line(line.line_number),
                    flow.program.text(line),
                )
                _collect_contour_line(state, runner, flow, line)
        runner.finish_contour()
        return SlContour(name, runner.elements, runner.side, part.is_pocket)

    def _corner_is_next(self) -> bool:
        """Return whether RND or CHF follows, so that the current path element must be buffered."""
        return isinstance(self._flow.peek_next_node(), nodes.CornerBlock)


def _collect_contour_line(
    state: State, runner: ContourCollector, flow: Flow, line: nodes.KlartextLine
) -> None:
    """Execute one line of a contour subprogram, ignoring feeds, M functions and tools."""
    match line.node:
        case nodes.PathFunction():
            runner.add_path_function(line.node)
        case nodes.CornerBlock():
            runner.add_corner(line.node)
        case nodes.Pole():
            runner.set_pole(line.node)
        case nodes.Label() | nodes.LabelCall() | nodes.ConditionalJump():
            execute_flow_block(state, flow, line.line_number, line.node)
        case node if isinstance(node, CalculationNode):
            execute_calculation(state, node)
        case (
            nodes.DatumShift()
            | nodes.CoordinateTransform()
            | nodes.PlaneBlock()
            | nodes.CycleDefinition()
            | nodes.CycleLine()
        ):
            what = state.text.split("~")[0].strip()
            raise make_unsupported_error(
                state.line_number, 1, Message("{form} inside an SL cycle contour", form=what)
            )
