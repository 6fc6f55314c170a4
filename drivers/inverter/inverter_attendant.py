"""Whoever owns the line: tells the inverter what is wanted, looks at it, and says when it does not obey.

``Attendant.exchange`` is one round; a thread repeats it (``AttendantThread``), a test calls it. A stop goes
before everything: at most the answer that is under way is waited for.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from core.message import Message
from core.ports import Clock, DriverError, Fault, FaultCode
from drivers.inverter.inverter_family import Family, Look
from drivers.inverter.modbus_rtu import HeldBackError, NoAnswerError, RefusedError
from drivers.serial_line import WireError

# --- Whether an inverter does what it was told.


OBEYS_WITHIN = 1.0  # s
_ROUNDING = 0.001  # Hz: what rounding to the step of the setpoint may add
STANDS = 0.5  # Hz
_FALLS = 0.005  # part of its speed by which it must have fallen at least once a second
PRESS = "PRESS E-STOP"


def with_stop(why: str) -> str:
    """Return the fault with the request to press the E-stop."""
    return Message("{why}: {press}", why=why, press=PRESS)


class Obedience:
    """``judge`` each look; ``command`` when another command goes out.

    A look on a slow line is as old as its exchange is long: the second that an inverter has begins behind it,
    and what must fall is compared with the first look behind the command, never with one before it.
    ``step`` is the resolution of the reported setpoint in Hz.
    """

    def __init__(self, step: float = 0.01) -> None:
        self._within = step + _ROUNDING
        self._since: float | None = None  # when it last did what it was told; None: it does
        self._lowest: float = 0.0  # Hz, on the way down
        self._unseen = False  # no look has come since the command
        self._asked = 0.0

    def command(self, now: float, asked: float, seen: Look | None) -> None:
        """A command in Hz, signed. Another setpoint of the same direction is not a new start of the clock."""
        if asked == self._asked:
            return
        if seen is not None and (asked == 0.0 or asked * self._asked < 0.0 or abs(asked) < abs(self._asked)):
            self._lowest = seen.output
            self._unseen = True
        self._asked = asked
        if self._since is None:
            self._since = now

    def judge(self, now: float, look: Look, took: float = 0.0) -> str:
        """Return why it has not obeyed for a second and ``took``, the seconds of one exchange.

        Empty while all is well or may become so.
        """
        if self._unseen:  # it may have been getting faster when the command came
            self._lowest, self._unseen = max(self._lowest, look.output), False
        wrong = self._wrong(look)
        if self._falls(look):
            self._lowest = look.output
        if not wrong:
            self._since = None
            return ""
        if self._since is None:
            self._since = now
        return wrong if now - self._since > OBEYS_WITHIN + took else ""

    def _wrong(self, look: Look) -> str:
        why = self._standing(look) if self._asked == 0.0 else self._understood(look) or self._turning(look)
        return with_stop(why) if why else ""

    def _standing(self, look: Look) -> str:
        if look.output > STANDS and (look.run or not self._falls(look)):
            return Message(
                "a stop was commanded, but the inverter still outputs {output} Hz",
                output=f"{look.output:.1f}",
            )
        return "a stop was commanded, but the inverter still reports that it is running" if look.run else ""

    def _understood(self, look: Look) -> str:
        """Its own words for what it is to do."""
        asked = abs(self._asked)
        if abs(look.setpoint - asked) > self._within:
            return Message(
                "{requested} Hz was commanded, but the inverter reports a setpoint of {setpoint} Hz",
                requested=f"{asked:.2f}",
                setpoint=f"{look.setpoint:.2f}",
            )
        if not look.run:
            return Message(
                "{requested} Hz was commanded, but the inverter is not running", requested=f"{asked:.1f}"
            )
        return (
            ""
            if look.asked_reverse == (self._asked < 0.0)
            else ("the inverter reports a command for the opposite direction")
        )

    def _turning(self, look: Look) -> str:
        """What it does: on the way down, or round to the other direction, it must get slower."""
        back = look.reverse != (self._asked < 0.0) and look.output > STANDS
        if back and not self._falls(look):
            return "the inverter runs in the direction opposite to its command"
        if not back and look.output > abs(self._asked) + STANDS and not self._falls(look):
            return Message(
                "{requested} Hz was commanded, but the inverter outputs {output} Hz",
                requested=f"{abs(self._asked):.1f}",
                output=f"{look.output:.1f}",
            )
        return ""

    def _falls(self, look: Look) -> bool:
        """Slower than ever since it was told, by more than a ripple."""
        return look.output < self._lowest * (1.0 - _FALLS)


# --- Whether encoder and inverter tell of the same spindle: open couplings, slipping belts, wrong counts.
# The inverter's figure is late by a round of its line, so it is compared only while it does not change.


_EVEN_RPM, _EVEN = 10.0, 0.01  # a change of the output that is none
_SETTLED = 0.5  # s of an even output before it is compared
_LONG = 1.0  # s for which both must disagree
_SLACK = 30.0  # rpm


class Agreement:
    """``fraction`` by which they may differ."""

    def __init__(self, fraction: float) -> None:
        self._fraction = fraction
        self._given = 0.0
        self._even_since = 0.0
        self._off_since: float | None = None

    def look(self, measured: float, given: float, now: float) -> str:
        """What is wrong; empty when they agree, or cannot be compared. rpm, signed; 0 given: it runs down."""
        if abs(given - self._given) > _EVEN_RPM + _EVEN * abs(given):
            self._given, self._even_since = given, now
        off = abs(measured - given) > _SLACK + self._fraction * abs(given)
        if given == 0.0 or not off or now - self._even_since < _SETTLED:
            self._off_since = None
            return ""
        self._off_since = now if self._off_since is None else self._off_since
        if now - self._off_since < _LONG:
            return ""
        return Fault(
            "the encoder measures {measured} rpm, but the inverter output corresponds to {given} "
            "rpm; check the coupling, the belt and counts_per_rev; {press}",
            "spindle-disagrees",
            measured=f"{measured:.0f}",
            given=f"{given:.0f}",
            press=PRESS,
        )


# --- The attendant.


LOST = 1.0  # s without an answer after which the inverter counts as lost
DEAD = LOST + 0.5  # s: by then the attendant itself has reported the silence
_PARTS = 2.0  # s after a look for which single answers count, before the next look has to be whole
_AGAIN = 1.0  # s between two attempts to open a port that has gone
_MOST = 60  # rounds in which a warm-up must have come to its end
_RESTARTS = 3.0  # s in which an inverter may be silent after a reset


@dataclass(frozen=True, slots=True)
class Seen:
    """The last look and its time; ``asked``: a command from before then was sent before the look began."""

    t: float
    look: Look
    asked: float = 0.0


class Attendant:
    """``want`` (Hz, signed) may be set by any thread; all else belongs to the one that calls ``round``.

    ``open_line`` makes the family on a freshly opened line; it raises DriverError. ``step`` is the
    resolution of the reported setpoint in Hz.
    """

    def __init__(
        self,
        open_line: Callable[[], Family],
        clock: Clock,
        comm_loss: float,
        highest: float,
        step: float = 0.01,
    ) -> None:
        self._open, self._clock = open_line, clock
        self._comm_loss, self._highest, self._step = comm_loss, highest, step
        self._want = 0.0
        self._told: float | None = None  # None: nothing since the line was opened
        self._obedience = Obedience(self._step)
        self._family: Family | None = None
        self._retry = 0.0
        self._began = self._began_before = clock.now()  # the exchange that is under way, and the last one
        self._answered = clock.now()  # when an answer has last come in an exchange without a failure
        self._reset = False
        self.grace = 0.0  # until then silence is no trouble
        self.seen: Seen | None = None
        self.trouble: Fault | str = ""  # latched until ``clear``
        self.missed = ""  # why the last exchange failed
        self.warnings: tuple[str, ...] = ()

    @property
    def want(self) -> float:
        """Hz, signed. Trouble makes it 0, and it stays so."""
        return 0.0 if self.trouble else self._want

    @want.setter
    def want(self, hz: float) -> None:
        self._want = hz

    @property
    def warm(self) -> bool:
        """Whether enough has been answered to trust it."""
        return self._family is not None and self._family.good >= self._family.warm_up

    @property
    def unheard(self) -> bool:
        """Whether nothing is known of the inverter now: its port is gone, or it has not answered of late."""
        return self._family is None or self.seen is None or self.silent_for > LOST

    @property
    def silent_for(self) -> float:
        """Return the seconds since a look, or an answer on the way to one; 0 while it may be silent."""
        seen, now = self.seen, self._clock.now()
        if seen is None or now <= self.grace:
            return 0.0
        return now - max(seen.t, min(self._answered, seen.t + _PARTS))

    @property
    def lag(self) -> float:
        """Return the seconds by which the line delays a command and the look that shows it."""
        seen = self.seen
        return self._clock.now() - seen.asked if seen is not None else 0.0

    def connect(self) -> None:
        """Open, stop, check, look until it is trusted. Raises DriverError."""
        self._prepare()
        for _ in range(_MOST):
            self._look()
            if self.warm:
                return
        raise DriverError(
            "the inverter did not send {warm_up} valid responses in a row: {missed}",
            warm_up=self._familiar.warm_up,
            missed=self.missed,
        )

    def exchange(self) -> None:
        """One exchange; what goes wrong is trouble, never an exception."""
        try:
            if self._family is None:
                self._reopen()
            else:
                self._exchange()
            self.missed = ""
        except WireError as error:
            self._let_go(str(error))
        except (NoAnswerError, RefusedError) as error:
            self.missed = str(error)
            self._told = None  # whether it has heard is not known: it is told again
            self._answered = 0.0  # what else it has answered makes no look
        self._supervise()

    def clear(self) -> None:
        """Forget the trouble and reset a trip; what was wanted before is not wanted any more. Any thread."""
        self._want = 0.0
        self._reset = True
        self.trouble = ""

    def begin_again(self) -> None:
        """Nothing is known before the next look, which may take a moment."""
        self.clear()
        self._told, self.seen, self.grace = None, None, self._clock.now() + _RESTARTS

    def close(self) -> None:
        """Stop, and let the line go."""
        self._want = 0.0
        if self._family is not None:
            try:
                self._family.stop()
            except DriverError as error:
                self.missed = str(error)
            self._family.close()
            self._family = None

    @property
    def _familiar(self) -> Family:
        if self._family is None:
            raise NoAnswerError("the serial line to the inverter is not open")
        return self._family

    def _prepare(self) -> None:
        self._family = self._open()
        self._family.hurry = self._stop_waits
        self._told = None
        self._family.stop()
        self._told = 0.0
        self.warnings = tuple(self._family.prepare(self._comm_loss, self._highest))

    def _stop_waits(self) -> bool:
        return self.want == 0.0 and self._told != 0.0

    def _reopen(self) -> None:
        now = self._clock.now()
        if now < self._retry:
            self._clock.sleep_until(min(self._retry, now + 0.1))
            return
        self._retry = now + _AGAIN
        self._prepare()

    def _exchange(self) -> None:
        self._began_before, self._began = self._began, self._clock.now()
        if self._reset:
            self._clear_now()
        with suppress(HeldBackError):  # the next exchange says the stop first
            self._tell()
            self._look()

    def _clear_now(self) -> None:
        """Only what answers can be cleared; a trip that stays comes back with the next look."""
        self._familiar.stop()
        self._told = 0.0
        self._obedience = Obedience(self._step)
        tripped = self.seen is None or bool(self.seen.look.trip)
        self._reset = False
        if tripped:
            self.grace = self._clock.now() + _RESTARTS
            self._familiar.reset()

    def _tell(self) -> None:
        want, look = self.want, self.seen.look if self.seen else None
        # A stop is said until it stands.
        turns = want == 0.0 and look is not None and (look.run or look.output > STANDS)
        if want == self._told and not turns:
            return
        self._obedience.command(self._clock.now(), want, look)
        if want == 0.0:
            self._familiar.stop()
        else:
            self._told = None  # from its first frame on a stop has to be said, and holds back the others
            self._familiar.command(want)
        self._told, self._answered = want, self._clock.now()

    def _look(self) -> None:
        for look in self._familiar.looks():
            self._answered = self._clock.now()
            if look is not None:
                self._judge(look)
            elif self._stop_waits():
                return

    def _judge(self, look: Look) -> None:
        now = self._clock.now()
        self.seen = Seen(now, look, self._began_before)
        if self._reset:
            return  # a look from before the operator's word
        if look.trip:
            self._latch(Message("the inverter has tripped: {trip}", trip=look.trip), "spindle")
        elif why := self._obedience.judge(now, look, now - self._began):
            self._latch(Message("the inverter does not follow its command: {why}", why=why), "ignores-stop")

    def _let_go(self, why: str) -> None:
        self.missed = why
        if self._family is not None:
            self._family.close()
        self._family, self._told = None, None
        self._latch(with_stop(why) if self._may_turn() else why, "inverter-silent")

    def _supervise(self) -> None:
        """Nothing seen for too long is trouble, also when nothing was wanted of it."""
        never = self.seen is None and self._clock.now() >= self.grace
        if (never or self.silent_for >= LOST) and not self.trouble:
            why = self.missed or "no response from inverter"
            self._latch(with_stop(why) if self._may_turn() else why, "inverter-silent")

    def _may_turn(self) -> bool:
        return self._want != 0.0 or self.seen is None or self.seen.look.output > 0.0

    def _latch(self, why: str, code: FaultCode) -> None:
        if not self.trouble:
            self.trouble = Fault(why, code)
        self._want, self._reset = 0.0, False


# --- The thread that repeats the attendant's rounds. Its end is seen by whoever asks for the spindle's fault.


_END = 3.0  # s: the longest exchange and its retries


class AttendantThread:
    """Rounds without a pause: the line itself keeps the pace of its requests."""

    def __init__(self, attendant: Attendant) -> None:
        self._attendant = attendant
        self._ended = threading.Event()
        self.thread = self._made()

    def start(self) -> None:
        """Once."""
        self.thread.start()

    def revive(self) -> None:
        """In the place of a thread that has failed another one goes round; the first it says is a stop."""
        if not self.alive and not self._ended.is_set():
            self._attendant.begin_again()
            self.thread = self._made()
            self.thread.start()

    @property
    def alive(self) -> bool:
        """Whether it still goes round."""
        return self.thread.is_alive()

    def close(self) -> None:
        """The last word on the line is a stop."""
        self._attendant.want = 0.0  # holds back what the thread has not sent yet
        self._ended.set()
        if self.thread.is_alive():
            self.thread.join(_END)
        self._attendant.close()

    def _made(self) -> threading.Thread:
        return threading.Thread(target=self._keep, name="inverter", daemon=True)

    def _keep(self) -> None:
        while not self._ended.is_set():
            self._attendant.exchange()
