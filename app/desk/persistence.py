"""Interface between the screen and the data store, and its substitute if no store is available."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from core.store.backup import BackupCheckResult
from core.store.store_errors import StoreError
from core.store.store_rows import EventRow, RunRow
from core.store.user_records import UserList

if TYPE_CHECKING:
    from core.store.production.run_records import RunRecords
    from core.store.store import Store

NOTHING_SAVED = "no data is being saved; start turndesk with a writable folder (TURNDESK_HOME)"


@dataclass(frozen=True, slots=True)
class NullRunRecords:
    """Substitute for run records if no store is open. It discards every record and counts no parts.

    ``error_text`` is the reason why no store is open. It is empty for scripts, which do not have a store.
    """

    error_text: str = ""

    def read_records_by_text(self) -> Mapping[str, RunRow]:
        """Return an empty mapping. Raises StoreError if the store could not be opened."""
        if self.error_text:
            raise StoreError(self.error_text)
        return {}

    def read_part_count(self, _program: str) -> int:
        """Return 0, because no parts are counted."""
        return 0

    def add_parts(self, program: str, count: int = 1) -> None:
        """Ignore the change of a part count."""

    def reset_parts(self, program: str) -> None:
        """Ignore the reset of a part count."""

    def record_run_start(self, program: str) -> None:
        """Ignore the start of a run."""

    def record_run_end(self, program: str, outcome: str) -> None:
        """Ignore the outcome of a run."""

    def record_cycle(self, program: str, seconds: float) -> None:
        """Ignore the duration of a cycle."""

    def record_proof(self, program: str, result: str, planned: float | None, text: str | None = None) -> None:
        """Ignore the result of a proof."""


@dataclass(slots=True)
class Persistence:
    """Storage of settings, run records, versions, users and the event log.

    This base class is for scripts and for a store that cannot be opened. It stores only settings, and only
    until the program ends. Reading may raise StoreError. Writing is queued and never blocks.

    Call ``backup``, ``restore``, ``save_settings``, ``events`` and ``save_version`` only on a worker
    thread. Wait for changes of ``require_store`` only on a worker thread.
    """

    settings: dict[str, object] = field(default_factory=dict)
    who: Callable[[], str] = str  # Returns the signed-in user; empty if access levels are off.

    def read_setting(self, key: str) -> object:
        """Return the stored value of a setting, or None if it is not set."""
        return self.settings.get(key)

    def save_setting(self, key: str, value: object) -> None:
        """Store the value of a setting, which must be representable in JSON. None removes the setting."""
        self.settings[key] = value

    def save_settings(self, values: Mapping[str, object]) -> None:
        """Store several settings and wait until they are on the disk.

        Call this method on a worker thread. Raises StoreError if storing fails.
        """
        for key, value in values.items():
            self.save_setting(key, value)

    def log_change(self, text: str, user_name: str = "") -> None:
        """Log a change of data that have no history of their own.

        ``user_name`` is the user who requested the change, or empty for the signed-in user. If access
        levels are off, no entry is written.
        """

    def log_access(self, text: str, user_name: str) -> None:
        """Write an access event to the event log, for example a sign-in or a wrong PIN."""

    @property
    def runs(self) -> RunRecords | NullRunRecords:
        """Return the run records of the open store. After a restore, call this method again."""
        return NullRunRecords()

    def require_store(self) -> Store:
        """Return the open store. Raises StoreError if no store is open."""
        raise StoreError(NOTHING_SAVED, "nothing-stored")

    def people(self) -> UserList:
        """Return the users of the machine. Raises StoreError if they cannot be read."""
        return UserList()

    def events(self, _search: str, _kinds: Collection[str], _limit: int) -> Sequence[EventRow]:
        """Return up to ``_limit`` log entries, newest first.

        If ``_kinds`` is empty, all kinds are included.
        """
        return ()

    def rename_program(self, old_name: str, new_name: str) -> None:
        """Move the versions, part count and run record of a program to its new name."""

    def save_version(self, _name: str, _text: bytes, _why: str) -> int:
        """Save a version of a program, wait until it is on the disk, and return its number.

        Raises StoreError if saving fails. Without a store, this method always raises StoreError, because
        the text would be lost.
        """
        raise StoreError(NOTHING_SAVED, "nothing-stored")

    def backup(self, _target: Path) -> None:
        """Write a backup of the whole store. Raises StoreError if the backup fails."""
        raise StoreError(NOTHING_SAVED, "nothing-stored")

    def check_backup(self, _source: Path) -> BackupCheckResult:
        """Check a backup, compare it with the current store, and return the result.

        Call this method on a worker thread. Raises StoreError if the check cannot be made.
        """
        raise StoreError(NOTHING_SAVED, "nothing-stored")

    def restore(self, _source: Path) -> Path | None:
        """Replace the store with a backup, and return the old store's path. Raises StoreError on failure."""
        raise StoreError(NOTHING_SAVED, "nothing-stored")
