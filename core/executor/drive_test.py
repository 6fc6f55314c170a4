"""Drive test: one axis plays a step, ramp or sine as long as its lease is renewed, by the rules of a jog.

What is queued already ends in the stop of a lost lease. The whole excursion has to lie within the travel
before anything moves. Nothing is written to a drive.
"""

from __future__ import annotations

import math

from core.executor import drive_test_path
from core.executor.drive_test_path import DriveTestPath, Limits
from core.executor.jog_line import Ramp, room_to_limit
from core.executor.jogging import LONGEST_LEASE, Jogger
from core.executor.machine_context import MachineContext
from core.executor.snapshot import DriveTestState
from core.machine.machine_model import Axis
from core.message import Message
from core.ports import MachinePorts

PLANS = (
    "drive tests are not available because the controller plans its own motion and does not accept setpoints"
)
_ROUND = 1e-9
TICKS = 100.0  # samples a second where the driver has none of its own


def barred(ports: MachinePorts) -> str:
    """Why this machine has no drive tests; empty when it has."""
    return PLANS if ports.blocks is not None else ports.untraced


class DriveTester:
    """The drive test that is under way, if any."""

    def __init__(self, context: MachineContext, jogger: Jogger) -> None:
        self._context, self._jogger = context, jogger
        self._ramps: list[Ramp] = []
        self._lasts = 0.0  # s, of all of them
        self._began = 0.0
        self._until = 0.0  # s from there for which they are queued
        self._number = 0

    @property
    def state(self) -> DriveTestState:
        """For the snapshot."""
        jogger = self._jogger
        return DriveTestState(
            barred(self._context.ports),
            jogger.axis if jogger.testing else "",
            self._number,
            self._began,
            jogger.tested,
            self._rate,
        )

    @property
    def _rate(self) -> float:
        samples = self._context.ports.samples
        return samples.rate if samples is not None else TICKS

    def refusal(self, path: DriveTestPath, lease: float) -> str:
        """Why this test is refused; empty when it may begin."""
        if why := barred(self._context.ports) or self._jogger.missing(path.axis):
            return why
        if not math.isfinite(lease) or lease <= 0.0:
            return "a drive test needs a watchdog time greater than 0"
        return self._not_now(path.axis) or self._no_test(path)

    def _not_now(self, name: str) -> str:
        context = self._context
        if self._jogger.axis:
            return Message("{axis} is still moving", axis=self._jogger.axis)
        if context.signals.hold:
            return "feed hold is pressed"
        if context.spindle.guard_open:
            return "the guard is open"
        if context.spindle.asked or not context.spindle.stopped:
            return "the spindle is turning; stop it first"
        if not context.sample.homed[context.ports.axes.axes.index(name)]:
            return Message(
                "{name} is not homed, so TurnDesk cannot check whether there is enough travel for the test",
                name=name,
            )
        return ""

    def _no_test(self, path: DriveTestPath) -> str:
        axis = self._context.machine.axis(path.axis)
        if axis.rotary:
            return Message("{axis} is a rotary axis; drive tests are only for linear axes", axis=axis.name)
        limits = self._limits(axis)
        return path.refusal(limits) or self._no_room(axis, path, limits)

    def _no_room(self, axis: Axis, path: DriveTestPath, limits: Limits) -> str:
        here = self._context.sample.demand[self._context.ports.axes.axes.index(axis.name)]
        low, high = drive_test_path.reach(path.ramps(limits))
        for way in (low, high):
            if abs(way) > _ROUND and abs(way) > room_to_limit(axis, here, way):
                end = "+" if way > 0.0 else "−"
                return Message(
                    "{axis} must move {distance} mm in the {end} direction for the test, but its travel ends "
                    "before that point",
                    axis=axis.name,
                    distance=f"{abs(way):.3f}",
                    end=end,
                )
        return ""

    def _limits(self, axis: Axis) -> Limits:
        return Limits(self._jogger.top(axis, homed=True), axis.amax, self._rate)

    def begin(self, path: DriveTestPath, lease: float) -> bool:
        """Begin it from rest; False where its lease is over before anything moves. Raises DriverError."""
        self._ramps = path.ramps(self._limits(self._context.machine.axis(path.axis)))
        self._lasts, self._until = drive_test_path.seconds(self._ramps), 0.0
        begins = self._queue(path.axis, lease)
        self._number += begins
        return begins

    def renew(self, lease: float) -> None:
        """Another lease; what is over, or braking already, goes on no more. Raises DriverError."""
        jogger = self._jogger
        if jogger.testing and not jogger.ending and self._until < self._lasts and lease > 0.0:
            self._queue(jogger.axis, lease)

    def look(self) -> None:
        """Once a tick: a test ends where a guard is opened. Raises DriverError."""
        if self._jogger.testing and not self._jogger.ending and self._context.spindle.guard_open:
            self._jogger.stop()

    def _queue(self, name: str, lease: float) -> bool:
        """Queue as much as the lease lasts, and the braking behind it; False where there is nothing left."""
        amax, until = self._context.machine.axis(name).amax, self._context.now + min(lease, LONGEST_LEASE)

        def go(start: float, _p: float, _v: float) -> list[Ramp]:
            if not self._until:
                self._began = start
            if start - self._began > self._until:
                return []  # the lease ran out: it brakes already
            kept = drive_test_path.cut(self._ramps, start - self._began, until - self._began)
            return [*kept, *drive_test_path.braking(kept, amax)]

        plays = self._jogger.play(name, go)
        if plays:
            self._until = min(until - self._began, self._lasts)
            self._jogger.whole(self._until >= self._lasts)
        return plays
