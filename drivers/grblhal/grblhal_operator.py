"""Feed holds, jog and overrides: what the operator changes about motion.

The controller knows steps of its overrides only. They go out from what it has told, and are read back. A jog
is a lease: the controller never has more travel than the lease allows, so silence is the stop.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from core.message import Message
from core.ports import DriverError, FaultCode
from drivers.grblhal import grblhal_codes
from drivers.grblhal.grblhal_codes import jog_line
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_report import Report
from drivers.grblhal.grblhal_wire import Ask

_APART = 0.1  # s between two corrections
_AGAIN = 2.5  # s without a word of the overrides, which every twentieth plain report carries at least
_PATIENCE = 7.0  # s: then it does not take them
LEAST, MOST = 10, 200  # per cent that the controller knows


def steps_to(percent: int, told: int, steps: tuple[int, ...] = grblhal_codes.FEED) -> bytes:
    """From the ``told`` per cent to ``percent``.

    By way of 100 % only where that lies in between: the reset acts at once, and slides that creep would leap.
    So there are never more of them than its queue holds.
    """
    reset, *moves = steps
    straight, over = _from(told, percent, moves), bytes([reset]) + _from(100, percent, moves)
    crosses = (percent - 100) * (told - 100) <= 0
    return over if crosses and len(over) < len(straight) else straight


def _from(told: int, percent: int, moves: list[int]) -> bytes:
    """Coarse steps, then fine ones; the other way round where a coarse one would be cut short at a limit."""
    up_10, down_10, up_1, down_1 = moves
    tens, ones = divmod(abs(percent - told), 10)
    tens, ones = (tens + 1, ones - 10) if ones > 5 else (tens, ones)
    sign = 1 if percent > told else -1
    coarse, fine, back = (up_10, up_1, down_1) if sign > 0 else (down_10, down_1, up_1)
    steps = [coarse] * tens, [fine if ones > 0 else back] * abs(ones)
    fits = LEAST <= told + sign * 10 * tens <= MOST
    return bytes([*steps[0], *steps[1]] if fits else [*steps[1], *steps[0]])


def rapid_step(fraction: float) -> int:
    """Per cent: the greatest of the controller's three that is not faster than asked; 25 is its least."""
    return 100 if fraction >= 1.0 else 50 if fraction >= 0.5 else 25


def in_reach(fraction: float) -> int:
    """Per cent of a fraction, within what the controller knows."""
    return min(max(round(100 * fraction), LEAST), MOST)


class Overrides:
    """``wanted`` is compared with what the controller reports; differences are sent again."""

    def __init__(self, write: Callable[[bytes], None], fail: Callable[[str, FaultCode], None]) -> None:
        self._write = write
        self._fail = fail
        self._asked = [100, 100, 100]
        self._sent_at, self._seen = -1.0, 0
        self._since: float | None = None  # it has not been true, nor come nearer
        self._last: tuple[int, ...] | None = None  # that was told
        self.level = False  # a thread: at 100 % whatever is asked, for it would run beside its lead

    @property
    def commanded(self) -> list[int]:
        """Per cent: feed, rapid, spindle."""
        return [100, self._asked[1], 100] if self.level else self._asked

    def want(self, feed: float, rapid: float) -> None:
        """Fractions above 0."""
        self._asked[:2] = in_reach(feed), rapid_step(rapid)

    def want_spindle(self, percent: int) -> None:
        """Of the speed in its last S word."""
        self._asked[2] = percent

    def true_to(self, reported: tuple[int, ...] | None) -> bool:
        """Whether the controller does what is wanted."""
        return reported is not None and list(reported[:3]) == self.commanded

    def correct(self, reported: tuple[int, ...] | None, told: int, now: float) -> None:
        """Send what differs, from a word of the controller that is younger than what was sent.

        ``told`` counts these words. One that does not come is asked for, by sending again.
        """
        if reported is None or self.true_to(reported) or reported != self._last:
            self._since = None  # what follows the radius is on its way for as long as it does
        self._last = reported
        if reported is None or self.true_to(reported):
            return
        fresh = told > self._seen and now - self._sent_at >= _APART
        if not fresh and now - self._sent_at < _AGAIN:
            return
        self._since = now if self._since is None else self._since
        if now - self._since > _PATIENCE:
            self._fail(
                Message(
                    "the controller does not accept an override: {commanded} was commanded, but "
                    "{reported} is reported",
                    commanded=self.commanded,
                    reported=list(reported),
                ),
                "controller-refuses",
            )
            return
        self._sent_at, self._seen = now, told
        self._write(self._steps(reported))

    def _steps(self, reported: tuple[int, ...]) -> bytes:
        feed, rapid, spindle = self.commanded
        data = steps_to(feed, reported[0])
        data += bytes([grblhal_codes.RAPIDS[rapid]]) if reported[1] != rapid else b""
        return data + (steps_to(spindle, reported[2], grblhal_codes.SPINDLE) if len(reported) > 2 else b"")


# --- Feed holds: ours, other people's, and the way out of each.


_LATE = 3  # reports that may still tell of before a hold, or of one that has just been ended


class Holds:
    """0x82 and 0x81, from report to report."""

    def __init__(self, controller: Controller) -> None:
        self._c = controller
        self._asked = False  # and not yet taken back
        self._ours = False  # the hold that stands is our own
        self._released = self._again = 0  # reports from which a hold is one again, or has to be said again

    @property
    def stands(self) -> bool:
        """Whether the controller rests in a hold."""
        c = self._c
        held = c.report is not None and c.report.state == "Hold" and not c.report.sub
        return held and c.reports >= self._released and not c.busy

    def begin(self) -> None:
        """At once."""
        self._asked = self._ours = True
        self._released = 0
        self._say()

    def end(self) -> None:
        """At once where it rests, or as soon as it does; the operator's word ends any hold."""
        self._asked, self._ours = False, True
        self._go_on()

    def forget(self) -> None:
        """What stops for good needs no hold."""
        self._asked = self._ours = False

    def reported(self, report: Report) -> None:
        """Look at a report."""
        if report.state == "Hold":
            self._go_on()
        elif self._asked and report.state == "Run" and self._c.reports >= self._again:
            self._say()  # a button at the controller has ended it
        else:
            self._ours = self._ours and (self._asked or report.state in {"Run", "Jog"})

    # --- inside -------------------------------------------------------------------------------------------

    def _say(self) -> None:
        self._again = self._c.reports + _LATE
        self._c.realtime(grblhal_codes.HOLD)
        self._c.question()

    def _go_on(self) -> None:
        """Out of a hold once it rests and somebody has said so; never out of another's by itself."""
        report = self._c.report
        if (
            self._ours
            and not self._asked
            and report is not None
            and report.state == "Hold"
            and not report.sub
        ):
            self._ours = False
            self._released = self._c.reports + _LATE
            self._c.realtime(grblhal_codes.START)
            self._c.question()


# --- Jog as a lease.


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
                "the controller does not have an axis {axis} to jog", "controller-refuses", axis=axis
            )
        if self.active:
            # Another speed or direction: from where the way that it has ends.
            place = self._sent
        self._axis, self._velocity = axis, velocity
        self._from = self._sent = place
        self._since, self._ask = now, None
