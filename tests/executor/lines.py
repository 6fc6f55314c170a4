"""An operator at MDI, as the executor sees him: a line is proved, prepared and started."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from app.compose.machine.machine_setup import get_control_limits
from app.compose.program_proving import create_proof
from app.searchto.restart_plan import read_machine_state
from core.executor.commands import CycleStart, PrepareCycleStart
from core.executor.job import Job, make_job
from core.executor.snapshot import MachineState, StartAction
from core.interpreter.restart.restart_approach import OperatorChoices, make_lathe_pass_start
from core.interpreter.restart.restart_point import RestartPoint
from core.interpreter.restart.state_rebuild import OmniturnRestartSearch
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.diagnostics import Diagnostic
from core.language.source import Dialect, ProgramSource
from core.proving.prove_program import prove
from tests.executor.rig import Rig

TOOLS: Mapping[int, ToolOffset] = {1: ToolOffset(-12.7, -50.8), 2: ToolOffset(6.35, -25.4)}


def line_job(rig: Rig, text: str, tools: Mapping[int, ToolOffset] = TOOLS) -> Job:
    """The job of a line at the machine as it stands."""
    shot = rig.shot
    point = Checkpoint(shot.modal, tool_line=-1 if shot.is_tool_move_pending else 0)
    setup = InterpreterSetup(
        tools=tools,
        limits=get_control_limits(rig.machine),
        start=shot.demand,
        begin=PassStart(point, is_mdi_line=True),
    )
    return make_job(ProgramSource("MDI", text, Dialect(rig.machine.mdi_language)), setup)


def errors(rig: Rig, text: str) -> list[Diagnostic]:
    """Return the errors that proving finds in a line."""
    job = line_job(rig, text)
    return list(prove(job.source, job.setup, rig.machine).errors)


def press(rig: Rig, text: str) -> None:
    """Prove, prepare, and Cycle Start; the line must be a good one."""
    if rig.state is MachineState.DISABLED:
        rig.ready()
    rig.run(0.35)  # no bounce of the last start
    job = line_job(rig, text)
    report = prove(job.source, job.setup, rig.machine)
    assert not report.errors, report.errors
    rig.post(PrepareCycleStart(StartAction.MDI_LINE, job, create_proof(job, report)))
    rig.post(CycleStart())
    assert not rig.shot.start_refusal_reason, rig.shot.start_refusal_reason


def mdi(rig: Rig, *lines: str) -> None:
    """One line after the other, each to its end."""
    for line in lines:
        press(rig, line)
        rig.until(MachineState.IDLE)


def restart_job(rig: Rig, line: int, choices: OperatorChoices | None = None, number: int = 0) -> Job | None:
    """The job that goes on from a line of the loaded program at the machine as it stands; None: it cannot."""
    whole = rig.executor._control.status.job
    assert whole is not None
    now = read_machine_state(rig.shot, whole)
    found = OmniturnRestartSearch(whole.source, whole.setup, lambda _count: None).find_restart_point(
        line, number, now.interruption
    )
    if not isinstance(found, RestartPoint):
        return None
    begin = make_lathe_pass_start(found, now, choices or OperatorChoices())
    return make_job(whole.source, replace(whole.setup, start=rig.shot.demand, begin=begin), whole)
