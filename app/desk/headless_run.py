"""Execution of one program without a screen, with automatic button presses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from core.executor.commands import Command, CycleStart, EnableDrives, FeedHold, HomeAxes, LoadJob, SetSwitch
from core.executor.job import Job, Proof
from core.executor.snapshot import MachineState, Snapshot
from core.message import Message
from core.ports import Clock

POLL_INTERVAL_S = 0.01  # Seconds between two polls of the machine.
WAIT_TIMEOUT_S = 60.0  # Seconds of machine time after which a wait for an input is canceled.
HOMING_TIMEOUT_S = 120.0  # Seconds of machine time for homing all axes. Ten inches at 6 in/min take 100 s.
_MAX_START_PRESSES = 10  # Maximum presses of Cycle Start at one stop, 0.2 s apart.
RUNNING_STATES = frozenset(MachineState) - {
    MachineState.IDLE,
    MachineState.DISABLED,
    MachineState.ESTOP,
    MachineState.FAULT,
}


class HeadlessControl(Protocol):
    """Interface of the executor that a headless run uses."""

    @property
    def snapshot(self) -> Snapshot:
        """Return the snapshot of the current tick."""
        ...

    def post(self, command: Command) -> None:
        """Send a command to the executor."""
        ...

    def run_tick(self) -> None:
        """Advance the executor by one tick of its clock."""
        ...


@dataclass(frozen=True, slots=True)
class RunOutcome:
    """Outcome of a program run.

    ``final_state`` is ``complete``, ``refused``, ``alarm``, ``hold`` or ``waiting``. ``failure_reason`` is
    the reason as text. ``elapsed_s`` is the cycle time in seconds.
    """

    final_state: str
    failure_reason: str
    snapshot: Snapshot
    elapsed_s: float


class HeadlessRun:
    """Program run that loads and starts a job, and presses Cycle Start at M00 and M01."""

    def __init__(
        self,
        executor: HeadlessControl,
        clock: Clock,
        show_message: Callable[[str], None],
        report_progress: Callable[[float], None],
        press_start: Callable[[], None] | None = None,
        on_snapshot: Callable[[Snapshot, Proof], None] | None = None,
    ) -> None:
        """Create a run that uses this executor and clock.

        ``press_start`` presses both palm buttons, or asks a person to press them, if a command cannot start
        a cycle. ``on_snapshot`` receives every snapshot after the machine is ready, including the snapshots
        before the start.
        """
        self._executor = executor
        self._clock = clock
        self._say = show_message
        self._progress = report_progress
        self._palms = press_start
        self._see = on_snapshot
        self._proof: Proof | None = None
        self._last_move = 0.0

    def run_job(self, job: Job, proof: Proof, *, optional_stop: bool = False) -> RunOutcome:
        """Execute one cycle of a job and return its outcome."""
        self._until(lambda s: s.state is not MachineState.DISABLED, EnableDrives(), tries=100)
        if not self._home_axes():
            self._executor.post(FeedHold("the command line"))
            self._step()
            return self._outcome(
                "waiting",
                Message("homing did not finish within {homing} s", homing=f"{HOMING_TIMEOUT_S:.0f}"),
            )
        self._executor.post(SetSwitch("optional_stop", optional_stop))
        self._executor.post(LoadJob(job, proof))
        self._proof = proof
        self._step()
        before = self._executor.snapshot.parts  # A program with one action may end before the first poll.
        if not self._start(
            lambda s: s.state is not MachineState.IDLE or bool(s.start_refusal_reason) or s.parts > before
        ):
            return self._outcome("waiting", "no Cycle Start received; were both palm buttons pressed?")
        if self._executor.snapshot.state in RUNNING_STATES:
            return self._watch()
        return self._ended()

    def _home_axes(self) -> bool:
        """Home the axes that are not homed, and return whether homing finishes in time."""
        snapshot = self._executor.snapshot
        lost = [name for name, homed in zip(snapshot.axes, snapshot.homed, strict=True) if not homed]
        if not lost or snapshot.state is not MachineState.IDLE:
            return True
        self._say(Message("homing {lost}", lost=", ".join(lost)))
        self._until(lambda s: s.state is MachineState.HOMING, HomeAxes(), tries=20)
        return self._wait(
            lambda s: s.state is not MachineState.HOMING, tries=round(HOMING_TIMEOUT_S / POLL_INTERVAL_S)
        )

    def _start(self, reached: Callable[[Snapshot], bool]) -> bool:
        if self._palms is None:
            return self._until(reached, CycleStart(), tries=20)
        self._palms()
        return self._wait(reached, tries=round(WAIT_TIMEOUT_S / POLL_INTERVAL_S))

    def _until(self, reached: Callable[[Snapshot], bool], command: Command, tries: int) -> bool:
        self._executor.post(command)
        return self._wait(reached, tries)

    def _wait(self, reached: Callable[[Snapshot], bool], tries: int) -> bool:
        for _ in range(tries):
            self._step()
            if reached(self._executor.snapshot):
                return True
        return False

    def _watch(self) -> RunOutcome:
        self._last_move = self._clock.now()
        while True:
            snapshot = self._executor.snapshot
            if snapshot.state not in RUNNING_STATES:
                return self._ended()
            if snapshot.state is MachineState.PROGRAM_STOP:
                self._say(
                    Message(
                        "line {line}: program stop {snapshot}; Cycle Start pressed",
                        line=snapshot.line,
                        snapshot=f"{snapshot.message!r}",
                    )
                )
                if not self._has_restarted():
                    return self._outcome(
                        "waiting", snapshot.start_refusal_reason or ("Cycle Start has no effect")
                    )
            elif snapshot.state is MachineState.HOLD:
                return self._outcome("hold", snapshot.waiting_for or "feed hold")
            elif self._is_stuck(snapshot):
                self._executor.post(FeedHold("the command line"))
                self._step()
                hint = Message(
                    "line {line} waits for {waiting_for}; specify the input state with --inputs",
                    line=snapshot.line,
                    waiting_for=snapshot.waiting_for,
                )
                return self._outcome("waiting", hint)
            self._progress(snapshot.cycle_elapsed)
            self._step()

    def _has_restarted(self) -> bool:
        """Press Cycle Start repeatedly, and return whether the program continues.

        The control ignores a press that follows another press too soon.
        """
        for _ in range(_MAX_START_PRESSES):
            self._start(lambda s: s.state is not MachineState.PROGRAM_STOP)
            if self._executor.snapshot.state is not MachineState.PROGRAM_STOP:
                return True
        return False

    def _is_stuck(self, snapshot: Snapshot) -> bool:
        """Return whether the program has waited too long for an input, which cannot change in this run."""
        now = self._clock.now()
        if snapshot.state is not MachineState.WAIT or snapshot.waiting_for.startswith("DWELL"):
            self._last_move = now
        return now - self._last_move > WAIT_TIMEOUT_S

    def _ended(self) -> RunOutcome:
        snapshot = self._executor.snapshot
        alarm = snapshot.alarms[-1] if snapshot.alarms else snapshot.stop
        if (
            alarm is not None and snapshot.state is not MachineState.IDLE
        ):  # An E-stop is a stop and not an alarm.
            return self._outcome(
                "alarm",
                Message(
                    "{alarm}: {cause}; {remedy}", alarm=alarm.text, cause=alarm.cause, remedy=alarm.remedy
                ),
            )
        if snapshot.start_refusal_reason:
            return self._outcome("refused", snapshot.start_refusal_reason)
        if snapshot.state is not MachineState.IDLE:
            return self._outcome("refused", Message("the machine is in state {state}", state=snapshot.state))
        return self._outcome("complete", "")

    def _outcome(self, state: str, why: str) -> RunOutcome:
        snapshot = self._executor.snapshot
        elapsed = snapshot.cycle_elapsed or snapshot.last_cycle
        return RunOutcome(state, why, snapshot, elapsed)

    def _step(self) -> None:
        self._executor.run_tick()
        if self._see is not None and self._proof is not None:
            self._see(self._executor.snapshot, self._proof)
        self._clock.sleep_until(self._clock.now() + POLL_INTERVAL_S)
