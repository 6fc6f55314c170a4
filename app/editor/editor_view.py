"""Page EDITOR (F3): the text with its margin, the path, and the findings of the proof.

All functions are available from the keyboard, and every function key is a touch target.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QWidget

from app.desk.arithmetic import line_of
from app.desk.pages.sheet import Key
from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.status.prompt_line import MOVING
from app.editor import editor_messages as messages
from app.editor.code_help_view import CodeList, CodeStrip
from app.editor.editor import Editor, Stage, enter
from app.editor.editor_parts_view import ASKING, EditedPath, EditorParts, FindingList, HeadLine, Mode
from app.editor.question_view import AskLine, Finder
from app.editor.text_view import TextField, TypedText
from app.editor.versions import VersionHistory
from app.editor.versions_view import VersionList
from app.path.measuring import measuring_words
from app.path.part_player import player_of
from app.screen import page_table
from app.screen.entry_panel import PROGRAMS, LetterPad
from app.screen.page_base import EditorPanel, Host, KeyActions
from app.working_plane.working_plane_view import WorkingPlaneView
from core.executor.snapshot import Snapshot
from core.message import Message

if TYPE_CHECKING:
    from core.language.diagnostics import Diagnostic

Keys = dict[int, Key]
Actions = dict[int, Callable[[], None]]


PROMPTS = {
    Mode.FIND: messages.FINDING,
    Mode.GO_TO: messages.GOING,
    Mode.HISTORY: messages.CHOOSING,
    Mode.CODES: messages.CODING,
}
"""What the prompt line says while nothing else is to be said."""


class EditorPage(EditorParts):
    """Editor page; opens with the loaded program or with a typed name.

    Keys of the question line arrive in ``eventFilter``.
    """

    NAME = page_table.EDITOR

    def __init__(self, host: Host, editor: Editor, parent: QWidget) -> None:
        super().__init__(host, parent)
        look, self.editor = host.look, editor
        self.mode = Mode.TEXT
        self._target = page_table.AUTOMATIC  # page that is shown after leaving
        self._moving = False
        self.head = HeadLine(look, self.turn_letters, self.open_panel, self)
        self.letters = LetterPad(look, self._strike, self, PROGRAMS)
        self.field = TextField(look, self)
        self.path = EditedPath(look, self.go_to, self, player_of(host.desk))
        self.space = WorkingPlaneView(look, self)  # replaces the path for a mill program
        self.findings = FindingList(look, self._go_to_finding, self)
        self.code = CodeStrip(look, self.look_up, self)
        self.codes = CodeList(look, self.field, editor.proof, self.back, self)
        self.history = VersionHistory(editor.archive, editor.worker)
        self.versions = VersionList(look, self.history, self)
        self.ask = AskLine(look, self, self)
        self.finder = Finder(self.field, self.ask)
        self.typed_text = TypedText(self.field, self.editor)
        self.panel: EditorPanel = page_table.editor_panel(EditorPanel)(host, self)
        # numbers of the panel's text that was proved and of the text put into the field
        self._shown_panel = (0, 0)

    # --- calls of the main window --------------------------------------------------------------------

    def opens(self) -> bool:
        """Return whether the editor can open. It cannot while a program runs or the spindle turns."""
        return self.editor.stage is not Stage.CLOSED or enter(self.desk, self.editor)

    def opened(self) -> None:
        """Reset the page. The program is being read."""
        self._target = page_table.AUTOMATIC
        self.enter(Mode.TEXT)

    def leave(self) -> bool:
        """Start saving and return whether the page can close now.

        Otherwise it closes after saving.
        """
        if self.editor.stage is Stage.OFFERED:
            self.editor.abort()
        if self.editor.stage is not Stage.CLOSED:
            self._target = page_table.AUTOMATIC
            self.editor.leave(self.typed_text.now())
        return self.editor.stage is Stage.CLOSED

    def labels(self) -> tuple[str, ...]:
        """Return the labels of the present function keys."""
        now = self._keys()
        return tuple(now[n].label if n in now else "" for n in range(1, 11))

    def key_actions(self) -> KeyActions:
        """Return the actions of the present function keys."""
        found = {f"F{number}": key.action for number, key in self._keys().items()}
        found["Codes"] = self.look_up
        found |= {name: partial(self.open_panel, name) for name in self.panel.KEYS}
        if self.mode is Mode.LOOK:  # keys of the Automatic page with the same meaning
            path = self.path
            found |= {"Zoom in": partial(path.zoom, 1), "Zoom out": partial(path.zoom, -1)}
            found |= {"Measure": self.back, "View": path.next_view}
        return found

    def esc_holds(self) -> bool:
        """Return whether Esc stops the axes during motion, which it does unless a question is pending."""
        return not self.editor.notice and self.editor.stage is not Stage.OFFERED

    def escape(self) -> bool:
        """Cancel the question, the mode or the message. Leave the editor without unsaved changes."""
        if self._moving and self.esc_holds():
            self.desk.feed_hold()  # Esc must do the safe action on every page.
        elif self.editor.stage is Stage.OFFERED:
            self.editor.abort()
        elif self.mode is not Mode.TEXT:
            if self.mode is not Mode.PANEL or not self.panel.model.escape():
                self.back()
        elif self.editor.notice:
            self.editor.clear()
        elif self.desk.notice:
            return False
        elif self.editor.is_dirty(self.typed_text.now()):
            self.editor.notice = messages.UNSAVED
        else:
            self._target = page_table.AUTOMATIC
            self.abandon()
        return True

    def asks(self) -> str:
        """Return the question that F6 confirms, or an empty string."""
        return self.editor.notice if self.editor.asked else ""

    def prompt(self) -> str:
        """Return the last message, or else the finding in the cursor line."""
        if self.editor.notice:
            return self.editor.notice
        if self._moving:
            return messages.RUNS_OLD
        own = {Mode.LOOK: measuring_words, Mode.PANEL: self.panel.model.prompt}.get(self.mode)
        if own is not None or self.mode in PROMPTS:
            return own() if own is not None else PROMPTS[self.mode]
        line = self.field.line
        found = self.field.finding_at(line)
        if found is not None:
            return Message(
                "LINE {line}: {value} {hint}", line=line, value=found.text, hint=found.hint
            ).strip()
        return messages.STANDING

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Process finished work, prove the typed text and update the page."""
        editor = self.editor
        self._moving = snapshot.state in MOVING
        editor.poll()
        if editor.stage is Stage.CLOSED:
            self._go()
            return
        self.typed_text.refresh()
        self._follow_stage()
        if self.mode is Mode.PANEL:
            self._follow_panel()
        self.show_text()
        if self.mode is Mode.LOOK and self.path.ruler is None:
            self.back()  # Measuring has ended, so the text gets the keyboard again.
        self.versions.refresh()
        self.codes.refresh()

    def _follow_stage(self) -> None:
        """Change the mode when the editor waits for a name or offers a new file."""
        stage = self.editor.stage
        if stage is Stage.NAMING and self.mode is not Mode.NAME:
            self.enter(Mode.NAME)
        elif stage is Stage.OFFERED and self.mode is not Mode.OFFER:
            self.enter(Mode.OFFER)
        elif stage is Stage.OPEN and self.mode in {Mode.NAME, Mode.OFFER}:
            self.enter(Mode.TEXT)
        elif stage is Stage.OPEN and self.mode is Mode.TEXT and self.editor.made_of is not None:
            self._make_of(self.editor.made_of)

    # --- the function keys ---------------------------------------------------------------------------

    def _keys(self) -> Keys:
        """Return the function keys of the present mode."""
        word = "SAV+MENU" if self.mode is Mode.TEXT and self.typed_text.dirty else "MENU"
        menu, back = Key(word, partial(self.leave_to, page_table.MENU)), Key("BACK", self.back)
        undo = {8: Key("UNDO", self.field.undo), 9: Key("REDO", self.field.redo)}
        of_mode: dict[Mode, Callable[[], Keys]] = {
            Mode.FIND: lambda: self.finder.keys() | undo,
            Mode.HISTORY: lambda: {2: Key("RESTORE", self.restore), **self.versions.keys()},
            Mode.CODES: self.codes.keys,
            Mode.PANEL: self.panel.model.keys,
            Mode.LOOK: lambda: {3: Key("GO TO LINE", self._to_line), **self.path.keys()},
        }
        if self.mode is Mode.PANEL and not self.panel.model.listing:
            # A form must be written or discarded before the page closes.
            return {**of_mode[self.mode](), 10: back}
        if self.mode in of_mode:
            return {1: menu, **of_mode[self.mode](), 10: back}
        if self.mode is Mode.OFFER:
            return {1: Key("CREATE", self.editor.create), 10: Key("ABORT", self.editor.abort)}
        if self.mode is Mode.TEXT:
            return {1: menu, **self._text_keys(), **undo, 10: Key("DISCARD", self.abandon)}
        return {2: Key("SAVE" if self.mode is Mode.NAME else "GO", self._take), 10: back}

    def _text_keys(self) -> Keys:
        return {
            2: Key("SAVE", self.save),
            3: Key(self._load_label(), partial(self.leave_to, page_table.AUTOMATIC)),
            4: Key("FIND", partial(self.enter, Mode.FIND)),
            5: Key("GO TO", partial(self.enter, Mode.GO_TO)),
            6: Key("YES", self.answer) if self.editor.asked else Key("NEXT ERROR", self.next_finding),
            7: Key("HISTORY", partial(self.enter, Mode.HISTORY)),
        }

    def _load_label(self) -> str:
        """Return the label of F3, which loads saved changes or a text that is not loaded."""
        editor, now = self.editor, self.desk.session.now
        if self.typed_text.dirty:
            return "SAV+LOAD"
        document = editor.document
        other = document is not None and document.path == now.path and self.desk.storage.difference()
        return "LOAD" if editor.was_saved or other or now.path is None else "LEAVE"

    def enter(self, mode: Mode) -> None:
        """Switch to a mode."""
        self.mode = mode
        self._ask()
        self.show_mode()
        if mode is Mode.HISTORY:
            self.versions.raise_()
            self.history.look(self.editor.name, self.typed_text.now())
        if mode is Mode.CODES:
            self.codes.raise_()
        if mode is Mode.PANEL:
            self.panel.raise_()
        if mode in {Mode.HISTORY, Mode.OFFER, Mode.CODES, Mode.PANEL}:
            self.setFocus()
        elif mode is Mode.TEXT:
            self.field.setFocus()

    def back(self) -> None:
        """Return to the text from a question, a list or the path."""
        self.editor.keep_no_name()
        if self.mode is Mode.PANEL:
            self.typed_text.stale = True  # The present proof can belong to the preview of a form.
        self.enter(Mode.TEXT)

    def go_to(self, line: int, column: int = 0) -> None:
        """Move the cursor to a line and column."""
        if self.mode is Mode.LOOK:
            self.enter(Mode.TEXT)
        self.field.go_to(max(1, line), column)
        self.field.setFocus()

    def _go_to_finding(self, found: Diagnostic) -> None:
        """Move the cursor to a finding. For a finding in the part, show the part after that line."""
        self.go_to(found.line, found.column)
        if found.n:
            self.path.show_part()

    def next_finding(self) -> None:
        """Move the cursor to the next finding."""
        found = self.findings.following(self.field.line)
        if found is not None:
            self._go_to_finding(found)
        else:
            self.editor.notice = "NO ERRORS OR WARNINGS FOUND"

    def save(self) -> None:
        """Save the text and continue editing."""
        self.editor.save(self.typed_text.now())

    def leave_to(self, page: str) -> None:
        """Save the text and go to another page."""
        self._target = page
        self.editor.leave(self.typed_text.now(), to_desk=page == page_table.AUTOMATIC)

    def abandon(self) -> None:
        """Leave without saving."""
        self.editor.abandon(self.typed_text.now())

    def answer(self) -> None:
        """Confirm the editor's question."""
        self.editor.answer(self.typed_text.now())

    def restore(self) -> None:
        """Restore the selected version into the editor."""
        if self.history.text is not None:
            self.editor.restore(self.history.text, self.history.number)
            self.enter(Mode.TEXT)

    def look_up(self) -> None:
        """Complete the typed code, or look up the code at the cursor."""
        if self.editor.stage is not Stage.OPEN or self.mode not in {Mode.TEXT, Mode.CODES}:
            return
        if self.codes.ask():
            self.enter(Mode.CODES)
        else:
            self.editor.notice = messages.NO_CODES

    def look_at_path(self) -> None:
        """Give the keyboard to the path, for measuring and for finding the line of a move."""
        if self.path.drawn:
            self.enter(Mode.LOOK)
        else:
            self.editor.notice = messages.NO_PATH

    def open_panel(self, key: str = "") -> None:
        """Open the panel of an optional feature by its key. From the panel, return to the text."""
        if self.mode is Mode.PANEL:
            self.back()
        elif self.editor.stage is Stage.OPEN and self.mode is Mode.TEXT:
            panel, now = self.panel, self.typed_text.now()
            self.editor.notice = panel.open_at(key, self.editor.name, now, self.field.line)
            if not self.editor.notice:
                self.desk.clear()
                self._shown_panel = (panel.model.number, panel.model.written)
                self.enter(Mode.PANEL)

    def _make_of(self, file: Path) -> None:
        """Open the form for the file from which this program is generated."""
        self.editor.made_of = None
        self.open_panel()
        if self.mode is Mode.PANEL:
            self.panel.model.open_file(file)

    def _follow_panel(self) -> None:
        """Prove the preview of the form, and put the written text into the field."""
        model, (proved, written) = self.panel.model, self._shown_panel
        model.look()
        if model.written != written:
            self.field.put_text(model.text, afresh=False)
            self.field.go_to(model.at)
        if model.number != proved and not self.typed_text.stale:
            self.editor.preview(model.text)
        self._shown_panel = (model.number, model.written)
        self.panel.refresh()

    def typed(self, key: str) -> bool:
        """Pass a key to the panel's form or list, and return whether it was used."""
        return self.mode is Mode.PANEL and self.panel.model.typed(key)

    def takes(self, key: str) -> bool:
        """Return whether a character is text of the form."""
        return self.mode is Mode.PANEL and self.panel.model.takes(key)

    def has_field(self) -> bool:
        """Return whether the form has the keyboard."""
        return self.mode is Mode.PANEL

    def _to_line(self) -> None:
        """Move the cursor to the line whose path is at the crosshair."""
        self.editor.notice = self.path.line_here()

    # --- question line ---------------------------------------------------------------------------------

    def _ask(self) -> None:
        """Show the question of the mode, or hide the question line."""
        if self.mode is Mode.FIND:
            self.ask.ask("FIND", "REPLACE WITH", entry=self.finder.start())
            self.finder.look()
        elif self.mode is Mode.GO_TO:
            self.ask.ask("GO TO LINE", entry=str(self.field.line))
        elif self.mode is Mode.NAME:
            self.ask.ask("SAVE AS", entry=self.editor.name)
        else:
            self.ask.hide()

    def _take(self) -> None:
        """Accept the entry of the question line."""
        entry = self.ask.first.text()
        if self.mode is Mode.FIND:
            self.finder.step(1)
        elif self.mode is Mode.NAME:
            self.editor.take_name(entry)
        elif (number := line_of(entry)) is None or number > self.field.blockCount():
            self.ask.answer = Message("ENTER A NUMBER FROM 1 TO {count}", count=self.field.blockCount())
            self.ask.first.selectAll()  # the next digit replaces the entry
        else:
            self.enter(Mode.TEXT)
            self.go_to(number)

    # --- Qt's calls ----------------------------------------------------------------------------------

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Handle keys of the question line. The focused field also receives the drawn keyboard."""
        if event.type() == QEvent.Type.FocusIn and isinstance(watched, QWidget):
            self.letters.write_into(watched)
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return self._key(event)
        return False

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Handle keys that no field has used, and pass the rest to the main window."""
        if not self._key(event):
            event.ignore()

    def _key(self, event: QKeyEvent) -> bool:
        action = self._action_of(event)
        if action is not None:
            action()
        return action is not None

    def _action_of(self, event: QKeyEvent) -> Callable[[], None] | None:
        """Return the action of a key other than text and function keys, or None."""
        key, modifiers = event.key(), event.modifiers()
        if modifiers & Qt.KeyboardModifier.ControlModifier:
            return self._chords().get(key)
        if self.mode in ASKING:
            before = bool(modifiers & Qt.KeyboardModifier.ShiftModifier) and self.mode is Mode.FIND
            enter, tab = partial(self.finder.step, -1) if before else self._take, self.ask.other_field
            asking: Actions = dict.fromkeys((Qt.Key.Key_Return, Qt.Key.Key_Enter), enter)
            asking |= dict.fromkeys((Qt.Key.Key_Tab, Qt.Key.Key_Backtab), tab)
            return asking.get(key)
        if self.mode is Mode.CODES:
            return self.codes.arrows().get(key)
        if self.mode is Mode.HISTORY:
            restore: Actions = dict.fromkeys((Qt.Key.Key_Return, Qt.Key.Key_Enter), self.restore)
            return (self.versions.arrows() | restore).get(key)
        return None

    def _chords(self) -> Actions:
        """Return the actions of Ctrl with a key. Ctrl with arrows pans the path in the path mode."""
        find, chords = partial(self.enter, Mode.FIND), dict[int, Callable[[], None]]()
        if self.mode is not Mode.HISTORY:
            chords = {
                Qt.Key.Key_S: self.save,
                Qt.Key.Key_Space: self.look_up,
                Qt.Key.Key_F: find,
                Qt.Key.Key_H: find,
                Qt.Key.Key_G: partial(self.enter, Mode.GO_TO),
                Qt.Key.Key_M: self.look_at_path,
            }
        if self.mode is Mode.LOOK:
            ways = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, -1)}
            ways[Qt.Key.Key_Down] = (0, 1)
            chords |= {key: partial(self.path.pan, *way) for key, way in ways.items()}
        return chords

    def _go(self) -> None:
        """Show the editor's last message and the requested page after the editor has closed."""
        if self.editor.notice:
            self.desk.say(self.editor.notice)
            self.editor.clear()
        self.host.go(self._target)
