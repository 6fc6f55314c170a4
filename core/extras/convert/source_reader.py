"""Reader of a source program, which executes its words on a modal state and produces path steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.cycles.source_cycles import SourceCycles
from core.extras.convert.cycles.thread_cycles import append_thread_pass
from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.source_angles import find_angle_target, is_angle_word
from core.extras.convert.source_arcs import append_arc
from core.extras.convert.source_codes import (
    LEFT_OUT_WITH_AXES,
    ROTARY_LETTERS,
    check_repeated_words,
    execute_mode,
    execute_start_codes,
    execute_stop_codes,
    get_left_out_letters,
    is_mode,
)
from core.extras.convert.source_corners import Corner, add_corner
from core.extras.convert.source_dwell import append_dwell, read_seconds
from core.extras.convert.source_flow import ProgramFlow
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import ConversionOptions, SourceControl
from core.extras.convert.source_preset import add_preset_shift
from core.extras.convert.source_spindle import execute_spindle_words
from core.extras.convert.source_state import MM_PER_INCH, SourceState
from core.extras.convert.source_tools import execute_tool_words, report_unused_tool
from core.language.diagnostics import Diagnostic, ProgramError

_NO_MOTION = -1  # after G80 of LinuxCNC


class SourceReader:
    """One pass through a source program. ``state.steps`` and ``state.warnings`` are the results."""

    def __init__(self, texts: Sequence[str], options: ConversionOptions) -> None:
        self.flow = ProgramFlow(texts, options.control)
        self.state = SourceState(options, is_metric=options.metric)
        self._cycles = SourceCycles(self.state, self.flow, self.execute_statement)
        self._corner: Corner | None = None
        self._nose_ends = False
        self._motion_before_cycle = 0.0
        control = options.control
        self.state.uses_tool_change = not control.is_fanuc and self.flow.uses_tool_change
        self.state.is_feed_per_rev = control.is_fanuc
        self.state.is_x_diameter = (
            options.diameter if options.diameter is not None else control is not SourceControl.LINUXCNC
        )

    def read_program(self) -> None:
        """Read the whole program. Raises ProgramError at the first line that cannot be converted."""
        for each in self.flow.lines:
            if each.has_block_delete:
                word = SourceWord("/", 0, False, each.line_number, each.code.index("/") + 1, "/")
                self.state.add_warning(word, "block-delete", word=each.code.strip())
        for statement in self.flow.iter_statements():
            self.execute_statement(statement)
            if not self.state.source_control.is_fanuc:
                self._store_position()
        self._require_no_corner()
        report_unused_tool(self.state)
        for first, last in self.flow.find_unexecuted_lines():
            word = SourceWord("", 0, False, first, 1, "")
            self.state.add_warning(word, "not-executed", first=first, last=last)
        if self.flow.repeats:
            word = SourceWord("M", 99, False, self.flow.repeats, 1, "M99")
            self.state.add_warning(word, "repeat")
        if not any(each.kind is StepKind.END for each in self.state.steps):
            line = self.state.steps[-1].line if self.state.steps else 1
            self.state.append_step(PathStep(StepKind.END, line, number=30))

    def _store_position(self) -> None:
        """Store the position in the predefined variables of LinuxCNC, or remove these if it is unknown."""
        state, variables = self.state, self.flow.variables
        factor = 2.0 if state.is_x_diameter else 1.0
        unit = 1.0 if state.is_metric else MM_PER_INCH
        for value, keys in ((state.x, ("<_x", "5420")), (state.z, ("<_z", "5422"))):
            for key in keys:
                variables.pop(key, None)
                if value is not None and state.is_metric is not None:
                    variables[key] = value / unit * (factor if keys[0] == "<_x" else 1.0)

    # --- one statement

    def execute_statement(self, statement: SourceStatement) -> None:
        """Execute the words of one line. Raises ProgramError if the line cannot be converted."""
        state = self.state
        if statement.comment:
            state.pending_comment = f"{state.pending_comment}\n{statement.comment}".strip()
        statement = self._without_y(statement)
        if not statement.words:
            return
        check_repeated_words(statement)
        for word in statement.find_words("G"):
            execute_mode(state, statement, word)
        self._feed(statement)
        execute_tool_words(state, statement)
        execute_spindle_words(state, statement)
        execute_start_codes(state, statement)
        self._motion(statement)
        if execute_stop_codes(state, statement):
            self._require_no_corner()
            self.flow.ended = True

    def _without_y(self, statement: SourceStatement) -> SourceStatement:
        """Return the statement without Y0 and V0, which have no effect on a lathe without a Y axis."""
        idle = [each for each in statement.words if each.letter in "YV" and not each.value]
        for each in idle:
            self.state.add_warning(each, "left-out", word=each.text)
        return replace(statement, words=tuple(each for each in statement.words if each not in idle))

    def _feed(self, statement: SourceStatement) -> None:
        state = self.state
        word = statement.find_word("F")
        if word is None or self._is_lead(statement):
            return
        if (
            state.is_feed_per_rev
            and not word.has_decimal_point
            and state.source_control.is_fanuc
            and state.options.no_point != 1
        ):
            raise make_error(word.line_number, word.column, "feed-no-point", word=word.text)
        state.feed = word.value * state.get_unit_mm(word)
        if state.source_control.is_fanuc:
            state.last_lead_mm = 0.0  # F is one value on Fanuc controls, so that the next thread needs F.
        most = state.options.max_feed_mm_min
        if not state.is_feed_per_rev and state.feed > most:
            state.add_warning(word, "feed-limited", word=word.text)
            state.feed = most

    def _is_lead(self, statement: SourceStatement) -> bool:
        """Return whether F of this line is a thread lead, which Fanuc controls program with F.

        F is the lead on a line with a thread code, and on a line that continues an active thread code.
        """
        if not self.state.source_control.is_fanuc:
            return False
        code = 92 if self.state.source_control.uses_code_system_a else 78
        if statement.has_g_code(32, 33, 76, code):
            return True
        has_axes = any(each.letter in "XZUW" for each in statement.words)
        others = [each for each in statement.find_words("G") if self._uses_axes(each)]
        return self.state.motion_code in {32, 33, code} and has_axes and not others

    def _uses_axes(self, word: SourceWord) -> bool:
        """Return whether a G code is a move, a cycle or another code with axis words."""
        return word.value in {0, 1, 2, 3} or self._cycles.is_modal(word.value) or self._is_one_shot(word)

    # --- moves

    def _motion(self, statement: SourceStatement) -> None:
        state = self.state
        one_shot = [each for each in statement.find_words("G") if self._is_one_shot(each)]
        if len(one_shot) > 1:
            first, second = one_shot[:2]
            raise make_error(
                second.line_number, second.column, "word-twice", word=first.text, other=second.text
            )
        motion = [
            each for each in statement.find_words("G") if each not in one_shot and self._is_motion(each)
        ]
        self._select_motion(statement, motion)
        self._nose_codes(statement)
        if one_shot:
            self._require_no_corner()
            self._execute_one_shot(statement, one_shot[0], motion)
            return
        axes = [each for each in statement.words if each.letter in state.source_control.axis_letters]
        if self._cycles.is_modal(state.motion_code):
            if axes or (motion and self._cycles.is_hole_cycle(state.motion_code)):
                self._require_no_corner()
                self._cycles.execute_modal_cycle(statement, motion[-1] if motion else axes[0])
            return
        self._check_letters(statement)
        if not axes:
            find_angle_target(state, statement)  # An angle without an end point is an error.
            return
        self._move(statement, motion[-1] if motion else axes[0])
        if self._nose_ends:
            self._nose_ends = False
            state.append_step(PathStep(StepKind.NOSE, statement.line_number, number=40))

    def _select_motion(self, statement: SourceStatement, motion: Sequence[SourceWord]) -> None:
        """Select the move or the cycle that is active from this line on."""
        state = self.state
        if motion:
            if not self._cycles.is_modal(state.motion_code):
                self._motion_before_cycle = state.motion_code
            state.motion_code = motion[-1].value
            if motion[-1].value != state.cycle_code:
                state.cycle_code, state.hole_cycle_words = -1, {}
            return
        cancel = next((each for each in statement.find_words("G") if each.value == 80), None)
        if cancel is None:
            return
        if not self._cycles.is_hole_cycle(state.motion_code):
            state.add_note(cancel, "no-change", word=cancel.text)
        else:
            fanuc = state.source_control.is_fanuc
            state.motion_code = self._motion_before_cycle if fanuc else _NO_MOTION

    def _require_no_corner(self) -> None:
        """Raise ProgramError if the last move has a chamfer or a corner radius that was not added."""
        if self._corner is not None:
            word = self._corner.word
            raise make_error(word.line_number, word.column, "corner", word=word.text)

    def _is_one_shot(self, word: SourceWord) -> bool:
        """Return whether a code acts only on its line and uses the axis words of this line."""
        code, control = word.value, self.state.source_control
        return (
            code in {4, 28, 30, 53}
            or code in LEFT_OUT_WITH_AXES
            or (code == 50 and control.is_fanuc)
            or (code == 92 and not control.uses_code_system_a)
            or self._cycles.is_one_shot(code)
        )

    def _is_motion(self, word: SourceWord) -> bool:
        if self._cycles.is_modal(word.value):
            return True
        if word.value in {0, 1, 2, 3, 33} or (word.value == 32 and self.state.source_control.is_fanuc):
            return True
        if not is_mode(self.state, word.value):
            raise make_error(word.line_number, word.column, "code-unknown", word=word.text)
        return False

    def _move(self, statement: SourceStatement, code: SourceWord) -> None:
        state = self.state
        if state.motion_code == _NO_MOTION:
            raise make_error(code.line_number, code.column, "motion-missing")
        if state.motion_code in {2, 3}:
            self._require_no_corner()
            append_arc(state, statement, code)
            return
        x, z = find_angle_target(state, statement) or state.find_target(statement)
        corner, self._corner = self._corner, None
        if corner is not None:
            if x is None or z is None or state.motion_code != 1:
                raise make_error(corner.word.line_number, corner.word.column, "corner", word=corner.word.text)
            add_corner(state, corner, x, z)
        if state.motion_code in {32, 33}:
            append_thread_pass(state, statement, code)
            return
        if state.motion_code == 0:
            state.append_rapid(statement.line_number, x, z)
            return
        word = self._corner_word(statement)
        start = state.get_position(code) if x is None or z is None or word is not None else None
        state.append_cut(code, x, z)
        if word is not None and start is not None:
            self._corner = Corner(word, abs(state.convert_length(word)), start)

    def _corner_word(self, statement: SourceStatement) -> SourceWord | None:
        if not self.state.source_control.is_fanuc:
            return None
        if not any(each.letter in "XZUW" for each in statement.words):
            return None
        return next(
            (each for each in statement.words if each.letter in {",C", ",R", "C", "R", "I", "K"}), None
        )

    def _check_letters(self, statement: SourceStatement) -> None:
        """Raise ProgramError if the statement contains a word that this reader does not use."""
        allowed = "GMXZFSTNUW" if self.state.source_control.is_fanuc else "GMXZFSTN"
        if self.state.motion_code in {2, 3}:
            allowed += "RIK"
        elif self.state.motion_code in {32, 33}:
            allowed += "E" if self.state.source_control.is_fanuc else "K"
        for word in statement.words:
            if word.letter in allowed or self._belongs_to_code(statement, word):
                continue
            if self.state.motion_code == 1 and self._corner_word(statement) is word:
                continue
            code = "c-axis" if word.letter in ROTARY_LETTERS else "code-unknown"
            raise make_error(word.line_number, word.column, code, word=word.text)

    def _belongs_to_code(self, statement: SourceStatement, word: SourceWord) -> bool:
        """Return whether a word belongs to a code of the same line that other functions handle."""
        letter = word.letter
        if letter == "D" and statement.has_g_code(41, 42):
            if word.value != self.state.tool_number:
                self.state.add_warning(word, "left-out", word=word.text)
            return True
        return (
            is_angle_word(self.state, word)
            or (letter == "D" and statement.has_g_code(96) and not self.state.source_control.is_fanuc)
            or (letter == "H" and statement.has_g_code(43))
            or letter in get_left_out_letters(statement)
        )

    def _nose_codes(self, statement: SourceStatement) -> None:
        state = self.state
        for word in statement.find_words("G"):
            if word.value in {41, 42} and state.nose_code != word.value:
                # OmniTurn sees X+ downward, so that left and right are exchanged.
                code = 83 - word.value if not state.options.front else word.value
                state.nose_code = round(word.value)
                state.append_step(PathStep(StepKind.NOSE, statement.line_number, number=code))
                state.add_warning(word, "nose-offset", number=state.tool_number or 1)
            elif word.value == 40 and state.nose_code != 40:
                state.nose_code = 40
                self._nose_ends = True
            elif word.value in {40, 41, 42}:
                state.add_note(word, "no-change", word=word.text)

    # --- codes that act only on their line

    def _execute_one_shot(
        self, statement: SourceStatement, word: SourceWord, motion: Sequence[SourceWord]
    ) -> None:
        code = word.value
        if code in LEFT_OUT_WITH_AXES:
            self._leave_out_axes(statement, word, motion)
        elif code == 4:
            self._dwell(statement, word)
        elif code in {28, 30}:
            self._home(statement, word)
        elif code == 53:
            self._machine_position(statement, word)
        elif self._cycles.is_one_shot(code):
            self._cycles.execute_one_shot_cycle(statement, word)
        else:
            self._preset(statement, word)

    def _leave_out_axes(
        self, statement: SourceStatement, word: SourceWord, motion: Sequence[SourceWord]
    ) -> None:
        """Check the axis words of a code that is not converted.

        Raises ProgramError if these words may be a move.
        """
        self._only(statement, f"GMSTFN{get_left_out_letters(statement)}")
        if motion and any(each.letter in "XZ" for each in statement.words):
            raise make_error(
                word.line_number, word.column, "word-twice", word=motion[-1].text, other=word.text
            )

    def _dwell(self, statement: SourceStatement, word: SourceWord) -> None:
        state = self.state
        letters = "PXU" if state.source_control.is_fanuc else "P"
        self._only(statement, "GMSTF" + letters)
        times = [each for each in statement.words if each.letter in letters]
        if not times:
            raise make_error(word.line_number, word.column, "cycle-word", word="P")
        if len(times) > 1:
            raise make_error(
                times[1].line_number, times[1].column, "word-twice", word=times[0].text, other=times[1].text
            )
        append_dwell(state, times[0], read_seconds(state, times[0]))

    def _home(self, statement: SourceStatement, word: SourceWord) -> None:
        state = self.state
        letters = "XZUW" if state.source_control.is_fanuc else "XZ"
        self._only(statement, "GMST" + letters)
        if word.value == 30:
            state.add_warning(word, "home-position", word=word.text)
        x_word, z_word = (
            next((each for each in statement.words if each.letter in pair), None) for pair in ("XU", "ZW")
        )
        through = state.find_target(statement)
        if through != (state.x, state.z):
            state.append_rapid(statement.line_number, *through)
        both = x_word is None and z_word is None
        self._go_home(statement, x=both or x_word is not None, z=both or z_word is not None)

    def _machine_position(self, statement: SourceStatement, word: SourceWord) -> None:
        self._only(statement, "GMST" + "XZ")
        x, z = statement.find_word("X"), statement.find_word("Z")
        for each in (x, z):
            if each is not None and each.value:
                self.state.add_warning(word, "home-position", word=f"{word.text} {each.text}")
        if x is None and z is None:
            self.state.add_warning(word, "left-out", word=word.text)
            return
        self._go_home(statement, x=x is not None, z=z is not None)

    def _only(self, statement: SourceStatement, letters: str) -> None:
        for each in statement.words:
            if each.letter not in letters:
                code = "c-axis" if each.letter in ROTARY_LETTERS else "code-unknown"
                raise make_error(each.line_number, each.column, code, word=each.text)

    def _go_home(self, statement: SourceStatement, *, x: bool, z: bool) -> None:
        state = self.state
        if self._nose_ends or state.nose_code != 40:
            self._nose_ends, state.nose_code = False, 40
            state.append_step(PathStep(StepKind.NOSE, statement.line_number, number=40))
        state.append_step(
            PathStep(StepKind.HOME, statement.line_number, 0.0 if x else None, 0.0 if z else None)
        )
        state.x, state.z = None if x else state.x, None if z else state.z

    def _preset(self, statement: SourceStatement, code: SourceWord) -> None:
        """Execute G50 or G92, which set a maximum speed, a position preset or both."""
        state = self.state
        self._only(statement, "GMSTXZ" + ("UW" if state.source_control.is_fanuc else ""))
        if not any(each.letter in "XZUW" for each in statement.words):
            if statement.find_word("S") is None or state.source_control is SourceControl.LINUXCNC:
                raise make_error(code.line_number, code.column, "cycle-word", word="X Z")
            return
        for each in statement.words:
            if each.letter in "UW":
                raise make_error(each.line_number, each.column, "code-unknown", word=each.text)
        state.has_preset = True
        before = state.x, state.z
        x, z = statement.find_word("X"), statement.find_word("Z")
        state.x = state.convert_x(x) if x is not None else state.x
        state.z = state.convert_length(z) if z is not None else state.z
        add_preset_shift(state, before)
        state.append_step(PathStep(StepKind.PRESET, statement.line_number, state.x, state.z))


def read_source(texts: Sequence[str], options: ConversionOptions) -> tuple[SourceState, list[Diagnostic]]:
    """Read the source program; return the final state and the findings in order.

    If an error has ended the reading, it is the last finding.
    """
    if options.front and options.control is SourceControl.LINUXCNC:
        return SourceState(options), [make_error(0, 0, "tool-post").diagnostic]
    try:
        reader = SourceReader(texts, options)
    except ProgramError as error:
        return SourceState(options), [error.diagnostic]
    try:
        reader.read_program()
    except ProgramError as error:
        return reader.state, [*reader.state.warnings, error.diagnostic]
    return reader.state, reader.state.warnings
