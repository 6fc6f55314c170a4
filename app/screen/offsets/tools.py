"""F8 TOOL OFFSETS: every field of 32 tools in one table."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.desk import pages
from app.desk.offsets import gridwords
from app.desk.offsets.grid import ToolGrid
from app.desk.words import tr
from app.screen.offsets.asked import Asked
from app.screen.offsets.grid import GridTable
from app.screen.offsets.page import OffsetPage
from app.screen.pages import Doings, Host


class ToolsPage(OffsetPage):
    """F8, tool offsets."""

    NAME = pages.TOOLS
    LABELS = ("MENU", "ADD", "MASTER", "UNDO", "HISTORY", "EFFECT", "ALARMS", "", "SECCMP", "ZERO")

    def __init__(self, host: Host, parent: QWidget) -> None:
        self.model = ToolGrid(host.desk, host.desk.book)
        super().__init__(host, parent, self.model)
        self.table = GridTable(self.look, self.model, self)

    def board(self) -> QWidget:
        """The table of this page."""
        return self.table

    def takes(self, key: str) -> bool:
        """Figures and signs; every character while a remark is written."""
        return self.model.takes(key)

    def doings(self) -> Doings:
        """Add to what is there; X and Z from the master; the rest as on F9."""
        return {**super().doings(), "F2": self.model.add, "F3": self.model.turn_relative}

    def show_offsets(self) -> None:
        """The table and the question as they are now."""
        model = self.model
        self.table.show_grid()
        foot = tr("F2 adds what is typed; F3 shows X and Z from the master; Esc leaves")
        self.asked.show_asked(
            Asked("", gridwords.question(model), model.text, gridwords.old_to_new(model), foot)
        )
