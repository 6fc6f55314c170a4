"""What Cycle Start begins: the program, a restart in it, or a line of MDI; and why it may not."""

from __future__ import annotations

from core.executor import gate
from core.executor.bench import Bench
from core.executor.inherited import as_it_is
from core.executor.job import Job, outdated
from core.executor.snapshot import Starts, State
from core.executor.standing import Standing
from core.interpreter.checkpoint import Begin
from core.interpreter.modal_state import Modal

_NOTHING = {
    Starts.LINE: "no line is ready: type one and press Enter",
    Starts.RESTART: "no restart is ready: search a line and confirm it",
}
_SAME = 0.01  # mm, degrees: nearer than this the slides stand where a way was planned from


def job_of(standing: Standing) -> Job | None:
    """The job that Cycle Start would begin."""
    return standing.job if standing.starts is Starts.PROGRAM else standing.prepared


def refusal(bench: Bench, state: State, standing: Standing) -> str:
    """Why Cycle Start does nothing now; empty when it may start."""
    job, proof = job_of(standing), standing.proof
    if standing.starts is not Starts.PROGRAM:
        proof = standing.prepared_proof
    if job is None and standing.starts in _NOTHING:
        return gate.hindrance(bench, state) or _NOTHING[standing.starts]
    return gate.refusal(bench, state, job, proof) or (_moved(bench, job) or _changed(bench, standing, job))


def _moved(bench: Bench, job: Job | None) -> str:
    if job is None or job.setup.begin is None:
        return ""
    at, _ = bench.ports.axes.demand_at(bench.now)
    away = max(abs(a - b) for a, b in zip(at, job.setup.start, strict=False))
    if away <= _SAME:
        return ""
    return f"the slides have moved since this was proved: {_again(job.setup.begin)}"


def _changed(bench: Bench, standing: Standing, job: Job | None) -> str:
    """Whether what the program, the line or the restart was proved for is still so."""
    if job is None:
        return ""
    begin = job.setup.begin
    if begin is None:
        old = outdated(job, standing.modal)
        return f"{old}, and the program says nothing of it: load it again" if old else ""
    now = as_it_is(standing.modal, bench)
    if not begin.single:
        return _restart(standing, job, begin, now)
    same = now == begin.checkpoint.modal
    return "" if same else f"the state has changed since the line was proved: {_again(begin)}"


def _again(begin: Begin) -> str:
    """How the operator has it proved anew."""
    if begin.single:
        return "ask for the way out again" if begin.way else "press Enter again"
    return "search for the line again"


def _restart(standing: Standing, job: Job, begin: Begin, now: Modal) -> str:
    """The program must still be the one that is loaded, and the collet as the line has it."""
    if standing.job is None or standing.job.digest != job.part_of:
        return "the program was loaded anew: search for the line again"
    wanted = begin.checkpoint.modal.collet_closed
    if now.collet_closed != wanted:
        is_now, must = ("closed", "open") if now.collet_closed else ("open", "closed")
        return f"the collet is {is_now} and must be {must} at line {begin.line}: use MDI"
    return gate.unproved(standing.job, standing.proof)
