"""The common ground of the parts of the page: a frame, its title in the top line, places to press."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, Generic, TypeVar

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QEventPoint,
    QFontMetricsF,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QTouchEvent,
)
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.screen.look import CENTRE, LEFT, Look, Painter, put
from app.screen.window_layout import FINGER

Press = Callable[[], None]
LEAF = 5.0  # units: size of the keys that leaf through a list; a fingertip at least
NARROW = 50.0  # units: width of a list that keeps all of it for its rows
T = TypeVar("T")


class Shown(Generic[T]):
    """An attribute of a panel: the panel is drawn anew when it becomes another."""

    def __init__(self, first: T) -> None:
        self._first = first

    def __set_name__(self, _owner: type, name: str) -> None:
        self._name = name

    def __get__(self, panel: QWidget, _owner: type | None = None) -> T:
        value: T = vars(panel).get(self._name, self._first)
        return value

    def __set__(self, panel: QWidget, value: T) -> None:
        if value != self.__get__(panel):
            vars(panel)[self._name] = value
            panel.update()


class Panel(QWidget):
    """Draws itself from what it shows, and only when that has changed. Never takes the keyboard."""

    title = ""
    ground = "ground"
    paints: ClassVar[int] = 0  # how often any of them has been

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.look = look
        self._places: list[tuple[QRectF, Press]] = []
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Qt's call to draw. The painter ends whatever happens: one left open takes the process with it."""
        Panel.paints += 1
        with Painter(self, self.look) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.fill(self.area(), self.ground)
            self._places.clear()
            if self.title:
                self.frame(painter, self.title)
            self.draw(painter)

    def draw(self, painter: Painter) -> None:
        """What a part of the page draws inside its frame."""

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """A finger or the mouse acts when it goes down, as a key does."""
        self.touch(event.position())

    def touch(self, at: QPointF) -> bool:
        """Press whatever stands there; False when nothing does."""
        for rect, press in self._places:
            if rect.contains(at):
                press()
                return True
        return False

    def place(self, rect: QRectF, press: Press) -> None:
        """While drawing: remember that pressing inside ``rect`` does this."""
        self._places.append((rect, press))

    def key(
        self,
        painter: Painter,
        box: QRectF,
        word: str,
        size: float,
        press: Press,
        *,
        ink: str = "text",
        raw: bool = False,
        margin: float = 0.0,
    ) -> None:
        """While drawing: a key for a finger with its word in the middle."""
        painter.fill(box, "key")
        painter.write(box, word, size, ink, at=CENTRE, raw=raw, margin=margin)
        self.place(box, press)

    def leaf(
        self, painter: Painter, room: QRectF, seen: tuple[int, int, int], go: Callable[[int], None]
    ) -> QRectF:
        """While drawing a list: two keys where not all of it fits; the room left for its rows.

        ``seen``: the first row that is shown, how many fit, how many there are. ``go`` takes how many rows
        further down: a finger has no wheel, and marking a row brings no other into sight. The keys stand at
        the right, below a narrow list (see ``fitting``), and side by side where there is no height.
        """
        top, fits, count = seen
        if count <= fits:
            return room
        gap, (wide, high) = 0.6 * self.look.u, self._leaf_size
        foot = self._is_narrow(room.width())
        beside = foot or room.height() < 2 * high + gap
        strip = QRectF(room.right() - wide - beside * (wide + gap), room.y(), wide, room.height())
        if foot:
            wide = (room.width() - gap) / 2
            strip = QRectF(room.x(), room.bottom() - high, wide, high)
        right, down = (wide + gap, 0.0) if beside else (0.0, (strip.height() + gap) / 2)
        for number, (sign, ends) in enumerate(((-1, top <= 0), (1, top + fits >= count))):
            box = QRectF(strip.x(), strip.y(), wide, strip.height() if beside else down - gap)
            box.translate(number * right, number * down)
            painter.fill(box, "key")
            self._triangle(painter, box, sign, "ghost" if ends else "accent")
            self.place(box, partial(go, sign * fits))
        left = room.adjusted(0, 0, -2 * gap, -high - gap)
        if not foot:
            left = room.adjusted(0, 0, strip.x() - 2 * gap - room.right(), 0)
        self._seen_share(painter, QRectF(left.right() + gap, left.y(), 0.6 * gap, left.height()), seen)
        return left

    @property
    def _leaf_size(self) -> tuple[float, float]:
        """Width and least height of a key that leafs, pixels."""
        return max(LEAF * self.look.u, float(FINGER)), max(LEAF * self.look.u, float(FINGER))

    def _is_narrow(self, width: float) -> bool:
        return width < NARROW * self.look.u

    def fitting(self, room: QRectF, high: float, count: int) -> int:
        """How many rows of this height fit, the keys of ``leaf`` counted where they stand below."""
        fits = int(room.height() / high)
        if fits < count and self._is_narrow(room.width()):
            fits = int((room.height() - self._leaf_size[1] - 0.6 * self.look.u) / high)
        return max(1, fits)

    def _triangle(self, painter: Painter, box: QRectF, sign: int, ink: str) -> None:
        at, size = box.center(), 1.2 * self.look.u
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self.look.colour(ink))
        tip, foot = QPointF(at.x(), at.y() + sign * size), at.y() - sign * size
        painter.drawPolygon(QPolygonF([tip, QPointF(at.x() - size, foot), QPointF(at.x() + size, foot)]))

    @staticmethod
    def _seen_share(painter: Painter, track: QRectF, seen: tuple[int, int, int]) -> None:
        """How much of a list is seen, and where."""
        top, fits, count = seen
        painter.fill(track, "key")
        part = QRectF(track.x(), 0, track.width(), track.height() * fits / count)
        part.moveTop(track.y() + track.height() * top / count)
        painter.fill(part, "accent")

    def area(self) -> QRectF:
        """The whole widget, in pixels."""
        return QRectF(self.rect())

    def inside(self) -> QRectF:
        """The room inside a frame with a title, pixels."""
        u = self.look.u
        return self.area().adjusted(1.2 * u, 2.6 * u, -1.2 * u, -0.9 * u)

    def frame(self, painter: Painter, title: str, colour: str = "frame", width: float = 0.16) -> None:
        """A box with its title set into the top line, as text screens drew them."""
        look, u, title = self.look, self.look.u, tr(title)
        top = 1.0 * u
        pen = look.pen(colour, width)
        half = pen.widthF() / 2
        box = self.area().adjusted(half, top, -half, -half)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("panel"))
        painter.drawRect(box)
        painter.setPen(QPen(pen))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(box)
        font = look.fit(title, 1.7, self.width() - 4 * u, bold=True)
        painter.setFont(font)
        wide = QFontMetricsF(font).horizontalAdvance(title)
        patch = QRectF(1.6 * u, 0.0, wide + 1.2 * u, 2.0 * u)
        painter.fillRect(
            QRectF(patch.x(), top - half - 1, patch.width(), 2 * half + 2), look.colour("ground")
        )
        painter.fill(QRectF(patch.x(), top, patch.width(), 1.0 * u), "panel")
        painter.setPen(look.colour("soft"))
        put(painter, patch.adjusted(0.6 * u, 0, 0, 0), LEFT, title)


