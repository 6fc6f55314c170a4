"""Find and replace in the text field, with the count of what is found."""

from __future__ import annotations

from app.desk.editing.search import Search, following, preceding
from app.screen.editor.ask import AskLine
from app.screen.editor.textfield import TextField


class Finder:
    """Looks for what is typed into the line that asks; the cursor goes to the first from where it stands."""

    def __init__(self, field: TextField, ask: AskLine) -> None:
        self._field, self._ask = field, ask
        self.whole = True
        ask.first.textEdited.connect(lambda _text: self.look())

    def start(self) -> str:
        """What is looked for at first: what is marked, if it is part of one line, or the last time's."""
        marked = self._field.textCursor().selectedText()
        return marked if marked and "\u2029" not in marked else self._ask.first.text()

    @property
    def _search(self) -> Search:
        return Search(self._ask.first.text(), self.whole)

    def look(self) -> None:
        """Count, and mark the first from the cursor on."""
        if self._ask.isVisible():
            cursor = self._field.textCursor()
            self._show(following(self._places(), cursor.selectionStart()))

    def step(self, way: int) -> None:
        """To the next (1) or the one before (-1)."""
        cursor, places = self._field.textCursor(), self._places()
        if way > 0:
            after = cursor.selectionEnd() if cursor.hasSelection() else cursor.position()
            self._show(following(places, after))
        else:
            self._show(preceding(places, cursor.selectionStart()))

    def replace(self) -> None:
        """Replace the marked one and go to the next."""
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
        """Replace all of them, as one step that can be undone."""
        places = self._places()
        if places:
            self._field.replace_at(places, len(self._search.needle), self._ask.second.text())
        self._ask.say(f"{len(places)} REPLACED" if places else "NOT FOUND")

    def other_width(self) -> None:
        """Whole words and numbers only, or parts of them too."""
        self.whole = not self.whole
        self.look()

    def _places(self) -> tuple[int, ...]:
        return self._search.places(self._field.toPlainText())

    def _show(self, place: int | None) -> None:
        search = self._search
        self._ask.say(search.words(self._field.toPlainText()) if search.needle else "")
        if place is not None:
            self._field.select(place, len(search.needle))
