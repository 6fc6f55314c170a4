"""F1, the main menu: one large target for each page, with the key that opens it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.screen import page_table
from app.screen.look import CENTRE, Look, Painter
from app.screen.page_base import Host, KeyActions, Page
from app.screen.page_table import IN_MENU, PageEntry
from app.screen.panel import Panel

_LABEL_OF = {entry.key: entry.label for entry in IN_MENU}
COLUMNS = 2


class MenuPage(Page):
    """The page that opens all others, by key or finger."""

    NAME = page_table.MENU
    LABELS = tuple(
        {"F1": "MENU", "F7": "ALARMS", **_LABEL_OF}.get(f"F{number}", "") for number in range(1, 11)
    )

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.list = _Tiles(self.look, host.press, self)

    def key_actions(self) -> KeyActions:
        """The function keys of the entries."""
        return {entry.key: partial(self._open, entry.name) for entry in IN_MENU}

    def _open(self, name: str) -> None:
        self.desk.clear()  # an answer to the key before has been read
        self.host.go(name)

    def prompt(self) -> str:
        """How a page is chosen."""
        return "PRESS A FUNCTION KEY OR TOUCH A PAGE; ESC FOR AUTOMATIC"

    def escape(self) -> bool:
        """Back to the Automatic page."""
        self.host.go(page_table.AUTOMATIC)
        return True

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """The tiles fill the page."""
        self.list.setGeometry(self.rect())


class _Tiles(Panel):
    """The entries in two columns."""

    title = page_table.MENU

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._press = press

    def draw(self, painter: Painter) -> None:
        u, room = self.look.u, self.inside()
        rows = -(-len(IN_MENU) // COLUMNS)
        wide, high = room.width() / COLUMNS, min(room.height() / rows, 13.0 * u)
        for number, entry in enumerate(IN_MENU):
            column, row = divmod(number, rows)
            box = QRectF(room.x() + column * wide, room.y() + row * high, wide - u, high - u)
            self._tile(painter, box, entry)
            self.place(box, partial(self._press, entry.key))

    def _tile(self, painter: Painter, box: QRectF, entry: PageEntry) -> None:
        u = self.look.u
        painter.box(box, "accent", 0.2, "key")
        painter.write(QRectF(box.x() + u, box.y(), 8 * u, box.height()), entry.key, 3.4, "accent", at=CENTRE)
        text = box.adjusted(10.5 * u, 0.14 * box.height(), -1.5 * u, -0.14 * box.height())
        text.setHeight(text.height() / 2)
        painter.write(text, entry.name, 3.0, "text")
        painter.write(text.translated(0, text.height()), entry.use, 1.9, "soft", bold=False)