# --- several fingers at once --------------------------------------------------------------------------


MOUSE = -1  # the pointer's place among the touches


@dataclass(frozen=True, slots=True)
class Control:
    """One thing to press: what going down on it, moving along it and coming up do."""

    box: QRectF
    down: Callable[[QPointF], None]
    along: Callable[[QPointF], None] | None = None
    up: Callable[[], None] | None = None
    always: bool = False  # it stops the machine: it acts however late the finger is seen

    def stopping(self) -> Control:
        """The same, as one that stops the machine."""
        return replace(self, always=True)


def pressed(box: QRectF, press: Press) -> Control:
    """A control that acts as it goes down, wherever in its box."""
    return Control(box, lambda _at: press())


class FingerPanel(Panel):
    """Drawing declares the controls; fingers and the mouse find them."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.controls: list[Control] = []
        self._held: dict[int, Control] = {}
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    def stops_at(self, at: QPointF) -> bool:
        """Whether what stands there stops the machine."""
        return any(control.always and control.box.contains(at) for control in self.controls)

    @property
    def fingers(self) -> int:
        """How many fingers hold a control."""
        return len(self._held)

    def mouse_is_up(self) -> None:
        """The button was let go where nobody could see it."""
        self._up(MOUSE)

    def let_go(self) -> None:
        """Forget what fingers hold: their release will not arrive any more."""
        for finger in tuple(self._held):
            self._up(finger)

    def event(self, event: QEvent) -> bool:
        """Touches come here; everything else goes its usual way."""
        if not isinstance(event, QTouchEvent):
            return super().event(event)
        for point in event.points():
            self._finger(point)
        if event.type() == QEvent.Type.TouchCancel:
            self.let_go()
        event.accept()
        return True

    def _finger(self, point: QEventPoint) -> None:
        state = point.state()
        if state == QEventPoint.State.Pressed:
            self._down(point.id(), point.position())
        elif state == QEventPoint.State.Updated:
            self._along(point.id(), point.position())
        elif state == QEventPoint.State.Released:
            self._up(point.id())

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """The mouse is one finger, and its left button; what stops takes any."""
        if event.button() is Qt.MouseButton.LeftButton or self.stops_at(event.position()):
            self._up(MOUSE)
            self._down(MOUSE, event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Along the control that it went down on."""
        self._along(MOUSE, event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Up again, wherever it is now."""
        if not event.buttons() & Qt.MouseButton.LeftButton:
            self._up(MOUSE)

    def _down(self, finger: int, at: QPointF) -> None:
        for control in self.controls:
            if control.box.contains(at):
                self._held[finger] = control
                control.down(at)
                return

    def _along(self, finger: int, at: QPointF) -> None:
        control = self._held.get(finger)
        if control and control.along:
            control.along(at)

    def _up(self, finger: int) -> None:
        control = self._held.pop(finger, None)
        if control and control.up:
            control.up()
