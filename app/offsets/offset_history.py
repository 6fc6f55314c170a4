"""What is remembered of a table of offsets: the last change, the history, and the way back.

And when an offset may change: corrections at any time at which no hand moves the slides, the rest at rest.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field

from app.desk.desk import Desk
from app.desk.status.formats import local_time
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.offsets.offset_book import OffsetBook
from app.offsets.offset_values import Mode, from_to
from core.executor.snapshot import Snapshot, State
from core.message import Message
from core.store.store_errors import StoreError
from core.store.store_rows import Change, Kind
from core.tool_edges import edge_name

LETTERS = {
    Kind.TOOL: "T",
    Kind.SHAPE: "T",
    Kind.SECONDARY: "D",
    Kind.ZERO: "G",
    Kind.MILL_TOOL: "T",
    Kind.PRESET: "PRESET ",
}


def refusal(snapshot: Snapshot, *, correction: bool) -> str:
    """Why nothing may be changed now; empty when it may.

    A correction (wear, secondary offset) may be entered while parts run: the part under way keeps the
    offsets that it was proved with. What says where a tip is waits until no program is under way.
    """
    if snapshot.state in {State.JOG, State.HOME}:
        return tr("AXES ARE MOVING. WAIT UNTIL THEY STOP TO CHANGE OFFSETS")
    if snapshot.state in UNDER_WAY and not correction:
        return tr("PROGRAM RUNNING. CHANGE ONLY WEAR OR SECONDARY OFFSETS (F9)")
    return ""


def counts_from(snapshot: Snapshot) -> str:
    """What a change entered now will count for; empty between cycles."""
    if snapshot.state not in UNDER_WAY:
        return ""
    if snapshot.cycle_repeat:
        return tr("OFFSET CHANGES APPLY FROM NEXT PART, AFTER THEY ARE PROVED")
    return tr("WEAR APPLIES FROM NEXT CYCLE START")


def _behind_saved(snapshot: Snapshot) -> str:
    """What the message says behind SAVED while parts run."""
    if snapshot.state not in UNDER_WAY:
        return ""
    if snapshot.cycle_repeat:
        return tr("; APPLIES FROM NEXT PART")
    return tr("; APPLIES FROM NEXT CYCLE START")


@dataclass(slots=True)
class OffsetHistory:
    """Of the table ``kind``; every page that changes it looks once a frame."""

    desk: Desk
    kind: Kind
    mode: Mode = field(default_factory=Mode)  # of the control, as it was looked at last
    keys: str = "F5"  # that show the history from the page
    last: tuple[Change, ...] = ()  # the changes of the last step that was saved while the page was open
    listed: tuple[Change, ...] | None = None  # the history while it is looked at
    _seen: int = 0
    _newest: int = 0  # id of the newest change that was read
    _asked_of: tuple[int, int | None] | None = None  # changes of the book, and row, that ``_undoable`` is of
    _undoable: bool = True

    def __post_init__(self) -> None:
        self._seen = self.book.changes

    @property
    def book(self) -> OffsetBook:
        """The offsets as they are saved."""
        return self.desk.book

    def opened(self) -> None:
        """The page comes up: what was changed elsewhere is no news here."""
        self._seen, self.last = self.book.changes, ()
        self._newest = max((change.id for change in self._read(1)), default=0)

    def look(self, snapshot: Snapshot) -> None:
        """Once a frame: follow the control's unit, and say what has been saved since."""
        self.mode = Mode(snapshot.modal.metric, snapshot.reads_diameter)
        if self.book.changes == self._seen:
            return
        self._seen = self.book.changes
        changes = self._read()
        # What was saved may have been of another table: the tip of a tool, entered on the page of its shape.
        fresh = bool(changes) and changes[0].id != self._newest
        self._newest = changes[0].id if changes else 0
        self.last = tuple(change for change in changes if fresh and change.step == changes[0].step)
        if self.listed is not None:
            self.listed = changes
        self.desk.done(self._saved() + _behind_saved(snapshot))

    def _saved(self) -> str:
        if not self.last:
            return tr("SAVED")
        names = " ".join(self._named(change) for change in reversed(self.last))
        if len(self.last) > 1 and self.kind is not Kind.ZERO:
            names = tr(Message("{count} OFFSETS", count=len(self.last)))
        taken_back = self.last[0].undoes is not None
        return tr(Message(tr("{names} UNDONE") if taken_back else tr("{names} SAVED"), names=names))

    def _named(self, change: Change) -> str:
        letter = LETTERS[self.kind]
        return edge_name(change.number) if letter == "T" else f"{letter}{change.number}"

    def in_words(self, change: Change) -> tuple[str, str, str, str]:
        """Of one change: when (local time), which, from → to in the control's unit, why and by whom."""
        at = local_time(change.at)
        who = "" if change.who == "operator" else f" ({change.who})"
        which = self._named(change)
        return at, which, from_to(change.old, change.new, self.mode), f"{change.why}{who}"

    @property
    def last_in_words(self) -> str:
        """The last change in one line; empty when nothing has changed here yet."""
        if len(self.last) == 1:
            _at, which, change, _why = self.in_words(self.last[0])
            return f"{which}   {change}"
        return (
            tr(
                Message(
                    "{count} offsets changed. {keys}: show the changes", count=len(self.last), keys=self.keys
                )
            )
            if self.last
            else ""
        )

    def toggle(self) -> None:
        """The history instead of the table, or the table again."""
        self.listed = None if self.listed is not None else self._read()

    def undoable(self, number: int | None) -> bool:
        """Return whether a change of this row can be taken back. It asks the store once per change."""
        key = self.book.changes, number
        if self._asked_of != key:
            self._asked_of, self._undoable = key, True
            with suppress(StoreError):  # undo itself reports it
                self._undoable = bool(self.book.undoable(self.kind, number))
        return self._undoable

    def answer(self, why: str) -> None:
        """Say why not, where there is a reason."""
        if why:
            self.desk.say(why)

    def _read(self, limit: int = 200) -> tuple[Change, ...]:
        try:
            return self.book.history(self.kind, limit)
        except StoreError as error:
            self.desk.say(str(error))
            return ()
