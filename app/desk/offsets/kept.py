"""What every book of offsets has: a store behind it, and changes that are saved without waiting."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from core.store.errors import StoreError

if TYPE_CHECKING:
    from core.store.store import Store


class Waiting(Protocol):
    """The answer of the store's writer, as far as a screen asks for it."""

    def done(self) -> bool: ...

    def exception(self) -> BaseException | None: ...


Write = Callable[["Store"], Waiting]
SAVING = "STILL SAVING THE CHANGE BEFORE: PRESS RETURN AGAIN"


@dataclass(slots=True)
class KeptBook:
    """Without ``store`` nothing can be changed, and ``locked`` says why.

    A change is posted to the store's writer and shown when it is on the disk; ``poll`` is called once a
    frame.
    """

    store: Store | None = None
    locked: str = ""
    changes: int = 0  # how many were saved
    _waiting: Waiting | None = None
    _reopened: tuple[Store | None, str] | None = None  # by another thread, for the next poll

    def __post_init__(self) -> None:
        self._read()

    @property
    def busy(self) -> bool:
        """Whether a change is on its way to the disk."""
        return self._waiting is not None

    def reopen(self, store: Store | None, trouble: str) -> None:
        """Another store is in the place of the one before; None: ``trouble`` says why. From any thread."""
        self._reopened = store, trouble

    def poll(self) -> str:
        """Look whether the change is on the disk; the answer is what went wrong, or nothing."""
        if self._reopened is not None:
            return self._turn_to(*self._reopened)
        waiting = self._waiting
        if waiting is None or not waiting.done():
            return ""
        self._waiting = None
        error = waiting.exception()
        if error is None:
            self.changes += 1
        return self._read_or_why() or (str(error) if error is not None else "")

    def _turn_to(self, store: Store | None, trouble: str) -> str:
        self._reopened, self._waiting = None, None
        self.store = store
        self.locked = "" if store is not None else f"OFFSETS CANNOT BE KEPT: {trouble}"
        self.changes += 1
        return self._read_or_why()

    def _post(self, write: Write) -> str:
        if self.store is None or self.busy:
            return self.locked or SAVING
        try:
            self._waiting = write(self.store)
        except StoreError as error:
            return str(error)
        return ""

    def _read_or_why(self) -> str:
        try:
            self._read()
        except StoreError as error:
            return str(error)
        return ""

    def _read(self) -> None:
        """Take the values of the store; it answers at once, also while it is being written."""
        raise NotImplementedError
