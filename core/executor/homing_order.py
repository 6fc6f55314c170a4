"""Homing: axes that do not know their position, one after the other in the machine file's order."""

from __future__ import annotations

from core.executor.machine_context import MachineContext
from core.message import Message
from core.ports import Stop

_SETTLES = 1.0  # s that the slides may take to stand before the next axis looks for home


class Homing:
    """The homing that is under way, if any."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._left: list[str] = []
        self._now = ""
        self._found_at = 0.0  # when the last one was found, s

    def begin(self, name: str) -> str:
        """Start with one axis, or with all; returns why not, empty when it has begun."""
        axes = self._context.machine.axes
        if name and name not in {axis.name for axis in axes}:
            return Message("this machine has no axis {name} to home", name=name)
        lost = [
            axis
            for axis, homed in zip(axes, self._context.sample.homed, strict=True)
            if not homed and name in {"", axis.name}
        ]
        if not lost:
            return "all axes homed"
        self._left = [axis.name for axis in sorted(lost, key=lambda axis: axis.home_order)]
        self._now = ""
        return ""

    def stop(self) -> None:
        """Give the homing up; the drives brake on their own and hold."""
        self._left, self._now = [], ""
        self._context.ports.axes.stop(Stop.RAMP_HOLD)

    def step(self) -> bool:
        """Every tick: home the next axis when one is done; returns whether all are. Raises DriverError."""
        context = self._context
        homed = dict(zip(context.ports.axes.axes, context.sample.homed, strict=True))
        if self._now and not homed[self._now]:
            self._found_at = context.now
            return False
        if self._left:
            if self._now and context.sample.moving and context.now < self._found_at + _SETTLES:
                return False
            self._now = self._left.pop(0)
            context.ports.axes.home(self._now)
            return False
        self._now = ""
        return not context.sample.moving
