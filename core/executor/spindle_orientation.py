"""Spindle orientation by the drive: request, wait, supervision and release."""

from __future__ import annotations

from core.executor.raised_alarm import AlarmError
from core.message import Message
from core.ports import OrientingSpindle


class OrientationControl:
    """The orientation of the spindle at one angle. It must be released before the spindle turns or stops."""

    def __init__(self, port: OrientingSpindle | None, rpm: float) -> None:
        """Initialize without a requested angle. ``rpm`` is the maximum speed of an orienting spindle."""
        self._port = port
        self._rpm = rpm
        self._asked: tuple[float, int] | None = None
        self._reached = False

    @property
    def angle_deg(self) -> float | None:
        """The angle in degrees at which the drive holds the spindle, or None."""
        return self._asked[0] if self._asked is not None and self._reached else None

    @property
    def is_moving(self) -> bool:
        """True while the drive moves the spindle to an angle."""
        return self._asked is not None and not self._reached

    @property
    def max_rpm(self) -> float:
        """The maximum speed in rpm that an orientation can cause; 0 without a requested angle."""
        return self._rpm if self._asked is not None else 0.0

    def request_angle(self, angle: float, direction: int) -> bool:
        """Request an angle once; return True when the drive holds it. Raises AlarmError or DriverError."""
        if self._port is None:
            raise AlarmError("spindle-orient", "this machine cannot orient the spindle to an angle")
        if self._asked != (angle, direction):
            self._reached = False
            self._port.orient_spindle(angle, direction)
            self._asked = angle, direction
        self._reached = self._reached or self._port.is_oriented()
        return self._reached

    def release(self) -> None:
        """Release the requested angle, whether it has been reached or not."""
        asked, self._asked, self._reached = self._asked, None, False
        if asked is not None and self._port is not None:
            self._port.release_spindle()

    def check_angle(self) -> None:
        """Raise AlarmError if the drive no longer holds the angle that it reached. Called every tick."""
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
