"""Tool setting: the chosen tool, its tip in a drawing, its fields, and what can be asked of it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.formats import length
from app.desk.translation import tr
from app.jog.jog_model import JogModel
from app.jog.jog_touch_off import TOUCH_X, TOUCH_Z
from app.jog.tool_setting import TOOL
from app.offsets.offset_values import Mode, marked, not_set, shown_value, signed, word
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.panel import Panel
from app.screen.tool_tip_drawing import draw_tip
from core.executor.snapshot import Snapshot

# Field, and the key that asks for it.
FIELDS = (
    ("x", "X"),
    ("z", "Z"),
    ("wear_x", "W"),
    ("wear_z", "W"),
    ("nose_radius", "N"),
    ("quadrant", "Q"),
    ("remark", "K"),
    ("master", "M"),
)
_ASKS = {"x": TOUCH_X, "z": TOUCH_Z}


class ToolPanel(Panel):
    """Draws the model; every field is a target for a finger."""

    def __init__(self, look: Look, model: JogModel, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model
        self._shown: object = None
        self._tip: tuple[float, float] | None = None
        self._mode = Mode()

    def show_tool(self, snapshot: Snapshot) -> None:
        """The tool of now, and where its tip stands."""
        tool = self._model.tool
        self._mode = tool.history.mode
        self._tip = tool.tip(snapshot)
        shown = (
            tool.number,
            tool.row,
            tool.asked,
            self._tip,
            tool.from_master(),
            self._mode,
            tool.book.master,
        )
        if shown != self._shown:
            self._shown = shown
            self.update()

    def draw(self, painter: QPainter) -> None:
        unit = tr("MM") if self._mode.metric else tr("INCH")
        self.frame(painter, f"{tr('TOOL SETTING')}  ·  {unit}")
        u = self.look.u
        room = self.inside().adjusted(-0.3 * u, 0, 0.3 * u, 0.3 * u)
        head = QRectF(room.x(), room.y(), room.width(), min(10.5 * u, 0.36 * room.height()))
        self._head(painter, head)
        rest = QRectF(
            room.x(), head.bottom() + 0.5 * u, room.width(), room.bottom() - head.bottom() - 0.5 * u
        )
        self._cells(painter, rest)

    def _head(self, painter: QPainter, room: QRectF) -> None:
        """Which tool, how its tip lies, where it stands."""
        look, u, tool = self.look, self.look.u, self._model.tool
        box = QRectF(room.x(), room.y(), 13 * u, room.height())
        self._target(painter, box, partial(self._model.ask, TOOL), lit=tool.asked == TOOL)
        painter.setPen(look.colour("text"))
        painter.setFont(look.font(5.0, bold=True))
        put(painter, box.adjusted(0, 0.6 * u, 0, 0), CENTRE, f"T{tool.number}" if tool.number else "T–")
        self._key(painter, box, "T")
        side = room.height()
        tip = QRectF(box.right() + 0.8 * u, room.y(), side, side)
        self._target(painter, tip, partial(self._model.ask, "quadrant"), lit=False)
        draw_tip(
            painter,
            tip.adjusted(0.6 * u, 0.6 * u, -0.6 * u, -0.6 * u),
            look,
            tool.row.quadrant if tool.row else 0,
        )
        self._stands(
            painter, QRectF(tip.right() + 1.2 * u, room.y(), room.right() - tip.right() - 1.2 * u, side)
        )

    def _stands(self, painter: QPainter, room: QRectF) -> None:
        look, u, mode = self.look, self.look.u, self._mode
        painter.setPen(look.colour("soft"))
        painter.setFont(look.font(1.5, bold=True))
        put(painter, QRectF(room.x(), room.y(), room.width(), 2.0 * u), LEFT, tr("ITS TIP IS NOW AT"))
        high = (room.height() - 2.0 * u) / 2
        if self._tip is None:
            painter.setFont(look.font(2.8, bold=True))
            put(painter, QRectF(room.x(), room.y() + 2 * u, room.width(), 2 * high), LEFT, not_set())
            return
        x, z = self._tip
        figures = (
            (f"X {'Ø' if mode.diameter else 'R'}", length(2 * x if mode.diameter else x, mode.metric)),
            ("Z", length(z, mode.metric)),
        )
        for number, (name, figure) in enumerate(figures):
            row = QRectF(room.x(), room.y() + 2.0 * u + number * high, room.width(), high)
            painter.setPen(look.colour("accent"))
            painter.setFont(look.font(2.2, bold=True))
            put(painter, row, LEFT, name)
            painter.setPen(look.colour("text"))
            painter.setFont(look.fit(figure, 3.4, row.width() - 5 * u, bold=True))
            put(painter, row.adjusted(5 * u, 0, 0, 0), RIGHT, figure)

    def _cells(self, painter: QPainter, room: QRectF) -> None:
        u = self.look.u
        rows = -(-len(FIELDS) // 2)
        high, wide = (room.height() + 0.5 * u) / rows, (room.width() + 0.6 * u) / 2
        for number, (name, key) in enumerate(FIELDS):
            row, column = divmod(number, 2)
            box = QRectF(room.x() + column * wide, room.y() + row * high, wide - 0.6 * u, high - 0.5 * u)
            self._cell(painter, box, name, key)

    def _cell(self, painter: QPainter, box: QRectF, name: str, key: str) -> None:
        look, u, mode = self.look, self.look.u, self._mode
        model, tool = self._model, self._model.tool
        asks = _ASKS.get(name, name)
        press: Callable[[], None] = model.choose_master if name == "master" else partial(model.ask, asks)
        self._target(painter, box, press, lit=tool.asked == asks)
        mark = marked(name, mode)
        label = {"x": tr("TOUCH X"), "z": tr("TOUCH Z")}.get(name, word(name)) + (f" {mark}" if mark else "")
        self._key(painter, box, key)
        painter.setPen(look.colour("soft"))
        painter.setFont(look.fit(label, 1.5, box.width() - 4 * u, bold=True))
        put(painter, QRectF(box.x() + 3.4 * u, box.y() + 0.3 * u, box.width() - 4 * u, 2.2 * u), LEFT, label)
        text = self._text(name)
        room = QRectF(box.x() + u, box.y() + 2.3 * u, box.width() - 2 * u, box.height() - 2.5 * u)
        painter.setPen(look.colour("text"))
        painter.setFont(look.fit(text, 2.5, room.width(), bold=True))
        put(painter, room, LEFT if name in {"remark", "master"} else RIGHT, text)

    def _text(self, name: str) -> str:
        tool, mode = self._model.tool, self._mode
        if name == "master":
            return self._master()
        return shown_value(name, getattr(tool.row, name), mode) if tool.row else ""

    def _master(self) -> str:
        """Which tool the others are relative to, and how far this one is from it."""
        tool, mode = self._model.tool, self._mode
        master = tool.book.master
        if not master:
            return tr("none")
        if master == tool.number:
            return tr("THIS ONE")
        apart = tool.from_master()
        if apart is None:
            return f"T{master}"
        x = signed(2 * apart[0] if mode.diameter else apart[0], mode.metric)
        return f"T{master}   X {x}  Z {signed(apart[1], mode.metric)}"

    def _target(self, painter: QPainter, box: QRectF, press: Callable[[], None], *, lit: bool) -> None:
        look = self.look
        painter.setPen(look.pen("lit" if lit else "frame", 0.24 if lit else 0.12))
        painter.setBrush(look.colour("here" if lit else "key"))
        painter.drawRect(box)
        self.place(box, press)

    def _key(self, painter: QPainter, box: QRectF, key: str) -> None:
        look, u = self.look, self.look.u
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(1.7, bold=True))
        put(painter, QRectF(box.x() + 0.9 * u, box.y() + 0.3 * u, 2.4 * u, 2.2 * u), LEFT, key)
