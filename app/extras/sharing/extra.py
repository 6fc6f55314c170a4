"""Registration of program sharing with other machines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from app.compose.extra import Close, Extra, Subcommand, Tell

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import Answers
    from app.compose.runs.journal import Journal
    from app.desk.desk import Desk
    from app.desk.page_description import PageEntry
    from app.desk.programs.program_loading import LoadingSteps
    from core.json_key import Output
    from core.machine.machine_model import Machine


class Sharing(Extra):
    """Optional feature with the page SHARED PROGRAMS, ``turndesk share`` and the table [sharing]."""

    commands = {
        "share": Subcommand("jobs", "share programs with other controls: publish, take, compare"),
    }
    threads = {"sharing": "PROGRAM SHARING"}

    machine_tables = {"core.extras.sharing.sharing_table": ("sharing",)}

    @property
    def pages(self) -> Sequence[PageEntry]:
        from app.desk.page_description import PageEntry

        return (
            PageEntry(
                "SHARED PROGRAMS",
                "app.extras.sharing.sharing_view.SharedProgramsPage",
                "app.extras.sharing.sharing_model.SharingModel",
                "X",
                "SHARED",
                "programs from other TurnDesk controls; newer versions are copied on request",
                after="JOBS",
            ),
        )

    def attach(self, desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
        from app.extras.sharing.sharing_desk import attach_sharing

        attach_sharing(desk, machine, journal)

    def start(self, desk: Desk, journal: Journal, tell: Tell) -> Close | None:
        from app.extras.sharing.sharing_desk import start_sharing

        return start_sharing(desk, journal)

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        from app.extras.sharing.share_command import FOLLOWS, OUTPUTS

        return {FOLLOWS: OUTPUTS}

    def check(self, machine: Machine, answers: Answers) -> None:
        from app.extras.sharing.sharing_check import check_sharing

        check_sharing(machine, answers)


EXTRA = Sharing()
