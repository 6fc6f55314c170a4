"""Run records of an open store: the part counts, runs, cycle times and proofs of each program text."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from typing import TYPE_CHECKING

from core.message import Message
from core.store import event_log, program_records, settings
from core.store.production.part_cycles import ProductionRow, queue_row
from core.store.store_access import StoreAccess, WaitingEntries
from core.store.store_rows import EventOrigin, EventRow, RunRow, get_utc_now_text

if TYPE_CHECKING:
    from concurrent.futures import Future

LAST_ORIGIN_KEY = "last_event"  # key of the setting with the origin of the last stored event


class LoadedProgramTexts:
    """The record keys of the texts that were loaded since the store opened, by program name."""

    def __init__(self) -> None:
        self._keys = dict[str, str]()

    def record_loaded_text(self, name: str, key: str) -> None:
        """Record that the text with the record key ``key`` is loaded under ``name``."""
        self._keys[name] = key

    def rename_program(self, old_name: str, new_name: str) -> None:
        """Transfer the text that is loaded under the name ``old_name``, if any, to the name ``new_name``."""
        key = self._keys.pop(old_name, None)
        self._keys.pop(new_name, None)
        if key is not None:
            self._keys[new_name] = key

    def find_record_key(self, program: str) -> str:
        """Return the record key of the text that is loaded under a name.

        The result is the name itself if no text was loaded.
        """
        return self._keys.get(program, program)


class RunRecords:
    """The records of the text that is loaded under a program name.

    Methods raise StoreError as described in ``StoreAccess``. If the disk is full, a change is not lost but
    remains in memory and is written later.
    """

    def __init__(self, store: StoreAccess, loaded: LoadedProgramTexts) -> None:
        self._store, self._loaded = store, loaded

    def read_run_records(self) -> tuple[RunRow, ...]:
        """Return the run record of each program, sorted by name."""
        return self._store.run_query(program_records.read_run_records)

    def read_records_by_text(self) -> dict[str, RunRow]:
        """Return the run record of each program text, by record key."""
        return self._store.run_query(program_records.read_run_records_by_text)

    def read_part_count(self, program: str) -> int:
        """Return the part count of a program, including the parts that have not been written to disk yet."""
        with self._store.read() as connection:
            key = program_records.find_loaded_text_key(connection, self._loaded.find_record_key(program))
            stored, held = program_records.read_part_count(connection, key), self._store.pending_entries
        reset, more = (False, 0)
        if held is not None:
            reset, more = held.part_counts_by_program.get(key) or held.part_counts_by_program.get(
                program, (False, 0)
            )
        return max(0, (0 if reset else stored) + more)

    def add_parts(self, program: str, count: int = 1) -> Future[None]:
        """Add parts to the part count of a program.

        A negative ``count`` subtracts parts, down to zero.
        """
        key = self._loaded.find_record_key(program)
        return self._store.keep(lambda unwritten: unwritten.add_parts(key, count))

    def record_event(
        self,
        event: EventRow,
        counted_program: str = "",
        origin: EventOrigin | None = None,
        production_rows: Sequence[ProductionRow] = (),
    ) -> Future[None]:
        """Log an event with its origin, and count a part of the program ``counted_program``.

        No part is counted if ``counted_program`` is empty. The event, the count and the
        ``production_rows`` of the event are written in one transaction. The future is done when the data
        are on disk.
        """
        key = self._loaded.find_record_key(counted_program) if counted_program else ""

        def add_event_entries(unwritten: WaitingEntries) -> None:
            unwritten.add_event(event)
            if key:
                unwritten.add_parts(key, 1)
            for row in production_rows:
                queue_row(unwritten, row)
            if origin is not None:
                value = list(origin)
                unwritten.replace_operation(
                    ("setting", LAST_ORIGIN_KEY), lambda c: settings.save_setting(c, LAST_ORIGIN_KEY, value)
                )

        return self._store.keep(add_event_entries)

    def read_last_origin(self) -> EventOrigin | None:
        """Return the origin of the last stored event of a control process, or None if none is stored."""
        match self._store.run_query(settings.read_setting, LAST_ORIGIN_KEY):
            case [str() as control, int() as number]:
                return EventOrigin(control, number)
            case _:
                return None

    def reset_parts(self, program: str) -> Future[None]:
        """Set the part count of a program to zero."""
        key = self._loaded.find_record_key(program)
        return self._store.keep(lambda unwritten: unwritten.reset_parts(key))

    def record_run_start(self, program: str) -> Future[None]:
        """Record that a run of the program starts now."""
        at, key = get_utc_now_text(), self._loaded.find_record_key(program)
        return self._store.store_latest_operation(
            ("start", key), lambda c: program_records.record_run_start(c, key, at)
        )

    def record_run_end(self, program: str, outcome: str) -> Future[None]:
        """Record the outcome of the run of a program."""
        key = self._loaded.find_record_key(program)
        return self._store.store_latest_operation(
            ("end", key), lambda c: program_records.record_run_outcome(c, key, outcome)
        )

    def end_interrupted_runs(self, outcome: str, warning_template: str) -> Future[None]:
        """Record ``outcome`` for all runs that have no end.

        For each of these programs, a warning made from ``warning_template`` is logged.
        """

        def record_interruptions(connection: sqlite3.Connection) -> None:
            cut_off = program_records.record_interrupted_runs(connection, outcome)
            event_log.add_events(
                connection,
                (
                    EventRow(get_utc_now_text(), "warning", Message(warning_template, program=name))
                    for name in cut_off
                ),
            )

        return self._store.store_latest_operation(("start", ""), record_interruptions)

    def record_cycle(self, program: str, cycle_time_s: float) -> Future[None]:
        """Record one complete cycle of a program and its time in seconds."""
        key = self._loaded.find_record_key(program)
        return self._store.keep(lambda unwritten: unwritten.add_cycle(key, cycle_time_s))

    def record_proof(
        self, program: str, result: str, cycle_time_s: float | None, text: str | None = None
    ) -> Future[None]:
        """Record the result of proving ``text``, and the calculated cycle time in seconds.

        If ``text`` is None, the record is for the text that is loaded under the name ``program``.
        """
        key = (
            self._loaded.find_record_key(program)
            if text is None
            else program_records.make_text_record_key(text)
        )
        at = get_utc_now_text()
        return self._store.store_latest_operation(
            ("proof", key), lambda c: program_records.record_proof(c, key, result, cycle_time_s, at)
        )
