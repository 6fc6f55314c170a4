"""The journal while a backup takes the store's place."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import NoReturn

import pytest

from app.compose.desk_assembly import EventDistributor
from app.compose.runs.journal import INTERRUPTED_JOB_KEY, Journal
from app.compose.runs.receipt import EventReceipt
from app.desk.persistence import Persistence
from app.offsets.offset_values import describe_missing_offset
from core.executor.snapshot import LogEvent, convert_interrupted_job_to_json
from core.store.production.run_records import LAST_ORIGIN_KEY
from core.store.store import Store
from core.store.store_errors import StoreError, StoreErrorCause
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import EventOrigin, OffsetKind
from drivers.wakeups import ManualClock
from tests.interrupted import broken_off
from tests.texts import begins, pattern, shows


@pytest.fixture
def journal(tmp_path: Path) -> Iterator[Journal]:
    journal = Journal(tmp_path / "home")
    yield journal
    journal.close()


def test_journal_implements_all_persistence_members() -> None:
    offered = (
        name for name, what in vars(Persistence).items() if callable(what) or isinstance(what, property)
    )
    asked = {name for name in offered if not name.startswith("_")}
    assert len(asked) > 10
    assert asked <= vars(Journal).keys()


def test_invalid_backup_leaves_the_store_unchanged(journal: Journal, tmp_path: Path) -> None:
    bad = tmp_path / "bad.db"
    bad.write_bytes(b"no database" * 50)
    journal.hear(LogEvent(0.0, "start", "before"))
    with pytest.raises(StoreError, match=pattern("screen.not-a-database")):
        journal.restore(bad)
    journal.hear(LogEvent(0.0, "start", "after"))
    journal.save_version("a.nc", b"M30", "so that all is written")
    assert [event.text for event in journal.events("", (), 9)] == ["after", "before"]
    assert journal.write_error == ""


def test_a_part_made_meanwhile_is_counted_in_the_restored_store(journal: Journal, tmp_path: Path) -> None:
    journal.hear(LogEvent(0.0, "load", "/programs/pin.nc"))
    journal.save_version("pin.nc", b"M30", "test")
    target = tmp_path / "copy.db"
    journal.backup(target)
    book = journal.book()
    before = book.store
    journal.restore(target)
    journal.hear(LogEvent(0.0, "part", "part 1"))
    journal.save_version("pin.nc", b"M02", "so that all is written")
    assert journal.runs.read_part_count("pin.nc") == 1
    assert book.poll_saving() == ""
    assert book.store is not before
    assert book.changes == 1


def test_restore_neither_adds_nor_removes_an_interrupted_job(journal: Journal, tmp_path: Path) -> None:
    """Whose tool stands in a part is of this machine and of now."""
    journal.note(broken_off(line=3))
    journal.save_version("pin.nc", b"M30", "so that all is written")
    target = tmp_path / "copy.db"
    journal.backup(target)
    journal.note(broken_off(line=8))
    journal.restore(target)
    journal.close()
    again = Journal(tmp_path / "home")
    assert again.left == broken_off(line=8)
    again.note(None)
    again.save_version("pin.nc", b"M02", "so that all is written")
    again.restore(target)
    again.close()
    last = Journal(tmp_path / "home")
    assert last.left is None
    last.close()


def test_unreadable_interrupted_job_is_ignored(journal: Journal, tmp_path: Path) -> None:
    journal.save_setting(INTERRUPTED_JOB_KEY, {"line": "eight"})
    journal.close()
    again = Journal(tmp_path / "home")
    assert (again.left, again.write_error) == (None, "")
    again.close()


def test_backup_and_restore_are_refused_without_a_store(tmp_path: Path) -> None:
    (tmp_path / "home").write_text("a file where the folder should be")
    journal = Journal(tmp_path / "home")
    assert journal.write_error
    with pytest.raises(StoreError):
        journal.backup(tmp_path / "x.db")
    with pytest.raises(StoreError):
        journal.restore(tmp_path / "x.db")
    journal.save_setting("a", 1)
    assert journal.read_setting("a") is None
    assert journal.runs.read_part_count("pin.nc") == 0
    journal.close()


# --- events of a control process ----------------------------------------------------------------------------


def part(number: int, confirmed: list[int], control: str = "control") -> tuple[LogEvent, EventReceipt]:
    """A finished part, and the receipt of its event."""
    receipt = EventReceipt(EventOrigin(control, number), partial(confirmed.append, number))
    return LogEvent(float(number), "part", f"part {number}"), receipt


def test_event_is_confirmed_when_it_is_on_disk(journal: Journal, tmp_path: Path) -> None:
    confirmed = list[int]()
    journal.hear(LogEvent(0.0, "load", "pin.nc"))
    with sqlite3.connect(tmp_path / "home" / STORE_FILE_NAME, timeout=30.0) as other:
        other.execute("BEGIN IMMEDIATE")  # nothing else can be written meanwhile
        journal.hear(*part(1, confirmed))
        assert confirmed == []
        other.rollback()
    journal.hear(*part(2, confirmed))
    journal.save_version("pin.nc", b"M30", "so that all is written")
    journal.close()
    assert confirmed[-1] == 2
    with Store.open(tmp_path / "home", read_only=True) as store:
        assert store.runs.read_part_count("pin.nc") == 2
        assert store.runs.read_last_origin() == EventOrigin("control", 2)


def test_an_event_that_an_earlier_screen_has_stored_is_not_counted_again(
    journal: Journal, tmp_path: Path
) -> None:
    journal.hear(LogEvent(0.0, "load", "pin.nc"))
    journal.hear(*part(1, []))
    journal.hear(*part(2, []))
    journal.close()  # killed before the control has received the confirmations
    again, confirmed, desk = Journal(tmp_path / "home", control_running=True), list[int](), list[LogEvent]()
    again.hear(LogEvent(0.0, "load", "pin.nc"))
    events = EventDistributor(ManualClock(), again)
    events.desk = SimpleNamespace(hear=desk.append)  # type: ignore[assignment]
    for number in (1, 2, 3):
        events.hear(*part(number, confirmed))
    again.save_version("pin.nc", b"M30", "so that all is written")
    again.close()
    assert confirmed == [1, 2, 3]
    assert [event.time_s for event in desk] == [3.0]
    with Store.open(tmp_path / "home", read_only=True) as store:
        assert store.runs.read_part_count("pin.nc") == 3


def test_events_of_another_control_are_numbered_separately(journal: Journal, tmp_path: Path) -> None:
    journal.hear(LogEvent(0.0, "load", "pin.nc"))
    journal.hear(*part(7, []))
    journal.close()
    again = Journal(tmp_path / "home")
    assert again.has_stored_event(EventOrigin("control", 7))
    assert not again.has_stored_event(EventOrigin("control", 8))
    assert not again.has_stored_event(EventOrigin("another", 1))
    again.close()


def test_events_without_a_store_are_not_confirmed(tmp_path: Path) -> None:
    (tmp_path / "home").write_text("a file where the folder should be")
    journal, confirmed = Journal(tmp_path / "home"), list[int]()
    journal.hear(*part(1, confirmed))
    journal.close()
    assert confirmed == []


@pytest.mark.parametrize("value", [3, ["a"], ["a", "b"], [1, 2], {"a": 1}])
def test_damaged_event_origin_is_ignored(journal: Journal, tmp_path: Path, value: object) -> None:
    journal.save_setting(LAST_ORIGIN_KEY, value)
    journal.close()
    again = Journal(tmp_path / "home")
    assert not again.has_stored_event(EventOrigin("a", 1))
    assert again.write_error == ""
    again.close()


# --- a store that was away at the start --------------------------------------------------------------------


@pytest.fixture
def away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Journal]:
    """Begun while the disk was full; the store holds a job that was interrupted before."""
    with Store.open(tmp_path / "home") as store:
        store.offsets.tool_offsets.change_row(3, "test", {"x": 1.25}).result(60)
        store.settings.save_setting(
            INTERRUPTED_JOB_KEY, convert_interrupted_job_to_json(broken_off(line=8))
        ).result(60)
    full = StoreErrorCause.FULL.make_error(tmp_path / "home" / "turndesk.db", "")
    monkeypatch.setattr("app.compose.runs.journal.RETRY_INTERVAL_S", 1e6)  # the test opens it
    with monkeypatch.context() as disk:
        disk.setattr("core.store.store.open_store_for_writing", raising(full))
        journal = Journal(tmp_path / "home")
    assert shows(journal.write_error, "desk.disk-full")
    yield journal
    journal.close()


def raising(error: StoreError) -> Callable[[object], NoReturn]:
    def refuse(_asked: object, *_args: object) -> NoReturn:
        raise error

    return refuse


def test_offsets_can_be_changed_when_the_store_becomes_available(away: Journal) -> None:
    book, parts = away.book(), away.create_parts_book()
    assert shows(
        book.change_fields(OffsetKind.TOOL, 3, {"x": 2.0}, "test"),
        "desk.offsets-not-kept",
        why=pattern("desk.disk-full"),
    )
    assert shows(parts.lock_reason, "desk.parts-not-kept", why=pattern("desk.disk-full"))
    away._reopen()
    assert book.poll_saving() == ""
    assert book.tool_offsets[3].x == 1.25
    assert book.changes == 1  # what is on the desk is proved anew
    assert book.change_fields(OffsetKind.TOOL, 3, {"x": 2.0}, "test") == ""
    away.save_version("a.nc", b"M30", "so that all is written")
    assert book.poll_saving() == ""
    assert book.tool_offsets[3].x == 2.0
    parts.update("")
    assert (parts.lock_reason, parts.store) == ("", book.store)
    parts.worker.close()


def test_unavailable_store_rejects_changes(away: Journal, monkeypatch: pytest.MonkeyPatch) -> None:
    book, parts = away.book(), away.create_parts_book()
    locked = StoreErrorCause.LOCKED.make_error(Path("turndesk.db"), "")
    monkeypatch.setattr("core.store.store.open_store_for_writing", raising(locked))
    away._reopen()
    assert book.poll_saving() == ""
    assert begins(book.lock_reason, "desk.offsets-not-kept", why=pattern("desk.locked", path="turndesk.db"))
    assert book.changes == 0
    parts.update("")
    assert begins(parts.lock_reason, "desk.parts-not-kept", why=pattern("desk.locked", path="turndesk.db"))
    parts.worker.close()


def test_interrupted_job_is_found_when_its_store_opens_late(away: Journal, tmp_path: Path) -> None:
    """The tool stands in that part, whatever the disk was at the start."""
    told: list[object] = []
    away.set_late_open_callback(lambda: told.append(away.left))
    assert (away.left, told) == (None, [])
    away._reopen()
    assert told == [broken_off(line=8)]
    away.set_late_open_callback(lambda: told.append("who asks later"))
    assert told[1:] == ["who asks later"]
    away.close()
    again = Journal(tmp_path / "home")
    assert again.left == broken_off(line=8)
    again.close()


def test_job_interrupted_meanwhile_overrides_the_one_in_a_late_store(away: Journal, tmp_path: Path) -> None:
    away.note(broken_off(line=3))
    away._reopen()
    assert away.left is None
    away.close()
    again = Journal(tmp_path / "home")
    assert again.left == broken_off(line=3)
    again.close()


# --- a store that opened at the start and could not be read ------------------------------------------------


def test_store_unreadable_at_startup_is_opened_by_a_later_retry(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first try had opened it: its lock must be free again, and what happened meanwhile is written."""
    with Store.open(tmp_path / "home") as store:
        store.settings.save_setting(
            INTERRUPTED_JOB_KEY, convert_interrupted_job_to_json(broken_off(line=8))
        ).result(60)
    locked = StoreErrorCause.LOCKED.make_error(tmp_path / "home" / "turndesk.db", "")
    monkeypatch.setattr("app.compose.runs.journal.RETRY_INTERVAL_S", 1e6)  # the test tries again
    with monkeypatch.context() as disk:
        disk.setattr(Store, "find_damaged_rows", raising(locked))
        journal = Journal(tmp_path / "home")
        assert shows(journal.write_error, "desk.locked")
        assert journal.waiting
        with pytest.raises(StoreError, match=pattern("desk.locked")):
            journal.require_store()
        journal.hear(LogEvent(0.0, "load", "/programs/pin.nc"))
        journal.hear(LogEvent(0.0, "part", "part 1"))
        journal._reopen()
        assert journal.waiting  # read as little as the first time
        assert journal.held == "1 part, 2 events"
    journal._reopen()
    assert (journal.write_error, journal.waiting, journal.held) == ("", False, "")
    assert journal.left == broken_off(line=8)
    journal.save_version("pin.nc", b"M30", "so that all is written")
    assert journal.runs.read_part_count("pin.nc") == 1
    journal.close()


