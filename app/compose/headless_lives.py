"""Tool life in a run without a screen: counted and told as on the desk, and no part with a spent insert."""

from __future__ import annotations

from collections.abc import Callable

from app.compose.journal import Journal
from app.production.parts_book import PartsBook, production
from app.production.tool_life_watch import ToolLifeWatch
from core.executor.commands import BarNextPart, Command
from core.executor.job import Proof
from core.executor.snapshot import Snapshot
from core.message import Message
from core.store.store_errors import StoreError
from core.store.store_rows import Kind


class HeadlessLives:
    """``see`` is called at every step of a run. Without a store nothing is counted, and that is said."""

    def __init__(
        self,
        journal: Journal,
        post: Callable[[Command], None],
        say: Callable[[str], None],
        tools: Kind = Kind.TOOL,
    ) -> None:
        self._book = journal.parts_book(tools)
        self._watch = ToolLifeWatch(self._book)
        self._post, self._say = post, say
        self._barred = ""
        try:
            self._read(self._book)
        except StoreError as error:
            say(Message("tool life is not counted: {error}", error=error))

    def _read(self, book: PartsBook) -> None:
        if book.store is None:
            raise StoreError(book.locked)
        book.now = production(book.store, "", book.tools, {})
        book.loads = 1

    def see(self, snapshot: Snapshot, proof: Proof) -> None:
        """Count what was cut, tell what is due, and bar the next part."""
        if not self._book.loads:
            return
        self._watch.see(snapshot, self._say)
        wanted = self._watch.bar(snapshot, proof.tools)
        if wanted != self._barred:
            self._post(BarNextPart(wanted))
        self._barred = wanted

    def close(self) -> None:
        """Hand the store what was counted since it was kept last."""
        self._watch.keep_all()
        self._book.close()
