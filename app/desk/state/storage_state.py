"""State of the data store and of the loaded program's file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(slots=True)
class StorageState:
    """State of the data store and of the loaded program's file.

    Without a store, no data count as unsaved.
    """

    _problem: Callable[[], str] = str
    _waiting: Callable[[], str] = str
    _difference: Callable[[], str] = str
    _recheck_file: Callable[[], None] = lambda: None
    _can_reload: Callable[[], bool] = bool
    _restoring: bool = False

    def set_store_readers(
        self, read_problem: Callable[[], str] = str, read_unsaved: Callable[[], str] = str
    ) -> None:
        """Set the functions that read the storage problem and the description of the unsaved data.

        ``read_storage_problem`` and ``read_unsaved_text`` call these functions.
        """
        self._problem, self._waiting = read_problem, read_unsaved

    def set_file_readers(
        self,
        read_difference: Callable[[], str],
        recheck_file: Callable[[], None],
        can_reload: Callable[[], bool] = bool,
    ) -> None:
        """Set the functions of the program file monitor.

        ``describe_file_difference``, ``recheck_file`` and ``can_reload_file`` call these functions.
        """
        self._difference, self._recheck_file, self._can_reload = read_difference, recheck_file, can_reload

    def read_storage_problem(self) -> str:
        """Return why events, parts and versions cannot be saved, or an empty string if they can be saved."""
        return self._problem()

    def read_unsaved_text(self) -> str:
        """Return a description of the data that wait in memory to be saved.

        The result is an empty string if no data are waiting.
        """
        return self._waiting()

    def describe_file_difference(self) -> str:
        """Return how the program file differs from the loaded program, or else an empty string."""
        return self._difference()

    def can_reload_file(self) -> bool:
        """Return whether the program file has changed and can be loaded again."""
        return self._can_reload()

    def recheck_file(self) -> None:
        """Request a new comparison of the program file after the editor has written the file."""
        self._recheck_file()

    @property
    def is_restoring(self) -> bool:
        """Return whether a restore of a backup is in progress."""
        return self._restoring

    def begin_restore(self) -> None:
        """Prevent starts while a backup replaces the stored data."""
        self._restoring = True

    def end_restore(self) -> None:
        """Permit starts again after a restore, successful or not."""
        self._restoring = False
