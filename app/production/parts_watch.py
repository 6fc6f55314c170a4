"""What the desk sees of tools and parts in every frame: counts, what is due, what stops parts."""

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
    """What an optional feature has to say of the parts."""

    def bar(self, snapshot: Snapshot) -> str:
        """Why no other part may begin; empty: it may."""

    def due(self) -> str:
        """What the prompt line tells of it; empty: nothing."""


@dataclass(slots=True)
class PartsWatch:
    """``see`` is called once a frame, ``due`` by the prompt line; both know only what is at hand."""

    desk: Desk
    book: PartsBook
    lives: ToolLifeWatch
    _ends: int = -1
    _changes: int = -1
    _store: object = None
    _barred: str | None = None  # as the executor was told
    plans: list[Plan] = field(default_factory=list)  # of optional features

    @property
    def program(self) -> str:
        """The name of the program on the desk."""
        return Path(self.desk.session.now.name).name

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """One frame."""
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
        """The executor is told before the part ends, so that the next one does not begin."""
        tools = loaded.proof.tools if loaded.proof is not None else ()
        bars = (self.lives.bar(snapshot, tools), *(plan.bar(snapshot) for plan in self.plans))
        wanted = next(filter(None, bars), "")
        if wanted not in {snapshot.next_barred, self._barred}:
            self.desk.post(BarNextPart(wanted))
        self._barred = wanted

    def due(self) -> str:
        """What the prompt line tells besides: what to measure, which insert to change; empty: nothing."""
        return join_messages(" · ", filter(None, (*(plan.due() for plan in self.plans), self.lives.due())))

    def refuse(self, why: str) -> None:
        """What was not kept, and why."""
        self.desk.say(tr(Message("NOT SAVED: {why}", why=why)))

    def close(self) -> None:
        """End the worker; what inserts have cut since it was kept last is handed to the store."""
        self.lives.keep_all()
        self.book.close()
