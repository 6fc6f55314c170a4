"""Document of the editor: its file, how it is saved, and the draft that protects unsaved text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.background_work import Latest
from app.desk.programs.program_folder import ENDINGS
from app.editor import editor_messages as messages
from app.editor.versions import Archive
from app.programs.whole_file import present, write_whole
from core.file_placing import write_in_place
from core.language.source import SourceError, load_source
from core.message import CodedError, Message
from core.store.program_records import check_name
from core.store.store_errors import StoreError

MOST_LINES = 50_000  # The text field needs 0.7 s for this number of lines.
_DOS = "\r\n"


class TooLongError(CodedError, ValueError):
    """Error for a text that is too long for the editor, with a message for the operator."""


class NameRefusedError(ValueError):
    """Error for an invalid program name, with a message for the operator."""


@dataclass(frozen=True, slots=True)
class Document:
    """Edited program. ``text`` has line feeds only, and ``line_end`` is the line ending of the file.

    ``protected`` marks a sample, which must be saved under another name. ``fresh`` marks a document that is
    not on the disk yet.
    """

    path: Path
    text: str = ""
    line_end: str = "\n"
    protected: bool = False
    fresh: bool = False

    @property
    def name(self) -> str:
        """File name of the program."""
        return self.path.name

    def encoded(self, text: str) -> bytes:
        """Return ``text`` as the bytes of the file, with the file's line ending."""
        return with_last_line_ended(text).replace("\n", self.line_end).encode("utf-8", "replace")


def with_last_line_ended(text: str) -> str:
    """Return the text with a final line feed, as it is saved and proved."""
    return text if text.endswith("\n") or not text else text + "\n"


def open_document(path: Path, samples: Path) -> Document:
    """Open a file as a document.

    Raises SourceError if the file is not a program text, and TooLongError if the text is too long.
    """
    text = _text(path)
    if text.count("\n") >= MOST_LINES:
        raise TooLongError(
            Message(
                "{path} has over {most_lines} lines, too many for this editor; split the file in "
                "another editor",
                path=path.name,
                most_lines=MOST_LINES,
            ),
            "too-long",
        )
    line_end = _DOS if _DOS in text else "\n"
    protected = path.resolve().is_relative_to(samples.resolve())
    return Document(path, text.replace(_DOS, "\n").replace("\r", "\n"), line_end, protected)


def _text(path: Path) -> str:
    """Return the text of a file. An empty file is permitted."""
    try:
        return load_source(path).text
    except SourceError as error:
        if error.diagnostic.code == "file-empty":
            return ""
        raise


def new_document(folder: Path, typed: str, usual: str) -> Document:
    """Return a new, empty document for a typed name. Raises NameRefusedError."""
    return Document(folder / program_name(typed, usual), fresh=True)


def program_name(typed: str, usual: str) -> str:
    """Return the file name for a typed name, with the ``usual`` extension if the name has none.

    Raises NameRefusedError if the name is not valid.
    """
    name = typed.strip()
    if not name:
        raise NameRefusedError("ENTER A PROGRAM NAME")
    if name.startswith("."):
        raise NameRefusedError(
            Message("{name} WOULD BE A HIDDEN FILE. START WITH A LETTER OR DIGIT", name=name)
        )
    try:
        check_name(name)
    except StoreError as error:
        raise NameRefusedError(
            Message("{name}: INVALID NAME. USE LETTERS, DIGITS, DOT, DASH, SPACE", name=name)
        ) from error
    ending = Path(name).suffix
    if ending.lower() not in ENDINGS:
        allowed = " ".join(sorted(ENDINGS - {""}))
        raise NameRefusedError(
            Message(
                "EXTENSION {ending} IS NOT ALLOWED. USE ONE OF {allowed} OR NONE",
                ending=ending,
                allowed=allowed,
            )
        )
    return name if ending else name + usual


# --- saving: the file first, then the version; the previous content is archived too ------------------------


CHANGED = "changed by another program"


