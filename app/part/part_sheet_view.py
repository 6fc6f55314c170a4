"""Page PART: findings or stock on the left, and the part after the selected block on the right."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.page_entry import editor_barred
from app.desk.pages.sheet import Key
from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.part.part_sheet import PartSheet, Section
from app.part.part_tables import table
from app.path.part_player import player_of
from app.path.path_view import PathView
from app.screen import page_table
from app.screen.entry_panel import KeyPad, LetterPad
from app.screen.page_base import Host, KeyActions
from app.screen.sheet_panel import ListPage, SheetPanel
from core.executor.snapshot import Snapshot
from core.language.diagnostics import Diagnostic

# ratio of the page width; units: width of the number pad, height of the letter pad
SHARE, PAD, LETTERS = 0.5, 28.4, 24.0


class PartView(PathView):
    """View of the part after the block of the selected finding, or at the time of the time line."""

    title = "PART"


class PartPage(ListPage):
    """Page PART: shows its model and passes the keys to it."""

    NAME = page_table.PART
    model: PartSheet

    def __init__(self, host: Host, model: PartSheet, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.table = SheetPanel(self.look, model.touch, self)
        self.path = PartView(self.look, self, player=player_of(host.desk))
        self.pad = KeyPad(self.look, self.touched, own=None, parent=self)
        self.letters = LetterPad(self.look, self.touched, self)
        self._loaded: Loaded | None = None
        self._shown: Diagnostic | None = None  # finding whose location the part view shows
        model.shows = self._show

    def page_keys(self) -> Mapping[str, Key]:
        """Return the function keys of the model."""
        return self.model.keys()

    def labels(self) -> tuple[str, ...]:
        """Return the labels of the displayed table and of the page."""
        return self.labels_of({"F3": "EDIT", "F5": "FIT", "F8": "TOOLS"}, self.page_keys())

    def barred(self) -> frozenset[str]:
        """Return the barred keys of the table, and F3 while the editor cannot be opened."""
        named = self.desk.session.now.path is not None
        closed = editor_barred(self.desk.snapshot(), named=named)
        return super().barred() | ({"F3"} if closed else set())

    def lively(self) -> bool:
        """Return whether the part is being played."""
        return self.path.player is not None and self.path.player.playing

    def key_actions(self) -> KeyActions:
        """Return the actions of the table, the time line and the view."""
        path = self.path
        return {
            **{name: key.action for name, key in self.page_keys().items()},
            "F3": partial(self.host.go, page_table.EDITOR),
            "F5": path.fit,
            "F8": partial(self.host.go, page_table.TOOLS),
            "View": path.next_view,
            **path.look_keys(),
            **path.play_keys(),
        }

    def has_field(self) -> bool:
        """Return whether a reason, a file name or a value of the stock is being typed."""
        return self.model.has_entry

    def dress(self) -> None:
        """Redraw the path in the present colors."""
        self.path.restart()

    def _show(self, found: Diagnostic) -> None:
        """Show the part after the block of the finding."""
        player = self.path.player
        assert player is not None
        self._shown = found
        if found.n:
            player.to_block(found.n)
        elif found.line:
            player.to_line(found.line)

    def refresh(self, _snapshot: Snapshot, _view: MachineStatus, loaded: Loaded) -> None:
        """Update the table and the part."""
        model = self.model
        model.look()
        sheet = table(model)
        self.table.show_sheet(sheet)
        self._show_part(loaded)
        figures = model.section is Section.STOCK and model.takes("1") and not model.has_keyboard
        if (figures, model.has_keyboard) != (not self.pad.isHidden(), not self.letters.isHidden()):
            self.pad.setVisible(figures)
            self.letters.setVisible(model.has_keyboard)
            self._lay_out()

    def _show_part(self, loaded: Loaded) -> None:
        if loaded is not self._loaded:
            self._loaded = loaded
            picture = loaded.picture
            self.path.show_picture(None if picture is not None and picture.scene is not None else picture)
            self.path.show_part()
            first = self.model.finding
            if first is not None and loaded.picture is not None and first is not self._shown:
                self._show(first)
        self.path.advance()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange table, part and pads."""
        self._lay_out()

    def _lay_out(self) -> None:
        u = self.look.u
        gap, left = max(4, round(0.7 * u)), round(SHARE * self.width())
        right, pad = self.width() - left - gap, 0 if self.pad.isHidden() else round(PAD * u) + gap
        low = 0 if self.letters.isHidden() else round(LETTERS * u) + gap
        self.table.setGeometry(0, 0, left, self.height())
        self.path.setGeometry(left + gap, 0, right - pad, self.height() - low)
        self.pad.setGeometry(self.width() - pad + gap, 0, max(0, pad - gap), self.height())
        self.letters.setGeometry(left + gap, self.height() - low + gap, right, max(0, low - gap))
