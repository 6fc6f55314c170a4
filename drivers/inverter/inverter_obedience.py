"""Whether an inverter does what it was told, and whether the encoder measures what it gives."""

from __future__ import annotations

from core.message import Message
from core.ports import Fault
from drivers.inverter.inverter_family import Look

OBEYS_WITHIN = 1.0  # s
_STEP = 0.011  # Hz: the setpoint counts in hundredths
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
    """

    def __init__(self) -> None:
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
        if abs(look.setpoint - asked) > _STEP:
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
            Message(
                "the encoder measures {measured} rpm, but the inverter output corresponds to {given} "
                "rpm; check the coupling, the belt and counts_per_rev; {press}",
                measured=f"{measured:.0f}",
                given=f"{given:.0f}",
                press=PRESS,
            ),
            "spindle-disagrees",
        )
