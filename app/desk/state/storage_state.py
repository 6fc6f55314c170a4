"""State of the data store and of the loaded program's file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(slots=True)
class StorageState:
    """State of the data store and the program file. Without a store, no data count as unsaved."""

    _problem: Callable[[], str] = str
    _waiting: Callable[[], str] = str
    _difference: Callable[[], str] = str
    _recheck_file: Callable[[], None] = lambda: None
    _restoring: bool = False

    def set_store_readers(
        self, read_problem: Callable[[], str] = str, read_unsaved: Callable[[], str] = str
    ) -> None:
        """Set the functions that ``read_problem`` and ``read_unsaved`` call to read the state of a store."""
        self._problem, self._waiting = read_problem, read_unsaved

    def set_file_readers(self, read_difference: Callable[[], str], recheck_file: Callable[[], None]) -> None:
        """Set the functions of the program file monitor.

        ``describe_file_difference`` and ``recheck_file`` call these functions.
        """
        self._difference, self._recheck_file = read_difference, recheck_file

    def read_storage_problem(self) -> str:
        """Return the reason why events, parts and versions are not saved, or an empty string if they are."""
        return self._problem()

    def read_unsaved_text(self) -> str:
        """Return a description of the data that wait in memory to be saved.

        The result is an empty string if no data are waiting.
        """
        return self._waiting()

    def describe_file_difference(self) -> str:
        """Return how the program file differs from the loaded program, or an empty string if equal."""
        return self._difference()

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
