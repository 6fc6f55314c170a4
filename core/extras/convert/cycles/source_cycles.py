"""Cycles of the source program, selected according to the G code and the source control."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.cycles.contour_cycles import (
    RoughingValues,
    append_contour_repetitions,
    append_roughing_passes,
    read_allowances,
    read_pass_depth,
    store_roughing_words,
)
from core.extras.convert.cycles.cycle_limits import allow_letters, require_words
from core.extras.convert.cycles.hole_cycles import HOLE_CYCLE_CODES, append_hole_cycle, get_hole_letters
from core.extras.convert.cycles.linuxcnc_contours import LINUXCNC_CONTOUR_CODES, LinuxcncContourCycle
from core.extras.convert.cycles.single_cycles import (
    PeckValues,
    append_facing_cycle,
    append_peck_cycle,
    append_turning_cycle,
)
from core.extras.convert.cycles.thread_cycles import (
    FanucThreadValues,
    append_linuxcnc_thread_cycle,
    append_single_thread_cycle,
    append_thread_cycle,
    is_first_of_two_lines,
)
from core.extras.convert.path_steps import MOVE_KINDS, PathStep, StepKind
from core.extras.convert.source_flow import ProgramFlow
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import SourceControl
from core.extras.convert.source_state import SourceState

ExecuteFunction = Callable[[SourceStatement], None]
_BOXES: Mapping[int, Callable[[SourceState, SourceStatement, SourceWord], None]] = {
    90: append_turning_cycle,
    92: append_single_thread_cycle,
    94: append_facing_cycle,
}
_BOXES_OF_B: Mapping[int, Callable[[SourceState, SourceStatement, SourceWord], None]] = {
    77: append_turning_cycle,
    78: append_single_thread_cycle,
    79: append_facing_cycle,
}
_WORDS = {
    70: "PQFUWD", 71: "PQUWDF", 72: "PQUWDF", 73: "PQUWFDIK", 74: "RXZUWPQF", 75: "RXZUWPQF", 76: "PQRF",
}  # fmt: skip
_BOX_LETTERS = {90: "RI", 92: "RIE", 94: "RK", 77: "RI", 78: "RIE", 79: "RK"}
_FIRST_LINE = {71: "URF", 72: "WRF", 73: "UWRF"}


class SourceCycles:
    """Cycles of a source program, with the values that the first lines of two-line cycles store."""

    def __init__(self, state: SourceState, flow: ProgramFlow, execute: ExecuteFunction) -> None:
        self._state, self._flow, self._execute = state, flow, execute
        self._rough = RoughingValues()
        self._thread = FanucThreadValues()
        self._peck = PeckValues()
        self._is_in_contour = False

    def is_modal(self, code: float) -> bool:
        """Return whether this G code remains active on further lines with axis words."""
        return code in self._boxes() or code in self._holes()

    def is_hole_cycle(self, code: float) -> bool:
        """Return whether this G code is a hole cycle."""
        return code in self._holes()

    def _boxes(self) -> Mapping[int, Callable[[SourceState, SourceStatement, SourceWord], None]]:
        if not self._state.source_control.is_fanuc:
            return {}
        return _BOXES if self._state.source_control.uses_code_system_a else _BOXES_OF_B

    def _holes(self) -> frozenset[int]:
        return HOLE_CYCLE_CODES - {73} if self._state.source_control.is_fanuc else HOLE_CYCLE_CODES

    def execute_modal_cycle(self, statement: SourceStatement, code: SourceWord) -> None:
        """Execute a line of the active modal cycle. Raises ProgramError if it cannot be converted."""
        number = round(self._state.motion_code)
        code = code._replace(value=number)
        letters = _BOX_LETTERS[number] if number in self._boxes() else get_hole_letters(number)
        allow_letters(statement, f"GMSTNF{self._state.source_control.axis_letters}{letters}")
        if number in self._boxes():
            self._boxes()[number](self._state, statement, code)
        else:
            if self._state.plane_code == 18 and not self._state.source_control.is_fanuc:
                raise make_error(code.line_number, code.column, "hole-plane", word=f"G{number}")
            append_hole_cycle(self._state, statement, code)

    def is_one_shot(self, code: float) -> bool:
        """Return whether this G code is a cycle that is active only on its own line."""
        control = self._state.source_control
        if control.is_fanuc:
            return code in _WORDS
        return code == 76 or (control is SourceControl.LINUXCNC and code in LINUXCNC_CONTOUR_CODES)

    def execute_one_shot_cycle(self, statement: SourceStatement, code: SourceWord) -> None:
        """Execute a cycle that is active only on its own line. Raises ProgramError for an invalid word."""
        state, number = self._state, code.value
        if not state.source_control.is_fanuc and number != 76:
            q = statement.find_word("Q")
            if q is None:
                raise make_error(code.line_number, code.column, "cycle-word", word="Q")
            cycle = LinuxcncContourCycle(state, statement, code)
            cycle.append_moves(self._flow.read_subprogram(q))
            return
        if not state.source_control.is_fanuc:
            allow_letters(statement, "GMNSTFPZIJKRQHEL")
            append_linuxcnc_thread_cycle(state, statement, code)
            return
        if number == 70:
            for word in statement.words:
                if word.letter in "UWD":  # Some CAM systems repeat the words of G71 here.
                    state.add_warning(word, "left-out", word=word.text)
        allow_letters(statement, "GMNST" + self._get_letters(statement, round(number)))
        if number in {70, 71, 72, 73}:
            self._contour(statement, code)
        elif number in {74, 75}:
            append_peck_cycle(state, statement, code, self._peck)
        elif is_first_of_two_lines(statement):
            require_words(statement, code, "PQR")
            self._thread.store_words(state, statement)
        else:
            append_thread_cycle(state, statement, code, self._thread)

    def _get_letters(self, statement: SourceStatement, number: int) -> str:
        """Return the letters that have an effect in a line of a cycle."""
        is_haas = self._state.source_control is SourceControl.HAAS
        if number in {71, 72, 73} and statement.find_word("P") is None:
            return _FIRST_LINE[number]
        if number in {74, 75} and is_first_of_two_lines(statement):
            return "R"
        if number in {74, 75} and (is_haas or any(statement.find_word(each) for each in "IKD")):
            return "XZUWFIKD"
        if number == 76 and not is_first_of_two_lines(statement):
            return "XZUWRIFEKDAP" if statement.find_word("K") else "XZUWRIFEPQ"
        return _WORDS[number]

    def _contour(self, statement: SourceStatement, code: SourceWord) -> None:
        state = self._state
        if not any(statement.find_word(each) for each in "PQUWR"):
            raise make_error(code.line_number, code.column, "cycle-word", word="P")
        if code.value != 70 and store_roughing_words(state, statement, code, self._rough):
            return
        p, q = statement.find_word("P"), statement.find_word("Q")
        if p is None or q is None:
            raise make_error(code.line_number, code.column, "cycle-word", word="P" if p is None else "Q")
        if self._is_in_contour:
            raise make_error(code.line_number, code.column, "cycle-nested", word=code.text)
        lines, after = self._flow.contour(p.value, q.value, self._flow.at)
        start = state.get_position(code)
        if code.value == 70:
            self._execute_contour(lines)
            state.append_rapid(code.line_number, *start)
            return
        contour = self._trace(lines)
        allowance = read_allowances(state, statement)
        if code.value == 73:
            append_contour_repetitions(state, code, contour, self._rough, allowance)
        else:
            depth = read_pass_depth(state, statement, code, self._rough)
            append_roughing_passes(state, code, contour, depth, self._rough.retract_mm, allowance)
        # A contour in front of the cycle has been executed already and is not skipped.
        self._flow.at = max(self._flow.at, after)

    def _execute_contour(self, lines: Sequence[SourceStatement]) -> None:
        self._is_in_contour = True
        for each in lines:
            self._execute(each)
        self._is_in_contour = False

    def _trace(self, lines: Sequence[SourceStatement]) -> list[PathStep]:
        """Return the moves of a contour without the rapids at its end.

        The modal state is restored afterwards.
        """
        state = self._state
        saved = (
            state.steps,
            state.x,
            state.z,
            state.feed,
            state.motion_code,
            state.nose_code,
            state.pending_comment,
        )
        spindle, request = state.spindle, state.speed_request
        state.steps, state.feed = [], state.feed or 1.0
        self._execute_contour(lines)
        found = [each for each in state.steps if each.kind in MOVE_KINDS]
        for step in state.steps:
            if step.kind not in MOVE_KINDS and step.kind is not StepKind.NOSE:
                word = SourceWord("", 0, False, step.line, 1, "")
                state.add_warning(word, "contour-action", line=step.line)
        (
            state.steps,
            state.x,
            state.z,
            state.feed,
            state.motion_code,
            state.nose_code,
            state.pending_comment,
        ) = saved
        state.spindle, state.speed_request = spindle, request
        while len(found) > 1 and found[-1].kind is StepKind.RAPID:
            found.pop()
        return found
