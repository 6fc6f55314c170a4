"""Common parts of the pages of tool, secondary and zero offsets.

A page has a table above the entry line, with a number pad for touch on the right. The history or the effect
of a change on the path can replace the table.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import QEvent, QObject, QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.field_help import make_field_help
from app.desk.pages.guide_text import GuideBlock
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.offsets.offset_effect import EffectDisplay
from app.offsets.offset_table import OffsetTable
from app.offsets.part_effect import make_part_table
from app.path.path_pane_view import ZOOM_STEP
from app.path.path_view import PathView
from app.screen import page_table
from app.screen.entry_panel import EntryPanel, EntryTexts, LetterPad, NumberPad
from app.screen.page_base import KeyActions, ModelPage, PageHost
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ScreenTheme, ThemedPainter
from app.screen.table_panel import RowPanel, TablePanel
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import Snapshot

PAD, ASKED = 28.4, 12.4  # Units: width of the pad, height of the entry line.
ROW_HEIGHT = 5.2  # Units: height of one change in the history.
CLOSE_UP_SEPARATION = 0.06  # Distance of the two paths in the close-up, as a fraction of the width.


class OffsetEffectView(PathView):
    """Picture of the loaded program's paths, calculated with the old and with the new offsets.

    The model selects which two paths are compared.
    """

    def __init__(self, theme: ScreenTheme, model: EffectDisplay, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._model = model
        self._near = False
        self.hide()

    def update_effect(self) -> None:
        """Show the old and new paths that are already calculated, and continue drawing them."""
        pair = self._model.compared_paths
        self.show_comparison(pair.picture_before if pair else None, pair.picture_after if pair else None)
        if pair is not None and self._model.is_close_up_shown != self._near:
            self._near = self._model.is_close_up_shown
            self._zoom_to_difference(pair.largest_distance_mm) if self._near else self.fit_all_panes()
        self.continue_drawing()

    def _zoom_to_difference(self, difference: float) -> None:
        """Zoom in on the largest change, so that both paths are visible side by side."""
        frame = self.first_projection
        if frame is not None and math.isfinite(difference) and difference > 0.0:
            factor = CLOSE_UP_SEPARATION * self.width() / (difference * frame.pixels_per_mm)
            self.zoom_view(max(0, math.ceil(math.log(factor, ZOOM_STEP))))


HistoryEntry = tuple[str, str, str, str]


class ChangeHistoryList(RowPanel):
    """List of all offset changes, newest first, with two lines for each change."""

    title = "HISTORY  ·  NEWEST FIRST"
    is_searchable = True

    history_entries: RedrawingAttribute[tuple[HistoryEntry, ...]] = RedrawingAttribute(())

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self.hide()

    def list_row_texts(self) -> Sequence[str]:
        """Return the texts of each change."""
        return [" ".join(map(tr, entry)) for entry in self.history_entries]

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the visible changes, or a message that no offset has been changed."""
        u, room = self.theme.unit_px, self.inside()
        if not self.history_entries:
            head = QRectF(room.x(), room.y(), room.width(), 3 * u)
            painter.draw_text_line(head, "No offset has been changed yet.", 2.0, "soft", bold=False)
        fits = self.count_fitting_rows(room, ROW_HEIGHT * u, len(self.history_entries))
        room.setHeight(fits * ROW_HEIGHT * u)
        room = self.draw_scroll_keys(painter, room, fits, len(self.history_entries))
        for number, box in self.find_row_boxes(room, ROW_HEIGHT * u):
            self._entry(painter, box, self.history_entries[number])

    def _entry(self, painter: ThemedPainter, row: QRectF, entry: HistoryEntry) -> None:
        u = self.theme.unit_px
        at, which, change, why = entry
        painter.draw_text_line(QRectF(row.x(), row.y(), 6 * u, 2.6 * u), which, 2.2, "accent")
        room = row.adjusted(6.4 * u, 0, 0, 0)
        painter.draw_text_line(QRectF(room.x(), room.y(), room.width(), 2.6 * u), change, 2.0, "text")
        below = QRectF(room.x(), room.y() + 2.4 * u, room.width(), 2.2 * u)
        painter.draw_text_line(below, f"{at}    {why}", 1.7, "soft", bold=False, fit=False)


