"""One servo axis: position loop with velocity feed-forward, limits, an encoder with steps, and its faults."""

from __future__ import annotations

import math

from drivers.simulators.plant_config import SimAxis
from drivers.simulators.servo_response import AT_REST, Number, Response, ServoLoop, Setpoints
from drivers.simulators.worn_axis import WornAxis

_FEEDS, _CUTS = 0.05, 0.25  # mm/s, and the fraction of the rapid above which nothing is cut
_SETTLED = 1e-4  # mm or degrees, and per second: below this the slide is put on its setpoint


class Servo:
    """A slide and its drive. Positions are as the control counts them: from home once homed."""

    def __init__(self, axis: SimAxis, step: float = 0.001) -> None:
        """``step`` is the interval of the model's grid, s."""
        self.axis = axis
        self._step = step
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
        self.feeds = (_FEEDS, _CUTS * axis.vmax)  # between these speeds it is taken to cut
        self._wn = 2 * math.pi * axis.bandwidth
        self._loop = ServoLoop(self._wn * step, axis.feed_forward) if self._wn * step < 0.5 else None

    @property
    def reading(self) -> float:
        """Where the slide is, as far as it is measured."""
        if self.stuck is not None:
            return self.stuck
        worn = self.worn
        p = worn.slide if worn.gib else worn.counted(self.p) if worn.deceives else self.p
        return round(p / self.axis.count) * self.axis.count

    @property
    def sound(self) -> bool:
        """Whether nothing is wrong with slide, drive or encoder."""
        worn = self.worn
        return not (
            self.jammed or self.runaway or worn.gib or worn.ripple or worn.missed or self.stuck is not None
        )

    @property
    def cuts(self) -> bool:
        """Whether it feeds: much slower than its rapid, which is as near to a cut as this gets."""
        least, most = self.feeds
        return least < abs(self.v) < most

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

    def foresee(self, setpoints: Setpoints, steps: int) -> Response | None:
        """Return how the slide follows ``steps`` setpoints, or None where a fault or a limit may act.

        The bounds are those of ``follow``: the first force exactly, everything else by the sum of its parts.
        """
        loop, axis, dt = self._loop, self.axis, self._step
        if not self.sound or loop is None:
            return None
        p, dp, ddp = setpoints
        if self.p == p and not (self.v or dp or ddp):
            return AT_REST
        response = loop.response(self.p, self.v * dt, setpoints)
        lag, drift, slow, fast = response
        slow, fast = abs(slow), abs(fast)
        if abs(lag) + abs(drift) * steps + slow + fast > axis.following_window:
            return None
        bent = 2.0 * abs(ddp) + slow * loop.slow_bend + fast * loop.fast_bend
        first = self._wn * (self._wn * (p - self.p) + 2.0 * (axis.feed_forward * dp / dt - self.v))
        if max(bent / (dt * dt), abs(first)) > axis.amax * axis.reserve:
            return None
        fastest = max(abs(dp), abs(dp + 2.0 * ddp * steps)) + abs(drift) + slow + fast
        return response if fastest <= axis.vmax * 1.1 * dt else None

    def glide(self, setpoints: Setpoints, response: Response, steps: int) -> None:
        """Move as ``steps`` calls of ``follow`` do, by the response that ``foresee`` returned."""
        self.p, self.v, self.load = self.states(setpoints, response, steps)
        self.over = 0.0

    def states(
        self, setpoints: Setpoints, response: Response, steps: Number
    ) -> tuple[Number, Number, Number]:
        """Return position, velocity and load after ``steps`` grid points, one number or many."""
        assert self._loop is not None
        dt = self._step
        place, moved, bent = self._loop.states(setpoints, response, steps)
        return place, moved / dt, 100.0 * bent / (dt * dt) / (self.axis.amax * self.axis.reserve)

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
