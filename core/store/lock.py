"""One process writes a store. The kernel gives the lock back when that process ends, however it ends."""

from __future__ import annotations

import fcntl
import os
from contextlib import suppress
from pathlib import Path

from core.store.causes import why
from core.store.errors import StoreError


class WriterLock:
    """The advisory lock beside the store, held from construction to close. Raises StoreError when taken."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / "turndesk.lock"
        try:
            self._file = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o644)
        except OSError as error:
            raise why(self._path, error) from error
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            owner = os.read(self._file, 32).decode("ascii", "replace").strip()
            os.close(self._file)
            who = f" (process {owner})" if owner else ""
            raise StoreError(
                f"the store in {folder} is in use by another TurnDesk{who}; close that one, or enter it there"
            ) from error
        with suppress(OSError):  # a courtesy to whoever finds it taken; a full disk has no room for it
            os.ftruncate(self._file, 0)
            os.pwrite(self._file, f"{os.getpid()}\n".encode("ascii"), 0)

    def close(self) -> None:
        """Give the store free. Calling it again does nothing."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1
