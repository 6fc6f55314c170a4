"""The editor: opening, creating, saving and leaving, with every version kept. No Qt, never waits.

What the operator asks for begins at once and ends in a later ``poll``, once a frame; the text itself lies in
the text field of the page, which hands it over with each request.
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
    """What the editor is doing with its document."""

    CLOSED = "closed"
    OFFERED = "offered"  # a new file: F1 creates it, Esc aborts
    READING = "reading"
    OPEN = "open"
    NAMING = "naming"  # saving waits for a name
    SAVING = "saving"


@dataclass(frozen=True, slots=True)
class LeftProgram:
    """Which program was left, whether it was saved meanwhile with changes, and whether it is to be run."""

    path: Path
    changed: bool
    to_desk: bool
    text: str = ""


@dataclass(slots=True)
class Editor:
    """One document at a time. ``left`` hears of the program that was left in good order.

    ``steps`` prove without keeping anything, ``programs`` is the operator's own folder.
    """

    steps: LoadingSteps
    archive: Archive
    programs: Path
    samples: Path
    left: Callable[[LeftProgram], None] = field(default=lambda _: None)
    may_save: Callable[[], str] = str  # why the level in force does not; empty when it may
    stage: Stage = Stage.CLOSED
    document: Document | None = None
    notice: str = ""
    text_number: int = 0  # counts texts put into the field from here: opened, created, restored
    text: str = ""  # the last of them
    wanted: str = ""  # a name typed where a program is chosen: it is what the editor is entered for
    made_of: Path | None = None  # a file of which an optional feature makes the text of this program
    restored: bool = False  # it takes the place of what was typed, as one step that can be undone
    block_delete: bool = False
    usual_ending: str = ".nc"  # of a new program: that of the language that this machine is typed in
    proof: LiveProof = field(init=False)
    drafts: Drafts = field(init=False)
    worker: Latest = field(default_factory=lambda: Latest("editing-files"))
    _offered: str = ""
    _leaving: bool = False
    _to_desk: bool = False
    _changed: bool = False  # something of it was saved since it was opened
    asked: Callable[[str], None] | None = None  # what F6 does now: never what the key does that asked
    _unnamed: str = ""  # text whose saving waits for a name

    def __post_init__(self) -> None:
        self.proof = LiveProof(self.steps)
        self.drafts = Drafts(self.programs / ".drafts", self.archive)

    def poll(self) -> None:
        """Once a frame: take up what the worker has finished."""
        self.worker.poll()
        self.drafts.poll()
        if self.drafts.trouble and not self.notice:
            self.notice = self.drafts.trouble

    def close(self) -> None:
        """End the editor's workers; what is being written is written to its end."""
        self.proof.close()
        self.worker.close()
        self.drafts.close()

    # --- coming in -----------------------------------------------------------------------------------

    def open(self, path: Path, block_delete: bool = False) -> None:
        """Read a program into the editor."""
        self.clear()
        self.block_delete = block_delete
        self.stage = Stage.READING
        self.worker.queue(lambda: open_document(path, self.samples), self._opened, self._not_opened)

    def offer(self, typed: str) -> None:
        """A name that no program has: ask whether it shall be a new one."""
        self.clear()
        self.stage, self._offered = Stage.OFFERED, typed
        self.notice = messages.CREATE

    def create(self) -> None:
        """F1: the name that was offered becomes a new, empty document."""
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
        """Esc: back to where one came from."""
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

    # --- writing -------------------------------------------------------------------------------------

    @property
    def was_saved(self) -> bool:
        """Whether something was saved since the document was opened."""
        return self._changed

    @property
    def name(self) -> str:
        """What is edited, or offered as a new file."""
        return self.document.name if self.document else self._offered

    def changed(self, text: str) -> None:
        """This is in the field now: have it proved."""
        self.proof.submit(self.name, with_last_line_ended(text), self.block_delete)
        if self.document is not None:
            self.drafts.look(self.document, text)

    def preview(self, text: str) -> None:
        """Have proved what a form would make of the text; nothing of it is kept."""
        self.proof.submit(self.name, with_last_line_ended(text), self.block_delete)

    def is_dirty(self, text: str) -> bool:
        """Whether leaving now would have something to save."""
        document = self.document
        return document is not None and text != document.text

    def restore(self, text: str, number: int) -> None:
        """An older version takes the place of the text, as one step that can be undone."""
        self._put(text, restored=True)
        self.notice = messages.RESTORED.format(number)

    def clear(self) -> None:
        """Take answer and questions back."""
        self.notice, self.asked = "", None

    # --- saving and leaving --------------------------------------------------------------------------

    def save(self, text: str, *, leave: bool = False, replacing: bool = False) -> None:
        """Write the file and keep the version; then, if asked for, leave."""
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
        """The name under which a sample is saved; False when it is refused."""
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
        """Esc at the question for a name: go on editing."""
        if self.stage is Stage.NAMING:
            self.clear()
            self.stage, self._leaving = Stage.OPEN, False

    def leave(self, text: str, *, to_desk: bool = False) -> None:
        """Save what has changed, then go; an untouched new file is forgotten.

        ``to_desk``: it is loaded then (F3); otherwise the loaded program stays as it is (F1).
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
        """Leave without saving; asked when there is something to lose, and done by another key."""
        if self.stage is not Stage.OPEN:
            return
        if self.is_dirty(text):
            self.notice, self.asked = messages.ABANDON, lambda _text: self._shut()
            return
        self._shut()

    def answer(self, text: str) -> None:
        """F6: yes to what is asked of the text that stands in the field."""
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
        for each in (document, self.document or document):  # under its new name, and its old one
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


# --- coming in and going, beside the machine --------------------------------------------------------------
def enter(desk: Desk, editor: Editor) -> bool:
    """Go into the editor: with the program of the name that was typed, or else with that on the desk.

    A name that no program has is offered as a new file. False when it is refused; the desk says why.
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
    """Load the program if it was left by F3 and is not loaded yet; otherwise report what stays loaded."""
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
        desk.say(tr(messages.RELOAD))  # somebody started a cycle at the station meanwhile
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
    """Return whether F3 loads it: it was written or is not what is loaded. Looking never loads another."""
    if left.changed or now.path is None:
        return True
    return left.path == now.path and not _is_loaded(left.text, now)


def _is_loaded(text: str, now: Loaded) -> bool:
    """Return whether the loaded program has this text; line ends do not count."""
    if now.source is None:
        return False
    loaded = now.source.text.replace("\r\n", "\n").replace("\r", "\n")
    return with_last_line_ended(loaded) == text
