"""Between the text field and the editor: texts that come, texts that were typed, and whether they differ."""

from __future__ import annotations

from app.desk.editing.editor import Editor, Stage
from app.screen.editor.textfield import TextField
from core.language.dialect import dialect_of


class Draft:
    """Looks at most once a frame at what has been typed, however fast that is."""

    def __init__(self, field: TextField, editor: Editor) -> None:
        self._field, self._editor = field, editor
        self._taken = 0  # number of the text of the editor that stands in the field
        self._stale = False  # the text has changed since it was given to the editor
        self._taking = False  # a text is being put into the field from here
        self._text = ""
        field.textChanged.connect(self._changed)

    def _changed(self) -> None:
        self._stale = True
        if not self._taking:
            self._editor.clear()  # whoever goes on typing has read the answer, and no question stays open

    def now(self) -> str:
        """What stands in the field."""
        return self._field.toPlainText()

    def refresh(self) -> None:
        """Once a frame: take a text that has come; have proved what was typed."""
        editor, field = self._editor, self._field
        self._colour()
        if editor.text_number != self._taken:
            self._taken = editor.text_number
            self._taking = True
            field.put_text(editor.text, afresh=not editor.restored)
            self._taking = False
            field.setFocus()
            self._stale = True
        if self._stale:
            self._stale = False
            self._text = self.now()
            editor.changed(self._text)
        field.setReadOnly(editor.stage is not Stage.OPEN)

    def _colour(self) -> None:
        """By the language that the name of the file tells; new colours are no new text."""
        document = self._editor.document
        if document is not None:
            before, self._taking = self._stale, True
            self._field.highlighter.speak(dialect_of(document.name))
            self._taking, self._stale = False, before

    @property
    def mark(self) -> str:
        """How the text stands to its file, in a word."""
        document = self._editor.document
        if document is None:
            return ""
        dirty = self._editor.is_dirty(self._text)
        if document.protected:
            return "SAMPLE, CHANGED" if dirty else "SAMPLE"
        if document.fresh:
            return "NEW"
        return "CHANGED" if dirty else ""
