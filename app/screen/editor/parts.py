"""The parts of the editor page, where they stand, and what they show; what keys do is the page's."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.editing.editor import Editor
from app.desk.editing.history import History
from app.desk.swivel.telling import at_line, plane_words
from app.screen.editor.ask import AskLine
from app.screen.editor.doings import Mode
from app.screen.editor.draft import Draft
from app.screen.editor.drawn import EditedPath
from app.screen.editor.finder import Finder
from app.screen.editor.findings import FindingList
from app.screen.editor.heading import Heading, HeadLine
from app.screen.editor.keyboard import ASKING
from app.screen.editor.layout import KEYS, editor_places
from app.screen.editor.textfield import TextField
from app.screen.editor.versions import VersionList
from app.screen.letters import PROGRAMS, LetterPad, strike
from app.screen.pages import Host, Page
from app.screen.swivel.view import SwivelView

if TYPE_CHECKING:
    from app.desk.picture import Picture


class EditorParts(Page):
    """``mode`` says which of them are seen; keys of the line that asks come to ``eventFilter``."""

    def __init__(self, host: Host, editor: Editor, parent: QWidget) -> None:
        super().__init__(host, parent)
        look, self.editor = host.look, editor
        self._mode = Mode.TEXT
        self.head = HeadLine(look, self.turn_letters, self)
        self.letters = LetterPad(look, self._strike, self, PROGRAMS)
        self._with_letters = False
        self.field = TextField(look, self)
        self.path = EditedPath(look, self.go_to, self)
        self.space = SwivelView(look, self)  # takes the path's place where the program is for a mill
        self.findings = FindingList(look, self.go_to, self)
        self.history = History(editor.bench.archive, editor.worker)
        self.versions = VersionList(look, self.history, self)
        self.ask = AskLine(look, self, self)
        self.finder = Finder(self.field, self.ask)
        self.draft = Draft(self.field, self.editor)

    @property
    def mode(self) -> Mode:
        """What the keys are for now."""
        return self._mode

    def go_to(self, line: int, column: int = 0) -> None:
        """The cursor to a place of the program."""
        self.field.go_to(max(1, line), column)
        self.field.setFocus()

    def show_text(self) -> None:
        """Heading, findings and picture of what is in the field now."""
        editor = self.editor
        line, column = self.field.line, self.field.textCursor().positionInBlock() + 1
        place = f"LINE {line} OF {self.field.blockCount()}  ·  {column}"
        self.head.show_heading(Heading(editor.name, self.draft.mark, place))
        findings = editor.checker.now
        self.field.show_findings(findings.by_line)
        self.findings.show_findings(findings, line)
        self._show_path(findings.picture, line)

    def _show_path(self, picture: Picture | None, line: int) -> None:
        """The path up to the line of the cursor; on a mill the plane of that line in space."""
        scene = picture.scene if picture is not None else None
        self.space.show_scene(scene)
        self.space.setVisible(scene is not None and self._mode is not Mode.OFFER and not self.lettered)
        self.path.show_picture(picture if scene is None else None)
        if scene is not None:
            here = at_line(scene, line)
            self.space.show_instant(here, plane_words(here.swivel))
            return
        self.path.follow(line)
        self.path.advance()

    def show_mode(self) -> None:
        """The parts that this mode has."""
        self.path.measure(on=self._mode is Mode.LOOK)
        self.versions.setVisible(self._mode is Mode.HISTORY)
        self.field.setVisible(self._mode is not Mode.OFFER)  # what was edited last is not what is offered
        for part in (self.path, self.findings):
            part.setVisible(self._mode is not Mode.OFFER and not self.lettered)
        self.letters.setVisible(self.lettered)
        self.letters.write_into(self.ask.first if self._mode in ASKING else self.field)
        self._lay_out()

    # --- the drawn keyboard --------------------------------------------------------------------------

    @property
    def lettered(self) -> bool:
        """Whether the keyboard is drawn: where something is written, if a finger has asked for it."""
        return self._with_letters and self._mode in ASKING | {Mode.TEXT}

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
        keys = KEYS if self.lettered else 0.0
        asking = self._mode in ASKING
        at = editor_places(self.width(), self.height(), self.look.u, asking=asking, keys=keys)
        for part, rect in (
            (self.head, at.head),
            (self.field, at.text),
            (self.path, at.path),
            (self.space, at.path),
            (self.findings, at.findings),
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
