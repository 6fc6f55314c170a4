"""Feed holds: ours, other people's, and the way out of each."""

from __future__ import annotations

from drivers.grblhal import grblhal_codes
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_report import Report

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
