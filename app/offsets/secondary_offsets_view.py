"""Secondary offsets, F9: 32 in two columns of sixteen; a finger has eight of them brought near first."""

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
NEAR = 8  # offsets that are shown large: half a column
BAR = 6.8  # units: a finger's height
# Shares of a column: where the number, and each letter with its figure, end.
_NUMBER, _X, _Z = 0.09, 0.42, 0.73


class SecondaryTable(Panel):
    """The row being changed is filled, the last changed has a bar.

    Sixteen rows leave a row a third of a finger's width, so that a finger on the table brings the eight
    offsets around it near, and the next one chooses.
    """

    offsets: Shown[Mapping[int, SecondaryRow]] = Shown({})
    near = Shown(0)  # the first number of those that are shown large; 0: all are shown
    _number = Shown(0)
    _marked: Shown[frozenset[int]] = Shown(frozenset())
    _mode = Shown(Mode())
    unread = Shown(False)  # whether there are offsets that cannot be read

    def __init__(self, look: Look, choose: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose

    def show_offsets(
        self, offsets: Mapping[int, SecondaryRow], number: int, marked: Collection[int], mode: Mode
    ) -> None:
        """The table, the row that is being changed (0: none), those changed last, and the unit."""
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
        """Show eight offsets from this one on large, 0: all of them."""
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
        """``size``: of the letters, 1 where all are shown."""
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
    """Two columns of so many rows, downwards first."""
    high, wide = room.height() / rows, (room.width() - gap) / 2
    return [
        QRectF(room.x() + column * (wide + gap), room.y() + row * high, wide, high)
        for column in range(2)
        for row in range(rows)
    ]


class SecondaryOffsetsPage(OffsetPage):
    """F9, secondary offsets."""

    NAME = page_table.SECCMP
    LABELS = ("MENU", "", "", "UNDO", "HISTORY", "EFFECT", "ALARMS", "TOOLS", "", "ZERO")
    model: SecondaryOffsets
    table: SecondaryTable

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, SecondaryOffsets(host.desk))
        self.table = SecondaryTable(self.look, self.model.choose, self)

    def escape(self) -> bool:
        """Eight offsets that were brought near go back first."""
        if self.table.near:
            self.table.bring_near(0)
            return True
        return super().escape()

    def leave(self) -> bool:
        """The whole table stands here the next time."""
        self.table.bring_near(0)
        return super().leave()

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """The table as it is now."""
        super().refresh(snapshot, status, loaded)
        model = self.model
        marked = {change.number for change in model.history.last}
        self.table.unread = model.book.unread
        self.table.show_offsets(model.book.secondary, model.number, marked, model.mode)
