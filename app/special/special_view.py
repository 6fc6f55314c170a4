"""Page of the special functions (F10): list on the left, displayed function on the right."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.sheet import Key
from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.screen import page_table
from app.screen.entry_panel import KeyPad, LetterPad
from app.screen.look import CENTRE, Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Shown
from app.screen.sheet_panel import ListPage, RowPanel, SheetPanel
from app.screen.window_layout import FINGER
from app.special.special_functions import SpecialFunctions
from core.executor.snapshot import Snapshot

# --- list of functions -------------------------------------------------------------------------------------


ROW, GAP = 7.0, 0.4  # units: height of a row and the gap below it


class ItemList(RowPanel):
    """List of functions. The displayed function is highlighted and has a wide bar while it has the keys.

    Rows are at least a fingertip high. If not all rows fit, the list scrolls with two keys and the wheel.
    """

    title = "SPECIAL FUNCTIONS"
    notch = 1
    mark: Shown[object] = Shown(None)  # present position; a change redraws the list

    def __init__(
        self, look: Look, model: SpecialFunctions, enter: Callable[[int], None], parent: QWidget
    ) -> None:
        super().__init__(look, parent)
        self.model, self._enter = model, enter

    @property
    def _high(self) -> float:
        """Height of a row in pixels, at least that of a fingertip with the gap."""
        return max(ROW * self.look.u, FINGER + GAP * self.look.u)

    def draw(self, painter: Painter) -> None:
        functions, high, room = self.model.functions, self._high, self.inside()
        fits = self.fitting(room, high, len(functions))
        room = self.scrolled(painter, room, fits, len(functions), self.model.at)
        for number, row in self.boxes(room, high):
            box = row.adjusted(0, 0, 0, -GAP * self.look.u)
            self._item(painter, box, number, functions[number].name, functions[number].use)
            self.place(box, partial(self._enter, number), kind="row", on=number == self.model.at)

    def _item(self, painter: Painter, box: QRectF, number: int, name: str, use: str) -> None:
        u = self.look.u
        here = number == self.model.at
        painter.fill(box, "here" if here else "key")
        if here:
            wide = (1.0 if self.model.inside else 0.4) * u
            painter.fill(QRectF(box.x(), box.y(), wide, box.height()), "lit")
        figure = QRectF(box.x() + u, box.y(), 3.6 * u, box.height())
        painter.write(figure, str(number + 1), 2.6, "accent", at=CENTRE)
        text = box.adjusted(5.2 * u, 0.1 * box.height(), -0.6 * u, -0.1 * box.height())
        painter.write(QRectF(text.x(), text.y(), text.width(), 0.55 * text.height()), name, 2.0, "text")
        below = QRectF(text.x(), text.y() + 0.55 * text.height(), text.width(), 0.45 * text.height())
        painter.write(below, use, 1.6, "text" if here else "soft", bold=False)


LIST, PAD = 34.0, 28.4  # units: widths of the list and the number pad
LETTERS = 24.0  # units: height of the letter pad


class SpecialPage(ListPage):
    """Page of the special functions: shows the models and passes the keys to them."""

    NAME = page_table.SPECIAL
    model: SpecialFunctions

    def __init__(self, host: Host, model: SpecialFunctions, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.items = ItemList(self.look, model, self._enter, self)
        self.table = SheetPanel(self.look, self._chosen, self)
        self.pad = KeyPad(self.look, self.touched, own=None, parent=self)
        self.letters = LetterPad(self.look, self.touched, self)

    def _enter(self, number: int) -> None:
        self.model.enter(number)
        self._page_instead()

    def typed(self, key: str) -> bool:
        """Handle a key as in every list. A function with a separate page opens that page."""
        taken = super().typed(key)
        if taken:
            self._page_instead()
        return taken

    def _page_instead(self) -> None:
        shown = self.model.current
        if self.model.inside and shown.page:
            self.model.inside = False
            self.host.go(shown.page)

    def _chosen(self, row: int) -> None:
        self.model.inside = True
        self.model.current.choose(row)
        self._page_instead()

    def touched(self, key: str) -> None:
        """Pass a touched key to the displayed function."""
        self.model.inside = True
        super().touched(key)

    def page_keys(self) -> Mapping[str, Key]:
        """Return the function keys of the displayed function."""
        return self.model.current.keys()

    def labels(self) -> tuple[str, ...]:
        """Return the labels of the displayed function and of the page."""
        return self.labels_of({}, self.page_keys())

    def key_actions(self) -> KeyActions:
        """Return the key actions of the displayed function. Pressing one opens the function."""
        keys = self.model.current.keys()
        return {name: partial(self._do, name) for name in keys}

    def has_field(self) -> bool:
        """Return whether an open function has an entry."""
        return self.model.inside and self.model.current.takes("1")

    def _do(self, name: str) -> None:
        self.model.inside = True
        self.model.current.keys()[name].action()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Show the table for a snapshot."""
        self.model.look()
        shown = self.model.current
        sheet = shown.sheet(snapshot)
        self.items.mark = (self.model.at, self.model.inside)
        self.table.show_sheet(sheet)
        letters = bool(sheet.question) and shown.takes("a")
        figures = bool(sheet.question) and shown.takes("1") and not letters
        if (figures, letters) != (not self.pad.isHidden(), not self.letters.isHidden()):
            self.pad.setVisible(figures)
            self.letters.setVisible(letters)
            self._lay_out()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange list, table and pads."""
        self._lay_out()

    def _lay_out(self) -> None:
        u = self.look.u
        gap, left = max(4, round(0.7 * u)), round(LIST * u)
        pad = 0 if self.pad.isHidden() else round(PAD * u) + gap
        self.items.setGeometry(0, 0, left, self.height())
        letters = max(round(LETTERS * u), self.letters.least)
        low = 0 if self.letters.isHidden() else letters + gap
        right = self.width() - left - gap
        self.table.setGeometry(left + gap, 0, right - pad, self.height() - low)
        self.letters.setGeometry(left + gap, self.height() - low + gap, right, max(0, low - gap))
        self.pad.setGeometry(self.width() - pad + gap, 0, max(0, pad - gap), self.height())
