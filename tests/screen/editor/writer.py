"""The operator at the editor: the same hands, and what he sees of the text."""

from __future__ import annotations

from app.editor.editor_view import EditorPage
from app.screen import page_table
from tests.screen.hands import Hands, Key


class Writer(Hands):
    """Types programs."""

    @property
    def editor(self) -> EditorPage:
        """The page, which must be in front."""
        page = self.frame.current_page
        assert isinstance(page, EditorPage)
        return page

    @property
    def front(self) -> str:
        """The name of the page in front."""
        return self.frame.current_page.NAME

    def text(self) -> str:
        """What stands in the field."""
        return self.editor.text_field.toPlainText()

    def write(self, text: str) -> None:
        """Type lines."""
        for number, line in enumerate(text.splitlines()):
            if number:
                self.key(Key.Key_Return)
            self.type(line)

    def new(self, name: str) -> None:
        """A new file, by the control's own dialogue."""
        self.key(Key.Key_F2)
        self.type(name)
        self.key(Key.Key_Return)
        self.key(Key.Key_X)
        self.key(Key.Key_F3)
        self.key(Key.Key_F1)
        self.sees(lambda: self.front == page_table.EDITOR and self.editor.text_field.hasFocus())

    def edit(self, name: str) -> None:
        """A program of the folders, from the desk into the editor."""
        self.load(name)
        self.key(Key.Key_F3)
        self.sees(lambda: self.front == page_table.EDITOR and bool(self.text()))

    def proved(self) -> bool:
        """Whether what is typed is proved."""
        page = self.editor
        proof = page.editor.live_proof
        fresh = (
            not page.text_synchronizer.is_stale and not proof.is_outdated
        )  # what was typed has come to the proof
        return (
            fresh
            and page.finding_list.findings is proof.current_findings
            and proof.current_findings.number > 0
        )
