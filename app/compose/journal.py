"""What the run leaves behind: events, part counts and the program versions that ran, in the store."""

from __future__ import annotations

from pathlib import Path

from app.desk.home import home
from app.desk.offsets.book import OffsetBook
from core.executor.snapshot import Event
from core.language.source import Source
from core.store.errors import StoreError
from core.store.rows import VersionRow
from core.store.store import Store


class Journal:
    """Writes by the store's own thread, so that neither executor nor screen ever waits for the disk.

    Without a store (``trouble`` says why) the machine runs all the same, and nothing is kept.
    """

    def __init__(self, folder: Path) -> None:
        self._store: Store | None = None
        self._program = ""
        self._trouble = ""
        try:
            self._store = Store.open(folder)
        except StoreError as error:
            self._trouble = str(error)

    @classmethod
    def at_home(cls) -> Journal:
        """The journal of the product's folder."""
        return cls(home())

    @property
    def trouble(self) -> str:
        """Why nothing is kept, or why the last write failed; empty while all is well."""
        return self._trouble or (self._store.trouble if self._store else "")

    def book(self) -> OffsetBook:
        """The offsets of the store, for the screen to show and to change."""
        if self._store is None:
            return OffsetBook(locked=f"OFFSETS CANNOT BE KEPT: {self.trouble}")
        return OffsetBook(self._store)

    def hear(self, event: Event) -> None:
        """Keep an event; a finished part counts for the program that made it."""
        if event.kind == "load":
            self._program = event.text
        if self._store is None:
            return
        self._store.log_event(event.kind, event.text, event.line)
        if event.kind == "part" and self._program:
            self._store.count_part(Path(self._program).name)

    def keep(self, source: Source) -> None:
        """The text that is about to be proved and run becomes a version of its program."""
        if self._store is not None:
            name = Path(source.name).name
            self._store.save_program(name, source.text.encode("utf-8", "surrogateescape"), "loaded to run")

    def versions(self, name: str) -> tuple[VersionRow, ...]:
        """Every version of a program, newest first. Raises StoreError; not for the screen's thread."""
        return self._opened().versions(name)

    def text_of(self, name: str, version: int) -> bytes:
        """A version as it was kept. Raises StoreError; not for the screen's thread."""
        return self._opened().load_program(name, version)

    def keep_version(self, name: str, text: bytes, why: str) -> int:
        """Another version; its number once it is kept. Raises StoreError; not for the screen's thread."""
        return self._opened().save_program(name, text, why).result()

    def _opened(self) -> Store:
        if self._store is None:
            raise StoreError(self._trouble or "the store is closed")
        return self._store

    def close(self) -> None:
        """Write what is queued and give the store free."""
        if self._store is not None:
            self._store.close()
            self._store = None
