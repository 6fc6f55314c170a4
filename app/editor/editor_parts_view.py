"""The parts of the page EDITOR: which are seen for what the keys do, where they stand, and what they show."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

from PySide6.QtGui import QResizeEvent

from app.editor.code_help_view import CodeList, CodeStrip
from app.editor.edited_path_view import EditedPath
from app.editor.editor import Editor
from app.editor.findings_view import FindingList
from app.editor.heading_view import KEYBOARD, Heading, HeadLine, editor_places
from app.editor.question_view import AskLine
from app.editor.text_view import TextField, TypedText
from app.editor.versions_view import VersionList
from app.screen.entry_panel import LetterPad, strike
from app.screen.page_base import EditorPanel, Page
from app.working_plane.plane_instant import at_line, plane_words
from app.working_plane.working_plane_view import WorkingPlaneView
from core.language.source import dialect_of
from core.message import Message

if TYPE_CHECKING:
    from app.path.path_picture import Picture


class Mode(StrEnum):
    """What the keys are for."""

    TEXT = "text"
    FIND = "find"
    GO_TO = "go to"
    NAME = "name"
    HISTORY = "history"
    OFFER = "offer"
    CODES = "codes"  # the list of codes is looked through
    LOOK = "look"  # at the path: the keyboard measures in it
    PANEL = "panel"  # a form of an optional feature writes the lines


ASKING = frozenset({Mode.FIND, Mode.GO_TO, Mode.NAME})


class EditorParts(Page):
    """The page by its parts, which ``EditorPage`` makes; ``mode`` says which of them are seen."""

    mode: Mode
    editor: Editor
    head: HeadLine
    letters: LetterPad
    field: TextField
    path: EditedPath
    space: WorkingPlaneView
    findings: FindingList
    code: CodeStrip
    codes: CodeList
    versions: VersionList
    ask: AskLine
    panel: EditorPanel
    typed_text: TypedText
    _with_letters = False

    def show_text(self) -> None:
        """Heading, findings and picture of what is in the field now."""
        editor = self.editor
        line, column, count = self.field.line, self.field.column, self.field.blockCount()
        if self.mode is Mode.PANEL:  # of the text with what the form writes
            line, count = self.panel.model.line, self.panel.model.text.count("\n") + 1
        place = Message("LINE {line} OF {count}  ·  COL {column}", line=line, count=count, column=column)
        self.head.heading = Heading(editor.name, self.typed_text.mark, place)
        self.head.panel_keys = tuple(self.panel.head_keys(editor.name))
        self.codes.dialect = dialect_of(editor.name)
        findings = editor.proof.now
        self.field.show_findings(findings.by_line)
        self.findings.show_findings(findings, line)
        if self.mode is Mode.TEXT:
            self.code.entry = self.codes.follow()
        self._show_path(findings.picture, line)

    def _show_path(self, picture: Picture | None, line: int) -> None:
        """The path up to the line of the cursor; on a mill the plane of that line in space."""
        scene = picture.scene if picture is not None else None
        self.space.show_scene(scene)
        self.space.setVisible(scene is not None and self.mode is not Mode.OFFER and not self.lettered)
        self.path.show_picture(picture if scene is None else None)
        if scene is not None:
            here = at_line(scene, line)
            self.space.show_instant(here, plane_words(here.swivel))
            return
        self.path.follow(line)
        self.path.advance()

    def show_mode(self) -> None:
        """The parts that this mode has."""
        self.path.measure(on=self.mode is Mode.LOOK)
        self.versions.setVisible(self.mode is Mode.HISTORY)
        self.codes.setVisible(self.mode is Mode.CODES)
        self.panel.setVisible(self.mode is Mode.PANEL)
        self.field.setVisible(
            self.mode not in {Mode.OFFER, Mode.PANEL}
        )  # what was edited last is not what is offered
        for part in (self.path, self.findings, self.code):
            part.setVisible(self.mode is not Mode.OFFER and not self.lettered)
        self.letters.setVisible(self.lettered)
        self.letters.write_into(self.ask.first if self.mode in ASKING else self.field)
        self._lay_out()

    # --- the drawn keyboard --------------------------------------------------------------------------

    @property
    def lettered(self) -> bool:
        """Whether the keyboard is drawn: where something is written, if a finger has asked for it."""
        return self._with_letters and self.mode in ASKING | {Mode.TEXT}

    def turn_letters(self) -> None:
        """Show the keyboard, or take it away."""
        self._with_letters = not self._with_letters
        self.show_mode()

    def _strike(self, key: str) -> None:
        strike(key, self.letters.focusProxy() or self.field)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Everything again, in the new unit."""
        self._lay_out()
        self.dress()

    def _lay_out(self) -> None:
        keys = KEYBOARD if self.lettered else 0.0
        asking = self.mode in ASKING
        at = editor_places(self.width(), self.height(), self.look.u, asking=asking, keys=keys)
        for part, rect in (
            (self.head, at.head),
            (self.field, at.text),
            (self.path, at.path),
            (self.space, at.path),
            (self.findings, at.findings),
            (self.code, at.code),
            (self.codes, at.codes),
            (self.panel, at.text),
            (self.versions, at.body),
            (self.ask, at.ask),
            (self.letters, at.keys),
        ):
            part.setGeometry(*rect)
            part.update()

    def dress(self) -> None:
        """Everything in the colours and sizes that are in force now."""
        self.field.dress()
        self.ask.dress()
        self.path.restart()
