"""Persistence, as far as the screen asks for it: what is kept from day to day; and where nothing is kept."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from core.store.backup import Verdict
from core.store.people import People, PersonRow
from core.store.store_errors import StoreError
from core.store.store_rows import EventRow, RunRow

NOTHING_KEPT = "no data is being saved; start turndesk with a writable folder (TURNDESK_HOME)"


@dataclass(slots=True)
class Persistence:
    """Settings, part counts, runs, versions and the event log.

    This one is for scripts and a store that cannot be opened: settings live until the program ends, nothing
    else is kept. Reading may raise StoreError; writing is posted and never waits. ``backup``, ``restore``,
    ``keep_settings``, those of people, ``events``, ``runs`` and ``save_version`` take their time: they are
    called on a worker.
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

    def people(self) -> People:
        """Who works at the machine. Raises StoreError."""
        return People()

    def keep_person(self, _row: PersonRow) -> None:
        """Somebody new, or another PIN; on a worker. Raises StoreError."""
        raise StoreError(NOTHING_KEPT, "nothing-stored")

    def remove_person(self, _name: str) -> None:
        """He works here no more; on a worker. Raises StoreError."""
        raise StoreError(NOTHING_KEPT, "nothing-stored")

    def remove_people(self) -> None:
        """Nobody is entered any more: there are no levels; on a worker. Raises StoreError."""
        raise StoreError(NOTHING_KEPT, "nothing-stored")

    def parts(self, _program: str) -> int:
        """Parts counted of this program."""
        return 0

    def correct_parts(self, program: str, by: int) -> None:
        """Parts added or taken away by hand."""

    def reset_parts(self, program: str) -> None:
        """Put the part count of this program to nought."""

    def events(self, _search: str, _kinds: Collection[str], _limit: int) -> Sequence[EventRow]:
        """The log, newest first; no ``kinds``: all."""
        return ()

    def runs(self) -> Sequence[RunRow]:
        """What each program has done."""
        return ()

    def runs_by_text(self) -> Mapping[str, RunRow]:
        """Return what each program text has done, by ``program_texts.key_of_text``. Raises StoreError."""
        return {}

    def run_started(self, program: str) -> None:
        """Note in the record that a run of this program begins."""

    def run_ended(self, program: str, outcome: str) -> None:
        """Note in the record how the run of this program ended."""

    def cycle_finished(self, program: str, seconds: float) -> None:
        """Note the cycle time of one whole cycle, in seconds."""

    def program_proved(self, program: str, result: str, planned: float | None, text: str) -> None:
        """Store what proving found in this text; ``planned`` is the forecast cycle time in seconds."""

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
