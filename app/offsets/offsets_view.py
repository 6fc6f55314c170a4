"""Common parts of the pages of tool, secondary and zero offsets.

A page has a table above the entry line, with a number pad for touch at the right. The history or the effect
of a change on the path replaces the table.
"""

from __future__ import annotations

import math
from functools import partial

from PySide6.QtCore import QEvent, QObject, QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.offsets.offset_effect import EffectDisplay
from app.offsets.offset_table import OffsetTable
from app.offsets.part_effect import part_table
from app.path.path_pane_view import ZOOM_STEP
from app.path.path_view import PathView
from app.screen import page_table
from app.screen.entry_panel import EntryPanel, EntryWords, KeyPad, LetterPad
from app.screen.look import Look, Painter
from app.screen.page_base import Host, KeyActions, ModelPage
from app.screen.panel import Panel, Shown
from app.screen.sheet_panel import RowPanel, SheetPanel
from app.screen.window_layout import FINGER
from core.executor.snapshot import Snapshot

PAD, ASKED = 28.4, 12.4  # Units: width of the pad, height of the entry line.
ROW = 5.2  # Units: height of one change in the history.
NEAR = 0.06  # Distance of the two paths in the close-up, as a fraction of the width.


class EffectView(PathView):
    """Shows the two paths of the loaded program that the model selects."""

    def __init__(self, look: Look, model: EffectDisplay, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model
        self._near = False
        self.hide()

    def show_effect(self) -> None:
        """Show the paths that are ready, and continue drawing."""
        pair = self._model.pictures
        self.show_compared(pair.before if pair else None, pair.after if pair else None)
        if pair is not None and self._model.near != self._near:
            self._near = self._model.near
            self._go_near(pair.furthest) if self._near else self.fit()
        self.advance()

    def _go_near(self, apart: float) -> None:
        """Zoom to the largest change, so that both paths are visible side by side."""
        frame = self.view
        if frame is not None and math.isfinite(apart) and apart > 0.0:
            factor = NEAR * self.width() / (apart * frame.scale)
            self.zoom(max(0, math.ceil(math.log(factor, ZOOM_STEP))))


Entry = tuple[str, str, str, str]


class HistoryList(RowPanel):
    """The list of changes, newest first, with two lines for each change."""

    title = "HISTORY  ·  NEWEST FIRST"

    entries: Shown[tuple[Entry, ...]] = Shown(())

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.hide()

    def draw(self, painter: Painter) -> None:
        u, room = self.look.u, self.inside()
        if not self.entries:
            head = QRectF(room.x(), room.y(), room.width(), 3 * u)
            painter.write(head, "No offset has been changed yet.", 2.0, "soft", bold=False)
        fits = self.fitting(room, ROW * u, len(self.entries))
        room.setHeight(fits * ROW * u)
        room = self.scrolled(painter, room, fits, len(self.entries))
        for number, box in self.boxes(room, ROW * u):
            self._entry(painter, box, self.entries[number])

    def _entry(self, painter: Painter, row: QRectF, entry: Entry) -> None:
        u = self.look.u
        at, which, change, why = entry
        painter.write(QRectF(row.x(), row.y(), 6 * u, 2.6 * u), which, 2.2, "accent")
        room = row.adjusted(6.4 * u, 0, 0, 0)
        painter.write(QRectF(room.x(), room.y(), room.width(), 2.6 * u), change, 2.0, "text")
        below = QRectF(room.x(), room.y() + 2.4 * u, room.width(), 2.2 * u)
        painter.write(below, f"{at}    {why}", 1.7, "soft", bold=False, fit=False)


class OffsetPage(ModelPage):
    """A page with an offset table, its history and the effect of a change. One of them is visible."""

    model: OffsetTable
    table: Panel

    def __init__(self, host: Host, parent: QWidget, model: OffsetTable) -> None:
        super().__init__(host, parent)
        self.model = model
        self.history = HistoryList(self.look, self)
        self.asked = EntryPanel(self.look, self)
        self.effect_model = EffectDisplay(model)
        self.effect = EffectView(self.look, self.effect_model, self)
        self.features = SheetPanel(self.look, lambda _row: None, self)
        self.features.hide()
        own = (model.own_key, model.own_key) if model.own_key else None
        self.pad = KeyPad(self.look, self.touched, own=own, parent=self)
        self.pad.hide()
        self.letters = LetterPad(self.look, self.touched, self)
        self.asked.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Show the number pad at a touch on the table. A touch on the entry line toggles the pad."""
        if event.type() == QEvent.Type.MouseButtonPress:
            self.show_pad(watched is not self.asked or self.pad.isHidden())
        return super().eventFilter(watched, event)

    def show_pad(self, shown: bool) -> None:
        """Show or hide the number pad. Without the pad, the table uses the full width."""
        if shown is self.pad.isHidden():
            self.pad.setVisible(shown)
            self._lay_out()

    def opened(self) -> None:
        """Inform the model that the page has opened, and let a touch on the table show the number pad."""
        super().opened()
        self.table.installEventFilter(self)

    def key_actions(self) -> KeyActions:
        """Return the key actions: undo, history, effect, and the other tables."""
        around = self.effect.look_keys() if self.effect_model.open else {}
        zero = {"F10": partial(self._go, page_table.ZERO)} if self.labels()[9] else {}
        return {
            **around,
            **zero,
            "F4": self.model.undo,
            "F5": self._toggle_history,
            "F6": self._turn_effect,
            "F8": partial(self._go, page_table.TOOLS),
            "F9": partial(self._go, page_table.SECCMP),
        }

    def barred(self) -> frozenset[str]:
        """Return the keys of the table that are disabled now."""
        return frozenset(key for key, why in self.barred_by().items() if why)

    def barred_by(self) -> dict[str, object]:
        """Return the reason for each disabled key, empty if the key is enabled."""
        nothing = not self.model.text and not self.model.history.undoable(self.model.chosen)
        return {"F4": self.model.undo_barred() or nothing, "F6": self.effect_model.barred()}

    def labels(self) -> tuple[str, ...]:
        """Return the key labels. If two keys open the same table, only the first has a label."""
        shown = super().labels()
        return shown if shown[8] != shown[9] else (*shown[:9], "")

    def _go(self, name: str) -> None:
        self.host.go(name)

    def _toggle_history(self) -> None:
        self.effect_model.close()
        self.model.history.toggle()
        self.history.top = 0

    def _turn_effect(self) -> None:
        self.model.history.listed = None
        self.effect_model.turn()

    def typed(self, key: str) -> bool:
        """Handle a key of the entry. While the effect is shown, characters are rejected with a message."""
        if self.history.isVisible() and key in {"Page up", "Page down"}:
            self.history.scroll_by((1 if key == "Page down" else -1) * self.history.rows)
            return True
        if self.effect_model.open and len(key) == 1 and self.model.takes(key):
            self.desk.say(tr("TYPE VALUES IN THE TABLE. ESC: SHOW TABLE"))
            return True
        return self.model.typed(key)

    def has_field(self) -> bool:
        """Return whether values can be entered, which is always so except while the effect is shown."""
        return not self.effect_model.open

    def prompt(self) -> str:
        """Return the prompt of the model, or the description of the effect while it is shown."""
        if self.effect_model.open:
            return self.effect_model.words
        return self.model.prompt(self.desk.snapshot())

    def dress(self) -> None:
        """Redraw the paths in the present colors."""
        self.effect.restart()

    def leave(self) -> bool:
        """Discard unfinished entries, and let the page close."""
        self.effect_model.close()
        self.model.leave()
        return True

    def esc_holds(self) -> bool:
        """Return False, because Esc goes one step back even while the machine moves."""
        return False

    def escape(self) -> bool:
        """Go one step back, or from the first question to the Automatic page."""
        if self.effect_model.open:
            self.effect_model.close()
        elif not self.model.escape():
            self.host.go(page_table.AUTOMATIC)
        return True

    def refresh(self, snapshot: Snapshot, _status: MachineStatus, _loaded: Loaded) -> None:
        """Show the visible part and the entry line. Subclasses also show their table."""
        model, effect = self.model, self.effect_model
        model.look(snapshot)
        changes = model.history.listed
        self.history.setVisible(changes is not None)
        self._show_letters(model.is_writing and not self.pad.isHidden())
        room = self.letters.isHidden() or self.table.height() >= 2 * FINGER
        self.table.setVisible(changes is None and not effect.open and room)
        part = effect.part
        self.effect.setVisible(effect.open and part is None)
        self.features.setVisible(part is not None)
        if part is not None:
            self.features.show_sheet(part_table(part, model.mode))
        elif effect.open:
            self.effect.show_effect()
        if changes is not None:
            self.history.entries = tuple(model.history.in_words(change) for change in changes)
        words = (model.heading, model.question, model.entered, model.old_to_new, model.foot)
        self.asked.asked = EntryWords(*words)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Lay out the table, the entry line, the number pad and the letter keyboard."""
        self._lay_out()

    def _show_letters(self, shown: bool) -> None:
        """Show the letter keyboard while a text is edited by touch, else the number pad."""
        if shown is self.letters.isHidden():
            self.letters.setVisible(shown)
            self._lay_out()

    def _lay_out(self) -> None:
        u, texts = self.look.u, not self.letters.isHidden()
        pad, high, gap = round(PAD * u), round(ASKED * u), max(4, round(0.7 * u))
        low = self.letters.least + gap if texts else 0
        wide = self.width() - (0 if self.pad.isHidden() or texts else pad + gap)
        table = self.height() - high - gap - low
        for part in (self.table, self.history, self.effect, self.features):
            part.setGeometry(0, 0, wide, table)
        self.asked.setGeometry(0, table + gap, wide, high)
        self.pad.setGeometry(self.width() - pad, 0, 0 if texts else pad, self.height())
        self.letters.setGeometry(0, self.height() - low + gap, wide, max(0, low - gap))
