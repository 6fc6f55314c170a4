"""The offsets as the screen sees them: the present values, and changes that are saved without waiting."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

from core.interpreter.job_setup import SecondaryOffset, ToolOffset
from core.store.store_errors import StoreError
from core.store.store_rows import Change, Kind, Row, SecondaryRow, ToolRow, Value
from core.store.touch_off import Touch
from core.store.zero_offset_table import ZeroChange, ZeroRow

if TYPE_CHECKING:
    from core.store.store import Store

# --- What every book of offsets has: a store behind it, and changes that are saved without waiting.


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


NONE_KEPT = "NO OFFSETS ARE KEPT HERE"


@dataclass(slots=True)
class OffsetBook(KeptBook):
    """Present offsets by number, mm, X a radius."""

    tools: dict[int, ToolRow] = field(default_factory=dict)
    secondary: dict[int, SecondaryRow] = field(default_factory=dict)

    @property
    def master(self) -> int:
        """The tool that the others are relative to; 0: none."""
        return next((number for number, row in self.tools.items() if row.master), 0)

    def of(self, kind: Kind, number: int) -> Row | None:
        """The offset of this number; None when it was never set."""
        return self.tools.get(number) if kind is Kind.TOOL else self.secondary.get(number)

    def change(self, kind: Kind, number: int, values: Mapping[str, Value], why: str) -> str:
        """Save fields of an offset; the answer is why not, or nothing. So it is with the others below."""
        return self._post(lambda store: store.set_offset(kind, number, why, values))

    def touch_off(self, number: int, touch: Touch, why: str) -> str:
        """Set a tool by what it touched; with the master all others follow."""
        return self._post(lambda store: store.touch_off(number, touch, why))

    def choose_master(self, number: int, why: str) -> str:
        """Another master, 0: none."""
        return self._post(lambda store: store.choose_master(number, why))

    def clear_secondary(self) -> str:
        """All secondary offsets at once."""
        return self._post(lambda store: store.clear_secondary("C: all offsets cleared"))

    def undo(self, kind: Kind) -> str:
        """Take the last change of this kind back."""
        return self._post(lambda store: store.undo_offset(kind=kind))

    def history(self, kind: Kind, limit: int = 200) -> tuple[Change, ...]:
        """The last changes, newest first; none where there is no store to remember them."""
        if self.store is None:
            return ()
        return self.store.history(kind, limit)

    def _read(self) -> None:
        if self.store is not None:
            self.tools, self.secondary = self.store.tools(), self.store.secondary()


# --- G54 to G59 as the screen sees them: the present values, and changes that are saved without waiting.


NO_ZEROS_KEPT = "NO ZERO OFFSETS ARE KEPT HERE"


@dataclass(slots=True)
class ZeroBook(KeptBook):
    """Present settable offsets by code, mm and degrees, X a radius."""

    rows: dict[int, ZeroRow] = field(default_factory=dict)

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

    def _read(self) -> None:
        if self.store is not None:
            self.rows = self.store.zero_offsets()


# --- From the rows of the store to what the interpreter counts with.


def tool_offsets(rows: Mapping[int, ToolRow]) -> dict[int, ToolOffset]:
    """Of the tools: geometry and wear together."""
    return {n: ToolOffset(*row.offset, row.nose_radius) for n, row in rows.items()}


def secondary_offsets(rows: Mapping[int, SecondaryRow]) -> dict[int, SecondaryOffset]:
    """Of the secondary offsets."""
    return {n: SecondaryOffset(*row) for n, row in rows.items()}
