"""An executor on a simulated machine and a clock that the test moves."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from app.compose.backends.simulated_backend import create_simulation
from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import get_control_limits
from core.executor.commands import Command, ConfirmStart, CycleStart, EnableDrives, LoadJob
from core.executor.executor import Executor
from core.executor.job import Job, ProgramPass, Proof, make_job, start_program_pass
from core.executor.snapshot import InterruptedJob, LogEvent, MachineState, Snapshot
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from drivers.simulated.simulated_machine import Simulation
from drivers.wakeups import ManualClock

INCH = 25.4
TICK = 0.02  # s; the longest that the executor has between two ticks
FINE = 0.01  # s; what it has mostly, for tests of what a tick tells apart


class CreepingClock(ManualClock):
    """A clock that goes on with every look at it, as a real one does."""

    def now(self) -> float:
        self.advance(20e-6)
        return super().now()


@dataclass
class Rig:
    """Drive it with ``post``, ``run`` and the simulated hands of ``sim.machine``."""

    machine: Machine = field(default_factory=load_machine)
    events: list[LogEvent] = field(default_factory=list)
    watch: list[Callable[[Snapshot], None]] = field(default_factory=list)
    clock_kind: type[ManualClock] = ManualClock
    made: Iterable[Block] | None = None  # run these instead of interpreting
    gear: bool = True  # whether the driver follows the spindle by itself
    every: float = TICK  # s between two ticks
    left: InterruptedJob | None = None  # what the last power cut left interrupted
    notes: list[InterruptedJob | None] = field(
        default_factory=list
    )  # what a power cut would leave, as it was noted

    def __post_init__(self) -> None:
        self.clock = self.clock_kind()
        self.sim: Simulation = create_simulation(self.machine, self.clock)
        if not self.gear:
            self.sim = self.sim._replace(ports=dataclasses.replace(self.sim.ports, gear=None))
        self.executor = Executor(
            self.machine, self.sim.ports, self.events.append, self._passes, self.notes.append, self.left
        )
        self.executor.run_tick()

    def _passes(self, job: Job, setup: InterpreterSetup) -> ProgramPass:
        return start_program_pass(job, setup) if self.made is None else ProgramPass(iter(self.made), list)

    @property
    def shot(self) -> Snapshot:
        return self.executor.snapshot

    @property
    def state(self) -> MachineState:
        return self.executor.snapshot.state

    def post(self, *commands: Command) -> None:
        """Post and let one tick pass."""
        for command in commands:
            self.executor.post(command)
        self.tick()

    def tick(self, dt: float | None = None) -> None:
        self.clock.advance(self.every if dt is None else dt)
        self.executor.run_tick()
        for look in self.watch:
            look(self.executor.snapshot)

    def run(self, seconds: float) -> None:
        end = self.clock.now() + seconds
        while self.clock.now() < end - 1e-9:
            self.tick()

    def until(self, *states: MachineState, limit: float = 60.0) -> float:
        """Run until one of these states; returns how long it took."""
        began = self.clock.now()
        while self.state not in states:
            assert self.clock.now() - began < limit, f"still {self.state} after {limit} s: {self.shot}"
            self.tick()
        return self.clock.now() - began

    def until_true(self, condition: Callable[[Snapshot], bool], limit: float = 60.0) -> float:
        began = self.clock.now()
        while not condition(self.shot):
            assert self.clock.now() - began < limit, f"not within {limit} s: {self.shot}"
            self.tick()
        return self.clock.now() - began

    def load(
        self,
        text: str,
        tools: Mapping[int, ToolOffset] | None = None,
        name: str = "PART",
        **changes: object,
    ) -> Job:
        """Load a program with a proof that has nothing against it."""
        if self.made is not None:
            changes.setdefault("metric", self.shot.modal.metric)  # what stands in for a program needs no unit
        setup = InterpreterSetup(
            tools=dict(tools or {}),
            limits=get_control_limits(self.machine),
            last_rapid=self.machine.limits.manual_rapid,
            **changes,  # type: ignore[arg-type]
        )
        job = make_job(ProgramSource(name, text), setup)
        self.post(LoadJob(job, Proof(job.digest, ())))
        return job

    def ready(self) -> None:
        self.post(EnableDrives())
        assert self.state is MachineState.IDLE, self.shot

    def start(self, text: str, tools: Mapping[int, ToolOffset] | None = None) -> None:
        """Drives on, program loaded, Cycle Start."""
        if self.state is MachineState.DISABLED:
            self.ready()
        self.run(0.3)  # no bounce of the last start
        self.load(text, tools)
        self.confirm()
        self.post(CycleStart())

    def confirm(self) -> None:
        """The operator has read what was interrupted, and means to begin at the first line."""
        if self.shot.interrupted is not None:
            self.post(ConfirmStart(self.shot.interrupted.at))
            self.run(0.9)  # a start counts when it was meant before the hands came down

    def said(self, kind: str) -> list[str]:
        return [event.text for event in self.events if event.kind == kind]

    def numbers(self, kind: str) -> list[int]:
        """Return the alarm numbers of the logged stops of this kind."""
        return [int(said.split()[0]) for said in self.said(kind)]


def off_line(shot: Snapshot, a: tuple[float, float], b: tuple[float, float]) -> float:
    """How far the demand lies off the line through two points (x, z), mm."""
    x, z, _ = shot.demand
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    return abs((b[0] - a[0]) * (z - a[1]) - (b[1] - a[1]) * (x - a[0])) / length


def unhomed_machine() -> Machine:
    """The shipped lathe with a Z that only counts and has to be homed."""
    machine = load_machine()
    x, z, c = machine.axes
    z = dataclasses.replace(z, is_position_absolute=False, home_speed=20.0, home_order=1)
    return dataclasses.replace(machine, axes=(x, z, c))
