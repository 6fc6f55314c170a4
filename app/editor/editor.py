"""Editor model without Qt: opening, creating, saving and leaving programs, with version history.

No method waits. Each request of the operator starts at once and ends in a later ``poll``, which is called
once per frame. The text is in the text field of the page, which passes it with each request.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import partial
from pathlib import Path

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.page_entry import editor_barred
from app.desk.programs.program_loading import Loaded, LoadingSteps
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.editor import editor_messages as messages
from app.editor.document import (
    CHANGED,
    Document,
    Drafts,
    NameRefusedError,
    new_document,
    open_document,
    save_document,
    with_last_line_ended,
)
from app.editor.live_proof import LiveProof
from app.editor.versions import Archive
from core.message import Message


class Stage(StrEnum):
    """State of the editor."""

    CLOSED = "closed"
    OFFERED = "offered"  # a new file: F1 creates it, Esc cancels
    READING = "reading"
    OPEN = "open"
    NAMING = "naming"  # saving waits for a name
    SAVING = "saving"


@dataclass(frozen=True, slots=True)
class LeftProgram:
    """Program that was closed in the editor.

    ``changed`` means that it was saved with changes, and ``to_desk`` that it is to be loaded.
    """

    path: Path
    changed: bool
    to_desk: bool
    text: str = ""


@dataclass(slots=True)
class Editor:
    """Editor of one document at a time. ``left`` is called with the program that was closed.

    ``steps`` prove a text without storing anything, and ``programs`` is the operator's program folder.
    """

    steps: LoadingSteps
    archive: Archive
    programs: Path
    samples: Path
    left: Callable[[LeftProgram], None] = field(default=lambda _: None)
    may_save: Callable[[], str] = str  # reason why the access level does not permit saving, or empty
    stage: Stage = Stage.CLOSED
    document: Document | None = None
    notice: str = ""
    text_number: int = 0  # counts the texts that the model puts into the field: opened, created or restored
    text: str = ""  # the last of these texts
    wanted: str = ""  # name typed on another page, for which the editor is opened
    made_of: Path | None = None  # file from which an optional feature generates the text of this program
    restored: bool = False  # the text replaces the typed text as one step that can be undone
    block_delete: bool = False
    usual_ending: str = ".nc"  # extension of new programs, from the language of the machine
    proof: LiveProof = field(init=False)
    drafts: Drafts = field(init=False)
    worker: Latest = field(default_factory=lambda: Latest("editing-files"))
    _offered: str = ""
    _leaving: bool = False
    _to_desk: bool = False
    _changed: bool = False  # saved at least once since it was opened
    asked: Callable[[str], None] | None = None  # action of F6; never the action of the key that asked
    _unnamed: str = ""  # text whose saving waits for a name

    def __post_init__(self) -> None:
        self.proof = LiveProof(self.steps)
        self.drafts = Drafts(self.programs / ".drafts", self.archive)

    def poll(self) -> None:
        """Process finished work; called once per frame."""
        self.worker.poll()
        self.drafts.poll()
        if self.drafts.trouble and not self.notice:
            self.notice = self.drafts.trouble

    def close(self) -> None:
        """Stop the workers after pending writes are finished."""
        self.proof.close()
        self.worker.close()
        self.drafts.close()

    # --- opening -------------------------------------------------------------------------------------

    def open(self, path: Path, block_delete: bool = False) -> None:
        """Read a program into the editor."""
        self.clear()
        self.block_delete = block_delete
        self.stage = Stage.READING
        self.worker.queue(lambda: open_document(path, self.samples), self._opened, self._not_opened)

    def offer(self, typed: str) -> None:
        """Ask whether to create a new file with this name."""
        self.clear()
        self.stage, self._offered = Stage.OFFERED, typed
        self.notice = messages.CREATE

    def create(self) -> None:
        """Create the offered document (F1)."""
        if self.stage is not Stage.OFFERED:
            return
        try:
            document = new_document(self.programs, self._offered, self.usual_ending)
        except NameRefusedError as error:
            self.notice = Message("{error}. ESC: BACK", error=error)
            return
        if document.path.exists():
            self.notice = messages.THERE_ALREADY.format(document.name)
            return
        self.clear()
        self._opened(document)

    def abort(self) -> None:
        """Cancel the offer of a new document (Esc)."""
        if self.stage is Stage.OFFERED:
            self.clear()
            self._shut()

    def _opened(self, document: Document) -> None:
        self.document, self.stage, self._changed = document, Stage.OPEN, False
        self.proof.forget()
        self._put(document.text)
        self.drafts.recover(document, self._recovered)

    def _recovered(self, said: str) -> None:
        self.notice = said or self.notice

    def _not_opened(self, why: str) -> None:
        self._shut()
        self.notice = why

    def _put(self, text: str, *, restored: bool = False) -> None:
        self.text, self.restored = text, restored
        self.text_number += 1

    # --- editing -------------------------------------------------------------------------------------

    @property
    def was_saved(self) -> bool:
        """Whether the document was saved since it was opened."""
        return self._changed

    @property
    def name(self) -> str:
        """Name of the document or of the offered new file."""
        return self.document.name if self.document else self._offered

    def changed(self, text: str) -> None:
        """Prove the changed text and store it as a draft."""
        self.proof.submit(self.name, with_last_line_ended(text), self.block_delete)
        if self.document is not None:
            self.drafts.look(self.document, text)

    def preview(self, text: str) -> None:
        """Prove the text that a form would produce, without storing it."""
        self.proof.submit(self.name, with_last_line_ended(text), self.block_delete)

    def is_dirty(self, text: str) -> bool:
        """Return whether the text has unsaved changes."""
        document = self.document
        return document is not None and text != document.text

    def restore(self, text: str, number: int) -> None:
        """Replace the text with an older version, as one step that can be undone."""
        self._put(text, restored=True)
        self.notice = messages.RESTORED.format(number)

    def clear(self) -> None:
        """Clear the message and the pending question."""
        self.notice, self.asked = "", None

    # --- saving and leaving --------------------------------------------------------------------------

    def save(self, text: str, *, leave: bool = False, replacing: bool = False) -> None:
        """Save the file and archive the version, then leave if requested."""
        document = self.document
        if document is None or self.stage is not Stage.OPEN:
            return
        self.clear()
        self._leaving = leave
        if why := self.may_save():
            self.notice = why
        elif not text.strip():
            self.notice = messages.EMPTY
        elif document.protected:
            self.stage, self.notice, self._unnamed = Stage.NAMING, messages.SAMPLE, text
        else:
            self._write(document, text, replacing=replacing)

    def take_name(self, typed: str) -> bool:
        """Save a sample under the typed name. Return False if the name is rejected."""
        document = self.document
        if document is None or self.stage is not Stage.NAMING:
            return False
        try:
            path = new_document(self.programs, typed, document.path.suffix or self.usual_ending).path
        except NameRefusedError as error:
            self.notice = str(error)
            return False
        if path.exists():
            self.notice = messages.THERE_ALREADY.format(path.name)
            return False
        self.clear()
        self._write(replace(document, path=path, protected=False, fresh=True), self._unnamed)
        return True

    def keep_no_name(self) -> None:
        """Cancel the name entry and continue editing (Esc)."""
        if self.stage is Stage.NAMING:
            self.clear()
            self.stage, self._leaving = Stage.OPEN, False

    def leave(self, text: str, *, to_desk: bool = False) -> None:
        """Save changes and leave the editor. An empty new file is discarded.

        If ``to_desk`` is set, the program is loaded (F3). Otherwise the loaded program remains (F1).
        """
        document, self._to_desk = self.document, to_desk
        if document is None or self.stage is not Stage.OPEN:
            return
        if document.fresh and not text.strip():
            self._shut()
        elif self.is_dirty(text) or document.fresh:
            self.save(text, leave=True)
        else:
            self._go(document)

    def abandon(self, text: str) -> None:
        """Leave without saving. Unsaved changes require confirmation with another key."""
        if self.stage is not Stage.OPEN:
            return
        if self.is_dirty(text):
            self.notice, self.asked = messages.ABANDON, lambda _text: self._shut()
            return
        self._shut()

    def answer(self, text: str) -> None:
        """Confirm the pending question (F6)."""
        asked = self.asked
        self.clear()
        if asked is not None and self.stage is Stage.OPEN:
            asked(text)

    def _write(self, document: Document, text: str, *, replacing: bool = False) -> None:
        self.stage = Stage.SAVING
        self.worker.queue(
            lambda: save_document(document, text, self.archive, replacing),
            lambda trouble: self._saved(document, text, trouble),
            self._not_saved,
        )

    def _saved(self, document: Document, text: str, trouble: str) -> None:
        if trouble == CHANGED:
            leave = self._leaving
            self._not_saved(messages.CHANGED_OUTSIDE.format(document.name))
            self.asked = lambda now: self.save(now, leave=leave, replacing=True)
            return
        # Both the old and the new name of a sample have a draft.
        for each in (document, self.document or document):
            self.drafts.forget(each)
        self.document, self.stage = replace(document, text=text, fresh=False), Stage.OPEN
        self._changed = True
        self.notice = messages.NOT_KEPT.format(trouble) if trouble else ""
        if self._leaving:
            self._go(self.document)
        elif not trouble:
            self.notice = Message("{document} SAVED", document=document.name)

    def _not_saved(self, why: str) -> None:
        self.stage, self.notice, self._leaving = Stage.OPEN, why, False

    def _go(self, document: Document) -> None:
        self._shut()
        text = with_last_line_ended(document.text)
        self.left(LeftProgram(document.path, self._changed, self._to_desk, text))

    def _shut(self) -> None:
        if self.document is not None:
            self.drafts.forget(self.document)
        self.stage, self.document, self._leaving = Stage.CLOSED, None, False
        self._offered = ""
        self.asked = None


# --- opening and closing in the context of the machine ----------------------------------------------------
def enter(desk: Desk, editor: Editor) -> bool:
    """Open the editor with the program whose name was typed, or else with the loaded program.

    An unknown name is offered as a new file. Returns False if the editor cannot be opened. TurnDesk shows the
    reason.
    """
    name, now = editor.wanted.strip(), desk.session.now
    editor.wanted = ""
    path = desk.programs.folders.find(name) if name else now.path
    if why := editor_barred(desk.snapshot(), named=bool(name or path)):
        desk.say(why)
        return False
    desk.clear()
    editor.left = partial(_take_up, desk)
    if path is None:
        editor.offer(name)
    else:
        editor.open(path, now.block_delete)
    return True


def _take_up(desk: Desk, left: LeftProgram) -> None:
    """Load the closed program if F3 requires it.

    Otherwise report which program remains loaded.
    """
    path, now = left.path, desk.session.now
    if left.changed:
        desk.storage.recheck_file()
    if not left.to_desk:
        if left.changed or path != now.path:
            desk.done(tr(Message(_stays(left, now), name=path.name, other=now.name)))
    elif not _is_to_load(left, now):
        if path != now.path:
            desk.done(tr(Message(messages.LOOKED, name=path.name, other=now.name)))
    elif desk.snapshot().state in UNDER_WAY:
        desk.say(tr(messages.RELOAD))  # A cycle was started at the operator station in the meantime.
    elif path == now.path:
        desk.session.load(path, now.block_delete)
    else:
        desk.programs.load(path)


def _stays(left: LeftProgram, now: Loaded) -> str:
    if now.path is None:
        return messages.SAVED_NONE
    if not left.changed:
        return messages.LOOKED
    return messages.SAVED_SAME if left.path == now.path else messages.SAVED_ONLY


def _is_to_load(left: LeftProgram, now: Loaded) -> bool:
    """Return whether F3 loads the program: it was changed, or the loaded program has another text.

    Viewing a program never replaces another loaded program.
    """
    if left.changed or now.path is None:
        return True
    return left.path == now.path and not _is_loaded(left.text, now)


def _is_loaded(text: str, now: Loaded) -> bool:
    """Return whether the loaded program has this text, ignoring line endings."""
    if now.source is None:
        return False
    loaded = now.source.text.replace("\r\n", "\n").replace("\r", "\n")
    return with_last_line_ended(loaded) == text
