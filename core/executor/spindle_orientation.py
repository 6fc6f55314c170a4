"""Orientation of the spindle by its drive: request, wait, supervision and release."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from core.executor.raised_alarm import AlarmError
from core.faults import SPINDLE_TURNS
from core.message import Message
from core.ports import DriverError, OrientingSpindle


def try_standstill_command(command: Callable[[], None]) -> bool:
    """Run a command that requires a stopped spindle; return whether the drive has accepted it.

    The drive may reject the command because the spindle still turns, although slower than ``stop_below`` of
    the machine file. Raises DriverError if the drive rejects it for any other reason.
    """
    try:
        command()
    except DriverError as error:
        if error.reason != SPINDLE_TURNS:
            raise
        return False
    return True


class OrientationControl:
    """Control of the spindle orientation to an angle.

    The orientation must be released before the spindle is turned on or stopped.
    """

    def __init__(self, port: OrientingSpindle | None, rpm: float) -> None:
        """Initialize the control without a requested angle.

        ``rpm`` is the maximum speed of the spindle during orientation.
        """
        self._port = port
        self._rpm = rpm
        self._asked: tuple[float, int] | None = None
        self._reached = False

    @property
    def angle_deg(self) -> float | None:
        """Return the angle in degrees at which the drive holds the spindle, or None if it does not."""
        return self._asked[0] if self._asked is not None and self._reached else None

    @property
    def is_moving(self) -> bool:
        """Return whether the drive is moving the spindle to an angle."""
        return self._asked is not None and not self._reached

    @property
    def max_rpm(self) -> float:
        """Return the maximum speed in rpm during an orientation, or 0 if no angle is requested."""
        return self._rpm if self._asked is not None else 0.0

    def request_angle(self, angle: float, direction: int) -> bool:
        """Request an angle once; return whether the drive holds the spindle at this angle.

        If the drive still considers the spindle as turning, the next call requests the angle again. Raises
        AlarmError if the machine cannot orient the spindle, or DriverError if the drive fails.
        """
        if self._port is None:
            raise AlarmError("spindle-orient", "this machine cannot orient the spindle to an angle")
        if self._asked != (angle, direction):
            self._reached = False
            if not try_standstill_command(partial(self._port.orient_spindle, angle, direction)):
                return False
            self._asked = angle, direction
        self._reached = self._reached or self._port.is_oriented()
        return self._reached

    def release_spindle(self) -> None:
        """Release the requested angle, whether it has been reached or not."""
        asked, self._asked, self._reached = self._asked, None, False
        if asked is not None and self._port is not None:
            self._port.release_spindle()

    def check_angle(self) -> None:
        """Raise AlarmError if the drive no longer holds the angle that the spindle had reached.

        The function is called every tick.
        """
        if self._reached and self._port is not None and not self._port.is_oriented():
            assert self._asked is not None
            self._reached = False
            raise AlarmError(
                "spindle-orient",
                Message(
                    "the spindle drive no longer holds the spindle at {requested} degrees",
                    requested=f"{self._asked[0]:g}",
                ),
            )
