"""A backup of all that is kept, once a day: verified, rotated, where the machine file says. No Qt.

It waits for a standstill, but not for longer than half a day.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import date, datetime, timedelta
from pathlib import Path

from app.desk.repeating_thread import RepeatingThread
from core.store.store_errors import StoreError

ENDING = ".turndesk.db"
DAILY = "daily-"
_DAY = timedelta(hours=24)
_PATIENCE = timedelta(hours=12)
_FIRST_LOOK, _LOOK = 60.0, 600.0  # s


@dataclass(slots=True)
class DailyBackup:
    """``copy`` writes a backup, ``check`` tells what is wrong in one; ``still``: whether nothing runs."""

    folder: Path
    keep: int
    copy: Callable[[Path], None]
    check: Callable[[Path], tuple[str, ...]]
    still: Callable[[], bool]
    tell: Callable[[str], None]
    now: Callable[[], datetime] = datetime.now
    _told: tuple[str, date] | None = None
    _thread: RepeatingThread = field(init=False)

    def __post_init__(self) -> None:
        self._thread = RepeatingThread("daily-backup", self.look, _LOOK, _FIRST_LOOK)

    def start(self) -> None:
        """Once."""
        self._thread.start()

    def close(self) -> None:
        """A backup that is under way is finished."""
        self._thread.close()

    def look(self) -> Path | None:
        """Make the backup of the day where it is due; answers it. What is in the way is told once a day."""
        try:
            age = self._age()
            if age is not None and (age < _DAY or (age < _DAY + _PATIENCE and not self.still())):
                return None
            made = self._made()
        except (OSError, StoreError) as error:
            self._trouble(getattr(error, "strerror", None) or str(error))
            return None
        self._told = None
        return made

    def _age(self) -> timedelta | None:
        """Of the newest; None: there is none. A backup of the future, by a clock set back, counts as none."""
        newest = max(self._there(), key=lambda path: path.name, default=None)
        if newest is None:
            return None
        age = self.now() - datetime.fromtimestamp(newest.stat().st_mtime)
        return age if age >= timedelta() else None

    def _there(self) -> list[Path]:
        return list(self.folder.glob(f"{DAILY}*{ENDING}"))

    def _made(self) -> Path:
        """Raises OSError or StoreError; what is no good leaves no file, and the older ones stay."""
        self.folder.mkdir(parents=True, exist_ok=True)
        target = self.folder / f"{DAILY}{self.now():%Y-%m-%d-%H%M%S}{ENDING}"
        self.copy(target)
        wrong = self.check(target)
        if wrong:
            target.unlink(missing_ok=True)
            raise StoreError(f"it was written, but {wrong[0]}; look at the disk of {self.folder}")
        for old in sorted(self._there(), key=lambda path: path.name)[: -self.keep]:
            old.unlink(missing_ok=True)
        return target

    def _trouble(self, why: str) -> None:
        now = why, self.now().date()
        if now != self._told:
            self.tell(f"{self.folder}: {why}")
        self._told = now
