"""The right side of the Jog page: tool setting on a lathe, or tool, preset and 3D-ROT on a mill."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.status.formats import length
from app.desk.translation import tr
from app.jog.jog_model import JogModel
from app.jog.tilted_jog import SLIDES
from app.jog.tool_setting import TOOL, TOUCH_X, TOUCH_Z
from app.offsets.offset_values import Mode, marked, not_set, shown_value, signed, word
from app.screen.drawings import draw_tip
from app.screen.look import CENTRE, LEFT, RIGHT, Look, Painter
from app.screen.panel import Panel, Shown
from app.screen.window_layout import FINGER
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.tool_edges import edge_name

# Field, and the key that asks for its value.
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
ROWS = len(FIELDS) // 2
_ASKS = {"x": TOUCH_X, "z": TOUCH_Z}


class ToolPanel(Panel):
    """The panel of the tool setting. Every field is a touch target."""

    _shown: Shown[object] = Shown(None)
    _tip: Shown[tuple[float, float] | None] = Shown(None)
    _mode = Shown(Mode())

    def __init__(self, look: Look, model: JogModel, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model

    def show_tool(self, snapshot: Snapshot) -> None:
        """Show the selected tool and the position of its tip."""
        tool = self._model.tool
        self._mode = tool.history.mode
        self._tip = tool.tip(snapshot)
        self._shown = (tool.number, tool.row, tool.asked, tool.from_master(), tool.book.master)

    @property
    def shown_mode(self) -> Mode:
        """The unit of the position display, so that the page never shows positions in two units."""
        return Mode(self._model.desk.settings.units.metric(self._mode.metric), self._mode.diameter)

    @property
    def tip_words(self) -> str:
        """The heading of the tip position, with its unit if the unit differs from the panel's."""
        if self.shown_mode.metric == self._mode.metric:
            return tr("TIP POSITION FROM PART ZERO")
        return (
            tr("TIP POSITION FROM PART ZERO, MM")
            if self.shown_mode.metric
            else tr("TIP POSITION FROM PART ZERO, INCH")
        )

    def draw(self, painter: Painter) -> None:
        unit = tr("MM") if self._mode.metric else tr("INCH")
        self.frame(painter, join_messages("  ·  ", (tr("TOOL SETTING"), unit)))
        u = self.look.u
        room = self.inside().adjusted(-0.3 * u, 0, 0.3 * u, 0.3 * u)
        cells = ROWS * (FINGER + 0.5 * u)  # Each cell is a touch target.
        high = min(10.5 * u, 0.36 * room.height(), max(room.height() - cells, 7.0 * u))
        head = QRectF(room.x(), room.y(), room.width(), high)
        self._head(painter, head)
        rest = QRectF(
            room.x(), head.bottom() + 0.5 * u, room.width(), room.bottom() - head.bottom() - 0.5 * u
        )
        self._cells(painter, rest)

    def _head(self, painter: Painter, room: QRectF) -> None:
        """Draw the tool number, the tip quadrant and the tip position."""
        u, tool = self.look.u, self._model.tool
        box = QRectF(room.x(), room.y(), 13 * u, room.height())
        self._target(painter, box, partial(self._model.ask, TOOL), lit=tool.asked == TOOL)
        name = edge_name(tool.number) if tool.number else "T–"
        painter.write(box.adjusted(0, 0.6 * u, 0, 0), name, 5.0, "text", at=CENTRE)
        self._key(painter, box, "T")
        side = room.height()
        tip = QRectF(box.right() + 0.8 * u, room.y(), side, side)
        quadrant = tool.row.quadrant if tool.row else 0
        name = f"{word('quadrant')} {quadrant or ''}"
        self._target(painter, tip, partial(self._model.ask, "quadrant"), name, lit=False)
        draw_tip(painter, tip.adjusted(0.6 * u, 0.6 * u, -0.6 * u, -0.6 * u), quadrant)
        self._stands(painter, room.adjusted(tip.right() + 1.2 * u - room.x(), 0, 0, 0))

    def _stands(self, painter: Painter, room: QRectF) -> None:
        u, mode = self.look.u, self.shown_mode
        painter.write(QRectF(room.x(), room.y(), room.width(), 2.0 * u), self.tip_words, 1.5, "soft")
        high = (room.height() - 2.0 * u) / 2
        if self._tip is None:
            painter.write(
                room.adjusted(0, 2 * u, 0, 0), not_set(unread=self._model.tool.book.unread), 2.8, "soft"
            )
            return
        x, z = self._tip
        figures = (
            (f"X {'Ø' if mode.diameter else 'R'}", length(2 * x if mode.diameter else x, mode.metric)),
            ("Z", length(z, mode.metric)),
        )
        for number, (name, figure) in enumerate(figures):
            row = QRectF(room.x(), room.y() + 2.0 * u + number * high, room.width(), high)
            painter.write(row, name, 2.2, "accent")
            painter.write(row.adjusted(5 * u, 0, 0, 0), figure, 3.4, "text", at=RIGHT)

    def _cells(self, painter: Painter, room: QRectF) -> None:
        u = self.look.u
        high, wide = (room.height() + 0.5 * u) / ROWS, (room.width() + 0.6 * u) / 2
        for number, (name, key) in enumerate(FIELDS):
            row, column = divmod(number, 2)
            box = QRectF(room.x() + column * wide, room.y() + row * high, wide - 0.6 * u, high - 0.5 * u)
            self._cell(painter, box, name, key)

    def _cell(self, painter: Painter, box: QRectF, name: str, key: str) -> None:
        u, mode = self.look.u, self._mode
        model, tool = self._model, self._model.tool
        asks = _ASKS.get(name, name)
        press: Callable[[], None] = model.choose_master if name == "master" else partial(model.ask, asks)
        self._target(painter, box, press, lit=tool.asked == asks)
        mark = marked(name, mode)
        label = {"x": tr("TOUCH OFF X"), "z": tr("TOUCH OFF Z")}.get(name, word(name)) + (
            f" {mark}" if mark else ""
        )
        self._key(painter, box, key)
        upper = QRectF(box.x() + 3.4 * u, box.y() + 0.3 * u, box.width() - 4 * u, 2.2 * u)
        painter.write(upper, label, 1.5, "soft")
        text = self._text(name)
        room = QRectF(box.x() + u, box.y() + 2.3 * u, box.width() - 2 * u, box.height() - 2.5 * u)
        at = LEFT if name in {"remark", "master"} else RIGHT
        painter.write(room, text, 2.5, "text", at=at, raw=name == "remark")

    def _text(self, name: str) -> str:
        tool, mode = self._model.tool, self._mode
        if name == "master":
            return self._master()
        return shown_value(name, getattr(tool.row, name), mode) if tool.row else ""

    def _master(self) -> str:
        """Return the master tool, and the distance of this tool from the master."""
        tool, mode = self._model.tool, self._mode
        master = tool.book.master
        if not master:
            return tr("none")
        if master == tool.number:
            return tr("THIS TOOL")
        apart = tool.from_master()
        if apart is None:
            return f"T{master}"
        x = signed(2 * apart[0] if mode.diameter else apart[0], mode.metric)
        return f"T{master}   X {x}  Z {signed(apart[1], mode.metric)}"

    def _target(
        self, painter: Painter, box: QRectF, press: Callable[[], None], name: str = "", *, lit: bool
    ) -> None:
        painter.box(box, "lit" if lit else "frame", 0.24 if lit else 0.12, "here" if lit else "key")
        self.place(box, press, name)

    def _key(self, painter: Painter, box: QRectF, key: str) -> None:
        u = self.look.u
        painter.write(QRectF(box.x() + 0.9 * u, box.y() + 0.3 * u, 2.4 * u, 2.2 * u), key, 1.7, "accent")


