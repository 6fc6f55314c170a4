"""What a line of Klartext holds, once read. Numbers as written: the program's unit, F as programmed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from core.language.diagnostics import Diagnostic
from core.language.formulas import Formula, Number, Operation, Parameter


class Value(NamedTuple):
    """A number, or the content of a parameter Q, QL or QR. ``column`` is where it stands, from 1."""

    number: float
    q: int | None = None
    negative: bool = False  # the sign before Q
    column: int = 0
    kind: str = "Q"

    @property
    def formula(self) -> Formula:
        """The same as a formula."""
        if self.q is None:
            return Number(self.number)
        made = Parameter(self.kind, self.q, self.column)
        return Operation("negative", (made,), self.column) if self.negative else made


class AxisWord(NamedTuple):
    """``X+10`` or ``IX+10``."""

    axis: str
    value: Value
    incremental: bool = False
    column: int = 0


class Feed(NamedTuple):
    """``F200``, ``FQ5``, ``FMAX`` or ``F AUTO``; ``FU0.1`` and ``FZ0.05`` count a revolution or a tooth."""

    kind: str  # "value", "max" or "auto"
    value: Value | None = None
    column: int = 0
    per: str = ""  # U or Z; empty: a minute, under M136 a revolution


class Retract(NamedTuple):
    """``MB50`` or ``MB MAX`` (None)."""

    distance: Value | None = None
    column: int = 0


class MCode(NamedTuple):
    """``M3``; M128 may carry a feed, M103 its factor, M140 carries its way and may carry a feed."""

    number: int
    column: int = 0
    retract: Retract | None = None
    feed: Feed | None = None


@dataclass(frozen=True, slots=True)
class Begin:
    """``BEGIN PGM name MM``."""

    name: str
    inch: bool


@dataclass(frozen=True, slots=True)
class End:
    """``END PGM name MM``."""

    name: str
    inch: bool


@dataclass(frozen=True, slots=True)
class BlankForm:
    """``BLK FORM 0.1 Z X Y Z`` (the least corner, with the tool axis) or ``0.2`` (the greatest)."""

    part: int
    corner: tuple[AxisWord, ...]
    tool_axis: str = ""


@dataclass(frozen=True, slots=True)
class RoundBlank:
    """``BLK FORM CYLINDER Z R50 L100 DIST+5``: ``above`` is how far it reaches over the datum."""

    tool_axis: str
    radius: Value
    length: Value
    above: Value


@dataclass(frozen=True, slots=True)
class ToolCall:
    """``TOOL CALL 1 Z S3000 F500 DL+0.1``; a call without a tool changes speed or feed only."""

    tool: int | str | Value | None = None  # a Value: the number is in a Q parameter
    tool_axis: str = ""
    speed: Value | None = None
    feed: Value | None = None
    length: Value | None = None  # DL
    radius: Value | None = None  # DR
    column: int = 0  # of the tool
    feed_per: str = ""  # U or Z of FU and FZ
    cutting_speed: Value | None = None  # S(VC = 120), m/min


@dataclass(frozen=True, slots=True)
class Move:
    """A path function: ``L X+10 IY-5 R0 F200 M3``, ``CR X+10 Y+0 R+5 DR-``, ``APPR CT X+0 Y+0 CCA90 R+5 RL``.

    ``words`` are those besides axes, by name: PR and PA (a pole's radius and angle), R, CCA, LEN.
    """

    axes: tuple[AxisWord, ...] = ()
    compensation: str = ""  # 0, L or R of R0, RL, RR; empty: as before
    feed: Feed | None = None
    codes: tuple[MCode, ...] = ()
    form: str = "L"
    words: tuple[AxisWord, ...] = ()
    turn: str = ""  # + or - of DR
    column: int = 1

    def word(self, name: str) -> AxisWord | None:
        """The axis or other word of this name."""
        return next((word for word in (*self.axes, *self.words) if word.axis == name), None)


@dataclass(frozen=True, slots=True)
class Pole:
    """``CC X+50 Y+50``; without axes the point where the tool stands."""

    axes: tuple[AxisWord, ...] = ()
    column: int = 1


@dataclass(frozen=True, slots=True)
class Corner:
    """``RND R5 F100`` or ``CHF 2``: the corner between the path before and the one behind."""

    form: str  # RND or CHF
    size: Value
    feed: Feed | None = None
    column: int = 1


@dataclass(frozen=True, slots=True)
class Codes:
    """A block of M functions alone."""

    codes: tuple[MCode, ...]


@dataclass(frozen=True, slots=True)
class Datum:
    """``TRANS DATUM AXIS …``, ``TRANS DATUM RESET`` (no axes), or a block of cycle 7."""

    axes: tuple[AxisWord, ...] = ()
    reset: bool = False
    cycle: int | None = None  # n of CYCL DEF 7.n
    text: str = ""  # of CYCL DEF 7.0
    row: Value | None = None  # of the datum table
    column: int = 0
    table: str = ""  # its file, where the block names one


@dataclass(frozen=True, slots=True)
class Label:
    """``LBL 1``, ``LBL "NAME"``; ``LBL 0`` ends a subprogram."""

    name: int | str
    column: int = 0


@dataclass(frozen=True, slots=True)
class Call:
    """``CALL LBL 1``, with ``REP n`` a repeat of the section behind the label."""

    name: int | str
    repeat: Value | None = None
    column: int = 0


@dataclass(frozen=True, slots=True)
class Assign:
    """``Q5 = +10``, ``Q5 = Q1 * SIN 30``, ``FN 3: Q5 = +Q1 * +2``."""

    q: int
    formula: Formula
    column: int = 0
    kind: str = "Q"  # Q, QL or QR


@dataclass(frozen=True, slots=True)
class Jump:
    """``FN 9: IF +Q1 EQU +5 GOTO LBL 3``; ``condition`` is the whole comparison."""

    condition: Formula
    name: int | str
    column: int = 0


@dataclass(frozen=True, slots=True)
class SystemRead:
    """``FN 18: SYSREAD Q5 = ID50 NR1 IDX5``: group, number and index of a figure of the control."""

    q: int
    group: Formula
    number: Formula
    index: Formula | None = None
    column: int = 0
    kind: str = "Q"


@dataclass(frozen=True, slots=True)
class SystemWrite:
    """``FN 17: SYSWRITE ID50 NR4 IDX5 = +0``: what is to stand there from now on."""

    group: Formula
    number: Formula
    index: Formula | None
    content: Formula
    column: int = 0


@dataclass(frozen=True, slots=True)
class ErrorMessage:
    """``FN 14: ERROR = 1000``: the program itself tells a fault, and stops."""

    number: int
    column: int = 0


@dataclass(frozen=True, slots=True)
class Unheeded:
    """A block that steers nothing here, such as ``FN 16: F-PRINT``; ``what`` names it."""

    what: str
    column: int = 0


class CycleValue(NamedTuple):
    """``Q200=+2``, or a part ``Q`` 0 of an old cycle's line with the word before it."""

    q: int
    formula: Formula
    column: int


@dataclass(frozen=True, slots=True)
class Cycle:
    """``CYCL DEF 200 DRILLING Q200=+2 …``: a cycle from 200 on with its parameters."""

    number: int
    values: tuple[CycleValue, ...] = ()
    column: int = 0


@dataclass(frozen=True, slots=True)
class GlobalDef:
    """``GLOBAL DEF 100 GENERAL Q200=+2 …``: what ``Q200=PREDEF`` of a cycle behind it means."""

    values: tuple[CycleValue, ...]
    column: int = 0


@dataclass(frozen=True, slots=True)
class CycleLine:
    """``CYCL DEF 1.2 DEPTH-15``: line ``part`` of a cycle under 200, with its words and numbers in order."""

    number: int
    part: int
    words: tuple[AxisWord, ...] = ()
    feed: Feed | None = None
    turn: str = ""  # + or - of DR
    text: str = ""  # what is no number
    column: int = 0


@dataclass(frozen=True, slots=True)
class CycleCall:
    """``CYCL CALL M3``, ``CYCL CALL POS X+10 Y+10 Z+0 F500``."""

    axes: tuple[AxisWord, ...] = ()
    feed: Feed | None = None
    codes: tuple[MCode, ...] = ()
    column: int = 0
    pattern: bool = False  # CYCL CALL PAT


class PatternPart(NamedTuple):
    """``ROW1 (X+10 Y+0 D+8 NUM5 ROT+0 Z+0)``."""

    form: str  # POS ROW PAT FRAME CIRC PITCHCIRC
    words: tuple[AxisWord, ...]
    column: int


@dataclass(frozen=True, slots=True)
class PatternDef:
    """``PATTERN DEF`` with its parts: where CYCL CALL PAT runs the cycle."""

    parts: tuple[PatternPart, ...]
    column: int = 0


class ContourPart(NamedTuple):
    """The subprogram of a contour; ``pocket`` False is an island, None is said by RL and RR (cycle 14)."""

    label: int | str
    pocket: bool | None
    file: str = ""  # a program of its own instead of a subprogram


@dataclass(frozen=True, slots=True)
class ContourDef:
    """``CONTOUR DEF P1 = LBL 1 I2 = LBL 2``: what cycle 14 does, with pockets and islands said."""

    parts: tuple[ContourPart, ...]
    column: int = 0


@dataclass(frozen=True, slots=True)
class Selection:
    """``SEL TABLE "N.D"``, ``SEL PATTERN "P.PNT"``, ``SEL PGM "A.H"``: ``kind`` is the word behind SEL."""

    kind: str
    name: str
    column: int = 0


@dataclass(frozen=True, slots=True)
class ProgramCall:
    """``CALL PGM name``; without a name the one of SEL PGM (``CALL SELECTED PGM``)."""

    name: str
    column: int = 0


@dataclass(frozen=True, slots=True)
class ToolDef:
    """``TOOL DEF 5 L+10 R+5`` in the program's unit; without both a tool to be got ready."""

    tool: int | str
    length: Value | None = None
    radius: Value | None = None
    column: int = 0


@dataclass(frozen=True, slots=True)
class Transform:
    """``TRANS MIRROR AXIS X``, ``TRANS ROTATION ROT+30``, ``TRANS SCALE SCL0.5``, RESET, cycles 8 10 11.

    ``value`` is the angle or the factor; None with no ``axes`` ends it.
    """

    form: str  # MIRROR, ROTATION or SCALE
    value: Value | None = None
    axes: str = ""  # of MIRROR
    incremental: bool = False
    column: int = 0


@dataclass(frozen=True, slots=True)
class TipControl:
    """``FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS`` and ``FUNCTION RESET TCPM``."""

    on: bool
    column: int = 0


@dataclass(frozen=True, slots=True)
class Stop:
    """``STOP``, with M functions where there are."""

    codes: tuple[MCode, ...] = ()


@dataclass(frozen=True, slots=True)
class Heading:
    """``* text``: structures the program and does nothing."""

    text: str


@dataclass(frozen=True, slots=True)
class Positioning:
    """How the rotary axes are brought to a plane, and which of two ways to stand is asked for."""

    way: str = ""  # MOVE, TURN or STAY
    distance: Value | None = None  # DIST
    retract: Retract | None = None  # MB
    feed: Feed | None = None
    side: str = ""  # SYM+ SYM- SEQ+ SEQ-
    rotation: str = ""  # COORD ROT or TABLE ROT


@dataclass(frozen=True, slots=True)
class Plane:
    """A PLANE block. ``words`` by name: axes (AXIAL), P1X… (POINTS), SPA… (SPATIAL, RELATIV), RESET none."""

    form: str  # AXIAL POINTS SPATIAL RELATIV RESET
    words: tuple[AxisWord, ...] = ()
    positioning: Positioning = Positioning()
    column: int = 0


Node = (
    Begin
    | End
    | BlankForm
    | RoundBlank
    | ToolDef
    | ToolCall
    | Move
    | Pole
    | Corner
    | Codes
    | Datum
    | Transform
    | Label
    | Call
    | ProgramCall
    | Selection
    | Assign
    | Jump
    | SystemRead
    | SystemWrite
    | ErrorMessage
    | Unheeded
    | Cycle
    | GlobalDef
    | CycleLine
    | CycleCall
    | PatternDef
    | ContourDef
    | TipControl
    | Stop
    | Heading
    | Plane
)


class KlartextLine(NamedTuple):
    """One line. ``node`` is None where there is nothing to do, or ``error`` says why it cannot be read."""

    number: int
    node: Node | None = None
    block: int | None = None  # its own number, as written
    skip: bool = False
    comment: str | None = None
    error: Diagnostic | None = None
    code: str = ""  # the block as written, without number, skip sign and comment
