"""G54 to G59 as the screen sees them: the present values, and changes that are saved without waiting."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.offsets.book import SAVING, Waiting
from core.store.errors import StoreError
from core.store.zero import ZeroChange, ZeroRow

if TYPE_CHECKING:
    from core.store.store import Store

NONE_KEPT = "NO ZERO OFFSETS ARE KEPT HERE"


@dataclass(slots=True)
class ZeroBook:
    """Present settable offsets by code, mm and degrees, X a radius.

    Without ``store`` nothing can be changed, and ``locked`` says why. A change is posted to the store's
    writer and shown when it is on the disk; ``poll`` is called once a frame.
    """

    store: Store | None = None
    locked: str = ""
    rows: dict[int, ZeroRow] = field(default_factory=dict)
    changes: int = 0  # how many were saved
    _waiting: Waiting | None = None
    _reopened: tuple[Store | None, str] | None = None  # by another thread, for the next poll

    def __post_init__(self) -> None:
        self._read()

    @property
    def busy(self) -> bool:
        """Whether a change is on its way to the disk."""
        return self._waiting is not None

    def change(self, code: int, values: Mapping[str, float], why: str) -> str:
        """Save some of x, z, c; the answer is why not, or nothing. So it is with the others below."""
        return self._post(lambda store: store.set_zero(code, why, values))

    def clear(self, why: str) -> str:
        """All of them at once."""
        return self._post(lambda store: store.clear_zero(why))

    def undo(self) -> str:
        """Take the last change back."""
        return self._post(lambda store: store.undo_zero())

    def history(self, limit: int = 200) -> tuple[ZeroChange, ...]:
        """The last changes, newest first; none where there is no store to remember them."""
        return () if self.store is None else self.store.zero_history(limit)

    def reopen(self, store: Store | None, trouble: str) -> None:
        """Another store is in the place of the one before; None: ``trouble`` says why. From any thread."""
        self._reopened = store, trouble

    def poll(self) -> str:
        """Look whether the change is on the disk; the answer is what went wrong, or nothing."""
        if self._reopened is not None:
            (self.store, trouble), self._reopened, self._waiting = self._reopened, None, None
            self.locked = "" if self.store is not None else f"OFFSETS CANNOT BE KEPT: {trouble}"
            self.changes += 1
            return self._read_or_why()
        waiting = self._waiting
        if waiting is None or not waiting.done():
            return ""
        self._waiting = None
        error = waiting.exception()
        if error is None:
            self.changes += 1
        return self._read_or_why() or (str(error) if error is not None else "")

    def _post(self, write: Callable[[Store], Waiting]) -> str:
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
        """The values of the store; it answers at once, also while it is being written."""
        if self.store is not None:
            self.rows = self.store.zero_offsets()
