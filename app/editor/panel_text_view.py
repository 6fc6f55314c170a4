"""Transfer of text between the editor's text field and a feature panel.

The text of the panel is proved as a preview and then copied into the text field.
"""

from __future__ import annotations

from app.editor.editor_model import EditorModel
from app.editor.text_synchronizer_view import TextSynchronizer
from app.editor.text_view import ProgramTextField
from app.screen.page_base import EditorPanel


class PanelSynchronizer:
    """Synchronizer that copies text between the text field and the panel of an optional feature."""

    def __init__(
        self,
        editor_panel: EditorPanel,
        editor_model: EditorModel,
        text_field: ProgramTextField,
        typed_text: TextSynchronizer,
    ) -> None:
        self._panel, self._editor = editor_panel, editor_model
        self._field, self._typed_text = text_field, typed_text
        # numbers of the panel's text that was proved and of the text put into the field
        self._shown = (0, 0)

    def open_panel(self, key_name: str) -> bool:
        """Open the panel with the given key for the current text, and return whether the panel is open.

        If it cannot open, the editor shows the reason.
        """
        panel, editor = self._panel, self._editor
        now = self._typed_text.read_text()
        editor.message = panel.open_for_text(key_name, editor.name, now, self._field.cursor_line)
        if not editor.message:
            self._shown = (panel.model.text_number, panel.model.write_count)
        return not editor.message

    def synchronize(self) -> None:
        """Show new text of the panel's form in the text field, and prove the form's preview.

        This method is called once per frame.
        """
        model, (proved, written) = self._panel.model, self._shown
        model.process_results()
        if model.write_count != written:
            self._field.replace_text(model.text, as_new=False)
            self._field.move_cursor_to(model.cursor_line)
        if model.text_number != proved and not self._typed_text.is_stale:
            self._editor.preview_text(model.text)
        self._shown = (model.text_number, model.write_count)
        self._panel.refresh()
