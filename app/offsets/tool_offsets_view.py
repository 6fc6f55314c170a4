"""Tool offsets, F8: some of the 32 tools, each field a cell that a finger or the cursor chooses."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.offsets.offset_values import heading, not_set
from app.offsets.offsets_view import OffsetPage
from app.offsets.tool_offsets import COLUMNS, ToolOffsets
from app.screen import page_table
from app.screen.look import CENTRE, LEFT, RIGHT, Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Shown
from app.screen.row_panel import RowPanel
from app.screen.tool_tip_drawing import draw_tip
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.tool_edges import edge_of, tool_of

NUMBER = 5.4  # units: width of the column of numbers
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


class ToolTable(RowPanel):
    """Draws the model; redrawn when something of it has changed."""

    notch = 1
    _shown: Shown[object] = Shown(())

    def __init__(self, look: Look, model: ToolOffsets, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model
        self.choose: Callable[[int, int], None] = model.choose
        self._heads: dict[str, str] = {}  # of the columns

    def show_tools(self) -> None:
        """The model as it is now."""
        model = self._model
        self._shown = (
            model.book.tools,
            (model.number, model.column, model.relative, model.mode, model.opened_edge),
            dict(model.fields.new.values),
            tuple(change.number for change in model.history.last),
        )

    def scroll_by(self, rows: int) -> None:
        """Move the cursor, which is always visible."""
        key = ("Up", "Down") if abs(rows) == 1 else ("Page up", "Page down")
        self._model.typed(key[rows > 0])

    def draw(self, painter: Painter) -> None:
        u, model = self.look.u, self._model
        mode = model.mode
        x = tr("X IS A DIAMETER") if mode.diameter else tr("X IS A RADIUS")
        title: str = join_messages("  ·  ", (tr("TOOL OFFSETS"), tr("MM") if mode.metric else tr("INCH"), x))
        if model.relative:
            title += "  ·  " + tr(Message("X AND Z RELATIVE TO MASTER T{number}", number=model.book.master))
        self.frame(painter, title)
        room = self.inside().adjusted(-0.7 * u, -0.2 * u, 0.7 * u, 0.5 * u)
        body = room.adjusted(0, HEAD * u, 0, 0)
        count = len(model.rows)
        model.page = min(count, self.fitting(body, self.look.row(7.0, 9.0, touch=True), count))
        body = self.scrolled(painter, body, model.page, count, model.row)
        head = QRectF(body.x(), room.y(), body.width(), HEAD * u)
        columns = self._columns(head)
        self._head(painter, head, columns)
        high = body.height() / model.page
        for place, row in self.boxes(body, high):
            self._row(painter, row, model.rows[place], columns)

    def _head(self, painter: Painter, head: QRectF, columns: dict[str, tuple[float, float]]) -> None:
        u, mode = self.look.u, self._model.mode
        for name, (left, wide) in columns.items():
            cell = QRectF(left, head.y(), wide - 0.4 * u, head.height())
            self._heads[name] = heading(name, mode)
            painter.write(cell, self._heads[name], 1.5, "soft", at=CENTRE, margin=0.2)

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
        self, painter: Painter, row: QRectF, number: int, columns: dict[str, tuple[float, float]]
    ) -> None:
        u, model = self.look.u, self._model
        here = number == model.number
        if here:
            painter.fill(row, "here")
        if number in {change.number for change in model.history.last}:
            painter.fill(QRectF(row.x(), row.y(), 0.5 * u, row.height()), "lit")
        margin = QRectF(row.x(), row.y(), (NUMBER - 0.8) * u, row.height())
        name = f"T{number}" if number == tool_of(number) else f"D{edge_of(number)}"
        painter.write(margin, name, 2.2 * self._scale(row), "accent", at=RIGHT)
        unset = number not in model.book.tools
        for at, (field, (left, wide)) in enumerate(columns.items()):
            cell = QRectF(left, row.y(), wide, row.height())
            self._cell(painter, cell, number, field)
            if here and at == model.column:
                painter.box(cell.adjusted(0.2 * u, 0.1 * u, -0.2 * u, -0.1 * u), "accent", 0.24, "")
            spot = cell.united(margin) if at == 0 else cell  # who touches its number means its row
            words = f"{name} {self._heads[field]}"
            self.place(
                spot, partial(self.choose, number, at), words, kind="row", on=here and at == model.column
            )
        if unset and number != model.fields.new.number:
            empty = QRectF(columns["x"][0] + u, row.y(), 14 * u, row.height())
            painter.write(
                empty, not_set(unread=model.book.unread), 1.9 * self._scale(row), "soft", bold=False
            )

    def _scale(self, row: QRectF) -> float:
        """Of the letters, by the height of the row."""
        return min(1.0, row.height() / (4.2 * self.look.u))

    def _cell(self, painter: Painter, cell: QRectF, number: int, name: str) -> None:
        u = self.look.u
        text = self._model.cell(number, name)
        room = cell.adjusted(0.8 * u, 0, -0.9 * u, 0)
        if name == "quadrant" and text:
            wide = 2.6 * u * self._scale(cell)
            draw_tip(painter, room.adjusted(room.width() - wide, 0.2 * u, 0, -0.2 * u), int(text))
            room.setRight(room.right() - wide - 0.4 * u)
        worn = name.startswith("wear") and text.strip("+0.") == ""
        ink, at = "soft" if worn else "text", LEFT if name == "remark" else RIGHT
        painter.write(
            room,
            text,
            2.0 * self._scale(cell),
            ink,
            at=at,
            bold=not worn and name != "remark",
            raw=name == "remark",
        )


class ToolOffsetsPage(OffsetPage):
    """F8, tool offsets."""

    NAME = page_table.TOOLS
    LABELS = ("MENU", "ADD", "MASTER", "UNDO", "HISTORY", "EFFECT", "ALARMS", "SHAPE", "SECCMP", "ZERO")
    model: ToolOffsets
    table: ToolTable

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, ToolOffsets(host.desk))
        self.table = ToolTable(self.look, self.model, self)

    def barred_by(self) -> dict[str, object]:
        """Return also why nothing is added, and why X and Z are not shown from a master."""
        model = self.model
        return {**super().barred_by(), "F2": model.add_barred(), "F3": model.relative_barred()}

    def key_actions(self) -> KeyActions:
        """Add to what is there; X and Z from the master; the tool's shape; the rest as on F9."""
        own: KeyActions = {
            "F2": self.model.add,
            "F3": self.model.turn_relative,
            "F8": partial(self._go, page_table.SHAPE),
        }
        return {**super().key_actions(), **own}

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """The table as it is now."""
        super().refresh(snapshot, status, loaded)
        self.table.show_tools()
