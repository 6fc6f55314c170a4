"""A disk that hangs instead of failing is reported, and closing does not wait for it without a limit."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.compose.runs.journal import Journal
from core.executor.snapshot import LogEvent
from core.store.store import Store
from core.store.store_errors import StoreErrorCause
from core.store.store_file import STORE_FILE_NAME
from core.store.store_writer import SLOW_WRITE_S, StoreWriter

LONG = 60.0  # s that a test waits for another thread


class Disk:
    """A disk that hangs from ``hang`` to ``release``, and the time of a writer that uses it."""

    def __init__(self) -> None:
        self.now = 100.0
        self._hung, self._released = threading.Event(), threading.Event()

    def clock(self) -> float:
        return self.now

    def operation(self, _connection: sqlite3.Connection) -> None:
        """An operation that the disk does not finish."""
        self._hung.set()
        self._released.wait(LONG)

    def hang(self, store: Store) -> None:
        """From now on the writer waits for the disk."""
        store.write(self.operation)
        assert self._hung.wait(LONG)

    def release(self) -> None:
        self._released.set()


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch) -> Iterator[Disk]:
    disk = Disk()

    def writer(connection: sqlite3.Connection, path: Path) -> StoreWriter:
        return StoreWriter(connection, path, disk.clock)

    monkeypatch.setattr("core.store.store._writer", writer)
    yield disk
    disk.release()


def test_entries_not_stored_for_two_seconds_are_reported(disk: Disk, tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    journal.hear(LogEvent(0.0, "load", "pin.nc"))
    journal.require_store().events.log_event("start", "before").result(LONG)
    disk.hang(journal.require_store())
    for number in range(3):
        journal.hear(LogEvent(0.0, "part", f"part {number}, 3.20 s"))
    disk.now += SLOW_WRITE_S - 0.1
    assert (journal.write_error, journal.held) == ("", "")
    disk.now += 0.2
    assert journal.write_error == str(
        StoreErrorCause.NOT_RESPONDING.make_error(tmp_path / STORE_FILE_NAME, "")
    )
    assert journal.held
    disk.release()
    journal.require_store().events.log_event("start", "behind").result(LONG)
    assert (journal.write_error, journal.held) == ("", "")
    assert journal.require_store().runs.read_part_count("pin.nc") == 3
    assert journal.close() == ""


def test_slow_disk_is_not_reported(disk: Disk, tmp_path: Path) -> None:
    """Time that passes with nothing to write is no wait."""
    with Store.open(tmp_path) as store:
        for _ in range(5):
            store.events.log_event("start", "stored").result(LONG)
            disk.now += 10.0 * SLOW_WRITE_S
            assert (store.write_error, store.pending_entries) == ("", None)


def test_close_abandons_hanging_disk_and_reports_lost_entries(
    disk: Disk, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(StoreWriter.close, "__defaults__", (0.0,))
    journal = Journal(tmp_path)
    disk.hang(journal.require_store())
    disk.now += 2.0 * SLOW_WRITE_S
    assert journal.close() != ""
