"""The PROGRAMS page, with the list on the left and the selected program on the right.

A preview and details of the selected program are shown.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF
from PySide6.QtGui import QImage, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.page_description import ProgramKey
from app.desk.pages.page_entry import find_editor_refusal
from app.desk.pages.table_content import FunctionKey
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.editor.editor_model import EditorModel
from app.path.path_view import PathView
from app.programs.program_commands import NO_SELECTION
from app.programs.program_list_model import LONG_DETAILS, ProgramListModel, make_program_details
from app.programs.program_rows import ListedFile, Thumbnail
from app.screen import page_table
from app.screen.entry_panel import WIDE_NAME_KEYS, LetterPad
from app.screen.page_base import KeyActions, PageHost
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ThemedPainter
from app.screen.table_panel import ListPage, TablePanel
from app.working_plane.plane_instant import make_instant_after_line
from app.working_plane.working_plane_view import WorkingPlaneView
from core.executor.snapshot import Snapshot

if TYPE_CHECKING:
    from app.path.path_picture import ProgramPicture

# --- details of the selected program -----------------------------------------------------------------------


LABEL_WIDTH = 11.0  # units


class ProgramDetailPanel(Panel):
    """Panel that shows the details of a program in two columns: labels and values."""

    title = "DETAILS"
    program: RedrawingAttribute[ListedFile | None] = RedrawingAttribute(None)
    error_text = RedrawingAttribute("")  # state or error of the preview
    part_thumbnail: RedrawingAttribute[Thumbnail | None] = RedrawingAttribute(None)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the preview of the part and the details of the program.

        If the preview has an error, the details include the error.
        """
        u = self.theme.unit_px
        rows = list(make_program_details(self.program)) if self.program is not None else []
        preview_row_count = sum(label not in LONG_DETAILS for label, _ in rows)
        if self.error_text:
            rows.append(("PREVIEW", self.error_text))
        room = self.inside()
        high = min(self.theme.find_line_height(3.0), room.height() / max(1, len(rows)))
        self._draw_part(painter, high * preview_row_count)
        for number, (label, text) in enumerate(rows):
            y = room.y() + number * high
            painter.draw_text_line(QRectF(room.x(), y, (LABEL_WIDTH - 0.6) * u, high), label, 1.6, "soft")
            value = QRectF(room.x() + LABEL_WIDTH * u, y, room.width() - LABEL_WIDTH * u, high)
            painter.draw_text_line(value, text, 1.9, "text")

    def _draw_part(self, painter: ThemedPainter, height: float) -> None:
        """Draw the finished part on the right, next to the rows with short texts."""
        if self.part_thumbnail is None or height <= 0.0:
            return
        pixels, columns, rows = self.part_thumbnail
        room, form = self.inside(), QImage.Format.Format_ARGB32_Premultiplied
        scale = min(1.0, height / rows, 0.5 * room.width() / columns)
        wide, tall = columns * scale, rows * scale
        at = QRectF(room.right() - wide, room.y() + (height - tall) / 2, wide, tall)
        painter.drawImage(at, QImage(pixels, columns, rows, 4 * columns, form))


SHARE, RECORD = 0.6, 24.0  # ratio of the width for the list; units of height for the details
KEYBOARD_HEIGHT = 19.0  # units of height for the drawn keyboard


class PreviewPathView(PathView):
    """Path preview of a program that is not loaded."""

    title = "PREVIEW"


class PreviewPlaneView(WorkingPlaneView):
    """Preview of a mill program, with machine table, workpiece and path."""

    title = "PREVIEW"


SEARCH_HINT = "TYPE PART OF A NAME: THIS LIST NEEDS NO CTRL+F"


