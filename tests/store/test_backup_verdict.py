"""What the list of backups says of each: whole or not, and what a restore would change."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from core.store import backup, store_connection
from core.store.backup import BackupCheckResult, check_backup
from core.store.store import Store
from core.store.store_errors import StoreError
from tests.coded import raises_code


def judged(folder: Path, path: Path) -> BackupCheckResult:
    with closing(store_connection.connect_store(folder / "turndesk.db", is_read_only=True)) as now:
        return check_backup(now, path)


@pytest.fixture
def kept(store: Store, folder: Path, tmp_path: Path) -> Path:
    """A backup of two tools, a correction, two programs and a setting."""
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0, "z": 0.0})
    store.offsets.tool_offsets.change_row(2, "x", {"x": 2.0, "z": 0.0})
    store.offsets.secondary_offsets.change_row(4, "x", {"x": -0.01})
    store.programs.save_version("pin.nc", b"M30\n", "saved")
    store.programs.save_version("bush.nc", b"M30\n", "saved")
    store.runs.add_parts("pin.nc")
    store.settings.save_setting("preset", 1).result()
    backup.back_up_store(folder, tmp_path / "b.db")
    return tmp_path / "b.db"


def test_identical_backup_has_no_problem_or_difference(folder: Path, kept: Path) -> None:
    assert judged(folder, kept) == BackupCheckResult()


def test_changed_missing_and_new_entries_are_counted(store: Store, folder: Path, kept: Path) -> None:
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.5})  # other
    store.offsets.tool_offsets.remove_row(2, "x")  # missing now
    store.offsets.tool_offsets.change_row(3, "x", {"x": 3.0, "z": 0.0})  # new since
    store.programs.save_version("pin.nc", b"G90\nM30\n", "saved")
    store.programs.save_version("new.nc", b"M30\n", "saved")
    store.runs.add_parts("pin.nc")
    store.settings.save_setting("preset", 2).result()
    differs = (("programs", 2), ("tool offsets", 3), ("part counts", 1), ("settings", 1))
    assert judged(folder, kept).difference_counts == differs


def test_value_restored_by_hand_is_not_a_difference(store: Store, folder: Path, kept: Path) -> None:
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.5})
    store.offsets.tool_offsets.change_row(1, "back", {"x": 1.0}).result()
    assert judged(folder, kept) == BackupCheckResult()


def test_damaged_backup_is_reported_and_not_compared(folder: Path, kept: Path) -> None:
    kept.write_bytes(kept.read_bytes().replace(b"M30\n", b"M31\n"))
    found = judged(folder, kept)
    assert found.first_problem == backup.find_store_problems(kept)[0]
    assert found.difference_counts == ()


@pytest.mark.parametrize("data", [b"", b"no database", bytes(5000)])
def test_file_that_is_not_a_backup_is_reported(
    data: bytes, store: Store, folder: Path, tmp_path: Path
) -> None:
    store.settings.save_setting("a", 1).result()
    (tmp_path / "b.db").write_bytes(data)
    assert str(tmp_path / "b.db") in judged(folder, tmp_path / "b.db").first_problem
    assert str(tmp_path / "gone.db") in judged(folder, tmp_path / "gone.db").first_problem
    with raises_code(StoreError, "not-a-database"):
        backup.find_store_problems(tmp_path / "b.db")
    with raises_code(StoreError, "not-found"):
        backup.find_store_problems(tmp_path / "gone.db")


def test_programs_of_older_backup_are_compared(folder: Path, kept: Path) -> None:
    with closing(sqlite3.connect(kept)) as connection:
        connection.execute("PRAGMA user_version = 10")
    assert judged(folder, kept) == BackupCheckResult(has_older_version=True)


def test_verdict_writes_nothing(folder: Path, kept: Path) -> None:
    before = kept.read_bytes()
    judged(folder, kept)
    assert kept.read_bytes() == before
    assert sorted(each.name for each in kept.parent.iterdir()) == ["b.db", "home"]
