"""A job in single block, start by start, to its end: what it stopped at, against its blocks."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from core.executor.commands import CycleStart, LoadJob, SetSwitch
from core.executor.job import Job, ProgramPass, Proof, make_job, start_program_pass
from core.executor.snapshot import MachineState
from core.interpreter.dialects import interpret_program
from core.interpreter.shared.actions import Dwell, ProgramEnd
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.diagnostics import Severity
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from tests.executor.rig import Rig

STOPPED = {MachineState.SINGLE_BLOCK_STOP, MachineState.PROGRAM_STOP}
_QUICK = 8.0  # times the feeds and through the dwells: steps and places are the same
_LEAST_FEED = 1.0  # mm/s
_TICK = 0.02
_LONGEST = 1000.0  # s of the machine
_APART = 2  # ticks of 0.19 s between a stop and the next start, which bounces for 0.3 s


def with_room(machine: Machine) -> Machine:
    """The same machine with slides long enough for any program."""
    axes = [
        axis if axis.travel is None else dataclasses.replace(axis, travel=(-1e4, 1e4))
        for axis in machine.axes
    ]
    return dataclasses.replace(machine, axes=tuple(axes))


def _quick(block: Block) -> Block:
    if isinstance(block.action, Dwell):
        return dataclasses.replace(block, action=Dwell(block.action.seconds / _QUICK))
    if block.action is None and block.kind is not BlockKind.THREAD and not block.rapid:
        least = 0.0 if block.per_rev else _LEAST_FEED
        return dataclasses.replace(block, feed=max(block.feed * _QUICK, least))
    return block


@dataclass
class QuickRig(Rig):
    """Feeds several times as fast; threads and rapids as they are."""

    blocks: list[Block] = field(default_factory=list)  # of the last pass

    def _passes(self, job: Job, setup: InterpreterSetup) -> ProgramPass:
        self.blocks = []
        whole = start_program_pass(job, setup)
        return whole._replace(block_iterator=self._kept(whole.block_iterator))

    def _kept(self, blocks: Iterator[Block]) -> Iterator[Block]:
        for block in blocks:
            self.blocks.append(block)
            yield _quick(block)


def has_errors(source: ProgramSource, setup: InterpreterSetup) -> bool:
    """Whether a program is refused."""
    program = interpret_program(source, setup)
    for _ in program.generate_blocks():
        pass
    return any(found.severity is Severity.ERROR for found in program.diagnostics)


def steps_of(blocks: Iterable[Block]) -> list[int]:
    """Numbers of the blocks at which single block stops: all, a thread with its pull-out, not the end."""
    steps: list[int] = []
    threading = False
    for block in blocks:
        moves = block.action is None
        pulls = (
            moves and threading and (block.kind is BlockKind.THREAD or (block.rapid and block.z == block.z0))
        )
        if pulls:
            steps[-1] = block.n
        elif not isinstance(block.action, ProgramEnd):
            steps.append(block.n)
        threading = moves and block.kind is BlockKind.THREAD and not pulls
    return steps


def _answered(rig: Rig) -> None:
    """The loader or bar feeder for whose terminal the program waits does what it waits for."""
    for model in rig.machine.inputs.values():
        if rig.state is MachineState.WAIT and model.terminal and rig.shot.waiting_for == model.terminal:
            rig.sim.machine.set_input(model.name, model.name not in rig.shot.inputs)


def stepped_through(
    source: ProgramSource, setup: InterpreterSetup, machine: Machine, limit: int = 2000
) -> tuple[QuickRig, list[int]]:
    """The rig at the end, and the block at which each start of single block ended."""
    rig = QuickRig(machine=dataclasses.replace(with_room(machine), is_inch=not setup.metric))
    for model in rig.machine.inputs.values():
        if model.terminal and setup.inputs(model.terminal):
            rig.sim.machine.set_input(model.name, True)
    rig.ready()
    rig.post(SetSwitch("single_block", True))
    rig.run(0.3)
    job = make_job(source, setup)
    rig.post(LoadJob(job, Proof(job.digest, ())), CycleStart())
    stops: list[int] = []
    while rig.state not in {MachineState.IDLE, MachineState.FAULT}:
        assert rig.state is not MachineState.HOLD, rig.shot.waiting_for
        assert rig.clock.now() < _LONGEST, (
            f"still {rig.state} in line {rig.shot.line}: {rig.shot.waiting_for}"
        )
        if rig.state not in STOPPED:
            _answered(rig)
            rig.tick(_TICK)
            continue
        stops.append(rig.shot.block)
        assert len(stops) <= limit, f"still in line {rig.shot.line} after {limit} starts"
        for _ in range(_APART):
            rig.tick(0.19)
        rig.post(CycleStart())
    return rig, stops
