"""Entry of the scope in the list of special functions (F10)."""

from __future__ import annotations

from app.desk.pages.sheet import Row
from app.desk.translation import tr
from app.scope.scope_model import Scope
from app.special.special_functions import PageFunction
from core.message import Message

PAGE = "SCOPE"  # name of the page in app.screen.page_table


class ScopeFunction(PageFunction):
    """Special function that shows the recorded duration and opens the scope."""

    name = "SCOPE"
    use = "axis and spindle curves"
    page = PAGE
    way = (
        "Press Enter to open the page. Shift+F10 opens this page from any other page "
        "and switches back to that page."
    )

    def facts(self) -> tuple[Row, ...]:
        """Return the rows with the recorded duration and the number of channels."""
        scope = self.desk.pages.find(Scope)
        live = scope.live if scope is not None else None
        if live is None:
            return (Row((tr("RECORDED"), tr("NO SCOPE DATA RECORDED ON THIS MACHINE"))),)
        return (
            Row((tr("STORED"), tr(Message("THE LAST {minutes} MINUTES", minutes=f"{live.lasts / 60.0:g}")))),
            Row((tr("CHANNELS"), str(len(live.channels)))),
        )

    def prompt(self) -> str:
        """Return the prompt that names the keys."""
        return "ENTER: OPEN SCOPE   ESC: BACK TO LIST"
