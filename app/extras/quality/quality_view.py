"""Page MEASURED PARTS (W), with the section list on the left and the open section on the right.

The chart is below the open section.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.extras.quality.quality_setup import QualitySectionList
from app.extras.quality.section import QualitySection
from app.screen.page_base import PageHost
from app.special.special_view import LETTER_PAD_HEIGHT, LIST, PAD, SpecialFunctionsPage
from core.executor.snapshot import Snapshot

if TYPE_CHECKING:
    from app.extras.quality.plots_view import PlotsPane


def _pane_class() -> type[PlotsPane]:
    """Import and return the class of the chart.

    A worker calls this function, because importing pyqtgraph takes 0.3 s.
    """
    from app.extras.quality.plots_view import PlotsPane

    return PlotsPane


class MeasuredPartsPage(SpecialFunctionsPage):
    """Screen page for measured parts.

    The page works like the special functions page, but also has a chart that is loaded at its first use.
    """

    NAME = "MEASURED PARTS"
    model: QualitySectionList

    def __init__(self, host: PageHost, model: QualitySectionList, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.function_list.title = self.NAME
        self.chart: PlotsPane | None = None
        self._share = 0.0
        self._asked = False  # whether the chart was requested

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram) -> None:
        """Update the table and the chart of the open section."""
        super().refresh(snapshot, status, loaded)
        shown = self.model.shown_function
        share = shown.chart_share if isinstance(shown, QualitySection) else 0.0
        if share != self._share:
            self._share = share
            self._lay_out()
        if share:
            self._ask_pane()
        if self.chart is not None and isinstance(shown, QualitySection) and share:
            self.chart.show_drawing(shown.make_chart())

    def continue_preparation(self) -> bool:
        """Create the sections, the chart and its plots step by step before the page is first shown.

        Returns whether more steps remain.
        """
        self._ask_pane()
        self.model.worker.deliver_results()
        return not self.model.functions or self.chart is None or not self.chart.prepare_next_plot()

    def _ask_pane(self) -> None:
        if not self._asked:
            self._asked = True
            self.model.worker.enqueue_work(_pane_class, self._pane_there, self.desk.say)

    def _pane_there(self, pane: type[PlotsPane]) -> None:
        self.chart = pane(self.theme, self)
        self.chart.show()
        self._lay_out()

    def apply_theme(self) -> None:
        """Apply the current colors to the chart."""
        if self.chart is not None:
            self.chart.apply_theme()

    def _lay_out(self) -> None:
        u = self.theme.unit_px
        gap, left = max(4, round(0.7 * u)), round(LIST * u)
        pad = 0 if self.number_pad.isHidden() else round(PAD * u) + gap
        low = 0 if self.letter_pad.isHidden() else round(LETTER_PAD_HEIGHT * u) + gap
        right, room = self.width() - left - gap, self.height() - low
        drawn = 0 if self.is_searching else round(self._share * room)
        self.function_list.setGeometry(0, 0, left, self.height())
        self.table_panel.setGeometry(left + gap, 0, right - pad, room - drawn)
        self.letter_pad.setGeometry(left + gap, room + gap, right, max(0, low - gap))
        self.number_pad.setGeometry(self.width() - pad + gap, 0, max(0, pad - gap), self.height())
        if self.chart is not None:
            self.chart.setVisible(drawn > 0)
            self.chart.setGeometry(left + gap, room - drawn + gap, right - pad, max(0, drawn - gap))
