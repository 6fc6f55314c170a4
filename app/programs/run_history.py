"""History of program runs from snapshots: outcomes, cycle times, proofs and part counts."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase
from app.desk.status import prompt_line
from app.desk.translation import tr
from core.executor.commands import Command, SetPartCount, SetSwitch
from core.executor.snapshot import MachineState, Snapshot
from core.message import Message
from core.store.production.run_records import RunRecords
from core.store.store_errors import StoreError

COMPLETE, UNCOUNTED, GIVEN_UP, ESTOP = "COMPLETE", "NOT COUNTED", "GIVEN UP", "E-STOP"
INTERRUPTED_OUTCOME = "CUT OFF"  # the control stopped during the run, as detected at the next start
_RUNNING_STATES = (
    frozenset({MachineState.RUN, MachineState.STOPPING, MachineState.WAIT}) | prompt_line.INTERRUPTED_STATES
)
_FINAL_PHASES = frozenset({LoadingPhase.READY, LoadingPhase.REFUSED})


@dataclass(slots=True)
class RunHistory:
    """Recorder of program runs.

    It examines every snapshot and posts to the store without waiting.
    """

    persistence: Persistence = field(default_factory=Persistence)
    running_program: str = ""  # program that is running
    _parts: int | None = None
    _ends: int = 0
    _timed: int = 0
    # count of MDI lines while nothing was running: an MDI line is not a run of the loaded program
    _lines: int = 0
    _loaded: LoadedProgram | None = None

    def process_snapshot(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Record the runs and proofs that a snapshot shows.

        This is called once a frame. If the store rejects a record, the error is reported elsewhere.
        """
        try:
            self._run(snapshot)
            self._proof(loaded)
        except StoreError:
            self.running_program = ""

    def _run(self, snapshot: Snapshot) -> None:
        parts, self._parts = self._parts, snapshot.parts
        name = Path(snapshot.program).name
        if parts is not None and snapshot.parts > parts and name:
            if snapshot.timed_cycle_count > self._timed:
                self.persistence.runs.record_cycle(name, snapshot.last_cycle)
            if not self.running_program:
                self.persistence.runs.record_run_start(name)
            self._end(name, COMPLETE)
        elif parts is not None and snapshot.ends > self._ends and self.running_program:
            self._end(name, UNCOUNTED)
        self._ends, self._timed = snapshot.ends, snapshot.timed_cycle_count
        if snapshot.state not in _RUNNING_STATES:
            self._lines = snapshot.lines
        under_way = snapshot.state in _RUNNING_STATES and snapshot.block > 0 and snapshot.lines == self._lines
        if under_way and not self.running_program and name:
            self.running_program = name
            self.persistence.runs.record_run_start(name)
        elif self.running_program and snapshot.state not in _RUNNING_STATES:
            self._end(self.running_program, _outcome(snapshot))

    def _end(self, name: str, outcome: str) -> None:
        self.running_program = ""
        self.persistence.runs.record_run_end(name, outcome)

    def _proof(self, loaded: LoadedProgram) -> None:
        if loaded is self._loaded:
            return
        self._loaded = loaded
        if loaded.phase not in _FINAL_PHASES or loaded.path is None or loaded.source is None:
            return
        errors, name, text = len(loaded.blocking_errors), loaded.path.name, loaded.source.text
        if loaded.phase is LoadingPhase.REFUSED:
            first = loaded.blocking_errors[0].message if errors else ""
            self.persistence.runs.record_proof(
                name,
                Message("{errors_count} ERRORS: {errors}", errors_count=max(errors, 1), errors=first),
                None,
                text,
            )
        else:
            planned = loaded.proof.cycle_time_s if loaded.proof else None
            self.persistence.runs.record_proof(name, "PROVED", planned, text)


def _outcome(snapshot: Snapshot) -> str:
    if snapshot.state is MachineState.ESTOP:
        return ESTOP
    if snapshot.state is MachineState.FAULT and snapshot.alarms:
        return Message("ALARM {number}", number=snapshot.alarms[-1].number)
    return GIVEN_UP


def mark_interrupted_runs(run_records: RunRecords) -> None:
    """Mark stored runs that have no end time as interrupted by a shutdown.

    This is called at startup.
    """
    write_future = run_records.end_interrupted_runs(
        INTERRUPTED_OUTCOME, "{program}: the control shut down during the last run of this program"
    )
    with suppress(StoreError):  # A full disk stores the records later.
        write_future.result()


MAX_COUNT = 9_999_999
_PRODUCING_STATES = frozenset({MachineState.RUN, MachineState.WAIT})


