"""The main menu (F1), with a large touch target for each page and the key that opens the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.page_description import PageDescription
from app.desk.pages.page_entry import find_editor_refusal, find_mdi_refusal
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.screen import page_table
from app.screen.page_base import KeyActions, Page, PageHost
from app.screen.page_table import list_menu_entries, map_menu_keys
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ScreenTheme, ThemedPainter
from app.screen.window.key_table import MENU_KEYS
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import Snapshot

COLUMN_COUNT, LOW_COLUMN_COUNT = 2, 4  # A low menu has more columns and does not describe the pages.


class MenuPage(Page):
    """The page from which all other pages can be opened, by key or touch."""

    NAME = page_table.MENU

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        super().__init__(host, parent)
        self._entries = list_menu_entries(host.desk.machine.program_language)
        self._keys = map_menu_keys(host.desk.machine.program_language)
        labels = {"F1": "MENU", "F7": "ALARMS", **{key: each.menu_label for key, each in self._keys.items()}}
        self._labels = tuple(labels.get(f"F{number}", "") for number in range(1, 11))
        self.menu_list = _MenuTiles(self.theme, host.press_key, self._entries, self)

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the key labels of the pages that this machine has."""
        return self._labels

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the keys of the editor page and the MDI page while these pages cannot be opened."""
        snapshot, named = self.desk.read_snapshot(), self.desk.program_loader.loaded_program.path is not None
        found = {
            page_table.EDITOR: find_editor_refusal(snapshot, has_name=named),
            page_table.MDI: find_mdi_refusal(snapshot),
        }
        return frozenset(key for key, each in self._keys.items() if found.get(each.name))

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram) -> None:
        """Dim the tiles of pages that cannot be opened now."""
        super().refresh(snapshot, status, loaded)
        self.menu_list.disabled_pages = self.find_disabled_keys()

    def make_key_actions(self) -> KeyActions:
        """Return the actions of the menu's keys."""
        return {MENU_KEYS.get(key, key): partial(self._open, entry.name) for key, entry in self._keys.items()}

    def _open(self, name: str) -> None:
        self.desk.clear_prompt_line()  # The message for the previous key has been read.
        self.host.open_page(name)

    def prompt_text(self) -> str:
        """Return the instruction for choosing a page."""
        return "PRESS A FUNCTION KEY OR TAP A PAGE. ESC: AUTOMATIC"

    def is_esc_stop_key(self) -> bool:
        """Return False, because Esc opens the Automatic page even while the machine moves."""
        return False

    def handle_escape(self) -> bool:
        """Open the Automatic page."""
        self.host.open_page(page_table.AUTOMATIC)
        return True

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Resize the tiles so that they fill the page."""
        self.menu_list.setGeometry(self.rect())


class _MenuTiles(Panel):
    """The menu entries in two columns."""

    title = page_table.MENU
    disabled_pages: RedrawingAttribute[frozenset[str]] = RedrawingAttribute(
        frozenset()
    )  # Keys of pages that cannot be opened now.

    def __init__(
        self,
        theme: ScreenTheme,
        press: Callable[[str], None],
        entries: Sequence[PageDescription],
        parent: QWidget,
    ) -> None:
        super().__init__(theme, parent)
        self._press, self._entries = press, entries

    def draw(self, painter: ThemedPainter) -> None:
        u, room = self.theme.unit_px, self.inside()
        columns = COLUMN_COUNT
        rows = -(-len(self._entries) // columns)
        if room.height() / rows < 2 * self.theme.find_line_height(2.2) + u:
            columns = LOW_COLUMN_COUNT
            rows = -(-len(self._entries) // columns)
        wide, high = room.width() / columns, min(room.height() / rows, 13.0 * u)
        tall = max(high - u, min(high, FINGERTIP_PX))
        for number, entry in enumerate(self._entries):
            column, row = divmod(number, rows)
            box = QRectF(room.x() + column * wide, room.y() + row * high, wide - u, tall)
            self._tile(painter, box, entry, is_described=columns == COLUMN_COUNT)
            press = partial(self._press, MENU_KEYS.get(entry.key, entry.key))
            self.add_target(box, press, is_disabled=entry.key in self.disabled_pages)

    def _tile(
        self, painter: ThemedPainter, box: QRectF, entry: PageDescription, *, is_described: bool
    ) -> None:
        u = self.theme.unit_px
        barred = entry.key in self.disabled_pages
        ink = "soft" if barred else "accent"
        painter.draw_box(box, "frame" if barred else "accent", 0.2, "panel" if barred else "key")
        key_width = 8 * u if is_described else 6 * u
        painter.draw_text_line(
            QRectF(box.x() + 0.5 * u, box.y(), key_width, box.height()), entry.key, 3.4, ink, at=ALIGN_CENTER
        )
        if not is_described:
            name = box.adjusted(key_width + u, 0, -0.4 * u, 0)
            painter.draw_text_line(name, entry.name, 2.4, "soft" if barred else "text")
            return
        edge = max(0.0, min(0.14 * box.height(), 0.5 * box.height() - self.theme.find_line_height(2.4)))
        text = box.adjusted(10.0 * u, edge, -0.8 * u, -edge)
        text.setHeight(text.height() / 2)
        painter.draw_text_line(text, entry.name, 3.0, "soft" if barred else "text")
        painter.draw_text_line(text.translated(0, text.height()), entry.use, 1.9, "soft", bold=False)
