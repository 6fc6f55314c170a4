"""The spindle held at an angle by its own drive: asked for, waited for, watched, let go."""

from __future__ import annotations

from core.executor.raised_alarm import AlarmError
from core.message import Message
from core.ports import SpindleOrientation


class Orientation:
    """One angle at a time. Whoever lets the spindle turn, or stops it, lets the angle go first."""

    def __init__(self, port: SpindleOrientation | None, rpm: float) -> None:
        """``rpm``: how fast the drive may turn on its way to an angle."""
        self._port = port
        self._rpm = rpm
        self._asked: tuple[float, int] | None = None
        self._reached = False

    @property
    def at(self) -> float | None:
        """Degrees at which the spindle is held; None while it is not."""
        return self._asked[0] if self._asked is not None and self._reached else None

    @property
    def on_its_way(self) -> bool:
        """Whether the drive turns it to an angle."""
        return self._asked is not None and not self._reached

    @property
    def turns_at(self) -> float:
        """rpm at which the spindle may turn without a command: on its way to an angle."""
        return self._rpm if self._asked is not None else 0.0

    def bring(self, angle: float, sense: int) -> bool:
        """Ask for an angle, once; True as soon as the spindle is held there. Raises DriverError."""
        if self._port is None:
            raise AlarmError("spindle-orient", "this machine cannot orient the spindle to an angle")
        if self._asked != (angle, sense):
            self._reached = False
            self._port.orient(angle, sense)
            self._asked = angle, sense
        self._reached = self._reached or self._port.oriented()
        return self._reached

    def let_go(self) -> None:
        """The angle counts no more, reached or not."""
        asked, self._asked, self._reached = self._asked, None, False
        if asked is not None and self._port is not None:
            self._port.release()

    def look(self) -> None:
        """Every tick. Raises AlarmError where the drive no longer holds the angle that it had reached."""
        if self._reached and self._port is not None and not self._port.oriented():
            assert self._asked is not None
            self._reached = False
            raise AlarmError(
                "spindle-orient",
                Message(
                    "the spindle drive no longer holds the spindle at {requested} degrees",
                    requested=f"{self._asked[0]:g}",
                ),
            )
