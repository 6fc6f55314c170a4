"""Record of the state that the screen sent to the control, used to set up its replacement."""

from __future__ import annotations

from typing import Final

from core.executor import commands
from core.executor.commands import (
    ChangeOffsets,
    Command,
    LoadJob,
    PrepareCycleStart,
    SetSwitch,
    SupplyJobProof,
)
from core.executor.job import Job, Proof
from core.executor.snapshot import InterruptedJob, Snapshot, StartAction

StationCall = tuple[str, tuple[object, ...]]
# Commands that set one value: the last of each kind is posted again.
_VALUES: Final = (
    commands.UseOffsetTables,
    commands.SetSpindleLimit,
    commands.SetFeedOverride,
    commands.PreventNextPart,
)
# Switches that only make a run stop earlier or not count. Cycle repeat starts parts, so it is off again.
_SWITCHES = ("single_block", "optional_stop", "no_count")
# Controls of the simulated station that remain where the operator has set them, with the control they set.
_STATION: Final = {
    "press_estop": "estop",
    "release_estop": "estop",
    "set_spindle_auto": "spindle_auto",
    "set_spindle_pot": "spindle_pot",
    "set_feed_pot": "feed_pot",
}


class PostedState:
    """Record of the loaded program, the operator's values and the simulated station's settings."""

    def __init__(self, interrupted_job: InterruptedJob | None) -> None:
        self.interrupted_job = interrupted_job  # the job that the end of the control would interrupt
        self._job: Job | None = None
        self._proof: Proof | None = None
        self._renewal: ChangeOffsets | None = None  # a change of offsets that has no new job yet
        self._starts = StartAction.PROGRAM
        self._values: dict[type[Command], Command] = {}
        self._station: dict[str, StationCall] = {}

    def record_command(self, command: Command) -> None:
        """Update the recorded state for a command that was sent to the control."""
        match command:
            case LoadJob(job, proof) | ChangeOffsets(Job() as job, proof):
                self._job, self._proof, self._renewal = job, proof, None
            case ChangeOffsets():
                self._renewal = command
            case SupplyJobProof(proof):
                self._proof = proof
            case PrepareCycleStart():
                self._starts = command.starts
            case _ if isinstance(command, _VALUES):
                self._values[type(command)] = command

    def record_station_action(self, name: str, values: tuple[object, ...]) -> None:
        """Update the recorded state for an action at the simulated station."""
        if name in _STATION:
            self._station[_STATION[name]] = name, values

    def list_restore_commands(self, last_snapshot: Snapshot) -> list[Command]:
        """Return the commands that restore the recorded state in a new control, without any motion.

        ``last_snapshot`` is the last snapshot of the previous control.
        """
        found = list[Command]()
        if self.interrupted_job is not None:
            found.append(commands.ReportInterruptedJob(self.interrupted_job, logged=True))
        found += self._values.values()
        found += [SetSwitch(name, on=True) for name in _SWITCHES if getattr(last_snapshot, name)]
        if self._job is not None:
            proof = self._proof
            known = proof is not None and proof.digest == self._job.digest
            found.append(LoadJob(self._job, proof if known else None))
            found.append(commands.SetPartCount(last_snapshot.made))
        if self._renewal is not None:
            found.append(self._renewal)
        if self._starts is not StartAction.PROGRAM:  # a line or a restart must be prepared again
            found.append(PrepareCycleStart(StartAction.MDI_LINE))
        return found

    def list_restore_station_actions(self) -> list[StationCall]:
        """Return the actions that restore the recorded state at the simulated station of a new control."""
        return list(self._station.values())
