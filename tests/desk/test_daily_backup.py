"""The backup of the day: when it is due, verified, rotated; a disk that takes nothing loses no older one."""

from __future__ import annotations

import os
from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from app.desk.daily_backup import BACKUP_SUFFIX, DailyBackup
from core.store import backup
from core.store.store import Store
from core.store.store_errors import StoreError
from tests.store.disk import small_disk
from tests.texts import pattern, shows


class Days:
    """A clock on the wall that is set by hand, and what is told."""

    def __init__(self) -> None:
        self.now = datetime(2026, 11, 23, 6, 0)
        self.runs = False
        self.told: list[str] = []

    def daily(self, folder: Path, copy: Callable[[Path], None], keep: int = 3) -> DailyBackup:
        def stamped(target: Path) -> None:
            copy(target)
            at = self.now.timestamp()
            os.utime(target, (at, at))

        return DailyBackup(
            folder,
            keep,
            stamped,
            backup.find_store_problems,
            lambda: not self.runs,
            self.told.append,
            lambda: self.now,
        )


@pytest.fixture
def home(tmp_path: Path) -> Path:
    with Store.open(tmp_path / "home") as store:
        store.offsets.tool_offsets.change_row(3, "touched", {"x": 1.0, "z": 2.0}).result()
    return tmp_path / "home"


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_one_backup_a_day_is_made_and_the_newest_are_retained(home: Path, tmp_path: Path) -> None:
    days, folder = Days(), tmp_path / "nas" / "lathe3"
    daily = days.daily(folder, lambda target: backup.back_up_store(home, target))
    for _ in range(5 * 24):
        daily.make_backup_if_due()
        days.now += timedelta(hours=1)
    assert names(folder) == [f"daily-2026-11-{day}-060000{BACKUP_SUFFIX}" for day in (25, 26, 27)]
    assert days.told == []
    backup.restore_store(tmp_path / "other", folder / names(folder)[-1])
    with Store.open(tmp_path / "other") as store:
        assert store.offsets.tool_offsets.read_rows()[3].x == 1.0


def test_backup_waits_for_standstill_up_to_a_limit(home: Path, tmp_path: Path) -> None:
    days, folder = Days(), tmp_path / "b"
    daily = days.daily(folder, lambda target: backup.back_up_store(home, target))
    daily.make_backup_if_due()
    days.runs = True
    days.now += timedelta(hours=35)
    assert daily.make_backup_if_due() is None
    days.now += timedelta(hours=2)
    assert daily.make_backup_if_due() is not None


def test_clock_set_back_does_not_prevent_backups(home: Path, tmp_path: Path) -> None:
    days, folder = Days(), tmp_path / "b"
    daily = days.daily(folder, lambda target: backup.back_up_store(home, target))
    daily.make_backup_if_due()
    days.now -= timedelta(days=400)
    assert daily.make_backup_if_due() is not None


def test_failed_backup_is_reported_once_a_day_and_leaves_older_ones(home: Path, tmp_path: Path) -> None:
    days, folder = Days(), tmp_path / "b"

    def copy(target: Path) -> None:
        backup.back_up_store(home, target)
        if days.now.day > 23:
            with target.open("r+b") as file:
                file.seek(8192)
                file.write(b"\xff" * 4096)

    daily = days.daily(folder, copy)
    daily.make_backup_if_due()
    for _ in range(3):
        days.now += timedelta(hours=30)
        assert daily.make_backup_if_due() is None
    assert names(folder) == [f"daily-2026-11-23-060000{BACKUP_SUFFIX}"]
    assert len(days.told) == 3  # once a day
    assert shows(days.told[0], "desk.backup-damaged", what=pattern("desk.file-damaged"))
    daily.make_backup_if_due()
    assert len(days.told) == 3


def test_backup_folder_that_cannot_be_created_is_reported(home: Path, tmp_path: Path) -> None:
    days = Days()
    (tmp_path / "nas").write_text("a file")
    daily = days.daily(tmp_path / "nas" / "lathe3", lambda target: backup.back_up_store(home, target))
    assert daily.make_backup_if_due() is None
    assert "lathe3" in days.told[0]


def test_damaged_store_is_not_backed_up(tmp_path: Path) -> None:
    days = Days()

    def copy(_target: Path) -> None:
        raise StoreError("T3 is not as it was saved")

    daily = days.daily(tmp_path / "b", copy, keep=2)
    daily.make_backup_if_due()
    assert days.told == [f"{tmp_path / 'b'}: T3 is not as it was saved"]


def test_daily_backup_ends_when_turndesk_closes(home: Path, tmp_path: Path) -> None:
    daily = Days().daily(tmp_path / "b", lambda target: backup.back_up_store(home, target))
    daily.start()
    daily.close()
    assert not (tmp_path / "b").exists()  # the first look is a minute later


def test_todays_backup_is_retained_after_clock_reset(home: Path, tmp_path: Path) -> None:
    """What is dated later than now was made before the clock went back, and goes first."""
    days, folder = Days(), tmp_path / "b"
    daily = days.daily(folder, lambda target: backup.back_up_store(home, target))
    for _ in range(4):
        daily.make_backup_if_due()
        days.now += timedelta(days=1)
    days.now = datetime(2000, 1, 1, 6, 0)
    made = []
    for _ in range(3 * 24 * 6):
        made += [path for path in (daily.make_backup_if_due(),) if path is not None]
        days.now += timedelta(minutes=10)
    assert [path.name for path in made] == names(folder)
    assert names(folder) == [f"daily-2000-01-0{day}-060000{BACKUP_SUFFIX}" for day in (1, 2, 3)]
    days.now = datetime(2026, 11, 27, 6, 0)
    daily.make_backup_if_due()
    assert names(folder)[-1] == f"daily-2026-11-27-060000{BACKUP_SUFFIX}"
    assert len(names(folder)) == 3


def test_backup_folder_on_the_same_disk_is_reported_once(home: Path, tmp_path: Path) -> None:
    """A disk that is not mounted leaves its folder on this one: better such a backup than none."""
    days, hints = Days(), list[str]()
    daily = days.daily(tmp_path / "mnt" / "nas", lambda target: backup.back_up_store(home, target))
    daily.data_folder, daily.report_same_disk = home, lambda: hints.append("same disk")
    for _ in range(3):
        assert daily.make_backup_if_due() is not None
        days.now += timedelta(days=1)
    assert hints == ["same disk"]


def test_backup_folder_on_another_disk_gives_no_hint(home: Path, tmp_path: Path) -> None:
    days, hints = Days(), list[str]()
    with small_disk(tmp_path / "mnt") as disk:
        daily = days.daily(disk.path / "lathe3", lambda target: backup.back_up_store(home, target))
        daily.data_folder, daily.report_same_disk = home, lambda: hints.append("same disk")
        assert daily.make_backup_if_due() is not None
        assert hints == []
        disk.fill()
        days.now += timedelta(days=1)
        assert daily.make_backup_if_due() is None
        assert shows(days.told[0], "desk.disk-full")
        assert len(names(disk.path / "lathe3")) == 1
