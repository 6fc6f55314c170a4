"""Registration of the optional feature that shares programs with other machines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.optional_features import CloseFunction, OptionalFeature, ReportFunction, Subcommand

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import MachineCheckResults
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from app.desk.page_description import PageDescription
    from app.desk.programs.program_loading import LoadingSteps
    from core.json_keys import JsonOutput
    from core.machine.machine_model import Machine


class SharingExtra(OptionalFeature):
    """Optional feature with the SHARED PROGRAMS page, ``turndesk share`` and the table [sharing]."""

    subcommands = {
        "share": Subcommand("jobs", "share programs with other controls: publish, take, compare"),
    }
    supervised_threads = {"sharing": "PROGRAM SHARING"}

    machine_tables = {"core.extras.sharing.sharing_table": ("sharing",)}

    @property
    def page_descriptions(self) -> Sequence[PageDescription]:
        """Return the description of the SHARED PROGRAMS page."""
        from app.desk.page_description import PageDescription

        return (
            PageDescription(
                "SHARED PROGRAMS",
                "app.extras.sharing.sharing_view.SharedProgramsPage",
                "app.extras.sharing.sharing_model.SharingModel",
                "X",
                "SHARED",
                "programs from other TurnDesk controls; newer versions are copied on request",
                preceding_page="JOBS",
            ),
        )

    def attach_models(
        self, desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps
    ) -> None:
        """Attach the page of shared programs to TurnDesk.

        If there is no store or no [sharing] table, the page shows the reason why no programs are shared.
        """
        from app.extras.sharing.sharing_setup import attach_sharing

        attach_sharing(desk, machine, journal)

    def start_services(
        self, desk: Desk, journal: Journal, report_reason: ReportFunction
    ) -> CloseFunction | None:
        """Start the synchronization thread, and return the function that stops the thread.

        The result is None if the machine file has no [sharing] table or the shared location cannot be used.
        """
        from app.extras.sharing.sharing_setup import start_sharing

        return start_sharing(desk, journal)

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON outputs of ``turndesk share`` for the reference page."""
        from app.extras.sharing.share_command import OUTPUTS, PRECEDING_COMMAND

        return {PRECEDING_COMMAND: OUTPUTS}

    def add_check_rows(self, machine: Machine, results: MachineCheckResults) -> None:
        """Add a row that shows whether the shared location responds and is set up for sharing.

        If the machine file has no [sharing] table, no row is added.
        """
        from app.extras.sharing.sharing_check import add_sharing_check_row

        add_sharing_check_row(machine, results)


EXTRA = SharingExtra()
