"""Tool offsets, F8: some of the 32 tools, each field a cell that a finger or the cursor chooses."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPolygonF, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.offsets.offset_values import heading, not_set
from app.offsets.offsets_view import OffsetPage
from app.offsets.tool_offsets import COLUMNS, PAGE, ToolOffsets
from app.screen import page_table
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Panel
from app.screen.tool_tip_drawing import draw_tip
from core.executor.snapshot import Snapshot
from core.store.store_rows import OFFSETS

NUMBER, SCROLL = 5.4, 7.4  # units: width of the column of numbers, of the arrows that leaf
HEAD = 3.2  # units: height of the names of the columns
# Widths of the columns in parts of what is left.
SHARES = {
    "x": 15.0,
    "z": 14.0,
    "nose_radius": 11.5,
    "quadrant": 8.6,
    "wear_x": 14.0,
    "wear_z": 13.0,
    "master": 9.6,
    "remark": 17.0,
}


class ToolTable(Panel):
    """Draws the model; redrawn when something of it has changed."""

    def __init__(self, look: Look, model: ToolOffsets, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model
        self._shown: tuple[object, ...] = ()
        self.top = 1  # the first number that is shown
        self.choose: Callable[[int, int], None] = model.choose

    def show_tools(self) -> None:
        """The model as it is now; the cursor is always in sight."""
        model = self._model
        last = OFFSETS[-1] - PAGE + 1
        self.top = max(model.number - PAGE + 1, min(self.top, model.number, last), 1)
        shown = (
            model.book.tools,
            (model.number, model.column, self.top, model.relative, model.mode),
            dict(model.fields.new.values),
            tuple(change.number for change in model.history.last),
        )
        if shown != self._shown:
            self._shown = shown
            self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """A row a notch."""
        self._model.typed("Up" if event.angleDelta().y() > 0 else "Down")

    def draw(self, painter: QPainter) -> None:
        u, model = self.look.u, self._model
        mode = model.mode
        x = tr("X IS A DIAMETER") if mode.diameter else tr("X IS A RADIUS")
        title = f"{tr('TOOL OFFSETS')}  ·  {tr('MM') if mode.metric else tr('INCH')}  ·  {x}"
        if model.relative:
            title += "  ·  " + tr("X AND Z FROM THE MASTER T{number}").format(number=model.book.master)
        self.frame(painter, title)
        room = self.inside().adjusted(-0.7 * u, -0.2 * u, 0.7 * u, 0.5 * u)
        head = QRectF(room.x(), room.y(), room.width() - SCROLL * u, HEAD * u)
        strip = room.adjusted(room.width() - (SCROLL - 0.6) * u, HEAD * u, 0, 0)
        self._leaf(painter, strip)
        columns = self._columns(head)
        self._head(painter, head, columns)
        high = strip.height() / PAGE
        for place in range(PAGE):
            row = QRectF(head.x(), head.bottom() + place * high, head.width(), high)
            self._row(painter, row, self.top + place, columns)

    def _head(self, painter: QPainter, head: QRectF, columns: dict[str, tuple[float, float]]) -> None:
        look, u, mode = self.look, self.look.u, self._model.mode
        painter.setPen(look.colour("soft"))
        for name, (left, wide) in columns.items():
            text = heading(name, mode)
            painter.setFont(look.fit(text, 1.5, wide - 0.6 * u, bold=True))
            put(painter, QRectF(left, head.y(), wide - 0.4 * u, head.height()), CENTRE, text)

    def _leaf(self, painter: QPainter, strip: QRectF) -> None:
        """Two large arrows: a page up and a page down."""
        look, u = self.look, self.look.u
        half = (strip.height() - 0.6 * u) / 2
        for number, (key, sign) in enumerate((("Page up", -1), ("Page down", 1))):
            box = QRectF(strip.x(), strip.y() + number * (half + 0.6 * u), strip.width(), half)
            painter.fillRect(box, look.colour("key"))
            at, size = box.center(), 1.2 * u
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(look.colour("accent"))
            tip = QPointF(at.x(), at.y() + sign * size)
            foot = at.y() - sign * size
            painter.drawPolygon(QPolygonF([tip, QPointF(at.x() - size, foot), QPointF(at.x() + size, foot)]))
            self.place(box, partial(self._press, key))

    def _press(self, key: str) -> None:
        self._model.typed(key)

    def _columns(self, room: QRectF) -> dict[str, tuple[float, float]]:
        """Left edge and width of each column, pixels."""
        left = room.x() + NUMBER * self.look.u
        part = (room.right() - left) / sum(SHARES.values())
        columns = {}
        for name in COLUMNS:
            columns[name] = (left, SHARES[name] * part)
            left += SHARES[name] * part
        return columns

    def _row(
        self, painter: QPainter, row: QRectF, number: int, columns: dict[str, tuple[float, float]]
    ) -> None:
        look, u, model = self.look, self.look.u, self._model
        here = number == model.number
        if here:
            painter.fillRect(row, look.colour("here"))
        if number in {change.number for change in model.history.last}:
            painter.fillRect(QRectF(row.x(), row.y(), 0.5 * u, row.height()), look.colour("lit"))
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(2.2, bold=True))
        put(painter, QRectF(row.x(), row.y(), (NUMBER - 0.8) * u, row.height()), RIGHT, f"T{number}")
        unset = number not in model.book.tools
        for at, (name, (left, wide)) in enumerate(columns.items()):
            cell = QRectF(left, row.y(), wide, row.height())
            self._cell(painter, cell, number, name)
            if here and at == model.column:
                painter.setPen(look.pen("accent", 0.24))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawRect(cell.adjusted(0.2 * u, 0.1 * u, -0.2 * u, -0.1 * u))
            self.place(cell, partial(self.choose, number, at))
        if unset and number != model.fields.new.number:
            painter.setPen(look.colour("soft"))
            painter.setFont(look.font(1.9))
            put(painter, QRectF(columns["x"][0] + u, row.y(), 14 * u, row.height()), LEFT, not_set())

    def _cell(self, painter: QPainter, cell: QRectF, number: int, name: str) -> None:
        look, u = self.look, self.look.u
        text = self._model.cell(number, name)
        room = cell.adjusted(0.8 * u, 0, -0.9 * u, 0)
        if name == "quadrant" and text:
            draw_tip(
                painter,
                QRectF(room.right() - 2.6 * u, room.y() + 0.2 * u, 2.6 * u, room.height() - 0.4 * u),
                look,
                int(text),
            )
            room.setRight(room.right() - 3.0 * u)
        worn = name.startswith("wear") and text.strip("+0.") == ""
        painter.setPen(look.colour("soft" if worn else "text"))
        painter.setFont(look.fit(text, 2.0, room.width(), bold=not worn and name != "remark"))
        put(painter, room, LEFT if name == "remark" else RIGHT, text)


class ToolOffsetsPage(OffsetPage):
    """F8, tool offsets."""

    NAME = page_table.TOOLS
    LABELS = ("MENU", "ADD", "MASTER", "UNDO", "HISTORY", "EFFECT", "ALARMS", "", "SECCMP", "ZERO")
    model: ToolOffsets
    table: ToolTable

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, ToolOffsets(host.desk))
        self.table = ToolTable(self.look, self.model, self)

    def key_actions(self) -> KeyActions:
        """Add to what is there; X and Z from the master; the rest as on F9."""
        return {**super().key_actions(), "F2": self.model.add, "F3": self.model.turn_relative}

    def show_table(self, _snapshot: Snapshot) -> None:
        """The table as it is now."""
        self.table.show_tools()
