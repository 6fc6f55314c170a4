"""Registration of measured parts and the shift report."""

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


class Quality(Extra):
    """Optional feature with the page MEASURED PARTS, the shift report, commands and the table [gauge]."""

    commands = {
        "parts": Subcommand(
            "alarms", "show the stored part counts, cycle times, readings and offset changes"
        ),
        "shift": Subcommand("share", "print a shift report: parts, times, stops, alarms, offsets, readings"),
    }
    own_functions = ("TOOL LIFE",)
    machine_tables = {"app.extras.quality.gauge_table": ("gauge",)}
    tables_follow = "dnc"

    @property
    def pages(self) -> Sequence[PageEntry]:
        from app.desk.page_description import PageEntry

        return (
            PageEntry(
                "MEASURED PARTS",
                "app.extras.quality.quality_view.MeasuredPartsPage",
                "app.extras.quality.quality_desk.QualityFunctions",
                "W",
                "MEASURED",
                "features, readings, charts, trends",
                later=(
                    "app.extras.quality.plots_view.PlotsPane",
                    "app.extras.quality.sections_desk.sections",
                ),
                after="SCOPE",
            ),
        )

    def attach(self, desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
        from app.extras.quality.quality_desk import attach_quality

        attach_quality(desk, machine)

    def special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: Latest
    ) -> Sequence[tuple[SpecialFunction, str]]:
        from app.desk.data_folder import data_folder
        from app.extras.quality.quality_desk import MeasuredPartsFunction
        from app.extras.quality.shift_function import ShiftReport

        report = ShiftReport(desk, machine.name, worker, data_folder() / "sheets")
        parts = MeasuredPartsFunction(desk)
        return ((parts, "SCOPE"), (report, "JOBS"))

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        from app.extras.quality.quality_json_keys import OUTPUTS

        return OUTPUTS


EXTRA = Quality()
