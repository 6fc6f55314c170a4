"""The page of G54 to G59: the table, the cell that is typed over, a pad of keys, and the history."""

from __future__ import annotations

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk import pages
from app.desk.offsets.dialogue import CHARACTERS
from app.desk.session import Loaded
from app.desk.view import View
from app.desk.words import tr
from app.desk.zero_offsets.desk import ZeroDesk
from app.desk.zero_offsets.figures import told
from app.screen.offsets.asked import Asked, AskedPanel
from app.screen.offsets.history import HistoryList
from app.screen.offsets.keypad import KeyPad
from app.screen.pages import Doings, Host, Page
from app.screen.zero_offsets.table import ZeroTable
from core.executor.snapshot import Snapshot

PAD, ASKED = 28.4, 12.4  # units: width of the pad, height of the entry


class ZeroPage(Page):
    """The model decides, this only shows it and hands the keys on."""

    NAME = pages.ZERO
    LABELS = ("MENU", "HERE", "", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "SECCMP", "")

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = ZeroDesk(host.desk)
        self.table = ZeroTable(self.look, self.model.choose, self)
        self.history = HistoryList(self.look, self)
        self.asked = AskedPanel(self.look, self)
        self.pad = KeyPad(self.look, self._touched, own=("C", "C"), parent=self)

    def doings(self) -> Doings:
        """The position of the machine, undo, history, and the other tables."""
        return {
            "F2": self.model.here,
            "F4": self.model.undo,
            "F5": self._toggle,
            "F8": lambda: self._go(pages.TOOLS),
            "F9": lambda: self._go(pages.SECCMP),
        }

    def _go(self, name: str) -> None:
        self.host.go(name)

    def _toggle(self) -> None:
        self.model.ledger.toggle_history()
        self.history.look_at(0)

    def typed(self, key: str) -> bool:
        """Figures and signs are the entry's; letters stay what they are everywhere, but for C."""
        if self.history.isVisible() and key in {"Page up", "Page down"}:
            self.history.look_at(self.history.top + (1 if key == "Page down" else -1) * self.history.rows)
            return True
        return self.model.typed(key)

    def takes(self, key: str) -> bool:
        """Figures, signs, and C."""
        return key in CHARACTERS or key == "C"

    def has_field(self) -> bool:
        """Figures are always typed here."""
        return True

    def _touched(self, key: str) -> None:
        if key == "Esc":
            self.host.press(key)
        else:
            self.typed(key)

    def prompt(self) -> str:
        """From the model."""
        return self.model.prompt(self.desk.snapshot())

    def opened(self) -> None:
        """What was changed elsewhere is no news here."""
        self.model.ledger.opened()

    def leave(self) -> bool:
        """Nothing stays half entered."""
        self.model.leave()
        return True

    def escape(self) -> bool:
        """Esc goes one step back, and then to the Automatic page."""
        if not self.model.escape():
            self.host.go(pages.AUTOMATIC)
        return True

    def refresh(self, snapshot: Snapshot, _view: View, _loaded: Loaded) -> None:
        """The table as the store has it, and the entry."""
        model = self.model
        model.ledger.look()
        changes = model.ledger.looking_back
        self.history.setVisible(changes is not None)
        self.table.setVisible(changes is None)
        if changes is not None:
            self.history.show_entries(tuple(told(change) for change in changes))
        self.table.show_rows(model.book.rows, (model.row, model.column), snapshot.modal.settable)
        foot = tr(
            "F2: where the machine stands reads what is typed        C: clear G54 to G59        Esc: exit"
        )
        self.asked.show_asked(Asked("", model.question, model.text, model.old_to_new, foot))

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Table over entry, the pad at their right."""
        u = self.look.u
        pad, high, gap = round(PAD * u), round(ASKED * u), max(4, round(0.7 * u))
        wide, table = self.width() - pad - gap, self.height() - high - gap
        for part in (self.table, self.history):
            part.setGeometry(0, 0, wide, table)
        self.asked.setGeometry(0, table + gap, wide, high)
        self.pad.setGeometry(wide + gap, 0, pad, self.height())
