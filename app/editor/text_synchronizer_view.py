"""Transfer of text between the editor's text field and the editor model."""

from __future__ import annotations

from app.editor.editor_model import EditorModel, EditorStage
from app.editor.text_view import ProgramTextField
from core.language.source import guess_dialect


class TextSynchronizer:
    """Synchronizer between the text field and the editor model, which acts at most once per frame."""

    def __init__(self, text_field: ProgramTextField, editor_model: EditorModel) -> None:
        self._field, self._editor = text_field, editor_model
        # revision of the field and document of the last comparison
        self._seen: tuple[int, object] = (-1, None)
        self._dirty = False
        self._taken = 0  # number of the editor's text that is in the field
        self.is_stale = False  # the text has changed since it was passed to the editor
        self._taking = False  # the field is being changed by this object
        self._text = ""
        text_field.text_changed.connect(self._changed)

    def _changed(self) -> None:
        self.is_stale = True
        if not self._taking:
            self._editor.clear_message()  # Typing clears the message and cancels a question.

    def read_text(self) -> str:
        """Return the current text of the field."""
        return self._field.toPlainText()

    @property
    def is_dirty(self) -> bool:
        """Return whether the text has unsaved changes.

        The comparison is cached until the text changes.
        """
        seen = (self._field.buffer.revision, self._editor.document)
        if seen != self._seen:
            self._seen, self._dirty = seen, self._editor.is_dirty(self.read_text())
        return self._dirty

    def synchronize(self) -> None:
        """Copy a new text of the editor model into the field, or submit typed text to the live proof.

        This method is called once per frame.
        """
        editor, field = self._editor, self._field
        self._update_dialect()
        if editor.loaded_text_count != self._taken:
            self._taken = editor.loaded_text_count
            self._taking = True
            field.replace_text(editor.text, as_new=not editor.is_replacement_undoable)
            self._taking = False
            field.setFocus()
            self.is_stale = True
        if self.is_stale:
            self.is_stale = False
            self._text = self.read_text()
            editor.update_text(self._text)
        field.setReadOnly(editor.stage is not EditorStage.OPEN)

    def _update_dialect(self) -> None:
        """Set the program language that the file name indicates."""
        document = self._editor.document
        if document is not None:
            self._field.set_dialect(guess_dialect(document.name))

    @property
    def mark(self) -> str:
        """Return the label for the state of the text: CHANGED, SAMPLE, NEW, or empty if unchanged."""
        document = self._editor.document
        if document is None:
            return ""
        dirty = self._editor.is_dirty(self._text)
        if document.is_read_only:
            return "SAMPLE, CHANGED" if dirty else "SAMPLE"
        if document.is_new:
            return "NEW"
        return "CHANGED" if dirty else ""
