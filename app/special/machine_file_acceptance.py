"""The machine file: what has changed in it since somebody accepted it, key by key."""

from __future__ import annotations

from collections.abc import Mapping

from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet
from app.desk.status.machine_file_changes import FileChanges
from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.special.special_functions import SpecialFunction
from core.access.access_table import Act
from core.executor.snapshot import Snapshot, State
from core.message import Message

_OFF = frozenset({State.DISABLED, State.ESTOP, State.FAULT})


class MachineFileAcceptance(SpecialFunction):
    """F2 accepts, after asking once; until then the drives cannot be switched on."""

    name = "MACHINE FILE"
    use = "changes in the machine file since the file was last accepted"

    def __init__(self, desk: Desk, changes: FileChanges) -> None:
        super().__init__(desk)
        self.changes = changes

    @property
    def count(self) -> int:
        """How many keys of the file have changed."""
        return len(self.changes.changes)

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """One row for each key that has changed: key, was, is."""
        rows = tuple(Row(tuple(change), None, Tone.WAIT) for change in self.changes.changes)
        note = (
            tr("Press F2 to accept; the drives stay off until then.")
            if rows
            else tr("No changes since the machine file was accepted.")
        )
        return Sheet(
            Message("MACHINE FILE  ·  {source}", source=self.changes.source),
            ("KEY", "WAS", "IS"),
            (0.44, 0.28, 0.28),
            rows,
            self.marked if rows else -1,
            notes=(note,),
            raw=frozenset({0, 1, 2}),
        )

    def keys(self) -> Mapping[str, Key]:
        """F2, while there is something to accept."""
        return {"F2": Key("ACCEPT", self._accept)} if self.changes.changes else {}

    def _accept(self) -> None:
        if self.desk.refused(Act.MACHINE_FILE):
            return
        if self.desk.snapshot().state not in _OFF:
            self.desk.say(tr("TURN DRIVES OFF BEFORE ACCEPTING THE CHANGED MACHINE FILE"))
        else:
            question = tr("PRESS Y TO ACCEPT THE MACHINE FILE AS IT IS NOW, N TO CANCEL")
            self.desk.ask(question, self._accepted)

    def _accepted(self) -> None:
        self.changes.accept()
        self.marked = 0
        self.desk.done(tr("ACCEPTED: THE DRIVES CAN BE SWITCHED ON"))

    def prompt(self) -> str:
        """What the keys do, for the prompt line."""
        if self.changes.changes:
            return tr("ARROWS: SCROLL THE CHANGES   F2: ACCEPT ALL   ESC: BACK")
        return super().prompt()
