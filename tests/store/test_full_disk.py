"""A disk that takes nothing: nothing that happened is lost, and what is wrong is called by its name."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from app.cli.main import main
from app.compose.runs.journal import Journal
from core.executor.snapshot import LogEvent
from core.store import store_writer
from core.store.store import Store, StoreError
from core.store.store_errors import StoreErrorCause, find_store_error_cause
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import EventRow
from core.store.store_writer import UnwrittenEntries
from tests.coded import raises_code, recorded_refusals
from tests.interrupted import broken_off
from tests.store.disk import Disk, small_disk


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Disk]:
    with small_disk(tmp_path / "disk") as disk:
        yield disk


def part(number: int) -> LogEvent:
    return LogEvent(0.0, "part", f"part {number}, 3.20 s")


def fill_up(store: Store, disk: Disk) -> None:
    """Full, and the log has used up the room that its file had."""
    disk.fill()
    for _ in range(200):
        store.events.log_event("filler", "x" * 3000)
    with pytest.raises(StoreError):
        store.events.log_event("filler", "last").result(60)
    assert store.pending_entries is not None


# --- nothing is lost ----------------------------------------------------------------------------------------


def test_parts_and_events_are_written_when_disk_has_room_again(disk: Disk) -> None:
    with Store.open(disk.path / "home") as store:
        for _ in range(3):
            store.runs.add_parts("pin.nc")
        store.events.log_event("start", "before").result(60)
        fill_up(store, disk)
        for number in range(33):
            store.runs.add_parts("pin.nc")
            store.events.log_event("part", f"part {number}")
            store.runs.record_cycle("pin.nc", 3.0 + number)
        with raises_code(StoreError, "disk-full"):
            store.settings.save_setting("theme", "light").result(60)
        assert store.write_error == str(
            StoreErrorCause.FULL.make_error(disk.path / "home" / STORE_FILE_NAME, "")
        )
        assert store.pending_entries is not None
        assert store.pending_entries.part_count == 33
        assert store.runs.read_part_count("pin.nc") == 36  # what is held counts on the screen
        disk.make_room()
        store.events.log_event("end", "after").result(60)
        assert (store.write_error, store.pending_entries) == ("", None)
    with Store.open(disk.path / "home") as store:
        assert store.runs.read_part_count("pin.nc") == 36
        told = [event.text for event in reversed(store.events.read_events(limit=1000))]
        assert told[0] == "before"
        assert told[-34:] == [*(f"part {number}" for number in range(33)), "after"]
        (run,) = store.runs.read_run_records()
        assert (run.cycles, run.best, run.latest) == (33, 3.0, 35.0)
        assert store.settings.read_setting("theme") == "light"


def test_pending_entries_are_written_without_further_calls(
    disk: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("core.store.store_writer.RETRY_INTERVAL_S", 0.02)
    with Store.open(disk.path / "home") as store:
        fill_up(store, disk)
        store.runs.add_parts("pin.nc")
        disk.make_room()
        tick = threading.Event()
        while store.pending_entries is not None:
            tick.wait(0.01)
        assert store.runs.read_part_count("pin.nc") == 1


def test_offset_change_on_full_disk_is_rejected_with_reason(disk: Disk) -> None:
    with Store.open(disk.path / "home") as store:
        store.offsets.tool_offsets.change_row(3, "x", {"x": 1.0}).result(60)
        fill_up(store, disk)
        with raises_code(StoreError, "disk-full"):
            store.offsets.tool_offsets.change_row(3, "x", {"x": 2.0, "remark": "y" * 40}).result(60)
        assert store.offsets.tool_offsets.read_rows()[3].x == 1.0  # reading works
        disk.make_room()
        store.offsets.tool_offsets.change_row(3, "x", {"x": 2.0}).result(60)
        assert store.offsets.tool_offsets.read_rows()[3].x == 2.0


def test_interrupted_job_is_saved_as_soon_as_disk_has_room(disk: Disk) -> None:
    journal = Journal(disk.path / "home")
    store = journal.require_store()
    fill_up(store, disk)
    journal.note(broken_off())
    disk.make_room()
    assert journal.close() == ""
    again = Journal(disk.path / "home")
    assert again.left == broken_off()
    again.close()


def test_close_reports_lost_entries(disk: Disk) -> None:
    journal = Journal(disk.path / "home")
    journal.hear(LogEvent(0.0, "load", "pin.nc"))
    fill_up(journal.require_store(), disk)
    for number in range(20):
        journal.hear(part(number))
    lost = journal.close()
    assert lost.startswith("20 parts, ")
    assert lost.endswith("events")


def test_control_started_with_full_disk_saves_its_parts_later(
    disk: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.compose.runs.journal.RETRY_INTERVAL_S", 0.02)
    disk.fill()
    journal = Journal(disk.path / "home")
    assert (
        str(StoreErrorCause.FULL.make_error(disk.path / "home" / STORE_FILE_NAME, "")) in journal.write_error
    )
    journal.hear(LogEvent(0.0, "load", "pin.nc"))
    for number in range(20):
        journal.hear(part(number))
    assert journal.held == "20 parts, 21 events"
    disk.make_room()
    tick = threading.Event()
    while journal.write_error:
        tick.wait(0.01)
    journal.save_version("pin.nc", b"M30", "so that all is written")
    assert journal.runs.read_part_count("pin.nc") == 20
    journal.close()


# --- what it is called --------------------------------------------------------------------------------------


def test_command_line_reports_full_disk(
    disk: Disk, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(disk.path / "home"))
    assert main(["offsets", "set", "T3", "x=1.0", "z=-2"]) == 0
    disk.fill()
    capsys.readouterr()
    refusals = recorded_refusals(monkeypatch)
    assert main(["offsets", "show"]) == (2 if refusals else 0)
    expected = len(refusals) + 3
    assert main(["store", "backup", str(disk.path / "copy.db")]) == 2
    assert main(["store", "export", str(disk.path / "out")]) == 2
    assert main(["offsets", "set", "T4", "x=1.0", "z=-2", "--why", "w" * 20000]) == 2
    assert [each.code for each in refusals] == ["disk-full"] * expected


def test_new_store_is_not_created_on_full_disk(disk: Disk) -> None:
    disk.fill()
    with raises_code(StoreError, "disk-full"):
        Store.open(disk.path / "home")
    assert not (disk.path / "home" / "turndesk.db").exists()


def test_store_locked_by_another_program_is_not_damaged(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.write(lambda c: c.execute("PRAGMA busy_timeout = 20").close()).result(60)
        with closing(sqlite3.connect(tmp_path / "turndesk.db", isolation_level=None)) as other:
            other.execute("BEGIN IMMEDIATE")
            with raises_code(StoreError, "locked"):
                store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0}).result(60)
            store.runs.add_parts("pin.nc")
            with raises_code(StoreError, "locked"):
                store.events.log_event("part", "part 1").result(60)
            assert store.write_error == str(StoreErrorCause.LOCKED.make_error(tmp_path / STORE_FILE_NAME, ""))
            assert store.runs.read_part_count("pin.nc") == 1
            other.execute("ROLLBACK")
        store.events.log_event("end", "after").result(60)
        assert store.write_error == ""
        assert store.runs.read_part_count("pin.nc") == 1


def test_store_without_write_permission_is_rejected(tmp_path: Path) -> None:
    with Store.open(tmp_path):
        pass
    path = tmp_path / "turndesk.db"
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as connection:
        with pytest.raises(sqlite3.Error) as caught:
            connection.execute("DELETE FROM settings")
        assert find_store_error_cause(path, caught.value) is StoreErrorCause.FORBIDDEN
    error = StoreErrorCause.FORBIDDEN.make_error(path, caught.value)
    assert error.code == "forbidden"
    assert str(path) in str(error)


def test_system_error_is_mapped_to_store_error_cause(tmp_path: Path) -> None:
    causes = {
        28: StoreErrorCause.FULL,
        122: StoreErrorCause.FULL,
        27: StoreErrorCause.FULL,
        13: StoreErrorCause.FORBIDDEN,
        30: StoreErrorCause.FORBIDDEN,
    }
    causes |= {5: StoreErrorCause.FAILING, 2: StoreErrorCause.MISSING, 40: StoreErrorCause.OTHER}
    assert {number: find_store_error_cause(tmp_path, OSError(number, "x")) for number in causes} == causes


# --- what is held does not grow, and one bad entry holds nothing up ----------------------------------------


def test_pending_counts_and_settings_have_constant_size() -> None:
    held = UnwrittenEntries()
    for number in range(100_000):
        held.add_parts("pin.nc", 1)
        held.replace_operation(("setting", "theme"), lambda _c: number)  # noqa: B023
    assert (held.count_entries("").part_count, held.count_entries("").other_count) == (100_000, 1)


def test_events_dropped_beyond_limit_are_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store_writer, "MAX_PENDING_EVENTS", 10)
    held = UnwrittenEntries()
    for number in range(25):
        held.add_event(EventRow("2026-01-01T00:00:00.000Z", "stop", f"{number}"))
    with Store.open(tmp_path) as store:
        store.write(held.write_all).result(60)
        texts = [event.text for event in reversed(store.events.read_events())]
    assert texts[:-1] == [str(n) for n in range(15, 25)]
    assert texts[-1].startswith("15 ")


def test_invalid_program_name_does_not_block_other_entries(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.programs.save_loaded_version("bad/name", b"M30", "x")
        store.runs.add_parts("pin.nc")
        store.events.log_event("end", "after").result(60)
        assert store.pending_entries is None
        assert store.runs.read_part_count("pin.nc") == 1
        assert any("bad/name" in event.text for event in store.events.read_events())


def test_part_count_is_reset_while_disk_is_full(disk: Disk) -> None:
    with Store.open(disk.path / "home") as store:
        store.runs.add_parts("pin.nc", 5).result(60)
        fill_up(store, disk)
        store.runs.add_parts("pin.nc")
        store.runs.reset_parts("pin.nc")
        store.runs.add_parts("pin.nc")
        store.runs.add_parts("pin.nc", 2)
        with pytest.raises(StoreError):
            store.events.log_event("x", "y").result(60)
        assert store.runs.read_part_count("pin.nc") == 3
        disk.make_room()
        store.events.log_event("x", "z").result(60)
        assert store.runs.read_part_count("pin.nc") == 3


# --- reading goes on ----------------------------------------------------------------------------------------


def closed_store(folder: Path) -> Path:
    """A store with one setting, closed: nothing lies beside the file but its lock."""
    with Store.open(folder) as store:
        store.settings.save_setting("theme", "light").result(60)
    assert sorted(each.name for each in folder.iterdir()) == ["turndesk.db", "turndesk.lock"]
    return folder


def test_store_on_full_disk_can_still_be_read(disk: Disk) -> None:
    home = closed_store(disk.path / "home")
    disk.fill()
    with Store.open(home, read_only=True) as store:
        assert store.settings.read_setting("theme") == "light"
    with raises_code(StoreError, "disk-full"):
        Store.open(home)


def test_unreadable_log_is_not_skipped(disk: Disk) -> None:
    home = closed_store(disk.path / "home")
    (home / "turndesk.db-wal").write_bytes(bytes(64))
    disk.fill()
    with raises_code(StoreError, "disk-full"):
        Store.open(home, read_only=True)
