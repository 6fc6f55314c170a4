"""Model of the editor, which opens, creates, saves and closes programs. It does not use Qt.

No method blocks. A request of the operator starts background work, and ``EditorModel.poll`` processes its
result once per frame. The page owns the text and passes it with each request.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import partial
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.page_entry import find_editor_refusal
from app.desk.programs.program_loading import LoadedProgram, LoadingSteps
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.editor import editor_messages as messages
from app.editor.edited_document import (
    CHANGED_EXTERNALLY,
    Document,
    DraftStore,
    InvalidProgramNameError,
    add_final_newline,
    create_document,
    open_document,
    save_document,
)
from app.editor.live_proof import LiveProof
from app.editor.version_history import VersionArchive
from core.message import Message


class EditorStage(StrEnum):
    """Stage of the editor's work on a document."""

    CLOSED = "closed"
    OFFERED = "offered"  # a new file: F1 creates it, Esc cancels
    READING = "reading"
    OPEN = "open"
    NAMING = "naming"  # saving waits for a name
    SAVING = "saving"


@dataclass(frozen=True, slots=True)
class ClosedProgram:
    """Program that was closed in the editor.

    ``is_changed`` means that changes to the program were saved. ``should_load`` means that TurnDesk must
    load the program.
    """

    path: Path
    is_changed: bool
    should_load: bool
    text: str = ""


