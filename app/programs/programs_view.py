"""Page PROGRAMS: list of programs on the left, preview and details of the selected program on the right."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF
from PySide6.QtGui import QImage, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.page_description import ProgramKey
from app.desk.pages.page_entry import editor_barred
from app.desk.pages.sheet import Key
from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.editor.editor import Editor
from app.path.path_view import PathView
from app.programs.copy_rename_delete import NONE
from app.programs.program_list import ProgramList, details_of
from app.programs.program_rows import Program, Thumbnail
from app.screen import page_table
from app.screen.entry_panel import NAMES_WIDE, LetterPad
from app.screen.look import Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Panel, Shown
from app.screen.sheet_panel import ListPage, SheetPanel
from app.working_plane.plane_instant import at_line
from app.working_plane.working_plane_view import WorkingPlaneView
from core.executor.snapshot import Snapshot

if TYPE_CHECKING:
    from app.path.path_picture import Picture

# --- details of the selected program -----------------------------------------------------------------------


LABEL = 11.0  # units
LONG = 2  # rows at the end that use the whole width


class RecordPanel(Panel):
    """Panel of details in two columns: label and value."""

    title = "DETAILS"
    program: Shown[Program | None] = Shown(None)
    trouble = Shown("")  # state or error of the preview
    part: Shown[Thumbnail | None] = Shown(None)

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        rows = list(details_of(self.program)) if self.program is not None else []
        beside = len(rows) - LONG
        if self.trouble:
            rows.append(("PREVIEW", self.trouble))
        room = self.inside()
        high = min(3.0 * u, room.height() / max(1, len(rows)))
        self._draw_part(painter, high * beside)
        for number, (label, text) in enumerate(rows):
            y = room.y() + number * high
            painter.write(QRectF(room.x(), y, (LABEL - 0.6) * u, high), label, 1.6, "soft")
            value = QRectF(room.x() + LABEL * u, y, room.width() - LABEL * u, high)
            painter.write(value, text, 1.9, "text")

    def _draw_part(self, painter: Painter, high: float) -> None:
        """Draw the finished part on the right, next to the short rows."""
        if self.part is None or high <= 0.0:
            return
        pixels, columns, rows = self.part
        room, form = self.inside(), QImage.Format.Format_ARGB32
        scale = min(1.0, high / rows, 0.5 * room.width() / columns)
        wide, tall = columns * scale, rows * scale
        at = QRectF(room.right() - wide, room.y() + (high - tall) / 2, wide, tall)
        painter.drawImage(at, QImage(pixels, columns, rows, 4 * columns, form))


SHARE, RECORD = 0.6, 24.0  # ratio of the width for the list; units of height for the details
LETTERS = 19.0  # units of height for the drawn keyboard


class PreviewPath(PathView):
    """Path preview of a program that is not loaded."""

    title = "PREVIEW"


class PreviewSpace(WorkingPlaneView):
    """Preview of a mill program: table, workpiece and path."""

    title = "PREVIEW"


class ProgramsPage(ListPage):
    """Page PROGRAMS: shows its model and passes the keys to it."""

    NAME = page_table.PROGRAMS
    model: ProgramList

    def __init__(self, host: Host, model: ProgramList, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.table = SheetPanel(self.look, self._chosen, self)
        self.path = PreviewPath(self.look, self)
        self.space = PreviewSpace(self.look, self)
        self._shown: Picture | None = None
        self.record = RecordPanel(self.look, self)
        self.letters = LetterPad(self.look, self.touched, self, NAMES_WIDE)
        self._with_letters = False
        self.table.touch_entry = self._turn_letters

    def barred(self) -> frozenset[str]:
        """Return the barred keys of the list, and F3 while the editor cannot be opened."""
        closed = not self.model.transfer.open and editor_barred(self.desk.snapshot())
        return super().barred() | ({"F3"} if closed else set())

    def page_keys(self) -> Mapping[str, Key]:
        """Return the function keys of the model."""
        return self.model.keys()

    def labels(self) -> tuple[str, ...]:
        """Return the labels of the list or of the folder chooser."""
        added = {name: key.label for name, key in self.desk.pages.program_keys.items()}
        own = {} if self.model.transfer.open else {"F3": "EDIT", **added}
        return self.labels_of(own, self.page_keys())

    def key_actions(self) -> KeyActions:
        """Return the actions of the function keys of the list or of the folder chooser."""
        keys = self.page_keys()
        added = {name: partial(self._use, key) for name, key in self.desk.pages.program_keys.items()}
        own: KeyActions = {} if self.model.transfer.open else {"F3": self._edit, **added}
        return {**own, **{name: partial(self._do, name) for name in keys}}

    def _do(self, name: str) -> None:
        self.page_keys()[name].action()

    def _edit(self) -> None:
        """Edit the selected program without loading it, or a new program with the typed name."""
        here = self.model.program
        editor = self.desk.pages.find(Editor)
        if here is None and editor is not None and self.model.find.text:
            editor.wanted = self.model.find.text
            self.host.go(page_table.EDITOR)
            return
        if here is None or editor is None:
            self.desk.say(NONE)
            return
        editor.made_of = here.path if here.drawing else None
        editor.wanted = f"{here.path.stem}.nc" if here.drawing else str(here.path)
        if not self.host.go(page_table.EDITOR):
            editor.made_of = None

    def _use(self, key: ProgramKey) -> None:
        """Open the page of the key with the selected program."""
        here = self.model.program
        if here is None or here.drawing:
            self.desk.say(NONE)
        elif self.host.go(key.page):
            key.use(here.name)

    def _chosen(self, row: int) -> None:
        model = self.model
        if model.transfer.open:
            model.transfer.touch(row)
        elif row == model.marked:
            self.typed("Enter")
        else:
            model.choose(row)

    def typed(self, key: str) -> bool:
        """Handle a key. Enter on a program loads it and opens the Automatic page."""
        model = self.model
        if key == "Enter" and not model.transfer.open and not model.question:
            # The page changes first, because a question about an interrupted job belongs to the new page.
            if model.may_load() and self.host.go(page_table.AUTOMATIC):
                model.load()
            return True
        return model.typed(key)

    def has_field(self) -> bool:
        """Return whether a name can be typed."""
        return not self.model.transfer.open

    def dress(self) -> None:
        """Redraw the path in the present colors."""
        self.path.restart()

    def refresh(self, _snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Update list, preview and details."""
        model = self.model
        model.look()
        self.table.show_sheet(model.sheet())
        here = model.program
        self._show_picture(model.preview.of(None if here is not None and here.drawing else here))
        lettered = (bool(model.question) or self._with_letters) and not model.transfer.open
        if lettered is self.letters.isHidden():
            self.letters.setVisible(lettered)
            self._lay_out()
        self.record.program = here
        self.record.part = model.preview.part_of(here)
        self.record.trouble = "DRAWING THE PREVIEW …" if model.preview.busy else model.preview.trouble

    def _show_picture(self, picture: Picture | None) -> None:
        scene = picture.scene if picture is not None else None
        if picture is not self._shown:
            self._shown = picture
            self.space.show_scene(scene)
            self.space.setVisible(scene is not None)
            self.path.show_picture(picture if scene is None else None)
        if scene is None:
            self.path.advance()
        else:
            self.space.show_instant(at_line(scene, 0), "")

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the parts after a change of size."""
        self._lay_out()

    def _turn_letters(self) -> None:
        self._with_letters = not self._with_letters

    def opened(self) -> None:
        """Open the list without the drawn keyboard."""
        self._with_letters = False
        super().opened()

    def _lay_out(self) -> None:
        u = self.look.u
        gap = max(4, round(0.7 * u))
        left, low = round(SHARE * self.width()), round(RECORD * u)
        right = self.width() - left - gap
        keys = 0 if self.letters.isHidden() else max(self.letters.least, round(LETTERS * u))
        foot = keys or low  # The keyboard takes the place of the details.
        self.table.setGeometry(0, 0, left, self.height() - (keys + gap if keys else 0))
        for part in (self.path, self.space):
            part.setGeometry(left + gap, 0, right, self.height() - foot - gap)
        self.record.setGeometry(left + gap, self.height() - low, right, low)
        self.record.setVisible(not keys)
        self.letters.setGeometry(0, self.height() - keys, self.width(), keys)
