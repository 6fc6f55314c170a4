"""Where an analysis is drawn: its chart comes when a worker has loaded what charts need."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QRect
from PySide6.QtWidgets import QWidget

from app.desk.background_work import Latest
from app.desk.status.formats import MM_PER_INCH
from app.extras.analyses.analyses import scaled
from app.extras.analyses.drawing import Drawing
from app.screen.look import Look

if TYPE_CHECKING:
    from app.extras.analyses.analyses_chart_view import AnalysisChart

_PLOTS = 2  # of a drawing at most


def _chart_class() -> type[AnalysisChart]:
    """On a worker: pyqtgraph takes a third of a second."""
    from app.extras.analyses.analyses_chart_view import AnalysisChart

    return AnalysisChart


class DrawingRoom(QWidget):
    """Empty until the chart is there; then what was shown last."""

    part_name = "CHART"

    def __init__(self, look: Look, worker: Latest, say: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(parent)
        self._look = look
        self.chart: AnalysisChart | None = None  # until it is there
        self._shown: object = None
        worker.queue(_chart_class, self._chart_there, say)

    def _chart_there(self, chart: type[AnalysisChart]) -> None:
        self.chart = chart(self._look, self)
        self.chart.setGeometry(self.rect())
        self.chart.show()

    def ready(self) -> bool:
        """Whether nothing has to be made any more before a drawing can be shown."""
        return self.chart is not None and self.chart.ready(_PLOTS)

    def show_drawing(self, drawn: object, drawing: Callable[[], Drawing], *, metric: bool) -> None:
        """The drawing (mm) of what ``drawn`` names, in mm or inches; nothing where that is shown already."""
        if self.chart is None or drawn == self._shown:
            return
        if self.chart.show_drawing(scaled(drawing(), 1.0 if metric else 1.0 / MM_PER_INCH)):
            self._shown = drawn

    def dress(self) -> None:
        """Other colours, or another language, are in force."""
        self._shown = None
        if self.chart is not None:
            self.chart.dress()

    def lay_out(self, place: QRect) -> None:
        """Put it there; what is shown follows, also while it is hidden."""
        self.setGeometry(place)
        if self.chart is not None:
            self.chart.setGeometry(self.rect())
            self.chart.dress()