@dataclass(slots=True)
class EditorModel:
    """Model of an editor for one document at a time.

    ``on_closed`` is called with each closed program. ``loading_steps`` prove a text without storing
    anything. ``programs_folder`` is the program folder of the operator.
    """

    loading_steps: LoadingSteps
    version_archive: VersionArchive
    programs_folder: Path
    samples_folder: Path
    on_closed: Callable[[ClosedProgram], None] = field(default=lambda _: None)
    find_save_refusal: Callable[[], str] = str  # reason why the access level does not permit saving, or empty
    stage: EditorStage = EditorStage.CLOSED
    document: Document | None = None
    message: str = ""
    loaded_text_count: int = (
        0  # counts the texts that the model puts into the field: opened, created or restored
    )
    text: str = ""  # the last of these texts
    pending_name: str = ""  # name typed on another page, for which the editor is opened
    source_drawing: Path | None = (
        None  # file from which an optional feature generates the text of this program
    )
    closed_program: ClosedProgram | None = None  # the last program that was closed without discarding it
    is_replacement_undoable: bool = False  # the text replaces the typed text as one step that can be undone
    is_block_delete_on: bool = False
    default_extension: str = ".nc"  # extension of new programs, from the language of the machine
    live_proof: LiveProof = field(init=False)
    draft_store: DraftStore = field(init=False)
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-files"))
    _offered: str = ""
    _leaving: bool = False
    _to_desk: bool = False
    _changed: bool = False  # saved at least once since it was opened
    pending_action: Callable[[str], None] | None = (
        None  # action of F6; never the action of the key that asked
    )
    _unnamed: str = ""  # text whose saving waits for a name

    def __post_init__(self) -> None:
        self.live_proof = LiveProof(self.loading_steps)
        self.draft_store = DraftStore(self.programs_folder / ".drafts", self.version_archive)

    def poll(self) -> None:
        """Process the results of completed background work.

        This method is called once per frame.
        """
        self.worker.deliver_results()
        self.draft_store.poll()
        if self.draft_store.error_text and not self.message:
            self.message = self.draft_store.error_text

    def close(self) -> None:
        """Stop the workers after pending writes are complete."""
        self.live_proof.close()
        self.worker.close()
        self.draft_store.close()

    # --- opening -------------------------------------------------------------------------------------

    def choose_drawing(self, drawing: Path) -> None:
        """Choose the drawing from which the editor makes a program of the same name when it opens."""
        self.source_drawing, self.pending_name = drawing, f"{drawing.stem}.nc"

    def open_program(self, path: Path, block_delete: bool = False) -> None:
        """Start reading a program into the editor."""
        self.clear_message()
        self.is_block_delete_on = block_delete
        self.stage = EditorStage.READING
        self.worker.enqueue_work(
            lambda: open_document(path, self.samples_folder), self._opened, self._not_opened
        )

    def offer_new_document(self, typed_name: str) -> None:
        """Ask the operator whether to create a new file with the typed name."""
        self.clear_message()
        self.stage, self._offered = EditorStage.OFFERED, typed_name
        self.message = messages.CREATE_FILE

    def create_document(self) -> None:
        """Create the new document that the editor offered to create (F1)."""
        if self.stage is not EditorStage.OFFERED:
            return
        try:
            document = create_document(self.programs_folder, self._offered, self.default_extension)
        except InvalidProgramNameError as error:
            self.message = Message("{error}. ESC: BACK", error=error)
            return
        if document.path.exists():
            self.message = messages.NAME_EXISTS.format(document.name)
            return
        self.clear_message()
        self._opened(document)

    def cancel_document_offer(self) -> None:
        """Withdraw the offer to create a new document (Esc)."""
        if self.stage is EditorStage.OFFERED:
            self.clear_message()
            self._shut()

    def _opened(self, document: Document) -> None:
        self.document, self.stage, self._changed = document, EditorStage.OPEN, False
        self.closed_program = None
        self.live_proof.clear_findings()
        self._put(document.text)
        self.draft_store.recover_draft(document, self._recovered)

    def _recovered(self, said: str) -> None:
        self.message = said or self.message

    def _not_opened(self, why: str) -> None:
        self._shut()
        self.message = why

    def _put(self, text: str, *, restored: bool = False) -> None:
        self.text, self.is_replacement_undoable = text, restored
        self.loaded_text_count += 1

    # --- editing -------------------------------------------------------------------------------------

    @property
    def is_saved_since_open(self) -> bool:
        """Return whether the document was saved after it was opened."""
        return self._changed

    @property
    def name(self) -> str:
        """Return the name of the document, or of the new file that the editor offers to create."""
        return self.document.name if self.document else self._offered

    def update_text(self, text: str) -> None:
        """Prove the changed text and store it as a draft."""
        self.live_proof.submit_text(self.name, add_final_newline(text), self.is_block_delete_on)
        if self.document is not None:
            self.draft_store.set_text(self.document, text)

    def preview_text(self, text: str) -> None:
        """Prove a text that a form would produce, without storing it."""
        self.live_proof.submit_text(self.name, add_final_newline(text), self.is_block_delete_on)

    def is_dirty(self, text: str) -> bool:
        """Return whether the text has unsaved changes."""
        document = self.document
        return document is not None and text != document.text

    def restore_version(self, text: str, version_number: int) -> None:
        """Replace the text with the text of an older version. One undo reverses the change."""
        self._put(text, restored=True)
        self.message = messages.VERSION_RESTORED.format(version_number)

    def clear_message(self) -> None:
        """Clear the message and the pending question."""
        self.message, self.pending_action = "", None

    # --- saving and leaving --------------------------------------------------------------------------

    def save_document(self, text: str, *, leave_after: bool = False, may_overwrite: bool = False) -> None:
        """Save the file, archive the version, and close the editor if ``leave_after`` is true.

        ``may_overwrite`` permits overwriting a file that another program has changed.
        """
        document = self.document
        if document is None or self.stage is not EditorStage.OPEN:
            return
        self.clear_message()
        self._leaving = leave_after
        if why := self.find_save_refusal():
            self.message = why
        elif not text or text.isspace():
            self.message = messages.EMPTY_NOT_SAVED
        elif document.is_read_only:
            self.stage, self.message, self._unnamed = EditorStage.NAMING, messages.SAMPLE_READ_ONLY, text
        else:
            self._write(document, text, replacing=may_overwrite)

    def save_under_name(self, typed_name: str) -> bool:
        """Save a sample under the typed name and return whether the name was accepted."""
        document = self.document
        if document is None or self.stage is not EditorStage.NAMING:
            return False
        try:
            path = create_document(
                self.programs_folder, typed_name, document.path.suffix or self.default_extension
            ).path
        except InvalidProgramNameError as error:
            self.message = str(error)
            return False
        if path.exists():
            self.message = messages.NAME_EXISTS.format(path.name)
            return False
        self.clear_message()
        self._write(replace(document, path=path, is_read_only=False, is_new=True), self._unnamed)
        return True

    def cancel_naming(self) -> None:
        """Cancel the name entry and continue editing (Esc)."""
        if self.stage is EditorStage.NAMING:
            self.clear_message()
            self.stage, self._leaving = EditorStage.OPEN, False

    def save_and_leave(self, text: str, *, should_load: bool = False) -> None:
        """Save changes and close the editor.

        An empty new file is discarded. If ``should_load`` is True (F3), the saved program is then loaded.
        Otherwise (F1), the loaded program does not change.
        """
        document, self._to_desk = self.document, should_load
        if document is None or self.stage is not EditorStage.OPEN:
            return
        if document.is_new and not text.strip():
            self._shut()
        elif self.is_dirty(text) or document.is_new:
            self.save_document(text, leave_after=True)
        else:
            self._go(document)

    def discard_and_leave(self, text: str) -> None:
        """Close the editor without saving.

        If the text has unsaved changes, the operator must first confirm that they are discarded.
        """
        if self.stage is not EditorStage.OPEN:
            return
        if self.is_dirty(text):
            self.message, self.pending_action = messages.CONFIRM_DISCARD, lambda _text: self._shut()
            return
        self._shut()

    def confirm_question(self, text: str) -> None:
        """Confirm the pending question (F6)."""
        asked = self.pending_action
        self.clear_message()
        if asked is not None and self.stage is EditorStage.OPEN:
            asked(text)

    def _write(self, document: Document, text: str, *, replacing: bool = False) -> None:
        self.stage = EditorStage.SAVING
        self.worker.enqueue_work(
            lambda: save_document(document, text, self.version_archive, replacing),
            lambda problem: self._saved(document, text, problem),
            self._not_saved,
        )

    def _saved(self, document: Document, text: str, problem: str) -> None:
        if problem == CHANGED_EXTERNALLY:
            leave = self._leaving
            self._not_saved(messages.CHANGED_ON_DISK.format(document.name))
            self.pending_action = lambda now: self.save_document(now, leave_after=leave, may_overwrite=True)
            return
        # Both the old and the new name of a sample have a draft.
        for each in (document, self.document or document):
            self.draft_store.delete_draft(each)
        self.document, self.stage = replace(document, text=text, is_new=False), EditorStage.OPEN
        self._changed = True
        self.message = messages.VERSION_NOT_SAVED.format(problem) if problem else ""
        if self._leaving:
            self._go(self.document)
        elif not problem:
            self.message = Message("{document} SAVED", document=document.name)

    def _not_saved(self, why: str) -> None:
        self.stage, self.message, self._leaving = EditorStage.OPEN, why, False

    def _go(self, document: Document) -> None:
        self._shut()
        text = add_final_newline(document.text)
        self.closed_program = ClosedProgram(document.path, self._changed, self._to_desk, text)
        self.on_closed(self.closed_program)

    def _shut(self) -> None:
        if self.document is not None:
            self.draft_store.delete_draft(self.document)
        self.stage, self.document, self._leaving = EditorStage.CLOSED, None, False
        self._offered = ""
        self.pending_action = None


