"""Whether encoder and inverter tell of the same spindle: open couplings, slipping belts, wrong counts.

The inverter's figure is late by a round of its line, so it is compared only while it does not change.
"""

from __future__ import annotations

from core.ports import Fault
from drivers.inverter.obedience import PRESS

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
            f"the encoder measures {measured:.0f} rpm and the inverter gives {given:.0f}: "
            f"coupling, belt or counts_per_rev; {PRESS}",
            "spindle-disagrees",
        )
