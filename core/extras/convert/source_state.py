"""Modal state of a source program, and conversion of its numbers to mm."""

from __future__ import annotations

from dataclasses import dataclass, field

from core.extras.convert.path_steps import Kind, Spindle, Step
from core.extras.convert.reasons import refuse, warn
from core.extras.convert.source_lines import Statement, Word
from core.extras.convert.source_options import Control, Options
from core.language.diagnostics import Diagnostic

MM_PER_INCH = 25.4
_LEAST = (0.0001, 0.001)  # least increment in inches and in mm
_SAME = 1e-9  # mm


@dataclass(slots=True)
class SourceState:
    """Modal state, position and steps of a pass through a source program.

    ``x z`` is the position in mm with X as a radius; an unknown coordinate is None. ``feed`` is in mm/min
    or mm/rev.
    """

    options: Options
    steps: list[Step] = field(default_factory=list)
    warnings: list[Diagnostic] = field(default_factory=list)
    x: float | None = None
    z: float | None = None
    metric: bool | None = None
    diameter: bool = True
    absolute: bool = True
    per_rev: bool = False
    feed: float | None = None
    lead: float = 0.0  # of the last thread, mm/rev
    motion: float = 0
    plane: float = 18
    spindle: Spindle = field(default_factory=Spindle)
    tool: int = 0
    nose: int = 40
    work_offset: float = 0
    comment: str = ""
    cycle_code: float = -1  # single cycle whose values are stored
    cycle_end: tuple[float, float] | None = None
    cycle_taper: float = 0.0
    hole: dict[str, Word] = field(default_factory=dict)  # words of the active hole cycle
    returns_to_r: bool = False  # G99 of G-code systems B and C

    @property
    def control(self) -> Control:
        """Return the control for which the source program was written."""
        return self.options.control

    def unit(self, word: Word) -> float:
        """Return the size of the program's length unit in mm. Raises ProgramError if the unit is unknown."""
        if self.metric is None:
            raise refuse(word.line, word.column, "unit")
        return 1.0 if self.metric else MM_PER_INCH

    def length(self, word: Word) -> float:
        """Return the length or coordinate of a word in mm, without halving a diameter.

        Raises ProgramError.
        """
        if not word.value:
            return 0.0
        unit = self.unit(word)
        if word.has_point or not self.control.is_fanuc or self.options.no_point == 1:
            return word.value * unit
        if not self.options.no_point:
            raise refuse(word.line, word.column, "no-point", word=word.text)
        return word.value * unit * _LEAST[bool(self.metric)]

    def across(self, word: Word) -> float:
        """Return the value of an X or U word in mm as a radius. Raises ProgramError."""
        return self.length(word) / (2.0 if self.diameter else 1.0)

    def increment(self, word: Word) -> float:
        """Return the P or Q word of a Fanuc cycle in mm.

        The value is in least increments unless the word has a decimal point.
        """
        if word.has_point or not self.control.is_fanuc:
            return word.value * self.unit(word)
        return word.value * self.unit(word) * _LEAST[bool(self.metric)]

    def target(self, statement: Statement) -> tuple[float | None, float | None]:
        """Return the end point of a move as X and Z; an unknown coordinate is None.

        Raises ProgramError for an increment from an unknown position.
        """
        return (
            self._axis(statement, "X", "U", self.x),
            self._axis(statement, "Z", "W", self.z),
        )

    def _axis(self, statement: Statement, letter: str, increment: str, now: float | None) -> float | None:
        word = statement.word(letter)
        by = statement.word(increment) if self.control.is_fanuc else None
        if word is None and by is None:
            return now
        across = letter == "X"
        found = word or by
        assert found is not None
        value = self.across(found) if across else self.length(found)
        if word is not None and self.absolute:
            return value
        if now is None:
            if not value:
                return None
            raise refuse(found.line, found.column, "position", axis=letter)
        return now + value

    def here(self, word: Word) -> tuple[float, float]:
        """Return the present position as X and Z. Raises ProgramError if the position is unknown."""
        if self.x is None or self.z is None:
            axis = "X" if self.x is None else "Z"
            raise refuse(word.line, word.column, "position", axis=axis)
        return self.x, self.z

    def warn(self, word: Word, code: str, /, **values: object) -> None:
        """Record a warning, unless a warning with the same code and text is already recorded."""
        found = warn(word.line, word.column, code, **values)
        if all((each.code, each.message) != (found.code, found.message) for each in self.warnings):
            self.warnings.append(found)

    # --- steps

    def add(self, step: Step) -> None:
        """Append a step, and attach the preceding comment to it."""
        if self.comment:
            object.__setattr__(step, "comment", self.comment)
            self.comment = ""
        self.steps.append(step)

    def go(self, kind: Kind, line: int, x: float | None, z: float | None, **values: float | bool) -> None:
        """Append a move to this point, unless it has no length."""
        moves = not (
            self.x is not None
            and self.z is not None
            and x is not None
            and z is not None
            and abs(self.x - x) < _SAME
            and abs(self.z - z) < _SAME
        )
        if moves or kind is Kind.ARC:
            self.add(Step(kind, line, x, z, **values))  # type: ignore[arg-type]
        self.x, self.z = x, z

    def rapid(self, line: int, x: float | None, z: float | None) -> None:
        """Append a rapid move to this point."""
        self.go(Kind.RAPID, line, x, z)

    def cut(self, word: Word, x: float | None, z: float | None) -> None:
        """Append a straight cut at the active feed. Raises ProgramError if no feed is active."""
        if self.feed is None:
            raise refuse(word.line, word.column, "feed-missing")
        self.go(Kind.FEED, word.line, x, z, feed=self.feed, per_rev=self.per_rev)
