"""One servo axis: position loop with velocity feed-forward, limits, an encoder with steps, and its faults."""

from __future__ import annotations

import math

from drivers.lookalikes.plant_config import SimAxis
from drivers.lookalikes.worn_axis import WornAxis

_SETTLED = 1e-4  # mm or degrees, and per second: below this the slide is put on its setpoint


class Servo:
    """A slide and its drive. Positions are as the control counts them: from home once homed."""

    def __init__(self, axis: SimAxis) -> None:
        self.axis = axis
        self.homed = axis.absolute
        self.switch = 0.0 if axis.absolute else -axis.power_up  # where home is in the present count
        self.p = axis.power_up if axis.absolute else 0.0
        self.v = 0.0
        self.jammed = False
        self.stuck: float | None = None  # reading of an encoder that no longer counts
        self.runaway = 0.0  # speed at which a drive that has gone mad drives it while it has power
        self.worn = WornAxis()
        self.over = 0.0  # seconds outside the following window
        self.load = 0.0  # per cent of what the drive can, signed
        self._wn = 2 * math.pi * axis.bandwidth

    @property
    def reading(self) -> float:
        """Where the slide is, as far as it is measured."""
        if self.stuck is not None:
            return self.stuck
        worn = self.worn
        p = worn.slide if worn.gib else worn.counted(self.p) if worn.deceives else self.p
        return round(p / self.axis.count) * self.axis.count

    @property
    def where(self) -> float:
        """Where the slide really is."""
        return self.worn.slide if self.worn.gib else self.p

    def push(self, way: float) -> None:
        """Somebody moves it."""
        self.p += way
        self.worn.slide += way

    def lead(self, p: float, v: float, a: float) -> float:
        """The setpoint, told with velocity ``v``, that brings the slide to ``p`` although it trails.

        ``follow`` turned round: 2(1 - ff)v/wn for the velocity, a/wn² for the acceleration ``a``.
        """
        return p + (2.0 * (1.0 - self.axis.feed_forward) * v + a / self._wn) / self._wn

    def follow(self, p: float, v: float, dt: float) -> bool:
        """One step of the powered drive towards setpoint ``p`` ``v``; True when the following error trips it.

        Second order, damping 1. Without the whole feed-forward the slide trails by 2(1 - ff)v/wn.
        """
        wn, axis = self._wn, self.axis
        seen = self.p if self.stuck is None and not self.worn.deceives else self._seen()
        limit = axis.amax * axis.reserve
        force = wn * (wn * (p - seen) + 2 * (axis.feed_forward * v - self.v))
        if not -limit <= force <= limit:  # quicker than min and max: this is done three times a millisecond
            force = math.copysign(limit, force)
        self.load = 100.0 * force / limit
        if self.jammed:
            self.v = 0.0
        elif self.runaway:
            self.v = self.runaway
            self.p += self.v * dt
        else:
            speed, top = self.v + force * dt, axis.vmax * 1.1
            self.v = speed if -top <= speed <= top else math.copysign(top, speed)
            self.p += self.v * dt
        if self.worn.gib:
            self.worn.carry(self.p, self.v)
        if abs(p - seen) > axis.following_window:
            self.over += dt
            return self.over > axis.following_time
        self.over = 0.0
        return False

    def _seen(self) -> float:
        """What the drive takes for its place."""
        if self.stuck is not None:
            return self.stuck
        return self.worn.counted(self.p) if self.worn.deceives else self.p

    def roll(self, dt: float) -> None:
        """One step without power: friction stops the slide."""
        drop = 0.5 * self.axis.amax * dt
        self.v = 0.0 if self.jammed or abs(self.v) <= drop else self.v - math.copysign(drop, self.v)
        self.p += self.v * dt
        if self.worn.gib:
            self.worn.carry(self.p, self.v)
        self.over = self.load = 0.0

    def settle(self, p: float) -> bool:
        """At a resting setpoint: snap on it when as good as there; False while still moving."""
        if self.jammed or self.stuck is not None or self.runaway:
            return False
        if abs(self._seen() - p) < _SETTLED and abs(self.v) < _SETTLED * self._wn:
            self.p = self.p if self.worn.deceives else p
            self.v = self.over = self.load = 0.0
            return True
        return False

    def reference(self) -> None:
        """Home is here: count from it."""
        self.push(-self.switch)
        self.switch = 0.0
        self.homed = True

    def power_lost(self) -> None:
        """An encoder that only counts does not know where it is after power was off."""
        self.load = 0.0
        if not self.axis.absolute and self.homed:
            self.homed = False
