"""Entry of the scope in the list of special functions (F10)."""

from __future__ import annotations

from app.desk.pages.table_content import TableRow
from app.desk.translation import tr
from app.scope.scope_model import ScopeModel
from app.special.special_functions import SeparatePageFunction
from core.message import Message

SCOPE_PAGE = "SCOPE"  # name of the page in app.screen.page_table


class ScopeFunction(SeparatePageFunction):
    """Special function that opens the scope and shows how much time the recorded data covers."""

    name = "SCOPE"
    use = "axis and spindle curves"
    page = SCOPE_PAGE
    key_hint = (
        "Press Enter to open the page. Shift+F10 opens this page from any other page "
        "and switches back to that page."
    )

    def make_information_rows(self) -> tuple[TableRow, ...]:
        """Return the rows with the recorded duration and the number of channels."""
        scope = self.desk.page_registry.find_model(ScopeModel)
        live = scope.live_samples if scope is not None else None
        if live is None:
            return (TableRow((tr("RECORDED"), tr("NO SCOPE DATA RECORDED ON THIS MACHINE"))),)
        return (
            TableRow(
                (
                    tr("STORED"),
                    tr(Message("THE LAST {minutes} MINUTES", minutes=f"{live.buffer_duration_s / 60.0:g}")),
                )
            ),
            TableRow((tr("CHANNELS"), str(len(live.channels)))),
        )

    def prompt_text(self) -> str:
        """Return the prompt that names the keys."""
        return "ENTER: OPEN SCOPE   ESC: BACK TO LIST"
