"""A backup of all that is kept, once a day: verified, rotated, where the machine file says. No Qt.

It waits for a standstill, but not for longer than half a day. The clock on the wall may be wrong: what is
dated later than now was made before it was set back, and is older than anything else.
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

ENDING = ".turndesk.db"
DAILY = "daily-"
_DAY = timedelta(hours=24)
_PATIENCE = timedelta(hours=12)
_FIRST_LOOK, _LOOK = 60.0, 600.0  # s


@dataclass(slots=True)
class DailyBackup:
    """``copy`` writes a backup, ``check`` tells what is wrong in one; ``still``: whether nothing runs.

    ``apart``: what is backed up, where the machine file names another place; ``hint`` is told when that lies
    on the same disk.
    """

    folder: Path
    keep: int
    copy: Callable[[Path], None]
    check: Callable[[Path], tuple[str, ...]]
    still: Callable[[], bool]
    tell: Callable[[str], None]
    now: Callable[[], datetime] = datetime.now
    apart: Path | None = None
    hint: Callable[[], None] = lambda: None
    _hinted: bool = False
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
        newest = max(self._there(), key=partial(_made_at, self._name()), default=None)
        if newest is None:
            return None
        age = self.now() - datetime.fromtimestamp(newest.stat().st_mtime)
        return age if age >= timedelta() else None

    def _there(self) -> list[Path]:
        return list(self.folder.glob(f"{DAILY}*{ENDING}"))

    def _name(self) -> str:
        return f"{DAILY}{self.now():%Y-%m-%d-%H%M%S}{ENDING}"

    def _made(self) -> Path:
        """Raises OSError or StoreError; what is no good leaves no file, and the older ones stay."""
        self.folder.mkdir(parents=True, exist_ok=True)
        target = self.folder / self._name()
        self.copy(target)
        wrong = self.check(target)
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
        for old in sorted(self._there(), key=partial(_made_at, target.name))[: -self.keep]:
            old.unlink(missing_ok=True)
        self._look_at_the_disk()
        return target

    def _look_at_the_disk(self) -> None:
        """Say once that another place is none: a disk that is not mounted leaves its folder on this one."""
        if self.apart is not None and not self._hinted:
            self._hinted = self.folder.stat().st_dev == self.apart.stat().st_dev
            if self._hinted:
                self.hint()

    def _trouble(self, why: str) -> None:
        now = why, self.now().date()
        if now != self._told:
            self.tell(Message("{folder}: {why}", folder=self.folder, why=why))
        self._told = now


def _made_at(now: str, path: Path) -> tuple[bool, str]:
    """The order in which backups were made, by their names and that of one made now."""
    return path.name <= now, path.name
