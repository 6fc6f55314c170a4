"""What is in force between two blocks of a SINUMERIK program, and where the machine stands."""

from __future__ import annotations

from collections.abc import Callable

from core.interpreter.actions import Action, Dwell
from core.interpreter.diagnostic_log import Log
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.formula_values import NoValueError, worth
from core.interpreter.job_setup import Setup, ZeroOffset
from core.interpreter.modal_state import Modal
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.interpreter.units import MM_PER_INCH
from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Parameter
from core.language.sinumerik.sinumerik_words import Word

NO_OFFSET = ZeroOffset()


class State:
    """Position in machine coordinates: mm, X a radius, C in degrees counting on over its turns.

    ``modal`` is what blocks carry; ``motion`` the G code of group 1 and ``plane`` that of the plane;
    ``programmed`` what TRANS and ATRANS have summed up.
    """

    def __init__(self, setup: Setup, log: Log) -> None:
        self.setup = setup
        self.log = log
        self.x, self.z, self.c = setup.start
        self.motion = 1
        self.plane = 18
        self.settable = NO_OFFSET
        self.programmed = NO_OFFSET
        self.r: dict[int, float] = {}
        self.variables: dict[str, float] = {}  # of DEF
        wraps = setup.limits.c_enabled and setup.limits.c_modulo
        self.modal = Modal(absolute=True, metric=True, diameter=True, rapid_rate=0.0, wraps_c=wraps)

    def adopt(self, modal: Modal) -> None:
        """Make ``modal`` the state in force; where it says nothing new, blocks go on sharing the old one."""
        if modal != self.modal:
            self.modal = modal

    def derive_offsets(self) -> None:
        """The offsets in force: settable and programmed ones summed."""
        one, other = self.settable, self.programmed
        frame = self.modal._replace(tool_x=one.x, tool_z=one.z, zero_x=other.x, zero_z=other.z)
        self.adopt(frame._replace(offset_c=one.c + other.c))

    def length(self, statement: Statement, word: Word) -> float:
        """A length in mm: as written under G71, inches under G70."""
        return self.number(statement, word) * (1.0 if self.modal.metric else MM_PER_INCH)

    def number(self, statement: Statement, word: Word) -> float:
        """The number of a word, or what its formula comes to. Raises ProgramError where that has no value."""
        if word.value is not None:
            return word.value
        assert word.formula is not None
        return self.worth(word.formula, lambda code, text, hint: statement.refuse(word, code, text, hint))

    def worth(self, formula: Formula, refuse: Callable[[str, str, str], ProgramError]) -> float:
        """What a formula comes to. ``refuse`` makes the error to raise of its code, text and hint."""

        def parameter(asked: Parameter) -> float:
            name = f"{asked.letters}{'' if asked.number is None else asked.number}"
            value = self.r.get(asked.number) if isinstance(asked.number, int) else self.variables.get(name)
            if value is None:
                what = "the program has not set it" if asked.number is not None else "no DEF has named it"
                before = f"{name}=…" if asked.number is not None else f"DEF REAL {name}"
                raise refuse("r-unset", f"{name} has no value: {what}.", f"Write {before} before it.")
            return value

        try:
            return worth(formula, parameter)
        except NoValueError as problem:
            raise refuse("arithmetic", f"{problem}.", "Correct the formula.") from None

    def keep(self, name: str, value: float) -> bool:
        """An R parameter or a variable holds this from now on; False where no DEF has named the variable."""
        if name[0] == "R" and name[1:].isdigit():
            self.r[int(name[1:])] = value
        elif name in self.variables:
            self.variables[name] = value
        else:
            return False
        return True

    def rpm_at(self, x: float) -> float:
        """Commanded speed with the tip at radius ``x`` of the program; signed, 0 with the spindle stopped."""
        modal = self.modal
        if not modal.spindle:
            return 0.0
        highest = self.setup.limits.max_rpm
        if modal.css:
            return modal.surface_rpm_at(x, highest)
        return modal.spindle * min(
            modal.rpm, highest if modal.css_max is None else min(highest, modal.css_max)
        )

    @property
    def rpm(self) -> float:
        """Commanded spindle speed where the tip stands; signed."""
        return self.rpm_at(self.x - self.modal.offset_x)

    @property
    def css(self) -> float | None:
        """Surface speed by which the spindle turns, mm/s; None while it stands or has another rule."""
        modal = self.modal
        return modal.surface_speed if modal.css and modal.spindle and modal.surface_speed else None

    def action(self, line: int, text: str, action: Action) -> Block:
        """A block in which no axis moves."""
        modal = self.modal
        x, z, c = self.x - modal.offset_x, self.z - modal.offset_z, self.c - modal.offset_c
        return Block(
            n=0, line=line, kind=Kind.DWELL if isinstance(action, Dwell) else Kind.ACTION, text=text,
            x0=x, z0=z, c0=c, x=x, z=z, c=c, offset_x=modal.offset_x, offset_z=modal.offset_z,
            modal=modal, rpm=self.rpm, css=self.css, action=action,
        )  # fmt: skip


def positive(statement: Statement, word: Word, value: float, what: str) -> float:
    """A number that must be over 0. Raises ProgramError."""
    if value > 0.0:
        return value
    raise statement.refuse(word, "not-positive", f"{word.text}: {what} must be over 0.", "Correct it.")
