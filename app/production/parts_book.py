"""Production data as the pages see them: tool life, stops and data of optional features, with changes."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from app.desk.access import Access
from app.desk.background_work import Latest
from app.production.tool_totals import TOTALS, ToolTotals
from core.access.access_table import Act
from core.message import Message
from core.store.production import part_cycles, tool_lives
from core.store.production.part_cycles import StopRow
from core.store.production.tool_lives import LifeRow
from core.store.settings import save_setting
from core.store.store import Store
from core.store.store_access import Operation, WaitingEntries
from core.store.store_errors import StoreError
from core.store.store_rows import Kind

NONE_KEPT = "MEASURED PARTS CANNOT BE SAVED: NO DATA STORE"
Read = Callable[[Store, str], Any]
"""What an optional feature reads of the store for a program, on the worker. Raises StoreError."""
NEWEST = 1000  # maximum number of readings, cycles and stops


@dataclass(frozen=True, slots=True)
class Production:
    """Production data: tool life of all tools, the latest stops, and data of optional features."""

    program: str = ""
    lives: dict[int, LifeRow] = field(default_factory=dict)
    stops: tuple[StopRow, ...] = ()  # stops of all programs, oldest first
    more: Mapping[str, Any] = field(default_factory=dict)  # by the name of the feature


def production(store: Store, program: str, tools: Kind, readers: Mapping[str, Read]) -> Production:
    """Return the stored production data. ``tools`` is the tool table of the machine.

    The call reads the store and can take a while. Raises StoreError.
    """
    more = {name: read(store, program) for name, read in readers.items()}
    with store.read() as connection:
        lives, stops = tool_lives.lives(connection, tools), part_cycles.stops(connection, None, NEWEST)
    return Production(program, lives, stops, more)


def tools_of(machine_kind: str) -> Kind:
    """Return the kind of tool table for a kind of machine."""
    return Kind.MILL_TOOL if machine_kind == "mill" else Kind.TOOL


@dataclass(slots=True)
class PartsBook:
    """Access to stored production data. ``look`` is called once per frame, and ``now`` is the latest data.

    A worker reads, and the store writes. Without ``store`` nothing is stored. ``away`` is the reason, and
    ``locked`` is the message on the pages of measured parts.
    """

    store: Store | None = None
    away: str = ""
    tools: Kind = Kind.TOOL  # tool table of this machine
    now: Production = field(default_factory=Production)
    access: Access = field(default_factory=Access)  # user and permissions for changes
    trouble: str = ""  # reason for the last failure of reading or writing
    loads: int = 0  # number of times that ``now`` was read
    readers: dict[str, Read] = field(default_factory=dict)  # readers of optional features
    worker: Latest = field(default_factory=lambda: Latest("measured-parts"))
    _stale: bool = True
    _reading: bool = False
    _saving: list[tuple[Future[Any], Callable[[], None], Callable[[str], None]]] = field(default_factory=list)
    _behind: Future[None] | None = None  # done when the writer has processed all earlier changes
    # callbacks for data that is on the disk but not read again yet
    _kept: list[Callable[[], None]] = field(default_factory=list)
    _reopened: tuple[Store | None, str] | None = None

    @property
    def locked(self) -> str:
        """Reason why measured parts are not stored, or an empty string."""
        if self.store is not None:
            return ""
        return Message("MEASURED PARTS CANNOT BE SAVED: {away}", away=self.away) if self.away else NONE_KEPT

    def look(self, program: str) -> None:
        """Process finished reading and writing, and read changed data again."""
        if self._reopened is not None:
            self.store, self.away = self._reopened
            self._reopened, self._behind, self._stale = None, None, True
        self.worker.poll()
        self._look_at_writing()
        if program != self.now.program:
            self.now, self._stale = Production(program, self.now.lives, more=self.now.more), True
        store = self.store
        if store is not None and not self.worker.busy and self._written(store):
            self._reading = True
            work = partial(production, store, program, self.tools, self.readers)
            self.worker.ask(lambda _watch: work(), self._read, self._failed)

    def _written(self, store: Store) -> bool:
        """Return whether data must be read again and all earlier changes are written."""
        if self._stale and self._behind is None:
            self._stale = False
            try:
                self._behind = store.write(lambda _connection: None)
            except StoreError as error:
                self._failed(str(error))
        if self._behind is None or not self._behind.done():
            return False
        self._behind = None
        return True

    def _read(self, found: Production) -> None:
        self.now, self.trouble, self._reading = found, "", False
        self.loads += 1
        self._tell_done()

    def _failed(self, why: str) -> None:
        self.trouble, self._reading = why, False
        self._tell_done()

    def _tell_done(self) -> None:
        """Call the callbacks for changes that are on the disk and read again."""
        told, self._kept = self._kept, []
        for done in told:
            done()

    def _look_at_writing(self) -> None:
        waiting, self._saving = self._saving, []
        for future, done, failed in waiting:
            if not future.done():
                self._saving.append((future, done, failed))
                continue
            self._stale = True
            error = future.exception()
            if error is None:
                self._kept.append(done)
            else:
                failed(str(error))

    def refresh(self) -> None:
        """Request a new reading because data was stored elsewhere."""
        self._stale = True

    @property
    def busy(self) -> bool:
        """Whether changes are still being written."""
        return bool(self._saving or self._kept)

    @property
    def settled(self) -> bool:
        """Whether ``now`` equals the stored data, with nothing left to write or read."""
        return not (self.busy or self._stale or self._behind is not None or self._reading)

    def write(
        self,
        act: Act,
        operation: Operation[Any],
        done: Callable[[], None],
        failed: Callable[[str], None],
        change: str = "",
    ) -> None:
        """Store a change.

        A later ``look`` calls ``done`` once the change is on the disk, or ``failed`` with a reason.
        ``change`` is the text for the change log, or empty for no entry.
        """
        why = (self.away or NONE_KEPT) if self.store is None else self.access.refusal(act)
        if self.store is None or why:
            failed(why)
            return

        def kept() -> None:
            if change:
                self.access.persistence.note_change(change)
            done()

        try:
            self._saving.append((self.store.write(operation), kept, failed))
        except StoreError as error:
            failed(str(error))

    def keep_use(self, lives: Iterable[LifeRow], totals: ToolTotals | None = None) -> None:
        """Store the use of tools, and the totals of the control that it includes, in one transaction."""
        store, tools = self.store, self.tools
        if store is None:
            return
        rows = tuple(lives)

        def keeping(unwritten: WaitingEntries) -> None:
            for row in rows:
                use = (row.number, row.parts, row.seconds, tools)
                unwritten.latest(("life", str(row.number)), partial(_set_use, use))
            if totals is not None:
                unwritten.latest(("setting", TOTALS), lambda c: save_setting(c, TOTALS, totals.plain))

        store.keep(keeping)

    def reopen(self, store: Store | None, trouble: str) -> None:
        """Replace the store; callable from any thread."""
        self._reopened = store, trouble

    def close(self) -> None:
        """Stop the worker."""
        self.worker.close()


def _set_use(use: tuple[int, int, float, Kind], connection: sqlite3.Connection) -> None:
    tool_lives.set_use(connection, *use)
