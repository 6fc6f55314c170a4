"""The reading half of the store: answers at once, from any thread, beside a writer anywhere."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

from core.store import offsets, programs, records, runs, zero
from core.store.causes import why
from core.store.errors import StoreError
from core.store.rows import Change, EventRow, Kind, ProgramRow, RunRow, SecondaryRow, ToolRow, VersionRow
from core.store.zero import ZeroChange, ZeroRow


class StoreReader:
    """Questions to a store. Every one of them raises StoreError when the file turns out to be damaged."""

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._reader = connection
        self._reading = threading.Lock()

    @contextmanager
    def read(self) -> Iterator[sqlite3.Connection]:
        """The reading connection, for one thread at a time; SQLite's errors come out as StoreError."""
        with self._reading:
            try:
                yield self._reader
            except sqlite3.ProgrammingError as error:
                raise StoreError(f"{self.path} is closed; nothing can be read from it any more") from error
            except sqlite3.Error as error:
                raise why(self.path, error) from error

    def tools(self) -> dict[int, ToolRow]:
        """The tool offsets that have been set."""
        with self.read() as connection:
            return offsets.tools(connection)

    def secondary(self) -> dict[int, SecondaryRow]:
        """The secondary offsets that have been set."""
        with self.read() as connection:
            return offsets.secondary(connection)

    def history(self, kind: Kind | None = None, limit: int = 100) -> tuple[Change, ...]:
        """Changes of offsets, newest first."""
        with self.read() as connection:
            return offsets.history(connection, kind, limit)

    def zero_offsets(self) -> dict[int, ZeroRow]:
        """The settable offsets G54…G59 that have been set."""
        with self.read() as connection:
            return zero.current(connection)

    def zero_history(self, limit: int = 100) -> tuple[ZeroChange, ...]:
        """Changes of G54…G59, newest first."""
        with self.read() as connection:
            return zero.history(connection, limit)

    def programs(self) -> tuple[ProgramRow, ...]:
        """All programs by name."""
        with self.read() as connection:
            return programs.listing(connection)

    def versions(self, name: str) -> tuple[VersionRow, ...]:
        """Every version of a program, newest first."""
        with self.read() as connection:
            return programs.versions(connection, name)

    def load_program(self, name: str, version: int | None = None) -> bytes:
        """The text as saved. Raises StoreError for a version that is not there or not as it was saved."""
        with self.read() as connection:
            return programs.load(connection, name, version)

    def events(self, search: str = "", limit: int = 100, kinds: Collection[str] = ()) -> tuple[EventRow, ...]:
        """The log, newest first; with ``search`` what holds it in kind or text, in any case of letters.

        With ``kinds`` only events of these.
        """
        with self.read() as connection:
            return records.events(connection, search, limit, kinds)

    def runs(self) -> tuple[RunRow, ...]:
        """What each program has done."""
        with self.read() as connection:
            return runs.all_of(connection)

    def parts(self, program: str) -> int:
        """Parts of this program that were counted."""
        with self.read() as connection:
            return programs.parts(connection, program)

    def setting(self, key: str) -> object:
        """A setting, None: not set."""
        with self.read() as connection:
            return records.setting(connection, key)
