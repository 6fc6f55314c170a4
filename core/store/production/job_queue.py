"""The job queue: programs with the number of parts to make and the number of parts made.

A job has no separate counter. While a job is active, the parts that are counted for its program also count
for the job. At most one job is active, which is the job that the operator loaded last.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from core.message import Message
from core.store import program_records, row_checksums, settings
from core.store.store_access import StoreAccess
from core.store.store_errors import StoreError
from core.store.store_file import make_loaded_text_key
from core.store.store_rows import get_utc_now_text

if TYPE_CHECKING:
    from concurrent.futures import Future

MAX_PARTS = 9_999_999
MAX_JOBS = 200
MAX_NOTE_LENGTH = 80


class JobRow(NamedTuple):
    """One job of the queue.

    ``base_part_count`` is the part count of the program at which the job started counting, or None if the
    job is not active. ``part_count`` is the current part count of the program.
    """

    id: int
    program: str
    parts_to_make: int
    parts_made_before: int = 0  # parts of the job that were made before ``base_part_count`` was set
    base_part_count: int | None = None
    note: str = ""
    added_at: str = ""
    part_count: int = 0

    @property
    def is_active(self) -> bool:
        """Return whether the job is active, so that parts of its program count for the job."""
        return self.base_part_count is not None

    @property
    def parts_made(self) -> int:
        """Return the number of parts that the job has made."""
        return max(
            0,
            self.parts_made_before
            + (self.part_count - self.base_part_count if self.base_part_count is not None else 0),
        )

    @property
    def remaining_part_count(self) -> int:
        """Return the number of parts that still have to be made."""
        return max(0, self.parts_to_make - self.parts_made)

    @property
    def is_done(self) -> bool:
        """Return whether all parts of the job have been made."""
        return self.parts_made >= self.parts_to_make

    @property
    def target_part_count(self) -> int:
        """Return the part count of the program at which the job is done, or 0 if the job is not active."""
        return (
            max(1, self.base_part_count + self.parts_to_make - self.parts_made_before)
            if self.base_part_count is not None
            else 0
        )


PendingCounts = Mapping[str, tuple[bool, int]]
"""Pending part counts in memory, by program: whether to reset to zero first, and the number to add."""


def read_jobs(
    connection: sqlite3.Connection, pending_counts: PendingCounts | None = None
) -> tuple[JobRow, ...]:
    """Return the jobs of the queue in order.

    Damaged rows are omitted. ``pending_counts`` contains the part counts that are in memory because they
    have not been written to disk yet.
    """
    rows = (
        row_checksums.decode_values(row)
        for row in row_checksums.read_intact_rows(connection, "jobs").values()
    )
    placed = sorted((place, number, rest) for number, place, *rest in rows)
    return tuple(
        _job(connection, JobRow._make((number, *rest, 0)), pending_counts or {}) for _, number, rest in placed
    )


def _job(connection: sqlite3.Connection, row: JobRow, held: PendingCounts) -> JobRow:
    """Return a database row of the queue as a job with its current part count.

    If a reset of the count has not been written to disk yet, the parts made before the reset still count
    for the job.
    """
    counted = program_records.read_part_count(connection, row.program)
    reset, more = held.get(program_records.find_loaded_text_key(connection, row.program), (False, 0))
    if reset and row.base_part_count is not None:
        before = row.parts_made_before + counted - row.base_part_count
        return row._replace(part_count=max(0, more), parts_made_before=before, base_part_count=0)
    return row._replace(part_count=max(0, counted + more))


def add_job(connection: sqlite3.Connection, program: str, parts_to_make: int, note: str = "") -> int:
    """Add a job at the end of the queue, and return its ID.

    Raises StoreError if the name, the number of parts or the note is invalid, or if the queue is full.
    """
    program_records.check_new_program_name(program)
    _check(parts_to_make, note)
    count, last = connection.execute("SELECT count(*), coalesce(max(place), 0) FROM jobs").fetchone()
    if count >= MAX_JOBS:
        raise StoreError(
            Message("the queue is full ({most_jobs} jobs); remove finished jobs", most_jobs=MAX_JOBS),
            "queue-full",
        )
    done = connection.execute(
        "INSERT INTO jobs (place, program, wanted, note, added) VALUES (?, ?, ?, ?, ?)",
        (last + 1, program, parts_to_make, note, get_utc_now_text()),
    )
    return int(done.lastrowid or 0)


def edit_job(connection: sqlite3.Connection, job_id: int, parts_to_make: int, note: str) -> None:
    """Change the number of parts and the note of a job.

    Raises StoreError if the number of parts or the note is invalid, or if the job is unknown.
    """
    _check(parts_to_make, note)
    _demand(connection, job_id)
    connection.execute("UPDATE jobs SET wanted = ?, note = ? WHERE id = ?", (parts_to_make, note, job_id))


def move_job(connection: sqlite3.Connection, job_id: int, position: int) -> None:
    """Move a job to the position ``position`` in the queue, counted from 1.

    Raises StoreError if the job is unknown.
    """
    _demand(connection, job_id)
    order = [number for (number,) in connection.execute("SELECT id FROM jobs ORDER BY place, id")]
    order.remove(job_id)
    order.insert(max(0, position - 1), job_id)
    connection.executemany(
        "UPDATE jobs SET place = ? WHERE id = ?", [(place, each) for place, each in enumerate(order, 1)]
    )


def remove_job(connection: sqlite3.Connection, job_id: int) -> None:
    """Remove a job from the queue without changing part counts.

    Raises StoreError if the job is unknown.
    """
    _demand(connection, job_id)
    connection.execute("DELETE FROM jobs WHERE id = ?", (job_id,))


def clear(connection: sqlite3.Connection, *, remove_all: bool) -> int:
    """Remove the completed and damaged jobs, or all jobs, and return the number of removed jobs."""
    whole = {row.id: row for row in read_jobs(connection)}
    numbers = [number for (number,) in connection.execute("SELECT id FROM jobs")]
    gone = [each for each in numbers if remove_all or each not in whole or whole[each].is_done]
    connection.executemany("DELETE FROM jobs WHERE id = ?", [(each,) for each in gone])
    return len(gone)


def activate_job(connection: sqlite3.Connection, job_id: int) -> None:
    """Activate a job, so that from now on parts of its program count only for this job.

    Raises StoreError if the job is unknown or damaged.
    """
    _demand(connection, job_id)
    deactivate_job(connection)
    row = next((row for row in read_jobs(connection) if row.id == job_id), None)
    if row is None:
        raise StoreError(
            "the data of this job does not match its checksum; clear the job from the "
            "queue and enter the job again",
            "damaged-job",
        )
    connection.execute("UPDATE jobs SET base = ? WHERE id = ?", (row.part_count, job_id))


def deactivate_job(connection: sqlite3.Connection) -> None:
    """Deactivate the active job.

    The parts that it has made remain counted.
    """
    for row in read_jobs(connection):
        if row.is_active:
            connection.execute("UPDATE jobs SET made = ?, base = NULL WHERE id = ?", (row.parts_made, row.id))


def save_count_before_reset(connection: sqlite3.Connection, program: str) -> None:
    """Save the number of parts made by the active job before its program's part count is reset."""
    key = program_records.find_loaded_text_key(connection, program)
    for row in read_jobs(connection):
        if row.is_active and program_records.find_loaded_text_key(connection, row.program) == key:
            connection.execute("UPDATE jobs SET made = ?, base = 0 WHERE id = ?", (row.parts_made, row.id))


