"""Daily backup of the store, verified and rotated, in the folder that the machine file specifies.

The module does not use Qt. A backup waits at most 12 h until the machine is at rest. If the computer's
clock was set back, an existing backup may have a date in the future. Such a backup counts as the oldest
backup.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import date, datetime, timedelta
from functools import partial
from pathlib import Path

from app.desk.background_work import RepeatingThread
from core.message import Message
from core.store.store_errors import StoreError

BACKUP_SUFFIX = ".turndesk.db"
DAILY_PREFIX = "daily-"
_DAY = timedelta(hours=24)
_MAX_WAIT = timedelta(hours=12)
_FIRST_LOOK, _LOOK = 60.0, 600.0  # s


@dataclass(slots=True)
class DailyBackup:
    """Service that makes and verifies a backup each day and deletes old backups.

    - ``write_backup`` writes a backup, and ``verify_backup`` returns the defects of a backup file.
    - ``is_idle`` returns whether the machine is at rest.
    - ``data_folder`` is the folder of the original data, or None if the machine file does not specify
      a separate folder for backups.
    - ``report_same_disk`` is called if both folders are on the same disk.
    """

    folder: Path
    max_backups: int
    write_backup: Callable[[Path], None]
    verify_backup: Callable[[Path], tuple[str, ...]]
    is_idle: Callable[[], bool]
    report_error: Callable[[str], None]
    read_clock: Callable[[], datetime] = datetime.now
    data_folder: Path | None = None
    report_same_disk: Callable[[], None] = lambda: None
    _hinted: bool = False
    _told: tuple[str, date] | None = None
    _thread: RepeatingThread = field(init=False)

    def __post_init__(self) -> None:
        self._thread = RepeatingThread("daily-backup", self.make_backup_if_due, _LOOK, _FIRST_LOOK)

    def start(self) -> None:
        """Start the thread that makes the backups. Call this method only once."""
        self._thread.start()

    def close(self) -> None:
        """End the backup thread, after completing a backup in progress."""
        self._thread.close()

    def make_backup_if_due(self) -> Path | None:
        """Make the daily backup if it is due, and return its path, or None if no backup was made.

        An error is reported once per day.
        """
        try:
            age = self._find_age()
            if age is not None and (age < _DAY or (age < _DAY + _MAX_WAIT and not self.is_idle())):
                return None
            made = self._make_backup()
        except (OSError, StoreError) as error:
            self._trouble(getattr(error, "strerror", None) or str(error))
            return None
        self._told = None
        return made

    def _find_age(self) -> timedelta | None:
        """Return the age of the newest backup.

        The result is None if no backup exists, or if the newest backup has a date in the future because the
        clock was set back.
        """
        newest = max(self._there(), key=partial(_sort_key, self._name()), default=None)
        if newest is None:
            return None
        age = self.read_clock() - datetime.fromtimestamp(newest.stat().st_mtime)
        return age if age >= timedelta() else None

    def _there(self) -> list[Path]:
        return list(self.folder.glob(f"{DAILY_PREFIX}*{BACKUP_SUFFIX}"))

    def _name(self) -> str:
        return f"{DAILY_PREFIX}{self.read_clock():%Y-%m-%d-%H%M%S}{BACKUP_SUFFIX}"

    def _make_backup(self) -> Path:
        """Write and verify a backup, delete the oldest backups, and return the path of the new backup.

        A backup that fails verification is deleted, and the previous backups remain. Raises OSError if a
        file cannot be written, or StoreError if the backup fails.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        target = self.folder / self._name()
        self.write_backup(target)
        wrong = self.verify_backup(target)
        if wrong:
            target.unlink(missing_ok=True)
            raise StoreError(
                Message(
                    "the backup was written, but {wrong}; check the disk that holds {folder}",
                    wrong=wrong[0],
                    folder=self.folder,
                ),
                "damaged-backup",
            )
        for old in sorted(self._there(), key=partial(_sort_key, target.name))[: -self.max_backups]:
            old.unlink(missing_ok=True)
        self._check_disk()
        return target

    def _check_disk(self) -> None:
        """Report once if the backup folder is on the same disk as the data.

        One possible cause is that the backup disk is not mounted.
        """
        if self.data_folder is not None and not self._hinted:
            self._hinted = self.folder.stat().st_dev == self.data_folder.stat().st_dev
            if self._hinted:
                self.report_same_disk()

    def _trouble(self, why: str) -> None:
        now = why, self.read_clock().date()
        if now != self._told:
            self.report_error(Message("{folder}: {why}", folder=self.folder, why=why))
        self._told = now


def _sort_key(now: str, path: Path) -> tuple[bool, str]:
    """Return the key that sorts backups by age. ``now`` is the file name of a backup made now."""
    return path.name <= now, path.name
