"""Registration of the optional feature for measured parts and the shift report."""

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


class QualityExtra(OptionalFeature):
    """Optional feature with the MEASURED PARTS page, the shift report, commands and the table [gauge]."""

    subcommands = {
        "parts": Subcommand(
            "alarms", "show the stored part counts, cycle times, readings and offset changes"
        ),
        "shift": Subcommand("share", "print a shift report: parts, times, stops, alarms, offsets, readings"),
    }
    own_special_functions = ("TOOL LIFE",)
    machine_tables = {"app.extras.quality.gauge_table": ("gauge",)}
    preceding_table = "dnc"

    @property
    def page_descriptions(self) -> Sequence[PageDescription]:
        """Return the description of the MEASURED PARTS page."""
        from app.desk.page_description import PageDescription

        return (
            PageDescription(
                "MEASURED PARTS",
                "app.extras.quality.quality_view.MeasuredPartsPage",
                "app.extras.quality.quality_setup.QualitySectionList",
                "W",
                "MEASURED",
                "features, readings, charts, trends",
                deferred_modules=(
                    "app.extras.quality.plots_view.PlotsPane",
                    "app.extras.quality.sections_setup.make_sections",
                ),
                preceding_page="SCOPE",
            ),
        )

    def attach_models(
        self, desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps
    ) -> None:
        """Attach the measured parts and the sampling plan to TurnDesk if production data are available."""
        from app.extras.quality.quality_setup import attach_quality

        attach_quality(desk, machine)

    def list_special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: LatestRequestWorker
    ) -> Sequence[tuple[SpecialFunction, str]]:
        """Return the MEASURED PARTS function and the shift report function, each with its predecessor.

        In the F10 list, MEASURED PARTS follows SCOPE, and the shift report follows JOBS.
        """
        from app.desk.data_folder import find_data_folder
        from app.extras.quality.quality_setup import MeasuredPartsFunction
        from app.extras.quality.shift_function import ShiftReportFunction

        report = ShiftReportFunction(desk, machine.name, worker, find_data_folder() / "sheets")
        parts = MeasuredPartsFunction(desk)
        return ((parts, "SCOPE"), (report, "JOBS"))

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON outputs of ``turndesk parts`` and ``turndesk shift`` for the reference page."""
        from app.extras.quality.quality_json_keys import OUTPUTS

        return OUTPUTS


EXTRA = QualityExtra()
