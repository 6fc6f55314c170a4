"""The offsets as the screen sees them: the present values, and changes that are saved without waiting."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.desk.offsets.kept import KeptBook
from core.store.rows import Change, Kind, Row, SecondaryRow, ToolRow, Value
from core.store.toolset import Touch

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
