"""What the desk sees of measured parts and tools in every frame: counts, what is due, what stops parts."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from app.desk.desk import Desk
from app.desk.program_loading import Loaded
from app.desk.translation import tr
from app.quality import sample_plan
from app.quality.parts_book import PartsBook
from app.quality.tool_life_watch import ToolLifeWatch
from core.executor.commands import BarNextPart
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.store.store_errors import StoreError


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
    _plans: dict[int, dict[str, int]] = field(default_factory=dict)  # by parts made, of ``_planned_of``
    _planned_of: object = None
    _waits: tuple[str, bool] = ("", False)  # whether parts of a program wait for their measuring

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
        wanted = self.lives.bar(snapshot, tools) or self._unmeasured(snapshot)
        if wanted not in {snapshot.next_barred, self._barred}:
            self.desk.post(BarNextPart(wanted))
        self._barred = wanted

    def _unmeasured(self, snapshot: Snapshot) -> str:
        if not self.waits:
            return ""
        made = self.desk.counter.count + (1 if snapshot.counts else 0)
        return sample_plan.bar(self._planned(made))

    def _planned(self, made: int) -> dict[str, int]:
        """What the plan asks for behind so many parts; worked out when something has changed."""
        data = self.book.now
        if made not in self._plans or self._planned_of is not data:
            kept = self._plans if self._planned_of is data else {}
            self._plans, self._planned_of = {**kept, made: sample_plan.due(data, made)}, data
        return self._plans[made]

    @property
    def waits(self) -> bool:
        """Whether parts of this program wait until the sample plan is done."""
        if self._waits[0] != self.program:
            try:
                kept = self.desk.counter.persistence.setting(_key(self.program)) is True
            except StoreError:
                kept = False
            self._waits = self.program, kept
        return self._waits[1]

    def turn_waits(self) -> None:
        """Parts wait for the plan, or go on. Raises StoreError when it is not kept."""
        on = not self.waits
        self._waits = self.program, on
        persistence = self.desk.counter.persistence
        persistence.save_setting(_key(self.program), on or None)
        template = (
            "program {program}: the next part cannot start before the required parts are measured"
            if on
            else "program {program}: the next part can start before the required parts are measured"
        )
        persistence.note_change(Message(template, program=self.program))

    def due(self) -> str:
        """What the prompt line tells besides: what to measure, which insert to change; empty: nothing."""
        plan = sample_plan.notice(self._planned(self.desk.counter.count))
        return join_messages(" · ", filter(None, (plan, self.lives.due())))

    def refuse(self, why: str) -> None:
        """What was not kept, and why."""
        self.desk.say(tr(Message("NOT SAVED: {why}", why=why)))

    def close(self) -> None:
        """End the worker; what inserts have cut since it was kept last is handed to the store."""
        self.lives.keep_all()
        self.book.close()


def _key(program: str) -> str:
    return f"measuring:{program}"
