"""The offsets as the screen sees them: the present values, and changes that are saved without waiting."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

from app.desk.offsets.figures import Triple
from core.store.errors import StoreError
from core.store.rows import Change, Kind

if TYPE_CHECKING:
    from core.store.store import Store


class Waiting(Protocol):
    """The answer of the store's writer, as far as a screen asks for it."""

    def done(self) -> bool: ...

    def exception(self) -> BaseException | None: ...


Write = Callable[[], Waiting]
NONE_KEPT = "NO OFFSETS ARE KEPT HERE"
SAVING = "STILL SAVING THE CHANGE BEFORE: PRESS RETURN AGAIN"


@dataclass(slots=True)
class OffsetBook:
    """Present offsets by kind and number, mm, X a radius.

    Without ``store`` nothing can be changed, and ``locked`` says why. A change is posted to the store's
    writer and shown when it is on the disk; ``poll`` is called once a frame.
    """

    store: Store | None = None
    locked: str = ""
    values: dict[Kind, dict[int, Triple]] = field(default_factory=lambda: {kind: {} for kind in Kind})
    changes: int = 0  # how many were saved
    _waiting: Waiting | None = None

    def __post_init__(self) -> None:
        self._read()

    @property
    def busy(self) -> bool:
        """Whether a change is on its way to the disk."""
        return self._waiting is not None

    def of(self, kind: Kind, number: int) -> Triple | None:
        """The offset of this number; None when it was never set."""
        return self.values[kind].get(number)

    def change(self, kind: Kind, number: int, new: Triple, why: str) -> str:
        """Save an offset; the answer is why not, or nothing."""
        store = self.store
        if store is None or self.busy:
            return self.locked or SAVING
        x, z, r = new
        if kind is Kind.TOOL:
            return self._post(lambda: store.set_tool(number, why, x=x, z=z, nose_radius=r))
        return self._post(lambda: store.set_secondary(number, why, x=x, z=z, r=r))

    def clear_secondary(self) -> str:
        """All secondary offsets at once; the answer is why not, or nothing."""
        store = self.store
        if store is None or self.busy:
            return self.locked or SAVING
        return self._post(lambda: store.clear_secondary("C: all offsets cleared"))

    def undo(self, kind: Kind) -> str:
        """Take the last change of this kind back; the answer is why not, or nothing."""
        store = self.store
        if store is None or self.busy:
            return self.locked or SAVING
        return self._post(lambda: store.undo_offset(kind=kind))

    def history(self, kind: Kind, limit: int = 200) -> tuple[Change, ...]:
        """The last changes, newest first; none where there is no store to remember them."""
        if self.store is None:
            return ()
        return self.store.history(kind, limit)

    def poll(self) -> str:
        """Look whether the change is on the disk; the answer is what went wrong, or nothing."""
        waiting = self._waiting
        if waiting is None or not waiting.done():
            return ""
        self._waiting = None
        error = waiting.exception()
        if error is None:
            self.changes += 1
        try:
            self._read()
        except StoreError as unread:
            return str(unread)
        return str(error) if error is not None else ""

    def _post(self, write: Write) -> str:
        try:
            self._waiting = write()
        except StoreError as error:
            return str(error)
        return ""

    def _read(self) -> None:
        """The values of the store; it answers at once, also while it is being written."""
        if self.store is not None:
            tools, secondary = self.store.tools(), self.store.secondary()
            self.values = {Kind.TOOL: {**tools}, Kind.SECONDARY: {**secondary}}
