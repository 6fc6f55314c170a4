"""State between two blocks of a SINUMERIK program, with modal functions and positions."""

from __future__ import annotations

from dataclasses import replace
from enum import IntEnum
from typing import Protocol

from core.interpreter.shared.actions import Action, Dwell, ProgramStop
from core.interpreter.shared.control_flow import MAIN_FILE
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.formula_values import compute_formula
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset, ZeroOffset
from core.interpreter.shared.modal_state import ModalState
from core.interpreter.shared.units import MM_PER_INCH
from core.interpreter.sinumerik.flow.variables import (
    UNSET_PARAMETER_CODE,
    ErrorFactory,
    Variables,
    get_position_axis,
    read_system_value,
)
from core.interpreter.sinumerik.motion.third_axis import wrap_angle
from core.interpreter.sinumerik.setup.programmed_frame import ProgrammedFrame
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import (
    PROGRAM_STOP_ASSUMPTION,
    Diagnostic,
    ProgramError,
    Severity,
    add_assumptions,
)
from core.language.formulas import Formula, Parameter
from core.language.sinumerik.sinumerik_words import LexedBlock, Word
from core.language.sinumerik.word_values import find_violated_limits, is_variable, make_limit_hint
from core.message import Message


class ActivePlane(Protocol):
    """Interface of the plane of an active transformation (see ``transformed_plane``)."""

    @property
    def name(self) -> str:
        """Return the word that activated the transformation."""
        ...

    @property
    def is_depth_along_z(self) -> bool:
        """Return whether the depth is along Z, so that drilling cycles are allowed."""
        ...

    @property
    def plane_code(self) -> int:
        """Return the G code of the plane for arcs and compensation, which is 17 or 19."""
        ...

    @property
    def depth_mm(self) -> float:
        """Return the tool position perpendicular to the plane in the program frame, in mm."""
        ...

    def make_depth_move(self, statement: Statement, depth: float, feed: float | None, text: str) -> Block:
        """Return a move to a depth in the program frame, in mm, which is a rapid if ``feed`` is None."""
        ...

    def make_rapid_to_hole(self, statement: Statement, x: float, y: float, text: str) -> Block:
        """Return a rapid to a point of the plane in mm."""
        ...


ZERO_SETTABLE_OFFSET = ZeroOffset()
IDENTITY_FRAME = ProgrammedFrame()


class MotionKind(IntEnum):
    """Kind of motion that the axis words program.

    The value is the number of the G code, or a separate number for CIP and CT.
    """

    RAPID = 0
    LINE = 1
    CLOCKWISE = 2
    COUNTERCLOCKWISE = 3
    THREAD = 33
    THREAD_GROWING_LEAD = 34
    THREAD_SHRINKING_LEAD = 35
    TAP = 331
    TAP_RETRACT = 332
    ARC_BY_POINT = 1000  # CIP
    TANGENTIAL_ARC = 1001  # CT


def format_motion_word(motion: int) -> str:
    """Return a kind of motion as a program word, such as G1 or CIP."""
    return {MotionKind.ARC_BY_POINT: "CIP", MotionKind.TANGENTIAL_ARC: "CT"}.get(
        MotionKind(motion), f"G{int(motion)}"
    )


ARC_MOTIONS = frozenset(
    {MotionKind.CLOCKWISE, MotionKind.COUNTERCLOCKWISE, MotionKind.ARC_BY_POINT, MotionKind.TANGENTIAL_ARC}
)

THREAD_MOTIONS = frozenset(
    {MotionKind.THREAD, MotionKind.THREAD_GROWING_LEAD, MotionKind.THREAD_SHRINKING_LEAD}
)
TAP_MOTIONS = frozenset({MotionKind.TAP, MotionKind.TAP_RETRACT})


