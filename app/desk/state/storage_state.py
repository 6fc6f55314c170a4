"""Whether the desk's data and the loaded program are as they are on the disk."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(slots=True)
class StorageState:
    """State of the store and of the program file. Without a store, nothing is unsaved."""

    _problem: Callable[[], str] = str
    _waiting: Callable[[], str] = str
    _difference: Callable[[], str] = str
    _recheck_file: Callable[[], None] = lambda: None
    _restoring: bool = False

    def follow_store(self, problem: Callable[[], str] = str, waiting: Callable[[], str] = str) -> None:
        """Use the reports of a store; see ``problem`` and ``waiting``."""
        self._problem, self._waiting = problem, waiting

    def follow_program(self, difference: Callable[[], str], recheck: Callable[[], None]) -> None:
        """Use the reports of a monitor of the program file; see ``difference`` and ``recheck_file``."""
        self._difference, self._recheck_file = difference, recheck

    def problem(self) -> str:
        """Return why events, parts and versions are not saved; empty if they are."""
        return self._problem()

    def waiting(self) -> str:
        """Return what waits in memory to be saved, in words; empty if nothing waits."""
        return self._waiting()

    def difference(self) -> str:
        """Return how the program file differs from the loaded program; empty if it does not."""
        return self._difference()

    def recheck_file(self) -> None:
        """Compare the program file again soon: the editor has written it."""
        self._recheck_file()

    @property
    def restoring(self) -> bool:
        """Whether a backup is replacing the data."""
        return self._restoring

    def begin_restore(self) -> None:
        """Bar starts while a backup replaces the data."""
        self._restoring = True

    def end_restore(self) -> None:
        """Allow starts again after a restore, successful or not."""
        self._restoring = False
