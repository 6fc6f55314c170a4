"""What an MDI line leaves in force is sent between the processes of the screen and the control."""

from __future__ import annotations

import pickle
from dataclasses import replace

import pytest

from app.compose.control.control_messages import CommandMessage, SnapshotMessage
from app.compose.machine.machine_files import load_named_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.program_proving import create_proof, make_checkpoint
from core.executor.commands import CycleStart, PrepareCycleStart
from core.executor.job import Job, make_job
from core.executor.snapshot import MachineState, StartAction
from core.interpreter.shared.checkpoint import PassStart
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import Dialect, ProgramSource
from core.proving.prove_program import prove
from tests.executor.rig import Rig

TOOLS = {1: ToolOffset(z=80.0, nose_radius=0.4, quadrant=3), 5: ToolOffset(z=80.0, nose_radius=6.0)}
LINES = [
    ("gt75", ("G90G72", "G04F.1", "M03S900")),
    ("sinumerik-modulo", ("R1=5", "G4 F0.1", "M3 S=R1*100")),
    ("ac-table-mill", ("Q1 = 5", "TOOL CALL 5 Z S2000", "L Z+Q1 FMAX")),
]


def press(rig: Rig, text: str) -> Job:
    """Prove the line, send it as the screen does, and run it to its end; return the job that arrived."""
    rig.run(0.5)
    setup = replace(
        create_power_up_setup(rig.machine, tool_offsets=TOOLS, secondary_offsets={}),
        start=rig.shot.demand,
        begin=PassStart(make_checkpoint(rig.shot), is_mdi_line=True),
    )
    job = make_job(ProgramSource("MDI", text, Dialect(rig.machine.mdi_language)), setup)
    report = prove(job.shared_program, job.setup, rig.machine)
    assert not report.errors, report.errors
    prepare = PrepareCycleStart(StartAction.MDI_LINE, job, create_proof(job, report))
    arrived: PrepareCycleStart = pickle.loads(pickle.dumps(CommandMessage(prepare, 0.0))).command
    rig.post(arrived)
    rig.post(CycleStart())
    assert not rig.shot.start_refusal_reason, rig.shot.start_refusal_reason
    rig.run(0.3)
    rig.until(MachineState.IDLE)
    assert arrived.job is not None
    return arrived.job


@pytest.mark.parametrize(("machine", "lines"), LINES, ids=[name for name, _ in LINES])
def test_snapshot_after_mdi_line_reaches_the_screen(machine: str, lines: tuple[str, ...]) -> None:
    """The next line starts from the state that arrived, and no message contains the states before it."""
    rig = Rig(machine=load_named_machine(machine))
    rig.ready()
    for line in lines:
        job = press(rig, line)
        received = pickle.loads(pickle.dumps(SnapshotMessage(rig.shot, False))).snapshot
        assert received.kept == rig.shot.kept
        begin = job.setup.begin
        assert begin is not None
        kept = begin.checkpoint.kept
        assert kept is None or all(getattr(each, "begin", None) is None for each in kept._shared)
    assert (rig.shot.kept is None) is (machine == "gt75")


@pytest.mark.parametrize(("machine", "lines"), LINES[1:], ids=[name for name, _ in LINES[1:]])
def test_messages_do_not_grow_with_each_mdi_line(machine: str, lines: tuple[str, ...]) -> None:
    rig = Rig(machine=load_named_machine(machine))
    rig.ready()
    sizes = []
    for _ in range(4):
        press(rig, lines[0])
        sizes.append(len(pickle.dumps(rig.shot.kept)))
    # The first line starts from no saved state. Line numbers differ in their length.
    assert max(sizes[1:]) - min(sizes[1:]) < 10, sizes
