"""The program on the desk is proved anew when something it was proved with has changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from app.desk.prompts import UNDER_WAY
from app.desk.renewing import Renewing
from app.desk.session import Phase, Session
from app.desk.words import tr
from app.offsets.offset_book import OffsetBook, ZeroBook, secondary_offsets, tool_offsets
from core.executor.commands import Command, UseOffsets
from core.executor.job import outdated
from core.executor.snapshot import Snapshot, State


@dataclass(slots=True)
class Rebuilding:
    """Offsets of both kinds, and the unit that the job before has left.

    Between two programs it is read, proved and drawn again; under a running one it is proved with the new
    offsets meanwhile, and the executor takes it up at the end of the part.
    """

    session: Session
    say: Callable[[str], None]
    wanted: bool = False
    renewing: Renewing = field(init=False)
    _changes: int = 0  # of the books, as far as they were seen

    def __post_init__(self) -> None:
        self.renewing = Renewing(self.session)

    def look(
        self, snapshot: Snapshot, book: OffsetBook, zero: ZeroBook, post: Callable[[Command], None]
    ) -> None:
        """Once a frame: note what has changed, and begin as soon as that may be."""
        trouble, before = book.poll() or zero.poll(), self._changes
        self._changes = book.changes + zero.changes
        if trouble:
            self.say(f"REFUSED: {trouble}")
        changed, under_way = self._changes != before, snapshot.state in UNDER_WAY
        if changed and under_way:
            self.renewing.begin()
        elif self.renewing.taken(snapshot) and not changed:
            self.wanted = False
        if changed or self._outdated(snapshot):
            self.wanted = True
        self._tell_trouble(snapshot)
        if self.wanted and not under_way and not (book.busy or zero.busy):
            self.wanted = False
            # Active at once, for the loaded tool too.
            post(UseOffsets(tool_offsets(book.tools), secondary_offsets(book.secondary)))
            now = self.session.now
            if now.path is not None:
                self.session.load(now.path, now.block_delete)

    def _tell_trouble(self, snapshot: Snapshot) -> None:
        """While there is still time to take a change back."""
        why = self.renewing.trouble()
        if why and snapshot.state in UNDER_WAY:
            self.say(tr("NO NEXT PART WITH THE CHANGED OFFSETS: {why}").format(why=why))

    def _outdated(self, snapshot: Snapshot) -> bool:
        """The job before has left another unit than this program was proved with, and it names none."""
        now = self.session.now
        at_rest = snapshot.state is State.IDLE and not now.busy and now.phase is not Phase.UNREADABLE
        return at_rest and now.job is not None and bool(outdated(now.job, snapshot.modal))
