"""Persistence, as far as the screen asks for it: what is kept from day to day; and where nothing is kept."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from core.store.backup import Verdict
from core.store.people import People
from core.store.store_errors import StoreError
from core.store.store_rows import EventRow, RunRow

if TYPE_CHECKING:
    from core.store.production.run_records import RunRecords
    from core.store.store import Store

NOTHING_KEPT = "no data is being saved; start turndesk with a writable folder (TURNDESK_HOME)"


@dataclass(frozen=True, slots=True)
class NoRunRecords:
    """The run records where no store is open: every record is dropped, and part counts are zero.

    ``trouble`` is why no store is open; empty for scripts, which have no store.
    """

    trouble: str = ""

    def read_records_by_text(self) -> Mapping[str, RunRow]:
        """Return no records. Raise StoreError if the store could not be opened."""
        if self.trouble:
            raise StoreError(self.trouble)
        return {}

    def count_parts(self, _program: str) -> int:
        """Return 0."""
        return 0

    def add_parts(self, program: str, count: int = 1) -> None:
        """Drop the change of a part count."""

    def reset_parts(self, program: str) -> None:
        """Drop the change of a part count."""

    def record_start(self, program: str) -> None:
        """Drop the start of a run."""

    def record_end(self, program: str, outcome: str) -> None:
        """Drop the outcome of a run."""

    def record_cycle(self, program: str, seconds: float) -> None:
        """Drop the time of a cycle."""

    def record_proof(self, program: str, result: str, planned: float | None, text: str | None = None) -> None:
        """Drop the result of a proof."""


@dataclass(slots=True)
class Persistence:
    """Settings, run records, versions, users and the event log.

    This class is for scripts and for a store that cannot be opened: it keeps settings until the program
    ends, and nothing else. Reading may raise StoreError; writing is posted and never waits. Call ``backup``,
    ``restore``, ``keep_settings``, ``events`` and ``save_version``, and wait for changes of ``opened``, on a
    worker only.
    """

    settings: dict[str, object] = field(default_factory=dict)
    who: Callable[[], str] = str  # has signed in; empty: there are no levels

    def read_setting(self, key: str) -> object:
        """What was kept under this name; None: nothing."""
        return self.settings.get(key)

    def save_setting(self, key: str, value: object) -> None:
        """Keep anything JSON can hold; None forgets it."""
        self.settings[key] = value

    def keep_settings(self, values: Mapping[str, object]) -> None:
        """The same of several, back when they are on the disk; on a worker. Raises StoreError."""
        for key, value in values.items():
            self.save_setting(key, value)

    def note_change(self, text: str, who: str = "") -> None:
        """A line of the log, with the name, for a change whose table has no history of its own.

        ``who`` has asked for it, where that is not whoever is signed in now. Nothing where there are no
        levels.
        """

    def note_access(self, text: str, who: str) -> None:
        """A line of the log about levels: who has signed in, which PIN was wrong."""

    @property
    def runs(self) -> RunRecords | NoRunRecords:
        """Return the run records of the store that is open now. A restore opens another store."""
        return NoRunRecords()

    def opened(self) -> Store:
        """Return the store that is open now. Raise StoreError if no store is open."""
        raise StoreError(NOTHING_KEPT, "nothing-stored")

    def people(self) -> People:
        """Who works at the machine. Raises StoreError."""
        return People()

    def events(self, _search: str, _kinds: Collection[str], _limit: int) -> Sequence[EventRow]:
        """The log, newest first; no ``kinds``: all."""
        return ()

    def renamed(self, old: str, new: str) -> None:
        """Versions, count and record go with a program that gets another name."""

    def save_version(self, _name: str, _text: bytes, _why: str) -> int:
        """Keep a version and answer its number when it is on the disk. Raises StoreError.

        Where no versions are kept nothing may be thrown away.
        """
        raise StoreError(NOTHING_KEPT, "nothing-stored")

    def backup(self, _target: Path) -> None:
        """A copy of everything that is kept. Raises StoreError."""
        raise StoreError(NOTHING_KEPT, "nothing-stored")

    def judge(self, _source: Path) -> Verdict:
        """Whether a backup is whole, and how it differs from what is kept; on a worker. Raises StoreError."""
        raise StoreError(NOTHING_KEPT, "nothing-stored")

    def restore(self, _source: Path) -> Path | None:
        """Put a backup in the place of what is kept; answers where that went. Raises StoreError."""
        raise StoreError(NOTHING_KEPT, "nothing-stored")
