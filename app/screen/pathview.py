"""The path of the running program as the operator sees it from above: X+ down, Z+ right, both sides of X0."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QMouseEvent, QPainter, QPolygonF, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.panel import Panel

if TYPE_CHECKING:
    from app.desk.picture import Picture
    from app.screen.layers import Layers
    from app.screen.plot import Frame

ZOOM_STEP = 1.25
PAN_STEP = 0.1  # of the width


class Tip(NamedTuple):
    """Where the program is: block under way (0: none), and the tool tip in the part's frame, mm."""

    block: int = 0
    z: float = 0.0
    x: float = 0.0
    metric: bool = False


class PathView(Panel):
    """Blits cached layers and draws the tip over them; nothing is computed here but where it stands."""

    title = "PATH"

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._picture: Picture | None = None
        self._layers: Layers | None = None
        self._frame: Frame | None = None
        self._tip = Tip()
        self._drag: QPointF | None = None

    @property
    def view(self) -> Frame | None:
        """What is looked at."""
        return self._frame

    def show_picture(self, picture: Picture | None) -> None:
        """Another program's path, or none."""
        if picture is not self._picture:
            self._picture = picture
            self.fit()

    def show_tip(self, tip: Tip) -> None:
        """Where the run is now."""
        if tip == self._tip:
            return
        if self._layers is not None and tip.block != self._tip.block:
            self._layers.want(tip.block - 1)
        self._tip = tip
        self.update()

    def advance(self) -> None:
        """Once a frame: draw on what is not drawn yet, for a few milliseconds at most."""
        if self._layers is not None and self._layers.advance():
            self.update()

    # --- looking around ------------------------------------------------------------------------------

    def fit(self) -> None:
        """The whole part."""
        self._frame = None
        if self._picture is not None and self.width() > 40:
            from app.screen.plot import fitted

            room = self._room()
            frame = fitted(self._picture.bounds, int(room.width()), int(room.height()), 2.8 * self.look.u)
            self._show_frame(frame)
        else:
            self._layers = None
            self.update()

    def restart(self) -> None:
        """The same again, in other colours."""
        if self._frame is not None:
            self._show_frame(self._frame)

    def zoom(self, steps: int, at: QPointF | None = None) -> None:
        """Nearer (positive) or farther, about a point of the widget or about the middle."""
        if self._frame is not None:
            room = self._room()
            at = at - room.topLeft() if at is not None else QPointF(room.width() / 2, room.height() / 2)
            self._show_frame(self._frame.zoomed(ZOOM_STEP**steps, at.x(), at.y()))

    def pan(self, across: int, down: int) -> None:
        """Look further right and down by so many steps."""
        if self._frame is not None:
            step = PAN_STEP * self._frame.width
            self._show_frame(self._frame.moved(-across * step, -down * step))

    def wheelEvent(self, event: QWheelEvent) -> None:
        """The wheel zooms about the pointer."""
        notches = event.angleDelta().y() / 120
        self.zoom(1 if notches > 0 else -1, event.position())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """A button of the view, or the start of a drag."""
        if not self.touch(event.position()):
            self._drag = event.position()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the picture along."""
        if self._drag is not None and self._frame is not None:
            by = event.position() - self._drag
            self._drag = event.position()
            self._show_frame(self._frame.moved(by.x(), by.y()))

    def mouseReleaseEvent(self, _event: QMouseEvent) -> None:
        """The drag is over."""
        self._drag = None

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Another size: the whole part again."""
        self.fit()

    def _show_frame(self, frame: Frame) -> None:
        from app.screen.layers import Layers

        self._frame = frame
        if self._picture is not None:
            self._layers = Layers(self.look, self._picture, frame)
            self._layers.want(self._tip.block - 1)
            self.advance()
        self.update()

    # --- drawing -------------------------------------------------------------------------------------

    def _room(self) -> QRectF:
        u = self.look.u
        return self.area().adjusted(0.2 * u, 1.2 * u, -0.2 * u, -0.2 * u).toRect().toRectF()

    def draw(self, painter: QPainter) -> None:
        frame, layers = self._frame, self._layers
        if frame is None or layers is None:
            painter.setPen(self.look.colour("soft"))
            painter.setFont(self.look.font(2.0))
            put(painter, self.inside(), CENTRE, "The path is shown when a program is loaded.")
            return
        room = self._room()
        painter.drawImage(room.topLeft(), layers.image)
        self.frame_again(painter)
        painter.save()
        painter.setClipRect(room)
        painter.translate(room.topLeft())
        self._centre_line(painter, frame)
        self._under_way(painter, frame, layers)
        self._tool_tip(painter, frame)
        painter.restore()
        self._furniture(painter, room, frame)

    def frame_again(self, painter: QPainter) -> None:
        """The image has covered the lower half of the title."""
        look, u = self.look, self.look.u
        painter.setFont(look.font(1.7, bold=True))
        painter.setPen(look.colour("soft"))
        put(painter, QRectF(2.2 * u, 0, 20 * u, 2.0 * u), LEFT, self.title)

    def _centre_line(self, painter: QPainter, frame: Frame) -> None:
        pen = self.look.pen("centre", 0.12)
        pen.setDashPattern([14, 4, 2, 4])
        painter.setPen(pen)
        row = round(float(frame.down(0.0))) + 0.5
        painter.drawLine(QPointF(0, row), QPointF(frame.width, row))
        column = round(float(frame.across(0.0))) + 0.5
        pen.setDashPattern([2, 6])
        painter.setPen(pen)
        painter.drawLine(QPointF(column, 0), QPointF(column, frame.height))

    def _under_way(self, painter: QPainter, frame: Frame, layers: Layers) -> None:
        """The part of the present block that lies behind the tip."""
        tip = self._tip
        if self._picture is None or tip.block < 1:
            return
        from app.screen.plot import polygon, travelled

        found = travelled(self._picture, frame, tip.block, tip.z, tip.x)
        if found is not None:
            painter.setPen(layers.pens(done=True)[found.stroke])
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawPolyline(polygon(found.columns, found.rows))

    def _tool_tip(self, painter: QPainter, frame: Frame) -> None:
        look, u = self.look, self.look.u
        at = QPointF(float(frame.across(self._tip.z)), float(frame.down(self._tip.x)))
        side = 1.0 if self._tip.x >= 0 else -1.0
        body = [at, at + QPointF(1.5 * u, 1.3 * side * u), at + QPointF(0.2 * u, 3.2 * side * u)]
        painter.setPen(look.pen("panel", 0.2))
        painter.setBrush(look.colour("tip"))
        painter.drawPolygon(QPolygonF([*body, at + QPointF(-1.1 * u, 1.6 * side * u)]))

    def _furniture(self, painter: QPainter, room: QRectF, frame: Frame) -> None:
        look, u = self.look, self.look.u
        for number, (sign, press) in enumerate(
            (("+", lambda: self.zoom(1)), ("−", lambda: self.zoom(-1)), ("FIT", self.fit))
        ):
            box = QRectF(room.right() - 5.6 * u, room.y() + (0.8 + number * 5.0) * u, 4.6 * u, 4.4 * u)
            painter.fillRect(box, look.colour("key"))
            painter.setPen(look.colour("text"))
            painter.setFont(look.font(1.6 if len(sign) > 1 else 2.8, bold=True))
            put(painter, box, CENTRE, sign)
            self.place(box, press)
        self._legend(painter, room)
        self._scale_bar(painter, room, frame)

    def _legend(self, painter: QPainter, room: QRectF) -> None:
        look, u = self.look, self.look.u
        x, y = room.x() + 1.2 * u, room.bottom() - 2.2 * u
        painter.setFont(look.font(1.5))
        for word, name, width in (
            ("done", "done", 0.26),
            ("to come", "todo", 0.14),
            ("rapid", "rapid", 0.14),
        ):
            pen = look.pen(name, width)
            if name == "rapid":
                pen.setStyle(Qt.PenStyle.DashLine)
            painter.setPen(pen)
            painter.drawLine(QPointF(x, y + u), QPointF(x + 3 * u, y + u))
            painter.setPen(look.colour("soft"))
            put(painter, QRectF(x + 3.6 * u, y, 9 * u, 2 * u), LEFT, word)
            x += (5.6 + 0.86 * len(word)) * u

    def _scale_bar(self, painter: QPainter, room: QRectF, frame: Frame) -> None:
        from app.screen.plot import scale_length

        look, u = self.look, self.look.u
        mm, text = scale_length(14 * u / frame.scale, self._tip.metric)
        wide = mm * frame.scale
        right, y = room.right() - 1.4 * u, room.bottom() - 1.0 * u
        painter.setPen(look.pen("soft", 0.16))
        for a, b in (((-wide, 0.0), (0.0, 0.0)), ((-wide, -0.7), (-wide, 0.0)), ((0.0, -0.7), (0.0, 0.0))):
            painter.drawLine(QPointF(right + a[0], y + a[1] * u), QPointF(right + b[0], y + b[1] * u))
        painter.setFont(look.font(1.5))
        painter.setPen(look.colour("soft"))
        put(painter, QRectF(right - wide - 12 * u, y - 1.2 * u, 11.2 * u, 2 * u), RIGHT, text)
