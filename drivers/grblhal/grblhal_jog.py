"""Jog as a lease: the controller never has more way than the lease allows, so silence is the stop."""

from __future__ import annotations

import math

from core.message import Message
from core.ports import DriverError
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_dialogue import Ask
from drivers.grblhal.grblhal_gcode import jog_line

_LEAST = 0.002  # mm; less is no way
_ROOM = 0.02  # s; a renewal that is worth less is not sent


class Jogs:
    """``$J`` lines, one unanswered at a time.

    At ``t`` the way ends where a slide that had moved at full speed since the begin would be a lease later:
    none can be further than that, so what is left to run is lease · v, and the braking.
    """

    def __init__(self, controller: Controller) -> None:
        self._c = controller
        self.active = False
        self._axis, self._velocity = "", 0.0
        self._from, self._since = 0.0, 0.0
        self._sent = 0.0  # target of the last line
        self._wanted = 0.0
        self._ask: Ask | None = None

    def move(self, axis: str, velocity: float, lease: float, limits: tuple[float, float] | None) -> bool:
        """Begin or renew; False at the end of the travel."""
        now = self._c.clock.now()
        if not self.active or axis != self._axis or velocity != self._velocity:
            self._begin(axis, velocity, now)
        target = self._from + velocity * (now - self._since + lease)
        if limits is not None:
            target = min(max(target, limits[0]), limits[1])
        if (target - self._from) * math.copysign(1.0, velocity) < _LEAST:
            self.active = False
            return False
        self._wanted, self.active = target, True
        self.pump()
        return True

    def step(self, axis: str, target: float, speed: float) -> None:
        """One jog from rest to rest."""
        self._begin(axis, speed, self._c.clock.now())
        self._wanted, self.active = target, True
        self.pump()

    def pump(self) -> None:
        """Send the way that has been added, when the last line has been answered."""
        if not self.active or (self._ask is not None and not self._ask.done):
            return
        added = abs(self._wanted - self._sent)
        if added < max(_LEAST, _ROOM * abs(self._velocity)) and self._ask is not None:
            return
        self._sent = self._wanted
        target = self._wanted + self._c.origin.get(self._axis, 0.0)
        self._ask = self._c.send(jog_line(self._axis, target, abs(self._velocity)))

    def rested(self) -> None:
        """The controller says that nothing is left."""
        if self._ask is None or self._ask.done:
            self.forget()

    def forget(self) -> None:
        """Nothing is jogged any more."""
        self.active, self._ask = False, None

    def _begin(self, axis: str, velocity: float, now: float) -> None:
        place = self._c.position.get(axis)
        if place is None:
            raise DriverError(
                Message("the controller does not have an axis {axis} to jog", axis=axis), "controller-refuses"
            )
        if self.active:
            # Another speed or direction: from where the way that it has ends.
            place = self._sent
        self._axis, self._velocity = axis, velocity
        self._from = self._sent = place
        self._since, self._ask = now, None
