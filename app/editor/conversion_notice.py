"""Notice that proposes the conversion of an edited program of another control."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.desk.desk import Desk
from app.desk.page_description import ProgramConversion
from app.desk.pages.table_content import FunctionKey
from app.desk.translation import tr
from app.editor.editor_model import EditorModel, EditorStage
from app.editor.live_proof import ProofFindings
from core.language.omniturn.other_controls import OTHER_CONTROL_CODE
from core.language.source import ProgramSource
from core.message import Message

NOTICE_TEXT = "PROGRAM FOR {control}. F6: SAVE AND CONVERT   ESC: EDIT"


class ConversionNotice:
    """Notice about the edited text, which Esc dismisses until another such text is opened or pasted.

    The proof of the text recognizes the control. Without an optional feature that converts programs, the
    notice is never shown.
    """

    def __init__(self, desk: Desk, editor: EditorModel) -> None:
        self._desk, self._editor = desk, editor
        self._control = ""  # name of the other control, or empty for a program of this machine
        self._is_dismissed = False
        self._seen: ProofFindings | None = None
        self._loaded_text_count = 0

    @property
    def conversion(self) -> ProgramConversion | None:
        """Return the conversion that the notice proposes, or None while the notice is not shown."""
        shown = self._control and not self._is_dismissed and self._editor.stage is EditorStage.OPEN
        return self._desk.page_registry.program_conversion if shown else None

    @property
    def text(self) -> str:
        """Return the text of the notice, or an empty string while it is not shown."""
        return tr(Message(NOTICE_TEXT, control=self._control)) if self.conversion is not None else ""

    def update(self) -> None:
        """Update the notice from the findings of the latest text. This is called once per frame."""
        if self._loaded_text_count != self._editor.loaded_text_count:
            self._loaded_text_count = self._editor.loaded_text_count
            self._control, self._is_dismissed = "", False
        findings = self._editor.live_proof.current_findings
        if findings is self._seen or self._editor.live_proof.is_outdated:
            return
        self._seen = findings
        self._control = _find_control(findings)
        self._is_dismissed = self._is_dismissed and bool(self._control)

    def make_function_key(self, save_and_open_page: Callable[[str], None]) -> FunctionKey | None:
        """Return the key that saves the text and converts it, or None while the notice is not shown."""
        conversion = self.conversion
        if conversion is None:
            return None
        return FunctionKey("CONVERT", partial(save_and_open_page, conversion.page_name))

    def dismiss(self) -> bool:
        """Hide the notice, and return whether it was shown."""
        was_shown = self.conversion is not None
        self._is_dismissed = self._is_dismissed or was_shown
        return was_shown

    def start_conversion(self, page_name: str) -> None:
        """Convert the program that the editor has closed, if the page of the conversion has opened."""
        conversion, closed = self._desk.page_registry.program_conversion, self._editor.closed_program
        if conversion is not None and closed is not None and page_name == conversion.page_name:
            conversion.convert_text(ProgramSource(closed.path.name, closed.text), closed.path)


def _find_control(findings: ProofFindings) -> str:
    """Return the name of the control that the findings name, or an empty string."""
    found = next((each for each in findings.diagnostics if each.code == OTHER_CONTROL_CODE), None)
    message = found.message if found is not None else None
    return str(message.values["control"]).upper() if isinstance(message, Message) else ""
