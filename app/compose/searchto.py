"""SEARCHTO of a desk on this machine."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.desk.desk import Desk
from app.desk.latest import Watch
from app.searchto.searchto_model import SearchtoModel
from core.executor.job import Job
from core.interpreter.restart.restart_approach import Choices
from core.machine.model import Machine

if TYPE_CHECKING:
    from core.interpreter.restart.state_rebuild import StateRebuild

_MODEST = 0.2  # of the manual rapid: legs within the part


def rebuilt(job: Job, watch: Watch) -> StateRebuild:
    """What goes through the program of a job; the interpreter is loaded when it is first asked for."""
    from core.interpreter.restart.state_rebuild import StateRebuild

    return StateRebuild(job.source, job.setup, watch)


def give_searchto(desk: Desk, machine: Machine) -> None:
    """Give the desk its SEARCHTO; its ways go at the manual rapid, slower within the part."""
    rapid = machine.manual_rapid
    choices = Choices(rapid=rapid, modest=_MODEST * rapid)
    desk.searchto = SearchtoModel(
        desk.session, desk.post, desk.snapshot, desk.say, desk.clear, rebuilt, choices
    )
