"""Transfer of text between the editor's text field and the editor model."""

from __future__ import annotations

import time

from app.editor.changed_lines import adjust_findings
from app.editor.editor_model import EditorModel, EditorStage
from app.editor.text_search import LONG_TEXT_LENGTH
from app.editor.text_view import ProgramTextField
from core.language.source import guess_dialect

TYPING_PAUSE_S = 0.4
MAX_CHECKED_LINES = 200  # changed lines whose syntax is checked at once


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
        self._last_change_s = 0.0
        text_field.text_changed.connect(self._changed)

    def _changed(self) -> None:
        self.is_stale = True
        if self._is_long:
            self._last_change_s = time.monotonic()
            self._check_changed_lines()
        if not self._taking:
            self._editor.clear_message()  # Typing clears the message and cancels a question.

    def _check_changed_lines(self) -> None:
        """Show the syntax errors of the changed lines of a long text, and cancel the present proof."""
        proof, change = self._editor.live_proof, self._field.buffer.last_change
        proof.cancel_proof()
        if not self._taking:
            count = min(change.new_line_count, MAX_CHECKED_LINES)
            errors = self._field.find_line_errors(change.first_line, count)
            found = adjust_findings(
                proof.current_findings,
                change.first_line + 1,
                change.old_line_count,
                change.new_line_count,
                errors,
            )
            proof.show_adjusted_findings(found)

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
            document = self._editor.document
            is_other_length = document is not None and self._field.buffer.length != len(document.text)
            self._seen, self._dirty = seen, is_other_length or self._editor.is_dirty(self.read_text())
        return self._dirty

    @property
    def proved_blocks(self) -> int | None:
        """Return the progress of the proof of a long text, or None for a short or proved text."""
        proof = self._editor.live_proof
        is_pending = self.is_stale or proof.is_outdated
        return proof.worker.progress_count if self._is_long and is_pending else None

    @property
    def _is_long(self) -> bool:
        return self._field.buffer.length > LONG_TEXT_LENGTH

    @property
    def _is_typing(self) -> bool:
        """Return whether the operator is typing in a long text, which is proved only after a pause."""
        return time.monotonic() < self._last_change_s + TYPING_PAUSE_S

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
        if self.is_stale and not self._is_typing:
            self.is_stale = False
            editor.update_text(self.read_text())
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
        dirty = self.is_dirty
        if document.is_read_only:
            return "SAMPLE, CHANGED" if dirty else "SAMPLE"
        if document.is_new:
            return "NEW"
        return "CHANGED" if dirty else ""
