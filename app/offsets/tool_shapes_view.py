"""Shape of a tool, F8 of the tool offsets: its fields, and insert, holder and tip drawn from its outline."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import data, tr
from app.offsets.offset_values import heading, word
from app.offsets.offsets_view import OffsetPage
from app.offsets.tool_shapes import ToolShapes
from app.screen import page_table
from app.screen.look import CENTRE, RIGHT, Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Panel, Shown
from app.screen.tool_outline_drawing import draw_outline
from app.screen.tool_tip_drawing import draw_tip
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.tool_edges import edge_number

ROWS = 6  # fields in one of the two columns
FIELDS = 0.6  # of the width, for both columns


class ShapeTable(Panel):
    """Two columns of fields, each a finger's target, and the picture at their right."""

    _shown: Shown[object] = Shown(())

    def __init__(self, look: Look, model: ToolShapes, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model

    def show_shape(self) -> None:
        """The model as it is now."""
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
        """Its name over its value."""
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

    # --- the picture ---------------------------------------------------------------------------------

    def _picture(self, painter: Painter, room: QRectF) -> None:
        """The outline, X downwards as in every picture of the path; under it what is assumed, or wrong."""
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
    """The shape of the tool at which the table of tools stands."""

    NAME = page_table.SHAPE
    LABELS = ("MENU", "", "NONE", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "SECCMP", "ZERO")
    model: ToolShapes
    table: ShapeTable

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, ToolShapes(host.desk))
        self.table = ShapeTable(self.look, self.model, self)

    def barred_by(self) -> dict[str, object]:
        """Return also why the shape of the tool is not removed."""
        return {**super().barred_by(), "F3": self.model.remove_barred()}

    def key_actions(self) -> KeyActions:
        """No shape any more; no effect on the path is drawn of these."""
        shared = {key: act for key, act in super().key_actions().items() if key != "F6"}
        return {**shared, "F3": self.model.remove}

    def opened(self) -> None:
        """At the first field of the tool that was chosen."""
        super().opened()
        self.model.place = 0

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """The table as it is now."""
        super().refresh(snapshot, status, loaded)
        self.table.show_shape()

    def escape(self) -> bool:
        """Esc goes one step back, and then to the table of tools."""
        if not self.model.escape():
            self.host.go(page_table.TOOLS)
        return True
