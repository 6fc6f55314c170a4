"""What is in force between two blocks of a SINUMERIK program, and where the machine stands."""

from __future__ import annotations

from dataclasses import replace
from enum import IntEnum
from typing import Protocol

from core.interpreter.shared.actions import Action, Dwell, ProgramStop
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.shared.formula_values import worth
from core.interpreter.shared.job_setup import Setup, ToolOffset, ZeroOffset
from core.interpreter.shared.modal_state import Modal
from core.interpreter.shared.units import MM_PER_INCH
from core.interpreter.sinumerik.flow.variables import UNSET, Refuse, Variables, position_asked, system_value
from core.interpreter.sinumerik.motion.third_axis import wrapped
from core.interpreter.sinumerik.setup.programmed_frame import ProgrammedFrame
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import AT_THE_STOP, Diagnostic, ProgramError, Severity, resting_on
from core.language.formulas import Formula, Parameter
from core.language.sinumerik.sinumerik_words import Line, Word
from core.message import Message


class PlaneInForce(Protocol):
    """The plane of a transformation; see ``transformed_plane``."""

    @property
    def name(self) -> str:
        """The word that has begun it."""
        ...

    @property
    def along_z(self) -> bool:
        """Whether the depth is Z, along which drilling cycles drill."""
        ...

    @property
    def plane(self) -> int:
        """G17 or G19, in which its arcs and its compensation lie."""
        ...

    @property
    def depth(self) -> float:
        """Where the tool stands square to the plane, as the program counts: mm."""
        ...

    def down_to(self, statement: Statement, depth: float, feed: float | None, text: str) -> Block:
        """A move square to the plane to a depth as the program counts it, in mm; feed None is a rapid."""
        ...

    def over(self, statement: Statement, x: float, y: float, text: str) -> Block:
        """A rapid to a place of the plane, mm."""
        ...


NO_OFFSET = ZeroOffset()
NO_FRAME = ProgrammedFrame()


class Motion(IntEnum):
    """How an axis word moves: the G code of group 1, and two that have a name."""

    RAPID = 0
    LINE = 1
    CLOCKWISE = 2
    COUNTER = 3
    THREAD = 33
    GROWING = 34
    SHRINKING = 35
    TAP = 331
    TAP_OUT = 332
    THROUGH = 1000  # CIP
    TANGENT = 1001  # CT


def motion_name(motion: int) -> str:
    """What a program writes for it."""
    return {Motion.THROUGH: "CIP", Motion.TANGENT: "CT"}.get(Motion(motion), f"G{int(motion)}")


ARCS = frozenset({Motion.CLOCKWISE, Motion.COUNTER, Motion.THROUGH, Motion.TANGENT})

THREADS = frozenset({Motion.THREAD, Motion.GROWING, Motion.SHRINKING})
TAPS = frozenset({Motion.TAP, Motion.TAP_OUT})


