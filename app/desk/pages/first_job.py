"""A card that guides the operator through the first job, from choosing a program to the first part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from app.desk.persistence import Persistence
from app.desk.programs.program_loading import Loaded, Phase
from app.desk.status.interrupted_notice import NoticeRow
from app.desk.status.prompt_line import missing_tools
from app.desk.translation import tr
from core.executor.snapshot import CYCLE, Snapshot, State
from core.message import Message

STEP = "first_job_step"  # Name of the setting.
CLOSE = "×"  # Key name and label of the card's close button.
_COUNTED = (("P", "NO COUNT"),)  # A touch target, because no lamp shows NO COUNT while it is off.


_NO_END = CYCLE | {State.ESTOP, State.FAULT}  # A dry run that stops in one of these states is not complete.


class Step(NamedTuple):
    """One step of the first job: its title, instructions and keys."""

    title: str
    how: str
    keys: tuple[tuple[str, str], ...] = ()


STEPS = (
    Step("CHOOSE A PROGRAM", "F2: TYPE A NAME   F1, THEN F6: CHOOSE FROM THE LIST"),
    Step(
        "SET THE TOOLS",
        "TOOLS NOT SET? PRESS F8. TO TOUCH OFF: F1, F5, THEN T, X, Z",
    ),
    Step(
        "PROVE THE PROGRAM",
        "PROGRAM IS PROVED AUTOMATICALLY. B (PART): SHOW ERRORS, WARNINGS",
    ),
    Step("DRY RUN", "DRY RUN, NO STOCK: P, D, CYCLE START. WATCH EVERY MOVE. H: FEED HOLD", _COUNTED),
    Step("FIRST PART", "P: COUNT ON. LOAD STOCK, CYCLE START. MEASURE PART. F9: CORRECT WEAR", _COUNTED),
)


@dataclass(slots=True)
class FirstJob:
    """The progress of the first job. A completed step remains completed until the card is shown again."""

    at: int = 0
    _dry: bool = False  # A cycle that counts no part is running.
    _parts: int | None = None
    _saved: int = -1  # The step that is saved in the store.

    @classmethod
    def stored(cls, persistence: Persistence) -> FirstJob:
        """Return the card at the step at which TurnDesk was closed. Raises StoreError."""
        at = persistence.read_setting(STEP)
        return cls(at, _saved=at) if isinstance(at, int) and 0 <= at <= len(STEPS) else cls()

    def save(self, persistence: Persistence) -> None:
        """Save the step if it has changed. Raises StoreError."""
        if self.at != self._saved:
            self._saved = self.at
            persistence.save_setting(STEP, self.at)

    def see(self, snapshot: Snapshot, loaded: Loaded, parts: int) -> None:
        """Advance past all completed steps; called once a frame. ``parts`` is the number of parts made."""
        while self.at < len(STEPS) and self._done(snapshot, loaded, parts):
            self.at += 1

    def _done(self, snapshot: Snapshot, loaded: Loaded, parts: int) -> bool:
        good = loaded.phase is Phase.READY and loaded.proof is not None
        if self.at == 0:
            return loaded.path is not None and loaded.proof is not None
        if self.at == 1:
            return loaded.proof is not None and not missing_tools(loaded)
        if self.at == 2:
            return good and not missing_tools(loaded)
        if self.at == 3:
            ran, self._dry = self._dry, snapshot.state in CYCLE and snapshot.no_count
            return ran and snapshot.state not in _NO_END
        made = self._parts = parts if self._parts is None else self._parts
        return parts > made

    @property
    def row(self) -> NoticeRow:
        """The card's text and keys for the present step."""
        keys = ((CLOSE, tr("CLOSE")),)
        if self.at >= len(STEPS):
            return NoticeRow(
                tr("FIRST JOB: DONE"), tr("SHOW THIS CARD AGAIN: F10, 7, ENTER, FIRST JOB CARD"), keys, "run"
            )
        step = STEPS[self.at]
        head = tr(Message("FIRST JOB, STEP {number} OF {count}", number=self.at + 1, count=len(STEPS)))
        own = tuple((name, tr(label)) for name, label in step.keys)
        return NoticeRow(f"{head}: {tr(step.title)}", tr(step.how), (*own, *keys), "wait")
