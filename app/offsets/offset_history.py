"""What one table of offsets remembers: the last change, the history, and the way back."""

from __future__ import annotations

from dataclasses import dataclass, field
from datetime import datetime

from app.desk.desk import Desk
from app.desk.translation import tr
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_changes import counts_later
from app.offsets.offset_values import Mode, in_words, shown_value, word, zero_change_in_words
from core.executor.snapshot import Snapshot
from core.store.store_errors import StoreError
from core.store.store_rows import Change, Kind, Row, ToolRow
from core.store.zero_offset_table import ZeroChange

# --- A change of the history in words.


def change_in_words(change: Change, letter: str, mode: Mode) -> tuple[str, str, str, str]:
    """Of one change: when (local time), which offset, from → to, why and by whom."""
    at = datetime.fromisoformat(change.at).astimezone().strftime("%Y-%m-%d %H:%M:%S")
    who = "" if change.who == "operator" else f" ({change.who})"
    return at, f"{letter}{change.number}", from_to(change.old, change.new, mode), f"{change.why}{who}"


def from_to(old: Row | None, new: Row | None, mode: Mode) -> str:
    """An offset before and after; of a tool that was and stays set only the fields that changed."""
    if isinstance(old, ToolRow) and isinstance(new, ToolRow):
        pairs = [
            f"{word(name)} {_shown(name, old, mode)} → {_shown(name, new, mode)}"
            for name in ToolRow._fields
            if getattr(old, name) != getattr(new, name)
        ]
        return "   ".join(pairs)
    return f"{in_words(old, mode)}  →  {in_words(new, mode)}"


def _shown(name: str, row: ToolRow, mode: Mode) -> str:
    if name == "master":
        return tr("yes") if row.master else tr("no")
    return shown_value(name, getattr(row, name), mode) or tr("none")


LOOKED_AT = 200  # changes


@dataclass(slots=True)
class Ledger:
    """Of the table ``kind``; every page that changes it looks once a frame."""

    desk: Desk
    book: OffsetBook
    kind: Kind
    mode: Mode = field(default_factory=Mode)
    last: tuple[Change, ...] = ()
    looking_back: tuple[Change, ...] | None = None  # the history while it is shown
    _seen: int = 0

    def __post_init__(self) -> None:
        self._seen = self.book.changes

    @property
    def letter(self) -> str:
        """T or D."""
        return "T" if self.kind is Kind.TOOL else "D"

    def look(self, snapshot: Snapshot) -> bool:
        """Follow the control's unit; True when something was saved since the last look, and say it."""
        self.mode = Mode(snapshot.modal.metric, snapshot.modal.diameter)
        if self.book.changes == self._seen:
            return False
        self._seen = self.book.changes
        changes = self._history()
        self.last = tuple(change for change in changes if change.step == changes[0].step)
        if self.looking_back is not None:
            self.looking_back = changes
        self.desk.say(self._saved() + counts_later(snapshot))
        return True

    def _saved(self) -> str:
        if not self.last:
            return tr("SAVED")
        names = self.told(self.last[0])[1]
        if len(self.last) > 1:
            names = tr("{count} OFFSETS").format(count=len(self.last))
        taken_back = self.last[0].undoes is not None
        return (tr("{names} TAKEN BACK") if taken_back else tr("{names} SAVED")).format(names=names)

    def told(self, change: Change) -> tuple[str, str, str, str]:
        """When, which, from → to, why; in the unit of the control."""
        return change_in_words(change, self.letter, self.mode)

    @property
    def last_told(self) -> str:
        """The last change in one line; empty when nothing has changed here yet."""
        if len(self.last) == 1:
            _at, which, change, _why = self.told(self.last[0])
            return f"{which}   {change}"
        return tr("{count} offsets changed: F5 shows them").format(count=len(self.last)) if self.last else ""

    def undo(self, why_not: str) -> None:
        """Take the last change of this table back, unless there is a reason not to."""
        if not why_not:
            self.desk.clear()
        self.answer(why_not or self.book.undo(self.kind))

    def toggle_history(self) -> None:
        """The history instead of the table, or the table again."""
        self.looking_back = None if self.looking_back is not None else self._history()

    def opened(self) -> None:
        """The page comes up: what was changed elsewhere is no news here."""
        self._seen = self.book.changes
        self.last = ()

    def answer(self, why: str) -> None:
        """Say why not, where there is a reason."""
        if why:
            self.desk.say(why)

    def _history(self) -> tuple[Change, ...]:
        try:
            return self.book.history(self.kind, LOOKED_AT)
        except StoreError as error:
            self.desk.say(str(error))
            return ()


# --- What the page of G54 to G59 remembers: the last change, the history, what was saved of late.


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
            _at, which, change, _why = zero_change_in_words(self.last[0])
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
