"""Page of the analyses: path error, screw thread passes, ball-bar plot and responses.

Each analysis has a drawing and a table.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, QRectF
from PySide6.QtGui import QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.background_work import LatestRequestWorker
from app.desk.pages.table_content import FunctionKey
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.formats import MM_PER_INCH
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.extras.analyses.analyses import AnalysesModel
from app.extras.analyses.analysis_result import AnalysisKind
from app.extras.analyses.drawing import AnalysisDrawing, scale_drawing
from app.screen import page_table
from app.screen.page_base import KeyActions, PageHost
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ScreenTheme, ThemedPainter
from app.screen.table_panel import ListPage, TablePanel
from core.executor.snapshot import Snapshot

if TYPE_CHECKING:
    from app.extras.analyses.analyses_chart_view import AnalysisChart


_PLOTS = 2  # maximum number of plots in a drawing


def _chart_class() -> type[AnalysisChart]:
    """Import and return the chart class.

    A worker calls this function, because importing pyqtgraph takes 0.3 s.
    """
    from app.extras.analyses.analyses_chart_view import AnalysisChart

    return AnalysisChart


class DrawingArea(QWidget):
    """Area of the drawing, which is empty until the chart class is loaded."""

    accessible_name = "CHART"

    def __init__(
        self,
        theme: ScreenTheme,
        worker: LatestRequestWorker,
        show_message: Callable[[str], None],
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self._look = theme
        self.chart: AnalysisChart | None = None  # None until it is loaded
        self._shown: object = None
        worker.enqueue_work(_chart_class, self._chart_there, show_message)

    def _chart_there(self, chart: type[AnalysisChart]) -> None:
        self.chart = chart(self._look, self)
        self.chart.setGeometry(self.rect())
        self.chart.show()

    def is_ready(self) -> bool:
        """Return whether the chart and its plots exist."""
        return self.chart is not None and self.chart.prepare_plots(_PLOTS)

    def show_drawing(
        self, drawing_id: object, make_drawing: Callable[[], AnalysisDrawing], *, metric: bool
    ) -> None:
        """Show a drawing in mm or inches, unless it is already shown.

        ``drawing_id`` identifies the drawing. ``make_drawing`` is called only if the drawing is not shown
        yet.
        """
        if self.chart is None or drawing_id == self._shown:
            return
        if self.chart.show_drawing(scale_drawing(make_drawing(), 1.0 if metric else 1.0 / MM_PER_INCH)):
            self._shown = drawing_id

    def apply_theme(self) -> None:
        """Draw the chart again in the current colors and language."""
        self._shown = None
        if self.chart is not None:
            self.chart.apply_theme()

    def lay_out(self, place: QRect) -> None:
        """Place the area and resize the chart. The chart is resized even while the area is hidden."""
        self.setGeometry(place)
        if self.chart is not None:
            self.chart.setGeometry(self.rect())
            self.chart.apply_theme()


_TABLE, _HEAD = 50.0, 3.4  # units


class DescriptionLine(Panel):
    """Line with the description of the analysis, or the reason why it has no result."""

    background_color = "panel"
    description_text = RedrawingAttribute("")

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the description of the analysis, or the reason why it has no result."""
        u = self.theme.unit_px
        room = self.find_full_area().adjusted(0.8 * u, 0, -0.8 * u, 0)
        painter.draw_text_line(QRectF(room), self.description_text, 1.8, "text")


