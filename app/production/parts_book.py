"""Production data for the pages: tool life, stops, data of optional features, and changes."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from app.desk.access import UserAccess
from app.desk.background_work import LatestRequestWorker
from app.production.tool_totals import TOTALS_SETTING, ToolUseTotals
from core.access.access_table import ProtectedChange
from core.message import Message
from core.store.production import part_cycles, tool_lives
from core.store.production.part_cycles import ProductionStopRow
from core.store.production.tool_lives import ToolLifeRow
from core.store.settings import save_setting
from core.store.store import Store
from core.store.store_access import Operation, WaitingEntries
from core.store.store_errors import StoreError
from core.store.store_rows import OffsetKind

PARTS_NOT_STORED = "MEASURED PARTS CANNOT BE SAVED: NO DATA STORE"
ReadFeatureData = Callable[[Store, str], Any]
"""Function with which an optional feature reads its data for a program from the store.

It is called on the worker thread and raises StoreError.
"""
MAX_ROWS = 1000  # maximum number of readings, cycles and stops


@dataclass(frozen=True, slots=True)
class ProductionData:
    """Production data, with tool life of all tools, the latest stops, and data of optional features."""

    program_name: str = ""
    tool_lives: dict[int, ToolLifeRow] = field(default_factory=dict)
    stops: tuple[ProductionStopRow, ...] = ()  # stops of all programs, oldest first
    feature_data: Mapping[str, Any] = field(default_factory=dict)  # by the name of the feature


def read_production_data(
    store: Store, program: str, tool_table: OffsetKind, readers: Mapping[str, ReadFeatureData]
) -> ProductionData:
    """Return the stored production data.

    ``tool_table`` is the tool table of the machine. The call reads the store and can take a while. Raise
    StoreError on failure.
    """
    more = {name: read(store, program) for name, read in readers.items()}
    with store.read() as connection:
        lives, stops = (
            tool_lives.read_tool_lives(connection, tool_table),
            part_cycles.read_stops(connection, None, MAX_ROWS),
        )
    return ProductionData(program, lives, stops, more)


def find_tool_table_kind(machine_kind: str) -> OffsetKind:
    """Return the kind of tool table for a kind of machine."""
    return OffsetKind.MILL_TOOL if machine_kind == "mill" else OffsetKind.TOOL


@dataclass(slots=True)
class ProductionRecords:
    """Access to stored production data.

    ``update`` is called once a frame, and ``current_data`` is the latest data. A worker reads the data, and
    the store writes it. If ``store`` is None, nothing is stored, and ``no_store_reason`` is the reason.
    ``lock_reason`` is the message on the pages of measured parts.
    """

    store: Store | None = None
    no_store_reason: str = ""
    tool_table_kind: OffsetKind = OffsetKind.TOOL  # tool table of this machine
    current_data: ProductionData = field(default_factory=ProductionData)
    user_access: UserAccess = field(default_factory=UserAccess)  # user and permissions for changes
    error_text: str = ""  # reason for the last failure of reading or writing
    load_count: int = 0  # number of times that ``current_data`` was read
    feature_readers: dict[str, ReadFeatureData] = field(default_factory=dict)  # readers of optional features
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("measured-parts"))
    _stale: bool = True
    _reading: bool = False
    _saving: list[tuple[Future[Any], Callable[[], None], Callable[[str], None]]] = field(default_factory=list)
    _behind: Future[None] | None = None  # done when the writer has processed all earlier changes
    # callbacks for data that is on the disk but not read again yet
    _kept: list[Callable[[], None]] = field(default_factory=list)
    _reopened: tuple[Store | None, str] | None = None

    @property
    def lock_reason(self) -> str:
        """Return the reason why measured parts are not stored, or an empty string."""
        if self.store is not None:
            return ""
        return (
            Message("MEASURED PARTS CANNOT BE SAVED: {away}", away=self.no_store_reason)
            if self.no_store_reason
            else PARTS_NOT_STORED
        )

    def update(self, program: str) -> None:
        """Process finished reads and writes, and read changed data again."""
        if self._reopened is not None:
            self.store, self.no_store_reason = self._reopened
            self._reopened, self._behind, self._stale = None, None, True
        self.worker.deliver_results()
        self._look_at_writing()
        if program != self.current_data.program_name:
            self.current_data, self._stale = (
                ProductionData(
                    program, self.current_data.tool_lives, feature_data=self.current_data.feature_data
                ),
                True,
            )
        store = self.store
        if store is not None and not self.worker.is_busy and self._is_reload_due(store):
            self._reading = True
            work = partial(read_production_data, store, program, self.tool_table_kind, self.feature_readers)
            self.worker.request_work(lambda _watch: work(), self._read, self._failed)

    def _is_reload_due(self, store: Store) -> bool:
        """Return whether data must be read again and all earlier changes have been written."""
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

    def _read(self, found: ProductionData) -> None:
        self.current_data, self.error_text, self._reading = found, "", False
        self.load_count += 1
        self._call_done()

    def _failed(self, why: str) -> None:
        self.error_text, self._reading = why, False
        self._call_done()

    def _call_done(self) -> None:
        """Call the ``on_done`` callbacks of changes that are on the disk and have been read back."""
        callbacks, self._kept = self._kept, []
        for done in callbacks:
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

    def request_reload(self) -> None:
        """Request that the data is read again, because other code has changed the store."""
        self._stale = True

    @property
    def is_busy(self) -> bool:
        """Return whether changes are still being written."""
        return bool(self._saving or self._kept)

    @property
    def is_up_to_date(self) -> bool:
        """Return whether ``current_data`` equals the stored data and no read or write is pending."""
        return not (self.is_busy or self._stale or self._behind is not None or self._reading)

    def write_change(
        self,
        access_right: ProtectedChange,
        operation: Operation[Any],
        on_done: Callable[[], None],
        on_failed: Callable[[str], None],
        description: str = "",
    ) -> None:
        """Store a change.

        A later ``update`` calls ``on_done`` when the change is on the disk, or ``on_failed`` with a reason.
        ``description`` is the text for the change log. If it is empty, there is no log entry.
        """
        why = (
            (self.no_store_reason or PARTS_NOT_STORED)
            if self.store is None
            else self.user_access.find_refusal_reason(access_right)
        )
        if self.store is None or why:
            on_failed(why)
            return

        def report_stored() -> None:
            if description:
                self.user_access.persistence.log_change(description)
            on_done()

        try:
            self._saving.append((self.store.write(operation), report_stored, on_failed))
        except StoreError as error:
            on_failed(str(error))

    def save_tool_use(self, lives: Iterable[ToolLifeRow], totals: ToolUseTotals | None = None) -> None:
        """Store tool use and, in the same transaction, the control's totals that include it."""
        store, tools = self.store, self.tool_table_kind
        if store is None:
            return
        rows = tuple(lives)

        def queue_tool_use(unwritten: WaitingEntries) -> None:
            for row in rows:
                use = (row.number, row.parts, row.seconds, tools)
                unwritten.replace_operation(("life", str(row.number)), partial(_set_use, use))
            if totals is not None:
                unwritten.replace_operation(
                    ("setting", TOTALS_SETTING),
                    lambda c: save_setting(c, TOTALS_SETTING, totals.setting_value),
                )

        store.keep(queue_tool_use)

    def switch_store(self, store: Store | None, error_text: str) -> None:
        """Replace the store.

        Any thread may call this.
        """
        self._reopened = store, error_text

    def close(self) -> None:
        """Stop the worker that reads the data."""
        self.worker.close()


def _set_use(use: tuple[int, int, float, OffsetKind], connection: sqlite3.Connection) -> None:
    tool_lives.save_insert_use(connection, *use)