class SinumerikState:
    """The machine position and the modal functions of a pass.

    - Positions are in mm and degrees, with X as a radius and continuous C.
    - ``modal`` is the modal state that blocks store.
    - ``motion`` is the active function of group 1, and ``plane`` is the G code of the plane.
    - ``programmed_frame`` is the frame of TRANS, ROT, SCALE and MIRROR.
    - ``edge`` is the offset of the active T and D.
    """

    def __init__(self, setup: InterpreterSetup, log: DiagnosticLog) -> None:
        self.setup = setup
        self.log = log
        self.call_site = MAIN_FILE  # of the block that is being executed
        self.x, self.z, self.c = setup.start
        self.motion = MotionKind.LINE
        self.plane = 18
        self.settable = ZERO_SETTABLE_OFFSET
        self.programmed_frame = IDENTITY_FRAME
        self.edge = ToolOffset()
        self.moved_by_tool: set[str] = set()  # axes whose position changed with T or D since their last move
        self.distance_is_radius = False  # DIAM90
        self.feed_in_inches = False  # G700
        self.override = 1.0  # OVR
        self.exact = False  # G60
        self.rounding = 0.0  # RNDM, mm
        self.corner_feed: float | None = None  # FRCM, as modal.feed
        self.pole = (0.0, 0.0)  # X, Z of G110 to G112, in the program's frame
        self.last_polar_point: tuple[float, float] | None = None  # last programmed RP in mm and AP in degrees
        self.direction: tuple[float, float] | None = None  # direction of the path at its end, X and Z
        # limits of G25 and G26, within the limit of the spindle
        self.lowest, self.highest = 0.0, setup.limits.max_rpm
        self.area: dict[tuple[str, bool], float] = {}  # G25 (False) and G26 (True), by axis: mm
        self.is_working_area_active = True  # WALIMON
        self.rounded = True  # G450; G451 uses the intersection
        self.round_ends = False  # KONT; NORM approaches in a straight line
        self.threads: tuple[Block, ...] = ()  # blocks of the active thread chain
        self.tap_lead_mm = 0.0  # K of G331, mm
        self.lead_change, self.end_lead, self.start_revolutions = 0.0, 0.0, 0.0  # of G34, G35 and SF
        self.names: list[str] = []  # names of tools that are not in the table, in order of use
        # a position was read after a program stop, at which the operator may move the axes
        self.is_after_program_stop = self.is_position_assumed = False
        self.logged_functions: set[str] = set()  # functions whose notes and warnings were already logged
        self.variables = Variables()
        self.variables.r_parameters.update((f"R{number}", value) for number, value in setup.r.items())
        self.modal_call_line: LexedBlock | None = None  # of MCALL
        self.transformation: ActivePlane | None = None  # TRANSMIT or TRACYL
        self.master = 1  # SETMS: with 2, S, M3 and G95 apply to the live tool
        self.live_speed_rpm = 0.0  # S of the live tool, rpm
        self.live_rpm = 0.0  # signed speed of the live tool
        wraps = setup.limits.is_c_enabled and setup.limits.is_c_modulo
        slide = setup.limits.is_c_enabled and setup.limits.is_c_linear
        self.modal = ModalState(
            absolute=True,
            metric=True,
            diameter=True,
            rapid_rate=0.0,
            is_c_axis_modulo=wraps,
            is_c_linear=slide,
        )

    def set_modal_state(self, modal: ModalState) -> None:
        """Set the modal state unless it equals the current state.

        Consecutive blocks with equal states therefore share one object.
        """
        if modal != self.modal:
            self.modal = modal

    def derive_offsets(self) -> None:
        """Update the offsets in the modal state from cutting edge, settable offset and programmed frame."""
        one, other, edge = self.settable, self.programmed_frame, self.edge
        self.set_modal_state(
            self.modal._replace(
                tool_offset_x=edge.x, tool_offset_z=edge.z, zero_offset_x=one.x, zero_offset_z=one.z,
                frame_shift_x=other.shift_x, frame_shift_z=other.shift_z, offset_c=one.c + other.shift_c,
            )
        )  # fmt: skip

    def length(self, statement: Statement, word: Word) -> float:
        """Return the length of a word in mm, which is converted from inches under G70."""
        return self.number(statement, word) * (1.0 if self.modal.metric else MM_PER_INCH)

    def third(self, statement: Statement, word: Word) -> float:
        """Return the value of a word of the third axis in degrees, or in mm for a linear axis."""
        return self.length(statement, word) if self.modal.is_c_linear else self.number(statement, word)

    def number(self, statement: Statement, word: Word) -> float:
        """Return the number of a word or the value of its formula.

        Raises ProgramError if the formula has no value, or if its value is outside the limits of the word.
        """
        value = self.compute_word_value(statement, word)
        if word.value is not None:
            return value
        limits = None if is_variable(word.name) else find_violated_limits(word.name, value)
        if limits is not None:
            text = Message(
                "{word} results in {value}, which is out of range.", word=word.text, value=f"{value:g}"
            )
            raise statement.make_error(word, "out-of-range", text, make_limit_hint(word.name, limits))
        return value

    def compute_word_value(self, statement: Statement, word: Word) -> float:
        """Return the number of a word or the value of its formula, without a check of the word's limits.

        Raises ProgramError if the formula has no value.
        """
        if word.value is not None:
            return word.value
        assert word.formula is not None
        return self.evaluate_formula(
            word.formula, lambda code, text, hint: statement.make_error(word, code, text, hint)
        )

    def evaluate_formula(self, formula: Formula, make_error: ErrorFactory) -> float:
        """Return the value of a formula.

        ``make_error`` creates the error from a code, a text and a hint.
        """

        def get_parameter_value(asked: Parameter) -> float:
            if asked.letters.startswith("$"):
                axis = get_position_axis(asked.letters)
                read = (
                    self.position(axis) if axis else read_system_value(asked.letters, self.modal, self.edge)
                )
                if read is not None:
                    self.is_position_assumed = self.is_position_assumed or bool(
                        axis and self.is_after_program_stop
                    )
                    return read
            try:
                return self.variables.get_value(
                    asked,
                    lambda index: compute_formula(index, get_parameter_value, make_no_value_error),
                    make_error,
                )
            except ProgramError as problem:
                if problem.diagnostic.code != UNSET_PARAMETER_CODE:
                    raise
                self._warn_unset(problem.diagnostic)
                return 0.0

        def make_no_value_error(_column: int, why: str) -> ProgramError:
            error = make_error("arithmetic", Message("{what}.", what=why), "Correct the formula.")
            return (
                ProgramError(add_assumptions(error.diagnostic, PROGRAM_STOP_ASSUMPTION))
                if self.is_position_assumed
                else error
            )

        return compute_formula(formula, get_parameter_value, make_no_value_error)

    def log_finding(self, finding: Diagnostic) -> None:
        """Log a finding of the block that is being executed, at its location in the main file.

        Findings of buffered blocks must not use this method, because another file may be active.
        """
        self.log.add_finding(self.call_site.relocate_finding(finding), finding)

    def _warn_unset(self, finding: Diagnostic) -> None:
        """Log a warning, once per R parameter, that the parameter has no value and is treated as 0."""
        if (
            finding.hint not in self.logged_functions
        ):  # the hint identifies the parameter, independent of the line
            self.logged_functions.add(finding.hint)
            self.log_finding(replace(finding, severity=Severity.WARNING))

    def compute_rpm_at_radius(self, x: float) -> float:
        """Return the commanded signed speed in rpm with the tip at radius ``x``.

        The radius is in the program frame, in mm. The speed is 0 if the spindle is stopped.
        """
        modal = self.modal
        if not modal.spindle:
            return 0.0
        highest = self.highest
        if modal.css:
            return modal.compute_surface_rpm(x, highest)
        most = highest if modal.max_css_rpm is None else min(highest, modal.max_css_rpm)
        return modal.spindle * max(min(modal.rpm, most), self.lowest if modal.rpm else 0.0)

    def position(self, axis: str) -> float | None:
        """Return the position of an axis in the program frame, or None if it is not known.

        X is a diameter or a radius according to DIAMON. C is from 0 to less than 360 degrees if it is a
        modulo axis. The position is unknown in TRANSMIT and TRACYL, under G70, and for other axes.
        """
        modal = self.modal
        if self.transformation is not None or not modal.metric:
            return None
        if axis == self.setup.limits.third_axis_name and self.setup.limits.is_c_enabled:
            c = self.c - modal.offset_c
            return wrap_angle(c) if self.setup.limits.is_c_modulo else c
        x, z = self.programmed_frame.convert_to_program_distance(
            self.x - modal.offset_x, self.z - modal.offset_z
        )
        return {"X": x * (2.0 if modal.diameter else 1.0), "Z": z}.get(axis)

    @property
    def rpm(self) -> float:
        """Return the commanded signed spindle speed at the current position, in rpm."""
        return self.compute_rpm_at_radius(self.x - self.modal.offset_x)

    @property
    def css(self) -> float | None:
        """Return the active surface speed in mm/s, or None if the spindle is stopped or G96 is not active."""
        modal = self.modal
        return modal.surface_speed if modal.css and modal.spindle and modal.surface_speed else None

    def action(self, line: int, text: str, action: Action) -> Block:
        """Return a block that executes an action without motion."""
        self.is_after_program_stop = self.is_after_program_stop or isinstance(action, ProgramStop)
        modal = self.modal
        x, z, c = self.x - modal.offset_x, self.z - modal.offset_z, self.c - modal.offset_c
        return Block(
            n=0,
            line=line,
            kind=BlockKind.DWELL if isinstance(action, Dwell) else BlockKind.ACTION,
            text=text,
            x0=x,
            z0=z,
            c0=c,
            x=x,
            z=z,
            c=c,
            offset_x=modal.offset_x,
            offset_z=modal.offset_z,
            modal=modal,
            rpm=self.rpm,
            css=self.css,
            action=action,
        )


def require_positive_number(statement: Statement, word: Word, value: float, description: str) -> float:
    """Return the number if it is above 0. Raises ProgramError if it is 0 or negative."""
    if value > 0.0:
        return value
    raise statement.make_error(
        word,
        "not-positive",
        Message("{word}: {what} must be greater than 0.", word=word.text, what=description),
        "Correct the value.",
    )
