"""The interface through which the repositories access an open store."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Concatenate, ParamSpec, Protocol, TypeVar

from core.message import Message, join_messages
from core.store.store_rows import EventRow

if TYPE_CHECKING:
    from concurrent.futures import Future

T = TypeVar("T")
P = ParamSpec("P")
Operation = Callable[[sqlite3.Connection], T]


@dataclass(frozen=True, slots=True)
class PendingEntries:
    """The numbers of entries that have not been written to disk yet, and the reason for the delay.

    The numbers of parts, events and other entries are separate.
    """

    reason: str
    event_count: int = 0
    part_count: int = 0
    other_count: int = 0
    dropped_event_count: int = 0  # events lost because the memory for them was full too
    # By program: whether the count is set to zero first, and the parts to add.
    part_counts_by_program: Mapping[str, tuple[bool, int]] = field(default_factory=dict)

    @property
    def description(self) -> str:
        """Return a description of the entries that would be lost if TurnDesk ended now."""
        counts = ((self.part_count, "part"), (self.event_count, "event"), (self.other_count, "other entry"))
        found = [
            Message("{count} {name}", count=count, name=_many(name, count)) for count, name in counts if count
        ]
        return join_messages(", ", found) if found else "nothing"


def _many(name: str, count: int) -> str:
    if count == 1:
        return name
    return name.replace("entry", "entries") if name.endswith("entry") else f"{name}s"


class WaitingEntries(Protocol):
    """Entries that are in memory until they can be written to disk.

    ``program`` is a record key or a program name.
    """

    def add_event(self, row: EventRow) -> None:
        """Add an event to the entries."""

    def add_parts(self, program: str, count: int) -> None:
        """Add parts to a part count, or subtract them if ``count`` is negative."""

    def reset_parts(self, program: str) -> None:
        """Set a part count to zero."""

    def add_cycle(self, program: str, seconds: float) -> None:
        """Add a complete cycle and its time in seconds."""

    def replace_operation(self, name: tuple[str, str], operation: Operation[object]) -> None:
        """Add an operation, replacing a pending operation with the same name."""


EntryWriter = Callable[[WaitingEntries], None]


class StoreAccess(Protocol):
    """Access to one open store for reading and writing, from any thread.

    Reads return immediately. They raise StoreError for a closed or damaged store. Writes return a future,
    whose result is available when the change is on disk. The future raises StoreError if the store rejects
    the change. Writes raise StoreError immediately for a store that is closed or open read-only.
    """

    @property
    def pending_entries(self) -> PendingEntries | None:
        """Return the entries that have not been written to disk yet, or None if all entries are on disk."""

    def read(self) -> AbstractContextManager[sqlite3.Connection]:
        """Open a read transaction for one thread at a time.

        The connection is returned as a context manager.
        """

    def run_query(
        self, function: Callable[Concatenate[sqlite3.Connection, P], T], *args: P.args, **named: P.kwargs
    ) -> T:
        """Call ``function`` with the read connection and the given arguments, and return its result."""

    def write(self, operation: Operation[T]) -> Future[T]:
        """Run ``operation`` in its own transaction.

        If the operation fails, its change is rolled back.
        """

    def keep(self, add_entry: EntryWriter) -> Future[None]:
        """Store an entry that must not be lost.

        If the disk is full, the entry is written when space is available again. The future raises
        StoreError while the entry is only in memory.
        """

    def store_latest_operation(self, key: tuple[str, str], operation: Operation[object]) -> Future[None]:
        """Store an operation as ``keep`` does, replacing a pending operation with the same ``key``."""
