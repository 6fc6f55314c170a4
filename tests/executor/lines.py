"""An operator at MDI, as the executor sees him: a line is proved, prepared and started."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from app.compose.machine.machine_setup import control_limits
from app.compose.workshop import proof_of
from app.searchto.searchto_plan import now_of
from core.executor.commands import CycleStart, Prepare
from core.executor.job import Job, make_job
from core.executor.snapshot import Starts, State
from core.interpreter.restart.restart_approach import Choices, begin_at
from core.interpreter.restart.restart_point import RestartPoint
from core.interpreter.restart.state_rebuild import StateRebuild
from core.interpreter.shared.checkpoint import Begin, Checkpoint
from core.interpreter.shared.job_setup import Setup, ToolOffset
from core.language.diagnostics import Diagnostic
from core.language.source import Dialect, Source
from core.proving.prove_program import prove
from tests.executor.rig import Rig

TOOLS: Mapping[int, ToolOffset] = {1: ToolOffset(-12.7, -50.8), 2: ToolOffset(6.35, -25.4)}


def line_job(rig: Rig, text: str, tools: Mapping[int, ToolOffset] = TOOLS) -> Job:
    """The job of a line at the machine as it stands."""
    shot = rig.shot
    point = Checkpoint(shot.modal, tool_line=-1 if shot.tool_open else 0)
    setup = Setup(
        tools=tools,
        limits=control_limits(rig.machine),
        start=shot.demand,
        begin=Begin(point, single=True),
    )
    return make_job(Source("MDI", text, Dialect(rig.machine.language)), setup)


def errors(rig: Rig, text: str) -> list[Diagnostic]:
    """Return the errors that proving finds in a line."""
    job = line_job(rig, text)
    return list(prove(job.source, job.setup, rig.machine).errors)


def press(rig: Rig, text: str) -> None:
    """Prove, prepare, and Cycle Start; the line must be a good one."""
    if rig.state is State.DISABLED:
        rig.ready()
    rig.run(0.35)  # no bounce of the last start
    job = line_job(rig, text)
    report = prove(job.source, job.setup, rig.machine)
    assert not report.errors, report.errors
    rig.post(Prepare(Starts.LINE, job, proof_of(job, report)))
    rig.post(CycleStart())
    assert not rig.shot.start_refused, rig.shot.start_refused


def mdi(rig: Rig, *lines: str) -> None:
    """One line after the other, each to its end."""
    for line in lines:
        press(rig, line)
        rig.until(State.IDLE)


def restart_job(rig: Rig, line: int, choices: Choices | None = None, number: int = 0) -> Job | None:
    """The job that goes on from a line of the loaded program at the machine as it stands; None: it cannot."""
    whole = rig.executor._control.status.job
    assert whole is not None
    now = now_of(rig.shot, whole)
    found = StateRebuild(whole.source, whole.setup, lambda _count: None).find(line, number, now.broken)
    if not isinstance(found, RestartPoint):
        return None
    begin = begin_at(found, now, choices or Choices())
    return make_job(whole.source, replace(whole.setup, start=rig.shot.demand, begin=begin), whole)
