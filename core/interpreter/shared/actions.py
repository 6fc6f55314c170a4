"""What a block does besides moving the slides: the payload of ``action`` and ``dwell`` blocks."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SpindleRun:
    """M03, M04, S: turn at ``rpm``, negative for M04; with ``surface_speed`` (mm/s) the radius decides."""

    rpm: float
    surface_speed: float | None = None


@dataclass(frozen=True, slots=True)
class SpindleStop:
    """M05; with ``stands`` nothing goes on before the spindle is at rest."""

    stands: bool = False


@dataclass(frozen=True, slots=True)
class SpindleLock:
    """M19, M89, G89: the spindle stops, and its drive holds it as axis C; after M19 it then turns to 0."""

    orient: bool


@dataclass(frozen=True, slots=True)
class SpindleOrient:
    """M19 of Klartext, SPOS: the spindle stops, and its drive holds it at ``angle``, degrees from its index.

    ``sense``: 1 it turns there as M3 does, -1 as M4, 0 by the short way.
    """

    angle: float
    sense: int = 0


@dataclass(frozen=True, slots=True)
class Coolant:
    """M08, M09."""

    on: bool


@dataclass(frozen=True, slots=True)
class Collet:
    """M12 clamps, M13 unclamps."""

    closed: bool


@dataclass(frozen=True, slots=True)
class Output:
    """An M function that the machine file assigns: M25/M26, M15/M16, …"""

    name: str
    on: bool


@dataclass(frozen=True, slots=True)
class ToolChange:
    """T: another offset becomes active; nothing moves."""

    tool: int


@dataclass(frozen=True, slots=True)
class WorkShift:
    """G10: sums into the shift of the next T, mm."""

    x: float
    z: float


@dataclass(frozen=True, slots=True)
class Preset:
    """G92: the current point gets these program coordinates, mm."""

    x: float
    z: float


@dataclass(frozen=True, slots=True)
class ProgramStop:
    """M00, and M01 when ``optional``: wait for Cycle Start, showing ``message`` large."""

    optional: bool
    message: str = ""


@dataclass(frozen=True, slots=True)
class ProgramEnd:
    """M30 (``reset`` the M functions) or M02 (leave them)."""

    reset: bool


@dataclass(frozen=True, slots=True)
class RepeatOff:
    """M31: cancels Cycle Repeat."""


@dataclass(frozen=True, slots=True)
class WaitInput:
    """M91…M94: wait until the terminal is closed (True) or open (False)."""

    terminal: str
    closed: bool


@dataclass(frozen=True, slots=True)
class AskInput:
    """M95, M97: the interpreter is about to ask this input; all motion before it must have ended."""

    terminal: str


@dataclass(frozen=True, slots=True)
class Dwell:
    """G04: seconds at rest."""

    seconds: float


Action = (
    SpindleRun
    | SpindleStop
    | SpindleLock
    | SpindleOrient
    | Coolant
    | Collet
    | Output
    | ToolChange
    | WorkShift
    | Preset
    | ProgramStop
    | ProgramEnd
    | RepeatOff
    | WaitInput
    | AskInput
    | Dwell
)
