"""Following error and standstill of the axes: what each may be off its setpoint, at rest and in motion.

The drives watch themselves too, with one window for every speed; this is narrower, and holds at rest.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.alarms import Code
from core.executor.raised_alarm import AlarmError
from core.machine.machine_model import Axis
from core.message import Message
from core.ports import AxisSample

_HOST = 0.03  # s beyond a drive's own time: a drive that trips by itself is to be heard first
_RECENT = 0.1  # s for which a slide may still trail behind a speed that has gone
_UNMOVED = 0.05  # s in which an encoder has to have counted while its axis is sent away
_ARRIVES = 1.0  # s that a slide may take into position, as the cycle waits for it
_FROZEN, _CLOSE = 3.0, 2.5  # s, counts: a drive that pushes moves its encoder by one or two
_PART = 0.125  # of the standstill window: pushed that far off, a slide that is free moves
_COUNTS = 20.0  # by which it must have been sent, where counts are coarse
_NOTHING = 1e-9


class FollowingErrorWatch:
    """Watches all axes, at rest and in motion, powered or not; ``look`` is called once a tick."""

    def __init__(self, axes: Sequence[Axis]) -> None:
        self._axes = [_OneAxis(axis) for axis in axes]
        self._enabled = False

    def look(self, sample: AxisSample, *, unpowered: bool) -> None:
        """Raises AlarmError for the first axis that is not where it ought to be.

        ``unpowered``: the drives are off and nothing else is the matter, so that nobody ought to move them.
        """
        if sample.enabled is not self._enabled:
            self._enabled = sample.enabled
            self.forget()
        each = zip(self._axes, sample.demand, sample.actual, sample.homed, strict=True)
        for one, demand, actual, homed in each:
            if sample.moving:
                one.sent()  # also where its wire has not yet told of it
            if not one.passes(sample.t):
                continue
            if sample.enabled:
                one.powered(demand, actual)
                one.unasked(actual, at_rest=not sample.moving and demand == actual)
            else:
                one.unasked(actual, at_rest=not sample.moving and unpowered and homed)

    def forget(self) -> None:
        """What was seen no longer counts: power has changed, or the operator has acknowledged an alarm."""
        for one in self._axes:
            one.forget()


class _OneAxis:
    """One axis. Times are those of the samples, so that a control that was away takes nothing for long."""

    def __init__(self, axis: Axis) -> None:
        self._axis = axis
        self._t = 0.0
        self.forget()

    def forget(self) -> None:
        self._dt = 0.0
        self._demand: float | None = None
        self._speed = self._speed_at = 0.0
        self._sent_at = self._t
        self._since: dict[str, float] = {}
        self._counted = (self._t, 0.0, 0.0)  # sent since, from which demand; reading when it last counted
        self._counted_at = self._t
        self._stood: float | None = None  # where it stood when it came to rest

    def passes(self, t: float) -> bool:
        """Whether this is a new sample."""
        self._dt, self._t = t - self._t, t
        return self._dt > 0.0

    def powered(self, demand: float, actual: float) -> None:
        """A sample of the axis with its drive on. Raises AlarmError."""
        axis, error = self._axis, abs(demand - actual)
        if self._demand is None:
            self._demand, self._sent_at, self._counted = demand, self._t, (self._t, demand, actual)
        self._note_speed(abs(demand - self._demand) / self._dt)
        self._demand = demand
        self._encoder(demand, actual)
        rest = self._t - self._sent_at
        limit = axis.following_limit(self._speed)
        if self._lasts("off", error > limit) > axis.following_time + _HOST:
            code: Code = "standstill" if rest > axis.still_time else "following"
            raise AlarmError(
                code, Message("{axis} is {error} off its setpoint", axis=axis.name, error=self._words(error))
            )
        if rest > axis.still_time:
            self._at_standstill(error, rest)

    def _at_standstill(self, error: float, rest: float) -> None:
        """Nothing has sent it away for a while, and it does not arrive: the nearer the longer it may take."""
        axis, unmoved = self._axis, self._t - self._counted_at
        pushed = max(_PART * axis.still_window, 4.0 * axis.in_position)
        if self._lasts("pushed", error > pushed) > axis.still_time and unmoved > axis.still_time:
            raise AlarmError(
                "standstill",
                Message("{axis} remains {error} off its setpoint", axis=axis.name, error=self._words(error)),
            )
        beside = self._lasts("beside", error > axis.in_position) > _ARRIVES and rest > _ARRIVES
        frozen = self._lasts("frozen", error > _CLOSE * axis.count) > _FROZEN and unmoved > _FROZEN
        if beside or frozen:
            raise AlarmError(
                "standstill",
                Message("{axis} remains {error} off its setpoint", axis=axis.name, error=self._words(error)),
            )

    def sent(self) -> None:
        """Something moves, by the driver's own word: where it stood no longer counts."""
        self._stood = None
        self._since.pop("rest", None)

    def unasked(self, actual: float, *, at_rest: bool) -> None:
        """At rest, without a setpoint that holds it there. Raises AlarmError."""
        axis = self._axis
        if not at_rest:
            self.sent()
            return
        if self._lasts("rest", True) < axis.still_time:
            return
        self._stood = actual if self._stood is None else self._stood
        off = abs(actual - self._stood)
        if self._lasts("moved", off > axis.still_window) > axis.still_time:
            raise AlarmError(
                "moved-unasked",
                Message("{axis} has moved by {off} without a command", axis=axis.name, off=self._words(off)),
            )

    def _note_speed(self, speed: float) -> None:
        if speed * self._dt > _NOTHING:
            self._sent_at = self._t
        if speed >= self._speed or self._t - self._speed_at > _RECENT:
            self._speed, self._speed_at = speed, self._t

    def _encoder(self, demand: float, actual: float) -> None:
        """Sent away, and its encoder counts nothing: it is jammed, or nobody knows where it is."""
        axis, (since, sent_from, read) = self._axis, self._counted
        if abs(actual - read) > 1.5 * axis.count:
            self._counted, self._counted_at = (self._t, demand, actual), self._t
            return
        least = max(0.25 * axis.still_window, _COUNTS * axis.count)
        sent = abs(demand - sent_from)
        if sent <= axis.count:
            self._counted = (self._t, sent_from, read)
        elif self._t - since > _UNMOVED and sent > least and abs(demand - actual) > least:
            raise AlarmError(
                "encoder-still",
                Message(
                    "{axis} was commanded to move {sent}, but its encoder does not count",
                    axis=axis.name,
                    sent=self._words(sent),
                ),
            )

    def _lasts(self, what: str, holds: bool) -> float:
        """How long it has held, s."""
        if not holds:
            self._since.pop(what, None)
            return 0.0
        return self._t - self._since.setdefault(what, self._t)

    def _words(self, way: float) -> str:
        return (
            Message("{angle} degrees", angle=f"{way:.2f}")
            if self._axis.rotary
            else Message("{unit} mm", unit=f"{way:.3f}")
        )
