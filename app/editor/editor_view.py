"""The F3 editor: the text with its margin, the path beside it, and what proving has found.

Everything is done by keys alone, and every function key is a target for a finger.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.machine_status import MachineStatus
from app.desk.program_loading import Loaded
from app.desk.prompt_line import MOVING
from app.editor import messages
from app.editor.edited_path_view import EditedPath, Looking
from app.editor.editor import Editor, Stage
from app.editor.editor_keys_view import ASKING, PROMPTS, Doing, Mode, action_of, doings
from app.editor.entering import enter
from app.editor.findings_view import FindingList
from app.editor.heading_view import KEYBOARD, Heading, HeadLine, editor_places
from app.editor.question_view import Asking, AskLine, Finder
from app.editor.text_view import Draft, TextField
from app.editor.versions import History
from app.editor.versions_view import VersionList
from app.screen import page_table
from app.screen.letter_keys import PROGRAMS, LetterPad, strike
from app.screen.page_base import Doings, Host, Page
from app.working_plane.plane_instant import at_line, plane_words
from app.working_plane.working_plane_view import WorkingPlaneView
from core.executor.snapshot import Snapshot

if TYPE_CHECKING:
    from app.path.path_picture import Picture

# --- The parts of the editor page, where they stand, and what they show; what keys do is the page's.


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
        self.space = WorkingPlaneView(look, self)  # takes the path's place where the program is for a mill
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
        findings = editor.proof.now
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
        keys = KEYBOARD if self.lettered else 0.0
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


class EditorPage(EditorParts):
    """Shows what the desk's editor holds; it opens with the program on the desk or a name that was typed."""

    NAME = page_table.EDITOR

    def __init__(self, host: Host, editor: Editor, parent: QWidget) -> None:
        super().__init__(host, editor, parent)
        self._target = page_table.AUTOMATIC  # where leaving leads to
        self._moving = False
        self.asking = Asking(self)
        self.looking = Looking(self)

    # --- the frame's calls ---------------------------------------------------------------------------

    def opens(self) -> bool:
        """Not while a program is under way, nor beside a turning spindle."""
        return self.editor.stage is not Stage.CLOSED or enter(self.desk, self.editor)

    def opened(self) -> None:
        """The program on the desk, or the name that was typed for a new one, is being fetched."""
        self._target = page_table.AUTOMATIC
        self.enter(Mode.TEXT)

    def leave(self) -> bool:
        """Save first; the page goes by itself when that is done."""
        if self.editor.stage is Stage.OFFERED:
            self.editor.abort()
        if self.editor.stage is not Stage.CLOSED:
            self._target = page_table.AUTOMATIC
            self.editor.leave(self.draft.now())
        return self.editor.stage is Stage.CLOSED

    def labels(self) -> tuple[str, ...]:
        """What the function keys do now."""
        now = self._doings()
        return tuple(now[n].label if n in now else "" for n in range(1, 11))

    def doings(self) -> Doings:
        """The function keys of the moment."""
        found = {f"F{number}": doing.act for number, doing in self._doings().items()}
        if self._mode is Mode.LOOK:
            found |= self.looking.doings()
        return found

    def escape(self) -> bool:
        """A question is taken back, else the answer of the last key; what has nothing to save is left."""
        if self._moving:
            self.desk.feed_hold()  # what a hand hits first must do the safe thing on every page
        elif self.editor.stage is Stage.OFFERED:
            self.editor.abort()
        elif self._mode is not Mode.TEXT:
            self.back()
        elif self.editor.notice:
            self.editor.clear()
        elif self.desk.notice:
            return False
        elif self.editor.is_dirty(self.draft.now()):
            self.editor.notice = messages.UNSAVED
        else:
            self._target = page_table.AUTOMATIC
            self.abandon()
        return True

    def asks(self) -> str:
        """What F6 would do now."""
        return self.editor.notice if self.editor.asked else ""

    def prompt(self) -> str:
        """The answer of the last key, or else what was found in the cursor's line."""
        if self.editor.notice:
            return self.editor.notice
        if self._moving:
            return messages.RUNS_OLD
        if self._mode is Mode.LOOK:
            return self.looking.prompt()
        if self._mode in PROMPTS:
            return PROMPTS[self._mode]
        line = self.field.line
        found = self.field.finding_at(line)
        if found is not None:
            return f"LINE {line}: {found.text} {found.hint}".strip()
        return messages.STANDING

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Take up what the workers have finished, prove what has been typed, show it."""
        editor = self.editor
        self._moving = snapshot.state in MOVING
        editor.poll()
        if editor.stage is Stage.CLOSED:
            self._go()
            return
        self.draft.refresh()
        self._follow_stage()
        self.show_text()
        self.looking.refresh()
        self.versions.refresh()

    def _follow_stage(self) -> None:
        """The questions that the editor asks of itself."""
        stage = self.editor.stage
        if stage is Stage.NAMING and self._mode is not Mode.NAME:
            self.enter(Mode.NAME)
        elif stage is Stage.OFFERED and self._mode is not Mode.OFFER:
            self.enter(Mode.OFFER)
        elif stage is Stage.OPEN and self._mode in {Mode.NAME, Mode.OFFER}:
            self.enter(Mode.TEXT)

    # --- what keys do --------------------------------------------------------------------------------

    def _doings(self) -> dict[int, Doing]:
        return doings(self, self._mode)

    def enter(self, mode: Mode) -> None:
        """From now on the keys are for this."""
        self._mode = mode
        self.asking.show(mode)
        self.show_mode()
        if mode is Mode.HISTORY:
            self.versions.raise_()
            self.history.look(self.editor.name, self.draft.now())
        if mode in {Mode.HISTORY, Mode.OFFER}:
            self.setFocus()
        elif mode is Mode.TEXT:
            self.field.setFocus()

    def ask_text(self) -> None:
        """Find and replace."""
        self.enter(Mode.FIND)

    def ask_line(self) -> None:
        """Go to a line."""
        self.enter(Mode.GO_TO)

    def show_history(self) -> None:
        """The versions."""
        self.enter(Mode.HISTORY)

    def back(self) -> None:
        """Back to the text."""
        self.editor.keep_no_name()
        self.enter(Mode.TEXT)

    def go_to(self, line: int, column: int = 0) -> None:
        """The cursor to a place of the program."""
        if self._mode is Mode.LOOK:
            self.enter(Mode.TEXT)
        super().go_to(line, column)

    def next_finding(self) -> None:
        """The cursor to the next line that something was found in."""
        found = self.findings.following(self.field.line)
        if found is not None:
            self.go_to(found.line, found.column)
        else:
            self.editor.notice = "NOTHING WAS FOUND THAT IS WRONG"

    def save(self) -> None:
        """Save and go on."""
        self.editor.save(self.draft.now())

    def leave_to(self, page: str) -> None:
        """Save and go to another page."""
        self._target = page
        self.editor.leave(self.draft.now(), to_desk=page == page_table.AUTOMATIC)

    def abandon(self) -> None:
        """Go without saving."""
        self.editor.abandon(self.draft.now())

    def answer(self) -> None:
        """Yes to what the editor asks."""
        self.editor.answer(self.draft.now())

    def restore(self) -> None:
        """The marked version into the editor."""
        if self.history.text is not None:
            self.editor.restore(self.history.text, self.history.number)
            self.enter(Mode.TEXT)

    # --- Qt's calls ----------------------------------------------------------------------------------

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keys in the line that asks; the field that has the keyboard has the drawn one too."""
        if event.type() == QEvent.Type.FocusIn and isinstance(watched, QWidget):
            self.letters.write_into(watched)
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return self._key(event)
        return False

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Keys that no field has taken; what means nothing here is the frame's."""
        if not self._key(event):
            event.ignore()

    def _key(self, event: QKeyEvent) -> bool:
        action = action_of(self, event)
        if action is not None:
            action()
        return action is not None

    def _go(self) -> None:
        """The editor has been left."""
        if self.editor.notice:
            self.desk.say(self.editor.notice)
            self.editor.clear()
        self.host.go(self._target)
