"""The queue of jobs: its counts are the store's own, whatever becomes of them and of the process."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest

from core.store import database
from core.store.damaged_rows import make_row_label
from core.store.production import job_queue
from core.store.production.job_queue import JobRow
from core.store.store import Store, StoreError
from core.store.store_file import STORE_FILE_NAME
from tests.coded import raises_code


def added(store: Store, program: str, wanted: int, note: str = "") -> int:
    return store.write(lambda c: job_queue.add_job(c, program, wanted, note)).result()


def begun(store: Store, job: int) -> None:
    store.write(lambda c: job_queue.activate_job(c, job)).result()


def made(store: Store) -> list[tuple[str, int, int]]:
    return [(row.program, row.parts_made, row.parts_to_make) for row in store.jobs.read_jobs()]


def count(store: Store, program: str, parts: int) -> None:
    store.runs.add_parts(program, parts).result()


def test_only_parts_of_the_active_job_are_counted_for_it(store: Store) -> None:
    count(store, "pin.nc", 40)
    job = added(store, "pin.nc", 5, "order 12")
    count(store, "pin.nc", 2)  # before it is on the desk
    assert made(store) == [("pin.nc", 0, 5)]
    begun(store, job)
    count(store, "pin.nc", 3)
    count(store, "cap.nc", 9)
    (row,) = store.jobs.read_jobs()
    assert (row.parts_made, row.remaining_part_count, row.is_done, row.target_part_count, row.note) == (
        3,
        2,
        False,
        47,
        "order 12",
    )
    count(store, "pin.nc", -1)  # scrap
    assert store.jobs.read_jobs()[0].parts_made == 2
    count(store, "pin.nc", 4)
    (row,) = store.jobs.read_jobs()
    assert (row.parts_made, row.remaining_part_count, row.is_done) == (6, 0, True)


def test_change_of_active_job_retains_parts_made(store: Store) -> None:
    pins, caps = added(store, "pin.nc", 5), added(store, "cap.nc", 2)
    begun(store, pins)
    count(store, "pin.nc", 3)
    begun(store, caps)
    count(store, "cap.nc", 1)
    count(store, "pin.nc", 7)  # for nobody's job
    assert made(store) == [("pin.nc", 3, 5), ("cap.nc", 1, 2)]
    begun(store, pins)
    count(store, "pin.nc", 1)
    assert made(store) == [("pin.nc", 4, 5), ("cap.nc", 1, 2)]
    assert [row.is_active for row in store.jobs.read_jobs()] == [True, False]
    assert store.find_damaged_rows() == ()


def test_part_count_reset_does_not_change_job_progress(store: Store) -> None:
    count(store, "pin.nc", 10)
    begun(store, added(store, "pin.nc", 5))
    count(store, "pin.nc", 3)
    store.runs.reset_parts("pin.nc").result()
    (row,) = store.jobs.read_jobs()
    assert (row.parts_made, row.target_part_count) == (3, 2)
    count(store, "pin.nc", 2)
    assert store.jobs.read_jobs()[0].is_done


def test_two_jobs_of_one_program_are_counted_separately(store: Store) -> None:
    first, second = added(store, "pin.nc", 2), added(store, "pin.nc", 3)
    begun(store, first)
    count(store, "pin.nc", 2)
    begun(store, second)
    count(store, "pin.nc", 1)
    assert made(store) == [("pin.nc", 2, 2), ("pin.nc", 1, 3)]


def test_jobs_are_moved_changed_removed_and_cleared(store: Store) -> None:
    a, b, c = (added(store, name, 1) for name in ("a.nc", "b.nc", "c.nc"))
    store.write(lambda con: job_queue.move_job(con, c, 1)).result()
    store.write(lambda con: job_queue.move_job(con, a, 99)).result()
    assert [row.program for row in store.jobs.read_jobs()] == ["c.nc", "b.nc", "a.nc"]
    store.write(lambda con: job_queue.edit_job(con, b, 7, "blue")).result()
    store.write(lambda con: job_queue.remove_job(con, c)).result()
    begun(store, a)
    count(store, "a.nc", 1)
    assert store.write(lambda con: job_queue.clear(con, remove_all=False)).result() == 1
    assert [(row.program, row.parts_to_make, row.note) for row in store.jobs.read_jobs()] == [
        ("b.nc", 7, "blue")
    ]
    assert store.write(lambda con: job_queue.clear(con, remove_all=True)).result() == 1


def test_renamed_program_retains_its_job(store: Store) -> None:
    begun(store, added(store, "pin.nc", 5))
    count(store, "pin.nc", 2)
    store.programs.rename_program("pin.nc", "pin2.nc").result()
    assert made(store) == [("pin2.nc", 2, 5)]


@pytest.mark.parametrize(
    ("program", "wanted", "note", "code", "value"),
    [
        ("a/b.nc", 1, "", "invalid-name", "a/b.nc"),
        ("NUL.nc", 1, "", "device-name", "NUL.nc"),
        ("a.nc", 0, "", "part-count", "9999999"),
        ("a.nc", 10_000_000, "", "part-count", "10000000"),
        ("a.nc", 1, "x" * 81, "invalid-note", "80"),
        ("a.nc", 1, "two\nlines", "invalid-note", "80"),
    ],
)
def test_invalid_job_is_rejected(
    store: Store, program: str, wanted: int, note: str, code: str, value: str
) -> None:
    with raises_code(StoreError, code, value):
        added(store, program, wanted, note)
    assert store.jobs.read_jobs() == ()


def test_missing_job_is_reported(store: Store) -> None:
    for operation in (
        lambda c: job_queue.activate_job(c, 7),
        lambda c: job_queue.move_job(c, 7, 1),
        lambda c: job_queue.remove_job(c, 7),
        lambda c: job_queue.edit_job(c, 7, 1, ""),
    ):
        with raises_code(StoreError, "job-gone"):
            store.write(operation).result()


def test_full_queue_rejects_more_jobs(store: Store) -> None:
    for _ in range(job_queue.MAX_JOBS):
        store.write(lambda c: job_queue.add_job(c, "a.nc", 1))
    with raises_code(StoreError, "queue-full", 200):
        added(store, "a.nc", 1)


def test_pending_part_counts_are_included(store: Store) -> None:
    begun(store, added(store, "pin.nc", 9))
    count(store, "pin.nc", 2)
    with store.read() as connection:
        assert job_queue.read_jobs(connection, {"pin.nc": (False, 3)})[0].parts_made == 5
        assert (
            job_queue.read_jobs(connection, {"pin.nc": (True, 3)})[0].parts_made == 5
        )  # put to nought, then three


def test_damaged_job_is_left_out_reported_and_cleared(folder: Path) -> None:
    with Store.open(folder) as store:
        added(store, "a.nc", 3)
        added(store, "b.nc", 4)
    with closing(sqlite3.connect(folder / STORE_FILE_NAME)) as outside:
        outside.execute("UPDATE jobs SET wanted = 300 WHERE program = 'a.nc'")
        outside.commit()
    with Store.open(folder) as store:
        assert [row.program for row in store.jobs.read_jobs()] == ["b.nc"]
        (told,) = store.find_damaged_rows()
        assert told.startswith(make_row_label("jobs", 1))
        assert "turndesk jobs clear" in told
        assert store.write(lambda c: job_queue.clear(c, remove_all=False)).result() == 1
        assert store.find_damaged_rows() == ()


def test_older_store_gets_a_job_queue(tmp_path: Path) -> None:
    with closing(sqlite3.connect(tmp_path / STORE_FILE_NAME, isolation_level=None)) as connection:
        connection.execute(f"PRAGMA application_id = {database.APPLICATION_ID}")
        database.upgrade_tables(connection, database.load_migrations()[:11])
        connection.execute("INSERT INTO part_counts VALUES ('pin.nc', 4, '2026-11-20T10:00:00.000Z')")
    with Store.open(tmp_path) as store:
        assert store.jobs.read_jobs() == ()
        assert store.runs.read_part_count("pin.nc") == 4
        assert store.find_damaged_rows() == ()


KILLED = """
import os, signal, sys
from pathlib import Path
from core.store.production import job_queue
from core.store.store import Store

store = Store.open(Path(sys.argv[1]))
job = store.write(lambda c: job_queue.add_job(c, "pin.nc", 50)).result()
store.write(lambda c: job_queue.activate_job(c, job)).result()
for _ in range(7):
    store.runs.add_parts("pin.nc").result()
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_killed_control_retains_queue_and_counts(folder: Path) -> None:
    ended = subprocess.run([sys.executable, "-c", KILLED, str(folder)], check=False)
    assert ended.returncode == -9
    with Store.open(folder) as store:
        (row,) = store.jobs.read_jobs()
        assert (row.program, row.parts_made, row.parts_to_make, row.is_active) == ("pin.nc", 7, 50, True)


def test_job_progress_is_counted_from_its_base_count() -> None:
    row = JobRow(1, "pin.nc", 50, parts_made_before=10, base_part_count=100, part_count=117)
    assert (row.parts_made, row.remaining_part_count, row.target_part_count) == (27, 23, 140)
    assert row._replace(base_part_count=None).parts_made == 10
    assert row._replace(part_count=80).parts_made == 0
