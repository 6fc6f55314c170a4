"""Document in the editor: its file, the functions that save it, and the draft of unsaved text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.programs.program_folder import PROGRAM_EXTENSIONS
from app.editor import editor_messages as messages
from app.editor.version_history import VersionArchive
from app.programs.atomic_files import read_file_if_exists, write_program_file
from core.file_replacement import write_atomically
from core.language.source import SourceError, load_source
from core.message import CodedError, Message
from core.store.program_records import check_new_program_name
from core.store.store_errors import StoreError

MAX_LINES = 2_000_000  # The proof of longer programs needs too much memory.
_CRLF = "\r\n"


class TextTooLongError(CodedError, ValueError):
    """Error for a text that is too long for the editor, with a message for the operator."""


class InvalidProgramNameError(ValueError):
    """Error for an invalid program name, with a message for the operator."""


@dataclass(frozen=True, slots=True)
class Document:
    """Program that is being edited.

    ``text`` has line feeds as line endings, and ``line_ending`` is the line ending of the file.
    ``is_read_only`` marks a sample, which must be saved under another name. ``is_new`` marks a document
    that has no file yet.
    """

    path: Path
    text: str = ""
    line_ending: str = "\n"
    is_read_only: bool = False
    is_new: bool = False

    @property
    def name(self) -> str:
        """Return the file name of the program."""
        return self.path.name

    def encode_text(self, text: str) -> bytes:
        """Return ``text`` as bytes with the line ending that the file uses."""
        text = add_final_newline(text)
        if self.line_ending != "\n":
            text = text.replace("\n", self.line_ending)
        return text.encode("utf-8", "replace")


def add_final_newline(text: str) -> str:
    """Return the text with a line feed at its end, or an empty string for an empty text.

    TurnDesk saves and proves texts in this form.
    """
    return text if text.endswith("\n") or not text else text + "\n"


def open_document(path: Path, samples_folder: Path) -> Document:
    """Open a file as a document.

    Raises SourceError if the file cannot be read or is not a program text, and TextTooLongError if the text
    is too long.
    """
    text = _read_text(path)
    if text.count("\n") >= MAX_LINES:
        raise TextTooLongError(
            Message(
                "{path} has over {most_lines} lines, too many for this editor; split the file in "
                "another editor",
                path=path.name,
                most_lines=MAX_LINES,
            ),
            "too-long",
        )
    line_end = _CRLF if _CRLF in text else "\n"
    protected = path.resolve().is_relative_to(samples_folder.resolve())
    return Document(path, text.replace(_CRLF, "\n").replace("\r", "\n"), line_end, protected)


def _read_text(path: Path) -> str:
    """Return the text of a file, or an empty string for an empty file."""
    try:
        return load_source(path).text
    except SourceError as error:
        if error.diagnostic.code == "file-empty":
            return ""
        raise


def create_document(folder: Path, typed_name: str, default_extension: str) -> Document:
    """Return a new, empty document for a typed name.

    Raises InvalidProgramNameError if the name is not valid.
    """
    return Document(folder / make_program_name(typed_name, default_extension), is_new=True)


def make_program_name(typed_name: str, default_extension: str) -> str:
    """Return the file name for a typed name.

    A name without an extension gets ``default_extension``. Raises InvalidProgramNameError if the name is not
    valid.
    """
    name = typed_name.strip()
    if not name:
        raise InvalidProgramNameError("ENTER A PROGRAM NAME")
    if name.startswith("."):
        raise InvalidProgramNameError(
            Message("{name} WOULD BE A HIDDEN FILE. START WITH A LETTER OR DIGIT", name=name)
        )
    try:
        check_new_program_name(name)
    except StoreError as error:
        raise InvalidProgramNameError(
            Message("{name}: INVALID NAME. USE LETTERS, DIGITS, DOT, DASH, SPACE", name=name)
        ) from error
    ending = Path(name).suffix
    if ending.lower() not in PROGRAM_EXTENSIONS:
        allowed = " ".join(sorted(PROGRAM_EXTENSIONS - {""}))
        raise InvalidProgramNameError(
            Message(
                "EXTENSION {ending} IS NOT ALLOWED. USE ONE OF {allowed} OR NONE",
                ending=ending,
                allowed=allowed,
            )
        )
    return name if ending else name + default_extension


# --- saving: the file first, then the version; the previous content is archived too ------------------------


CHANGED_EXTERNALLY = "changed by another program"


def save_document(document: Document, text: str, archive: VersionArchive, may_overwrite: bool) -> str:
    """Write ``text`` to the file of ``document`` and archive it as a version.

    Returns an empty string on success, or the reason why no version was archived. If another program has
    changed the file, it is overwritten only if ``may_overwrite`` is true and its changed content can be
    archived. Otherwise nothing is written and the result is ``CHANGED_EXTERNALLY``. Raises
    FileOperationError if the file cannot be read or written.
    """
    there = read_file_if_exists(document.path)
    foreign = there is not None and not _matches_opened(document, there)
    if foreign and not may_overwrite:
        return CHANGED_EXTERNALLY
    archive_error = ""
    if there is not None:
        archive_error = _kept(archive, document.name, there, "text before editing")
        if archive_error and foreign:
            return CHANGED_EXTERNALLY  # Content from another program is not replaced before it is archived.
    data = document.encode_text(text)
    write_program_file(document.path, data)
    return _kept(archive, document.name, data, "saved in the editor") or archive_error


def _matches_opened(document: Document, data: bytes) -> bool:
    """Return whether the file data are equal to the text that was opened or last saved."""
    if document.is_new:
        return False
    return data == document.encode_text(document.text) or _matches_text(document, data)


def _matches_text(document: Document, data: bytes) -> bool:
    """Return whether a file written under DOS decodes to the text of the document.

    Such a file can have another character set, a byte order mark or an end-of-file character.
    """
    for code in ("utf-8-sig", "cp437", "latin-1"):
        try:
            text = data.decode(code)
        except UnicodeDecodeError:
            continue
        if text.rstrip("\x1a").replace("\r\n", "\n").replace("\r", "\n") == document.text:
            return True
    return False


def _kept(archive: VersionArchive, name: str, data: bytes, why: str) -> str:
    try:
        archive.save_version(name, data, why)
    except StoreError as error:
        return str(error)
    return ""


WHY = "unsaved draft"


@dataclass(slots=True)
class DraftStore:
    """Store of draft files, one for each document with unsaved text.

    A worker writes the latest text of each document.
    """

    folder: Path
    archive: VersionArchive
    error_text: str = ""  # reason why the last draft was not written
    _wanted: dict[str, str | None] = field(default_factory=dict)  # None: the draft is obsolete
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-drafts"))

    def set_text(self, document: Document, text: str) -> None:
        """Store the current text of the editor as the draft of the document."""
        self._wanted[document.name] = None if text == document.text else text
        self._go_on()

    def delete_draft(self, document: Document) -> None:
        """Delete the draft of a document whose text was saved or discarded."""
        self._wanted[document.name] = None
        self._go_on()

    def recover_draft(self, document: Document, show_message: Callable[[str], None]) -> None:
        """Archive a draft from an earlier session as a version, so that a new draft cannot overwrite it.

        ``show_message`` is called with the result for the operator.
        """
        self.worker.enqueue_work(lambda: self._recovered(document), show_message, show_message)

    def _recovered(self, document: Document) -> str:
        place = self._place(document.name)
        try:
            text = place.read_text("utf-8")
            if text == document.text:
                place.unlink(missing_ok=True)
                return ""
            if self.archive.save_version(document.name, document.encode_text(text), WHY):
                place.unlink(missing_ok=True)
                return messages.DRAFT_IN_HISTORY
            why = messages.HISTORY_UNAVAILABLE
        except (FileNotFoundError, NotADirectoryError):
            return ""  # No draft was left.
        except (OSError, UnicodeDecodeError, StoreError) as error:
            why = str(error)
        aside = place.replace(place.with_suffix(".left"))  # The present text gets a separate draft file.
        return Message(messages.DRAFT_NOT_ARCHIVED, name=aside, why=why)

    def poll(self) -> None:
        """Process completed writes and start the next write.

        This method is called once per frame.
        """
        self.worker.deliver_results()
        self._go_on()

    def close(self) -> None:
        """Write the pending drafts and stop the worker."""
        self.worker.close()
        for name in list(self._wanted):
            self._write_draft(name, self._wanted.pop(name))

    def _go_on(self) -> None:
        if self.worker.is_busy or not self._wanted:
            return
        name, text = next(iter(self._wanted.items()))
        del self._wanted[name]
        self.worker.enqueue_work(lambda: self._write_draft(name, text), self._written, self._written)

    def _written(self, error_text: str) -> None:
        self.error_text = error_text
        self._go_on()

    def _write_draft(self, name: str, text: str | None) -> str:
        """Write or delete a draft file atomically.

        Returns an error message, or an empty string on success.
        """
        place = self._place(name)
        try:
            if text is None:
                place.unlink(missing_ok=True)
                return ""
            write_atomically(place, text.encode("utf-8", "replace"))
        except OSError as error:
            return messages.DRAFT_NOT_SAVED.format(error.strerror)
        return ""

    def _place(self, name: str) -> Path:
        return self.folder / f"{name}.draft"