class State:
    """Position in machine coordinates: mm, X a radius, C in degrees counting on over its turns.

    ``modal`` is what blocks carry; ``motion`` is that of group 1 and ``plane`` the G code of the plane;
    ``programmed`` is the frame of TRANS, ROT, SCALE and MIRROR, ``edge`` the row of T and D.
    """

    def __init__(self, setup: Setup, log: Log) -> None:
        self.setup = setup
        self.log = log
        self.x, self.z, self.c = setup.start
        self.motion = Motion.LINE
        self.plane = 18
        self.settable = NO_OFFSET
        self.programmed = NO_FRAME
        self.edge = ToolOffset()
        self.moved_by_tool: set[str] = set()  # slides whose place has changed with T or D since they moved
        self.distance_is_radius = False  # DIAM90
        self.feed_in_inches = False  # G700
        self.override = 1.0  # OVR
        self.exact = False  # G60
        self.rounding = 0.0  # RNDM, mm
        self.corner_feed: float | None = None  # FRCM, as modal.feed
        self.pole = (0.0, 0.0)  # X, Z of G110 to G112, in the program's frame
        self.polar: tuple[float, float] | None = None  # RP in mm and AP in degrees, as programmed last
        self.direction: tuple[float, float] | None = None  # of the path at its end, X and Z
        self.lowest, self.highest = 0.0, setup.limits.max_rpm  # G25 and G26 beside the spindle's own
        self.area: dict[tuple[str, bool], float] = {}  # G25 (False) and G26 (True), by axis: mm
        self.area_on = True  # WALIMON
        self.rounded = True  # G450; G451 goes by the intersection
        self.round_ends = False  # KONT; NORM goes straight
        self.threads: tuple[Block, ...] = ()  # of the chain of thread blocks under way
        self.tap_lead = 0.0  # K of G331, mm
        self.lead_change, self.end_lead, self.start_turns = 0.0, 0.0, 0.0  # of G34, G35 and SF
        self.names: list[str] = []  # of tools that the table does not have, by their order
        self.behind_stop = self.place_assumed = False  # a place was read behind a stop, where a hand may move
        self.told: set[str] = set()  # functions without effect that have been told
        self.variables = Variables()
        self.variables.r.update((f"R{number}", value) for number, value in setup.r.items())
        self.modal_call: Line | None = None  # of MCALL
        self.transformation: PlaneInForce | None = None  # TRANSMIT or TRACYL
        self.master = 1  # SETMS: 2 is the live tool, whose S, M3 and G95 are meant then
        self.live_speed = 0.0  # S of the live tool, rpm
        self.live_rpm = 0.0  # by which it turns, signed
        wraps = setup.limits.c_enabled and setup.limits.c_modulo
        slide = setup.limits.c_enabled and setup.limits.c_linear
        self.modal = Modal(
            absolute=True, metric=True, diameter=True, rapid_rate=0.0, wraps_c=wraps, linear_c=slide
        )

    def adopt(self, modal: Modal) -> None:
        """Make ``modal`` the state in force; where it says nothing new, blocks go on sharing the old one."""
        if modal != self.modal:
            self.modal = modal

    def derive_offsets(self) -> None:
        """The offsets in force: of the edge, settable and programmed ones."""
        one, other, edge = self.settable, self.programmed, self.edge
        self.adopt(
            self.modal._replace(
                tool_x=edge.x, tool_z=edge.z, settable_x=one.x, settable_z=one.z,
                zero_x=other.x, zero_z=other.z, offset_c=one.c + other.c,
            )
        )  # fmt: skip

    def length(self, statement: Statement, word: Word) -> float:
        """A length in mm: as written under G71, inches under G70."""
        return self.number(statement, word) * (1.0 if self.modal.metric else MM_PER_INCH)

    def third(self, statement: Statement, word: Word) -> float:
        """The value of a word of the third axis: degrees, or of a slide mm."""
        return self.length(statement, word) if self.modal.linear_c else self.number(statement, word)

    def number(self, statement: Statement, word: Word) -> float:
        """The number of a word, or what its formula comes to. Raises ProgramError where that has no value."""
        if word.value is not None:
            return word.value
        assert word.formula is not None
        return self.worth(word.formula, lambda code, text, hint: statement.refuse(word, code, text, hint))

    def worth(self, formula: Formula, refuse: Refuse) -> float:
        """What a formula comes to. ``refuse`` makes the error to raise of its code, text and hint."""

        def parameter(asked: Parameter) -> float:
            if asked.letters.startswith("$"):
                axis = position_asked(asked.letters)
                read = self.position(axis) if axis else system_value(asked.letters, self.modal, self.edge)
                if read is not None:
                    self.place_assumed = self.place_assumed or bool(axis and self.behind_stop)
                    return read
            try:
                return self.variables.value(asked, lambda index: worth(index, parameter, no_value), refuse)
            except ProgramError as problem:
                if problem.diagnostic.code != UNSET:
                    raise
                self._tell_unset(problem.diagnostic)
                return 0.0

        def no_value(_column: int, why: str) -> ProgramError:
            error = refuse("arithmetic", Message("{what}.", what=why), "Correct the formula.")
            return ProgramError(resting_on(error.diagnostic, AT_THE_STOP)) if self.place_assumed else error

        return worth(formula, parameter, no_value)

    def _tell_unset(self, found: Diagnostic) -> None:
        """Say once of each R parameter that it counts as 0."""
        if found.hint not in self.told:  # it names the parameter, whatever line asks for it
            self.told.add(found.hint)
            self.log.add(replace(found, severity=Severity.WARNING))

    def rpm_at(self, x: float) -> float:
        """Commanded speed with the tip at radius ``x`` of the program; signed, 0 with the spindle stopped."""
        modal = self.modal
        if not modal.spindle:
            return 0.0
        highest = self.highest
        if modal.css:
            return modal.surface_rpm_at(x, highest)
        most = highest if modal.css_max is None else min(highest, modal.css_max)
        return modal.spindle * max(min(modal.rpm, most), self.lowest if modal.rpm else 0.0)

    def position(self, axis: str) -> float | None:
        """Where an axis stands as the program counts it, X as DIAMON says, C 0 to 360 on a modulo axis.

        None where no number would be right: in TRANSMIT and TRACYL, under G70, and for no axis of this lathe.
        """
        modal = self.modal
        if self.transformation is not None or not modal.metric:
            return None
        if axis == self.setup.limits.third_axis and self.setup.limits.c_enabled:
            c = self.c - modal.offset_c
            return wrapped(c) if self.setup.limits.c_modulo else c
        x, z = self.programmed.unturned(self.x - modal.offset_x, self.z - modal.offset_z)
        return {"X": x * (2.0 if modal.diameter else 1.0), "Z": z}.get(axis)

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
        self.behind_stop = self.behind_stop or isinstance(action, ProgramStop)
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
    raise statement.refuse(
        word,
        "not-positive",
        Message("{word}: {what} must be greater than 0.", word=word.text, what=what),
        "Correct the value.",
    )
