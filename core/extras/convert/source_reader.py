"""Reader of a source program, which executes its words on a modal state and produces path steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.cycles.source_cycles import SourceCycles
from core.extras.convert.cycles.thread_cycles import append_thread_pass
from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.source_arcs import append_arc
from core.extras.convert.source_corners import Corner, add_corner
from core.extras.convert.source_flow import ProgramFlow
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import ConversionOptions, SourceControl
from core.extras.convert.source_spindle import execute_spindle_words, stop_spindle
from core.extras.convert.source_state import SourceState
from core.language.diagnostics import Diagnostic, ProgramError

_IDLE = frozenset(
    {
        9,
        17,
        18,
        40,
        43,
        49,
        61,
        61.1,
        64,
        69,
        80,
        91.1,
        92.1,
        92.2,
        53.1,
        15,
        50.1,
        13.1,
        113,
        67,
        23,
        25,
        26,
        22,
    }
)
_SILENT = frozenset(
    {17, 18, 40, 49, 80, 69, 91.1, 92.1, 92.2, 15, 67, 43}
)  # the state that a lathe program has anyway
_LEFT_OUT_M = frozenset({6, 7, 17, 18, 23, 24, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49})
_SILENT_M = frozenset({6, 7})
# Haas: chip conveyor, automatic door, high-pressure coolant, air jet, and display
_LEFT_OUT_M_OF_HAAS = frozenset({12, 13, 31, 32, 33, 76, 77, 83, 84, 85, 86, 88, 89})
_C_AXIS = frozenset({7.1, 12.1, 107, 112, 12, 16, 12.2})
_C_WORDS = "CHABYV"


class SourceReader:
    """One pass through a source program. ``state.steps`` and ``state.warnings`` are the results."""

    def __init__(self, texts: Sequence[str], options: ConversionOptions) -> None:
        self.flow = ProgramFlow(texts, options.control)
        self.state = SourceState(options, is_metric=options.metric)
        self._cycles = SourceCycles(self.state, self.flow, self.execute_statement)
        self._corner: Corner | None = None
        self._nose_ends = False
        control = options.control
        self.state.is_feed_per_rev = control.is_fanuc
        self.state.is_x_diameter = (
            options.diameter if options.diameter is not None else control is not SourceControl.LINUXCNC
        )

    def read_program(self) -> None:
        """Read the whole program. Raises ProgramError at the first line that cannot be converted."""
        for statement in self.flow.iter_statements():
            self.execute_statement(statement)
        if self.flow.repeats:
            word = SourceWord("M", 99, False, self.flow.repeats, 1, "M99")
            self.state.add_warning(word, "repeat")
        if not any(each.kind is StepKind.END for each in self.state.steps):
            line = self.state.steps[-1].line if self.state.steps else 1
            self.state.append_step(PathStep(StepKind.END, line, number=30))

    # --- one statement

    def execute_statement(self, statement: SourceStatement) -> None:
        """Execute the words of one line. Raises ProgramError if the line cannot be converted."""
        state = self.state
        if statement.comment:
            state.comment = f"{state.comment} {statement.comment}".strip()
        statement = self._without_y(statement)
        if not statement.words:
            return
        self._modes(statement)
        self._feed(statement)
        self._tool(statement)
        execute_spindle_words(state, statement)
        self._start_codes(statement)
        self._motion(statement)
        self._stop_codes(statement)

    def _modes(self, statement: SourceStatement) -> None:
        for word in statement.find_words("G"):
            if not self._numbers_mode(word) and not self._feed_mode(word):
                self._other_mode(word)

    def _without_y(self, statement: SourceStatement) -> SourceStatement:
        """Return the statement without Y0 and V0, which have no effect on a lathe without a Y axis."""
        idle = [each for each in statement.words if each.letter in "YV" and not each.value]
        for each in idle:
            self.state.add_warning(each, "left-out", word=each.text)
        return replace(statement, words=tuple(each for each in statement.words if each not in idle))

    def _numbers_mode(self, word: SourceWord) -> bool:
        """Execute a code for units, diameter programming or increments; return False for other codes."""
        state, fanuc, code = self.state, self.state.source_control.is_fanuc, word.value
        if code in {20, 21} or (code in {70, 71} and not fanuc):
            state.is_metric = code in {21, 71}
        elif code in {7, 8} and not fanuc:
            state.is_x_diameter = code == 7
        elif code in {90, 91} and not state.source_control.has_system_a:
            state.is_absolute = code == 90
        else:
            return False
        return True

    def _feed_mode(self, word: SourceWord) -> bool:
        """Execute a code that selects the feed mode; return False for other codes."""
        state, code = self.state, word.value
        if code in self._feed_codes():
            per_rev = code in {99, 95}
            state.feed = None if per_rev != state.is_feed_per_rev else state.feed
            state.is_feed_per_rev = per_rev
        elif code == 93 and not state.source_control.is_fanuc:
            raise make_error(word.line_number, word.column, "inverse-time")
        elif code in {98, 99} and not state.source_control.has_system_a:
            state.returns_to_r = code == 99
        else:
            return False
        return True

    def _other_mode(self, word: SourceWord) -> None:
        state, code = self.state, word.value
        if 54 <= code < 60:
            if state.work_offset not in {0, code} or code != int(code):
                raise make_error(word.line_number, word.column, "work-offset", word=word.text)
            state.work_offset = code
        elif code in {17, 18, 19}:
            state.plane_code = code
        elif code in _C_AXIS:
            raise make_error(word.line_number, word.column, "c-axis", word=word.text)
        elif code in _IDLE and code not in _SILENT:
            state.add_warning(word, "left-out", word=word.text)

    def _feed_codes(self) -> frozenset[int]:
        return frozenset({98, 99}) if self.state.source_control.has_system_a else frozenset({94, 95})

    def _feed(self, statement: SourceStatement) -> None:
        state = self.state
        word = statement.find_word("F")
        if (
            word is None
            or statement.has_g(4, 32, 33, 76, 34)
            or (state.motion_code in {32, 33} and not statement.find_words("G"))
        ):
            return
        if self._is_thread_cycle(statement):
            return
        if (
            state.is_feed_per_rev
            and not word.has_point
            and state.source_control.is_fanuc
            and state.options.no_point != 1
        ):
            raise make_error(word.line_number, word.column, "feed-no-point", word=word.text)
        state.feed = word.value * state.get_unit_mm(word)
        most = state.options.max_feed_mm_min
        if not state.is_feed_per_rev and state.feed > most:
            state.add_warning(word, "feed-limited", word=word.text)
            state.feed = most

    def _is_thread_cycle(self, statement: SourceStatement) -> bool:
        code = 92 if self.state.source_control.has_system_a else 78
        if not self.state.source_control.is_fanuc:
            return False
        return statement.has_g(code) or (self.state.motion_code == code and not statement.find_words("G"))

    def _tool(self, statement: SourceStatement) -> None:
        state, word = self.state, statement.find_word("T")
        if word is None:
            return
        number = offset = round(word.value)
        if number > 99:
            number, offset = divmod(number, 100)
        if not number or not offset:
            state.add_warning(word, "offset-cancelled", word=word.text)
            if number in {0, state.tool_number}:
                return
            offset = number
        if not 1 <= offset <= 32:
            raise make_error(word.line_number, word.column, "tool-number", word=word.text)
        if offset != state.tool_number:
            state.tool_number, state.x, state.z = offset, None, None
            state.append_step(PathStep(StepKind.TOOL, statement.line_number, number=offset))

    # --- M codes

    def _start_codes(self, statement: SourceStatement) -> None:
        for word in statement.find_words("M"):
            if word.value in {8, 7}:
                self.state.append_step(PathStep(StepKind.M, statement.line_number, number=8))
            elif word.value not in {0, 1, 2, 3, 4, 5, 9, 30, 60}:
                self._machine_code(word)

    def _machine_code(self, word: SourceWord) -> None:
        options = self.state.options
        code = word.value
        haas = options.control is SourceControl.HAAS and code in _LEFT_OUT_M_OF_HAAS
        if code in options.skipped_m_codes or code in _LEFT_OUT_M or haas:
            if code not in _SILENT_M:
                self.state.add_warning(word, "left-out", word=word.text)
        elif code in options.m_codes:
            self.state.add_warning(word, "machine-code", word=word.text)
            self.state.append_step(PathStep(StepKind.M, word.line_number, number=code))
        else:
            raise make_error(word.line_number, word.column, "m-code", word=word.text, number=f"{code:g}")

    def _stop_codes(self, statement: SourceStatement) -> None:
        state = self.state
        for word in statement.find_words("M"):
            if word.value in {9, 0, 1, 60}:
                state.append_step(
                    PathStep(StepKind.M, statement.line_number, number=0 if word.value == 60 else word.value)
                )
            elif word.value == 5:
                stop_spindle(state, word)
            elif word.value in {2, 30}:
                state.append_step(PathStep(StepKind.END, statement.line_number, number=word.value))
                self.flow.ended = True

    # --- moves

    def _motion(self, statement: SourceStatement) -> None:
        state = self.state
        for word in statement.find_words("G"):
            if self._one_shot(statement, word):
                return
        motion = [each for each in statement.find_words("G") if self._is_motion(each)]
        if motion:
            state.motion_code = motion[-1].value
            if motion[-1].value != state.cycle_code:
                state.cycle_code, state.hole_words = -1, {}
        if statement.has_g(80):
            state.motion_code = 0
        self._nose_codes(statement)
        axes = [
            each
            for each in statement.words
            if each.letter in ("XZUW" if state.source_control.is_fanuc else "XZ")
        ]
        if self._cycles.is_modal(state.motion_code):
            if axes or (motion and self._cycles.is_hole_cycle(state.motion_code)):
                self._cycles.execute_modal_cycle(statement, motion[-1] if motion else axes[0])
            return
        self._check_letters(statement)
        if not axes:
            return
        self._move(statement, motion[-1] if motion else axes[0])
        if self._nose_ends:
            self._nose_ends = False
            state.append_step(PathStep(StepKind.NOSE, statement.line_number, number=40))

    def _is_motion(self, word: SourceWord) -> bool:
        if self._cycles.is_modal(word.value):
            return True
        if word.value in {0, 1, 2, 3, 33} or (word.value == 32 and self.state.source_control.is_fanuc):
            return True
        known = (
            word.value in _IDLE
            or word.value in self._feed_codes()
            or word.value in {20, 21, 96, 97, 41, 42, 90, 91, 98, 99}
            or 54 <= word.value < 60
            or (not self.state.source_control.is_fanuc and word.value in {7, 8, 70, 71})
        )
        if not known:
            raise make_error(word.line_number, word.column, "code-unknown", word=word.text)
        return False

    def _move(self, statement: SourceStatement, code: SourceWord) -> None:
        state = self.state
        if state.motion_code in {2, 3}:
            if self._corner is not None:
                raise make_error(
                    self._corner.word.line_number,
                    self._corner.word.column,
                    "corner",
                    word=self._corner.word.text,
                )
            append_arc(state, statement, code)
            return
        x, z = state.find_target(statement)
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
        return next(
            (each for each in statement.words if each.letter in {",C", ",R", "C", "R", "I", "K"}), None
        )

    def _check_letters(self, statement: SourceStatement) -> None:
        """Raise ProgramError if the statement contains a word that this reader does not use."""
        allowed = "GMXZFSTNUW" if self.state.source_control.is_fanuc else "GMXZFSTN"
        if self.state.motion_code in {2, 3}:
            allowed += "RIK"
        elif self.state.motion_code in {32, 33}:
            allowed += "EQ" if self.state.source_control.is_fanuc else "K"
        for word in statement.words:
            if word.letter in allowed:
                continue
            if word.letter == "D" and statement.has_g(96, 41, 42):
                continue
            if word.letter in "PQ" and statement.has_g(64):
                continue
            if word.letter == "H" and statement.has_g(43):
                continue
            if self.state.motion_code == 1 and self._corner_word(statement) is word:
                continue
            code = "c-axis" if word.letter in _C_WORDS else "code-unknown"
            raise make_error(word.line_number, word.column, code, word=word.text)

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

    # --- codes that act only on their line

    def _one_shot(self, statement: SourceStatement, word: SourceWord) -> bool:
        """Execute a code that uses the axis words of its line; return False for other codes."""
        code, control = word.value, self.state.source_control
        if code == 4:
            self._dwell(statement, word)
        elif code in {28, 30}:
            self._home(statement)
        elif code == 53:
            self._machine_position(statement, word)
        elif (code == 50 and control.is_fanuc) or (code == 92 and not control.has_system_a):
            self._preset(statement)
        else:
            return self._cycles.execute_one_shot_cycle(statement, word)
        return True

    def _dwell(self, statement: SourceStatement, word: SourceWord) -> None:
        time = next((each for letter in "PXUF" if (each := statement.find_word(letter))), None)
        if time is None:
            raise make_error(word.line_number, word.column, "cycle-word", word="P")
        seconds = time.value
        if self.state.source_control.is_fanuc and not time.has_point:
            seconds = seconds / 1000.0
        if seconds > 0:
            self.state.append_step(PathStep(StepKind.DWELL, statement.line_number, number=max(seconds, 0.1)))

    def _home(self, statement: SourceStatement) -> None:
        state = self.state
        letters = "XZUW" if state.source_control.is_fanuc else "XZ"
        self._only(statement, "GMST" + letters)
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
        if x is not None or z is not None:
            self._go_home(statement, x=x is not None, z=z is not None)

    def _only(self, statement: SourceStatement, letters: str) -> None:
        for each in statement.words:
            if each.letter not in letters:
                code = "c-axis" if each.letter in _C_WORDS else "code-unknown"
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

    def _preset(self, statement: SourceStatement) -> None:
        """Execute G50 or G92, which set a maximum speed, a position preset or both."""
        state = self.state
        self._only(statement, "GMSTXZ" + ("UW" if state.source_control.is_fanuc else ""))
        if statement.find_word("X") is None and statement.find_word("Z") is None:
            return
        x, z = statement.find_word("X"), statement.find_word("Z")
        state.x = state.convert_x(x) if x is not None else state.x
        state.z = state.convert_length(z) if z is not None else state.z
        state.append_step(PathStep(StepKind.PRESET, statement.line_number, state.x, state.z))


def read_source(texts: Sequence[str], options: ConversionOptions) -> tuple[SourceState, list[Diagnostic]]:
    """Return the state after reading the source program, and the findings in order.

    If an error has ended the reading, it is the last finding.
    """
    try:
        reader = SourceReader(texts, options)
    except ProgramError as error:
        return SourceState(options), [error.diagnostic]
    try:
        reader.read_program()
    except ProgramError as error:
        return reader.state, [*reader.state.warnings, error.diagnostic]
    return reader.state, reader.state.warnings
