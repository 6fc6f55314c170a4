"""Question line of the editor: find and replace, go to line, and file name."""

from __future__ import annotations

import re
from bisect import bisect_left
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QObject, QRectF, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLineEdit, QWidget

from app.desk.pages.sheet import Key
from app.desk.translation import tr
from app.editor.text_view import TextField
from app.screen.entry_panel import dress_line
from app.screen.look import RIGHT, Look, Painter
from app.screen.panel import Panel, Shown
from core.message import Message


@dataclass(frozen=True, slots=True)
class Search:
    """Search for ``needle``, ignoring case.

    ``whole`` excludes matches inside longer words and numbers. F100 is then not found in F1000 or F100.5, so
    that replacing F100 does not change those words.
    """

    needle: str
    whole: bool = True

    def places(self, text: str) -> tuple[int, ...]:
        """Return the start positions of the matches, from 0, without overlaps."""
        if not self.needle:
            return ()
        return tuple(match.start() for match in re.finditer(self._pattern, text))

    @property
    def _pattern(self) -> str:
        pattern = "(?i)" + re.escape(self.needle)
        if not self.whole:
            return pattern
        if self.needle[0] in "0123456789.":
            pattern = "(?i)(?<![0-9.])" + re.escape(self.needle)
        elif self.needle[0].isalpha():
            pattern = "(?i)(?<![A-Za-z])" + re.escape(self.needle)
        if self.needle[-1] in "0123456789.":
            return pattern + r"(?![0-9]|\.[0-9])"
        return pattern + "(?![A-Za-z])" if self.needle[-1].isalpha() else pattern

    def inside(self, text: str) -> int:
        """Return the number of matches inside longer words and numbers."""
        return len(Search(self.needle, whole=False).places(text)) - len(self.places(text))

    def words(self, text: str) -> str:
        """Return the number of matches as display text."""
        count = len(self.places(text))
        found = Message("{count} FOUND", count=count) if count else "NOT FOUND"
        if not self.whole:
            return Message("{value}, INCLUDING PARTS OF WORDS", value=found)
        more = self.inside(text)
        return (
            Message("{value}; {more} MORE ARE PARTS OF LONGER WORDS", value=found, more=more)
            if more
            else found
        )


def following(places: tuple[int, ...], at: int) -> int | None:
    """Return the first position from ``at`` on, starting over at the top, or None without positions."""
    if not places:
        return None
    return places[bisect_left(places, at) % len(places)]


def preceding(places: tuple[int, ...], at: int) -> int | None:
    """Return the last position before ``at``, starting over at the end, or None without positions."""
    return places[bisect_left(places, at) - 1] if places else None


LABEL = 15.0  # units: width of a label
ANSWER = 34.0  # units: width of the message


