"""What is kept of production, as the desk sees it: tool lives, stops, data of features; and changes of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from app.desk.access import Access
from app.desk.background_work import Latest
from core.access.access_table import Act
from core.message import Message
from core.store.production import part_cycles, tool_lives
from core.store.production.part_cycles import StopRow
from core.store.production.tool_lives import LifeRow
from core.store.store import Store
from core.store.store_access import Operation
from core.store.store_errors import StoreError
from core.store.store_rows import Kind

NONE_KEPT = "MEASURED PARTS CANNOT BE SAVED: NO DATA STORE"
Read = Callable[[Store, str], Any]
"""What an optional feature reads of the store for a program, on the worker. Raises StoreError."""
NEWEST = 1000  # readings, cycles and stops that are looked at


@dataclass(frozen=True, slots=True)
class Production:
    """What is known of production: the lives of all tools, the newest stops, and what features have read."""

    program: str = ""
    lives: dict[int, LifeRow] = field(default_factory=dict)
    stops: tuple[StopRow, ...] = ()  # of all programs, oldest first
    more: Mapping[str, Any] = field(default_factory=dict)  # by the names of the features


def production(store: Store, program: str, tools: Kind, readers: Mapping[str, Read]) -> Production:
    """What is kept now; ``tools`` is the table of this machine. Takes its time. Raises StoreError."""
    more = {name: read(store, program) for name, read in readers.items()}
    with store.read() as connection:
        lives, stops = tool_lives.lives(connection, tools), part_cycles.stops(connection, None, NEWEST)
    return Production(program, lives, stops, more)


def tools_of(machine_kind: str) -> Kind:
    """The table of tools of a machine of this kind."""
    return Kind.MILL_TOOL if machine_kind == "mill" else Kind.TOOL


@dataclass(slots=True)
class PartsBook:
    """``look`` is called once a frame; reading is a worker's, writing the store's. ``now`` is what is known.

    Without ``store`` nothing is kept; ``away`` is why, ``locked`` says it where measured parts are shown.
    """

    store: Store | None = None
    away: str = ""
    tools: Kind = Kind.TOOL  # the table of this machine's tools
    now: Production = field(default_factory=Production)
    access: Access = field(default_factory=Access)  # who changes, and whether he may
    trouble: str = ""  # why the last reading or writing failed
    loads: int = 0  # how often ``now`` was read
    readers: dict[str, Read] = field(default_factory=dict)  # of optional features
    worker: Latest = field(default_factory=lambda: Latest("measured-parts"))
    _stale: bool = True
    _reading: bool = False
    _saving: list[tuple[Future[Any], Callable[[], None], Callable[[str], None]]] = field(default_factory=list)
    _behind: Future[None] | None = None  # answered when the writer has come to here
    _kept: list[Callable[[], None]] = field(default_factory=list)  # on the disk, and not read again yet
    _reopened: tuple[Store | None, str] | None = None

    @property
    def locked(self) -> str:
        """Why no measured part is kept, in a sentence; empty where they are."""
        if self.store is not None:
            return ""
        return Message("MEASURED PARTS CANNOT BE SAVED: {away}", away=self.away) if self.away else NONE_KEPT

    def look(self, program: str) -> None:
        """Take up what the worker has read and what is on the disk; read anew what has changed."""
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
        """Whether something is to be read anew, and the writer has come to what was posted before."""
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
        """What is on the disk is told when it is seen too."""
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
        """Something was kept elsewhere."""
        self._stale = True

    @property
    def busy(self) -> bool:
        """Whether something is on its way to the disk."""
        return bool(self._saving or self._kept)

    @property
    def settled(self) -> bool:
        """Whether ``now`` is what is kept: nothing is on its way to the disk or back."""
        return not (self.busy or self._stale or self._behind is not None or self._reading)

    def write(
        self,
        act: Act,
        operation: Operation[Any],
        done: Callable[[], None],
        failed: Callable[[str], None],
        change: str = "",
    ) -> None:
        """Have something kept; ``done`` is called by ``look`` when it is on the disk, else ``failed``.

        ``change`` is what the log says of it, where people say who they are.
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

    def keep_use(self, life: LifeRow) -> None:
        """What an insert has made by now; written as soon as the disk takes it."""
        store = self.store
        if store is not None:
            use = (life.number, life.parts, life.seconds, self.tools)
            store.keep_latest(("life", str(life.number)), lambda c: tool_lives.set_use(c, *use))

    def reopen(self, store: Store | None, trouble: str) -> None:
        """Another store is in the place of the one before. From any thread."""
        self._reopened = store, trouble

    def close(self) -> None:
        """End the worker."""
        self.worker.close()