def save_document(document: Document, text: str, archive: Archive, replacing: bool) -> str:
    """Write ``text`` to the file of ``document`` and archive it as a version.

    Returns an empty string, the reason why no version was archived, or ``CHANGED``. ``CHANGED`` means that
    the file differs from the opened text. Nothing is written then, unless ``replacing`` is set. Raises
    FileError.
    """
    there = present(document.path)
    foreign = there is not None and not _is_opened(document, there)
    if foreign and not replacing:
        return CHANGED
    trouble = ""
    if there is not None:
        trouble = _kept(archive, document.name, there, "text before editing")
        if trouble and foreign:
            return CHANGED  # Content from another program is not replaced before it is archived.
    data = document.encoded(text)
    write_whole(document.path, data)
    return _kept(archive, document.name, data, "saved in the editor") or trouble


def _is_opened(document: Document, data: bytes) -> bool:
    """Return whether the file still contains the text that was opened or last saved."""
    if document.fresh:
        return False
    return data == document.encoded(document.text) or _decodes_to(document, data)


def _decodes_to(document: Document, data: bytes) -> bool:
    """Return whether data from DOS decodes to the document's text.

    Such data can have another character set, a byte order mark or an end-of-file character.
    """
    for code in ("utf-8-sig", "cp437", "latin-1"):
        try:
            text = data.decode(code)
        except UnicodeDecodeError:
            continue
        if text.rstrip("\x1a").replace("\r\n", "\n").replace("\r", "\n") == document.text:
            return True
    return False


def _kept(archive: Archive, name: str, data: bytes, why: str) -> str:
    try:
        archive.save_version(name, data, why)
    except StoreError as error:
        return str(error)
    return ""


WHY = "unsaved draft"


@dataclass(slots=True)
class Drafts:
    """Draft files, one per text, written by a worker with the latest unsaved text."""

    folder: Path
    archive: Archive
    trouble: str = ""  # reason why the last draft was not written
    _wanted: dict[str, str | None] = field(default_factory=dict)  # None: the draft is obsolete
    worker: Latest = field(default_factory=lambda: Latest("editing-drafts"))

    def look(self, document: Document, text: str) -> None:
        """Record the present text of the editor as the draft."""
        self._wanted[document.name] = None if text == document.text else text
        self._go_on()

    def forget(self, document: Document) -> None:
        """Delete the draft of a document, because its text was saved or discarded."""
        self._wanted[document.name] = None
        self._go_on()

    def recover(self, document: Document, say: Callable[[str], None]) -> None:
        """Move a leftover draft of the document to the history before a new draft is written.

        ``say`` is called with a message.
        """
        self.worker.queue(lambda: self._recovered(document), say, say)

    def _recovered(self, document: Document) -> str:
        place = self._place(document.name)
        try:
            text = place.read_text("utf-8")
            if text == document.text:
                place.unlink(missing_ok=True)
                return ""
            if self.archive.save_version(document.name, document.encoded(text), WHY):
                place.unlink(missing_ok=True)
                return messages.DRAFT
            why = messages.NO_STORE
        except (FileNotFoundError, NotADirectoryError):
            return ""  # No draft was left.
        except (OSError, UnicodeDecodeError, StoreError) as error:
            why = str(error)
        aside = place.replace(place.with_suffix(".left"))  # The present text gets a separate draft file.
        return Message(messages.DRAFT_STAYS, name=aside, why=why)

    def poll(self) -> None:
        """Process finished writes and start the next; called once per frame."""
        self.worker.poll()
        self._go_on()

    def close(self) -> None:
        """Write the pending drafts and stop the worker."""
        self.worker.close()
        for name in list(self._wanted):
            self._write(name, self._wanted.pop(name))

    def _go_on(self) -> None:
        if self.worker.busy or not self._wanted:
            return
        name, text = next(iter(self._wanted.items()))
        del self._wanted[name]
        self.worker.queue(lambda: self._write(name, text), self._written, self._written)

    def _written(self, trouble: str) -> None:
        self.trouble = trouble
        self._go_on()

    def _write(self, name: str, text: str | None) -> str:
        """Write or delete a draft file atomically, and return an error message or an empty string."""
        place = self._place(name)
        try:
            if text is None:
                place.unlink(missing_ok=True)
                return ""
            write_in_place(place, text.encode("utf-8", "replace"))
        except OSError as error:
            return messages.NO_DRAFT.format(error.strerror)
        return ""

    def _place(self, name: str) -> Path:
        return self.folder / f"{name}.draft"