@dataclass(slots=True)
class PartCounter:
    """Part count of each program, stored with its target.

    A target of 0 means no target. During the cycle of the last part, Cycle Repeat is switched off so that
    the machine stops afterwards.
    """

    persistence: Persistence = field(default_factory=Persistence)
    program_name: str = ""
    part_count: int = 0
    target_count: int = 0
    job_target_count: int = 0  # count at which the active job is done; has priority over the target
    _seen: int | None = None
    _announced: int = -1
    _made: int = -1  # count that was last sent to the executor
    program_digest: str = ""  # digest of the program text whose parts are counted

    @property
    def part_count_text(self) -> str:
        """Return the number of parts, with the target if there is one, for example ``12`` or ``12/100``."""
        return (
            f"{self.part_count}/{self.effective_target_count}"
            if self.effective_target_count
            else str(self.part_count)
        )

    @property
    def effective_target_count(self) -> int:
        """Return the part count at which production ends, or 0 if no target is set.

        The target of the active job has priority over the target of the program.
        """
        return self.job_target_count or self.target_count

    @property
    def is_complete(self) -> bool:
        """Return whether the target number of parts has been made."""
        return 0 < self.effective_target_count <= self.part_count

    def process_snapshot(
        self,
        snapshot: Snapshot,
        post_command: Callable[[Command], None],
        show_message: Callable[[str], None],
        text_digest: str = "",
    ) -> None:
        """Update the count from a snapshot.

        This is called once a frame. It handles a change of program, a new part and the last part.
        ``text_digest`` is the digest of the loaded program text.
        """
        name = Path(snapshot.program).name
        if name != self.program_name or text_digest != self.program_digest:
            self._load(name)
            self.program_digest = text_digest
            self._seen = snapshot.parts
        if self._seen is not None and snapshot.parts > self._seen:
            self.part_count += snapshot.parts - self._seen
            if (
                self.is_complete and not self.job_target_count
            ):  # The end of a job is reported together with the next job.
                words = tr("TARGET REACHED: {count} OF {target} PARTS")
                show_message(tr(Message(words, count=self.part_count, target=self.target_count)))
        self._seen = snapshot.parts
        self._send_count(snapshot, post_command)
        self._stop_at(snapshot, post_command, show_message)

    def _send_count(self, snapshot: Snapshot, post: Callable[[Command], None]) -> None:
        """Send the part count to the executor, which numbers the parts."""
        if self.program_name and self.part_count not in {snapshot.made, self._made}:
            post(SetPartCount(self.part_count))
        self._made = self.part_count

    def _stop_at(
        self, snapshot: Snapshot, post: Callable[[Command], None], say: Callable[[str], None]
    ) -> None:
        last = (
            snapshot.counts
            and self.effective_target_count > 0
            and self.part_count + 1 >= self.effective_target_count
        )
        if (
            last
            and snapshot.cycle_repeat
            and snapshot.state in _PRODUCING_STATES
            and self._announced != self.part_count
        ):
            self._announced = self.part_count
            post(SetSwitch("cycle_repeat", False))
            say("THIS PART REACHES THE TARGET. CYCLE REPEAT IS NOW OFF")

    def _load(self, name: str) -> None:
        self.program_name, self.part_count, self.target_count, self._announced = name, 0, 0, -1
        if not name:
            return
        try:
            self.part_count = self.persistence.runs.read_part_count(name)
            kept = self.persistence.read_setting(_key(name))
        except StoreError:
            return  # TurnDesk itself reports that nothing is stored.
        self.target_count = kept if isinstance(kept, int) and 0 < kept <= MAX_COUNT else 0

    def reload(self) -> None:
        """Reload the count and the target, for example after a restore."""
        self._load(self.program_name)

    def set_target(self, target_count: int) -> None:
        """Set the target number of parts, or 0 for no target.

        The target is used immediately and is written to the disk later. A later write error is not raised,
        and without an open store the target is not stored. Raise StoreError if the store is closed or
        read-only; the new target is used even then.
        """
        before, self.target_count, self._announced = self.target_count, target_count, -1
        self.persistence.save_setting(_key(self.program_name), target_count or None)
        self.persistence.log_change(
            Message(
                "part target of {program}: {before} → {target}",
                program=self.program_name,
                before=before,
                target=target_count,
            )
        )

    def correct_count(self, change: int) -> None:
        """Correct the part count by ``change`` parts.

        The change is positive for parts that were made elsewhere, and negative for scrapped parts. The
        count changes immediately and is written to the disk later. A later write error is not raised. If no
        store has been opened, the count is not stored. Raises StoreError if the store was closed or is
        read-only; the displayed count changes even then.
        """
        self.part_count, self._announced = self.part_count + change, -1
        self.persistence.runs.add_parts(self.program_name, change)
        self.persistence.log_change(
            Message(
                "part count of {program}: {count} → {count2}",
                program=self.program_name,
                count=self.part_count - change,
                count2=self.part_count,
            )
        )

    def reset_count(self) -> None:
        """Reset the count to zero.

        The count changes immediately and is written to the disk later. A later write error is not raised,
        and without an open store the count is not stored. Raise StoreError if the store is closed or
        read-only; the displayed count is zero even then.
        """
        before, self.part_count, self._announced = self.part_count, 0, -1
        self.persistence.runs.reset_parts(self.program_name)
        self.persistence.log_change(
            Message("part count of {program}: {before} → 0", program=self.program_name, before=before)
        )


def _key(program: str) -> str:
    return f"target:{program}"
