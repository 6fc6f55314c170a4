"""Page of the analyses: path error, thread passes, ball bar and responses, with drawing and table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, QRectF
from PySide6.QtGui import QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.background_work import Latest
from app.desk.pages.sheet import Key
from app.desk.programs.program_loading import Loaded
from app.desk.status.formats import MM_PER_INCH
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.extras.analyses.analyses import Analyses, Kind, scaled
from app.extras.analyses.drawing import Drawing
from app.screen import page_table
from app.screen.look import Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Panel, Shown
from app.screen.sheet_panel import ListPage, SheetPanel
from core.executor.snapshot import Snapshot

if TYPE_CHECKING:
    from app.extras.analyses.analyses_chart_view import AnalysisChart


_PLOTS = 2  # maximum number of plots in a drawing


def _chart_class() -> type[AnalysisChart]:
    """Import the chart class on a worker, because importing pyqtgraph takes 0.3 s."""
    from app.extras.analyses.analyses_chart_view import AnalysisChart

    return AnalysisChart


class DrawingRoom(QWidget):
    """Area of the drawing, empty until the chart class is loaded."""

    part_name = "CHART"

    def __init__(self, look: Look, worker: Latest, say: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(parent)
        self._look = look
        self.chart: AnalysisChart | None = None  # None until it is loaded
        self._shown: object = None
        worker.queue(_chart_class, self._chart_there, say)

    def _chart_there(self, chart: type[AnalysisChart]) -> None:
        self.chart = chart(self._look, self)
        self.chart.setGeometry(self.rect())
        self.chart.show()

    def ready(self) -> bool:
        """Return whether the chart and its plots exist."""
        return self.chart is not None and self.chart.ready(_PLOTS)

    def show_drawing(self, drawn: object, drawing: Callable[[], Drawing], *, metric: bool) -> None:
        """Show a drawing in mm or inches, unless ``drawn`` identifies the present drawing."""
        if self.chart is None or drawn == self._shown:
            return
        if self.chart.show_drawing(scaled(drawing(), 1.0 if metric else 1.0 / MM_PER_INCH)):
            self._shown = drawn

    def dress(self) -> None:
        """Draw again with the present colors and language."""
        self._shown = None
        if self.chart is not None:
            self.chart.dress()

    def lay_out(self, place: QRect) -> None:
        """Place the area and resize the chart, even while hidden."""
        self.setGeometry(place)
        if self.chart is not None:
            self.chart.setGeometry(self.rect())
            self.chart.dress()


_TABLE, _HEAD = 50.0, 3.4  # units


class Above(Panel):
    """Line with the description of the analysis, or the reason for a missing result."""

    ground = "panel"
    words = Shown("")

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        room = self.area().adjusted(0.8 * u, 0, -0.8 * u, 0)
        painter.write(QRectF(room), self.words, 1.8, "text")


class AnalysesPage(ListPage):
    """Page of the analyses: shows its model."""

    NAME = page_table.ANALYSES
    model: _Keys

    def __init__(self, host: Host, analyses: Analyses, parent: QWidget) -> None:
        super().__init__(host, _Keys(analyses), parent)
        self.analyses = analyses
        self.above = Above(self.look, self)
        self.drawing = DrawingRoom(self.look, analyses.worker, self.desk.say, self)
        self.table = SheetPanel(self.look, analyses.mark, self)

    def ahead(self) -> bool:
        """Create the chart and its plots in steps, before the page is first shown."""
        self.analyses.worker.poll()
        return not self.drawing.ready()

    def _keys(self) -> Mapping[str, Key]:
        choose = self.analyses.choose
        mill = self.desk.machine.language == "klartext"  # no axis of a mill follows the spindle
        thread = {} if mill else {"F3": Key("THREAD", partial(choose, Kind.THREAD))}
        return {
            "F2": Key("PATH", partial(choose, Kind.PATH)),
            **thread,
            "F4": Key("BALL BAR", partial(choose, Kind.BALL_BAR)),
            "F5": Key("NEXT ARC", self.analyses.next_arc),
            "F6": Key("RESPONSE", partial(choose, Kind.RESPONSE)),
            "F8": Key("SCOPE", self._back),
            "F9": Key("TEST", self._test),
            "F10": Key("SPINDLE", partial(choose, Kind.SPINDLE)),
        }

    def _test(self) -> None:
        self.host.go("DRIVE TEST")

    def _back(self) -> None:
        self.host.go(page_table.SCOPE)

    def labels(self) -> tuple[str, ...]:
        """Return the labels of the analyses and of the key that returns to the scope."""
        return self.labels_of({}, self._keys())

    def key_actions(self) -> KeyActions:
        """Return the actions of the function keys and of the magnification."""
        magnify = self.analyses.magnify
        return {
            **{name: key.action for name, key in self._keys().items()},
            "Zoom in": partial(magnify, 1),
            "Zoom out": partial(magnify, -1),
        }

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Change the magnification with the wheel."""
        self.analyses.magnify(1 if event.angleDelta().y() > 0 else -1)
        event.accept()

    def escape(self) -> bool:
        """Clear the message.

        Otherwise leave Esc to the window, which holds the feed during motion.
        """
        if self.desk.notice:
            self.desk.clear()
            return True
        return False

    def refresh(self, _snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Show the present result."""
        analyses = self.analyses
        analyses.look()
        self.above.words = analyses.words
        self.table.show_sheet(analyses.sheet())
        metric = analyses.scope.metric
        shown = (analyses.found, analyses.magnified, analyses.marked, metric)
        self.drawing.show_drawing(shown, analyses.drawing, metric=metric)

    def dress(self) -> None:
        """Apply the present colors and language."""
        self.drawing.dress()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange drawing and table."""
        u = self.look.u
        gap, side, high = max(4, round(0.7 * u)), round(_TABLE * u), round(_HEAD * u)
        left = self.width() - side - gap
        self.above.setGeometry(0, 0, left, high)
        self.drawing.lay_out(QRect(0, high, left, self.height() - high))
        self.table.setGeometry(left + gap, 0, side, self.height())


class _Keys:
    """Adapter between the page and its model."""

    def __init__(self, analyses: Analyses) -> None:
        self._analyses = analyses

    def typed(self, key: str) -> bool:
        """Select a row by arrow keys."""
        return self._analyses.typed(key)

    def takes(self, _key: str) -> bool:
        """Return False, because this page has no entry."""
        return False

    def opened(self) -> None:
        """Analyze the present data."""
        self._analyses.opened()

    def escape(self) -> bool:
        """Return False, because there is nothing to close."""
        return False

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        return tr("ARROWS: SELECT ROW   Z: MAGNIFY   SAME F-KEY AGAIN: UPDATE")

    def leave(self) -> None:
        """Do nothing, because there is nothing to close."""
