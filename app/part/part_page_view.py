"""The PART page, with findings or stock on the left and a picture of the part on the right.

The picture shows the part as it is after the selected block.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.page_entry import find_editor_refusal
from app.desk.pages.table_content import FunctionKey
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.part.part_model import PartPageModel, PartPageTable
from app.part.part_tables import make_table
from app.path.part_player import make_part_player
from app.path.path_view import PathView
from app.screen import page_table
from app.screen.entry_panel import LetterPad, NumberPad
from app.screen.page_base import KeyActions, PageHost
from app.screen.table_panel import ListPage, TablePanel
from core.executor.snapshot import Snapshot
from core.language.diagnostics import Diagnostic

# ratio of the page width; units: width of the number pad, height of the letter pad
SHARE, PAD, LETTERS = 0.5, 28.4, 24.0


class PartPathView(PathView):
    """View of the part after the block of the selected finding, or at the timeline's time."""

    title = "PART"


class PartPage(ListPage):
    """The PART page, which displays its model and passes key presses to it."""

    NAME = page_table.PART
    model: PartPageModel

    def __init__(self, host: PageHost, model: PartPageModel, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.table_panel = TablePanel(self.theme, model.handle_row_touch, self)
        self.table_panel.on_select = model.select_row
        self.path_view = PartPathView(self.theme, self, part_player=make_part_player(host.desk))
        self.number_pad = NumberPad(self.theme, self.handle_touched_key, page_key=None, parent=self)
        self.letter_pad = LetterPad(self.theme, self.handle_touched_key, self)
        self._loaded: LoadedProgram | None = None
        self._shown: Diagnostic | None = None  # finding whose location the part view shows
        model.show_location = self._show

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys of the model."""
        return self.model.make_function_keys()

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the labels of the keys that the displayed table and the page use."""
        return self.make_function_key_labels(
            {"F3": "EDIT", "F5": "FIT", "F8": "TOOLS"}, self.make_function_keys()
        )

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the disabled keys of the table, and F3 while the editor cannot be opened."""
        named = self.desk.program_loader.loaded_program.path is not None
        closed = find_editor_refusal(self.desk.read_snapshot(), has_name=named)
        return super().find_disabled_keys() | ({"F3"} if closed else set())

    def is_animating(self) -> bool:
        """Return whether the part view is playing."""
        return self.path_view.part_player is not None and self.path_view.part_player.is_playing

    def make_key_actions(self) -> KeyActions:
        """Return the key actions of the table, the timeline and the view."""
        path = self.path_view
        return {
            **{name: key.action for name, key in self.make_function_keys().items()},
            "F3": partial(self.host.open_page, page_table.EDITOR),
            "F5": path.fit_all_panes,
            "F8": partial(self.host.open_page, page_table.TOOLS),
            "View": path.select_next_view,
            **path.make_view_key_actions(),
            **path.make_part_key_actions(),
        }

    def find_list(self) -> TablePanel | None:
        """Return the table, unless a reason or a file name is being typed."""
        return None if self.model.is_entering_text else self.table_panel

    def has_text_field(self) -> bool:
        """Return whether a reason, a file name or a value of the stock can be typed."""
        return self.model.has_entry

    def apply_theme(self) -> None:
        """Redraw the path in the current colors."""
        self.path_view.redraw()

    def _show(self, found: Diagnostic) -> None:
        """Show the part after the block that caused the finding."""
        player = self.path_view.part_player
        assert player is not None
        self._shown = found
        if found.block_number:
            player.seek_block(found.block_number)
        elif found.line:
            player.seek_line(found.line)

    def refresh(self, _snapshot: Snapshot, _view: MachineStatus, loaded: LoadedProgram) -> None:
        """Update the table and the part."""
        model = self.model
        model.poll()
        sheet = make_table(model)
        self.table_panel.show_table(sheet)
        self._show_part(loaded)
        has_pad = (
            model.shown_table is PartPageTable.STOCK and model.accepts_key("1") and not model.is_entering_text
        )
        if (has_pad, model.is_entering_text) != (
            not self.number_pad.isHidden(),
            not self.letter_pad.isHidden(),
        ):
            self.number_pad.setVisible(has_pad)
            self.letter_pad.setVisible(model.is_entering_text)
            self._lay_out()

    def _show_part(self, loaded: LoadedProgram) -> None:
        if loaded is not self._loaded:
            self._loaded = loaded
            picture = loaded.picture
            self.path_view.show_picture(
                None if picture is not None and picture.mill_scene is not None else picture
            )
            self.path_view.show_part()
            first = self.model.selected_finding
            if first is not None and loaded.picture is not None and first is not self._shown:
                self._show(first)
        self.path_view.continue_drawing()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the table, the part and the pads."""
        self._lay_out()

    def _lay_out(self) -> None:
        u = self.theme.unit_px
        gap, left = max(4, round(0.7 * u)), round(SHARE * self.width())
        right, pad = self.width() - left - gap, 0 if self.number_pad.isHidden() else round(PAD * u) + gap
        low = 0 if self.letter_pad.isHidden() else round(LETTERS * u) + gap
        self.table_panel.setGeometry(0, 0, left, self.height())
        self.path_view.setGeometry(left + gap, 0, right - pad, self.height() - low)
        self.number_pad.setGeometry(self.width() - pad + gap, 0, max(0, pad - gap), self.height())
        self.letter_pad.setGeometry(left + gap, self.height() - low + gap, right, max(0, low - gap))
