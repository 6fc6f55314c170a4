"""The main menu (F1), with a large target for each page and the key that opens it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.page_description import PageEntry
from app.desk.pages.page_entry import editor_barred, mdi_barred
from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.screen import page_table
from app.screen.look import CENTRE, Look, Painter
from app.screen.page_base import Host, KeyActions, Page
from app.screen.page_table import menu_keys, menu_of
from app.screen.panel import Panel, Shown
from app.screen.window.keys import OF_MENU
from app.screen.window_layout import FINGER
from core.executor.snapshot import Snapshot

COLUMNS = 2


class MenuPage(Page):
    """The page that opens all other pages, by key or touch."""

    NAME = page_table.MENU

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent)
        self._entries = menu_of(host.desk.machine.language)
        self._keys = menu_keys(host.desk.machine.language)
        labels = {"F1": "MENU", "F7": "ALARMS", **{key: each.label for key, each in self._keys.items()}}
        self._labels = tuple(labels.get(f"F{number}", "") for number in range(1, 11))
        self.list = _Tiles(self.look, host.press, self._entries, self)

    def labels(self) -> tuple[str, ...]:
        """Return the labels of the pages that this machine has."""
        return self._labels

    def barred(self) -> frozenset[str]:
        """Return the keys of the editor and MDI while those pages cannot be opened."""
        snapshot, named = self.desk.snapshot(), self.desk.session.now.path is not None
        found = {
            page_table.EDITOR: editor_barred(snapshot, named=named),
            page_table.MDI: mdi_barred(snapshot),
        }
        return frozenset(key for key, each in self._keys.items() if found.get(each.name))

    def refresh(self, snapshot: Snapshot, view: MachineStatus, loaded: Loaded) -> None:
        """Dim the tiles of pages that cannot be opened now."""
        super().refresh(snapshot, view, loaded)
        self.list.barred = self.barred()

    def key_actions(self) -> KeyActions:
        """Return the actions of the menu's keys."""
        return {OF_MENU.get(key, key): partial(self._open, entry.name) for key, entry in self._keys.items()}

    def _open(self, name: str) -> None:
        self.desk.clear()  # The message for the previous key has been read.
        self.host.go(name)

    def prompt(self) -> str:
        """Return the instruction for choosing a page."""
        return "PRESS A FUNCTION KEY OR TAP A PAGE. ESC: AUTOMATIC"

    def esc_holds(self) -> bool:
        """Return False, because Esc opens the Automatic page even while the machine moves."""
        return False

    def escape(self) -> bool:
        """Open the Automatic page."""
        self.host.go(page_table.AUTOMATIC)
        return True

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Let the tiles fill the page."""
        self.list.setGeometry(self.rect())


class _Tiles(Panel):
    """The menu entries in two columns."""

    title = page_table.MENU
    barred: Shown[frozenset[str]] = Shown(frozenset())  # Keys of pages that cannot be opened now.

    def __init__(
        self, look: Look, press: Callable[[str], None], entries: Sequence[PageEntry], parent: QWidget
    ) -> None:
        super().__init__(look, parent)
        self._press, self._entries = press, entries

    def draw(self, painter: Painter) -> None:
        u, room = self.look.u, self.inside()
        rows = -(-len(self._entries) // COLUMNS)
        wide, high = room.width() / COLUMNS, min(room.height() / rows, 13.0 * u)
        tall = max(high - u, min(high, FINGER))
        for number, entry in enumerate(self._entries):
            column, row = divmod(number, rows)
            box = QRectF(room.x() + column * wide, room.y() + row * high, wide - u, tall)
            self._tile(painter, box, entry)
            press = partial(self._press, OF_MENU.get(entry.key, entry.key))
            self.place(box, press, barred=entry.key in self.barred)

    def _tile(self, painter: Painter, box: QRectF, entry: PageEntry) -> None:
        u = self.look.u
        barred = entry.key in self.barred
        ink = "soft" if barred else "accent"
        painter.box(box, "frame" if barred else "accent", 0.2, "panel" if barred else "key")
        painter.write(QRectF(box.x() + u, box.y(), 8 * u, box.height()), entry.key, 3.4, ink, at=CENTRE)
        text = box.adjusted(10.5 * u, 0.14 * box.height(), -1.5 * u, -0.14 * box.height())
        text.setHeight(text.height() / 2)
        painter.write(text, entry.name, 3.0, "soft" if barred else "text")
        painter.write(text.translated(0, text.height()), entry.use, 1.9, "soft", bold=False)
