"""Monitor that checks tool life and due measurements, and can prevent the start of the next part."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from app.desk.desk import Desk
from app.desk.programs.program_loading import LoadedProgram
from app.desk.translation import tr
from app.production.parts_book import ProductionRecords
from app.production.tool_life_watch import ToolLifeMonitor
from core.executor.commands import PreventNextPart
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages


class ProductionPlan(Protocol):
    """An optional feature that plans the next parts and can prevent their start."""

    def find_lock_reason(self, snapshot: Snapshot) -> str:
        """Return why the next part must not start, or an empty string."""

    def find_reminder(self) -> str:
        """Return the reminder for the prompt line, or an empty string."""


@dataclass(slots=True)
class ProductionMonitor:
    """Monitor of production, which checks tool life and due measurements and can lock the next part.

    ``observe_frame`` is called once a frame. The prompt line calls ``find_reminder``, which never waits.
    """

    desk: Desk
    production_records: ProductionRecords
    tool_life_monitor: ToolLifeMonitor
    _ends: int = -1
    _changes: int = -1
    _store: object = None
    _barred: str | None = None  # reason that was last sent to the executor
    production_plans: list[ProductionPlan] = field(default_factory=list)  # plans of optional features

    @property
    def program_name(self) -> str:
        """Return the name of the loaded program."""
        return Path(self.desk.program_loader.loaded_program.name).name

    def observe_frame(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Update production data, tool life and the lock of the next part.

        This is called once a frame.
        """
        if snapshot.ends != self._ends or self.desk.offset_book.changes != self._changes:
            self._ends, self._changes = snapshot.ends, self.desk.offset_book.changes
            self.production_records.request_reload()
        self.production_records.update(self.program_name)
        if self.production_records.store is not self._store:
            self._store = self.production_records.store
            self.tool_life_monitor.discard_counts()
        self.tool_life_monitor.process_snapshot(snapshot, self.desk.say)
        self._update_block(snapshot, loaded)

    def _update_block(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Send the executor the reason why the next part must not start.

        The reason is sent before the current part ends. An empty reason permits the next part.
        """
        tools = loaded.proof.tool_numbers if loaded.proof is not None else ()
        bars = (
            self.tool_life_monitor.find_lock_reason(snapshot, tools),
            *(plan.find_lock_reason(snapshot) for plan in self.production_plans),
        )
        wanted = next(filter(None, bars), "")
        if wanted not in {snapshot.next_barred, self._barred}:
            self.desk.post(PreventNextPart(wanted))
        self._barred = wanted

    def find_reminder(self) -> str:
        """Return the due measurements and tool changes for the prompt line, or an empty string."""
        return join_messages(
            " · ",
            filter(
                None,
                (
                    *(plan.find_reminder() for plan in self.production_plans),
                    self.tool_life_monitor.find_reminder(),
                ),
            ),
        )

    def report_refusal(self, reason: str) -> None:
        """Report why data was not stored."""
        self.desk.say(tr(Message("NOT SAVED: {why}", why=reason)))

    def close(self) -> None:
        """Store the remaining tool use, and stop the worker."""
        self.tool_life_monitor.save_all_tool_use()
        self.production_records.close()
