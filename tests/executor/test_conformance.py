"""The worked examples, run on the simulated machine: where proving says they end, and about as long."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.commands import CycleStart, LoadJob
from core.executor.job import Proof, make_job
from core.executor.snapshot import MachineState
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from tests.executor.rig import Rig

pytestmark = pytest.mark.long

FOLDER = Path(__file__).parents[2].parent / "shared" / "conformance" / "omniturn"
RADIUS = 0.015 * 25.4
NAMES = (
    "arc-ik-diameter",
    "arc-ik-radius",
    "arc-r-radius-convex",
    "css-facing",
    "linear-diameter",
    "loop-notches",
    "secondary-taper",
    "tapping",
    "thread-cleanup",
    "thread-external",
    "thread-internal",
    "workshift-bar-loop",
    "workshift-dry-run",
)


@pytest.mark.parametrize("name", NAMES)
def test_program_runs_as_proved(name: str) -> None:
    path = FOLDER / f"{name}.nc"
    if not path.exists():
        pytest.skip("the worked examples are not here")
    rig = Rig()
    source = ProgramSource(name, path.read_text(encoding="utf-8"))
    tools = {number: ToolOffset() for number in range(1, 33)}
    setup = create_power_up_setup(
        rig.machine, tool_offsets=tools, secondary_offsets={1: SecondaryOffset(-RADIUS, -RADIUS, RADIUS)}
    )
    report = prove(source, setup, rig.machine)
    assert report.errors == ()
    rig.ready()
    job = make_job(source, setup)
    rig.post(LoadJob(job, Proof(job.digest, (), tool_numbers=report.tool_numbers)), CycleStart())
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=120)
    assert rig.shot.alarms == ()
    assert rig.shot.parts == 1
    assert rig.shot.underruns == 0
    assert rig.shot.demand[:2] == pytest.approx(report.machine_final_position[:2], abs=1e-6)
    # what proving leaves out: in position, ticks, the collet's spread
    assert rig.shot.last_cycle == pytest.approx(report.program_times.cycle_time_s, rel=0.05, abs=0.06)
