"""Actions of elementary blocks that do not move an axis, of the kinds ``action`` and ``dwell``."""

from __future__ import annotations

from typing import Final

from core.plain_value import ValueObject


class SpindleRun(ValueObject):
    """Action of M03, M04 or S that runs the spindle at ``rpm``, which is negative for M04.

    With ``surface_speed`` in mm/s, the spindle speed follows the radius of the cut.
    """

    __slots__ = __match_args__ = ("rpm", "surface_speed")

    def __init__(self, rpm: float, surface_speed_mm_s: float | None = None) -> None:
        self.rpm: Final = rpm
        self.surface_speed: Final = surface_speed_mm_s


class SpindleStop(ValueObject):
    """Action that stops the spindle (M05).

    With ``waits_for_standstill``, the next block waits until the spindle is at rest.
    """

    __slots__ = __match_args__ = ("waits_for_standstill",)

    def __init__(self, waits_for_standstill: bool = False) -> None:
        self.waits_for_standstill: Final = waits_for_standstill


class SpindleLock(ValueObject):
    """Action that stops the spindle and locks it as the C axis (M19, M89, G89).

    With ``orient`` (M19), C then rotates to 0.
    """

    __slots__ = __match_args__ = ("orient",)

    def __init__(self, orient: bool) -> None:
        self.orient: Final = orient


class SpindlePositioning(ValueObject):
    """Action that stops the spindle at an angle and holds it in position (M19 of Klartext, SPOS).

    ``angle`` is in degrees from the spindle index. ``sense`` is the direction of rotation: 1 as for M3, -1
    as for M4, or 0 for the shorter distance.
    """

    __slots__ = __match_args__ = ("angle", "sense")

    def __init__(self, angle: float, sense: int = 0) -> None:
        self.angle: Final = angle
        self.sense: Final = sense


class CoolantSwitch(ValueObject):
    """Action that turns the coolant on (M08) or off (M09)."""

    __slots__ = __match_args__ = ("on",)

    def __init__(self, on: bool) -> None:
        self.on: Final = on


class ColletSwitch(ValueObject):
    """Action that clamps (M12) or unclamps (M13) the collet."""

    __slots__ = __match_args__ = ("closed",)

    def __init__(self, closed: bool) -> None:
        self.closed: Final = closed


class OutputSwitch(ValueObject):
    """Action that switches the output that the machine file assigns to an M function, such as M25 or M26."""

    __slots__ = __match_args__ = ("name", "on")

    def __init__(self, name: str, on: bool) -> None:
        self.name: Final = name
        self.on: Final = on


class ToolChange(ValueObject):
    """Action that activates another tool offset (T) without axis motion."""

    __slots__ = __match_args__ = ("tool",)

    def __init__(self, tool: int) -> None:
        self.tool: Final = tool


class WorkShift(ValueObject):
    """Action of G10 that adds to the work shift, in mm with X as a radius, from the next T on."""

    __slots__ = __match_args__ = ("x", "z")

    def __init__(self, x: float, z: float) -> None:
        self.x: Final = x
        self.z: Final = z


class Preset(ValueObject):
    """Action of G92 that gives the current position new program coordinates, in mm (X as a radius)."""

    __slots__ = __match_args__ = ("x", "z")

    def __init__(self, x: float, z: float) -> None:
        self.x: Final = x
        self.z: Final = z


class ProgramStop(ValueObject):
    """Action that stops the program until Cycle Start is pressed (M00, or M01 if ``optional``).

    ``message`` is shown to the operator in large type.
    """

    __slots__ = __match_args__ = ("optional", "message")

    def __init__(self, optional: bool, message: str = "") -> None:
        self.optional: Final = optional
        self.message: Final = message


class ProgramEnd(ValueObject):
    """Action that ends the program.

    M30 resets the M functions (``reset``), and M02 does not change them.
    """

    __slots__ = __match_args__ = ("reset",)

    def __init__(self, reset: bool) -> None:
        self.reset: Final = reset


class CycleRepeatCancel(ValueObject):
    """Action that cancels Cycle Repeat (M31)."""

    __slots__ = ()


class InputWait(ValueObject):
    """Action that waits until an input terminal is closed (``closed`` is True) or open (M91 to M94)."""

    __slots__ = __match_args__ = ("terminal", "closed")

    def __init__(self, terminal: str, closed: bool) -> None:
        self.terminal: Final = terminal
        self.closed: Final = closed


class InputRead(ValueObject):
    """Action that stops all motion before the interpreter reads an input (M95, M97)."""

    __slots__ = __match_args__ = ("terminal",)

    def __init__(self, terminal: str) -> None:
        self.terminal: Final = terminal


class Dwell(ValueObject):
    """Action that waits for a number of seconds with the axes at rest (G04)."""

    __slots__ = __match_args__ = ("seconds",)

    def __init__(self, seconds: float) -> None:
        self.seconds: Final = seconds


Action = (
    SpindleRun
    | SpindleStop
    | SpindleLock
    | SpindlePositioning
    | CoolantSwitch
    | ColletSwitch
    | OutputSwitch
    | ToolChange
    | WorkShift
    | Preset
    | ProgramStop
    | ProgramEnd
    | CycleRepeatCancel
    | InputWait
    | InputRead
    | Dwell
)
