"""The codes beside the text: what the one at the cursor means, and a list to choose from."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from app.desk.code_help import CodeHelp
from app.desk.sheet import Key
from app.editor.code_pictures import picture_of
from app.editor.live_proof import LiveProof
from app.editor.text_view import TextField
from app.screen.code_choices_view import CodeChoices, write_entry
from app.screen.drawings import SketchPanel
from app.screen.look import Look, Painter
from app.screen.panel import Panel, Shown
from core.language.code_book import Entry
from core.language.source import Dialect

PICTURE = 17.0  # units: height of a picture


class CodeStrip(Panel):
    """One code: how it is written, and what it means. Pressing it opens the list."""

    ground = "panel"
    entry: Shown[Entry | None] = Shown(None)

    def __init__(self, look: Look, press: Callable[[], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._press = press

    def draw(self, painter: Painter) -> None:
        self.place(self.area(), self._press)
        box = self.area().adjusted(1.2 * self.look.u, 0.3 * self.look.u, -0.6 * self.look.u, 0)
        if self.entry is None:
            painter.write(box, "CODES", 1.8, "accent", fit=False)
            return
        write_entry(painter, box, self.entry, "accent", "text")


class CodeList(CodeChoices):
    """The choices, and of the marked one its words, lines that use it and its picture, if there is one."""

    def __init__(
        self, look: Look, field: TextField, proof: LiveProof, back: Callable[[], None], parent: QWidget
    ) -> None:
        """``back`` leads from the list to the text."""
        self._codes = CodeHelp()
        super().__init__(look, self._codes, self._take, parent)
        self._field, self._proof, self._back = field, proof, back
        self.dialect = Dialect.OMNITURN  # of the program, whose codes have pictures of their own
        self._picture = SketchPanel(look, lambda _word: None, lambda _point: None, self)

    def follow(self) -> Entry | None:
        """The code that the cursor stands on."""
        field = self._field
        self._codes.follow(self._proof.now.book, field.textCursor().block().text(), field.column)
        return self._codes.entry

    def ask(self) -> bool:
        """Complete what has been typed, or look the code up; False where no text has been proved yet."""
        self.follow()
        return self._codes.ask()

    def _take(self) -> None:
        """The marked code into the text."""
        chosen = self._codes.chosen
        if chosen is not None:
            self._field.write(chosen.written, self._codes.begin)
        self._back()

    def refresh(self) -> None:
        """Once a frame: drawn anew when other choices are shown or another one is marked."""
        super().refresh()
        chosen = self._codes.chosen
        drawn = picture_of(chosen.head, self.dialect) if chosen is not None else None
        self._picture.setVisible(drawn is not None)
        if drawn is not None:
            self._picture.shown = drawn, tuple((d.word, d.word) for d in drawn.dims), "", frozenset()
            u, foot = self.look.u, self._foot()
            self._picture.setGeometry(
                round(0.8 * u), round(self.height() - foot), round(self.width() - 1.6 * u), round(PICTURE * u)
            )

    def _foot(self) -> float:
        """Pixels that example and picture of the marked choice take."""
        return super()._foot() + self._drawn()

    def _drawn(self) -> float:
        """Pixels that the picture takes."""
        return PICTURE * self.look.u if not self._picture.isHidden() else 0.0

    def keys(self) -> dict[int, Key]:
        """The function keys while the list is looked through."""
        shown = self._codes
        return {
            2: Key("WRITE", self._take),
            4: Key("UP", lambda: shown.mark(shown.marked - 1)),
            5: Key("DOWN", lambda: shown.mark(shown.marked + 1)),
            6: Key("CHAPTER -", partial(shown.turn, -1)),
            7: Key("CHAPTER +", partial(shown.turn, 1)),
        }

    def arrows(self) -> dict[int, Callable[[], None]]:
        """The same actions by the arrow keys, and Return."""
        by = {number: key.action for number, key in self.keys().items()}
        return {
            Qt.Key.Key_Up: by[4],
            Qt.Key.Key_Down: by[5],
            Qt.Key.Key_Left: by[6],
            Qt.Key.Key_Right: by[7],
            Qt.Key.Key_Return: by[2],
            Qt.Key.Key_Enter: by[2],
        }
