"""Watch of tools and parts, updated each frame: tool life, due measurements and blocked parts."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from app.desk.desk import Desk
from app.desk.programs.program_loading import Loaded
from app.desk.translation import tr
from app.production.parts_book import PartsBook
from app.production.tool_life_watch import ToolLifeWatch
from core.executor.commands import BarNextPart
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages


class Plan(Protocol):
    """Plan of an optional feature for the next parts."""

    def bar(self, snapshot: Snapshot) -> str:
        """Return the reason why the next part must not start, or an empty string."""

    def due(self) -> str:
        """Return the text for the prompt line, or an empty string."""


@dataclass(slots=True)
class PartsWatch:
    """Watch of production.

    ``see`` is called once per frame, and ``due`` by the prompt line, without waiting.
    """

    desk: Desk
    book: PartsBook
    lives: ToolLifeWatch
    _ends: int = -1
    _changes: int = -1
    _store: object = None
    _barred: str | None = None  # reason that was last sent to the executor
    plans: list[Plan] = field(default_factory=list)  # plans of optional features

    @property
    def program(self) -> str:
        """Name of the loaded program."""
        return Path(self.desk.session.now.name).name

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Update production data, tool life and the lock of the next part. Called once per frame."""
        if snapshot.ends != self._ends or self.desk.book.changes != self._changes:
            self._ends, self._changes = snapshot.ends, self.desk.book.changes
            self.book.refresh()
        self.book.look(self.program)
        if self.book.store is not self._store:
            self._store = self.book.store
            self.lives.forget()
        self.lives.see(snapshot, self.desk.say)
        self._bar(snapshot, loaded)

    def _bar(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Send the lock reason to the executor before the part ends, so that the next part does not start."""
        tools = loaded.proof.tools if loaded.proof is not None else ()
        bars = (self.lives.bar(snapshot, tools), *(plan.bar(snapshot) for plan in self.plans))
        wanted = next(filter(None, bars), "")
        if wanted not in {snapshot.next_barred, self._barred}:
            self.desk.post(BarNextPart(wanted))
        self._barred = wanted

    def due(self) -> str:
        """Return the due measurements and tool changes for the prompt line, or an empty string."""
        return join_messages(" · ", filter(None, (*(plan.due() for plan in self.plans), self.lives.due())))

    def refuse(self, why: str) -> None:
        """Report the reason why data was not stored."""
        self.desk.say(tr(Message("NOT SAVED: {why}", why=why)))

    def close(self) -> None:
        """Store the remaining tool use and stop the worker."""
        self.lives.keep_all()
        self.book.close()
