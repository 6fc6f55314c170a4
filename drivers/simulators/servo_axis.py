"""One servo axis: position loop with velocity feed-forward, its drive's limits, encoder, wear and faults.

``Servo.follow`` steps a linear second-order difference equation. While no limit of the drive acts, its
solution is known: a steady part that follows the setpoint, and two decaying modes. One evaluation
(``ServoLoop``) therefore replaces any number of steps; both agree within rounding (1e-9 mm).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeVar

from core.ports import Cam, DriverError, FloatArray, Segments
from drivers.setpoint_queue import check_limits
from drivers.simulators.plant_config import SimAxis

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


# --- The drives' own limits, the last after the control's: setpoints beyond them are refused.


_STANDS = 10.0  # rpm; faster than this the spindle's drive turns, and cannot position
_SLIPS = 1.1  # of an axis' speed: a spindle that asks for more is refused, one that asks for less slips


def check_drives(segments: Segments, servos: Sequence[Servo], rpm: float) -> None:
    """Raises DriverError for setpoints too fast, out of the travel, or of C while the spindle turns."""
    axes = [servo.axis for servo in servos]
    check_limits(segments, axes, [servo.homed for servo in servos], [servo.reading for servo in servos])
    for i, axis in enumerate(axes):
        if axis.name == "C" and not axis.own_drive and abs(rpm) > _STANDS and segments.v[:, i].any():
            raise DriverError(
                "C axis: the spindle is turning at {rpm} rpm, so no setpoints were queued",
                "drive-limits",
                rpm=f"{rpm:.0f}",
            )


def check_cam(cam: Cam, servos: Sequence[Servo], rpm: float) -> None:
    """The same for motion over the turns of a spindle that turns at ``rpm``."""
    by_time = cam.way.v * (abs(rpm) / 60.0 / _SLIPS)
    check_drives(cam.way._replace(v=by_time), servos, rpm)
    if cam.then is not None:
        check_drives(cam.then, servos, rpm)


# --- Wear: a loose gib, and an encoder that counts wrongly once a turn of the screw.


_CREEP = 2.0  # mm/s; slower than this a loose slide sticks and slips
_STICKS = 0.25  # of the play by which the screw winds up further before a slide that sticks breaks loose
TURN = 5.0  # mm of slide for one turn of its screw


class WornAxis:
    """What is wrong between the motor and the place that is told.

    With a loose gib the drive still goes by its motor, but what is measured is the slide: it stays behind by
    half of the play whichever way it goes, so a reversal loses all of it. Below 2 mm/s it sticks until the
    screw has wound up a quarter of the play more, then slips to where it belongs.

    A bad encoder deceives the drive as well. ``ripple`` is the amplitude of an error that comes once a turn,
    as of a disc that is not centred; ``missed`` is what is not counted at one spot of each turn.
    """

    def __init__(self) -> None:
        self.gib = 0.0  # mm of play
        self.ripple = 0.0  # mm
        self.missed = 0.0  # mm
        self.turn = TURN
        self.slide = 0.0  # where the slide is, while the gib is loose

    @property
    def deceives(self) -> bool:
        """Whether the drive is told another place than its motor's."""
        return self.ripple != 0.0 or self.missed != 0.0

    def loosen(self, play: float, p: float) -> None:
        """The gib has ``play`` mm from now on, with the slide at ``p``; 0 sets it again."""
        self.gib, self.slide = play, p

    def counted(self, p: float) -> float:
        """What the encoder says of a motor at ``p``."""
        turns = p / self.turn
        return p + self.ripple * math.sin(2.0 * math.pi * turns) - self.missed * math.floor(turns)

    def carry(self, p: float, v: float) -> None:
        """The motor is at ``p`` now, at the velocity ``v``, and takes the slide along."""
        play = 0.5 * self.gib
        behind = p - self.slide
        if abs(behind) > play * (1.0 + 2.0 * _STICKS if abs(v) < _CREEP else 1.0):
            self.slide = p - math.copysign(play, behind)


# --- Closed-form response of the servo to setpoints of constant acceleration.


Number = TypeVar("Number", float, FloatArray)


class Setpoints(NamedTuple):
    """Setpoints of one axis on the model's grid: ``p + dp * k + ddp * k * k`` at grid point ``k``."""

    p: float
    dp: float
    ddp: float


class Response(NamedTuple):
    """Position minus setpoint at grid point ``k``: ``lag + drift * k + slow * slow_mode**k + ...``."""

    lag: float
    drift: float
    slow: float
    fast: float


AT_REST = Response(0.0, 0.0, 0.0, 0.0)


class ServoLoop:
    """Difference equation of a position loop with damping 1.

    ``stiffness`` is the natural frequency times the step; ``feed_forward`` is the fraction of the velocity
    that the drive is given. Raises ValueError where the loop would oscillate (stiffness of 0.5 and more).
    """

    def __init__(self, stiffness: float, feed_forward: float) -> None:
        if not 0.0 < stiffness < 0.5:
            raise ValueError(f"stiffness {stiffness}: must be between 0 and 0.5")
        w = self._w = stiffness
        self._missing = 1.0 - feed_forward
        # The characteristic equation m² - (2 - 2w - w²)m + (1 - 2w) = 0 has two real roots.
        middle, half = 1.0 - w - 0.5 * w * w, 0.5 * w * math.sqrt(w * (4.0 + w))
        self.slow_mode, self.fast_mode = middle + half, middle - half
        self.slow_bend, self.fast_bend = (self.slow_mode - 1.0) ** 2, (self.fast_mode - 1.0) ** 2

    def response(self, position: float, step: float, setpoints: Setpoints) -> Response:
        """Return the response from ``position``, reached by a last move of ``step`` (mm, or degrees)."""
        w, missing, (p, dp, ddp) = self._w, self._missing, setpoints
        drift = -4.0 * ddp * missing / w
        lag = (2.0 * w * (ddp - missing * dp - drift) - 2.0 * ddp) / (w * w)
        now = position - p - lag
        before = position - step - (p - dp + ddp) - (lag - drift)
        after = (2.0 - 2.0 * w - w * w) * now - (1.0 - 2.0 * w) * before
        slow = (after - self.fast_mode * now) / (self.slow_mode - self.fast_mode)
        return Response(lag, drift, slow, now - slow)

    def states(self, setpoints: Setpoints, response: Response, k: Number) -> tuple[Number, Number, Number]:
        """Return the position at grid point ``k``, the move that led there and its change, all in mm
        (or degrees) and intervals of the grid.
        """
        (p, dp, ddp), (lag, drift, slow_part, fast_part) = setpoints, response
        slow, fast = slow_part * self.slow_mode ** (k - 1), fast_part * self.fast_mode ** (k - 1)
        place = p + dp * k + ddp * k * k + lag + drift * k
        place = place + (slow * self.slow_mode + fast * self.fast_mode)
        moved = dp + ddp * (2 * k - 1) + drift
        moved = moved + slow * (self.slow_mode - 1.0) + fast * (self.fast_mode - 1.0)
        bent = 2.0 * ddp + slow * self.slow_bend / self.slow_mode + fast * self.fast_bend / self.fast_mode
        return place, moved, bent
