"""The search field for all lists, which the window frame shows below the page."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Protocol

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.translation import tr
from app.screen.entry_panel import WIDE_NAME_KEYS, LetterPad, draw_text_with_caret
from app.screen.lists.list_search import ListSearch
from app.screen.lists.searchable_list import LIST_KEYS, SearchableList
from app.screen.page_base import Page
from app.screen.panel import Panel
from app.screen.screen_theme import ScreenTheme, ThemedPainter
from app.screen.window.alarm_panels import AlarmList
from app.screen.window.key_table import SEARCH_KEY
from app.screen.window.part_placement import GAP_PX
from app.screen.window_layout import FINGERTIP_PX, Rect
from core.executor.snapshot import Snapshot
from core.message import Message

DISCARD_TIME_S = 1.0  # Seconds without keys after which keys act again after a forced close.
_LATEST_PRESS_S = 3.0  # Seconds by which a press can be handled late, because the computer is busy.
SEARCH_CLOSED = "SEARCH CLOSED. ONLY STOP KEYS ACT UNTIL YOU STOP TYPING FOR 1 S"
_BAR_HEIGHT, _KEY_WIDTH, _LABEL_WIDTH = 5.6, 15.0, 14.0  # Units.


class SearchedWindow(Protocol):
    """The parts of the window whose lists can be searched."""

    current_page: Page
    alarm_list: AlarmList
    has_recent_manual_motion: bool  # The layout must not change yet.


class SearchBar(Panel):
    """Search field with keys that keep the found row or close the search.

    A touch on the field shows or hides the touch keyboard, which also opens with a touch on the search key of
    a list.
    """

    accessible_name = "SEARCH"
    background_color = "panel"

    def __init__(
        self,
        theme: ScreenTheme,
        desk: Desk,
        press: Callable[[str], None],
        searched_window: SearchedWindow,
        parent: QWidget,
    ) -> None:
        """Create the bar.

        ``press`` presses a key of the window. ``searched_window`` has the list that uses the keys now.
        """
        super().__init__(theme, parent)
        self._desk, self._press, self._window = desk, press, searched_window
        self.search = ListSearch()
        self.search.on_close = self._hide_at_once
        self.search.on_forced_close = self._start_discarding
        self._discard_end_s: float | None = None  # End of the discarding, unless another key is pressed.
        self.letter_pad = LetterPad(theme, self._handle_touched_key, parent, WIDE_NAME_KEYS)
        self.has_letters = False
        self._drawn: object = None
        self.hide()

    @property
    def is_open(self) -> bool:
        """Return whether a search is open."""
        return self.search.is_open

    @property
    def height_px(self) -> int:
        """Return the height that the field and the touch keyboard need, which is 0 if no search is open."""
        if not self.is_open:
            return 0
        return self._bar_height_px + (self.letter_pad.min_height_px + GAP_PX if self.has_letters else 0)

    @property
    def _bar_height_px(self) -> int:
        return max(FINGERTIP_PX, round(_BAR_HEIGHT * self.theme.unit_px))

    def _find_list(self) -> SearchableList | None:
        window = self._window
        return window.alarm_list if window.alarm_list.isVisible() else window.current_page.find_list()

    def move_selection(self, key: str) -> bool:
        """Move the selection with a page key, Home or End, and return whether a list used the key."""
        rows = self._find_list() if key in LIST_KEYS else None
        return rows is not None and rows.isVisible() and rows.move_selection(key)

    def _open_by_touch(self) -> None:
        self.has_letters = True
        self._press(SEARCH_KEY)

    def open_search(self) -> None:
        """Open the search in the list that uses the keys, or show the reason why this is not possible."""
        has_letters, self.has_letters = self.has_letters and not self.is_open, False
        searched_list, snapshot = self._find_list(), self._desk.read_snapshot()
        if self.is_open:
            return
        refusal = self._find_page_refusal() or self.search.find_refusal(searched_list, snapshot)
        if refusal or searched_list is None:
            self._desk.say(refusal)
            return
        self.has_letters, self._discard_end_s = has_letters, None
        self.search.open(searched_list, snapshot)

    def _find_page_refusal(self) -> str:
        """Return a hint if keys are discarded, a question is open, or the layout or an entry must wait."""
        window = self._window
        if self.is_discarding:
            return tr(SEARCH_CLOSED)
        if self._desk.confirmation_key:
            return tr("ANSWER THE QUESTION BEFORE SEARCHING")
        if window.has_recent_manual_motion:
            return tr("AXES HAVE JUST MOVED. SEARCH AGAIN AFTER 3 S")
        if window.alarm_list.isVisible() or not window.current_page.has_unfinished_entry():
            return ""
        return tr("ENTRY NOT FINISHED. PRESS ENTER OR ESC BEFORE SEARCHING")

    def handle_key(self, key: str) -> None:
        """Handle a key as text, as Enter, or as a key that selects a found row."""
        if self.search.handle_key(key):
            self._desk.prompt_line.clear_message()
        else:
            self._desk.say(tr("NO ROW CONTAINS THIS TEXT"))

    def _hide_at_once(self) -> None:
        """Hide the field and the touch keyboard, although the layout may have to wait."""
        self.hide()
        self.letter_pad.hide()
        self._window.current_page.is_searching = False

    def close_for_question(self) -> None:
        """Close the search if a question is open, so that no character of the text answers it."""
        if self._desk.confirmation_key:
            self.search.force_close()

    def _start_discarding(self) -> None:
        self._discard_end_s = self._desk.station_controls.clock() + DISCARD_TIME_S
        self._desk.say(tr(SEARCH_CLOSED))

    @property
    def is_discarding(self) -> bool:
        """Return whether the search was closed while the operator was perhaps still typing.

        The time of the press counts, also if the press is handled late. Without a press, the state ends after
        a few seconds.
        """
        end, now = self._discard_end_s, self._desk.station_controls.clock()
        if end is None or now >= end + _LATEST_PRESS_S:
            return False
        return now - self._desk.window_state.find_press_age_s() < end

    def discard_key(self, *, is_repeat: bool) -> bool:
        """Return whether a pressed key is discarded because it may be the rest of a searched text.

        This ends with the first press after one second without keys.
        """
        if self._discard_end_s is None:
            return False
        if not is_repeat and not self.is_discarding:
            self._discard_end_s = None
            return False
        self._start_discarding()
        return True

    def refuse_hidden_row(self) -> bool:
        """Return whether the search hides the selected row, so that no key may act on it, and say so."""
        if self.search.is_selection_hidden:
            self._desk.say(tr("NO ROW CONTAINS THIS TEXT"))
        return self.search.is_selection_hidden

    def handle_escape(self) -> bool:
        """Close an open search and select the former row. Return False if no search is open."""
        was_open = self.is_open
        self.search.cancel()
        return was_open

    def refresh(self, snapshot: Snapshot) -> None:
        """Update the search and the search key of the list, and redraw the field if it has changed."""
        self.close_for_question()
        self.search.update(snapshot)
        rows = self._find_list()
        if self.search.searched_list is not rows:
            self.search.force_close()
        if rows is not None:
            rows.on_search_key = self._open_by_touch if rows.can_be_searched else None
        shown = self.search.input_field.text, self._count_text, self.is_open
        if shown != self._drawn:
            self._drawn = shown
            self.update()

    def place_below(self, area: Rect) -> Rect:
        """Place the field and the touch keyboard in an area, and return the area above them."""
        high, bar = self.height_px, self._bar_height_px
        self.setVisible(self.is_open)
        self.letter_pad.setVisible(self.is_open and self.has_letters)
        if not high:
            return area
        top = area.y + area.h - high
        self.setGeometry(area.x, top, area.w, bar)
        self.letter_pad.setGeometry(area.x, top + bar + GAP_PX, area.w, self.letter_pad.min_height_px)
        return area._replace(h=max(0, area.h - high - GAP_PX))

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the field with the typed text, the number of found rows and the two keys."""
        if not self.is_open:
            return
        u, room = self.theme.unit_px, self.find_full_area()
        wide = max(float(FINGERTIP_PX), _KEY_WIDTH * u)
        label = QRectF(room.x() + u, room.y(), _LABEL_WIDTH * u, room.height())
        painter.draw_text_line(label, "SEARCH", 2.2, "text")
        count = QRectF(room.right() - 2 * (wide + 0.5 * u) - wide, room.y(), wide, room.height())
        painter.draw_text_line(count, self._count_text, 1.8, "soft", bold=False, raw=True, margin=0.4)
        box = QRectF(label.right(), room.y(), count.x() - 0.5 * u - label.right(), room.height())
        painter.draw_box(box.adjusted(0, 0.2 * u, 0, -0.2 * u), "accent", 0.2, "ground")
        draw_text_with_caret(painter, box.adjusted(u, 0, -u, 0), self.search.input_field.text, 2.6)
        self.add_target(box, self._toggle_letters, "KEYBOARD")
        for number, (name, key) in enumerate((("KEEP ROW", "Enter"), ("CLOSE", "Esc"))):
            at = room.right() - (2 - number) * (wide + 0.5 * u) + 0.5 * u
            target = QRectF(at, room.y(), wide, room.height())
            self.key(painter, target, name, 2.0, partial(self._handle_touched_key, key), margin=0.6)

    @property
    def _count_text(self) -> str:
        rows = self.search.searched_list
        if rows is None or rows.found_rows is None or not self.search.input_field.text:
            return ""
        count = len(rows.found_rows)
        return tr(Message("{count} FOUND", count=count))

    def _toggle_letters(self) -> None:
        self.has_letters = not self.has_letters

    def _handle_touched_key(self, key: str) -> None:
        if key == "Esc":
            self._press(key)
        else:
            self.handle_key(key)
