"""The F3 editor: the text with its margin, the path beside it, what proving has found, and the function keys.

``refresh`` is called once a frame while the page is shown. Everything is done by keys alone, and every key in
the lowest row is a target for a finger.
"""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.editing import words
from app.desk.editing.editor import Editor, Stage
from app.desk.editing.history import History
from app.desk.prompts import MOVING
from app.screen.bars import PromptLine
from app.screen.editor.ask import AskLine
from app.screen.editor.bars import EditorTitle, Heading, KeyRow
from app.screen.editor.doings import Doing, Mode, doings
from app.screen.editor.drawn import EditedPath
from app.screen.editor.finder import Finder
from app.screen.editor.findings import FindingList
from app.screen.editor.layout import editor_places
from app.screen.editor.textfield import TextField
from app.screen.editor.versions import VersionList
from app.screen.layout import unit
from app.screen.look import Look

_ASKING = {Mode.FIND, Mode.GO_TO, Mode.NAME}


class EditorPage(QWidget):
    """``closed`` is called when the editor has been left and the page should go."""

    def __init__(
        self, look: Look, desk: Desk, editor: Editor, closed: Callable[[], None], parent: QWidget
    ) -> None:
        super().__init__(parent)
        self.look, self.desk, self.editor, self._closed = look, desk, editor, closed
        self._mode = Mode.TEXT
        self._taken = 0  # number of the text of the editor that stands in the field
        self._stale = False  # the text has changed since it was given to the editor
        self._text = ""
        self._dirty = False
        self.title = EditorTitle(look, self)
        self.field = TextField(look, self)
        self.path = EditedPath(look, self)
        self.findings = FindingList(look, self.go_to, self)
        self.history = History(editor.bench.archive, editor.worker)
        self.versions = VersionList(look, self.history, self)
        self.ask = AskLine(look, self, self)
        self.finder = Finder(self.field, self.ask)
        self.prompt = PromptLine(look, self)
        self.keys = KeyRow(look, self._press, self)
        self.field.textChanged.connect(self._changed)
        self.dress()

    # --- once a frame --------------------------------------------------------------------------------

    def refresh(self) -> None:
        """Take up what the workers have finished, prove what has been typed, show one snapshot."""
        editor = self.editor
        snapshot, view, _loaded = self.desk.look()
        editor.poll()
        if editor.stage is Stage.CLOSED:
            self._go()
            return
        self._take_text()
        self._hand_over()
        self._follow_stage()
        line, column = self.field.line, self.field.textCursor().positionInBlock() + 1
        place = f"LINE {line} OF {self.field.blockCount()}  ·  {column}"
        self.title.show_heading(
            Heading(editor.name, self._mark(), view.state, view.tone, place, self.desk.time_of_day())
        )
        findings = editor.checker.now
        self.field.show_findings(findings.by_line)
        self.findings.show_findings(findings, line)
        self.path.show_picture(findings.picture)
        self.path.follow(line, snapshot.modal.metric)
        self.path.advance()
        self.versions.refresh()
        self.keys.show_labels({number: doing.label for number, doing in self._doings().items()})
        self.prompt.show_text(self._words(line, moving=snapshot.state in MOVING), answer=bool(editor.notice))

    def _take_text(self) -> None:
        editor = self.editor
        if editor.text_number == self._taken:
            return
        self._taken = editor.text_number
        self.field.put_text(editor.text, afresh=not editor.restored)
        self._stale = True
        self.field.setFocus()

    def _hand_over(self) -> None:
        if not self._stale:
            return
        self._stale = False
        text = self.field.toPlainText()
        self._dirty = self.editor.is_dirty(text)
        self._text = text
        self.editor.changed(text)

    def _follow_stage(self) -> None:
        """The questions that the editor asks of itself."""
        stage = self.editor.stage
        if stage is Stage.NAMING and self._mode is not Mode.NAME:
            self._enter(Mode.NAME)
        elif stage is Stage.OFFERED and self._mode is not Mode.OFFER:
            self._enter(Mode.OFFER)
        elif stage is Stage.OPEN and self._mode in {Mode.NAME, Mode.OFFER}:
            self._enter(Mode.TEXT)
        self.field.setReadOnly(stage is not Stage.OPEN)
        self._dirty = self.editor.is_dirty(self._text)

    def _mark(self) -> str:
        document = self.editor.document
        if document is None:
            return ""
        if document.protected:
            return "SAMPLE, CHANGED" if self._dirty else "SAMPLE"
        if document.fresh:
            return "NEW"
        return "CHANGED" if self._dirty else ""

    def _words(self, line: int, *, moving: bool) -> str:
        if self.editor.notice:
            return self.editor.notice
        if moving:
            return "THE MACHINE MOVES BY THE PROGRAM AS IT WAS LOADED: ESC FOR FEED HOLD"
        found = self.field.finding_at(line)
        if found is not None:
            return f"LINE {line}: {found.message} {found.hint}".strip()
        return "F3 SAVES AND PUTS THE PROGRAM ON THE DESK, PROVED ANEW"

    def _changed(self) -> None:
        if self.field.document().revision() >= 0:
            self._stale = True

    # --- what keys do --------------------------------------------------------------------------------

    @property
    def mode(self) -> Mode:
        """What the keys are for now."""
        return self._mode

    def _doings(self) -> dict[int, Doing]:
        return doings(self, self._mode)

    def _press(self, number: int) -> None:
        """A function key, or a finger on it."""
        doing = self._doings().get(number)
        if doing is not None:
            doing.act()
            self.refresh_if_shown()

    def refresh_if_shown(self) -> None:
        """What a key has done is seen at once."""
        if self.editor.stage is not Stage.CLOSED:
            self.refresh()

    def _enter(self, mode: Mode) -> None:
        self._mode = mode
        if mode is Mode.FIND:
            self.ask.ask("FIND", "REPLACE BY", entry=self.finder.start())
            self.finder.look()
        elif mode is Mode.GO_TO:
            self.ask.ask("GO TO LINE", entry=str(self.field.line))
        elif mode is Mode.NAME:
            self.ask.ask("SAVE AS", entry=self.editor.name)
        else:
            self.ask.hide()
        self.versions.setVisible(mode is Mode.HISTORY)
        self._lay_out()
        if mode is Mode.HISTORY:
            self.versions.raise_()
            self.history.look(self.editor.name, self._now())
        if mode in {Mode.HISTORY, Mode.OFFER}:
            self.setFocus()
        elif mode is Mode.TEXT:
            self.field.setFocus()

    def _now(self) -> str:
        return self.field.toPlainText()

    def ask_text(self) -> None:
        """Find and replace."""
        self._enter(Mode.FIND)

    def ask_line(self) -> None:
        """Go to a line."""
        self._enter(Mode.GO_TO)

    def show_history(self) -> None:
        """The versions."""
        self._enter(Mode.HISTORY)

    def back(self) -> None:
        """Back to the text."""
        self.editor.keep_no_name()
        self._enter(Mode.TEXT)

    def go_to(self, line: int, column: int = 0) -> None:
        """The cursor to a place of the program."""
        self.field.go_to(max(1, line), column)
        self.field.setFocus()

    def next_finding(self) -> None:
        """The cursor to the next line that something was found in."""
        found = self.findings.following(self.field.line)
        if found is not None:
            self.go_to(found.line, found.column)
        else:
            self.editor.notice = "NOTHING WAS FOUND THAT IS WRONG"

    def save(self) -> None:
        """Save and go on."""
        self.editor.save(self._now())

    def leave(self) -> None:
        """Save and go."""
        self.editor.leave(self._now())

    def abandon(self) -> None:
        """Go without saving."""
        self.editor.abandon(self._now())

    def restore(self) -> None:
        """The marked version into the editor."""
        if self.history.text is not None:
            self.editor.restore(self.history.text, self.history.number)
            self._enter(Mode.TEXT)

    def take(self) -> None:
        """Return in the line that asks."""
        entry = self.ask.first.text()
        if self._mode is Mode.FIND:
            self.finder.step(1)
        elif self._mode is Mode.GO_TO:
            self._go_to_typed(entry)
        elif self._mode is Mode.NAME:
            self.editor.take_name(entry)

    def _go_to_typed(self, entry: str) -> None:
        number = entry.strip()
        if not (number.isascii() and number.isdigit()) or not 1 <= int(number) <= self.field.blockCount():
            self.ask.say(f"A NUMBER FROM 1 TO {self.field.blockCount()}")
            return
        self._enter(Mode.TEXT)
        self.go_to(int(number))

    def _escape(self) -> None:
        if self.desk.snapshot().state in MOVING:
            self.desk.feed_hold()  # what a hand hits first must do the safe thing on every page
        elif self.editor.stage is Stage.OFFERED:
            self.editor.abort()
        elif self._mode is not Mode.TEXT:
            self.back()
        else:
            self.editor.clear()

    # --- Qt's calls ----------------------------------------------------------------------------------

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        """Keys in the line that asks."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return self._key(event)
        return False

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Keys that no field has taken. None goes further: a letter typed here starts nothing elsewhere."""
        self._key(event)
        event.accept()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Nor does a release."""
        event.accept()

    def _key(self, event: QKeyEvent) -> bool:
        number = event.key() - Qt.Key.Key_F1 + 1
        shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        control = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        if 1 <= number <= 10:
            if not event.isAutoRepeat():
                self._press(number)
            return True
        if number in {11, 12}:
            self.editor.notice = words.NO_START
            return True
        action = self._chords().get(event.key()) if control else self._plain(shift).get(event.key())
        if action is None:
            return False
        action()
        self.refresh_if_shown()
        return True

    def _chords(self) -> dict[int, Callable[[], None]]:
        if self._mode is Mode.HISTORY:
            return {}
        return {
            Qt.Key.Key_S: self.save,
            Qt.Key.Key_F: self.ask_text,
            Qt.Key.Key_H: self.ask_text,
            Qt.Key.Key_G: self.ask_line,
        }

    def _plain(self, shift: bool) -> dict[int, Callable[[], None]]:
        keys: dict[int, Callable[[], None]] = {Qt.Key.Key_Escape: self._escape}
        if self._mode in _ASKING:
            back = self._mode is Mode.FIND and shift
            enter = (lambda: self.finder.step(-1)) if back else self.take
            tab = self.ask.other_field
            keys |= {Qt.Key.Key_Return: enter, Qt.Key.Key_Enter: enter}
            keys |= {Qt.Key.Key_Tab: tab, Qt.Key.Key_Backtab: tab}
        elif self._mode is Mode.HISTORY:
            page = self.versions.lines
            keys |= {
                Qt.Key.Key_Up: lambda: self.history.mark(self.history.marked - 1),
                Qt.Key.Key_Down: lambda: self.history.mark(self.history.marked + 1),
                Qt.Key.Key_PageUp: lambda: self.versions.look_at(-page),
                Qt.Key.Key_PageDown: lambda: self.versions.look_at(page),
                Qt.Key.Key_Return: self.restore,
                Qt.Key.Key_Enter: self.restore,
            }
        return keys

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Everything again, in the new unit."""
        self.look.resize(unit(self.width(), self.height()))
        self._lay_out()
        self.dress()

    def _lay_out(self) -> None:
        at = editor_places(self.width(), self.height(), asking=self._mode in _ASKING)
        for part, rect in (
            (self.title, at.title),
            (self.field, at.text),
            (self.path, at.path),
            (self.findings, at.findings),
            (self.versions, at.body),
            (self.ask, at.ask),
            (self.prompt, at.prompt),
            (self.keys, at.keys),
        ):
            part.setGeometry(*rect)
            part.update()

    def dress(self) -> None:
        """Everything in the colours and sizes that are in force now."""
        self.field.dress()
        self.ask.dress()
        self.path.restart()
        for part in self.findChildren(QWidget):
            part.update()

    def _go(self) -> None:
        """The editor has been left."""
        if self.editor.notice:
            self.desk.say(self.editor.notice)
            self.editor.clear()
        self._mode = Mode.TEXT
        self.ask.hide()
        self.versions.hide()
        self._closed()
