"""Measured parts as the desk sees them: what is kept of the program on the desk, and changes of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta
from typing import Any

from app.desk.access import Access
from app.desk.latest import Latest
from app.quality.cycle_recorder import COMPLETE
from core.access.access_table import Act
from core.message import Message
from core.quality.measured_feature import CorrectedBy, Feature, FeatureKind
from core.store import measured_parts, part_cycles, tool_lives
from core.store.measured_parts import FeatureRow, ReadingRow
from core.store.part_cycles import CorrectionRow, CycleRow, CycleTime, StopRow
from core.store.store import Store
from core.store.store_errors import StoreError
from core.store.store_rows import Kind, utc
from core.store.store_writer import Operation
from core.store.tool_lives import LifeRow

NONE_KEPT = "MEASURED PARTS CANNOT BE SAVED: NO DATA STORE"
_DAYS = timedelta(days=2)
Read = Callable[[Store, str], Any]
"""What an optional feature reads of the store for a program, on the worker. Raises StoreError."""
NEWEST = 1000  # readings, cycles and stops that are looked at


@dataclass(frozen=True, slots=True)
class PartsData:
    """Of one program, oldest first; lives of all tools; ``corrected``: newest change of an axis."""

    program: str = ""
    features: tuple[FeatureRow, ...] = ()
    readings: tuple[ReadingRow, ...] = ()
    lives: dict[int, LifeRow] = field(default_factory=dict)
    corrected: dict[tuple[str, int, str], int] = field(default_factory=dict)
    cycles: tuple[CycleRow, ...] = ()
    stops: tuple[StopRow, ...] = ()
    corrections: tuple[CorrectionRow, ...] = ()
    day: tuple[CycleTime, ...] = ()  # when all programs ran, as long ago as a shift may be
    more: Mapping[str, Any] = field(default_factory=dict)  # what features have read, by their names

    @property
    def whole_cycles(self) -> tuple[CycleRow, ...]:
        """Those whose time is that of the program: none that a restart has finished, or somebody given up."""
        return tuple(row for row in self.cycles if row.outcome == COMPLETE and row.seconds > 0.0)

    def readings_of(self, feature: int) -> tuple[ReadingRow, ...]:
        """Readings of a feature in the order in which they were taken."""
        return tuple(row for row in self.readings if row.feature == feature)

    def since_correction(self, row: FeatureRow) -> tuple[ReadingRow, ...]:
        """Readings of parts that were begun after the last change of what corrects the feature.

        A part of which nobody knows when it was begun counts only where nothing was ever changed.
        """
        last = self.corrected.get((row.by_kind, row.number, feature_of(row).axis), 0)
        return tuple(each for each in self.readings_of(row.id) if not last or each.offset_change >= last)


def feature_of(row: FeatureRow) -> Feature:
    """A kept feature as it is reckoned with."""
    return Feature(
        row.name,
        FeatureKind(row.kind),
        row.nominal,
        row.low,
        row.high,
        CorrectedBy(row.by_kind),
        row.number,
        row.grows,
        row.every,
        row.sample,
    )


def row_of(feature: Feature, program: str, number: int) -> FeatureRow:
    """The row that keeps a feature; ``number`` is its id, 0 for a new one."""
    return FeatureRow(
        number,
        program,
        feature.name,
        feature.kind.value,
        feature.nominal,
        feature.low,
        feature.high,
        feature.by.value,
        feature.number,
        feature.grows,
        feature.every,
        feature.sample,
    )


def parts_data(store: Store, program: str, limit: int = NEWEST, tools: Kind = Kind.TOOL) -> PartsData:
    """What is kept of a program, the newest so many of each; -1: all. ``tools``: the table of this machine.

    Takes its time. Raises StoreError.
    """
    with store.read() as connection:
        return PartsData(
            program,
            measured_parts.features(connection, program),
            measured_parts.readings(connection, program, limit),
            tool_lives.lives(connection, tools),
            measured_parts.last_corrections(connection),
            part_cycles.cycles(connection, program, limit),
            part_cycles.stops(connection, None, limit),
            part_cycles.corrections(connection, program, limit),
            part_cycles.times_since(connection, utc(datetime.now(UTC) - _DAYS)),
        )


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
    now: PartsData = field(default_factory=PartsData)
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
            self.now, self._stale = PartsData(program, lives=self.now.lives, more=self.now.more), True
        store = self.store
        if store is not None and not self.worker.busy and self._written(store):
            self._reading = True
            self.worker.ask(lambda _watch: self._data(store, program), self._read, self._failed)

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

    def _data(self, store: Store, program: str) -> PartsData:
        """On the worker. Raises StoreError."""
        more = {name: read(store, program) for name, read in self.readers.items()}
        return replace(parts_data(store, program, tools=self.tools), more=more)

    def _read(self, found: PartsData) -> None:
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
            store.keep(
                lambda held: held.latest(("life", str(life.number)), lambda c: tool_lives.set_use(c, *use))
            )

    def reopen(self, store: Store | None, trouble: str) -> None:
        """Another store is in the place of the one before. From any thread."""
        self._reopened = store, trouble

    def close(self) -> None:
        """End the worker."""
        self.worker.close()
