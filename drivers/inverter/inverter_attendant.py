"""Control of an inverter on its line: commands, polling and detection of an inverter that does not obey.

``Attendant.exchange`` is one exchange. ``AttendantThread`` repeats it; tests call it directly. A stop has
priority over everything and waits at most for the response in progress.
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

# --- Check whether an inverter obeys.


OBEYS_WITHIN = 1.0  # s
_ROUNDING = 0.001  # Additional tolerance in Hz for rounding of the setpoint.
STANDS = 0.5  # Hz
_FALLS = 0.005  # Fraction of the speed by which it must fall at least once per second.
PRESS = "PRESS E-STOP"


def with_stop(why: str) -> str:
    """Return the fault text with the request to press the E-stop."""
    return Message("{why}: {press}", why=why, press=PRESS)


class Obedience:
    """Check whether an inverter follows its commands; ``command`` notes a command, ``judge`` checks a poll.

    On a slow line, a poll is as old as its exchange is long. The permitted second therefore starts after the
    exchange, and a falling speed is compared with the first poll after the command. ``step`` is the
    resolution of the reported setpoint in Hz.
    """

    def __init__(self, step: float = 0.01) -> None:
        self._within = step + _ROUNDING
        self._since: float | None = None  # Time since which the inverter does not obey; None: it obeys.
        self._lowest: float = 0.0  # Lowest output in Hz while the speed falls.
        self._unseen = False  # No poll has been completed since the command.
        self._asked = 0.0

    def command(self, now: float, asked: float, seen: Look | None) -> None:
        """Note a command in Hz, signed; a new setpoint in the same direction does not restart the limit."""
        if asked == self._asked:
            return
        if seen is not None and (asked == 0.0 or asked * self._asked < 0.0 or abs(asked) < abs(self._asked)):
            self._lowest = seen.output
            self._unseen = True
        self._asked = asked
        if self._since is None:
            self._since = now

    def judge(self, now: float, look: Look, took: float = 0.0) -> str:
        """Return the reason why the inverter has not obeyed for one second plus ``took``.

        ``took`` is the duration of one exchange in seconds. The result is empty while the inverter may still
        obey.
        """
        if self._unseen:  # The motor may still have accelerated when the command was sent.
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
        """Return the difference between the command and the reported setpoint, run state and direction."""
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
        """Return a wrong output: the speed must fall toward a lower setpoint or before a reversal."""
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
        """Return whether the output is below its lowest value since the command by more than a ripple."""
        return look.output < self._lowest * (1.0 - _FALLS)


# --- Comparison of encoder and inverter, to detect open couplings, slipping belts and wrong counts. The value
# of the inverter is delayed by one exchange, so it is compared only while it is constant.


_EVEN_RPM, _EVEN = 10.0, 0.01  # A smaller change of the output is ignored.
_SETTLED = 0.5  # Seconds of constant output before the comparison.
_LONG = 1.0  # Seconds for which both must differ.
_SLACK = 30.0  # rpm


class Agreement:
    """Comparison of encoder and inverter speed; ``fraction`` is the permitted relative difference."""

    def __init__(self, fraction: float) -> None:
        self._fraction = fraction
        self._given = 0.0
        self._even_since = 0.0
        self._off_since: float | None = None

    def look(self, measured: float, given: float, now: float) -> str:
        """Return the fault when the speeds have differed for 1 s, or an empty text.

        Both speeds are in rpm, signed. They are compared only at a constant inverter output other than 0.
        """
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


# --- Polling and commands.


LOST = 1.0  # Seconds without a response after which the inverter counts as lost.
DEAD = LOST + 0.5  # Seconds after which the exchange itself has reported the silence.
_PARTS = 2.0  # Seconds after a poll in which single responses count, before the next poll must be complete.
_AGAIN = 1.0  # Seconds between two attempts to open a lost port.
_MOST = 60  # Polls until the inverter must be trusted.
_RESTARTS = 3.0  # Seconds in which an inverter may be silent after a reset.


@dataclass(frozen=True, slots=True)
class Seen:
    """Last poll and its time.

    ``asked`` is a time before which all commands were sent when the poll began.
    """

    t: float
    look: Look
    asked: float = 0.0


class Attendant:
    """Owner of the inverter's line.

    Any thread may set ``want``; all else belongs to the thread of ``exchange``.

    ``open_line`` opens the line and returns the inverter; it raises DriverError. ``step`` is the resolution
    of the reported setpoint in Hz.
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
        self._told: float | None = None  # None: no command since the line was opened.
        self._stops = self._stopped = 0  # Number of commanded stops, and of those that the inverter has.
        self._obedience = Obedience(self._step)
        self._family: Family | None = None
        self._retry = 0.0
        self._began = self._began_before = clock.now()  # Start times of the present and the last exchange.
        self._answered = clock.now()  # Time of the last response in an exchange without an error.
        self._reset = False
        self.grace = 0.0  # Silence is permitted until this time.
        self.seen: Seen | None = None
        self.trouble: Fault | str = ""  # Latched until ``clear``.
        self.missed = ""  # Reason why the last exchange failed.
        self.warnings: tuple[str, ...] = ()

    @property
    def want(self) -> float:
        """The commanded frequency in Hz, signed; a fault sets it permanently to 0."""
        return 0.0 if self.trouble else self._want

    @want.setter
    def want(self, hz: float) -> None:
        if hz == 0.0 and self._want != 0.0:
            self._stops += 1  # The stop is sent even if a start follows before the next exchange.
        self._want = hz

    @property
    def warm(self) -> bool:
        """Whether the inverter has sent enough valid responses to be trusted."""
        return self._family is not None and self._family.good >= self._family.warm_up

    @property
    def unheard(self) -> bool:
        """Whether the state is unknown, because the port is closed or the inverter is silent."""
        return self._family is None or self.seen is None or self.silent_for > LOST

    @property
    def silent_for(self) -> float:
        """The seconds since the last poll or partial response; 0 while silence is permitted."""
        seen, now = self.seen, self._clock.now()
        if seen is None or now <= self.grace:
            return 0.0
        return now - max(seen.t, min(self._answered, seen.t + _PARTS))

    @property
    def lag(self) -> float:
        """The seconds by which the line delays a command and the poll that shows its effect."""
        seen = self.seen
        return self._clock.now() - seen.asked if seen is not None else 0.0

    def connect(self) -> None:
        """Open the line, stop the inverter, check it, and poll until it is trusted. Raises DriverError."""
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
        """Perform one exchange; errors become the fault and are never raised."""
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
            self._told = None  # The command may be lost, so it is sent again.
            self._answered = 0.0  # Other responses do not complete the poll.
        self._supervise()

    def clear(self) -> None:
        """Clear the fault, reset a trip and discard the commanded frequency; callable from any thread."""
        self._want = 0.0
        self._reset = True
        self.trouble = ""

    def begin_again(self) -> None:
        """Discard the known state; the next poll may take a few seconds."""
        self.clear()
        self._told, self.seen, self.grace = None, None, self._clock.now() + _RESTARTS

    def close(self) -> None:
        """Stop the inverter and close the line."""
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
        self._family.hurry = lambda: self._stop_waits() or self._has_unsent_stop()
        self._stop_now()
        self.warnings = tuple(self._family.prepare(self._comm_loss, self._highest))

    def _stop_waits(self) -> bool:
        return self.want == 0.0 and self._told != 0.0

    def _has_unsent_stop(self) -> bool:
        return self._stops != self._stopped

    def _stop_now(self) -> None:
        """Stop the inverter; the stop counts when the inverter has confirmed it. Raises DriverError."""
        stops, self._told = self._stops, None
        self._familiar.stop()
        self._told, self._stopped = 0.0, stops

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
        with suppress(HeldBackError):  # The next exchange starts with the stop.
            self._tell()
            self._look()

    def _clear_now(self) -> None:
        """Stop and reset a trip; a trip that remains is reported by the next poll."""
        self._stop_now()
        self._obedience = Obedience(self._step)
        tripped = self.seen is None or bool(self.seen.look.trip)
        self._reset = False
        if tripped:
            self.grace = self._clock.now() + _RESTARTS
            self._familiar.reset()

    def _tell(self) -> None:
        want, look = self.want, self.seen.look if self.seen else None
        # A stop is repeated until standstill.
        turns = want == 0.0 and look is not None and (look.run or look.output > STANDS)
        missing = self._has_unsent_stop()
        if want == self._told and not turns and not missing:
            return
        if want == 0.0 or missing:
            self._obedience.command(self._clock.now(), 0.0, look)
            self._stop_now()
        if want != 0.0:
            self._obedience.command(self._clock.now(), want, look)
            self._told = None  # From the first frame on, a stop must be sent and has priority.
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
            return  # This poll started before the operator's reset.
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
        """Set a fault if the inverter has been silent for too long, even if no command is active."""
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


# --- Thread that repeats the exchanges. The spindle's fault reports its end.


_END = 3.0  # Seconds for the longest exchange with its retries.


class AttendantThread:
    """Thread that repeats the exchanges without a pause; the line limits the rate of requests."""

    def __init__(self, attendant: Attendant) -> None:
        self._attendant = attendant
        self._ended = threading.Event()
        self.thread = self._made()

    def start(self) -> None:
        """Start the thread; must be called only once."""
        self.thread.start()

    def revive(self) -> None:
        """Start a new thread if the last one has failed; its first command is a stop."""
        if not self.alive and not self._ended.is_set():
            self._attendant.begin_again()
            self.thread = self._made()
            self.thread.start()

    @property
    def alive(self) -> bool:
        """Whether the thread is running."""
        return self.thread.is_alive()

    def close(self) -> None:
        """End the thread and send a final stop."""
        self._attendant.want = 0.0  # Prevents further commands of the thread.
        self._ended.set()
        if self.thread.is_alive():
            self.thread.join(_END)
        self._attendant.close()

    def _made(self) -> threading.Thread:
        return threading.Thread(target=self._keep, name="inverter", daemon=True)

    def _keep(self) -> None:
        while not self._ended.is_set():
            self._attendant.exchange()
