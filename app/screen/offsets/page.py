"""F9 SECCMP and F8 TOOLS: the table, the dialogue under it, a pad of keys for fingers, and the history."""

from __future__ import annotations

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk import pages
from app.desk.offsets.desk import OffsetDesk, seccmp, tool_offsets
from app.desk.offsets.dialogue import CHARACTERS
from app.desk.session import Loaded
from app.desk.view import View
from app.screen.offsets.asked import AskedPanel
from app.screen.offsets.history import HistoryList
from app.screen.offsets.keypad import KeyPad
from app.screen.offsets.table import OffsetTable
from app.screen.pages import Doings, Host, Page
from core.executor.snapshot import Snapshot

PAD, ASKED = 27.0, 12.4  # units: width of the pad, height of the dialogue


class OffsetPage(Page):
    """What F8 and F9 share: the model decides, this only shows it and hands the keys on."""

    def __init__(self, host: Host, parent: QWidget, model: OffsetDesk) -> None:
        super().__init__(host, parent)
        self.model = model
        self.table = OffsetTable(self.look, model.dialogue.choose, self)
        self.table.tools = self.NAME == pages.TOOLS
        self.history = HistoryList(self.look, self)
        self.asked = AskedPanel(self.look, self)
        self.pad = KeyPad(self.look, self._touched, clears=self.NAME == pages.SECCMP, parent=self)

    def doings(self) -> Doings:
        """Undo and history; Page up and Page down look through the latter."""
        return {
            "F4": self.model.undo,
            "F5": self._toggle,
            "F8": lambda: self._go(pages.TOOLS),
            "F9": lambda: self._go(pages.SECCMP),
        }

    def _go(self, name: str) -> None:
        self.host.go(name)

    def _toggle(self) -> None:
        self.model.toggle_history()
        self.history.look_at(0)

    def typed(self, key: str) -> bool:
        """Figures and signs are the entry's; letters stay what they are everywhere, but for C on F9."""
        if self.history.isVisible() and key in {"Page up", "Page down"}:
            self.history.look_at(self.history.top + (1 if key == "Page down" else -1) * self.history.rows)
            return True
        return self.model.typed(key)

    def takes(self, key: str) -> bool:
        """Figures, signs, and C on F9."""
        return key in CHARACTERS or (key == "C" and self.NAME == pages.SECCMP)

    def _touched(self, key: str) -> None:
        if key == "Esc":
            self.host.press(key)
        else:
            self.typed(key)

    def prompt(self) -> str:
        """From the model."""
        return self.model.prompt(self.desk.snapshot())

    def opened(self) -> None:
        """What was changed on the other page is no news here."""
        self.model.opened()

    def leave(self) -> bool:
        """Nothing stays half entered."""
        self.model.leave()
        return True

    def escape(self) -> bool:
        """Esc goes one step back, and from the first question to the Automatic page."""
        if not self.model.escape():
            self.host.go(pages.AUTOMATIC)
        return True

    def refresh(self, snapshot: Snapshot, _view: View, _loaded: Loaded) -> None:
        """The table as the store has it, and the question."""
        model, mode = self.model, self.model.dialogue.mode
        model.look(snapshot)
        changes = model.looking_back
        self.history.setVisible(changes is not None)
        self.table.setVisible(changes is None)
        if changes is not None:
            self.history.show_entries(tuple(model.told(change) for change in changes))
        marked = {change.number for change in model.last}
        self.table.show_offsets(model.book.values[model.kind], model.dialogue.number, marked, mode)
        self.asked.show_dialogue(model)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Table over dialogue, the pad at their right."""
        u = self.look.u
        pad, high, gap = round(PAD * u), round(ASKED * u), max(4, round(0.7 * u))
        wide, table = self.width() - pad - gap, self.height() - high - gap
        for part in (self.table, self.history):
            part.setGeometry(0, 0, wide, table)
        self.asked.setGeometry(0, table + gap, wide, high)
        self.pad.setGeometry(wide + gap, 0, pad, self.height())


class SeccmpPage(OffsetPage):
    """F9, secondary offsets."""

    NAME = pages.SECCMP
    LABELS = ("MENU", "", "", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "", "")

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, seccmp(host.desk, host.desk.book))


class ToolsPage(OffsetPage):
    """F8, tool offsets."""

    NAME = pages.TOOLS
    LABELS = ("MENU", "", "", "UNDO", "HISTORY", "", "ALARMS", "", "SECCMP", "")

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, tool_offsets(host.desk, host.desk.book))
