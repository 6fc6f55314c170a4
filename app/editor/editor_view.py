"""Editor page (F3): the text with its margin, the path, and the findings of the proof.

All functions are available from the keyboard, and every function key is also a touch target.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QWidget

from app.desk.arithmetic import evaluate_line_number
from app.desk.pages.code_help import make_code_blocks
from app.desk.pages.guide_text import GuideBlock
from app.desk.pages.table_content import FunctionKey
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.desk.status.prompt_line import MOVING_STATES
from app.editor import editor_messages as messages
from app.editor.code_help_view import CodeList, CodeStrip
from app.editor.conversion_notice import ConversionNotice
from app.editor.editor_model import EditorModel, EditorStage, find_load_label, open_editor
from app.editor.editor_modes import ENTRY_MODES, MODE_PROMPTS, EditorMode
from app.editor.editor_parts_view import EditorHeadLine, EditorParts, EditorPathView, FindingList
from app.editor.live_proof import describe_finding
from app.editor.panel_text_view import PanelSynchronizer
from app.editor.question_view import QuestionLine, TextFinder, show_mode_question
from app.editor.text_synchronizer_view import TextSynchronizer
from app.editor.text_view import ProgramTextField
from app.editor.version_history import VersionHistory
from app.editor.versions_view import VersionList
from app.path.measuring import make_measuring_prompt
from app.path.part_player import make_part_player
from app.screen import page_table
from app.screen.entry_panel import PROGRAM_KEYS, LetterPad
from app.screen.page_base import EditorPanel, KeyActions, PageHost
from app.working_plane.working_plane_view import WorkingPlaneView
from core.executor.snapshot import Snapshot
from core.message import Message

if TYPE_CHECKING:
    from core.language.diagnostics import Diagnostic

ModeKeys = dict[int, FunctionKey]
KeyActionMap = dict[int, Callable[[], None]]


class EditorPage(EditorParts):
    """Editor page for the loaded program or for a program whose name was typed.

    The method ``eventFilter`` receives the keys of the question line.
    """

    NAME = page_table.EDITOR

    def __init__(self, host: PageHost, editor_model: EditorModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        look, self.editor = host.theme, editor_model
        self.mode = EditorMode.TEXT
        self._target = page_table.AUTOMATIC  # page that is shown after leaving
        self._moving = False
        self.head_line = EditorHeadLine(look, self.toggle_keyboard, self.open_panel, self)
        self.letter_pad = LetterPad(look, self._strike, self, PROGRAM_KEYS)
        self.text_field = ProgramTextField(look, self)
        self.path_view = EditorPathView(look, self.move_cursor_to, self, make_part_player(host.desk))
        self.plane_view = WorkingPlaneView(look, self)  # replaces the path for a mill program
        self.finding_list = FindingList(look, self._show_finding, self)
        self.code_strip = CodeStrip(look, self.complete_code, self)
        self.code_list = CodeList(look, self.text_field, editor_model.live_proof, self.return_to_text, self)
        self.version_history = VersionHistory(editor_model.version_archive, editor_model.worker)
        self.version_list = VersionList(look, self.version_history, self)
        self.conversion_notice = ConversionNotice(host.desk, editor_model)
        self.question_line = QuestionLine(look, self, self)
        self.text_finder = TextFinder(self.text_field, self.question_line)
        self.text_synchronizer = TextSynchronizer(self.text_field, self.editor)
        self.editor_panel: EditorPanel = page_table.find_editor_panel_class(EditorPanel)(host, self)
        self.panel_text = PanelSynchronizer(
            self.editor_panel, self.editor, self.text_field, self.text_synchronizer
        )

    # --- calls of the main window --------------------------------------------------------------------

    def can_open(self) -> bool:
        """Open the editor if possible, and return whether it opens.

        The editor cannot open while a program runs or the spindle turns.
        """
        return self.editor.stage is not EditorStage.CLOSED or open_editor(self.desk, self.editor)

    def on_open(self) -> None:
        """Reset the page when it opens, before the program has been read."""
        self._target = page_table.AUTOMATIC
        self.enter_mode(EditorMode.TEXT)

    def try_leave_page(self) -> bool:
        """Start saving the text, and return whether the page can close now.

        If the result is False, the page closes after the file is saved.
        """
        if self.editor.stage is EditorStage.OFFERED:
            self.editor.cancel_document_offer()
        if self.editor.stage is not EditorStage.CLOSED:
            self._target = page_table.AUTOMATIC
            self.editor.save_and_leave(self.text_synchronizer.read_text())
        return self.editor.stage is EditorStage.CLOSED

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the labels of the current function keys."""
        now = self._find_mode_keys()
        return tuple(now[n].label if n in now else "" for n in range(1, 11))

    def make_key_actions(self) -> KeyActions:
        """Return the actions of the current function keys."""
        found = {f"F{number}": key.action for number, key in self._find_mode_keys().items()}
        found["Codes"] = self.complete_code
        found |= {name: partial(self.open_panel, name) for name in self.editor_panel.KEYS}
        if self.mode is EditorMode.PATH:  # keys of the Automatic page with the same meaning
            path = self.path_view
            found |= {"Zoom in": partial(path.zoom_view, 1), "Zoom out": partial(path.zoom_view, -1)}
            found |= {"Measure": self.return_to_text, "View": path.select_next_view}
        return found

    def is_esc_stop_key(self) -> bool:
        """Return whether Esc stops the axes during motion.

        Esc does not stop the axes while a question is pending.
        """
        return not self.editor.message and self.editor.stage is not EditorStage.OFFERED

    def handle_escape(self) -> bool:
        """Cancel the question, mode or message. If none of them is open, close the editor.

        An editor with unsaved changes does not close. While an axis moves and no question is pending, Esc
        starts a feed hold instead. Returns False if the window must handle Esc.
        """
        if self._moving and self.is_esc_stop_key():
            self.desk.start_feed_hold()  # Esc must do the safe action on every page.
        elif self.editor.stage is EditorStage.OFFERED:
            self.editor.cancel_document_offer()
        elif self.mode is not EditorMode.TEXT:
            if self.mode is not EditorMode.PANEL or not self.editor_panel.model.handle_escape():
                self.return_to_text()
        elif self.editor.message:
            self.editor.clear_message()
        elif self.desk.prompt_notice:
            return False
        elif self.conversion_notice.dismiss():
            pass
        elif self.editor.is_dirty(self.text_synchronizer.read_text()):
            self.editor.message = messages.UNSAVED_CHANGES
        else:
            self.discard_and_leave()
        return True

    def needs_height(self) -> bool:
        """Return whether the letter keyboard or large keys of the panel are shown."""
        return not self.letter_pad.isHidden() or self.editor_panel.needs_height()

    def find_pending_question(self) -> str:
        """Return the question that F6 confirms, or an empty string if no question is pending."""
        return self.editor.message if self.editor.pending_action else ""

    def prompt_text(self) -> str:
        """Return the last message of the editor, or else the finding of the cursor line."""
        if self.editor.message:
            return self.editor.message
        if self._moving:
            return messages.TEXT_NOT_RUNNING
        own = {
            EditorMode.PATH: make_measuring_prompt,
            EditorMode.PANEL: self.editor_panel.model.prompt_text,
        }.get(self.mode)
        if own is not None or self.mode in MODE_PROMPTS:
            return own() if own is not None else MODE_PROMPTS[self.mode]
        line = self.text_field.cursor_line
        found = self.text_field.find_finding(line)
        finding_text = describe_finding(found, line) if found is not None else messages.SAVE_HINT
        return self.conversion_notice.text or finding_text

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: LoadedProgram) -> None:
        """Process completed background work, submit typed text for proof, and update the page."""
        editor = self.editor
        self._moving = snapshot.state in MOVING_STATES
        editor.poll()
        if editor.stage is EditorStage.CLOSED:
            self._handle_closed()
            return
        self.text_synchronizer.synchronize()
        self.conversion_notice.update()
        self._update_stage()
        if self.mode is EditorMode.PANEL:
            self.panel_text.synchronize()
        self.show_text()
        if self.mode is EditorMode.PATH and self.path_view.measurement is None:
            self.return_to_text()  # Measuring has ended, so the text gets the keyboard again.
        self.version_list.refresh()
        self.code_list.refresh()

    def _update_stage(self) -> None:
        """Change the mode if the editor is waiting for a name or offers to create a new file."""
        stage = self.editor.stage
        if stage is EditorStage.NAMING and self.mode is not EditorMode.NAME:
            self.enter_mode(EditorMode.NAME)
        elif stage is EditorStage.OFFERED and self.mode is not EditorMode.NEW_FILE:
            self.enter_mode(EditorMode.NEW_FILE)
        elif stage is EditorStage.OPEN and self.mode in {EditorMode.NAME, EditorMode.NEW_FILE}:
            self.enter_mode(EditorMode.TEXT)
        elif (
            stage is EditorStage.OPEN
            and self.mode is EditorMode.TEXT
            and self.editor.source_drawing is not None
        ):
            self._make_from_file(self.editor.source_drawing)

    # --- the function keys ---------------------------------------------------------------------------

    def _find_mode_keys(self) -> ModeKeys:
        """Return the function keys of the current mode."""
        word = "SAV+MENU" if self.mode is EditorMode.TEXT and self.text_synchronizer.is_dirty else "MENU"
        menu, back = (
            FunctionKey(word, partial(self.save_and_open_page, page_table.MENU)),
            FunctionKey("BACK", self.return_to_text),
        )
        undo = {8: FunctionKey("UNDO", self.text_field.undo), 9: FunctionKey("REDO", self.text_field.redo)}
        of_mode: dict[EditorMode, Callable[[], ModeKeys]] = {
            EditorMode.FIND: lambda: self.text_finder.make_function_keys() | undo,
            EditorMode.HISTORY: lambda: {
                2: FunctionKey("RESTORE", self.restore_version),
                **self.version_list.make_function_keys(),
            },
            EditorMode.CODES: self.code_list.make_function_keys,
            EditorMode.PANEL: self.editor_panel.model.make_function_keys,
            EditorMode.PATH: lambda: {
                3: FunctionKey("GO TO LINE", self._jump_to_line),
                **self.path_view.make_function_keys(),
            },
        }
        if self.mode is EditorMode.PANEL and not self.editor_panel.model.is_list_shown:
            # A form must be written or discarded before the page closes.
            return {**of_mode[self.mode](), 10: back}
        if self.mode in of_mode:
            return {1: menu, **of_mode[self.mode](), 10: back}
        if self.mode is EditorMode.NEW_FILE:
            return {
                1: FunctionKey("CREATE", self.editor.create_document),
                10: FunctionKey("ABORT", self.editor.cancel_document_offer),
            }
        if self.mode is EditorMode.TEXT:
            return {1: menu, **self._text_keys(), **undo, 10: FunctionKey("DISCARD", self.discard_and_leave)}
        return {
            2: FunctionKey("SAVE" if self.mode is EditorMode.NAME else "GO", self._accept_entry),
            10: back,
        }

    def _text_keys(self) -> ModeKeys:
        load_label = find_load_label(self.desk, self.editor, is_dirty=self.text_synchronizer.is_dirty)
        return {
            2: FunctionKey("SAVE", self.save_text),
            3: FunctionKey(load_label, partial(self.save_and_open_page, page_table.AUTOMATIC)),
            4: FunctionKey("FIND", partial(self.enter_mode, EditorMode.FIND)),
            5: FunctionKey("GO TO", partial(self.enter_mode, EditorMode.LINE_NUMBER)),
            6: FunctionKey("YES", self.confirm_question)
            if self.editor.pending_action
            else self.conversion_notice.make_function_key(self.save_and_open_page)
            or FunctionKey("NEXT ERROR", self.select_next_finding),
            7: FunctionKey("HISTORY", partial(self.enter_mode, EditorMode.HISTORY)),
        }

    def enter_mode(self, mode: EditorMode) -> None:
        """Switch the page to a mode and show the areas that belong to it."""
        self.mode = mode
        self._update_question_line()
        self.show_mode()
        if mode is EditorMode.HISTORY:
            self.version_list.raise_()
            self.version_history.open_history(self.editor.name, self.text_synchronizer.read_text())
        if mode is EditorMode.CODES:
            self.code_list.raise_()
        if mode is EditorMode.PANEL:
            self.editor_panel.raise_()
        if mode in {EditorMode.HISTORY, EditorMode.NEW_FILE, EditorMode.CODES, EditorMode.PANEL}:
            self.setFocus()
        elif mode is EditorMode.TEXT:
            self.text_field.setFocus()

    def return_to_text(self) -> None:
        """Move the focus from a question, a list or the path back to the program text."""
        self.editor.cancel_naming()
        if self.mode is EditorMode.PANEL:
            self.text_synchronizer.is_stale = True  # The present proof can belong to the preview of a form.
        self.enter_mode(EditorMode.TEXT)

    def move_cursor_to(self, line: int, column: int = 0) -> None:
        """Move the cursor to a line and column."""
        if self.mode is EditorMode.PATH:
            self.enter_mode(EditorMode.TEXT)
        self.text_field.move_cursor_to(max(1, line), column)
        self.text_field.setFocus()

    def _show_finding(self, found: Diagnostic) -> None:
        """Move the cursor to a finding.

        If the finding concerns the machined part, the picture shows the part as machined after the
        finding's line.
        """
        self.move_cursor_to(found.line, found.column)
        if found.block_number:
            self.path_view.show_part()

    def select_next_finding(self) -> None:
        """Move the cursor to the next finding."""
        found = self.finding_list.find_next_error(self.text_field.cursor_line)
        if found is not None:
            self._show_finding(found)
        else:
            self.editor.message = "NO ERRORS OR WARNINGS FOUND"

    def save_text(self) -> None:
        """Save the text and continue editing."""
        self.editor.save_document(self.text_synchronizer.read_text())

    def save_and_open_page(self, page_name: str) -> None:
        """Save the text and open another page."""
        self._target = page_name
        self.editor.save_and_leave(
            self.text_synchronizer.read_text(), should_load=page_name == page_table.AUTOMATIC
        )

    def discard_and_leave(self) -> None:
        """Close the editor without saving."""
        self._target = page_table.AUTOMATIC
        self.editor.discard_and_leave(self.text_synchronizer.read_text())

    def confirm_question(self) -> None:
        """Confirm the pending question of the editor."""
        self.editor.confirm_question(self.text_synchronizer.read_text())

    def restore_version(self) -> None:
        """Restore the selected version into the editor."""
        if self.version_history.text is not None:
            self.editor.restore_version(self.version_history.text, self.version_history.number)
            self.enter_mode(EditorMode.TEXT)

    def complete_code(self) -> None:
        """Complete the typed code. If nothing is typed, show the code at the cursor in the list of codes."""
        if self.editor.stage is not EditorStage.OPEN or self.mode not in {EditorMode.TEXT, EditorMode.CODES}:
            return
        if self.code_list.open_choices():
            self.enter_mode(EditorMode.CODES)
        else:
            self.editor.message = messages.PROOF_PENDING

    def focus_path(self) -> None:
        """Move the keyboard focus to the tool path for measuring or for finding a source line."""
        if self.path_view.has_path:
            self.enter_mode(EditorMode.PATH)
        else:
            self.editor.message = messages.NO_PATH

    def open_panel(self, key_name: str = "") -> None:
        """Open the panel of an optional feature, which is identified by its key.

        If a panel is already open, return to the text.
        """
        if self.mode is EditorMode.PANEL:
            self.return_to_text()
        elif (
            self.editor.stage is EditorStage.OPEN
            and self.mode is EditorMode.TEXT
            and self.panel_text.open_panel(key_name)
        ):
            self.desk.clear_prompt_line()
            self.enter_mode(EditorMode.PANEL)

    def _make_from_file(self, file: Path) -> None:
        """Open the form for the drawing file from which the edited program was generated."""
        self.editor.source_drawing = None
        self.open_panel()
        if self.mode is EditorMode.PANEL:
            self.editor_panel.model.open_file(file)

    def handle_key(self, key: str) -> bool:
        """Pass a key to the open panel of a feature, and return whether the panel used it."""
        return self.mode is EditorMode.PANEL and self.editor_panel.model.handle_key(key)

    def accepts_key(self, key: str) -> bool:
        """Return whether the open panel of a feature accepts a character as text."""
        return self.mode is EditorMode.PANEL and self.editor_panel.model.accepts_key(key)

    def has_text_field(self) -> bool:
        """Return whether a feature panel is open, because its form accepts letters."""
        return self.mode is EditorMode.PANEL

    def find_marked_help(self) -> Sequence[GuideBlock]:
        """Return the explanation of the codes in the line of the cursor."""
        book = self.editor.live_proof.current_findings.code_book
        return make_code_blocks(book, book.list_codes(self.text_field.cursor_line_text)) if book else ()

    def _jump_to_line(self) -> None:
        """Move the cursor to the program line that produces the path at the crosshair."""
        self.editor.message = self.path_view.jump_to_path_line()

    # --- question line ---------------------------------------------------------------------------------

    def _update_question_line(self) -> None:
        """Show the question of the mode, or hide the question line."""
        show_mode_question(
            self.question_line, self.text_finder, self.mode, self.text_field.cursor_line, self.editor.name
        )

    def _accept_entry(self) -> None:
        """Accept the entry in the question line."""
        entry = self.question_line.first_field.text()
        if self.mode is EditorMode.FIND:
            self.text_finder.select_match(1)
        elif self.mode is EditorMode.NAME:
            self.editor.save_under_name(entry)
        elif (number := evaluate_line_number(entry)) is None or number > self.text_field.blockCount():
            self.question_line.message_text = Message(
                "ENTER A NUMBER FROM 1 TO {count}", count=self.text_field.blockCount()
            )
            self.question_line.first_field.selectAll()  # the next digit replaces the entry
        else:
            self.enter_mode(EditorMode.TEXT)
            self.move_cursor_to(number)

    # --- Qt's calls ----------------------------------------------------------------------------------

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Handle the keys of the question line, and send on-screen keys to the field that has the focus."""
        if event.type() == QEvent.Type.FocusIn and isinstance(watched, QWidget):
            self.letter_pad.set_target_field(watched)
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return self._key(event)
        return False

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Handle a key that no field has used, or else pass it to the main window."""
        if not self._key(event):
            event.ignore()

    def _key(self, event: QKeyEvent) -> bool:
        action = self._find_action(event)
        if action is not None:
            action()
        return action is not None

    def _find_action(self, event: QKeyEvent) -> Callable[[], None] | None:
        """Return the action of a key that is neither text nor a function key, or None if it has no action."""
        key, modifiers = event.key(), event.modifiers()
        if modifiers & Qt.KeyboardModifier.ControlModifier:
            return self._make_chord_actions().get(key)
        if self.mode in ENTRY_MODES:
            before = bool(modifiers & Qt.KeyboardModifier.ShiftModifier) and self.mode is EditorMode.FIND
            enter, tab = (
                partial(self.text_finder.select_match, -1) if before else self._accept_entry,
                self.question_line.focus_other_field,
            )
            asking: KeyActionMap = dict.fromkeys((Qt.Key.Key_Return, Qt.Key.Key_Enter), enter)
            asking |= dict.fromkeys((Qt.Key.Key_Tab, Qt.Key.Key_Backtab), tab)
            return asking.get(key)
        if self.mode is EditorMode.CODES:
            return self.code_list.make_arrow_actions().get(key)
        if self.mode is EditorMode.HISTORY:
            restore: KeyActionMap = dict.fromkeys((Qt.Key.Key_Return, Qt.Key.Key_Enter), self.restore_version)
            return (self.version_list.make_arrow_actions() | restore).get(key)
        return None

    def _make_chord_actions(self) -> KeyActionMap:
        """Return the actions of the key combinations with Ctrl.

        In the path mode, Ctrl with an arrow key pans the path.
        """
        find, chords = partial(self.enter_mode, EditorMode.FIND), dict[int, Callable[[], None]]()
        if self.mode is not EditorMode.HISTORY:
            chords = {
                Qt.Key.Key_S: self.save_text,
                Qt.Key.Key_Space: self.complete_code,
                Qt.Key.Key_F: find,
                Qt.Key.Key_H: find,
                Qt.Key.Key_G: partial(self.enter_mode, EditorMode.LINE_NUMBER),
                Qt.Key.Key_M: self.focus_path,
            }
        if self.mode is EditorMode.PATH:
            chords |= self.path_view.make_pan_actions()
        return chords

    def _handle_closed(self) -> None:
        """Show the last message of the editor and open the requested page after the editor has closed."""
        if self.editor.message:
            self.desk.say(self.editor.message)
            self.editor.clear_message()
        if self.host.open_page(self._target):
            self.conversion_notice.start_conversion(self._target)
