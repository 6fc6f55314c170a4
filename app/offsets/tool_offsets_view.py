"""The pages of tool offsets and of a tool's shape (F8), with a drawing of insert, holder and tip."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import data, tr
from app.offsets.offset_values import heading, not_set, word
from app.offsets.offsets_view import OffsetPage
from app.offsets.tool_offsets import COLUMNS, ToolOffsets
from app.offsets.tool_shapes import ToolShapes
from app.screen import page_table
from app.screen.drawings import draw_outline, draw_tip
from app.screen.look import CENTRE, LEFT, RIGHT, Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Panel, Shown
from app.screen.sheet_panel import RowPanel
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.tool_edges import edge_number, edge_of, tool_of

NUMBER = 5.4  # Units: width of the number column.
HEAD = 3.2  # Units: height of the column heads.
# Relative widths of the other columns.
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
    """The table of the tool offsets. It is redrawn when the model has changed."""

    notch = 1
    _shown: Shown[object] = Shown(())

    def __init__(self, look: Look, model: ToolOffsets, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model
        self.choose: Callable[[int, int], None] = model.choose
        self._heads: dict[str, str] = {}  # Column heads by field.

    def show_tools(self) -> None:
        """Show the present state of the model."""
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
        """Return the left edge and width of each column in pixels."""
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
            spot = cell.united(margin) if at == 0 else cell  # A touch on the number selects the row.
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
        """Return the scale of the letters for the height of the row."""
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
    """The page of the tool offsets, F8."""

    NAME = page_table.TOOLS
    LABELS = ("MENU", "ADD", "MASTER", "UNDO", "HISTORY", "EFFECT", "ALARMS", "SHAPE", "SECCMP", "ZERO")
    model: ToolOffsets
    table: ToolTable

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, ToolOffsets(host.desk))
        self.table = ToolTable(self.look, self.model, self)

    def barred_by(self) -> dict[str, object]:
        """Return the reasons why keys are disabled, including F2 for adding and F3 for the master."""
        model = self.model
        return {**super().barred_by(), "F2": model.add_barred(), "F3": model.relative_barred()}

    def key_actions(self) -> KeyActions:
        """Return the key actions, including F2 for adding, F3 for the master and F8 for the tool's shape."""
        own: KeyActions = {
            "F2": self.model.add,
            "F3": self.model.turn_relative,
            "F8": partial(self._go, page_table.SHAPE),
        }
        return {**super().key_actions(), **own}

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """Show the present state of the table."""
        super().refresh(snapshot, status, loaded)
        self.table.show_tools()


ROWS = 6  # Fields in each of the two columns.
FIELDS = 0.6  # Fraction of the width for both columns.


class ShapeTable(Panel):
    """Two columns of fields, which are touch targets, with the drawing at their right."""

    _shown: Shown[object] = Shown(())

    def __init__(self, look: Look, model: ToolShapes, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model

    def show_shape(self) -> None:
        """Show the present state of the model."""
        model = self._model
        last = tuple(change.number for change in model.history.last)
        self._shown = (model.number, model.row, model.tool, model.name, model.mode, last)

    def draw(self, painter: Painter) -> None:
        u, model = self.look.u, self._model
        unit = tr("MM") if model.mode.metric else tr("INCH")
        title: str = join_messages(
            "  ·  ", (tr(Message("SHAPE OF T{number}", number=edge_number(model.number))), unit)
        )
        if model.tool is not None and model.tool.remark:
            title += f"  ·  {data(model.tool.remark)}"
        self.frame(painter, title)
        room = self.inside().adjusted(-0.7 * u, 0, 0.7 * u, 0.5 * u)
        fields = QRectF(room.x(), room.y(), FIELDS * room.width(), room.height())
        wide, high = fields.width() / 2, fields.height() / ROWS
        for place, name in enumerate(model.names):
            column, row = divmod(place, ROWS)
            cell = QRectF(fields.x() + column * wide, fields.y() + row * high, wide, high)
            self._field(painter, cell.adjusted(0, 0, -0.5 * u, -0.5 * u), name)
            self.place(cell, partial(model.choose, place))
        self._picture(
            painter,
            QRectF(
                fields.right() + 0.4 * u, room.y(), room.right() - fields.right() - 0.4 * u, room.height()
            ),
        )

    def _field(self, painter: Painter, cell: QRectF, name: str) -> None:
        """Draw the name of a field above its value."""
        u, model = self.look.u, self._model
        here = name == model.name
        painter.fill(cell, "here" if here else "key")
        head = cell.adjusted(0.8 * u, 0.3 * u, -0.8 * u, 0)
        head.setHeight(1.8 * u)
        painter.write(head, heading(name, model.mode), 1.5, "soft")
        wrong = name in {"quadrant" if each.field == "tip" else each.field for each in model.mistakes}
        foot = cell.adjusted(0.8 * u, 2.2 * u, -0.8 * u, -0.4 * u)
        text = model.cell(name)
        free = name in {"insert", "holder", "profile"}
        if name == "quadrant" and text:
            side = foot.height()
            draw_tip(painter, QRectF(foot.x(), foot.y(), side, side), int(text))
        painter.write(
            foot, text or "–", 2.0, "alarm" if wrong else "text", at=RIGHT, bold=bool(text), raw=free
        )

    # --- drawing -------------------------------------------------------------------------------------

    def _picture(self, painter: Painter, room: QRectF) -> None:
        """Draw the outline with X down, as in the path view. Below it are the assumed values."""
        u, model = self.look.u, self._model
        words = QRectF(room.x(), room.bottom() - 2.6 * u, room.width(), 2.4 * u)
        painter.fill(room, "panel")
        outline = model.outline
        if model.row is None:
            text = tr("TOOL SHAPE NOT DEFINED: ONLY THE TOOL NOSE IS CHECKED")
            painter.write(room, text, 1.8, "soft", at=CENTRE, margin=1.0)
        elif outline is None:
            painter.write(room, tr("IMPOSSIBLE TOOL SHAPE"), 1.8, "alarm", at=CENTRE, margin=1.0)
        else:
            draw_outline(painter, room.adjusted(0, 0, 0, -2.8 * u), outline)
            if outline.assumed:
                names = ", ".join(word("quadrant" if name == "tip" else name) for name in outline.assumed)
                text = tr(Message("ASSUMED: {names}", names=names))
                painter.write(words, text, 1.5, "soft", at=CENTRE, bold=False, margin=1.0)


class ToolShapePage(OffsetPage):
    """The page of the shape of the selected tool."""

    NAME = page_table.SHAPE
    LABELS = ("MENU", "", "NONE", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "SECCMP", "ZERO")
    model: ToolShapes
    table: ShapeTable

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, ToolShapes(host.desk))
        self.table = ShapeTable(self.look, self.model, self)

    def barred_by(self) -> dict[str, object]:
        """Return the reasons why keys are disabled, including F3 for deleting the shape."""
        return {**super().barred_by(), "F3": self.model.remove_barred()}

    def key_actions(self) -> KeyActions:
        """Return the key actions, with F3 for deleting the shape and without the effect on the path."""
        shared = {key: act for key, act in super().key_actions().items() if key != "F6"}
        return {**shared, "F3": self.model.remove}

    def opened(self) -> None:
        """Select the first field of the selected tool."""
        super().opened()
        self.model.place = 0

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """Show the present state of the fields."""
        super().refresh(snapshot, status, loaded)
        self.table.show_shape()

    def escape(self) -> bool:
        """Go one step back, or from the first step to the table of tools."""
        if not self.model.escape():
            self.host.go(page_table.TOOLS)
        return True
