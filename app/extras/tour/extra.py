"""Registration of the optional feature with the tour of TurnDesk."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.optional_features import OptionalFeature, Subcommand

if TYPE_CHECKING:
    from app.desk.background_work import LatestRequestWorker
    from app.desk.desk import Desk
    from app.desk.persistence import Persistence
    from app.special.special_functions import SpecialFunction
    from core.machine.machine_model import Machine


class TourExtra(OptionalFeature):
    """Optional feature with the tour: at the first start of the demo, in F10 and as ``turndesk tour``."""

    subcommands = {
        "tour": Subcommand(
            "run", "watch a simulated lathe make a part in one minute; any key or touch ends the tour"
        )
    }

    opening_show_class = "app.extras.tour.tour_view.Tour"

    def begins_with_show(self, folder: Path) -> bool:
        """Return whether this data folder of the demo is unused, so that the tour begins."""
        from app.extras.tour.tour_setup import is_first_start

        return is_first_start(folder)

    def list_special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: LatestRequestWorker
    ) -> Sequence[tuple[SpecialFunction, str]]:
        """Return the special function TOUR of a lathe, which follows LESSONS."""
        if machine.kind != "lathe":
            return ()
        from app.extras.tour.tour_function import TourFunction
        from app.extras.tour.tour_setup import is_fully_simulated

        return ((TourFunction(desk, is_simulated=is_fully_simulated(machine)), "LESSONS"),)


EXTRA = TourExtra()
