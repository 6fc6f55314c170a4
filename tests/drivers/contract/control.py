"""The real executor on a rig: commands in, snapshots out, the operator's hands at the machine."""

from __future__ import annotations

import math
from collections.abc import Callable

from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.program_proving import create_proof
from core.executor.commands import Command, ConfirmStart, EnableDrives, LoadJob
from core.executor.executor import Executor
from core.executor.job import Job, Proof, make_job
from core.executor.snapshot import LogEvent, MachineState, Snapshot
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.proving.prove_program import prove
from tests.drivers.contract.rig import STILL, TICK, Rig

INCH = 25.4
BOUNCE = 0.4  # s after which another press is another press


class Control:
    """Everything the operator has."""

    def __init__(self, rig: Rig, machine: Machine | None = None) -> None:
        """``machine``: the same with other rules."""
        self.rig, self.clock, self.world = rig, rig.clock, rig.world
        self.events: list[LogEvent] = []
        self.watch: list[Callable[[Snapshot], None]] = []
        self.executor = Executor(machine or rig.machine, rig.ports, self.events.append)
        self.run(0.1)

    @property
    def shot(self) -> Snapshot:
        return self.executor.snapshot

    @property
    def state(self) -> MachineState:
        return self.executor.snapshot.state

    def tick(self) -> None:
        self.rig.alone(TICK)
        self.executor.run_tick()
        for look in self.watch:
            look(self.shot)

    def post(self, *commands: Command) -> None:
        """Post and let one tick pass."""
        for command in commands:
            self.executor.post(command)
        self.tick()

    def run(self, seconds: float) -> None:
        end = self.clock.now() + seconds
        while self.clock.now() < end - 1e-9:
            self.tick()

    def until(self, *states: MachineState, limit: float = 30.0) -> float:
        """Run until one of these states; how long it took."""
        return self.until_true(lambda shot: shot.state in states, limit)

    def until_true(self, condition: Callable[[Snapshot], bool], limit: float = 30.0) -> float:
        began = self.clock.now()
        while not condition(self.shot):
            assert self.clock.now() - began < limit, f"not within {limit} s: {self.shot}\n{self.events[-5:]}"
            self.tick()
        return self.clock.now() - began

    def rest(self, limit: float) -> float:
        """Run until the slides really stand; how long it took."""
        began = self.clock.now()
        while not self.stands():
            assert self.clock.now() - began < limit + TICK + 1e-9, f"not at rest within {limit} s"
        return self.clock.now() - TICK - began

    def stands(self) -> bool:
        """Whether a tick moves nothing, by the machine itself."""
        before = self.world.place()
        self.tick()
        return math.dist(self.world.place(), before) < STILL

    def nothing_moves(self) -> bool:
        """Neither slides nor spindle, for a second."""
        before = self.world.place()
        self.run(1.0)
        return math.dist(self.world.place(), before) < STILL and self.world.rpm() == 0.0

    def ready(self) -> None:
        self.post(EnableDrives())
        self.until(MachineState.IDLE, limit=0.5)

    def load(self, text: str, *, proved: bool = True) -> Job:
        """With the proof that proving gives; or with one that has nothing against it."""
        setup = create_power_up_setup(
            self.rig.machine, tool_offsets={1: ToolOffset(0.0, 0.0)}, secondary_offsets={}
        )
        job = make_job(ProgramSource("PART", text), setup)
        proof = Proof(job.digest, ())
        if proved:
            proof = create_proof(job, prove(job.source, job.setup, self.rig.machine))
            assert not proof.errors, proof.errors
        self.post(LoadJob(job, proof))
        return job

    def press(self) -> None:
        """Both palms, once a start is no bounce of the last one."""
        self.run(BOUNCE)
        self.world.press_start()
        self.run(0.1)

    def start(self, text: str) -> None:
        """Drives on, program loaded, both palms."""
        if self.state is MachineState.DISABLED:
            self.ready()
        self.load(text)
        if self.shot.interrupted is not None:  # read, and meant all the same
            self.post(ConfirmStart(self.shot.interrupted.at))
            self.run(0.9)  # a start counts when it was meant before the hands came down
        self.press()

    def said(self, kind: str) -> list[str]:
        return [event.text for event in self.events if event.kind == kind]
