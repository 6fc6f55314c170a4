"""MDI of a desk: how its lines are proved on this machine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from app.compose.machine import setup_for
from app.compose.offsets import Offsets
from app.desk.desk import Desk
from app.desk.latest import Watch
from app.desk.persistence import Persistence
from app.desk.program_loading import Proved
from app.mdi.mdi_model import MdiModel, ProveLine, Typing
from core.executor.job import Job, make_job
from core.executor.snapshot import Snapshot
from core.interpreter.checkpoint import Begin, Checkpoint
from core.language.source import Source
from core.machine.model import Machine


def point_of(snapshot: Snapshot) -> Checkpoint:
    """What the next line inherits at the machine of this instant."""
    return Checkpoint(snapshot.modal, tool_line=-1 if snapshot.tool_open else 0)


def line_prover(machine: Machine, offsets: Callable[[], Offsets]) -> ProveLine:
    """Proves a line as a program is proved, from where the slides stand."""

    def prove_line(text: str, snapshot: Snapshot, watch: Watch) -> tuple[Job, Proved]:
        from app.compose.proof import proof_of
        from core.proving.prove_program import prove

        tools, secondary = offsets()
        setup = replace(
            setup_for(machine, tools=tools, secondary=secondary),
            start=snapshot.demand,
            begin=Begin(point_of(snapshot), single=True),
        )
        job = make_job(Source("MDI", text), setup)
        report = prove(job.reading, job.setup, machine, watch)
        return job, Proved(proof_of(job, report), report.diagnostics)

    return prove_line


def give_mdi(desk: Desk, machine: Machine, offsets: Callable[[], Offsets], keep: Persistence) -> None:
    """Give the desk its MDI."""
    prove_line = line_prover(machine, offsets)
    desk.mdi = MdiModel(prove_line, desk.post, desk.snapshot, desk.say, desk.clear, Typing(keep))
