"""Homing: the axes that do not know where they are, one after the other in the order of the machine file."""

from __future__ import annotations

from core.executor.machine_context import MachineContext
from core.ports import Stop


class Homing:
    """The homing that is under way, if any."""

    def __init__(self, bench: MachineContext) -> None:
        self._bench = bench
        self._left: list[str] = []
        self._now = ""

    def begin(self, name: str) -> str:
        """Start with one axis, or with all; returns why not, empty when it has begun."""
        axes = self._bench.machine.axes
        if name and name not in {axis.name for axis in axes}:
            return f"this machine has no axis {name} to home"
        lost = [
            axis
            for axis, homed in zip(axes, self._bench.sample.homed, strict=True)
            if not homed and name in {"", axis.name}
        ]
        if not lost:
            return "every axis knows its position"
        self._left = [axis.name for axis in sorted(lost, key=lambda axis: axis.home_order)]
        self._now = ""
        return ""

    def stop(self) -> None:
        """Give it up; the drives brake on their own and hold."""
        self._left, self._now = [], ""
        self._bench.ports.axes.stop(Stop.RAMP_HOLD)

    def step(self) -> bool:
        """Whether all is done. Raises DriverError."""
        bench = self._bench
        homed = dict(zip(bench.ports.axes.axes, bench.sample.homed, strict=True))
        if self._now and not homed[self._now]:
            return False
        if self._left:
            self._now = self._left.pop(0)
            bench.ports.axes.home(self._now)
            return False
        self._now = ""
        return not bench.sample.moving
