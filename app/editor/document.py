"""The program that is edited: where it lies, how it is saved, and the draft that is kept until it is."""

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

MOST_LINES = 50_000  # the text field takes .7 s of the screen's time for them
_DOS = "\r\n"


class TooLongError(CodedError, ValueError):
    """A text that the field would hold up the screen with; the sentence says so."""


class NameRefusedError(ValueError):
    """A name that no program can have; the sentence says why."""


@dataclass(frozen=True, slots=True)
class Document:
    """``text`` has bare line feeds, as an editor does; ``line_end`` is what the file has.

    ``protected``: a sample, which may be saved under another name only. ``fresh``: not on the disk yet.
    """

    path: Path
    text: str = ""
    line_end: str = "\n"
    protected: bool = False
    fresh: bool = False

    @property
    def name(self) -> str:
        """What the screen and the store call it."""
        return self.path.name

    def encoded(self, text: str) -> bytes:
        """``text`` as it goes to the disk, with the line ends that the file has."""
        return with_last_line_ended(text).replace("\n", self.line_end).encode("utf-8", "replace")


def with_last_line_ended(text: str) -> str:
    """The text with its last line ended, as it is saved and proved: nobody need press Return for that."""
    return text if text.endswith("\n") or not text else text + "\n"


def open_document(path: Path, samples: Path) -> Document:
    """The document of a file. Raises SourceError when it is no program text, TooLongError when too much."""
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
    """An empty file is no program to run, but one to write."""
    try:
        return load_source(path).text
    except SourceError as error:
        if error.diagnostic.code == "file-empty":
            return ""
        raise


def new_document(folder: Path, typed: str, usual: str) -> Document:
    """A new and empty document of this name. Raises NameRefusedError with a sentence."""
    return Document(folder / program_name(typed, usual), fresh=True)


def program_name(typed: str, usual: str) -> str:
    """The file name that was meant: a name without an ending gets the ``usual`` one."""
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


# --- saving: the file first, then the version; what stood there before is kept too -------------------------


CHANGED = "changed by another program"


def save_document(document: Document, text: str, archive: Archive, replacing: bool) -> str:
    """Write ``text`` into the file of ``document`` and keep it as a version.

    Answers why no version could be kept, empty when all went well, or ``CHANGED`` when the file is not any
    more what was opened (nothing is written then, unless ``replacing``). Raises FileError.
    """
    there = present(document.path)
    foreign = there is not None and not _is_opened(document, there)
    if foreign and not replacing:
        return CHANGED
    trouble = ""
    if there is not None:
        trouble = _kept(archive, document.name, there, "text before editing")
        if trouble and foreign:
            return CHANGED  # what somebody else wrote is not replaced before it is safe
    data = document.encoded(text)
    write_whole(document.path, data)
    return _kept(archive, document.name, data, "saved in the editor") or trouble


def _is_opened(document: Document, data: bytes) -> bool:
    """Whether the file still holds what was opened or last saved."""
    if document.fresh:
        return False
    return data == document.encoded(document.text) or _decodes_to(document, data)


def _decodes_to(document: Document, data: bytes) -> bool:
    """Files from DOS: other characters, a byte order mark, the old sign for the end of a file."""
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
    """A file for each text, written on a worker: the last of what was typed since it last came round."""

    folder: Path
    archive: Archive
    trouble: str = ""  # why the last could not be kept
    _wanted: dict[str, str | None] = field(default_factory=dict)  # None: it is not needed any more
    worker: Latest = field(default_factory=lambda: Latest("editing-drafts"))

    def look(self, document: Document, text: str) -> None:
        """This is in the editor now."""
        self._wanted[document.name] = None if text == document.text else text
        self._go_on()

    def forget(self, document: Document) -> None:
        """Its text is saved or given up: the draft file goes."""
        self._wanted[document.name] = None
        self._go_on()

    def recover(self, document: Document, say: Callable[[str], None]) -> None:
        """A draft that was left for it goes into the history, before anything is written for it now."""
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
            return ""  # none was left
        except (OSError, UnicodeDecodeError, StoreError) as error:
            why = str(error)
        aside = place.replace(place.with_suffix(".left"))  # what is typed now gets its own
        return Message(messages.DRAFT_STAYS, name=aside, why=why)

    def poll(self) -> None:
        """Once a frame: take up what was written, and write what was typed since."""
        self.worker.poll()
        self._go_on()

    def close(self) -> None:
        """Write what is left and end the worker."""
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
        """Whole or not at all; what failed, in words."""
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
