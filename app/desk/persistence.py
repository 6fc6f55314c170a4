"""Persistence, as far as the screen asks for it: what is kept from day to day; and where nothing is kept."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from core.store.store_errors import StoreError
from core.store.store_rows import EventRow, RunRow

NOTHING_KEPT = "nothing is kept here; start turndesk with a folder that can be written (TURNDESK_HOME)"


class Persistence(Protocol):
    """Settings, part counts, runs, versions and the event log.

    Reading raises StoreError; writing is posted and never waits. ``backup``, ``restore``, ``events``,
    ``runs`` and ``save_version`` take their time: they are called on a worker.
    """

    def setting(self, key: str) -> object:
        """What was kept under this name; None: nothing."""
        ...

    def save_setting(self, key: str, value: object) -> None:
        """Keep anything JSON can hold; None forgets it."""
        ...

    def parts(self, program: str) -> int:
        """Parts counted of this program."""
        ...

    def correct_parts(self, program: str, by: int) -> None:
        """Parts added or taken away by hand."""
        ...

    def reset_parts(self, program: str) -> None:
        """Put the part count of this program to nought."""
        ...

    def events(self, search: str, kinds: Collection[str], limit: int) -> Sequence[EventRow]:
        """The log, newest first; no ``kinds``: all."""
        ...

    def runs(self) -> Sequence[RunRow]:
        """What each program has done."""
        ...

    def run_started(self, program: str) -> None:
        """Note in the record that a run of this program begins."""
        ...

    def run_ended(self, program: str, outcome: str) -> None:
        """Note in the record how the run of this program ended."""
        ...

    def cycle_finished(self, program: str, seconds: float) -> None:
        """Note the cycle time of one whole cycle, in seconds."""
        ...

    def program_proved(self, program: str, result: str, planned: float | None) -> None:
        """Note what proving found; ``planned`` is the forecast cycle time in seconds."""
        ...

    def renamed(self, old: str, new: str) -> None:
        """Versions, count and record go with a program that gets another name."""
        ...

    def save_version(self, name: str, text: bytes, why: str) -> int:
        """Keep a version and answer its number when it is on the disk. Raises StoreError."""
        ...

    def backup(self, target: Path) -> None:
        """A copy of everything that is kept."""
        ...

    def restore(self, source: Path) -> Path | None:
        """Put a backup in the place of what is kept; answers where that went."""
        ...


@dataclass(slots=True)
class NoPersistence:
    """For scripts and a store that cannot be opened: settings live until the program ends."""

    settings: dict[str, object] = field(default_factory=dict)

    def setting(self, key: str) -> object:
        """What was set since the start."""
        return self.settings.get(key)

    def save_setting(self, key: str, value: object) -> None:
        """Keep the choice until the program ends."""
        self.settings[key] = value

    def parts(self, _program: str) -> int:
        """No parts are counted here."""
        return 0

    def correct_parts(self, _program: str, _by: int) -> None:
        """No parts are counted here."""

    def reset_parts(self, _program: str) -> None:
        """Nothing to put to nought."""

    def events(self, _search: str, _kinds: Collection[str], _limit: int) -> Sequence[EventRow]:
        """No events are kept here."""
        return ()

    def runs(self) -> Sequence[RunRow]:
        """No runs are remembered here."""
        return ()

    def run_started(self, _program: str) -> None:
        """Runs are not remembered here."""

    def run_ended(self, _program: str, _outcome: str) -> None:
        """Runs are not remembered here."""

    def cycle_finished(self, _program: str, _seconds: float) -> None:
        """Runs are not remembered here."""

    def program_proved(self, _program: str, _result: str, _planned: float | None) -> None:
        """Runs are not remembered here."""

    def renamed(self, _old: str, _new: str) -> None:
        """Nothing is kept that could go with the name."""

    def save_version(self, _name: str, _text: bytes, _why: str) -> int:
        """Versions are not kept here, so nothing may be thrown away."""
        raise StoreError(NOTHING_KEPT)

    def backup(self, _target: Path) -> None:
        """There is nothing to copy: raises StoreError."""
        raise StoreError(NOTHING_KEPT)

    def restore(self, _source: Path) -> Path | None:
        """There is no place for a backup: raises StoreError."""
        raise StoreError(NOTHING_KEPT)