_PLACES = 4  # Decimals of a direction cosine.
_HIGH = 6.0  # Units: height of a row.


class MillJogPanel(Panel):
    """The panel of a mill. Tool, preset and 3D-ROT are touch targets."""

    _shown: Shown[object] = Shown(None)
    _tip: Shown[tuple[float, ...] | None] = Shown(None)

    def __init__(
        self,
        look: Look,
        model: JogModel,
        tools: Callable[[], None],
        presets: Callable[[], None],
        parent: QWidget,
    ) -> None:
        super().__init__(look, parent)
        self._model, self._tools, self._presets = model, tools, presets

    def show_mill(self, snapshot: Snapshot) -> None:
        """Show the active tool and preset, the tip position and the tilted frame."""
        book, tilt, tool = self._model.desk.book, self._model.tilt, snapshot.modal.tool
        swivel = snapshot.swivel
        self._tip = swivel.system.place.point(_slides(snapshot)) if swivel is not None else None
        self._shown = (tool, book.mill_tools.get(tool), book.preset, tilt.on, tilt.frame, tilt.why)

    def draw(self, painter: Painter) -> None:
        self.frame(painter, tr("TOOL, PRESET, TILTED PLANE  ·  MM"))
        u, room = self.look.u, self.inside()
        row = QRectF(room.x(), room.y(), room.width(), _HIGH * u - 0.6 * u)
        self._tool(painter, row)
        row.translate(0, _HIGH * u)
        self._preset(painter, row)
        row.translate(0, _HIGH * u)
        self._tilted(painter, row)
        self._axes(
            painter, QRectF(room.x(), row.bottom() + u, room.width(), room.bottom() - row.bottom() - u)
        )

    def _tool(self, painter: Painter, row: QRectF) -> None:
        book, number = self._model.desk.book, self._model.desk.snapshot().modal.tool
        tool = book.mill_tools.get(number)
        words = tr("no tool active; run TOOL CALL in MDI")
        if tool is not None:
            words = f"{tool.name}   L {tool.length + tool.dl:.3f}   R {tool.radius + tool.dr:.3f}"
        self._key(painter, row, "F8", f"T{number}" if number else tr("TOOL"), words, self._tools)

    def _preset(self, painter: Painter, row: QRectF) -> None:
        book = self._model.desk.book
        preset = book.presets.get(book.preset)
        words = tr("zero point from the machine file")
        if preset is not None:
            words = Message(
                "X {x}   Y {y}   Z {z}   ROT {rotation}",
                x=f"{preset.x:.3f}",
                y=f"{preset.y:.3f}",
                z=f"{preset.z:.3f}",
                rotation=f"{preset.rotation:.3f}",
            )
        self._key(
            painter, row, "F9", tr(Message("PRESET {number}", number=book.preset)), words, self._presets
        )

    def _tilted(self, painter: Painter, row: QRectF) -> None:
        tilt = self._model.tilt
        state = tr("ON") if tilt.on else tr("OFF")
        tilted = self._model.desk.snapshot().swivel
        words = (
            tr("not tilted")
            if tilted is None or not tilted.system.tilted
            else tr("rotary axes are not at the angles of the tilted plane")
        )
        words = tilt.frame.words if tilt.frame is not None else words
        self._key(
            painter,
            row,
            "F5",
            Message("3D-ROT {state}", state=state),
            words,
            self._model.turn_tilt,
            lit=tilt.on,
        )

    def _key(
        self,
        painter: Painter,
        row: QRectF,
        key: str,
        name: str,
        words: str,
        press: Callable[[], None],
        *,
        lit: bool = False,
    ) -> None:
        u = self.look.u
        painter.box(row, "lit" if lit else "frame", 0.24 if lit else 0.12, "here" if lit else "key")
        painter.write(QRectF(row.x() + 0.8 * u, row.y() + 0.2 * u, 4 * u, 2 * u), key, 1.6, "accent")
        left = QRectF(row.x() + 4 * u, row.y(), 13.5 * u, row.height())
        painter.write(left, name, 2.5, "text")
        painter.write(row.adjusted(18 * u, 0, -0.8 * u, 0), words, 2.0, "soft")
        self.place(row, press)

    def _axes(self, painter: Painter, room: QRectF) -> None:
        """Draw the tip position in the active system, and the machine direction of each jog key."""
        u, tilt = self.look.u, self._model.tilt
        head = QRectF(room.x(), room.y(), room.width(), 2.2 * u)
        painter.write(head, tr("TIP POSITION"), 1.5, "soft")
        if tilt.frame is not None:
            painter.write(head, tr("JOG KEY DIRECTION IN MACHINE COORDINATES X Y Z"), 1.5, "soft", at=RIGHT)
        high = min(4.4 * u, (room.height() - 2.4 * u) / len(SLIDES))
        for place, name in enumerate(SLIDES):
            row = QRectF(room.x(), head.bottom() + place * high, room.width(), high)
            mark = "'" if tilt.on else ""
            painter.write(row, f"{name}{mark}", 2.6, "accent")
            if self._tip is not None:
                at = QRectF(row.x() + 4 * u, row.y(), 13 * u, high)
                painter.write(at, length(self._tip[place], metric=True), 2.8, "text", at=RIGHT)
            direction = tilt.along(name) if tilt.on else tilt.frame.direction(name) if tilt.frame else None
            if direction is not None:
                words = "   ".join(f"{share + 0.0:+.{_PLACES}f}" for share in direction)
                painter.write(row, words, 2.2, "text" if tilt.on else "soft", at=RIGHT)
        if self._tip is None:
            painter.write(room, tr("position unknown until a program line has run"), 2.2, "soft", at=CENTRE)


def _slides(snapshot: Snapshot) -> tuple[float, float, float]:
    x, y, z = snapshot.actual[:3]
    return x, y, z
