"""The store as the rest of the product sees it: reads answer at once, writes answer by a future."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Mapping
from concurrent.futures import Future
from pathlib import Path
from types import TracebackType
from typing import TypeVar

from core.store import offsets, programs, records, runs, toolset, zero
from core.store.errors import StoreError
from core.store.offsets import Reason
from core.store.opening import Opened, open_to_read, open_to_write
from core.store.reading import StoreReader
from core.store.rows import Change, EventRow, Kind, Row, SecondaryRow, ToolRow, Value, utc_now
from core.store.toolset import Touch
from core.store.unwritten import Held, Unwritten
from core.store.writer import Keeping, Operation, StoreWriter
from core.store.zero import ZeroChange, ZeroRow

__all__ = ["Store", "StoreError"]

T = TypeVar("T")


class Store(StoreReader):
    """Programs, offsets, events, part counts and settings of one folder; see ``open``.

    A future of a write is answered when the change is on the disk, and with StoreError when it is refused or
    fails; nobody but a command line need wait for it. Offsets and programs are then as before; events,
    counts, runs and settings are held in memory and written when the disk takes them (``held``).
    All methods may be called from any thread.
    """

    def __init__(self, opened: Opened) -> None:
        super().__init__(opened.path, opened.reader)
        self._opened = opened
        self._writer = StoreWriter(opened.writer, opened.path) if opened.writer else None

    @classmethod
    def open(cls, folder: Path, *, read_only: bool = False) -> Store:
        """The store in ``folder``, made where there is none.

        Read-only works beside a writer, and shows an empty store where there is none. Raises StoreError when
        another process writes it, or when the file is damaged, foreign or newer; such a file is not touched.
        """
        return cls(open_to_read(folder) if read_only else open_to_write(folder))

    def close(self) -> None:
        """Writes what is queued, then gives the store free. Calling it again does nothing."""
        if self._writer:
            self._writer.close()
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
    def held(self) -> Held | None:
        """What waits in memory for a disk that takes nothing; None while nothing has to."""
        return self._writer.held if self._writer else None

    def parts(self, program: str) -> int:
        """Parts of this program that were counted, those that are still to be written too."""
        stored, held = super().parts(program), self.held
        reset, more = held.counts.get(program, (False, 0)) if held is not None else (False, 0)
        return max(0, (0 if reset else stored) + more)

    def write(self, operation: Operation[T]) -> Future[T]:
        """Posts one transaction to the writer. Raises StoreError in a read-only store."""
        if self._writer is None:
            raise StoreError(f"{self.path} is open for reading only; nothing can be stored")
        return self._writer.post(operation)

    def keep(self, keeping: Keeping) -> Future[None]:
        """Hands something on that must be written, sooner or later. Raises StoreError in a read-only store.

        The future is answered when it is on the disk, and with StoreError when it is held for later.
        """
        if self._writer is None:
            raise StoreError(f"{self.path} is open for reading only; nothing can be stored")
        return self._writer.keep(keeping)

    def set_offset(
        self, kind: Kind, number: int, why: str, values: Mapping[str, Value], *, who: str = "operator"
    ) -> Future[Row]:
        """Sets the fields of offset 1…32 that ``values`` names, mm and X a radius; the rest stays."""
        reason, wanted = Reason(why, who), dict(values)
        return self.write(lambda c: offsets.change(c, kind, number, reason, wanted))

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
        return self.write(lambda c: toolset.touch_off(c, number, touch, Reason(why, who)))

    def choose_master(self, number: int, why: str, *, who: str = "operator") -> Future[tuple[Change, ...]]:
        """The tool that the others are relative to, 0: none; no tip moves by it."""
        return self.write(lambda c: toolset.choose_master(c, number, Reason(why, who)))

    def clear_secondary(self, why: str, *, who: str = "operator") -> Future[int]:
        """All D offsets at once, as one step of the history; answers how many were set."""
        return self.write(lambda c: offsets.clear(c, Kind.SECONDARY, Reason(why, who)))

    def undo_offset(
        self, why: str = "undo", *, kind: Kind | None = None, who: str = "operator"
    ) -> Future[tuple[Change, ...]]:
        """Takes the last change of offsets (of one ``kind``) back; again: the one before.

        StoreError when there is none.
        """
        return self.write(lambda c: offsets.undo(c, Reason(why, who), kind))

    def set_zero(
        self, code: int, why: str, values: Mapping[str, float], *, who: str = "operator"
    ) -> Future[ZeroRow]:
        """Sets what ``values`` names of G54…G59: mm, X a radius, C in degrees; the rest stays."""
        wanted = dict(values)
        return self.write(lambda c: zero.change(c, code, Reason(why, who), wanted))

    def clear_zero(self, why: str, *, who: str = "operator") -> Future[int]:
        """All of G54…G59 at once, as one step of their history; answers how many were set."""
        return self.write(lambda c: zero.clear(c, Reason(why, who)))

    def undo_zero(self, why: str = "undo", *, who: str = "operator") -> Future[tuple[ZeroChange, ...]]:
        """Takes the last change of G54…G59 back; again: the one before. StoreError when there is none."""
        return self.write(lambda c: zero.undo(c, Reason(why, who)))

    def save_program(self, name: str, text: bytes, why: str) -> Future[int]:
        """Keeps a version; answers its number, that of the newest when the text is the same."""
        return self.write(lambda c: programs.save(c, name, text, why))

    def rename_program(self, old: str, new: str) -> Future[None]:
        """Versions, part count and record go with a program that gets another name."""
        return self.write(lambda c: runs.renamed(c, old, new))

    # --- what must be kept, sooner or later: a disk that is full gets it when there is room again ----------

    def keep_program(self, name: str, text: bytes, why: str) -> Future[None]:
        """A version that nobody waits for."""
        return self._keep_latest("text", name, lambda c: programs.save(c, name, text, why))

    def log_event(self, kind: str, text: str, line: int = 0) -> Future[None]:
        """One line of the log, at this moment."""
        return self.log_events([EventRow(utc_now(), kind, text, line)])

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
        return self.keep(lambda unwritten: unwritten.count_parts(program, by))

    def reset_parts(self, program: str) -> Future[None]:
        """The part count of this program to nought."""
        return self.keep(lambda unwritten: unwritten.reset_parts(program))

    def run_started(self, program: str) -> Future[None]:
        """A run of this program begins now."""
        at = utc_now()
        return self._keep_latest("start", program, lambda c: runs.started(c, program, at))

    def run_ended(self, program: str, outcome: str) -> Future[None]:
        """How it ended."""
        return self._keep_latest("end", program, lambda c: runs.ended(c, program, outcome))

    def runs_cut_off(self, outcome: str, words: str) -> Future[None]:
        """How those ended whose end was never told; a warning for each, its name before ``words``."""

        def operation(connection: sqlite3.Connection) -> None:
            cut_off = runs.cut_off(connection, outcome)
            records.log(connection, (EventRow(utc_now(), "warning", f"{name}{words}") for name in cut_off))

        return self._keep_latest("start", "", operation)

    def cycle_finished(self, program: str, seconds: float) -> Future[None]:
        """One whole cycle of this program and its time."""
        return self.keep(lambda unwritten: unwritten.cycle(program, seconds))

    def program_proved(self, program: str, result: str, planned: float | None) -> Future[None]:
        """What proving found, and the cycle time it reckons with."""
        at = utc_now()
        return self._keep_latest("proof", program, lambda c: runs.proved(c, program, result, planned, at))

    def set_setting(self, key: str, value: object) -> Future[None]:
        """Keeps anything JSON can hold; None forgets it. Raises StoreError for what it cannot hold."""
        records.setting_text(key, value)
        return self._keep_latest("setting", key, lambda c: records.set_setting(c, key, value))

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
    ) -> Future[None]:
        """Programs and offsets of an export in one transaction: all of them or none."""

        def operation(connection: sqlite3.Connection) -> None:
            reason = Reason(why, "import")
            for name, text in texts.items():
                programs.save(connection, name, text, why)
            for number, tool in tools.items():
                offsets.change(connection, Kind.TOOL, number, reason, tool._asdict())
            for number, row in secondary.items():
                offsets.change(connection, Kind.SECONDARY, number, reason, row._asdict())
            for code, offset in (zero_rows or {}).items():
                zero.change(connection, code, reason, offset._asdict())

        return self.write(operation)
