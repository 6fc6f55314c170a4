"""Registration of the optional feature for the job queue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature, Subcommand

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.desk.background_work import LatestRequestWorker
    from app.desk.desk import Desk
    from app.desk.page_description import PageDescription
    from app.desk.persistence import Persistence
    from app.desk.programs.program_loading import LoadingSteps
    from app.special.special_functions import SpecialFunction
    from core.json_keys import JsonOutput
    from core.machine.machine_model import Machine


class JobsExtra(OptionalFeature):
    """Optional feature with the JOBS page, its special function and the command ``turndesk jobs``."""

    subcommands = {
        "jobs": Subcommand("parts", "manage the queue of programs to run next, with their part counts"),
    }

    @property
    def page_descriptions(self) -> Sequence[PageDescription]:
        """Return the description of the JOBS page."""
        from app.desk.page_description import PageDescription

        return (
            PageDescription(
                "JOBS",
                "app.extras.jobs.jobs_view.JobsPage",
                "app.extras.jobs.jobs_model.JobsModel",
                "J",
                "JOBS",
                "next job, number of parts, setup requirements",
                preceding_page="MEASURED PARTS",
                shortcut_key="Shift+F6",
            ),
        )

    def attach_models(
        self, desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps
    ) -> None:
        """Attach the job queue to TurnDesk, with its page and its key in the program list."""
        from app.extras.jobs.jobs_setup import attach_jobs

        attach_jobs(desk, machine, journal, loading_steps)

    def list_special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: LatestRequestWorker
    ) -> Sequence[tuple[SpecialFunction, str]]:
        """Return the JOBS function, paired with the function that it follows in the F10 list."""
        from app.extras.jobs.jobs_watch import JobsFunction

        return ((JobsFunction(desk), "MEASURED PARTS"),)

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON outputs of ``turndesk jobs`` for the reference page."""
        from app.extras.jobs.jobs_command import OUTPUTS

        return OUTPUTS


EXTRA = JobsExtra()
