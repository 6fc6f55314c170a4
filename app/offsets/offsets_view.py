"""What F8 and F9 share: a table over a dialogue, a pad of keys for fingers at their right, the history."""

from __future__ import annotations

import math
from functools import partial
from typing import Protocol

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.machine_status import MachineStatus
from app.desk.program_loading import Loaded
from app.offsets.effect_shown import Rows, ShownEffect
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_history import Ledger
from app.offsets.offset_history_view import HistoryList
from app.path.path_pane_view import ZOOM_STEP
from app.path.path_view import PathView
from app.screen import page_table
from app.screen.entry_panel import AskedPanel, KeyPad
from app.screen.look import Look
from app.screen.page_base import Doings, Host, Page
from core.executor.snapshot import Snapshot

# --- The path before and after a change of offsets on one picture.


NEAR = 0.06  # of the width: how far apart the greatest change is shown from near


class EffectView(PathView):
    """Two pictures of the loaded program; the model says which."""

    def __init__(self, look: Look, model: ShownEffect, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model
        self._near = False
        self.hide()

    def show_effect(self) -> None:
        """What is drawn now, and draw on."""
        pair = self._model.pictures
        self.show_compared(pair.before if pair else None, pair.after if pair else None)
        if pair is not None and self._model.near != self._near:
            self._near = self._model.near
            self._go_near(pair.furthest) if self._near else self.fit()
        self.advance()

    def _go_near(self, apart: float) -> None:
        """So near to the greatest change that both paths are seen beside each other."""
        frame = self.view
        if frame is not None and math.isfinite(apart) and apart > 0.0:
            factor = NEAR * self.width() / (apart * frame.scale)
            self.zoom(max(0, math.ceil(math.log(factor, ZOOM_STEP))))

    def doings(self) -> Doings:
        """Looking around by keys, as on the Automatic page."""
        return {
            "Zoom in": partial(self.zoom, 1),
            "Zoom out": partial(self.zoom, -1),
            "Pan left": partial(self.pan, -1, 0),
            "Pan right": partial(self.pan, 1, 0),
            "Pan up": partial(self.pan, 0, -1),
            "Pan down": partial(self.pan, 0, 1),
        }


PAD, ASKED = 28.4, 12.4  # units: width of the pad, height of the dialogue


class OffsetModel(Protocol):
    """What both models offer to their page."""

    ledger: Ledger

    @property
    def book(self) -> OffsetBook: ...

    def look(self, snapshot: Snapshot) -> None: ...

    def prompt(self, snapshot: Snapshot) -> str: ...

    def typed(self, key: str) -> bool: ...

    def proposed(self) -> Rows: ...

    def undo(self) -> None: ...

    def escape(self) -> bool: ...

    def leave(self) -> None: ...


class OffsetPage(Page):
    """The model decides, this only shows it and hands the keys on."""

    def __init__(self, host: Host, parent: QWidget, model: OffsetModel) -> None:
        super().__init__(host, parent)
        self.shared = model
        self.history = HistoryList(self.look, self)
        self.asked = AskedPanel(self.look, self)
        self.shown = ShownEffect(host.desk, model.ledger, model.proposed)
        self.effect = EffectView(self.look, self.shown, self)
        own = ("C", "C") if self.NAME == page_table.SECCMP else None
        self.pad = KeyPad(self.look, self._touched, own=own, parent=self)

    def board(self) -> QWidget:
        """The table of this page."""
        raise NotImplementedError

    def show_offsets(self) -> None:
        """The table and the question as they are now."""
        raise NotImplementedError

    def doings(self) -> Doings:
        """Undo and history; Page up and Page down look through the latter."""
        around = self.effect.doings() if self.shown.open else {}
        return {
            **around,
            "F4": self.shared.undo,
            "F5": self._toggle,
            "F6": self._effect,
            "F8": lambda: self._go(page_table.TOOLS),
            "F9": lambda: self._go(page_table.SECCMP),
            "F10": lambda: self._go(page_table.ZERO),
        }

    def _go(self, name: str) -> None:
        self.host.go(name)

    def _toggle(self) -> None:
        self.shown.close()
        self.shared.ledger.toggle_history()
        self.history.look_at(0)

    def _effect(self) -> None:
        self.shared.ledger.looking_back = None
        self.shown.turn()

    def typed(self, key: str) -> bool:
        """Figures and signs are the entry's; letters stay what they are everywhere, but for C on F9."""
        if self.history.isVisible() and key in {"Page up", "Page down"}:
            self.history.look_at(self.history.top + (1 if key == "Page down" else -1) * self.history.rows)
            return True
        return self.shared.typed(key)

    def _touched(self, key: str) -> None:
        if key == "Esc":
            self.host.press(key)
        else:
            self.typed(key)

    def has_field(self) -> bool:
        """Figures are always typed here, but while one looks at what they do."""
        return not self.shown.open

    def prompt(self) -> str:
        """From the model; while the effect is shown, what it is."""
        if self.shown.open:
            return self.shown.words
        return self.shared.prompt(self.desk.snapshot())

    def dress(self) -> None:
        """The picture in the colours of now."""
        self.effect.restart()

    def opened(self) -> None:
        """What was changed on another page is no news here."""
        self.shared.ledger.opened()

    def leave(self) -> bool:
        """Nothing stays half entered."""
        self.shown.close()
        self.shared.leave()
        return True

    def escape(self) -> bool:
        """Esc goes one step back, and from the first question to the Automatic page."""
        if self.shown.open:
            self.shown.close()
        elif not self.shared.escape():
            self.host.go(page_table.AUTOMATIC)
        return True

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """The table as the store has it, and the question."""
        ledger = self.shared.ledger
        self.shared.look(snapshot)
        changes = ledger.looking_back
        self.history.setVisible(changes is not None)
        self.board().setVisible(changes is None and not self.shown.open)
        self.effect.setVisible(self.shown.open)
        if self.shown.open:
            self.effect.show_effect()
        if changes is not None:
            self.history.show_entries(tuple(ledger.told(change) for change in changes))
        self.show_offsets()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Table over dialogue, the pad at their right."""
        u = self.look.u
        pad, high, gap = round(PAD * u), round(ASKED * u), max(4, round(0.7 * u))
        wide, table = self.width() - pad - gap, self.height() - high - gap
        for part in (self.board(), self.history, self.effect):
            part.setGeometry(0, 0, wide, table)
        self.asked.setGeometry(0, table + gap, wide, high)
        self.pad.setGeometry(wide + gap, 0, pad, self.height())