class AnalysesPage(ListPage):
    """Screen page for the analyses."""

    NAME = page_table.ANALYSES
    model: _AnalysesKeyAdapter

    def __init__(self, host: PageHost, analyses: AnalysesModel, parent: QWidget) -> None:
        super().__init__(host, _AnalysesKeyAdapter(analyses), parent)
        self.analyses = analyses
        self.description = DescriptionLine(self.theme, self)
        self.drawing = DrawingArea(self.theme, analyses.worker, self.desk.say, self)
        self.table = TablePanel(self.theme, analyses.select_row, self)
        self.table.on_select = analyses.select_row

    def continue_preparation(self) -> bool:
        """Create one part of the chart in advance, and return whether further parts must be created."""
        self.analyses.worker.deliver_results()
        return not self.drawing.is_ready()

    def _keys(self) -> Mapping[str, FunctionKey]:
        choose = self.analyses.choose_analysis
        mill = self.desk.machine.program_language == "klartext"  # no axis of a mill follows the spindle
        thread = {} if mill else {"F3": FunctionKey("THREAD", partial(choose, AnalysisKind.THREAD))}
        return {
            "F2": FunctionKey("PATH", partial(choose, AnalysisKind.PATH)),
            **thread,
            "F4": FunctionKey("BALL BAR", partial(choose, AnalysisKind.BALL_BAR)),
            "F5": FunctionKey("NEXT ARC", self.analyses.select_next_arc),
            "F6": FunctionKey("RESPONSE", partial(choose, AnalysisKind.AXIS_RESPONSE)),
            "F8": FunctionKey("SCOPE", self._back),
            "F9": FunctionKey("TEST", self._test),
            "F10": FunctionKey("SPINDLE", partial(choose, AnalysisKind.SPINDLE_RESPONSE)),
        }

    def _test(self) -> None:
        self.host.open_page("DRIVE TEST")

    def _back(self) -> None:
        self.host.open_page(page_table.SCOPE)

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the labels of the keys that select an analysis and of the key that returns to the scope."""
        return self.make_function_key_labels({}, self._keys())

    def make_key_actions(self) -> KeyActions:
        """Return the actions of the function keys and of the magnification keys."""
        magnify = self.analyses.change_magnification
        return {
            **{name: key.action for name, key in self._keys().items()},
            "Zoom in": partial(magnify, 1),
            "Zoom out": partial(magnify, -1),
        }

    def find_list(self) -> TablePanel:
        """Return the table of the analysis."""
        return self.table

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Change the magnification with the mouse wheel."""
        self.analyses.change_magnification(1 if event.angleDelta().y() > 0 else -1)
        event.accept()

    def handle_escape(self) -> bool:
        """Clear the message, and return whether there was a message to clear.

        Without a message, the window handles Esc, which starts a feed hold during motion.
        """
        if self.desk.prompt_notice:
            self.desk.clear_prompt_line()
            return True
        return False

    def refresh(self, _snapshot: Snapshot, _view: MachineStatus, _loaded: LoadedProgram) -> None:
        """Update the model and show the current result."""
        analyses = self.analyses
        analyses.update()
        self.description.description_text = analyses.description
        self.table.show_table(analyses.make_table())
        metric = analyses.scope.metric
        shown = (analyses.result, analyses.magnification, analyses.selected_row, metric)
        self.drawing.show_drawing(shown, analyses.make_drawing, metric=metric)

    def apply_theme(self) -> None:
        """Apply the current colors and language."""
        self.drawing.apply_theme()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the drawing and the table."""
        u = self.theme.unit_px
        gap, side, high = max(4, round(0.7 * u)), round(_TABLE * u), round(_HEAD * u)
        left = self.width() - side - gap
        self.description.setGeometry(0, 0, left, high)
        self.drawing.lay_out(QRect(0, high, left, self.height() - high))
        self.table.setGeometry(left + gap, 0, side, self.height())


class _AnalysesKeyAdapter:
    """Adapter that passes key presses on the page to the model."""

    def __init__(self, analyses: AnalysesModel) -> None:
        self._analyses = analyses

    def handle_key(self, key: str) -> bool:
        """Select a row with the arrow keys, and return whether the key was used."""
        return self._analyses.handle_key(key)

    def accepts_key(self, _key: str) -> bool:
        """Return False because this page has no entry field."""
        return False

    def on_open(self) -> None:
        """Start the analysis of the current data when the page opens."""
        self._analyses.restart_analysis()

    def handle_escape(self) -> bool:
        """Return False because the model has no entry or question that Esc could close."""
        return False

    def prompt_text(self) -> str:
        """Return the prompt that explains the current keys."""
        return tr("ARROWS: SELECT ROW   Z: MAGNIFY   SAME F-KEY AGAIN: UPDATE")

    def on_close(self) -> None:
        """Do nothing because the model has nothing to close."""