class AskLine(Panel):
    """Line with one or two fields and their labels, and a message about the entry on the right."""

    ground = "panel"
    answer = Shown("")  # message about the entry

    def __init__(self, look: Look, keys: QObject, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.first, self.second = QLineEdit(self), QLineEdit(self)
        self._labels: tuple[str, ...] = ("",)
        for edit in (self.first, self.second):
            edit.setMaxLength(250)
            edit.setContextMenuPolicy(Qt.ContextMenuPolicy.NoContextMenu)
            edit.installEventFilter(keys)
        self.hide()

    def ask(self, *labels: str, entry: str | None = None) -> None:
        """Show the line with the keyboard focus. The previous entry is selected for overtyping."""
        self._labels = labels
        self.answer = ""
        if entry is not None:
            self.first.setText(entry)
        for edit, label in zip((self.first, self.second), labels, strict=False):
            edit.setAccessibleName(tr(label))
        self.second.setVisible(len(labels) > 1)
        self.show()
        self._place()
        self.first.setFocus()
        self.first.selectAll()
        self.update()

    def other_field(self) -> None:
        """Move the keyboard focus to the other field."""
        if len(self._labels) > 1:
            (self.second if self.first.hasFocus() else self.first).setFocus()

    def dress(self) -> None:
        """Apply font and colors to the fields."""
        for edit in (self.first, self.second):
            dress_line(edit, self.look, 2.3, 0.6)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Place the fields next to their labels."""
        self._place()
        self.dress()

    def _place(self) -> None:
        u = self.look.u
        for edit, box in zip((self.first, self.second), self._boxes(), strict=False):
            edit.setGeometry(box.adjusted(LABEL * u, 0.8 * u, 0, -0.8 * u).toRect())

    def _boxes(self) -> list[QRectF]:
        u, count = self.look.u, len(self._labels)
        wide = (self.width() - (ANSWER + 2) * u) / count
        return [QRectF(n * wide + u, 0, wide - u, self.height()) for n in range(count)]

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        for label, box in zip(self._labels, self._boxes(), strict=True):
            painter.write(QRectF(box.x(), 0, (LABEL - 1) * u, box.height()), label, 1.8, "soft")
        room = QRectF(self.width() - (ANSWER + 1) * u, 0, ANSWER * u, self.height())
        painter.write(room, self.answer, 1.9, "text", at=RIGHT)


class Finder:
    """Search of the text typed in the question line. The cursor moves to the next match."""

    def __init__(self, field: TextField, ask: AskLine) -> None:
        self._field, self._ask = field, ask
        self.whole = True
        ask.first.textEdited.connect(lambda _text: self.look())

    def start(self) -> str:
        """Return the initial search text: the selection within one line, or the previous search text."""
        marked = self._field.textCursor().selectedText()
        return marked if marked and "\u2029" not in marked else self._ask.first.text()

    @property
    def _search(self) -> Search:
        return Search(self._ask.first.text(), self.whole)

    def look(self) -> None:
        """Count the matches and select the first from the cursor on."""
        if self._ask.isVisible():
            cursor = self._field.textCursor()
            self._show(following(self._places(), cursor.selectionStart()))

    def step(self, way: int) -> None:
        """Select the next match (1) or the previous match (-1)."""
        cursor, places = self._field.textCursor(), self._places()
        if way > 0:
            after = cursor.selectionEnd() if cursor.hasSelection() else cursor.position()
            self._show(following(places, after))
        else:
            self._show(preceding(places, cursor.selectionStart()))

    def replace(self) -> None:
        """Replace the selected match and select the next one."""
        cursor, places = self._field.textCursor(), self._places()
        start = cursor.selectionStart()
        length = len(self._search.needle)
        if cursor.hasSelection() and start in places and cursor.selectionEnd() - start == length:
            by = self._ask.second.text()
            self._field.replace_at((start,), length, by)
            self._show(following(self._places(), start + len(by)))
        else:
            self.step(1)

    def replace_all(self) -> None:
        """Replace all matches as one step that can be undone."""
        places = self._places()
        if places:
            self._field.replace_at(places, len(self._search.needle), self._ask.second.text())
        self._ask.answer = (
            Message("{places_count} REPLACED", places_count=len(places)) if places else "NOT FOUND"
        )

    def other_width(self) -> None:
        """Switch between whole words and partial words."""
        self.whole = not self.whole
        self.look()

    def keys(self) -> dict[int, Key]:
        """Return the function keys during a search."""
        return {
            2: Key("NEXT", partial(self.step, 1)),
            3: Key("PREVIOUS", partial(self.step, -1)),
            4: Key("REPLACE", self.replace),
            5: Key("ALL", self.replace_all),
            6: Key("PARTIAL" if self.whole else "WHOLE", self.other_width),
        }

    def _places(self) -> tuple[int, ...]:
        return self._search.places(self._field.toPlainText())

    def _show(self, place: int | None) -> None:
        search = self._search
        self._ask.answer = search.words(self._field.toPlainText()) if search.needle else ""
        if place is not None:
            self._field.select(place, len(search.needle))