@pytest.mark.parametrize("cause", [StoreErrorCause.FULL, StoreErrorCause.LOCKED])
def test_store_that_cannot_be_reopened_after_a_restore_is_opened_later(
    journal: Journal, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cause: StoreErrorCause
) -> None:
    journal.hear(LogEvent(0.0, "load", "/programs/pin.nc"))
    journal.backup(tmp_path / "copy.db")
    book = journal.book()
    monkeypatch.setattr("app.compose.runs.journal.RETRY_INTERVAL_S", 0.01)
    error = cause.make_error(tmp_path / "home" / STORE_FILE_NAME, "")
    with monkeypatch.context() as disk:
        disk.setattr("core.store.store.open_store_for_writing", raising(error))
        journal.restore(tmp_path / "copy.db")
        assert (journal.waiting, journal.write_error) == (True, str(error))
        journal.hear(LogEvent(0.0, "part", "part 1"))
        assert journal.held == "1 part, 1 event"
    assert journal._opener is not None
    journal._opener.join(60)
    assert (journal.write_error, journal.waiting, journal.held) == ("", False, "")
    journal.save_version("pin.nc", b"M30", "so that all is written")
    assert journal.runs.read_part_count("pin.nc") == 1
    assert book.poll_saving() == ""
    assert book.store is journal.require_store()


