"""Actions of ``action`` and ``dwell`` blocks: everything that a block does other than move an axis."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SpindleRun:
    """Run the spindle (M03, M04, S) at ``rpm``, which is negative for M04.

    With ``surface_speed`` (mm/s), the rpm follows the radius of the cut.
    """

    rpm: float
    surface_speed: float | None = None


@dataclass(frozen=True, slots=True)
class SpindleStop:
    """Stop the spindle (M05). With ``stands``, the next block waits until the spindle is at rest."""

    stands: bool = False


@dataclass(frozen=True, slots=True)
class SpindleLock:
    """Stop the spindle and hold it as the C axis (M19, M89, G89).

    With ``orient`` (M19), C then turns to 0.
    """

    orient: bool


@dataclass(frozen=True, slots=True)
class SpindleOrient:
    """Stop the spindle (M19 of Klartext, SPOS) and hold it at ``angle``, in degrees from its index.

    ``sense`` is the direction of rotation: 1 as for M3, -1 as for M4, 0 by the shorter distance.
    """

    angle: float
    sense: int = 0


@dataclass(frozen=True, slots=True)
class Coolant:
    """Turn the coolant on (M08) or off (M09)."""

    on: bool


@dataclass(frozen=True, slots=True)
class Collet:
    """Clamp (M12) or unclamp (M13) the collet."""

    closed: bool


@dataclass(frozen=True, slots=True)
class Output:
    """Switch the output that the machine file assigns to an M function, such as M25 or M26."""

    name: str
    on: bool


@dataclass(frozen=True, slots=True)
class ToolChange:
    """Activate another tool offset (T). No axis moves."""

    tool: int


@dataclass(frozen=True, slots=True)
class WorkShift:
    """Add to the work shift (G10) that the next T activates, in mm with X as a radius."""

    x: float
    z: float


@dataclass(frozen=True, slots=True)
class Preset:
    """Assign these program coordinates to the present position (G92), in mm with X as a radius."""

    x: float
    z: float


@dataclass(frozen=True, slots=True)
class ProgramStop:
    """Wait for Cycle Start (M00, or M01 if ``optional``) and show ``message`` in large type."""

    optional: bool
    message: str = ""


@dataclass(frozen=True, slots=True)
class ProgramEnd:
    """End the program: M30 resets the M functions (``reset``), and M02 leaves them as they are."""

    reset: bool


@dataclass(frozen=True, slots=True)
class RepeatOff:
    """Cancel Cycle Repeat (M31)."""


@dataclass(frozen=True, slots=True)
class WaitInput:
    """Wait until the terminal is closed (``closed`` is True) or open (M91 to M94)."""

    terminal: str
    closed: bool


@dataclass(frozen=True, slots=True)
class AskInput:
    """Stop all motion, because the interpreter reads this input next (M95, M97)."""

    terminal: str


@dataclass(frozen=True, slots=True)
class Dwell:
    """Wait at rest for a number of seconds (G04)."""

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