def record_loaded_text(connection: sqlite3.Connection, program: str, record_key: str) -> None:
    """Record that the program text with the key ``record_key`` is loaded under the name ``program``.

    The active job of the program retains the parts that it has made.
    """
    before = program_records.find_loaded_text_key(connection, program)
    if before == record_key:
        return
    if before == program:
        program_records.assign_rows_to_text(connection, program)
    made = {
        row.id: row.parts_made for row in read_jobs(connection) if row.is_active and row.program == program
    }
    settings.save_setting(connection, make_loaded_text_key(program), record_key)
    base = program_records.read_part_count(connection, program)
    for number, count in made.items():
        connection.execute("UPDATE jobs SET made = ?, base = ? WHERE id = ?", (count, base, number))


def _check(wanted: int, note: str) -> None:
    if not 1 <= wanted <= MAX_PARTS:
        raise StoreError(
            Message(
                "a job must have 1 to {most_parts} parts, not {expected}",
                most_parts=MAX_PARTS,
                expected=wanted,
            ),
            "part-count",
        )
    if len(note) > MAX_NOTE_LENGTH or not note.isprintable():
        raise StoreError(
            Message(
                "a job note can have at most {note_longest} characters, on one line",
                note_longest=MAX_NOTE_LENGTH,
            ),
            "invalid-note",
        )


def _demand(connection: sqlite3.Connection, job: int) -> None:
    if connection.execute("SELECT 1 FROM jobs WHERE id = ?", (job,)).fetchone() is None:
        raise StoreError("that job is not in the queue anymore", "job-gone")


class JobQueue:
    """The job queue of an open store. Methods raise StoreError as described in ``StoreAccess``."""

    def __init__(self, store: StoreAccess) -> None:
        self._store = store

    def read_jobs(self) -> tuple[JobRow, ...]:
        """Return the jobs in order, including part counts that have not been written to disk yet."""
        with self._store.read() as connection:
            held = self._store.pending_entries
            return read_jobs(connection, held.part_counts_by_program if held is not None else None)

    def add_job(self, program: str, parts_to_make: int, note: str = "") -> Future[int]:
        """Add a job for ``parts_to_make`` parts at the end of the queue.

        The result is the ID of the job. The future raises StoreError if the program name, the number of
        parts or the note is invalid, or if the queue is full.
        """
        return self._store.write(lambda c: add_job(c, program, parts_to_make, note))

    def move_job(self, job_id: int, position: int) -> Future[None]:
        """Move a job to a position in the queue, counted from 1.

        The future raises StoreError for an unknown job.
        """
        return self._store.write(lambda c: move_job(c, job_id, position))

    def remove_job(self, job_id: int) -> Future[None]:
        """Remove a job without changing part counts.

        The future raises StoreError for an unknown job.
        """
        return self._store.write(lambda c: remove_job(c, job_id))

    def clear_jobs(self, *, remove_all: bool) -> Future[int]:
        """Remove the completed and damaged jobs, or all jobs.

        The result is the number of removed jobs.
        """
        return self._store.write(lambda c: clear(c, remove_all=remove_all))
