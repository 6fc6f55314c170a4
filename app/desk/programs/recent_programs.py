"""List of the programs that were loaded last, including programs outside the program folders."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.desk.persistence import Persistence
from core.store.store_errors import StoreError

RECENT_PROGRAMS_SETTING = "recent_programs"  # Setting with the paths, newest first.
MAX_RECENT_PROGRAMS = 10


class RecentPrograms:
    """Paths of the programs that were loaded last, newest first. The store saves them for the next start.

    ``try_save`` calls a function and shows a message if it raises StoreError.
    """

    def __init__(self, persistence: Persistence, try_save: Callable[[Callable[[], None]], None]) -> None:
        self._persistence, self._try_save = persistence, try_save
        self._paths: tuple[Path, ...] | None = None  # None: not yet read.

    @property
    def paths(self) -> tuple[Path, ...]:
        """Return the paths, newest first. Invalid stored values are ignored.

        The result is empty while the store cannot be read.
        """
        if self._paths is None:
            self._paths = self._read()
        return self._paths or ()

    def add(self, path_text: str) -> None:
        """Put a program at the top of the list, and drop the oldest program of a list that is too long.

        A list that cannot be read is not changed, so that its stored programs are not lost.
        """
        path, paths = Path(path_text).absolute(), self.paths
        if self._paths is not None:
            self._save((path, *(each for each in paths if each != path))[:MAX_RECENT_PROGRAMS])

    def remove(self, path: Path) -> None:
        """Remove a program from the list. Its file is not changed."""
        self._save(tuple(each for each in self.paths if each != path))

    def _read(self) -> tuple[Path, ...] | None:
        try:
            stored = self._persistence.read_setting(RECENT_PROGRAMS_SETTING)
        except StoreError:
            return None
        texts = stored if isinstance(stored, list) else []
        found = (Path(text) for text in texts if isinstance(text, str) and "\0" not in text)
        return tuple(dict.fromkeys(path for path in found if path.is_absolute()))[:MAX_RECENT_PROGRAMS]

    def _save(self, paths: tuple[Path, ...]) -> None:
        self._paths = paths
        texts = [str(path) for path in paths]
        self._try_save(lambda: self._persistence.save_setting(RECENT_PROGRAMS_SETTING, texts))
