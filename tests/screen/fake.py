"""A scripted machine for the screen's tests: plays the blocks of a program by steps, one step a snapshot."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from core.executor.commands import (
    Command,
    CycleStart,
    EnableDrives,
    FeedHold,
    ForceOutput,
    LoadJob,
    PrepareCycleStart,
    Reset,
    SetFeedOverride,
    SetSpindleLimit,
    SetSwitch,
    SupplyJobProof,
)
from core.executor.job import Job, Proof
from core.executor.snapshot import Alarm, LogEvent, MachineState, Snapshot
from core.interpreter.shared.actions import ProgramEnd, ProgramStop
from core.interpreter.shared.elementary_blocks import Block, BlockKind

STOPPED = frozenset({MachineState.HOLD, MachineState.SINGLE_BLOCK_STOP, MachineState.PROGRAM_STOP})


@dataclass
class FakeMachine:
    """Posts in, snapshots out; ``step`` seconds pass at every snapshot."""

    blocks: Sequence[tuple[Block, float, float]] = ()
    step: float = 0.02
    posted: list[Command] = field(default_factory=list)
    now: Snapshot = field(default_factory=lambda: Snapshot(state=MachineState.IDLE, homed=(True, True, True)))
    job: Job | None = None
    proof: Proof | None = None
    palms: set[str] = field(default_factory=set)
    t: float = 0.0
    at: int = 0
    hear: Callable[[LogEvent], None] = lambda _: None
    alive: bool = True  # a dead control goes on showing its last snapshot
    # A program is loaded from a thread of its own: only ``snapshot`` shows it, or one thread would undo what
    # the other has just written.
    loaded: deque[Job] = field(default_factory=deque)

    def snapshot(self) -> Snapshot:
        """One step on, then a picture of it."""
        while self.loaded:
            self._show_loaded(self.loaded.popleft())
        if self.now.state is MachineState.RUN:
            self._run()
        wanted = self.job is not None and self.proof is None
        beat = self.now.t + 0.01 if self.alive else self.now.t
        self.now = replace(self.now, t=beat, needs_proof=wanted)
        return self.now

    def post(self, command: Command) -> None:
        """What the executor would do with it, as far as the screen can tell."""
        self.posted.append(command)
        match command:
            case LoadJob(job):
                self.job, self.proof = job, None
                self.loaded.append(job)
            case PrepareCycleStart(starts):
                self.now = replace(self.now, starts=starts)
            case SupplyJobProof(proof):
                self.proof = proof
            case SetSwitch(name, on):
                switched: dict[str, Any] = {name: on}
                self.now = replace(self.now, **switched)
            case SetSpindleLimit(rpm):
                self.now = replace(self.now, spindle_limit_rpm=rpm or 0.0)
            case ForceOutput(name, on):
                outputs = self.now.outputs | {name} if on else self.now.outputs - {name}
                self.now = replace(self.now, outputs=outputs)
            case SetFeedOverride(fraction):
                self.now = replace(self.now, feed_override=fraction)
            case CycleStart() | FeedHold() | Reset() | EnableDrives():
                self._button(command)

    def _show_loaded(self, job: Job) -> None:
        name, deletes = job.source.name, job.setup.block_delete
        self.now = replace(self.now, program=name, block_delete=deletes, line=0, block=0)

    def _button(self, command: Command) -> None:
        state = self.now.state
        if isinstance(command, CycleStart):
            self._start()
        elif isinstance(command, FeedHold) and state is MachineState.RUN:
            self.now = replace(self.now, state=MachineState.HOLD, velocity=0.0)
        elif isinstance(command, Reset) and state in {*STOPPED, MachineState.FAULT}:
            self.t, self.at = 0.0, 0
            back = MachineState.IDLE if state in STOPPED else MachineState.DISABLED
            self.now = replace(self.now, state=back, alarms=(), block=0, line=0, block_text="", message="")
        elif isinstance(command, EnableDrives) and state is MachineState.DISABLED:
            self.now = replace(self.now, state=MachineState.IDLE)

    def _start(self) -> None:
        why = self._refusal()
        if why:
            self.now = replace(self.now, start_refusal_reason=why)
        else:
            self.now = replace(self.now, state=MachineState.RUN, start_refusal_reason="", message="")

    def _refusal(self) -> str:
        if self.now.state is MachineState.FAULT:
            return "AN ALARM STANDS"
        if self.now.state not in {MachineState.IDLE, *STOPPED}:
            return "THE DRIVES ARE OFF"
        if self.job is None or self.proof is None:
            return "NO PROVED PROGRAM"
        return "THE PROGRAM HAS ERRORS" if self.proof.errors else ""

    def fault(self, alarm: Alarm) -> None:
        """Something breaks."""
        self.hear(LogEvent(self.now.t, "alarm", alarm.text, alarm.line, alarm))
        self.now = replace(self.now, state=MachineState.FAULT, alarms=(alarm,), velocity=0.0)

    def _run(self) -> None:
        self.t += self.step * self.now.feed_override
        while self.at < len(self.blocks) and self.t >= self.blocks[self.at][2]:
            self.at += 1
            if self._stops(self.blocks[self.at - 1][0]):
                return
        if self.at < len(self.blocks):
            self._show(*self.blocks[self.at])

    def _stops(self, block: Block) -> bool:
        action = block.action
        if isinstance(action, ProgramEnd):
            self.t, self.at = 0.0, 0
            self.now = replace(self.now, state=MachineState.IDLE, block=0, line=0, parts=self.now.parts + 1)
        elif isinstance(action, ProgramStop) and (not action.optional or self.now.optional_stop):
            self.now = replace(self.now, state=MachineState.PROGRAM_STOP, message=action.message)
        elif self.now.single_block:
            self.now = replace(self.now, state=MachineState.SINGLE_BLOCK_STOP)
        else:
            return False
        return True

    def _show(self, block: Block, t0: float, t1: float) -> None:
        share = (self.t - t0) / (t1 - t0) if t1 > t0 else 1.0
        x = block.x0 + (block.x - block.x0) * share + block.offset_x
        z = block.z0 + (block.z - block.z0) * share + block.offset_z
        self.now = replace(
            self.now,
            line=block.line,
            block=block.n,
            block_text=block.text,
            actual=(x, z, 0.0),
            block_end=(block.mx, block.mz, 0.0),
            offset=(block.offset_x, block.offset_z),
            modal=block.modal,
            feed=block.feed,
            rapid=block.kind is BlockKind.RAPID,
            velocity=block.feed * (abs(block.rpm) / 60 if block.per_rev else 1.0) * self.now.feed_override,
            rpm_command=block.rpm,
            rpm_actual=block.rpm * 0.998,
            comment=block.modal.comment,
            cycle_elapsed=self.t,
            outputs=frozenset({"collet", *(("coolant",) if block.modal.coolant else ())}),
        )

    # --- the operator station ------------------------------------------------------------------------

    def press_left(self) -> None:
        self._press("left")

    def press_right(self) -> None:
        self._press("right")

    def release_left(self) -> None:
        self.palms.discard("left")

    def release_right(self) -> None:
        self.palms.discard("right")

    def _press(self, side: str) -> None:
        self.palms.add(side)
        if len(self.palms) == 2:
            self.post(CycleStart())

    def press_hold(self) -> None:
        self.post(FeedHold())

    def release_hold(self) -> None:
        pass

    def press_estop(self) -> None:
        self.t, self.at = 0.0, 0
        self.now = replace(self.now, state=MachineState.ESTOP, velocity=0.0, rpm_command=0.0, block=0, line=0)

    def release_estop(self) -> None:
        self.now = replace(self.now, state=MachineState.DISABLED)

    def set_spindle_auto(self, is_auto: bool) -> None:
        self.now = replace(self.now, spindle_auto=is_auto)

    def set_spindle_pot(self, fraction: float) -> None:
        self.now = replace(self.now, spindle_override=fraction)

    def set_feed_pot(self, fraction: float) -> None:
        self.now = replace(self.now, feed_override=fraction)

    def turn_handwheel(self, count_change: int) -> None:
        """It has none."""

    def idle(self) -> None:
        """Whatever was, the machine is at rest now, so that the window lets itself be closed."""
        self.now = replace(self.now, state=MachineState.IDLE)
