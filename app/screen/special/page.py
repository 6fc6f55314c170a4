"""F10, the special functions: the list at the left, the one that is chosen at the right."""

from __future__ import annotations

from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk import pages
from app.desk.session import Loaded
from app.desk.special.special import SpecialDesk
from app.desk.view import View
from app.screen.letters import LetterPad
from app.screen.offsets.keypad import KeyPad
from app.screen.pages import Doings, Host
from app.screen.special.items import ItemList
from app.screen.special.listpage import ListPage
from app.screen.special.table import SheetPanel
from core.executor.snapshot import Snapshot

LIST, PAD = 34.0, 28.4  # units: widths
LETTERS = 24.0  # units: height


class SpecialPage(ListPage):
    """The models decide; this shows them and hands the keys on."""

    NAME = pages.SPECIAL
    model: SpecialDesk

    def __init__(self, host: Host, model: SpecialDesk, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.items = ItemList(self.look, model, self._enter, self)
        self.table = SheetPanel(self.look, self._chosen, self)
        self.pad = KeyPad(self.look, self._touched, own=None, parent=self)
        self.letters = LetterPad(self.look, self._touched, self)

    def _enter(self, number: int) -> None:
        self.model.enter(number)

    def _chosen(self, row: int) -> None:
        self.model.inside = True
        self.model.section.choose(row)

    def _touched(self, key: str) -> None:
        self.model.inside = True
        if key == "Esc":
            self.host.press(key)
        else:
            self.model.typed(key)

    def labels(self) -> tuple[str, ...]:
        """Those of the function that is shown, beside the page's own."""
        return self.labels_of({}, self.model.section.keys())

    def doings(self) -> Doings:
        """The keys of the function that is shown; pressing one goes into it."""
        keys = self.model.section.keys()
        return {name: partial(self._do, name) for name in keys}

    def has_field(self) -> bool:
        """The question of a function that is open."""
        return self.model.inside and self.model.section.takes("1")

    def _do(self, name: str) -> None:
        self.model.inside = True
        self.model.section.keys()[name].action()

    def refresh(self, snapshot: Snapshot, _view: View, _loaded: Loaded) -> None:
        """The table of this snapshot."""
        self.model.look()
        section = self.model.section
        sheet = section.sheet(snapshot)
        self.items.show_items()
        self.table.show_sheet(sheet)
        letters = bool(sheet.question) and section.takes("a")
        figures = bool(sheet.question) and section.takes("1") and not letters
        if (figures, letters) != (not self.pad.isHidden(), not self.letters.isHidden()):
            self.pad.setVisible(figures)
            self.letters.setVisible(letters)
            self._lay_out()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """List, table and pad side by side."""
        self._lay_out()

    def _lay_out(self) -> None:
        u = self.look.u
        gap, left = max(4, round(0.7 * u)), round(LIST * u)
        pad = 0 if self.pad.isHidden() else round(PAD * u) + gap
        self.items.setGeometry(0, 0, left, self.height())
        low = 0 if self.letters.isHidden() else round(LETTERS * u) + gap
        right = self.width() - left - gap
        self.table.setGeometry(left + gap, 0, right - pad, self.height() - low)
        self.letters.setGeometry(left + gap, self.height() - low + gap, right, max(0, low - gap))
        self.pad.setGeometry(self.width() - pad + gap, 0, max(0, pad - gap), self.height())