class ProgramsPage(ListPage):
    """The PROGRAMS page, which displays its model and passes key presses to it."""

    NAME = page_table.PROGRAMS
    model: ProgramListModel

    def __init__(self, host: PageHost, model: ProgramListModel, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.table_panel = TablePanel(self.theme, self._chosen, self)
        self.path_view = PreviewPathView(self.theme, self)
        self.plane_view = PreviewPlaneView(self.theme, self)
        self._shown: ProgramPicture | None = None
        self.detail_panel = ProgramDetailPanel(self.theme, self)
        self.letter_pad = LetterPad(self.theme, self.handle_touched_key, self, WIDE_NAME_KEYS)
        self._with_letters = False
        self.table_panel.on_entry_touched = self._turn_letters
        self.table_panel.on_select = self._select_row
        self.table_panel.search_hint = SEARCH_HINT

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the keys that cannot be used now, such as F3 while the editor cannot be opened."""
        if self.model.program_transfer.is_open:
            return super().find_disabled_keys()
        is_empty = self.model.selected_program is None and not self.model.search_field.text
        closed = is_empty or find_editor_refusal(self.desk.read_snapshot())
        without_program = self.desk.page_registry.program_keys if self.model.selected_program is None else ()
        return super().find_disabled_keys() | ({"F3"} if closed else set()) | set(without_program)

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys of the model."""
        return self.model.make_function_keys()

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the key labels of the list or of the folder chooser."""
        added = {name: key.label for name, key in self.desk.page_registry.program_keys.items()}
        own = {} if self.model.program_transfer.is_open else {"F3": "EDIT", **added}
        return self.make_function_key_labels(own, self.make_function_keys())

    def make_key_actions(self) -> KeyActions:
        """Return the key actions of the list or of the folder chooser."""
        keys = self.make_function_keys()
        added = {
            name: partial(self._use_program_key, key)
            for name, key in self.desk.page_registry.program_keys.items()
        }
        own: KeyActions = {} if self.model.program_transfer.is_open else {"F3": self._open_editor, **added}
        return {**own, **{name: partial(self._do, name) for name in keys}}

    def _do(self, name: str) -> None:
        self.make_function_keys()[name].action()

    def _open_editor(self) -> None:
        """Edit the selected program without loading it, or edit a new program with the typed name."""
        here = self.model.selected_program
        editor = self.desk.page_registry.find_model(EditorModel)
        if here is None and editor is not None and self.model.search_field.text:
            editor.pending_name = self.model.search_field.text
            self.host.open_page(page_table.EDITOR)
            return
        if here is None or editor is None:
            self.desk.say(NO_SELECTION)
            return
        if here.missing_reason:
            self.model.can_load()  # shows the reason
            return
        if here.is_drawing:
            editor.choose_drawing(here.path)
        else:
            editor.source_drawing, editor.pending_name = None, str(here.path)
        if not self.host.open_page(page_table.EDITOR):
            editor.source_drawing = None

    def _use_program_key(self, key: ProgramKey) -> None:
        """Open the page that belongs to a function key, and pass the selected program to that page."""
        here = self.model.selected_program
        if here is None or here.is_drawing:
            self.desk.say(NO_SELECTION)
        elif self.host.open_page(key.page_name):
            key.use(here.name)

    def _chosen(self, row: int) -> None:
        model = self.model
        if model.program_transfer.is_open:
            model.program_transfer.handle_entry_touch(row)
        elif row == model.selected_row:
            self.handle_key("Enter")
        else:
            model.select_row(row)

    def _select_row(self, row: int) -> None:
        transfer = self.model.program_transfer
        (transfer.select_entry if transfer.is_open else self.model.select_row)(row)

    def find_list(self) -> TablePanel | None:
        """Return the list of programs or the folder chooser, unless a new name is being typed."""
        return None if self.model.name_question else self.table_panel

    def handle_key(self, key: str) -> bool:
        """Handle a key.

        Enter on a program loads the program and opens the Automatic page.
        """
        model = self.model
        if key == "Enter" and not model.program_transfer.is_open and not model.name_question:
            # The page changes first, because a question about an interrupted job belongs to the new page.
            if model.can_load() and self.host.open_page(page_table.AUTOMATIC):
                model.load_selected_program()
            return True
        return model.handle_key(key)

    def has_text_field(self) -> bool:
        """Return whether a name can be typed."""
        return not self.model.program_transfer.is_open

    def apply_theme(self) -> None:
        """Redraw the path in the current colors."""
        self.path_view.redraw()

    def refresh(self, _snapshot: Snapshot, _view: MachineStatus, _loaded: LoadedProgram) -> None:
        """Update the list, the preview and the details."""
        model = self.model
        model.poll()
        self.table_panel.show_table(model.make_table())
        here = model.selected_program
        has_path = here is not None and not here.is_drawing and not here.missing_reason
        self._show_picture(model.preview.find_picture(here if has_path else None))
        lettered = (bool(model.name_question) or self._with_letters) and not model.program_transfer.is_open
        if lettered is self.letter_pad.isHidden():
            self.letter_pad.setVisible(lettered)
            self._lay_out()
        self.detail_panel.program = here
        self.detail_panel.part_thumbnail = model.preview.find_thumbnail(here if has_path else None)
        self.path_view.is_loading = model.preview.is_busy
        self.detail_panel.error_text = (
            "DRAWING THE PREVIEW …" if model.preview.is_busy else model.preview.error_text
        )

    def _show_picture(self, picture: ProgramPicture | None) -> None:
        scene = picture.mill_scene if picture is not None else None
        if picture is not self._shown:
            self._shown = picture
            self.plane_view.show_scene(scene)
            self.plane_view.setVisible(scene is not None)
            self.path_view.show_picture(picture if scene is None else None)
        if scene is None:
            self.path_view.continue_drawing()
        else:
            self.plane_view.show_instant(make_instant_after_line(scene, 0), "")

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the parts of the page after a change of size."""
        self._lay_out()

    def _turn_letters(self) -> None:
        self._with_letters = not self._with_letters

    def on_open(self) -> None:
        """Open the list without the on-screen keyboard."""
        self._with_letters = False
        super().on_open()

    def _lay_out(self) -> None:
        u = self.theme.unit_px
        gap = max(4, round(0.7 * u))
        left, low = round(SHARE * self.width()), round(RECORD * u)
        right = self.width() - left - gap
        keys = (
            0
            if self.letter_pad.isHidden()
            else max(self.letter_pad.min_height_px, round(KEYBOARD_HEIGHT * u))
        )
        foot = keys or low  # The keyboard takes the place of the details.
        self.table_panel.setGeometry(0, 0, left, self.height() - (keys + gap if keys else 0))
        for part in (self.path_view, self.plane_view):
            part.setGeometry(left + gap, 0, right, self.height() - foot - gap)
        self.detail_panel.setGeometry(left + gap, self.height() - low, right, low)
        self.detail_panel.setVisible(not keys)
        self.letter_pad.setGeometry(0, self.height() - keys, self.width(), keys)
