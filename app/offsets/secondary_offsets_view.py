"""The page of the 32 secondary offsets (F9), in two columns. A touch first enlarges eight of them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.formats import length
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.offsets.offset_values import UNKNOWN, Mode, signed
from app.offsets.offsets_view import OffsetPage
from app.offsets.secondary_offsets import SecondaryOffsets
from app.screen import page_table
from app.screen.look import RIGHT, Look, Painter
from app.screen.page_base import Host
from app.screen.panel import Panel, Shown
from core.executor.snapshot import Snapshot
from core.message import join_messages
from core.store.store_rows import SecondaryRow

ROWS = 16
NEAR = 8  # Number of offsets in the enlarged view, half a column.
BAR = 6.8  # Units: height of a fingertip.
# Fractions of the column width at which the number, X and Z end.
_NUMBER, _X, _Z = 0.09, 0.42, 0.73


class SecondaryTable(Panel):
    """The table of the offsets. The row being changed is filled, and the last changed row has a bar.

    A row in the full table has a third of a fingertip's height. The first touch therefore enlarges eight
    offsets, and the second touch selects one.
    """

    offsets: Shown[Mapping[int, SecondaryRow]] = Shown({})
    near = Shown(0)  # First number of the enlarged offsets; 0: all offsets are shown.
    _number = Shown(0)
    _marked: Shown[frozenset[int]] = Shown(frozenset())
    _mode = Shown(Mode())
    unread = Shown(False)  # True if offsets cannot be read.

    def __init__(self, look: Look, choose: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose

    def show_offsets(
        self, offsets: Mapping[int, SecondaryRow], number: int, marked: Collection[int], mode: Mode
    ) -> None:
        """Show the offsets, the row being changed (0 for none), the last changed rows and the unit."""
        if number:
            self.bring_near(0)
        self.offsets, self._number, self._marked, self._mode = offsets, number, frozenset(marked), mode

    def draw(self, painter: Painter) -> None:
        unit = tr("MM") if self._mode.metric else tr("INCH")
        self.frame(painter, join_messages("  ·  ", (tr("SECONDARY OFFSETS  ·  X STORED AS A RADIUS"), unit)))
        room = self.inside().adjusted(-0.6 * self.look.u, 0, 0.6 * self.look.u, 0.4 * self.look.u)
        if self.near:
            self._draw_near(painter, room)
        else:
            self._draw_all(painter, room)

    def bring_near(self, first: int) -> None:
        """Enlarge eight offsets from this number on, or show all offsets with 0."""
        self.near = first

    def _draw_all(self, painter: Painter, room: QRectF) -> None:
        for number, box in enumerate(_boxes(room, ROWS, 2.0 * self.look.u), start=1):
            self._row(painter, box, number, 1.0)
        for at, box in enumerate(_boxes(room, ROWS // NEAR, 2.0 * self.look.u)):
            self.place(box, partial(self.bring_near, at * NEAR + 1))

    def _draw_near(self, painter: Painter, room: QRectF) -> None:
        u = self.look.u
        bar = QRectF(room.x(), room.bottom() - BAR * u, room.width(), BAR * u)
        rows = room.adjusted(0, 0, 0, -(BAR + 0.6) * u)
        for number, box in enumerate(_boxes(rows, NEAR // 2, 0.8 * u), start=self.near):
            spot = box.adjusted(0, 0, 0, -0.6 * u)
            painter.fill(spot, "key")
            self._row(painter, spot, number, 1.25)
            self.place(spot, partial(self._choose_near, number))
        self.key(painter, bar, tr("ALL 32 OFFSETS"), 2.2, partial(self.bring_near, 0), ink="accent")

    def _choose_near(self, number: int) -> None:
        self.bring_near(0)
        self._choose(number)

    def _row(self, painter: Painter, box: QRectF, number: int, size: float) -> None:
        """Draw one row. ``size`` scales the letters, 1 in the full table."""
        u = self.look.u
        here = number == self._number
        if here:
            painter.fill(box, "here")
        if number in self._marked:
            painter.fill(QRectF(box.x(), box.y(), 0.5 * u, box.height()), "lit")
        offset = self.offsets.get(number)
        margin = QRectF(box.x(), box.y(), _NUMBER * box.width() - u, box.height())
        painter.write(margin, str(number), 1.9 * size, "accent", at=RIGHT)
        self._figures(painter, box, offset or SecondaryRow(), size, bold=here or offset is not None)

    def _figures(self, painter: Painter, box: QRectF, offset: SecondaryRow, size: float, bold: bool) -> None:
        x, z, r = offset
        metric, wide = self._mode.metric, box.width()
        cells = (
            ("X:", signed(x, metric), _NUMBER, _X),
            ("Z:", signed(z, metric), _X, _Z),
            ("R:", length(r, metric), _Z, 1.0),
        )
        u = self.look.u
        for letter, value, left, right in cells:
            figure = UNKNOWN if self.unread else value
            at = QRectF(box.x() + left * wide, box.y(), (right - left) * wide - 1.2 * u, box.height())
            self._cell(painter, at, letter, figure, size, bold)

    def _cell(self, painter: Painter, at: QRectF, letter: str, figure: str, size: float, bold: bool) -> None:
        u = self.look.u
        painter.write(QRectF(at.x(), at.y(), 2.4 * size * u, at.height()), letter, 1.8 * size, "soft")
        room = at.adjusted(2.4 * size * u, 0, 0, 0)
        painter.write(room, figure, 2.0 * size, "text" if bold else "soft", at=RIGHT, bold=bold)


def _boxes(room: QRectF, rows: int, gap: float) -> list[QRectF]:
    """Return the boxes of two columns with ``rows`` rows each, column by column."""
    high, wide = room.height() / rows, (room.width() - gap) / 2
    return [
        QRectF(room.x() + column * (wide + gap), room.y() + row * high, wide, high)
        for column in range(2)
        for row in range(rows)
    ]


class SecondaryOffsetsPage(OffsetPage):
    """The page of the secondary offsets, F9."""

    NAME = page_table.SECCMP
    LABELS = ("MENU", "", "", "UNDO", "HISTORY", "EFFECT", "ALARMS", "TOOLS", "", "ZERO")
    model: SecondaryOffsets
    table: SecondaryTable

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, SecondaryOffsets(host.desk))
        self.table = SecondaryTable(self.look, self.model.choose, self)

    def escape(self) -> bool:
        """Show all offsets again, or go one step back."""
        if self.table.near:
            self.table.bring_near(0)
            return True
        return super().escape()

    def leave(self) -> bool:
        """Show all offsets again, discard unfinished entries, and let the page close."""
        self.table.bring_near(0)
        return super().leave()

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """Show the present state of the table."""
        super().refresh(snapshot, status, loaded)
        model = self.model
        marked = {change.number for change in model.history.last}
        self.table.unread = model.book.unread
        self.table.show_offsets(model.book.secondary, model.number, marked, model.mode)
