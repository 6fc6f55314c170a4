"""Interpreter of SINUMERIK turning programs.

The interpreter generates the elementary blocks of a program for a setup.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

from core.interpreter.shared.actions import Dwell, ProgramEnd, ProgramStop
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.control_flow import ENDLESS_LOOP_CODE
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import (
    MAX_BLOCK_COUNT,
    MAX_LINE_COUNT,
    LinePass,
    generate_lathe_approach,
)
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.modal_state import ModalState
from core.interpreter.sinumerik.consequent_faults import MissingAxes, depends_on_state
from core.interpreter.sinumerik.cycles.cycle_calls import generate_cycle_blocks, log_ineffective_cycle
from core.interpreter.sinumerik.cycles.drilling_cycles import (
    HOLE_PATTERNS,
    generate_pattern_moves,
    make_missing_cycle_error,
)
from core.interpreter.sinumerik.cycles.tapping_cycles import make_tapping_block
from core.interpreter.sinumerik.flow.block_search import (
    InterpreterComponents,
    check_single_block,
    make_checkpoint,
    restore_state,
)
from core.interpreter.sinumerik.flow.subprogram_flow import SinumerikProgramFlow, is_main_program_end
from core.interpreter.sinumerik.flow.variable_assignments import set_parameters
from core.interpreter.sinumerik.motion.chamfers_and_roundings import Corner, SinumerikCornerStage, make_corner
from core.interpreter.sinumerik.motion.fixed_points import make_fixed_point_move, make_home_move
from core.interpreter.sinumerik.motion.linear_moves import make_straight_block
from core.interpreter.sinumerik.motion.radius_compensation import CompensationStage
from core.interpreter.sinumerik.motion.sinumerik_arcs import make_arc_block
from core.interpreter.sinumerik.motion.sinumerik_feeds import execute_feed_words
from core.interpreter.sinumerik.motion.thread_moves import generate_thread_blocks
from core.interpreter.sinumerik.motion.transformations import switch_transformation
from core.interpreter.sinumerik.motion.transformed_plane import ActiveTransformation
from core.interpreter.sinumerik.setup.m_functions import (
    check_m_functions,
    turn_outputs_off,
    turn_outputs_on,
)
from core.interpreter.sinumerik.setup.modes_and_offsets import (
    check_y_word,
    execute_frame_words,
    execute_pole_and_limits,
    log_ineffective_words,
    reset_offsets,
    set_modal_functions,
)
from core.interpreter.sinumerik.setup.spindle_and_dwell import (
    execute_spindle_words,
    has_spindle_words,
    make_dwell_block,
    separate_live_tool_words,
    switch_live_tool,
)
from core.interpreter.sinumerik.setup.tools_and_edges import execute_tool_words
from core.interpreter.sinumerik.sinumerik_state import (
    ARC_MOTIONS,
    TAP_MOTIONS,
    THREAD_MOTIONS,
    SinumerikState,
)
from core.interpreter.sinumerik.sinumerik_statement import Statement, make_statement
from core.language.diagnostics import Diagnostic, ProgramError
from core.language.sinumerik.control_differences import find_missing_function
from core.language.sinumerik.cycle_names import CYCLE_PARAMETERS, IGNORED_CYCLES
from core.language.sinumerik.sinumerik_words import ARC_WORDS, LexedBlock, Word
from core.language.sinumerik.subprogram_files import HEADER_PATTERN
from core.language.sinumerik.word_table import (
    BLOCK_EXACT_STOP_GROUP,
    DWELL_GROUP,
    INEFFECTIVE_WORDS,
    NON_MODAL_GROUP,
    SUPPRESSION_GROUP,
    TRANSFORMATION_GROUP,
)
from core.language.source import ProgramSource
from core.message import Message

_PROGRAM_END_CODES = frozenset({2, 17, 30})
_LINES_AFTER_ERROR = 20_000
"""Number of lines that are checked after the first error, to find errors that it hides."""


class Interpreter(LinePass[LexedBlock]):
    """One pass through a SINUMERIK program and its subprograms."""

    def __init__(self, source: ProgramSource, setup: InterpreterSetup) -> None:
        super().__init__(DiagnosticLog())
        self._source = source
        self._state = SinumerikState(setup, self._log)
        self._corners = SinumerikCornerStage(self._state, self._log)
        self._compensation = CompensationStage(self._state, self._log)
        self._flow = SinumerikProgramFlow(source, self._state)
        self._setup = setup
        self._missing_axes = MissingAxes()
        if setup.begin is not None:
            self._restore_from(setup.begin)

    @cached_property
    def source_block_count(self) -> int:
        """Return the number of program lines that contain more than a comment."""
        return sum(
            bool(line.split(";", 1)[0].strip()) and HEADER_PATTERN.fullmatch(line) is None
            for line in self._source.lines
        )

    @property
    def modal_state(self) -> ModalState:
        """Return the modal state after the last generated block."""
        return self._state.modal

    def generate_blocks(self, *, stops_at_first_error: bool = False) -> Iterator[Block]:
        """Generate the elementary blocks of the program. Call this method only once."""
        yield from self._approach
        for block in self._pass():
            if not self._stopped:
                self._made += 1
                block.n = self._made
                yield block
            elif stops_at_first_error:
                return

    # --- start from a saved state: MDI and block search
    # ------------------------------------------------------

    @property
    def checkpoint(self) -> Checkpoint:
        """Return a checkpoint with the state at the start of the next block."""
        parts = InterpreterComponents(self._state, self._corners, self._flow, self._taken)
        return make_checkpoint(parts, (self._setup, self._log, *self._flow.known_routines), self._made)

    @property
    def _active_transformation(self) -> ActiveTransformation | None:
        """Return the active TRANSMIT or TRACYL transformation, or None if no transformation is active."""
        plane = self._state.transformation
        return plane if isinstance(plane, ActiveTransformation) else None

    @property
    def blocking_reason(self) -> str:
        """Return the reason why another pass cannot continue from the current block.

        The result is an empty string if another pass can continue.
        """
        if self._active_transformation is not None:
            where = Message(
                "the line is part of a corner or a contour in {transformed}; start before the approach",
                transformed=self._active_transformation.name,
            )
            return where if self._active_transformation.has_open_contour else ""
        if self._compensation.has_open_contour:
            return "the line is part of a G41 or G42 contour; start before the approach"
        return "the previous block is part of an unfinished corner" if self._corners.has_buffered_move else ""

    def _restore_from(self, pass_start: PassStart) -> None:
        """Restore the state that the first block of this pass inherits."""
        kept = pass_start.checkpoint.kept
        if kept is not None:
            parts: InterpreterComponents = kept.copy_parts(self._setup, self._log)
            self._state, self._corners = parts.state, parts.corner_stage
            self._compensation = CompensationStage(self._state, self._log)
            if not pass_start.is_mdi_line:
                self._flow, self._taken = parts.program_flow, parts.pending_line
        restore_state(self._state, pass_start)
        if self._active_transformation is not None:
            self._active_transformation.update_position()
        self._made = 0 if pass_start.is_mdi_line else pass_start.checkpoint.blocks
        if pass_start.is_mdi_line:
            problem = check_single_block(self._source, self._setup.limits.third_axis_name)
            if problem is not None:
                self._log.add_finding(problem)
                self._flow.end_program()
        state = self._state
        self._approach = generate_lathe_approach(
            pass_start, state.modal, state.setup.start, state.compute_rpm_at_radius
        )

    def _can_stop(self, line: LexedBlock) -> bool:
        return line.is_executable and not self._flow.is_in_other_file and not self._deleted(line)

    def _deleted(self, line: LexedBlock) -> bool:
        return line.skip_level is not None and self._state.setup.block_delete

    def _pass(self) -> Iterator[Block]:
        for line in self._lines(self._flow.read_next_line):
            if line.is_executable and not self._deleted(line):
                yield from self._line(line)
            if self._log.is_full:
                break
        if not self.has_stopped_before_line and self._left >= 0:
            yield from self._last_blocks()

    def _line(self, line: LexedBlock) -> Iterator[Block]:
        """Yield the blocks of a line, up to the first error."""
        self._state.call_site = self._flow.call_site
        for found in line.errors:
            self._log_error(found)
        if line.errors:
            return
        try:
            self._check_control(line)
            if line.called_name or line.is_modal_call:
                yield from self._call(line)
                return
            if line.control_statement is not None:
                self._flow.execute_control_line(line, line.control_statement, self._state)
                return
            statement = make_statement(line)
            ends = is_main_program_end(statement, is_in_subprogram=self._flow.is_in_subprogram)
            yield from self._blocks_with_corners(statement)
            if state_call := self._modal_call(statement):
                yield from self._call(state_call, modal=True)
        except ProgramError as problem:
            if (
                problem.diagnostic.code != ENDLESS_LOOP_CODE or not self._stopped
            ):  # otherwise, it may be a consequence of an earlier error
                self._log_error(problem.diagnostic)
            ends = False
            if problem.diagnostic.code in {"recursion", ENDLESS_LOOP_CODE}:
                self._flow.end_program()
        self._execute_program_end(line, is_program_end=ends)

    def _check_control(self, line: LexedBlock) -> None:
        """Raise ProgramError for a function that the control model in the machine file does not have."""
        control = self._setup.limits.control_model
        if found := find_missing_function(control, line):
            name, column = found
            text = Message(
                "{name} is not a function of the SINUMERIK {control} on this machine.",
                name=name,
                control=control.upper(),
            )
            hint = 'Use a different function, or correct "control" under [machine] in the machine file.'
            raise line.make_error(column, "not-in-control", text, hint)

    def _call(self, line: LexedBlock, *, modal: bool = False) -> Iterator[Block]:
        """Yield the blocks of a called cycle, or enter the called subprogram.

        With MCALL, the call is only stored. Raises ProgramError for an invalid call.
        """
        if line.is_modal_call and not modal:
            self._state.modal_call_line = line if line.called_name else None
            return
        if line.called_name in IGNORED_CYCLES and not self._flow.has_routine(line.called_name):
            log_ineffective_cycle(self._state, line)
            return
        if line.called_name not in CYCLE_PARAMETERS or self._flow.has_routine(line.called_name):
            self._flow.call_subprogram(line, is_modal=modal)
            return
        if line.called_name in HOLE_PATTERNS:
            yield from self._pattern(line)
            return
        place = self._flow.get_displayed_line(line.line_number)
        for block in generate_cycle_blocks(self._state, line, self._flow):
            yield from self._apply_stages(
                block if place == line.line_number else replace(block, line=place), None
            )

    def _pattern(self, line: LexedBlock) -> Iterator[Block]:
        """Yield the blocks of HOLES1 or HOLES2, which execute the MCALL cycle at each position.

        Raises ProgramError for invalid parameters, and if no MCALL of a cycle is active.
        """
        state, called = self._state, self._state.modal_call_line
        if (
            called is None
            or called.called_name not in CYCLE_PARAMETERS
            or self._flow.has_routine(called.called_name)
        ):
            raise make_missing_cycle_error(line)
        place = self._flow.get_displayed_line(line.line_number)
        for over in generate_pattern_moves(state, line):
            yield from self._apply_stages(replace(over, line=place), None)
            yield from self._call(called, modal=True)

    def _modal_call(self, statement: Statement) -> LexedBlock | None:
        """Return the line of the active modal call (MCALL) to execute after this block, or None.

        The result is None if no MCALL is active or the block has no motion.
        """
        return (
            None if self._flow.is_in_modal_call or not statement.axis_names else self._state.modal_call_line
        )

    def _execute_program_end(self, line: LexedBlock, *, is_program_end: bool) -> None:
        """Execute M2, M17 and M30 after all other words of their block."""
        if is_program_end:
            self._flow.end_program()
        elif self._flow.is_in_subprogram and any(
            word.name == "M" and word.value in _PROGRAM_END_CODES for word in line.words
        ):
            self._flow.end_subprogram()

    def _blocks_with_corners(self, statement: Statement) -> Iterator[Block]:
        """Yield the final blocks of a statement, after corners and compensation were applied."""
        number = statement.lexed_block.line_number
        place = self._flow.get_displayed_line(number)
        if TRANSFORMATION_GROUP in statement.g_words:
            yield from self._flush()
        for block in self._blocks(statement):
            corner, plane = None, self._active_transformation
            if block.moves:
                corner = (
                    make_corner(self._state, statement, block) if plane is None else plane.make_corner(block)
                )
            yield from self._apply_stages(block if place == number else replace(block, line=place), corner)

    def _apply_stages(self, block: Block, corner: Corner | None) -> Iterator[Block]:
        """Yield the blocks that result from the corner and compensation stages of the active plane."""
        if self._active_transformation is not None:
            yield from self._active_transformation.accept_block(block, corner)
            return
        for cut in self._corners.accept_item(block, corner):
            yield from self._compensation.accept_block(cut)

    def _flush(self) -> Iterator[Block]:
        """Yield the buffered blocks, because no following move can form a corner with them."""
        if self._active_transformation is not None:
            yield from self._active_transformation.flush_corner()
            return
        for cut in self._corners.flush_at_program_end():
            yield from self._compensation.accept_block(cut)

    def _blocks(self, statement: Statement) -> Iterator[Block]:
        """Yield the blocks of a statement in the order modes, tool, spindle, motion and stops."""
        state = self._state
        set_parameters(state, statement)
        check_y_word(state, statement)
        if statement.frame_word is not None:
            if self._active_transformation is not None:
                self._active_transformation.execute_frame_words(statement)
            else:
                execute_frame_words(state, statement)
            return
        separate_live_tool_words(state, statement)
        check_m_functions(state, statement, self._lacking)
        if statement.g_words:
            set_modal_functions(state, statement)
        if statement.g_words or not INEFFECTIVE_WORDS.keys().isdisjoint(statement.words):
            log_ineffective_words(state, statement)
        execute_feed_words(state, statement)
        if DWELL_GROUP in statement.g_words:
            yield make_dwell_block(state, statement)
            return
        if statement.words:
            yield from execute_tool_words(state, statement, self._tools)
        yield from switch_live_tool(state, statement)
        if has_spindle_words(statement):
            yield from execute_spindle_words(state, statement)
        if statement.m_words:
            yield from turn_outputs_on(state, statement)
        yield from self._motion(statement)
        if statement.m_words:
            yield from turn_outputs_off(state, statement)
            yield from self._stops(statement)

    def _motion(self, statement: Statement) -> Iterator[Block]:
        """Yield the move of a statement."""
        state = self._state
        if TRANSFORMATION_GROUP in statement.g_words:
            yield from switch_transformation(state, self._log, statement)
        elif self._active_transformation is not None:
            yield from self._active_transformation.make_moves(statement)
        else:
            yield from self._lathe_motion(statement)

    def _find_unused_word(self, statement: Statement) -> Word | None:
        """Return the first word that needs another function in its block, or None.

        SINUMERIK stores SF for the next thread, but TurnDesk does not. An SF without a thread in its block
        is therefore rejected. Otherwise, the next thread would start at a wrong angle.
        """
        is_thread = self._state.motion in THREAD_MOTIONS and statement.has_position_word
        names = ("FP", "OFFN") if is_thread else ("FP", "OFFN", "SF")
        return next((statement.words[name] for name in names if name in statement.words), None)

    def _lathe_motion(self, statement: Statement) -> Iterator[Block]:
        """Yield the move of a statement with the axes of the lathe, without a transformation."""
        state = self._state
        if execute_pole_and_limits(state, statement):
            return
        if statement.get_g_code(NON_MODAL_GROUP) == 74:
            yield make_home_move(state, statement)
        elif statement.get_g_code(NON_MODAL_GROUP) == 75:
            yield make_fixed_point_move(state, statement)
        elif word := self._find_unused_word(statement):
            code = {"FP": "G75", "OFFN": "TRANSMIT", "SF": "G33"}[word.name]
            raise statement.make_error(
                word,
                "word-unused",
                Message("{word} can be used only with {total}.", word=word.text, total=code),
                "Remove this text from the program.",
            )
        elif statement.has_position_word or (ARC_WORDS & statement.words.keys()):
            yield from self._move(statement)
        elif word := statement.g_words.get(SUPPRESSION_GROUP):
            text = Message("{word} is effective only in a block that moves an axis.", word=word.text)
            raise statement.make_error(word, "word-unused", text, "Add the axes to the block.")
        else:
            return
        if state.exact or BLOCK_EXACT_STOP_GROUP in statement.g_words:
            yield state.action(statement.lexed_block.line_number, "G60" if state.exact else "G9", Dwell(0.0))

    def _move(self, statement: Statement) -> Iterator[Block]:
        state = self._state
        if state.motion in THREAD_MOTIONS:
            yield from generate_thread_blocks(state, statement)
            return
        state.threads = ()
        if state.motion in TAP_MOTIONS:
            yield make_tapping_block(state, statement)
        else:
            yield (
                make_arc_block(state, statement)
                if state.motion in ARC_MOTIONS
                else make_straight_block(state, statement)
            )

    def _stops(self, statement: Statement) -> Iterator[Block]:
        """Yield the blocks of M0, M1 and the program end."""
        state, line = self._state, statement.lexed_block
        for code in (0, 1):
            if code in statement.m_words:
                yield state.action(line.line_number, f"M{code}", ProgramStop(optional=code == 1))
        if statement.ends_program and not self._flow.is_in_subprogram:
            reset_offsets(state)
            state.set_modal_state(state.modal._replace(spindle=0, oriented=None))
            code = next(code for code in (2, 17, 30) if code in statement.m_words)
            yield state.action(line.line_number, f"M{code}", ProgramEnd(reset=True))

    def _last_blocks(self) -> Iterator[Block]:
        """Yield the buffered blocks after the last line."""
        try:
            yield from self._flush()
            if self._active_transformation is not None:
                yield from self._active_transformation.flush_at_program_end()
            yield from self._compensation.check_program_end()
        except ProgramError as problem:
            self._log_error(problem.diagnostic)

    def _log_error(self, finding: Diagnostic) -> None:
        """Log the error, unless it is only a consequence of an earlier error."""
        follows = self._stopped and depends_on_state(finding)
        if not follows and not self._missing_axes.is_axis_reported(finding):
            self._log.add_finding(self._flow.relocate_finding(finding), finding)
        self._stopped = True
        self._left = min(self._left, _LINES_AFTER_ERROR + 1)
        self._corners.discard_move()
        self._compensation.discard_contour()
        if self._active_transformation is not None:
            self._active_transformation.discard_blocks()

    def _report_limit(self, line: LexedBlock) -> None:
        if self._stopped and self._left < 0:
            return  # A loop with an invalid condition does not end, and its error is already reported.
        text = Message(
            "the program exceeds the limit of {most_blocks} blocks or {most_lines} executed lines.",
            most_blocks=f"{MAX_BLOCK_COUNT:,}",
            most_lines=f"{MAX_LINE_COUNT:,}",
        )
        hint = "Check the loops, and reduce the repeat counts of the calls."
        self._log_error(line.make_error(0, "too-many-blocks", text, hint).diagnostic)
