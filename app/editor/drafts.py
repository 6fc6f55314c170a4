"""What is typed and not saved: kept until the editor is left, for a control that ends before that."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.background_work import Latest
from app.editor import editor_messages as messages
from app.editor.document import Document
from app.editor.versions import Archive
from core.file_placing import write_in_place
from core.message import Message
from core.store.store_errors import StoreError

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
