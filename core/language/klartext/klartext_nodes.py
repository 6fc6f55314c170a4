"""Parsed Klartext blocks, with numbers as written in the program's unit and F as programmed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from core.language.diagnostics import Diagnostic
from core.language.formulas import Formula
from core.language.klartext.klartext_words import AxisWord, FeedWord, MFunction, RetractWord, Value


@dataclass(frozen=True, slots=True)
class BeginBlock:
    """The block ``BEGIN PGM name MM``."""

    name: str
    is_inch: bool


@dataclass(frozen=True, slots=True)
class EndBlock:
    """The block ``END PGM name MM``."""

    name: str
    is_inch: bool


@dataclass(frozen=True, slots=True)
class BlankCorner:
    """One corner of a rectangular blank.

    ``BLK FORM 0.1 Z X Y Z`` defines the tool axis and the minimum corner. ``BLK FORM 0.2`` defines the
    maximum corner.
    """

    corner_number: int
    axis_words: tuple[AxisWord, ...]
    tool_axis: str = ""


@dataclass(frozen=True, slots=True)
class CylinderBlank:
    """The block ``BLK FORM CYLINDER Z R50 L100 DIST+5``.

    ``height_above_datum`` is the height of the cylinder above the datum (DIST).
    """

    tool_axis: str
    radius: Value
    length: Value
    height_above_datum: Value


@dataclass(frozen=True, slots=True)
class ToolCall:
    """The block ``TOOL CALL 1 Z S3000 F500 DL+0.1``; without a tool, it changes only speed or feed."""

    tool: int | str | Value | None = None  # a Value if the number is in a Q parameter
    tool_axis: str = ""
    speed: Value | None = None
    feed: Value | None = None
    delta_length: Value | None = None  # DL
    delta_radius: Value | None = None  # DR
    corner_radius: Value | None = None  # DR2
    column: int = 0  # of the tool
    feed_unit_letter: str = ""  # U or Z of FU and FZ
    cutting_speed: Value | None = None  # S(VC = 120), m/min


@dataclass(frozen=True, slots=True)
class PathFunction:
    """A path function such as ``L X+10 IY-5 R0 F200 M3`` or ``APPR CT X+0 Y+0 CCA90 R+5 RL``.

    ``words`` contains the words that are neither axis words, compensation, feed nor M functions: PR and PA
    (polar radius and angle), R, CCA and LEN.
    """

    axis_words: tuple[AxisWord, ...] = ()
    compensation: str = ""  # 0, L or R of R0, RL, RR; empty: as before
    feed: FeedWord | None = None
    m_functions: tuple[MFunction, ...] = ()
    function_name: str = "L"
    words: tuple[AxisWord, ...] = ()
    rotation_direction: str = ""  # + or - of DR
    column: int = 1

    def find_word(self, name: str) -> AxisWord | None:
        """Return the axis word or other word with this name, or None if the block lacks the word."""
        return next((word for word in (*self.axis_words, *self.words) if word.axis == name), None)


@dataclass(frozen=True, slots=True)
class Pole:
    """The block ``CC X+50 Y+50``; without axis words, the pole is the current position."""

    axis_words: tuple[AxisWord, ...] = ()
    column: int = 1


@dataclass(frozen=True, slots=True)
class CornerBlock:
    """The block ``RND R5 F100`` or ``CHF 2``.

    The block defines a corner between the previous and the next path element.
    """

    function_name: str  # RND or CHF
    size: Value
    feed: FeedWord | None = None
    column: int = 1


@dataclass(frozen=True, slots=True)
class MFunctionBlock:
    """A block with only M functions."""

    m_functions: tuple[MFunction, ...]


@dataclass(frozen=True, slots=True)
class DatumShift:
    """The block ``TRANS DATUM AXIS …`` or ``TRANS DATUM RESET`` (without axes), or a block of cycle 7."""

    axis_words: tuple[AxisWord, ...] = ()
    is_reset: bool = False
    cycle_number: int | None = None  # n of CYCL DEF 7.n
    text: str = ""  # of CYCL DEF 7.0
    table_row: Value | None = None  # of the datum table
    column: int = 0
    table_name: str = ""  # file of the datum table, if specified in the block


@dataclass(frozen=True, slots=True)
class Label:
    """A label such as ``LBL 1`` or ``LBL "NAME"``.

    ``LBL 0`` ends a subprogram.
    """

    name: int | str
    column: int = 0


@dataclass(frozen=True, slots=True)
class LabelCall:
    """The block ``CALL LBL 1``, which repeats the section after the label if it has ``REP n``."""

    name: int | str
    repeat_count: Value | None = None
    column: int = 0


@dataclass(frozen=True, slots=True)
class Assignment:
    """An assignment such as ``Q5 = +10``, ``Q5 = Q1 * SIN 30`` or ``FN 3: Q5 = +Q1 * +2``."""

    parameter_number: int
    formula: Formula
    column: int = 0
    parameter_kind: str = "Q"  # Q, QL or QR


@dataclass(frozen=True, slots=True)
class ConditionalJump:
    """A jump such as ``FN 9: IF +Q1 EQU +5 GOTO LBL 3``; ``condition`` is the complete comparison."""

    condition: Formula
    name: int | str
    column: int = 0


@dataclass(frozen=True, slots=True)
class SystemRead:
    """The block ``FN 18: SYSREAD Q5 = ID50 NR1 IDX5``, which reads a system value.

    ``group_number``, ``number`` and ``index`` identify the value.
    """

    parameter_number: int
    group_number: Formula
    data_number: Formula
    index: Formula | None = None
    column: int = 0
    parameter_kind: str = "Q"


@dataclass(frozen=True, slots=True)
class SystemWrite:
    """The block ``FN 17: SYSWRITE ID50 NR4 IDX5 = +0``, which sets a system value."""

    group_number: Formula
    data_number: Formula
    index: Formula | None
    new_value: Formula
    column: int = 0


@dataclass(frozen=True, slots=True)
class ErrorMessageBlock:
    """The block ``FN 14: ERROR = 1000``, which reports an error and stops the program."""

    error_number: int
    column: int = 0


@dataclass(frozen=True, slots=True)
class IgnoredBlock:
    """A block without effect on this control, such as ``FN 16: F-PRINT``, with the name of its function."""

    function_name: str
    column: int = 0


class CycleParameter(NamedTuple):
    """A cycle parameter such as ``Q200=+2``. In a cycle numbered below 200, ``parameter_number`` is 0."""

    parameter_number: int
    formula: Formula
    column: int


@dataclass(frozen=True, slots=True)
class CycleDefinition:
    """The definition of a cycle numbered 200 or higher, such as ``CYCL DEF 200 DRILLING Q200=+2 …``."""

    cycle_number: int
    parameters: tuple[CycleParameter, ...] = ()
    column: int = 0


@dataclass(frozen=True, slots=True)
class GlobalDefinition:
    """The block ``GLOBAL DEF 100 GENERAL Q200=+2 …``.

    The block sets the values for ``Q200=PREDEF`` in later cycles.
    """

    parameters: tuple[CycleParameter, ...]
    column: int = 0


@dataclass(frozen=True, slots=True)
class CycleLine:
    """One line of a cycle numbered below 200, such as ``CYCL DEF 1.2 DEPTH-15``.

    ``line_number`` is the number after the decimal point. The words and numbers are in the order of the
    line.
    """

    cycle_number: int
    line_number: int
    words: tuple[AxisWord, ...] = ()
    feed: FeedWord | None = None
    rotation_direction: str = ""  # + or - of DR
    text: str = ""  # text that is not a number
    column: int = 0


@dataclass(frozen=True, slots=True)
class CycleCall:
    """A cycle call such as ``CYCL CALL M3`` or ``CYCL CALL POS X+10 Y+10 Z+0 F500``."""

    axis_words: tuple[AxisWord, ...] = ()
    feed: FeedWord | None = None
    m_functions: tuple[MFunction, ...] = ()
    column: int = 0
    is_pattern_call: bool = False  # CYCL CALL PAT


class PatternPart(NamedTuple):
    """One part of a pattern, such as ``ROW1 (X+10 Y+0 D+8 NUM5 ROT+0 Z+0)``."""

    pattern_kind: str  # POS ROW PAT FRAME CIRC PITCHCIRC
    words: tuple[AxisWord, ...]
    column: int


@dataclass(frozen=True, slots=True)
class PatternDefinition:
    """The block ``PATTERN DEF``, which defines the points for CYCL CALL PAT in one or more parts."""

    parts: tuple[PatternPart, ...]
    column: int = 0


class ContourPart(NamedTuple):
    """The subprogram or program of one contour.

    ``is_pocket`` is False for an island. With cycle 14, it is None, because RL or RR determines whether the
    contour is a pocket.
    """

    label_name: int | str
    is_pocket: bool | None
    file_name: str = ""  # separate program instead of a subprogram


@dataclass(frozen=True, slots=True)
class ContourDefinition:
    """The block ``CONTOUR DEF P1 = LBL 1 I2 = LBL 2``.

    The block is like cycle 14, but also specifies which contours are pockets and which are islands.
    """

    parts: tuple[ContourPart, ...]
    column: int = 0


@dataclass(frozen=True, slots=True)
class SelectionBlock:
    """A block such as ``SEL TABLE "N.D"`` or ``SEL PGM "A.H"``.

    ``selected_kind`` is the word that follows SEL.
    """

    selected_kind: str
    name: str
    column: int = 0


@dataclass(frozen=True, slots=True)
class ProgramCall:
    """The block ``CALL PGM name``, which calls the program of SEL PGM if it has no name."""

    name: str
    column: int = 0


@dataclass(frozen=True, slots=True)
class ToolDefinition:
    """The block ``TOOL DEF 5 L+10 R+5`` in the program's unit.

    Without L and R, the block only prepares the tool.
    """

    tool: int | str
    length: Value | None = None
    radius: Value | None = None
    column: int = 0


@dataclass(frozen=True, slots=True)
class CoordinateTransform:
    """A transformation with TRANS MIRROR, TRANS ROTATION, TRANS SCALE, or cycle 8, 10 or 11.

    ``value`` is the angle or the factor. If ``value`` is None and ``mirrored_axes`` is empty, the
    transformation is reset.
    """

    transformation_kind: str  # MIRROR, ROTATION or SCALE
    value: Value | None = None
    mirrored_axes: str = ""  # of MIRROR
    is_incremental: bool = False
    column: int = 0


@dataclass(frozen=True, slots=True)
class TcpmSwitch:
    """The block ``FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS`` or ``FUNCTION RESET TCPM``."""

    is_on: bool
    column: int = 0


@dataclass(frozen=True, slots=True)
class StopBlock:
    """The block ``STOP``, with optional M functions."""

    m_functions: tuple[MFunction, ...] = ()


@dataclass(frozen=True, slots=True)
class HeadingLine:
    """A comment line ``* text`` that structures the program and has no effect."""

    text: str


@dataclass(frozen=True, slots=True)
class RotaryPositioning:
    """Positioning mode of the rotary axes in a PLANE block.

    The mode includes the selection of one of the two solutions.
    """

    mode: str = ""  # MOVE, TURN or STAY
    rotation_center_distance: Value | None = None  # DIST
    retract: RetractWord | None = None  # MB
    feed: FeedWord | None = None
    solution: str = ""  # SYM+ SYM- SEQ+ SEQ-
    rotation_mode: str = ""  # COORD ROT or TABLE ROT


@dataclass(frozen=True, slots=True)
class PlaneBlock:
    """A PLANE block with its words by name.

    The words are axis words (AXIAL), P1X… (POINTS) or SPA… (SPATIAL and RELATIV). RESET has no words.
    """

    definition_kind: str  # AXIAL POINTS SPATIAL RELATIV RESET
    words: tuple[AxisWord, ...] = ()
    positioning: RotaryPositioning = RotaryPositioning()
    column: int = 0


Node = (
    BeginBlock
    | EndBlock
    | BlankCorner
    | CylinderBlank
    | ToolDefinition
    | ToolCall
    | PathFunction
    | Pole
    | CornerBlock
    | MFunctionBlock
    | DatumShift
    | CoordinateTransform
    | Label
    | LabelCall
    | ProgramCall
    | SelectionBlock
    | Assignment
    | ConditionalJump
    | SystemRead
    | SystemWrite
    | ErrorMessageBlock
    | IgnoredBlock
    | CycleDefinition
    | GlobalDefinition
    | CycleLine
    | CycleCall
    | PatternDefinition
    | ContourDefinition
    | TcpmSwitch
    | StopBlock
    | HeadingLine
    | PlaneBlock
)


class KlartextLine(NamedTuple):
    """One line of a Klartext program.

    ``node`` is None if the line has nothing to execute or if ``error`` contains a syntax error.
    """

    line_number: int
    node: Node | None = None
    block_number: int | None = None  # block number, as written
    is_skippable: bool = False
    comment: str | None = None
    error: Diagnostic | None = None
    block_text: str = ""  # the block as written, without number, skip sign and comment
