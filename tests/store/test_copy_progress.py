"""Progress of a backup, a restore and a check: what is reported, and what is printed on a terminal."""

from __future__ import annotations

import sqlite3
import sys
from contextlib import closing
from pathlib import Path

import pytest

from app.cli.main import main
from app.cli.proofs import progress_bar
from core.store import backup
from core.store.store import Store, StoreError
from core.store.store_file import STORE_FILE_NAME
from tests.coded import raises_code

CHECK_COUNT = 31  # pages, references, program texts, 14 tables with values and 14 with a history


@pytest.fixture
def reports(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    monkeypatch.setattr(backup, "_PAGES_PER_STEP", 4)
    return []


def count_pages(path: Path) -> int:
    with closing(sqlite3.connect(path)) as connection:
        return int(connection.execute("PRAGMA page_count").fetchone()[0])


def test_backup_reports_each_step_up_to_all_pages(
    store: Store, folder: Path, tmp_path: Path, reports: list[tuple[int, int]]
) -> None:
    store.programs.save_version("PIN.nc", b"M30\r\n", "new")
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0}).result()
    pages = count_pages(folder / STORE_FILE_NAME)
    backup.back_up_store(folder, tmp_path / "b.db", lambda done, total: reports.append((done, total)))
    # Steps of 4 pages, and a last step with the rest.
    assert [done for done, _ in reports] == [*range(4, pages, 4), pages]
    assert {total for _, total in reports} == {pages}


def test_a_change_during_the_backup_does_not_restart_it(
    store: Store, folder: Path, tmp_path: Path, reports: list[tuple[int, int]]
) -> None:
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0}).result()

    def report(done: int, total: int) -> None:
        reports.append((done, total))
        store.offsets.tool_offsets.change_row(1, "later", {"x": float(len(reports) + 1)}).result()

    backup.back_up_store(folder, tmp_path / "b.db", report)
    assert [done for done, _ in reports] == sorted({done for done, _ in reports})
    backup.restore_store(tmp_path / "other", tmp_path / "b.db")
    with Store.open(tmp_path / "other") as other:
        assert other.offsets.tool_offsets.read_rows()[1].x == 1.0  # the value when the backup began


def test_restore_reports_all_pages_of_the_backup(
    store: Store, folder: Path, tmp_path: Path, reports: list[tuple[int, int]]
) -> None:
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0}).result()
    backup.back_up_store(folder, tmp_path / "b.db")
    pages = count_pages(tmp_path / "b.db")
    backup.restore_store(
        tmp_path / "other", tmp_path / "b.db", lambda done, total: reports.append((done, total))
    )
    assert reports[-1] == (pages, pages)


def test_a_rejected_backup_or_restore_reports_no_progress(
    store: Store, folder: Path, tmp_path: Path, reports: list[tuple[int, int]]
) -> None:
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0}).result()
    backup.back_up_store(folder, tmp_path / "b.db")

    def report(done: int, total: int) -> None:
        reports.append((done, total))

    with raises_code(StoreError, "no-store"):
        backup.back_up_store(tmp_path / "empty", tmp_path / "c.db", report)
    with raises_code(StoreError, "in-use"):
        backup.restore_store(folder, tmp_path / "b.db", report)
    (tmp_path / "bad.db").write_bytes(b"G90\r\n" * 100)
    with pytest.raises(StoreError):
        backup.restore_store(tmp_path / "other", tmp_path / "bad.db", report)
    assert reports == []


@pytest.mark.parametrize("is_terminal", [True, False])
def test_command_shows_the_total_only_on_a_terminal(
    is_terminal: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    reports: list[tuple[int, int]],
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "data"))
    with Store.open(tmp_path / "data") as store:
        store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0}).result()
    pages = count_pages(tmp_path / "data" / STORE_FILE_NAME)
    monkeypatch.setattr(progress_bar, "SHOW_DELAY_S", -1.0)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: is_terminal)
    for action, text in (("backup", "backing up to"), ("restore", "restoring")):
        assert main(["store", action, str(tmp_path / "b.db")]) == 0
        shown = capsys.readouterr().err
        assert (text in shown) is is_terminal
        assert (f"of {pages}" in shown) is is_terminal
    assert main(["store", "verify"]) == 0
    shown = capsys.readouterr().err
    assert ("verifying" in shown) is is_terminal
    assert (f"of {CHECK_COUNT}" in shown) is is_terminal


def test_check_of_the_store_reports_each_check(store: Store, folder: Path) -> None:
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0}).result()
    reports: list[tuple[int, int]] = []
    backup.find_all_store_problems(
        folder / STORE_FILE_NAME, lambda done, total: reports.append((done, total))
    )
    assert reports == [(number, CHECK_COUNT) for number in range(1, CHECK_COUNT + 1)]


def test_check_of_a_damaged_store_ends_before_the_histories(store: Store, folder: Path) -> None:
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0}).result()
    store.close()
    with closing(sqlite3.connect(folder / STORE_FILE_NAME)) as connection:
        connection.execute("UPDATE tool_offsets SET x = 2.0")
        connection.commit()
    reports: list[int] = []
    assert backup.find_all_store_problems(folder / STORE_FILE_NAME, lambda done, _: reports.append(done))
    assert reports == [*range(1, CHECK_COUNT - 14 + 1)]


@pytest.mark.parametrize("name", ["missing.db", "no-store.db"])
def test_check_that_cannot_start_reports_nothing(name: str, tmp_path: Path) -> None:
    (tmp_path / "no-store.db").write_bytes(b"G90\r\n" * 100)
    reports: list[int] = []
    with pytest.raises(StoreError):
        backup.find_all_store_problems(tmp_path / name, lambda done, _: reports.append(done))
    assert reports == []
