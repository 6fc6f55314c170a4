"""Run records of an open store: part counts, runs, cycle times and proofs, by program text."""

from __future__ import annotations

import sqlite3
from typing import TYPE_CHECKING

from core.message import Message
from core.store import event_log, program_records, settings
from core.store.store_access import StoreAccess, WaitingEntries
from core.store.store_rows import EventOrigin, EventRow, RunRow, utc_now

if TYPE_CHECKING:
    from concurrent.futures import Future

ORIGIN = "last_event"  # key of the setting with the origin of the last stored event


class LoadedTexts:
    """The record keys of the texts loaded since the store was opened, by program name."""

    def __init__(self) -> None:
        self._keys = dict[str, str]()

    def add(self, name: str, key: str) -> None:
        """Record that the text with this record key is loaded under ``name``."""
        self._keys[name] = key

    def rename(self, old: str, new: str) -> None:
        """Transfer the text loaded under ``old``, if any, to ``new``."""
        key = self._keys.pop(old, None)
        self._keys.pop(new, None)
        if key is not None:
            self._keys[new] = key

    def key_of(self, program: str) -> str:
        """Return the record key of the text loaded under this name; the name itself if no text was loaded."""
        return self._keys.get(program, program)


class RunRecords:
    """Records of the text that is loaded under a program name.

    Methods raise StoreError as described in ``StoreAccess``. A change is not lost if the disk is full. It
    waits in memory and is written later.
    """

    def __init__(self, store: StoreAccess, loaded: LoadedTexts) -> None:
        self._store, self._loaded = store, loaded

    def read_records(self) -> tuple[RunRow, ...]:
        """Return the record of each program, sorted by name."""
        return self._store.query(program_records.all_of)

    def read_records_by_text(self) -> dict[str, RunRow]:
        """Return the record of each program text, by record key."""
        return self._store.query(program_records.by_text)

    def count_parts(self, program: str) -> int:
        """Return the part count of a program, including the parts that wait in memory for the disk."""
        with self._store.read() as connection:
            key = program_records.key_of(connection, self._loaded.key_of(program))
            stored, held = program_records.parts(connection, key), self._store.backlog
        reset, more = (False, 0)
        if held is not None:
            reset, more = held.counts.get(key) or held.counts.get(program, (False, 0))
        return max(0, (0 if reset else stored) + more)

    def add_parts(self, program: str, count: int = 1) -> Future[None]:
        """Add parts to the part count of a program; a negative ``count`` subtracts, down to zero."""
        key = self._loaded.key_of(program)
        return self._store.keep(lambda unwritten: unwritten.count_parts(key, count))

    def record_event(
        self, event: EventRow, part_of: str = "", origin: EventOrigin | None = None
    ) -> Future[None]:
        """Log an event, count a part of the program ``part_of`` if it is not empty, and store the origin.

        All is written in one transaction. The future is done when it is on the disk.
        """
        key = self._loaded.key_of(part_of) if part_of else ""

        def keeping(unwritten: WaitingEntries) -> None:
            unwritten.event(event)
            if key:
                unwritten.count_parts(key, 1)
            if origin is not None:
                value = list(origin)
                unwritten.latest(("setting", ORIGIN), lambda c: settings.save_setting(c, ORIGIN, value))

        return self._store.keep(keeping)

    def read_last_origin(self) -> EventOrigin | None:
        """Return the origin of the last event of a control process that is stored."""
        match self._store.query(settings.read_setting, ORIGIN):
            case [str() as control, int() as number]:
                return EventOrigin(control, number)
            case _:
                return None

    def reset_parts(self, program: str) -> Future[None]:
        """Set the part count of a program to zero."""
        key = self._loaded.key_of(program)
        return self._store.keep(lambda unwritten: unwritten.reset_parts(key))

    def record_start(self, program: str) -> Future[None]:
        """Record that a run of this program starts now."""
        at, key = utc_now(), self._loaded.key_of(program)
        return self._store.keep_latest(("start", key), lambda c: program_records.started(c, key, at))

    def record_end(self, program: str, outcome: str) -> Future[None]:
        """Record the outcome of the run of this program."""
        key = self._loaded.key_of(program)
        return self._store.keep_latest(("end", key), lambda c: program_records.ended(c, key, outcome))

    def end_cut_off_runs(self, outcome: str, template: str) -> Future[None]:
        """Record ``outcome`` for all runs without an end.

        For each program, the warning ``template`` is logged.
        """

        def operation(connection: sqlite3.Connection) -> None:
            cut_off = program_records.cut_off(connection, outcome)
            event_log.log(
                connection,
                (EventRow(utc_now(), "warning", Message(template, program=name)) for name in cut_off),
            )

        return self._store.keep_latest(("start", ""), operation)

    def record_cycle(self, program: str, seconds: float) -> Future[None]:
        """Record one complete cycle of a program and its time in seconds."""
        key = self._loaded.key_of(program)
        return self._store.keep(lambda unwritten: unwritten.cycle(key, seconds))

    def record_proof(
        self, program: str, result: str, planned: float | None, text: str | None = None
    ) -> Future[None]:
        """Record the result of proving ``text``, and the calculated cycle time in seconds.

        None as ``text`` selects the text that is loaded under the name ``program``.
        """
        key = self._loaded.key_of(program) if text is None else program_records.key_of_text(text)
        at = utc_now()
        return self._store.keep_latest(
            ("proof", key), lambda c: program_records.proved(c, key, result, planned, at)
        )
