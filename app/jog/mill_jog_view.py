"""The right side of the Jog page on a mill: tool in the spindle, preset, where the tip is, 3D-ROT."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.status.formats import length
from app.desk.translation import tr
from app.jog.jog_model import JogModel
from app.jog.tilted_jog import SLIDES
from app.screen.look import CENTRE, RIGHT, Look, Painter
from app.screen.panel import Panel, Shown
from core.executor.snapshot import Snapshot
from core.message import Message

_PLACES = 4  # of the cosines of a direction
_HIGH = 6.0  # units: a row


class MillJogPanel(Panel):
    """Draws the model; tool, preset and 3D-ROT are targets for a finger."""

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
        """The tool and the preset of now, where the tip stands, what is tilted."""
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
        """Where the tip stands in the system in force, and where each key moves in the machine."""
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
