"""Where the slides were when the controller's probe input came on: a report tells pin and place at once."""

from __future__ import annotations

from core.ports import PROBE, Latch
from drivers.grblhal.grblhal_axes import GrblAxes
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_report import Report
from drivers.grblhal.grblhal_terminals import GrblInputs

_ASKS = 60.0  # s from arming on in which it asks more often
_BEHIND = 0.5  # s behind a touch in which it still does


class GrblProbe:
    """``core.ports.TouchInput``, by reports that are asked for more often meanwhile.

    G38.2 is not used: it runs to its end when nobody is there any more, where a jog ends with its lease.
    """

    def __init__(self, controller: Controller, axes: GrblAxes, inputs: GrblInputs) -> None:
        self._c, self._axes, self._inputs = controller, axes, inputs
        self._report: Report | None = None
        self._at = controller.clock.now()  # of the last report that was looked at
        self._made = False
        self._kept: Latch | None = None

    def arm(self) -> None:
        """Forget what was kept, and look often."""
        self._kept = None
        self._c.hurry_until = self._c.clock.now() + _ASKS

    def latched(self) -> Latch | None:
        """The first touch since."""
        return self._kept

    def pump(self) -> None:
        """Once a round, behind the conversation's own."""
        now, report = self._c.clock.now(), self._c.report
        if report is self._report or report is None:
            return
        late, self._report, self._at = now - self._at, report, now
        before, self._made = self._made, self._inputs.states().get(PROBE, False)
        if self._made and not before and self._kept is None:
            sample = self._axes.sample()
            self._kept = Latch(sample.t, sample.actual, late)
            self._c.hurry_until = min(self._c.hurry_until, now + _BEHIND)
