"""What the line that asks is for, and what Return in it does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.desk.arithmetic import line_of
from app.screen.editor.doings import Mode

if TYPE_CHECKING:
    from app.screen.editor.page import EditorPage


class Asking:
    """Find and replace, go to a line, and the name that a sample is saved under."""

    def __init__(self, page: EditorPage) -> None:
        self._page = page

    def show(self, mode: Mode) -> None:
        """The question of this mode; the line goes where there is none."""
        page = self._page
        if mode is Mode.FIND:
            page.ask.ask("FIND", "REPLACE BY", entry=page.finder.start())
            page.finder.look()
        elif mode is Mode.GO_TO:
            page.ask.ask("GO TO LINE", entry=str(page.field.line))
        elif mode is Mode.NAME:
            page.ask.ask("SAVE AS", entry=page.editor.name)
        else:
            page.ask.hide()

    def take(self) -> None:
        """Return in the line that asks."""
        page, entry = self._page, self._page.ask.first.text()
        if page.mode is Mode.FIND:
            page.finder.step(1)
        elif page.mode is Mode.GO_TO:
            self._go_to(entry)
        elif page.mode is Mode.NAME:
            page.editor.take_name(entry)

    def _go_to(self, entry: str) -> None:
        page, number, last = self._page, line_of(entry), self._page.field.blockCount()
        if number is None or number > last:
            page.ask.say(f"A NUMBER FROM 1 TO {last}")
            return
        page.enter(Mode.TEXT)
        page.go_to(number)
