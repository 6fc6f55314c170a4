"""The store as the rest of the product sees it: reads answer at once, writes answer by a future."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Concatenate, ParamSpec, TypeVar

from core.message import Message
from core.store import damaged_rows, event_log, people, program_records
from core.store.database import Opened, open_to_read, open_to_write
from core.store.offsets import offset_history, offset_tables, touch_off
from core.store.offsets.offset_tables import Reason
from core.store.offsets.touch_off import Touch
from core.store.people import People
from core.store.production import job_queue
from core.store.production.job_queue import JobRow
from core.store.row_sums import KEYS
from core.store.store_errors import Cause, StoreError, why
from core.store.store_file import stock_key
from core.store.store_rows import (
    Change,
    EventRow,
    Kind,
    MillRow,
    PresetRow,
    ProgramRow,
    Row,
    RunRow,
    SecondaryRow,
    ShapeRow,
    ToolRow,
    Value,
    VersionRow,
    ZeroRow,
    utc_now,
)

if TYPE_CHECKING:
    from concurrent.futures import Future

    from core.store.store_writer import Backlog, Keeping, Operation, StoreWriter, Unwritten

__all__ = ["Store", "StoreError"]

T = TypeVar("T")
P = ParamSpec("P")


class Store:
    """Programs, offsets, events, part counts and settings of one folder; see ``open``.

    A future of a write is answered when the change is on the disk, and with StoreError when it is refused or
    fails; nobody but a command line need wait for it. Offsets and programs are then as before; events,
    counts, runs and settings are held in memory and written when the disk takes them (``held``).
    All methods may be called from any thread.
    """

    def __init__(self, opened: Opened) -> None:
        self.path = opened.path
        self._reader = opened.reader
        self._reading = threading.Lock()
        self._opened = opened
        self.repaired = (
            _repaired(opened.writer, opened.mended) if opened.writer else ()
        )  # what was damaged, in sentences
        self._writer = _writer(opened.writer, opened.path) if opened.writer else None
        self._texts = dict[str, str]()  # record keys of the texts loaded in this session, by name

    @classmethod
    def open(cls, folder: Path, *, read_only: bool = False) -> Store:
        """The store in ``folder``, made where there is none.

        Read-only works beside a writer, and shows an empty store where there is none. Raises StoreError when
        another process writes it, or when the file is damaged, foreign or newer; such a file is not touched.
        """
        return cls(open_to_read(folder) if read_only else open_to_write(folder))

    def close(self) -> None:
        """Write what is queued, then give the store free. Calling it again does nothing.

        While the disk hangs the store stays open: its lock and connections end with the process.
        """
        if self._writer and not self._writer.close():
            return
        with self._reading:
            self._opened.close()

    def __enter__(self) -> Store:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def trouble(self) -> str:
        """Why the last write failed; empty while all is well."""
        return self._writer.trouble if self._writer else ""

    @property
    def backlog(self) -> Backlog | None:
        """What waits in memory for a disk that takes nothing; None while nothing has to."""
        return self._writer.backlog if self._writer else None

    # --- reading: answers at once, from any thread; raises StoreError where the file is found damaged -----

    @contextmanager
    def read(self) -> Iterator[sqlite3.Connection]:
        """The reading connection, for one thread at a time; SQLite's errors come out as StoreError.

        All that is asked within sees one moment: a change that is saved between a row and its sum would
        else make the row a damaged one.
        """
        with self._reading:
            try:
                with _one_moment(self._reader) as connection:
                    yield connection
            except sqlite3.ProgrammingError as error:
                raise StoreError(
                    Message("{path} is closed; nothing more can be read from it", path=self.path), "closed"
                ) from error
            except sqlite3.Error as error:
                raise why(self.path, error) from error
            except UnicodeDecodeError as error:  # the name of a column
                raise Cause.DAMAGED.error(self.path, error) from error

    def _asked(
        self, query: Callable[Concatenate[sqlite3.Connection, P], T], *args: P.args, **named: P.kwargs
    ) -> T:
        with self.read() as connection:
            return query(connection, *args, **named)

    def offsets(self, kind: Kind) -> dict[int, Row]:
        """The offsets of a table that have been set, by number or code."""
        return self._asked(offset_tables.current, kind)

    def tools(self) -> dict[int, ToolRow]:
        """The tool offsets that have been set."""
        return self._asked(offset_tables.tools)

    def tools_at(self, moment: str) -> dict[int, ToolRow]:
        """The tool offsets as they were set at a moment (UTC)."""
        rows = self._asked(offset_history.as_of, Kind.TOOL, moment)
        return {number: row for number, row in rows.items() if isinstance(row, ToolRow)}

    def secondary(self) -> dict[int, SecondaryRow]:
        """The secondary offsets that have been set."""
        return self._asked(offset_tables.rows_of, Kind.SECONDARY, SecondaryRow)

    def history(self, kind: Kind | None = None, limit: int = 100) -> tuple[Change, ...]:
        """Changes of a table, newest first; without ``kind`` of tool and secondary offsets together."""
        return self._asked(offset_history.history, kind, limit)

    def history_of_all(self, limit: int = 100) -> tuple[Change, ...]:
        """Changes of all tables, newest first."""
        return self._asked(offset_history.history_any, limit)

    def zero_offsets(self) -> dict[int, ZeroRow]:
        """The settable offsets G54…G59 that have been set."""
        return self._asked(offset_tables.rows_of, Kind.ZERO, ZeroRow)

    def shapes(self) -> dict[int, ShapeRow]:
        """The shapes of tools that have been set."""
        return self._asked(offset_tables.rows_of, Kind.SHAPE, ShapeRow)

    def mill_tools(self) -> dict[int, MillRow]:
        """The tools of a mill."""
        return self._asked(offset_tables.rows_of, Kind.MILL_TOOL, MillRow)

    def presets(self) -> dict[int, PresetRow]:
        """The presets of a mill."""
        return self._asked(offset_tables.rows_of, Kind.PRESET, PresetRow)

    def damaged(self, tables: Collection[str] = KEYS, settings: Collection[str] = ()) -> tuple[str, ...]:
        """A sentence for each row that is not as it was saved; of some tables only, and of some settings."""
        return self._asked(damaged_rows.damaged, tables, settings)

    def programs(self) -> tuple[ProgramRow, ...]:
        """All programs by name."""
        return self._asked(program_records.listing)

    def versions(self, name: str) -> tuple[VersionRow, ...]:
        """Every version of a program, newest first."""
        return self._asked(program_records.versions, name)

    def load_program(self, name: str, version: int | None = None) -> bytes:
        """The text as saved. Raises StoreError for a version that is not there or not as it was saved."""
        return self._asked(program_records.load, name, version)

    def events(self, search: str = "", limit: int = 100, kinds: Collection[str] = ()) -> tuple[EventRow, ...]:
        """The log, newest first; with ``search`` what holds it in kind or text, in any case of letters.

        With ``kinds`` only events of these.
        """
        return self._asked(event_log.events, search, limit, kinds)

    def runs(self) -> tuple[RunRow, ...]:
        """What each program has done."""
        return self._asked(program_records.all_of)

    def runs_by_text(self) -> dict[str, RunRow]:
        """Return what each program text has done, by its record key."""
        return self._asked(program_records.by_text)

    def people(self) -> People:
        """Who works at the machine, where that is kept; else there are no levels."""
        return self._asked(people.people)

    def setting(self, key: str) -> object:
        """A setting, None: not set."""
        return self._asked(event_log.setting, key)

    def stock_of(self, program: str) -> str:
        """What was last said about the stock of a program; empty: nothing."""
        text = self.setting(stock_key(program))
        return text if isinstance(text, str) else ""

    def keep_stock(self, program: str, text: str) -> Future[None]:
        """Remembers the stock of a program; an empty text forgets it."""
        return self.set_setting(stock_key(program), text or None)

    def parts(self, program: str) -> int:
        """Parts of this program that were counted, those that are still to be written too."""
        with self.read() as connection:
            key = program_records.key_of(connection, self._key(program))
            stored, held = program_records.parts(connection, key), self.backlog
        reset, more = (False, 0)
        if held is not None:
            reset, more = held.counts.get(key) or held.counts.get(program, (False, 0))
        return max(0, (0 if reset else stored) + more)

    def jobs(self) -> tuple[JobRow, ...]:
        """The queue of jobs, with the parts that are still to be written."""
        with self.read() as connection:
            held = self.backlog
            return job_queue.jobs(connection, held.counts if held is not None else None)

    def write(self, operation: Operation[T]) -> Future[T]:
        """Posts one transaction to the writer. Raises StoreError in a read-only store."""
        if self._writer is None:
            raise StoreError(
                Message("{path} is open read-only; nothing can be stored", path=self.path), "read-only"
            )
        return self._writer.post(operation)

    def keep(self, keeping: Keeping) -> Future[None]:
        """Hands something on that must be written, sooner or later. Raises StoreError in a read-only store.

        The future is answered when it is on the disk, and with StoreError when it is held for later.
        """
        if self._writer is None:
            raise StoreError(
                Message("{path} is open read-only; nothing can be stored", path=self.path), "read-only"
            )
        return self._writer.keep(keeping)

    def set_offset(
        self, kind: Kind, number: int, why: str, values: Mapping[str, Value], *, who: str = "operator"
    ) -> Future[Row]:
        """Sets the fields that ``values`` names of an offset, mm and X a radius; the rest stays."""
        reason, wanted = Reason(why, who), dict(values)
        return self.write(lambda c: offset_tables.change(c, kind, number, reason, wanted))

    def set_tool(self, number: int, why: str, *, who: str = "operator", **values: Value) -> Future[Row]:
        """Sets what is given of tool offset 1…32, by the names of ``ToolRow``."""
        return self.set_offset(Kind.TOOL, number, why, values, who=who)

    def set_secondary(self, number: int, why: str, *, who: str = "operator", **values: Value) -> Future[Row]:
        """Sets what is given of D offset 1…32, by the names of ``SecondaryRow``."""
        return self.set_offset(Kind.SECONDARY, number, why, values, who=who)

    def touch_off(
        self, number: int, touch: Touch, why: str, *, who: str = "operator"
    ) -> Future[tuple[Change, ...]]:
        """Sets a tool by what it touched, and all with it when it is the master; answers the changes."""
        return self.write(lambda c: touch_off.touch_off(c, number, touch, Reason(why, who)))

    def choose_master(self, number: int, why: str, *, who: str = "operator") -> Future[tuple[Change, ...]]:
        """The tool that the others are relative to, 0: none; no tip moves by it."""
        return self.write(lambda c: touch_off.choose_master(c, number, Reason(why, who)))

    def remove_shape(self, number: int, why: str, *, who: str = "operator") -> Future[bool]:
        """A tool without a shape again; answers whether it had one."""
        return self.remove_offset(Kind.SHAPE, number, why, who=who)

    def remove_offset(self, kind: Kind, number: int, why: str, *, who: str = "operator") -> Future[bool]:
        """One offset that was never set again; answers whether it was."""
        return self.write(lambda c: offset_tables.remove(c, kind, number, Reason(why, who)))

    def clear_offsets(self, kind: Kind, why: str, *, who: str = "operator") -> Future[int]:
        """All offsets of a table at once, as one step of its history; answers how many were set."""
        return self.write(lambda c: offset_tables.clear(c, kind, Reason(why, who)))

    def undo_offset(
        self, why: str = "undo", *, kind: Kind | None = None, who: str = "operator"
    ) -> Future[tuple[Change, ...]]:
        """Takes the last change of a table back; again: the one before. StoreError when there is none.

        Without ``kind`` the last of tool and secondary offsets together.
        """
        return self.write(lambda c: offset_history.undo(c, Reason(why, who), kind))

    def undoable(self, kind: Kind, number: int | None = None) -> tuple[Change, ...]:
        """Return what ``undo_step`` would take back: the last step of a row, or of the whole table."""
        return self._asked(offset_history.undoable, kind, number)

    def undo_step(
        self, kind: Kind, number: int | None, step: int, why: str = "undo", *, who: str = "operator"
    ) -> Future[tuple[Change, ...]]:
        """Take back exactly this step. The future raises StoreError if its rows have changed since."""
        return self.write(lambda c: offset_history.undo_step(c, Reason(why, who), kind, number, step))

    def undo_last(self, why: str = "undo", *, who: str = "operator") -> Future[tuple[Change, ...]]:
        """Takes the youngest change of all tables back; again: the one before. StoreError without one."""
        return self.write(lambda c: offset_history.undo_any(c, Reason(why, who)))

    def save_program(self, name: str, text: bytes, why: str, *, who: str = "") -> Future[int]:
        """Keeps a version; answers its number, that of the newest when the text is the same."""
        return self.write(lambda c: program_records.save(c, name, text, why, who))

    def rename_program(self, old: str, new: str) -> Future[None]:
        """Versions and notes go with a program that gets another name; its record belongs to its text."""
        key = self._texts.pop(old, None)
        self._texts.pop(new, None)
        if key is not None:
            self._texts[new] = key
        return self.write(lambda c: program_records.renamed(c, old, new))

    # --- what must be kept, sooner or later: a disk that is full gets it when there is room again ----------

    def keep_program(self, name: str, text: bytes, why: str) -> Future[None]:
        """Store a version that is about to run. From now on the record of this name is that of this text."""
        key = program_records.key_of_bytes(text)
        self._texts[name] = key

        def operation(connection: sqlite3.Connection) -> None:
            job_queue.load_text(connection, name, key)
            program_records.save(connection, name, text, why)

        return self._keep_latest("text", name, operation)

    def _key(self, program: str) -> str:
        """Return the record key of the text loaded under this name; the name if this session loaded none."""
        return self._texts.get(program, program)

    def log_event(self, kind: str, text: str, line: int = 0, record: str = "", who: str = "") -> Future[None]:
        """One line of the log, at this moment."""
        return self.log_events([EventRow(utc_now(), kind, text, line, record, who)])

    def log_events(self, events: Iterable[EventRow]) -> Future[None]:
        """Several lines of the log."""
        rows = tuple(events)

        def keeping(unwritten: Unwritten) -> None:
            for row in rows:
                unwritten.event(row)

        return self.keep(keeping)

    def count_part(self, program: str) -> Future[None]:
        """One part more of this program."""
        return self.correct_parts(program, 1)

    def correct_parts(self, program: str, by: int) -> Future[None]:
        """Parts added or taken away by hand; there are never fewer than none."""
        key = self._key(program)
        return self.keep(lambda unwritten: unwritten.count_parts(key, by))

    def reset_parts(self, program: str) -> Future[None]:
        """The part count of this program to nought."""
        key = self._key(program)
        return self.keep(lambda unwritten: unwritten.reset_parts(key))

    def run_started(self, program: str) -> Future[None]:
        """A run of this program begins now."""
        at, key = utc_now(), self._key(program)
        return self._keep_latest("start", key, lambda c: program_records.started(c, key, at))

    def run_ended(self, program: str, outcome: str) -> Future[None]:
        """How it ended."""
        key = self._key(program)
        return self._keep_latest("end", key, lambda c: program_records.ended(c, key, outcome))

    def runs_cut_off(self, outcome: str, template: str) -> Future[None]:
        """Record an outcome for runs without an end, and log a warning ``template`` for each program."""

        def operation(connection: sqlite3.Connection) -> None:
            cut_off = program_records.cut_off(connection, outcome)
            event_log.log(
                connection,
                (EventRow(utc_now(), "warning", Message(template, program=name)) for name in cut_off),
            )

        return self._keep_latest("start", "", operation)

    def cycle_finished(self, program: str, seconds: float) -> Future[None]:
        """One whole cycle of this program and its time."""
        key = self._key(program)
        return self.keep(lambda unwritten: unwritten.cycle(key, seconds))

    def program_proved(
        self, program: str, result: str, planned: float | None, text: str | None = None
    ) -> Future[None]:
        """Store what proving found in ``text``, and the calculated cycle time in seconds.

        Without ``text`` it is that of the text loaded under this name.
        """
        at, key = utc_now(), self._key(program) if text is None else program_records.key_of_text(text)
        return self._keep_latest("proof", key, lambda c: program_records.proved(c, key, result, planned, at))

    def set_setting(self, key: str, value: object) -> Future[None]:
        """Keeps anything JSON can hold; None forgets it. Raises StoreError for what it cannot hold."""
        event_log.setting_text(key, value)
        return self._keep_latest("setting", key, lambda c: event_log.set_setting(c, key, value))

    def _keep_latest(self, what: str, of: str, operation: Operation[object]) -> Future[None]:
        return self.keep(lambda unwritten: unwritten.latest((what, of), operation))

    # --- all at once ----------------------------------------------------------------------------------------

    def import_all(
        self,
        texts: Mapping[str, bytes],
        tools: Mapping[int, ToolRow],
        secondary: Mapping[int, SecondaryRow],
        why: str,
        zero_rows: Mapping[int, ZeroRow] | None = None,
        shapes: Mapping[int, ShapeRow] | None = None,
        mill: Mapping[Kind, Mapping[int, Mapping[str, Value]]] | None = None,
        *,
        who: str = "import",
    ) -> Future[None]:
        """Programs and offsets of an export in one transaction: all of them or none. ``mill``: its tables."""

        def operation(connection: sqlite3.Connection) -> None:
            reason = Reason(why, who)
            for name, text in texts.items():
                program_records.save(connection, name, text, why)
            for number, tool in tools.items():
                offset_tables.change(connection, Kind.TOOL, number, reason, tool._asdict())
            for number, row in secondary.items():
                offset_tables.change(connection, Kind.SECONDARY, number, reason, row._asdict())
            for code, offset in (zero_rows or {}).items():
                offset_tables.change(connection, Kind.ZERO, code, reason, offset._asdict())
            for number, shape in (shapes or {}).items():
                offset_tables.change(connection, Kind.SHAPE, number, reason, shape._asdict())
            for kind, rows in (mill or {}).items():
                for number, values in rows.items():
                    offset_tables.change(connection, kind, number, reason, values)

        return self.write(operation)


@contextmanager
def _one_moment(connection: sqlite3.Connection) -> Iterator[sqlite3.Connection]:
    """A transaction that only reads: it waits for no writer, and no writer waits for it."""
    connection.execute("BEGIN")
    try:
        yield connection
    finally:
        if connection.in_transaction:  # SQLite itself ends one that a damaged file has broken
            connection.execute("ROLLBACK")


def _writer(connection: sqlite3.Connection, path: Path) -> StoreWriter:
    from core.store.store_writer import StoreWriter  # noqa: PLC0415  who only reads needs no thread, no queue

    return StoreWriter(connection, path)


def _repaired(connection: sqlite3.Connection, mended: tuple[str, ...]) -> tuple[str, ...]:
    """Damaged rows that the history has put right, noted in the log; a disk that takes nothing waits."""
    try:
        connection.execute("BEGIN IMMEDIATE")
        told = (*mended, *damaged_rows.repair(connection))
        event_log.log(connection, (EventRow(utc_now(), "warning", text) for text in told))
        connection.execute("COMMIT")
    except sqlite3.Error:
        with suppress(sqlite3.Error):
            connection.rollback()
        return mended
    return told
