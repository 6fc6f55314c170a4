"""G54 to G59 as the screen sees them: the present values, and changes that are saved without waiting."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.desk.offsets.kept import KeptBook
from core.store.zero import ZeroChange, ZeroRow

NONE_KEPT = "NO ZERO OFFSETS ARE KEPT HERE"


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
