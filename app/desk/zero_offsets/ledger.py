"""What the page of G54 to G59 remembers: the last change, the history, what was saved of late."""

from __future__ import annotations

from dataclasses import dataclass

from app.desk.desk import Desk
from app.desk.words import tr
from app.desk.zero_offsets.figures import told
from core.store.errors import StoreError
from core.store.zero import ZeroChange

_LOOKED_AT = 200  # changes


@dataclass(slots=True)
class ZeroLedger:
    """Of the offsets of this desk; looked at once a frame."""

    desk: Desk
    last: tuple[ZeroChange, ...] = ()
    looking_back: tuple[ZeroChange, ...] | None = None  # the history while it is shown
    _seen: int = 0

    def __post_init__(self) -> None:
        self._seen = self.desk.zero.changes

    @property
    def last_told(self) -> str:
        """The last change in one line; empty when nothing has changed here yet."""
        if len(self.last) == 1:
            _at, which, change, _why = told(self.last[0])
            return f"{which}   {change}"
        return tr("{count} offsets changed: F5 shows them").format(count=len(self.last)) if self.last else ""

    def look(self) -> None:
        """Once a frame: see what has been saved, and say it."""
        if self.desk.zero.changes == self._seen:
            return
        self._seen = self.desk.zero.changes
        changes = self._history()
        self.last = tuple(change for change in changes if change.step == changes[0].step)
        if self.looking_back is not None:
            self.looking_back = changes
        names = " ".join(f"G{change.code}" for change in reversed(self.last))
        back = bool(self.last) and self.last[0].undoes is not None
        self.desk.say((tr("{names} TAKEN BACK") if back else tr("{names} SAVED")).format(names=names))

    def toggle_history(self) -> None:
        """The history instead of the table, or the table again."""
        self.looking_back = None if self.looking_back is not None else self._history()

    def opened(self) -> None:
        """The page comes up: what was changed elsewhere is no news here."""
        self._seen, self.last = self.desk.zero.changes, ()

    def _history(self) -> tuple[ZeroChange, ...]:
        try:
            return self.desk.zero.history(_LOOKED_AT)
        except StoreError as error:
            self.desk.say(str(error))
            return ()
