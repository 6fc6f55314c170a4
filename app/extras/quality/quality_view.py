"""Page MEASURED PARTS (W): sections on the left, the displayed section on the right with its chart below."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.extras.quality.quality_desk import QualityFunctions
from app.extras.quality.section import QualitySection
from app.screen.page_base import Host
from app.special.special_view import LETTERS, LIST, PAD, SpecialPage
from core.executor.snapshot import Snapshot

if TYPE_CHECKING:
    from app.extras.quality.plots_view import PlotsPane


def _pane_class() -> type[PlotsPane]:
    """Import the chart class on a worker, because importing pyqtgraph takes 0.3 s."""
    from app.extras.quality.plots_view import PlotsPane

    return PlotsPane


class MeasuredPartsPage(SpecialPage):
    """Page of measured parts: like the special functions, with a chart that is loaded on first use."""

    NAME = "MEASURED PARTS"
    model: QualityFunctions

    def __init__(self, host: Host, model: QualityFunctions, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.items.title = self.NAME
        self.chart: PlotsPane | None = None
        self._share = 0.0
        self._asked = False  # whether the chart was requested

    def refresh(self, snapshot: Snapshot, view: MachineStatus, loaded: Loaded) -> None:
        """Update table and chart."""
        super().refresh(snapshot, view, loaded)
        shown = self.model.current
        share = shown.chart_share if isinstance(shown, QualitySection) else 0.0
        if share != self._share:
            self._share = share
            self._lay_out()
        if share:
            self._ask_pane()
        if self.chart is not None and isinstance(shown, QualitySection) and share:
            self.chart.show_drawing(shown.drawing())

    def ahead(self) -> bool:
        """Create the sections, then the chart and its plots, before the page is first shown."""
        self._ask_pane()
        self.model.worker.poll()
        return not self.model.functions or self.chart is None or not self.chart.ahead()

    def _ask_pane(self) -> None:
        if not self._asked:
            self._asked = True
            self.model.worker.queue(_pane_class, self._pane_there, self.desk.say)

    def _pane_there(self, pane: type[PlotsPane]) -> None:
        self.chart = pane(self.look, self)
        self.chart.show()
        self._lay_out()

    def dress(self) -> None:
        """Apply the present colors to the chart."""
        if self.chart is not None:
            self.chart.dress()

    def _lay_out(self) -> None:
        u = self.look.u
        gap, left = max(4, round(0.7 * u)), round(LIST * u)
        pad = 0 if self.pad.isHidden() else round(PAD * u) + gap
        low = 0 if self.letters.isHidden() else round(LETTERS * u) + gap
        right, room = self.width() - left - gap, self.height() - low
        drawn = round(self._share * room)
        self.items.setGeometry(0, 0, left, self.height())
        self.table.setGeometry(left + gap, 0, right - pad, room - drawn)
        self.letters.setGeometry(left + gap, room + gap, right, max(0, low - gap))
        self.pad.setGeometry(self.width() - pad + gap, 0, max(0, pad - gap), self.height())
        if self.chart is not None:
            self.chart.setVisible(drawn > 0)
            self.chart.setGeometry(left + gap, room - drawn + gap, right - pad, max(0, drawn - gap))
