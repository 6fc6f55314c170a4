"""Version history: versions on the left, the differences of the selected version on the right."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF, Qt
from PySide6.QtWidgets import QWidget

from app.desk.pages.sheet import Key
from app.desk.status.formats import local_time
from app.editor.versions import DifferenceRow, VersionHistory
from app.screen.look import LEFT, RIGHT, Look, Painter, put, put_raw
from app.screen.panel import Shown
from app.screen.sheet_panel import RowPanel
from core.message import Message
from core.store.store_rows import VersionRow

ROW = 5.2  # units: height of a version, at least a fingertip
LINE = 2.9  # units: height of a line of the comparison
LIST = 50.0  # units: width of the list of versions
INKS = {"+": "run", "-": "alarm", " ": "soft", "…": "off"}


class VersionList(RowPanel):
    """List of versions. The selection itself is part of the history.

    The comparison scrolls, and the selected version is in the middle of the list.
    """

    title = "HISTORY"
    keyed = False
    _shown: Shown[tuple[object, ...]] = Shown(())

    def __init__(self, look: Look, history: VersionHistory, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._history = history
        self.hide()

    def refresh(self) -> None:
        """Redraw when the history has changed; called once per frame."""
        history = self._history
        now = (history.rows, history.marked, history.changes, history.words())
        if now[:3] != self._shown[:3]:
            self.top = 0
        self._shown = now

    def draw(self, painter: Painter) -> None:
        u, history = self.look.u, self._history
        high = self.look.row(ROW, 9.0, touch=True)
        rows = max(1, int((self.height() - 4.0 * u) / high))
        first = max(0, min(history.marked - rows // 2, len(history.rows) - rows))
        for place, version in enumerate(history.rows[first : first + rows]):
            box = QRectF(1.2 * u, 3.0 * u + place * high, (LIST - 1.2) * u, high)
            marked = first + place == history.marked
            self._version(painter, box, version, marked)
            self.place(box, partial(history.mark, first + place), kind="row", on=marked)
        self._comparison(painter)

    def _version(self, painter: Painter, box: QRectF, version: VersionRow, marked: bool) -> None:
        u = self.look.u
        if marked:
            painter.fill(box, "lit")
        ink, soft = ("on_lit", "on_lit") if marked else ("text", "soft")
        at = local_time(version.saved).replace(" ", "  ")
        upper = box.adjusted(u, 0.4 * u, -u, -box.height() / 2)
        painter.write(upper, f"{version.number}", 2.0, ink)
        painter.write(upper.adjusted(5 * u, 0, 0, 0), at, 1.8, ink, bold=False)
        painter.write(upper, Message("{size} bytes", size=version.size), 1.6, soft, at=RIGHT, bold=False)
        put(
            painter,
            upper.translated(5 * u, upper.height()),
            LEFT,
            f"{version.why} ({version.who})" if version.who else version.why,
        )

    def _comparison(self, painter: Painter) -> None:
        u, history = self.look.u, self._history
        room = QRectF((LIST + 2) * u, 2.8 * u, self.width() - (LIST + 3.4) * u, 3 * u)
        head = history.words() or history.heading()
        painter.write(room, head, 1.8, "text", fit=False)
        room = QRectF(room.x(), 6.2 * u, room.width(), self.height() - 8.0 * u)
        count = len(history.changes)
        self.scrolled(painter, room, self.fitting(room, LINE * u, count), count)
        for number, row in self.boxes(room, LINE * u):
            self._change(painter, row, history.changes[number])

    def _change(self, painter: Painter, row: QRectF, change: DifferenceRow) -> None:
        u = self.look.u
        number = QRectF(row.x(), row.y(), 5 * u, row.height())
        painter.write(number, str(change.old or ""), 1.6, "soft", at=RIGHT, bold=False)
        put(painter, number.translated(5 * u, 0), RIGHT, str(change.new or ""))
        sign = QRectF(row.x() + 11.4 * u, row.y(), 2.4 * u, row.height())
        painter.write(sign, change.sign, 2.0, INKS[change.sign], bold=change.sign in "+-")
        put_raw(painter, row.adjusted(14 * u, 0, 0, 0), LEFT, change.text.expandtabs(4))

    def keys(self) -> dict[int, Key]:
        """Return the function keys for selecting and scrolling."""
        history = self._history
        return {
            4: Key("NEWER", lambda: history.mark(history.marked - 1)),
            5: Key("OLDER", lambda: history.mark(history.marked + 1)),
            6: Key("UP", lambda: self.scroll_by(-self.rows)),
            7: Key("DOWN", lambda: self.scroll_by(self.rows)),
        }

    def arrows(self) -> dict[int, Callable[[], None]]:
        """Return the same actions for the arrow keys."""
        by = {number: key.action for number, key in self.keys().items()}
        return {
            Qt.Key.Key_Up: by[4],
            Qt.Key.Key_Down: by[5],
            Qt.Key.Key_PageUp: by[6],
            Qt.Key.Key_PageDown: by[7],
        }