class OffsetPage(ModelPage):
    """A page that shows an offset table, its history, or the effect of a change."""

    model: OffsetTable
    content_panel: Panel

    def __init__(self, host: PageHost, parent: QWidget, model: OffsetTable) -> None:
        super().__init__(host, parent)
        self.model = model
        self.history_list = ChangeHistoryList(self.theme, self)
        self.entry_panel = EntryPanel(self.theme, self)
        self.effect_display = EffectDisplay(model)
        self.effect_view = OffsetEffectView(self.theme, self.effect_display, self)
        self.feature_table = TablePanel(self.theme, lambda _row: None, self)
        self.feature_table.hide()
        own = (model.page_key, model.page_key) if model.page_key else None
        self.number_pad = NumberPad(self.theme, self.handle_touched_key, page_key=own, parent=self)
        self.number_pad.hide()
        self.letter_pad = LetterPad(self.theme, self.handle_touched_key, self)
        self.entry_panel.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Show the number pad on a touch of the table, and toggle it on a touch of the entry line."""
        if event.type() == QEvent.Type.MouseButtonPress and not self.is_searching:
            self.set_number_pad_visible(watched is not self.entry_panel or self.number_pad.isHidden())
        return super().eventFilter(watched, event)

    def set_number_pad_visible(self, is_shown: bool) -> None:
        """Show or hide the number pad.

        Without the pad, the table uses the full width.
        """
        if is_shown is self.number_pad.isHidden():
            self.number_pad.setVisible(is_shown)
            self._lay_out()

    def on_open(self) -> None:
        """Notify the model that the page has opened, and let a touch on the table show the number pad."""
        super().on_open()
        self.content_panel.installEventFilter(self)

    def make_key_actions(self) -> KeyActions:
        """Return the key actions for undo, history, effect and the other tables."""
        around = self.effect_view.make_view_key_actions() if self.effect_display.is_open else {}
        zero = {"F10": partial(self._go, page_table.ZERO)} if self.make_key_labels()[9] else {}
        return {
            **around,
            **zero,
            "F4": self.model.handle_undo,
            "F5": self._toggle_history,
            "F6": self._turn_effect,
            "F8": partial(self._go, page_table.TOOLS),
            "F9": partial(self._go, page_table.SECCMP),
        }

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the function keys of the page that are currently disabled."""
        return frozenset(key for key, why in self.find_key_refusals().items() if why)

    def find_key_refusals(self) -> dict[str, object]:
        """Return, for each key, the reason why it is disabled.

        The reason is empty if the key is enabled.
        """
        nothing = not self.model.text and not self.model.offset_history.can_undo(
            self.model.selected_row_number
        )
        return {
            "F4": self.model.find_undo_refusal() or nothing,
            "F6": self.effect_display.find_display_refusal(),
        }

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the key labels.

        If two keys open the same table, only the first key has a label.
        """
        shown = super().make_key_labels()
        return shown if shown[8] != shown[9] else (*shown[:9], "")

    def _go(self, name: str) -> None:
        self.host.open_page(name)

    def _toggle_history(self) -> None:
        self.effect_display.close_view()
        self.model.offset_history.toggle_change_list()
        self.history_list.first_row = 0

    def _turn_effect(self) -> None:
        self.model.offset_history.listed_changes = None
        self.effect_display.show_next_view()

    def handle_key(self, key: str) -> bool:
        """Handle a key of the entry line.

        While the effect on the path is shown, characters are rejected with a message.
        """
        if self.effect_display.is_open and len(key) == 1 and self.model.accepts_key(key):
            self.desk.say(tr("TYPE VALUES IN THE TABLE. ESC: SHOW TABLE"))
            return True
        return self.model.handle_key(key)

    def find_list(self) -> RowPanel | None:
        """Return the history or the table, unless a text is being typed or the effect is shown."""
        if self.history_list.isVisible():
            return self.history_list
        is_hidden = self.effect_display.is_open or self.model.is_text_open
        return self.content_panel if isinstance(self.content_panel, RowPanel) and not is_hidden else None

    def has_text_field(self) -> bool:
        """Return True unless the effect on the path is shown, because values cannot be entered then."""
        return not self.effect_display.is_open

    def has_unfinished_entry(self) -> bool:
        """Return whether a value or a text must be saved or discarded first."""
        return bool(self.model.text) or self.model.is_text_open

    def prompt_text(self) -> str:
        """Return the prompt of the table, or a description of the path effect while it is shown."""
        if self.effect_display.is_open:
            return self.effect_display.words
        return self.model.prompt_text(self.desk.read_snapshot())

    def find_marked_help(self) -> Sequence[GuideBlock]:
        """Return the help text for the selected field."""
        return make_field_help(self.model.kind, self.model.selected_field_name, self.model.question_text)

    def apply_theme(self) -> None:
        """Redraw the paths in the current colors."""
        self.effect_view.redraw()

    def try_leave_page(self) -> bool:
        """Discard unfinished entries, and allow the page to close."""
        self.effect_display.close_view()
        self.model.on_close()
        return True

    def is_esc_stop_key(self) -> bool:
        """Return False, because Esc closes a part of this page even while the machine moves."""
        return False

    def handle_escape(self) -> bool:
        """Close what is open: the effect, the history, a question or an entry.

        If nothing is open, go to the Automatic page.
        """
        if self.effect_display.is_open:
            self.effect_display.close_view()
        elif not self.model.handle_escape():
            self.host.open_page(page_table.AUTOMATIC)
        return True

    def refresh(self, snapshot: Snapshot, _status: MachineStatus, _loaded: LoadedProgram) -> None:
        """Update the entry line and the visible table, history or effect.

        Subclasses also update their own table.
        """
        model, effect = self.model, self.effect_display
        model.update(snapshot)
        changes = model.offset_history.listed_changes
        self.history_list.setVisible(changes is not None)
        self._show_letters(model.is_editing_text and not self.number_pad.isHidden())
        room = self.letter_pad.isHidden() or self.content_panel.height() >= 2 * FINGERTIP_PX
        self.content_panel.setVisible(changes is None and not effect.is_open and room)
        part = effect.compared_part
        self.effect_view.setVisible(effect.is_open and part is None)
        self.feature_table.setVisible(part is not None)
        if part is not None:
            self.feature_table.show_table(make_part_table(part, model.unit_mode))
        elif effect.is_open:
            self.effect_view.update_effect()
        if changes is not None:
            self.history_list.history_entries = tuple(
                model.offset_history.format_change(change) for change in changes
            )
        words = (
            model.heading,
            model.question_text,
            model.entered_text,
            model.change_description,
            model.footer_text,
        )
        self.entry_panel.entry_texts = EntryTexts(*words)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the table, the entry line, the number pad and the letter keyboard."""
        self._lay_out()

    def _show_letters(self, shown: bool) -> None:
        """Show the letter keyboard while a text is edited by touch, and otherwise the number pad."""
        if shown is self.letter_pad.isHidden():
            self.letter_pad.setVisible(shown)
            self._lay_out()

    def _lay_out(self) -> None:
        if self.is_searching:
            self.number_pad.hide()
        u, texts = self.theme.unit_px, not self.letter_pad.isHidden()
        pad, gap = round(PAD * u), max(4, round(0.7 * u))
        high = -gap if self.is_searching else round(ASKED * u)
        low = self.letter_pad.min_height_px + gap if texts else 0
        wide = self.width() - (0 if self.number_pad.isHidden() or texts else pad + gap)
        table = self.height() - high - gap - low
        for part in (self.content_panel, self.history_list, self.effect_view, self.feature_table):
            part.setGeometry(0, 0, wide, table)
        self.entry_panel.setVisible(not self.is_searching)
        self.entry_panel.setGeometry(0, table + gap, wide, max(0, high))
        self.number_pad.setGeometry(self.width() - pad, 0, 0 if texts else pad, self.height())
        self.letter_pad.setGeometry(0, self.height() - low + gap, wide, max(0, low - gap))
