"""Modal state of a source program, and conversion of its numbers to mm."""

from __future__ import annotations

from dataclasses import dataclass, field

from core.extras.convert.conversion_messages import make_error, make_note, make_warning
from core.extras.convert.path_steps import PathStep, SpindleState, StepKind
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import ConversionOptions, SourceControl
from core.language.diagnostics import Diagnostic, ProgramError

MM_PER_INCH = 25.4
_LEAST = (0.0001, 0.001)  # least increment in inches and in mm
_SAME = 1e-9  # mm
MAX_STEP_COUNT = 300_000
_CUTS = frozenset({StepKind.FEED, StepKind.ARC, StepKind.THREAD})
_NEED_SPEED = frozenset({StepKind.FEED, StepKind.ARC, StepKind.THREAD, StepKind.DWELL, StepKind.END})


@dataclass(slots=True)
class SourceState:
    """Modal state, position and steps of a pass through a source program.

    ``x z`` is the position in mm with X as a radius; an unknown coordinate is None. ``feed`` is in mm/min
    or mm/rev.
    """

    options: ConversionOptions
    steps: list[PathStep] = field(default_factory=list)
    warnings: list[Diagnostic] = field(default_factory=list)
    x: float | None = None
    z: float | None = None
    is_metric: bool | None = None
    is_x_diameter: bool = True
    is_absolute: bool = True
    is_feed_per_rev: bool = False
    feed: float | None = None
    last_lead_mm: float = 0.0  # of the last thread, mm/rev
    motion_code: float = 0
    plane_code: float = 18
    spindle: SpindleState = field(default_factory=SpindleState)
    speed_request: ProgramError | None = None  # raised by the next cut; S clears it
    start_request: ProgramError | None = None  # raised by the next cut; M03 and M04 clear it
    tool_number: int = 0
    nose_code: int = 40
    work_offset: float = 0
    uses_tool_change: bool = False  # T only prepares the tool, and M06 changes it
    prepared_tool: SourceWord | None = None
    has_preset: bool = False
    preset_shift: tuple[float, float] | None = (0.0, 0.0)  # X and Z of all presets; None if unknown
    move_error: ProgramError | None = None  # raised by the next move
    pending_comment: str = ""
    cycle_code: float = -1  # single cycle whose values are stored
    cycle_end_point: tuple[float, float] | None = None
    cycle_taper: float = 0.0
    hole_cycle_words: dict[str, SourceWord] = field(default_factory=dict)  # words of the active hole cycle
    returns_to_r_plane: bool = False  # G99 of G-code systems B and C
    _recorded: set[tuple[int, str, str]] = field(default_factory=set)

    @property
    def source_control(self) -> SourceControl:
        """Return the control for which the source program was written."""
        return self.options.control

    def get_unit_mm(self, word: SourceWord) -> float:
        """Return one length unit of the program in mm.

        Raises ProgramError if the unit is unknown.
        """
        if self.is_metric is None:
            raise make_error(word.line_number, word.column, "unit")
        return 1.0 if self.is_metric else MM_PER_INCH

    def convert_length(self, word: SourceWord) -> float:
        """Return the length or coordinate of a word in mm; a diameter remains a diameter.

        Raises ProgramError if the unit is unknown, or the meaning of a number without a decimal point.
        """
        if not word.value:
            return 0.0
        unit = self.get_unit_mm(word)
        if word.has_decimal_point or not self.source_control.is_fanuc or self.options.no_point == 1:
            return word.value * unit
        if not self.options.no_point:
            raise make_error(word.line_number, word.column, "no-point", word=word.text)
        return word.value * unit * _LEAST[bool(self.is_metric)]

    def convert_x(self, word: SourceWord) -> float:
        """Return an X or U word in mm as a radius.

        Raises ProgramError in the same cases as ``convert_length``.
        """
        return self.convert_length(word) / (2.0 if self.is_x_diameter else 1.0)

    def convert_increment(self, word: SourceWord) -> float:
        """Return the P or Q word of a Fanuc cycle in mm.

        The value is in least increments unless the word has a decimal point.
        """
        if word.has_decimal_point or not self.source_control.is_fanuc:
            return word.value * self.get_unit_mm(word)
        return word.value * self.get_unit_mm(word) * _LEAST[bool(self.is_metric)]

    def find_target(self, statement: SourceStatement) -> tuple[float | None, float | None]:
        """Return the end point of a move as X and Z; an unknown coordinate is None.

        Raises ProgramError for an increment from an unknown position.
        """
        return (
            self._axis(statement, "X", "U", self.x),
            self._axis(statement, "Z", "W", self.z),
        )

    def _axis(
        self, statement: SourceStatement, letter: str, increment: str, now: float | None
    ) -> float | None:
        word = statement.find_word(letter)
        by = statement.find_word(increment) if self.source_control.is_fanuc else None
        if word is None and by is None:
            return now
        across = letter == "X"
        found = word or by
        assert found is not None
        value = self.convert_x(found) if across else self.convert_length(found)
        if word is not None and self.is_absolute:
            return value
        if now is None:
            if not value:
                return None
            raise make_error(found.line_number, found.column, "position", axis=letter)
        return now + value

    def get_position(self, word: SourceWord) -> tuple[float, float]:
        """Return the current position as X and Z. Raises ProgramError if the position is unknown."""
        if self.x is None or self.z is None:
            axis = "X" if self.x is None else "Z"
            raise make_error(word.line_number, word.column, "position", axis=axis)
        return self.x, self.z

    def add_warning(self, word: SourceWord, code: str, /, **values: object) -> None:
        """Record a warning, unless the same warning is already recorded for this line."""
        self._add(make_warning(word.line_number, word.column, code, **values))

    def add_note(self, word: SourceWord, code: str, /, **values: object) -> None:
        """Record a note, unless the same note is already recorded for this line."""
        self._add(make_note(word.line_number, word.column, code, **values))

    def _add(self, found: Diagnostic) -> None:
        key = (found.line, found.code, found.message)
        if key not in self._recorded:
            self._recorded.add(key)
            self.warnings.append(found)

    # --- steps

    def append_step(self, step: PathStep) -> None:
        """Append a step, and attach the comment that precedes it.

        Raises ProgramError if the program makes too many steps, or if a speed or a start of the spindle is
        missing.
        """
        if len(self.steps) >= MAX_STEP_COUNT:
            raise make_error(step.line, 1, "too-many-moves", most=MAX_STEP_COUNT)
        if self.speed_request is not None and step.kind in _NEED_SPEED:
            raise self.speed_request
        if self.start_request is not None and step.kind in _CUTS:
            raise self.start_request
        if self.pending_comment:
            object.__setattr__(step, "comment", self.pending_comment)
            self.pending_comment = ""
        self.steps.append(step)

    def append_move(
        self, kind: StepKind, line: int, x: float | None, z: float | None, **values: float | bool
    ) -> None:
        """Append a move to this point, unless its length is zero.

        Raises ProgramError if the position is unknown since an earlier code.
        """
        if self.move_error is not None:
            raise self.move_error
        moves = not (
            self.x is not None
            and self.z is not None
            and x is not None
            and z is not None
            and abs(self.x - x) < _SAME
            and abs(self.z - z) < _SAME
        )
        if moves or kind is StepKind.ARC:
            self.append_step(PathStep(kind, line, x, z, **values))  # type: ignore[arg-type]
        self.x, self.z = x, z

    def append_rapid(self, line: int, x: float | None, z: float | None) -> None:
        """Append a rapid move to the given point."""
        self.append_move(StepKind.RAPID, line, x, z)

    def append_cut(self, word: SourceWord, x: float | None, z: float | None) -> None:
        """Append a straight cut at the active feed. Raises ProgramError if no feed is active."""
        if self.feed is None:
            raise make_error(word.line_number, word.column, "feed-missing")
        self.append_move(StepKind.FEED, word.line_number, x, z, feed=self.feed, per_rev=self.is_feed_per_rev)
