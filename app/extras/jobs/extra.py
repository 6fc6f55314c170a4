"""Registration of the job queue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.extra import Extra, Subcommand

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.background_work import Latest
    from app.desk.desk import Desk
    from app.desk.page_description import PageEntry
    from app.desk.persistence import Persistence
    from app.desk.programs.program_loading import LoadingSteps
    from app.special.special_functions import SpecialFunction
    from core.json_key import Output
    from core.machine.machine_model import Machine


class Jobs(Extra):
    """Optional feature with the page JOBS, its special function and ``turndesk jobs``."""

    commands = {
        "jobs": Subcommand("parts", "manage the queue of programs to run next, with their part counts"),
    }

    @property
    def pages(self) -> Sequence[PageEntry]:
        from app.desk.page_description import PageEntry

        return (
            PageEntry(
                "JOBS",
                "app.extras.jobs.jobs_view.JobsPage",
                "app.extras.jobs.jobs_model.JobsModel",
                "J",
                "JOBS",
                "next job, number of parts, setup requirements",
                after="MEASURED PARTS",
                shortcut="Shift+F6",
            ),
        )

    def attach(self, desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
        from app.extras.jobs.jobs_desk import attach_jobs

        attach_jobs(desk, machine, journal, work)

    def special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: Latest
    ) -> Sequence[tuple[SpecialFunction, str]]:
        from app.extras.jobs.jobs_watch import JobsFunction

        return ((JobsFunction(desk), "MEASURED PARTS"),)

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        from app.extras.jobs.jobs_command import OUTPUTS

        return OUTPUTS


EXTRA = Jobs()
