"""The program on the desk is read and proved anew when something it was proved with has changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.desk.offsets.book import OffsetBook
from app.desk.offsets.force import secondary_offsets, tool_offsets
from app.desk.prompts import UNDER_WAY
from app.desk.session import Phase, Session
from app.desk.zero_offsets.book import ZeroBook
from core.executor.commands import Command, SetSwitch, UseOffsets
from core.executor.job import outdated
from core.executor.snapshot import Snapshot, State


@dataclass(slots=True)
class Rebuilding:
    """Offsets of both kinds, and the unit that the job before has left; only between two programs."""

    session: Session
    say: Callable[[str], None]
    wanted: bool = False
    _changes: int = 0  # of the books, as far as they were seen

    def look(
        self, snapshot: Snapshot, book: OffsetBook, zero: ZeroBook, post: Callable[[Command], None]
    ) -> None:
        """Once a frame: note what has changed, and begin as soon as that may be."""
        trouble, before = book.poll() or zero.poll(), self._changes
        self._changes = book.changes + zero.changes
        if trouble:
            self.say(f"REFUSED: {trouble}")
        if self._changes != before and snapshot.state in UNDER_WAY and snapshot.cycle_repeat:
            post(SetSwitch("cycle_repeat", on=False))  # it would go on with what was before
        if self._changes != before or self._outdated(snapshot):
            self.wanted = True
        if self.wanted and snapshot.state not in UNDER_WAY and not (book.busy or zero.busy):
            self.wanted = False
            # Active at once, for the loaded tool too.
            post(UseOffsets(tool_offsets(book.tools), secondary_offsets(book.secondary)))
            now = self.session.now
            if now.path is not None:
                self.session.load(now.path, now.block_delete)

    def _outdated(self, snapshot: Snapshot) -> bool:
        """The job before has left another unit than this program was proved with, and it names none."""
        now = self.session.now
        at_rest = snapshot.state is State.IDLE and not now.busy and now.phase is not Phase.UNREADABLE
        return at_rest and now.job is not None and bool(outdated(now.job, snapshot.modal))
