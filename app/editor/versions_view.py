"""View of the version history, with the versions on the left and the differences on the right."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtWidgets import QWidget

from app.desk.pages.table_content import WHOLE_LIST, FunctionKey
from app.desk.status.formats import format_local_time
from app.editor.version_history import DifferenceRow, VersionHistory
from app.screen.panel import RedrawingAttribute
from app.screen.screen_theme import (
    ALIGN_LEFT,
    ALIGN_RIGHT,
    ScreenTheme,
    ThemedPainter,
    draw_raw_text,
    draw_text,
)
from app.screen.table_panel import RowPanel
from core.message import Message
from core.store.store_rows import ProgramVersionRow

VERSION_ROW_HEIGHT = 5.2  # units: height of a version, at least a fingertip
COMPARISON_LINE_HEIGHT = 2.9  # units: height of a line of the comparison
LIST_WIDTH = 50.0  # units: width of the list of versions
SIGN_COLORS = {"+": "run", "-": "alarm", " ": "soft", "…": "off"}


class VersionList(RowPanel):
    """List of versions, with a comparison between the selected version and the current text.

    The history model stores which version is selected. The selected version is in the middle of the list.
    The scroll keys scroll only the comparison.
    """

    title = "HISTORY"
    has_scroll_keys = False
    _shown: RedrawingAttribute[tuple[object, ...]] = RedrawingAttribute(())

    def __init__(self, theme: ScreenTheme, version_history: VersionHistory, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._history = version_history
        self.hide()

    def refresh(self) -> None:
        """Redraw the list if the history has changed.

        This method is called once per frame.
        """
        history = self._history
        now = (history.rows, history.marked, history.changes, history.words())
        if now[:3] != self._shown[:3]:
            self.first_row = 0
        self._shown = now

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the versions around the selected version, and the comparison of the selected version."""
        u, history = self.theme.unit_px, self._history
        high = self.theme.find_row_height(VERSION_ROW_HEIGHT, 9.0, is_touchable=True)
        rows = max(1, int((self.height() - 4.0 * u) / high))
        first = max(0, min(history.marked - rows // 2, len(history.rows) - rows))
        for place, version in enumerate(history.rows[first : first + rows]):
            box = QRectF(1.2 * u, 3.0 * u + place * high, (LIST_WIDTH - 1.2) * u, high)
            marked = first + place == history.marked
            self._version(painter, box, version, marked)
            self.add_target(box, partial(history.mark, first + place), kind="row", is_on=marked)
        self._comparison(painter)

    def _version(self, painter: ThemedPainter, box: QRectF, version: ProgramVersionRow, marked: bool) -> None:
        u = self.theme.unit_px
        if marked:
            painter.fill_rect(box, "lit")
        ink, soft = ("on_lit", "on_lit") if marked else ("text", "soft")
        at = format_local_time(version.saved).replace(" ", "  ")
        upper = box.adjusted(u, 0.4 * u, -u, -box.height() / 2)
        painter.draw_text_line(upper, f"{version.number}", 2.0, ink)
        painter.draw_text_line(upper.adjusted(5 * u, 0, 0, 0), at, 1.8, ink, bold=False)
        painter.draw_text_line(
            upper, Message("{size} bytes", size=version.size), 1.6, soft, at=ALIGN_RIGHT, bold=False
        )
        draw_text(
            painter,
            upper.translated(5 * u, upper.height()),
            ALIGN_LEFT,
            f"{version.why} ({version.who})" if version.who else version.why,
        )

    def _comparison(self, painter: ThemedPainter) -> None:
        u, history = self.theme.unit_px, self._history
        room = QRectF((LIST_WIDTH + 2) * u, 2.8 * u, self.width() - (LIST_WIDTH + 3.4) * u, 3 * u)
        head = history.words() or history.heading()
        painter.draw_text_line(room, head, 1.8, "text", fit=False)
        room = QRectF(room.x(), 6.2 * u, room.width(), self.height() - 8.0 * u)
        count = len(history.changes)
        self.draw_scroll_keys(
            painter, room, self.count_fitting_rows(room, COMPARISON_LINE_HEIGHT * u, count), count
        )
        for number, row in self.find_row_boxes(room, COMPARISON_LINE_HEIGHT * u):
            self._change(painter, row, history.changes[number])

    def _change(self, painter: ThemedPainter, row: QRectF, change: DifferenceRow) -> None:
        u = self.theme.unit_px
        number = QRectF(row.x(), row.y(), 5 * u, row.height())
        painter.draw_text_line(number, str(change.old or ""), 1.6, "soft", at=ALIGN_RIGHT, bold=False)
        draw_text(painter, number.translated(5 * u, 0), ALIGN_RIGHT, str(change.new or ""))
        sign = QRectF(row.x() + 11.4 * u, row.y(), 2.4 * u, row.height())
        painter.draw_text_line(sign, change.sign, 2.0, SIGN_COLORS[change.sign], bold=change.sign in "+-")
        draw_raw_text(painter, row.adjusted(14 * u, 0, 0, 0), ALIGN_LEFT, change.text.expandtabs(4))

    def make_function_keys(self) -> dict[int, FunctionKey]:
        """Return the function keys for selecting and scrolling."""
        history = self._history
        return {
            4: FunctionKey("NEWER", lambda: history.mark(history.marked - 1)),
            5: FunctionKey("OLDER", lambda: history.mark(history.marked + 1)),
            6: FunctionKey("UP", lambda: self.scroll_by(-self.rows)),
            7: FunctionKey("DOWN", lambda: self.scroll_by(self.rows)),
        }

    def make_arrow_actions(self) -> dict[int, Callable[[], None]]:
        """Return the actions of the arrow and page keys, which have the functions of F4 to F7.

        Home selects the newest version, and End selects the oldest version.
        """
        by = {number: key.action for number, key in self.make_function_keys().items()}
        return {
            Qt.Key.Key_Up: by[4],
            Qt.Key.Key_Down: by[5],
            Qt.Key.Key_PageUp: by[6],
            Qt.Key.Key_PageDown: by[7],
            Qt.Key.Key_Home: lambda: self._history.mark(0),
            Qt.Key.Key_End: lambda: self._history.mark(WHOLE_LIST),
        }
