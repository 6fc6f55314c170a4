"""F9 SECCMP: 32 secondary offsets in the control's own words."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.desk import pages
from app.desk.offsets.desk import SeccmpDesk
from app.desk.offsets.dialogue import CHARACTERS
from app.desk.words import tr
from app.screen.offsets.asked import Asked
from app.screen.offsets.page import OffsetPage
from app.screen.offsets.table import OffsetTable
from app.screen.pages import Host


class SeccmpPage(OffsetPage):
    """F9, secondary offsets."""

    NAME = pages.SECCMP
    LABELS = ("MENU", "", "", "UNDO", "HISTORY", "EFFECT", "ALARMS", "TOOLS", "", "ZERO")

    def __init__(self, host: Host, parent: QWidget) -> None:
        self.model = SeccmpDesk(host.desk, host.desk.book)
        super().__init__(host, parent, self.model)
        self.table = OffsetTable(self.look, self.model.dialogue.choose, self)

    def board(self) -> QWidget:
        """The table of this page."""
        return self.table

    def takes(self, key: str) -> bool:
        """Figures, signs, and C."""
        return key in CHARACTERS or key == "C"

    def escape(self) -> bool:
        """Eight offsets that were brought near go back first."""
        if self.table.near:
            self.table.bring_near(0)
            return True
        return super().escape()

    def leave(self) -> bool:
        """The whole table stands here the next time."""
        self.table.bring_near(0)
        return super().leave()

    def show_offsets(self) -> None:
        """The table and the question as they are now."""
        model, dialogue = self.model, self.model.dialogue
        marked = {change.number for change in model.ledger.last}
        self.table.show_offsets(model.book.secondary, dialogue.number, marked, dialogue.mode)
        which = tr("Secondary offset number:")
        if dialogue.number:
            which = f"{which} {dialogue.number}"
        self.asked.show_asked(Asked(which, dialogue.question, dialogue.text, model.old_to_new, model.foot))
