"""Guidance card for the operator's first job, from choosing a program to the first part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase
from app.desk.status.interrupted_notice import NoticeRow
from app.desk.status.prompt_line import find_unmeasured_tools
from app.desk.translation import tr
from core.executor.snapshot import CYCLE_STATES, MachineState, Snapshot
from core.message import Message

STEP_SETTING = "first_job_step"  # Name of the setting.
CLOSE_KEY = "×"  # Key name and label of the card's close button.

_NO_END = CYCLE_STATES | {
    MachineState.ESTOP,
    MachineState.FAULT,
}  # A dry run that stops in one of these states is not complete.


class CountSwitch(NamedTuple):
    """Setting of the part count that a step of the first job needs, and how the operator selects it."""

    is_counting: bool
    instructions: str  # Instructions while the setting is not selected.
    key_label: str  # Label of the touch target of the key P.


class FirstJobStep(NamedTuple):
    """One step of the first job, with its title, instructions and the part count that it needs."""

    title: str
    instructions: str
    count_switch: CountSwitch | None = None


FIRST_JOB_STEPS = (
    FirstJobStep("CHOOSE A PROGRAM", "F2: TYPE A NAME   F1, THEN F6: CHOOSE FROM THE LIST"),
    FirstJobStep(
        "SET THE TOOLS",
        "TOOLS NOT SET? PRESS F8. TO TOUCH OFF: F1, F5, THEN T, X, Z",
    ),
    FirstJobStep(
        "PROVE THE PROGRAM",
        "PROGRAM IS PROVED AUTOMATICALLY. B (PART): SHOW ERRORS, WARNINGS",
    ),
    FirstJobStep(
        "DRY RUN",
        "DRY RUN, NO STOCK: D, CYCLE START. WATCH EVERY MOVE. H: FEED HOLD",
        CountSwitch(False, "P: NO COUNT. THEN DRY RUN, NO STOCK: D, CYCLE START. H: FEED HOLD", "NO COUNT"),
    ),
    FirstJobStep(
        "FIRST PART",
        "LOAD STOCK, CYCLE START. MEASURE PART. F9: CORRECT WEAR",
        CountSwitch(True, "P: COUNT ON. LOAD STOCK, CYCLE START. MEASURE PART. F9: CORRECT WEAR", "COUNT ON"),
    ),
)


@dataclass(slots=True)
class FirstJobCard:
    """Progress of the operator through the steps of the first job.

    A completed step remains completed until the operator opens the card again.
    """

    step_index: int = 0
    _dry: bool = False  # A cycle that counts no part is running.
    _parts: int | None = None
    _saved: int = -1  # The step that is saved in the store.
    _is_counting: bool = True  # NO COUNT is off.

    @classmethod
    def from_store(cls, persistence: Persistence) -> FirstJobCard:
        """Return the card at the step that was stored. Raises StoreError if the store cannot be read."""
        at = persistence.read_setting(STEP_SETTING)
        return cls(at, _saved=at) if isinstance(at, int) and 0 <= at <= len(FIRST_JOB_STEPS) else cls()

    def save_step(self, persistence: Persistence) -> None:
        """Save the step if it has changed, without waiting for the disk.

        Raises StoreError if the step cannot be queued for saving. A later write error is not raised.
        """
        if self.step_index != self._saved:
            self._saved = self.step_index
            persistence.save_setting(STEP_SETTING, self.step_index)

    def advance(self, snapshot: Snapshot, loaded: LoadedProgram, part_count: int) -> None:
        """Advance past all completed steps. The screen calls this method once per frame.

        ``part_count`` is the number of parts made.
        """
        self._is_counting = not snapshot.no_count
        while self.step_index < len(FIRST_JOB_STEPS) and self._done(snapshot, loaded, part_count):
            self.step_index += 1

    def _done(self, snapshot: Snapshot, loaded: LoadedProgram, parts: int) -> bool:
        good = loaded.phase is LoadingPhase.READY and loaded.proof is not None
        if self.step_index == 0:
            return loaded.path is not None and loaded.proof is not None
        if self.step_index == 1:
            return loaded.proof is not None and not find_unmeasured_tools(loaded)
        if self.step_index == 2:
            return good and not find_unmeasured_tools(loaded)
        if self.step_index == 3:
            ran, self._dry = self._dry, snapshot.state in CYCLE_STATES and snapshot.no_count
            return ran and snapshot.state not in _NO_END
        made = self._parts = parts if self._parts is None else self._parts
        return parts > made

    @property
    def notice_row(self) -> NoticeRow:
        """Return the card's text and keys for the current step."""
        keys: tuple[tuple[str, str], ...] = ((CLOSE_KEY, tr("CLOSE")),)
        if self.step_index >= len(FIRST_JOB_STEPS):
            return NoticeRow(
                tr("FIRST JOB: DONE"), tr("SHOW THIS CARD AGAIN: F10, 7, ENTER, FIRST JOB CARD"), keys, "run"
            )
        step = FIRST_JOB_STEPS[self.step_index]
        head = tr(
            Message(
                "FIRST JOB, STEP {number} OF {count}", number=self.step_index + 1, count=len(FIRST_JOB_STEPS)
            )
        )
        switch, instructions = step.count_switch, step.instructions
        if switch is not None and switch.is_counting is not self._is_counting:
            instructions, keys = switch.instructions, (("P", tr(switch.key_label)), *keys)
        return NoticeRow(f"{head}: {tr(step.title)}", tr(instructions), keys, "wait")
