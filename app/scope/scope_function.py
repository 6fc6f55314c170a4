"""The scope in the list of special functions, F10: what is recorded, and the way to its page."""

from __future__ import annotations

from app.desk.sheet import Row, Sheet
from app.desk.translation import tr
from app.scope.scope_model import Scope
from app.special.special_functions import SpecialFunction
from core.executor.snapshot import Snapshot

PAGE = "SCOPE"  # its name in app.screen.page_table


class ScopeFunction(SpecialFunction):
    """Return, or a finger, opens the page."""

    name = "SCOPE"
    use = "axes and spindle as curves"
    page = PAGE

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """What is recorded, and how much of it."""
        scope = self.desk.attached(Scope)
        live = scope.live if scope is not None else None
        if live is None:
            rows: tuple[Row, ...] = (Row((tr("RECORDED"), tr("NOTHING ON THIS MACHINE"))),)
        else:
            rows = (
                Row((tr("KEPT"), tr("THE LAST {minutes} MINUTES").format(minutes=f"{live.lasts / 60.0:g}"))),
                Row((tr("CHANNELS"), str(len(live.channels)))),
            )
        notes = ("Return opens the page; Shift+F10 does so from every page, and goes back.",)
        return Sheet(tr("SCOPE"), ("", ""), (0.4, 0.6), rows, notes=notes)

    def prompt(self) -> str:
        """How the page is opened."""
        return "PRESS RETURN FOR THE SCOPE; ESC GOES BACK TO THE LIST"
