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
from core.store.writer import Operation, StoreWriter
from core.store.zero import ZeroChange, ZeroRow

__all__ = ["Store", "StoreError"]

T = TypeVar("T")


class Store(StoreReader):
    """Programs, offsets, events, part counts and settings of one folder; see ``open``.

    A future of a write is answered when the change is on the disk, and with StoreError when it is refused or
    fails; nobody but a command line need wait for it. All methods may be called from any thread.
    """

    def __init__(self, opened: Opened) -> None:
        super().__init__(opened.path, opened.reader)
        self._opened = opened
        self._writer = StoreWriter(opened.writer) if opened.writer else None

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
        """Why the last write that failed did so, for the alarm line; empty while all is well."""
        return self._writer.trouble if self._writer else ""

    def write(self, operation: Operation[T]) -> Future[T]:
        """Posts one transaction to the writer. Raises StoreError in a read-only store."""
        if self._writer is None:
            raise StoreError(f"{self.path} is open for reading only; nothing can be stored")
        return self._writer.post(operation)

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

    def log_event(self, kind: str, text: str, line: int = 0) -> Future[int]:
        """One line of the log, at this moment."""
        return self.log_events([EventRow(utc_now(), kind, text, line)])

    def log_events(self, events: Iterable[EventRow]) -> Future[int]:
        """Several lines of the log in one transaction."""
        rows = tuple(events)
        return self.write(lambda c: records.log(c, rows))

    def count_part(self, program: str) -> Future[int]:
        """One part more of this program; answers the count."""
        return self.write(lambda c: programs.count_part(c, program))

    def correct_parts(self, program: str, by: int) -> Future[int]:
        """Parts added or taken away by hand; the new count."""
        return self.write(lambda c: programs.correct_parts(c, program, by))

    def reset_parts(self, program: str) -> Future[None]:
        """The part count of this program to nought."""
        return self.write(lambda c: programs.reset_parts(c, program))

    def run_started(self, program: str) -> Future[None]:
        """A run of this program begins now."""
        return self.write(lambda c: runs.started(c, program))

    def run_ended(self, program: str, outcome: str) -> Future[None]:
        """How it ended."""
        return self.write(lambda c: runs.ended(c, program, outcome))

    def runs_cut_off(self, outcome: str) -> Future[tuple[str, ...]]:
        """How those ended whose end was never told; their programs."""
        return self.write(lambda c: runs.cut_off(c, outcome))

    def cycle_finished(self, program: str, seconds: float) -> Future[None]:
        """One whole cycle of this program and its time."""
        return self.write(lambda c: runs.finished(c, program, seconds))

    def program_proved(self, program: str, result: str, planned: float | None) -> Future[None]:
        """What proving found, and the cycle time it reckons with."""
        return self.write(lambda c: runs.proved(c, program, result, planned))

    def rename_program(self, old: str, new: str) -> Future[None]:
        """Versions, part count and record go with a program that gets another name."""
        return self.write(lambda c: runs.renamed(c, old, new))

    def set_setting(self, key: str, value: object) -> Future[None]:
        """Keeps anything JSON can hold; None forgets it."""
        return self.write(lambda c: records.set_setting(c, key, value))

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
