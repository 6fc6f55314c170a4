"""What a line of Klartext holds, once read. Numbers as written: the program's unit, F as programmed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from core.language.diagnostics import Diagnostic


class Value(NamedTuple):
    """A number, or the content of a Q parameter. ``column`` is where it stands, from 1."""

    number: float
    q: int | None = None
    negative: bool = False  # the sign before Q
    column: int = 0


class AxisWord(NamedTuple):
    """``X+10`` or ``IX+10``."""

    axis: str
    value: Value
    incremental: bool = False
    column: int = 0


class Feed(NamedTuple):
    """``F200``, ``FQ5``, ``FMAX`` or ``F AUTO``."""

    kind: str  # "value", "max" or "auto"
    value: Value | None = None
    column: int = 0


class Retract(NamedTuple):
    """``MB50`` or ``MB MAX`` (None)."""

    distance: Value | None = None
    column: int = 0


class MCode(NamedTuple):
    """``M3``; M128 may carry a feed, M140 carries its way and may carry a feed."""

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
class ToolCall:
    """``TOOL CALL 1 Z S3000 F500 DL+0.1``; a call without a tool changes speed or feed only."""

    tool: int | str | None = None
    tool_axis: str = ""
    speed: Value | None = None
    feed: Value | None = None
    length: Value | None = None  # DL
    radius: Value | None = None  # DR
    column: int = 0  # of the tool


@dataclass(frozen=True, slots=True)
class Move:
    """``L X+10 IY-5 R0 F200 M3``."""

    axes: tuple[AxisWord, ...] = ()
    r0: bool = False
    feed: Feed | None = None
    codes: tuple[MCode, ...] = ()


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


@dataclass(frozen=True, slots=True)
class Label:
    """``LBL 1``, ``LBL "NAME"``; ``LBL 0`` ends a subprogram."""

    name: int | str
    column: int = 0


@dataclass(frozen=True, slots=True)
class Call:
    """``CALL LBL 1``, with ``REP n`` a repeat of the section behind the label."""

    name: int | str
    repeat: int | None = None
    column: int = 0


@dataclass(frozen=True, slots=True)
class Assign:
    """``Q5 = +10``; ``spelled`` with FN 0."""

    q: int
    value: Value
    spelled: bool = False
    column: int = 0


@dataclass(frozen=True, slots=True)
class Stop:
    """``STOP``."""


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
    Begin | End | BlankForm | ToolCall | Move | Codes | Datum | Label | Call | Assign | Stop | Heading | Plane
)


class KlartextLine(NamedTuple):
    """One line. ``node`` is None where there is nothing to do, or ``error`` says why it cannot be read."""

    number: int
    node: Node | None = None
    block: int | None = None  # its own number, as written
    skip: bool = False
    comment: str | None = None
    error: Diagnostic | None = None
