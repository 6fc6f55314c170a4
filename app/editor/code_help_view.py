"""The codes beside the text: what the one at the cursor means, and a list to choose from."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtWidgets import QWidget

from app.desk.sheet import Key
from app.editor.code_help import CodeHelp
from app.editor.code_pictures import picture_of
from app.editor.heading_view import CODE_LINE
from app.editor.live_proof import LiveProof
from app.editor.text_view import TextField
from app.screen.look import LEFT, Look, Painter, put_raw
from app.screen.panel import Panel, Shown
from app.shapes.sketch_view import SketchPanel
from core.language.code_book import Entry

LINE = 2.7  # units: a line of an example
MOST_LINES = 9  # of an example
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
        _write_entry(painter, box, self.entry, "accent", "text")


class CodeList(Panel):
    """The choices, and of the marked one lines that use it."""

    _shown: Shown[tuple[object, ...]] = Shown(())

    def __init__(
        self, look: Look, field: TextField, proof: LiveProof, back: Callable[[], None], parent: QWidget
    ) -> None:
        """``back`` leads from the list to the text."""
        super().__init__(look, parent)
        self._field, self._proof, self._back = field, proof, back
        self._help = CodeHelp()
        self.pictured = False  # the program is in the language whose codes have pictures
        self._picture = SketchPanel(look, lambda _word: None, lambda _point: None, self)
        self.hide()

    def follow(self) -> Entry | None:
        """The code that the cursor stands on."""
        field = self._field
        self._help.follow(self._proof.now.book, field.textCursor().block().text(), field.column)
        return self._help.entry

    def ask(self) -> bool:
        """Complete what has been typed, or look the code up; False where no text has been proved yet."""
        self.follow()
        return self._help.ask()

    def _take(self) -> None:
        """The marked code into the text."""
        chosen = self._help.chosen
        if chosen is not None:
            self._field.write(chosen.written, self._help.begin)
        self._back()

    def refresh(self) -> None:
        """Once a frame: drawn anew when other choices are shown or another one is marked."""
        self._shown = (self._help.choices, self._help.marked)
        chosen = self._help.chosen
        drawn = picture_of(chosen.head) if chosen is not None and self.pictured else None
        self._picture.setVisible(drawn is not None)
        if drawn is not None:
            self._picture.shown = drawn, tuple((d.word, d.word) for d in drawn.dims), "", frozenset()
            u, foot = self.look.u, self._foot()
            self._picture.setGeometry(
                round(0.8 * u), round(self.height() - foot), round(self.width() - 1.6 * u), round(PICTURE * u)
            )

    def _foot(self) -> float:
        """Pixels that example and picture of the marked choice take."""
        chosen = self._help.chosen
        if chosen is None:
            return 0.0
        lines = len(chosen.example.splitlines()[:MOST_LINES])
        drawn = PICTURE if not self._picture.isHidden() else 0.0
        return (lines * LINE + 1.4 + drawn) * self.look.u

    def draw(self, painter: Painter) -> None:
        u, shown = self.look.u, self._help
        self.frame(painter, shown.title)
        if shown.chosen is None:
            return
        lines = shown.chosen.example.splitlines()[:MOST_LINES]
        foot = self._foot()
        rows = max(1, int((self.height() - foot - 3.2 * u) / (CODE_LINE * u)))
        first = max(0, min(shown.marked - rows // 2, len(shown.choices) - rows))
        for place, entry in enumerate(shown.choices[first : first + rows]):
            box = QRectF(0.8 * u, (2.4 + place * CODE_LINE) * u, self.width() - 1.6 * u, CODE_LINE * u)
            self._row(painter, box, entry, first + place)
        example = len(lines) * LINE * u + 1.4 * u
        row = QRectF(1.6 * u, self.height() - example, self.width() - 3.2 * u, LINE * u)
        painter.setFont(self.look.font(1.9))
        painter.setPen(self.look.colour("text"))
        for line in lines:
            put_raw(painter, row, LEFT, line)
            row.translate(0, LINE * u)

    def _row(self, painter: Painter, box: QRectF, entry: Entry, number: int) -> None:
        marked = number == self._help.marked
        if marked:
            painter.fill(box, "lit")
        room = box.adjusted(0.6 * self.look.u, 0.2 * self.look.u, -0.4 * self.look.u, 0)
        _write_entry(painter, room, entry, *(("on_lit", "on_lit") if marked else ("accent", "text")))
        self.place(box, partial(self._press, number))

    def _press(self, number: int) -> None:
        """A finger marks a row; on the marked one it takes it."""
        if number == self._help.marked:
            self._take()
        else:
            self._help.mark(number)

    def keys(self) -> dict[int, Key]:
        """The function keys while the list is looked through."""
        shown = self._help
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


def _write_entry(painter: Painter, box: QRectF, entry: Entry, code: str, words: str) -> None:
    """The form above, the meaning below."""
    upper = box.adjusted(0, 0, 0, -box.height() / 2)
    painter.write(upper, entry.form, 1.9, code, raw=True, fit=False)
    painter.write(
        upper.translated(0, upper.height() - 0.2 * painter.look.u),
        entry.what,
        1.7,
        words,
        bold=False,
        fit=False,
    )
