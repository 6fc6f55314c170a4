"""The desk put together: which offsets it starts with, which machines it takes, that it ends."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from app.compose.machine.machine_setup import read_machine
from app.compose.runs.journal import Journal
from app.compose.screen_desk import build_desk
from app.compose.stored_offsets import (
    NO_OFFSETS,
    create_offset_book,
    make_offsets_reader,
    read_stored_offsets,
)
from app.desk.command_errors import CommandError
from core.executor.snapshot import LogEvent
from core.interpreter.shared.job_setup import SecondaryOffset
from core.language.source import ProgramSource
from core.store.store import Store
from core.store.store_rows import OffsetKind
from tests.texts import shows


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    return tmp_path / "home"


SHIPPED = Path(__file__).parents[2] / "resources" / "machines" / "gt75.toml"


def test_offsets_file_replaces_store() -> None:
    tools, secondary, *_ = make_offsets_reader(str(SHIPPED.parents[1] / "programs" / "offsets.toml"))()
    assert sorted(tools) == [1, 2, 3, 4, 6, 7, 8, 20]
    assert tools[1].z == pytest.approx(-3.0 * 25.4)
    assert secondary == {}


def test_store_is_read_again_each_time_without_offsets_file(home: Path) -> None:
    offsets = make_offsets_reader(None)
    assert offsets() == NO_OFFSETS
    with Store.open(home) as store:
        store.offsets.tool_offsets.change_row(7, values={"x": 1.0, "z": 2.0}, why="touched off").result(60)
    assert sorted(offsets()[0]) == [7]


def test_part_counts_and_events_are_saved(home: Path) -> None:
    journal = Journal(home)
    journal.keep(ProgramSource("part.nc", "G90\nM30\n"))
    for kind, text in (
        ("load", "part.nc"),
        ("start", "part.nc"),
        ("part", "part 1, 3 s"),
        ("part", "part 2"),
    ):
        journal.hear(LogEvent(1.0, kind, text))
    journal.close()
    with Store.open(home, read_only=True) as store:
        assert store.programs.load_version("part.nc") == b"G90\nM30\n"
        assert store.runs.read_part_count("part.nc") == 2
        assert [event.kind for event in store.events.read_events()].count("part") == 2


def test_unreadable_store_is_reported_and_left_unchanged(home: Path) -> None:
    Store.open(home).close()
    (file,) = home.glob("*.db")
    file.write_bytes(b"not a database" * 100)
    journal = Journal(home)
    journal.hear(LogEvent(1.0, "part", "part 1"))
    journal.close()
    assert str(file) in journal.write_error
    assert file.read_bytes() == b"not a database" * 100


def test_offsets_written_by_journal_are_read_at_next_loading(home: Path) -> None:
    journal = Journal(home)
    book = create_offset_book(read_stored_offsets, journal)
    assert book.change_fields(OffsetKind.SECONDARY, 4, {"x": 0.1, "z": -0.2, "r": 0.4}, "X .2") == ""
    journal.close()  # writes what is queued
    assert read_stored_offsets()[1] == {4: SecondaryOffset(0.1, -0.2, 0.4)}


def test_offsets_of_a_file_are_shown_and_not_changed(home: Path) -> None:
    journal = Journal(home)
    file = str(SHIPPED.parents[1] / "programs" / "offsets.toml")
    book = create_offset_book(make_offsets_reader(file), journal)
    assert sorted(book.tool_offsets) == [1, 2, 3, 4, 6, 7, 8, 20]
    assert shows(book.change_fields(OffsetKind.TOOL, 1, {"x": 1.0}, "try"), "screen.offsets-read-only")
    assert shows(book.clear_table(OffsetKind.SECONDARY, "C"), "screen.offsets-read-only")
    assert shows(book.undo_step(OffsetKind.TOOL, 1, 1), "screen.offsets-read-only")
    assert book.read_history(OffsetKind.TOOL) == ()
    journal.close()
    assert read_stored_offsets() == NO_OFFSETS


def test_offset_change_without_store_returns_reason(home: Path) -> None:
    Store.open(home).close()
    (file,) = home.glob("*.db")
    file.write_bytes(b"not a database" * 100)
    journal = Journal(home)
    assert str(file) in journal.book().change_fields(OffsetKind.TOOL, 1, {"x": 1.0}, "try")
    journal.close()


def test_machine_with_real_backend_is_rejected(tmp_path: Path) -> None:
    file = tmp_path / "real.toml"
    file.write_text(SHIPPED.read_text().replace('backend = "sim"', 'backend = "canopen"'))
    with pytest.raises(CommandError, match=r"canopen"):
        build_desk(str(file))


def test_missing_machine_file_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(CommandError, match=r"nothing\.toml"):
        build_desk(str(tmp_path / "nothing.toml"))


def test_close_ends_all_threads() -> None:
    desk = build_desk()
    names = ("control", "loading", "executor")
    assert any(thread.name.startswith(names) for thread in threading.enumerate())
    desk.close()
    assert not any(thread.name.startswith(names) for thread in threading.enumerate())


def test_close_ends_executor_thread() -> None:
    desk = build_desk(begun_control=(read_machine(None), None))
    assert any(thread.name == "executor" for thread in threading.enumerate())
    desk.close()
    assert not any(thread.name == "executor" for thread in threading.enumerate())