def test_store_damaged_by_a_restore_is_not_opened_again_and_again(
    journal: Journal, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal.backup(tmp_path / "copy.db")
    damaged = StoreErrorCause.DAMAGED.make_error(tmp_path / "home" / STORE_FILE_NAME, "a page is torn")
    with monkeypatch.context() as disk:
        disk.setattr("core.store.store.open_store_for_writing", raising(damaged))
        journal.restore(tmp_path / "copy.db")
        assert (journal.waiting, journal.write_error) == (False, str(damaged))
        with pytest.raises(StoreError, match=pattern("desk.damaged")):
            journal.require_store()


def test_a_store_too_damaged_to_be_read_is_left_to_a_restore(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    damaged = StoreErrorCause.DAMAGED.make_error(tmp_path / "home" / "turndesk.db", "a page is torn")
    with monkeypatch.context() as disk:
        disk.setattr(Store, "find_damaged_rows", raising(damaged))
        journal = Journal(tmp_path / "home")
    assert shows(journal.write_error, "desk.damaged")
    assert not journal.waiting  # no try will read it
    Store.open(tmp_path / "home").close()  # the command that restores finds it free
    journal.close()


def test_offsets_that_cannot_be_read_are_unknown_and_not_unset(tmp_path: Path) -> None:
    """Every tool was shown as not set."""
    home = tmp_path / "home"
    Store.open(home).close()
    whole = (home / STORE_FILE_NAME).read_bytes()
    (home / STORE_FILE_NAME).write_bytes(whole[:50])
    journal = Journal(home)
    book = journal.book()
    assert (book.has_read_failed, book.tool_offsets) == (True, {})
    assert describe_missing_offset(is_unreadable=book.has_read_failed) != describe_missing_offset()
    (home / STORE_FILE_NAME).write_bytes(whole)
    journal._reopen()
    book.poll_saving()
    assert not book.has_read_failed
    journal.close()


def test_offsets_of_a_machine_without_a_store_are_unset(tmp_path: Path) -> None:
    (tmp_path / "home").write_bytes(b"no folder")
    journal = Journal(tmp_path / "home")
    assert not journal.book().has_read_failed
    journal.close()


def test_unsaved_change_in_a_second_instance_names_the_first(tmp_path: Path) -> None:
    """It said that there was no room."""
    first = Journal(tmp_path / "home")
    second = Journal(tmp_path / "home")
    assert f"process {os.getpid()}" in second.write_error
    assert (second.waiting, second.held) == (False, "")
    second.close()
    first.close()


def test_a_second_instance_shows_the_offsets_of_the_first(tmp_path: Path) -> None:
    """It showed every tool as not set."""
    first = Journal(tmp_path / "home")
    first.require_store().offsets.tool_offsets.change_row(3, "test", {"x": -12.5}).result(60)
    second = Journal(tmp_path / "home")
    book = second.book()
    assert second.write_error
    assert book.lock_reason
    assert book.tool_offsets[3].x == -12.5
    assert book.change_fields(OffsetKind.TOOL, 3, {"x": 1.0}, "test") == book.lock_reason
    first.require_store().offsets.tool_offsets.change_row(3, "test", {"x": -13.0}).result(60)
    second._reopen()  # as its thread does every few seconds
    book.poll_saving()
    assert (book.tool_offsets[3].x, book.changes) == (-13.0, 1)
    second.close()
    first.close()