# --- opening and closing in the context of the machine ----------------------------------------------------
def open_editor(desk: Desk, editor: EditorModel) -> bool:
    """Open the editor with the program whose name was typed, or else with the loaded program.

    For an unknown name, the editor offers to create a new file. If the editor cannot open, the function
    returns False and the prompt line shows the reason.
    """
    name, now = editor.pending_name.strip(), desk.program_loader.loaded_program
    editor.pending_name = ""
    path = desk.program_choice.program_folders.find_path(name) if name else now.path
    if why := find_editor_refusal(desk.read_snapshot(), has_name=bool(name or path)):
        desk.say(why)
        return False
    desk.clear_prompt_line()
    editor.on_closed = partial(_handle_closed, desk)
    if path is None:
        editor.offer_new_document(name)
    else:
        editor.open_program(path, now.is_block_delete_on)
    return True


def find_load_label(desk: Desk, editor: EditorModel, *, is_dirty: bool) -> str:
    """Return the label of F3, which is SAV+LOAD, LOAD or LEAVE depending on its current function."""
    if is_dirty:
        return "SAV+LOAD"
    document, now = editor.document, desk.program_loader.loaded_program
    other = (
        document is not None and document.path == now.path and desk.storage_state.describe_file_difference()
    )
    return "LOAD" if editor.is_saved_since_open or other or now.path is None else "LEAVE"


def _handle_closed(desk: Desk, closed: ClosedProgram) -> None:
    """Load the closed program if F3 requested it. Otherwise, report which program is still loaded."""
    path, now = closed.path, desk.program_loader.loaded_program
    if closed.is_changed:
        desk.storage_state.recheck_file()
    if not closed.should_load:
        if closed.is_changed or path != now.path:
            desk.show_success(tr(Message(_stays(closed, now), name=path.name, other=now.name)))
    elif not _should_load(closed, now):
        if path != now.path:
            desk.show_success(tr(Message(messages.NOT_CHANGED, name=path.name, other=now.name)))
    elif desk.read_snapshot().state in ACTIVE_STATES:
        desk.say(
            tr(messages.RELOAD_AFTER_RUN)
        )  # A cycle was started at the operator station in the meantime.
    elif path == now.path:
        desk.program_loader.start_loading(path, now.is_block_delete_on)
    else:
        desk.program_choice.load_path(path)


def _stays(left: ClosedProgram, now: LoadedProgram) -> str:
    if now.path is None:
        return messages.SAVED_LOAD_HINT
    if not left.is_changed:
        return messages.NOT_CHANGED
    return messages.SAVED_NOT_LOADED if left.path == now.path else messages.SAVED_ONLY


def _should_load(closed: ClosedProgram, loaded: LoadedProgram) -> bool:
    """Return whether F3 loads the closed program.

    F3 loads a program that was changed, and reloads the loaded program if its text has changed. A program
    that was only viewed never replaces another loaded program.
    """
    if closed.is_changed or loaded.path is None:
        return True
    return closed.path == loaded.path and not _is_loaded(closed.text, loaded)


def _is_loaded(text: str, current: LoadedProgram) -> bool:
    """Return whether the loaded program has this text, ignoring different line endings."""
    if current.source is None:
        return False
    loaded = current.source.text.replace("\r\n", "\n").replace("\r", "\n")
    return add_final_newline(loaded) == text
