"""A spindle that HAL brings to an angle, by the pins of LinuxCNC's component ``orient``.

How it turns there, and what makes ``is_oriented`` come on, is said by the HAL file alone.
"""

from __future__ import annotations

from core.message import Message
from core.ports import DriverError
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_link import HalLink
from drivers.hal.hal_terminals import HalSpindle

_MODES = {0: 0, 1: 1, -1: 2}
_SETTLES = 0.05  # s from the rising of ``orient`` until ``is_oriented`` is that of the new angle
_STANDS = 2.0  # rpm


class HalOrientation:
    """``core.ports.SpindleOrientation``. ``tick`` with the rounds of the loop."""

    def __init__(self, axes: HalAxes, spindle: HalSpindle, link: HalLink) -> None:
        self._axes, self._spindle, self._link = axes, spindle, link
        self._order: int | None = None
        self._since: float | None = None  # when HAL was first seen to go there

    def orient(self, angle: float, sense: int = 0) -> None:
        """Bring it to an angle. Raises DriverError while it turns, with a fault or an open chain."""
        if why := self._spindle.fault() or self._axes.fault:
            raise DriverError(Message("the spindle stays off: {problem}", problem=why), "spindle-off")
        if self._link.told.get("ok") is not True:
            raise DriverError(
                "the spindle stays off because the E-stop chain is open; press Reset", "spindle-off"
            )
        if self._order is None and (self._spindle.ordered or abs(self._spindle.measured()) >= _STANDS):
            raise DriverError(
                "the spindle cannot be oriented while it is turning; stop it first", "spindle-off"
            )
        self._since = None
        self._order = self._link.say("orient", on=True, angle=angle, mode=_MODES[sense])

    def release(self) -> None:
        """Hold it no longer."""
        self._order = self._since = None
        if not self._link.lost:
            self._link.say("orient", on=False)

    def oriented(self) -> bool:
        """Whether HAL says so, and of the angle that was asked for last."""
        since = self._since
        if since is None or self._axes.now() < since + _SETTLES:
            return False
        return self._link.bit("spindle.is_oriented")

    def tick(self) -> None:
        """See whether HAL goes to the angle, and whether something has let it go."""
        if self._order is None or not self._link.done(self._order):
            return
        goes = self._link.told.get("orients") is True
        if goes and self._since is None:
            self._since = self._axes.now()
        elif not goes and self._since is not None:
            self._order = self._since = None
