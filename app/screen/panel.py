"""The common ground of the parts of the page: a frame, its title in the top line, places to press."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Generic, Literal, NamedTuple, TypeVar

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QEventPoint,
    QFontMetricsF,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QTouchEvent,
)
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.screen.look import CENTRE, LEFT, Look, Painter, put

Press = Callable[[], None]
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


def no_press() -> None:
    """Do nothing: what acts while it is held or dragged is not pressed by assistive technology."""


class Spot(NamedTuple):
    """A target of a panel. ``name`` goes before the texts that are painted on it; see ``words_on``."""

    box: QRectF
    press: Press
    name: str = ""
    kind: Literal["key", "row", "lamp", "slider"] = "key"
    on: bool = False  # a lamp that is lit, a row that has the mark
    barred: bool = False  # pressing it would be refused now


class Panel(QWidget):
    """Draws itself from what it shows, and only when that has changed. Never takes the keyboard."""

    title = ""
    part_name = ""  # for assistive technology, where the panel has no title
    lists = False  # its targets are the rows of a list
    ground = "ground"
    paints: ClassVar[int] = 0  # how often any of them has been

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.look = look
        self._places: list[Spot] = []
        self._written: list[tuple[QRectF, str]] | None = None
        self._titled = ""
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
            self._written = painter.written if Painter.notes else None

    def draw(self, painter: Painter) -> None:
        """What a part of the page draws inside its frame."""

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """A finger or the mouse acts when it goes down, as a key does."""
        self.touch(event.position())

    def touch(self, at: QPointF) -> bool:
        """Press whatever stands there; False when nothing does."""
        for spot in self._places:
            if spot.box.contains(at):
                spot.press()
                return True
        return False

    def place(
        self,
        rect: QRectF,
        press: Press,
        name: str = "",
        *,
        kind: Literal["key", "row", "lamp"] = "key",
        on: bool = False,
        barred: bool = False,
    ) -> None:
        """While drawing: remember that pressing inside ``rect`` does this; see ``Spot``."""
        self._places.append(Spot(rect, press, name, kind, on, barred))

    # --- for assistive technology ---------------------------------------------------------------------

    def spots(self) -> Sequence[Spot]:
        """Return the targets as they were painted last."""
        return self._places

    def written(self) -> list[tuple[QRectF, str]]:
        """Return the texts that were painted last, and their places.

        Painters note no texts before the first call, because that takes 5 % of their time.
        """
        Painter.notes = True
        if self._written is None and self.isVisible():
            self.grab()
        return [(box, text) for box, text in self._written or () if text]

    def words_on(self, spot: Spot) -> str:
        """Return the name of a target, and the texts that are painted on it."""
        texts = (text for box, text in self.written() if spot.box.contains(box.center()))
        return "  ".join((*([tr(spot.name)] if spot.name else ()), *texts))

    def words_outside(self) -> str:
        """Return all texts outside the targets, without the title."""
        return "  ".join(
            text
            for box, text in self.written()
            if text != self._titled and not any(each.box.contains(box.center()) for each in self.spots())
        )

    def words_of_name(self) -> str:
        """Return the title, or what it shows where it has none."""
        shown = self.words_outside() or "  ".join(text for _box, text in self.written())
        return self._titled or tr(self.part_name) or shown

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
        self._titled = title
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
    name: str = ""  # see ``Spot``
    kind: Literal["key", "slider"] = "key"

    def spot(self) -> Spot:
        """Return it as a target for assistive technology."""
        return Spot(self.box, no_press if self.along else self.tap, self.name, self.kind)

    def tap(self) -> None:
        """Go down in the middle and come up."""
        self.down(self.box.center())
        if self.up:
            self.up()

    def stopping(self) -> Control:
        """The same, as one that stops the machine."""
        return replace(self, always=True)


def pressed(box: QRectF, press: Press, name: str = "") -> Control:
    """A control that acts as it goes down, wherever in its box."""
    return Control(box, lambda _at: press(), name=name)


class FingerPanel(Panel):
    """Drawing declares the controls; fingers and the mouse find them."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.controls: list[Control] = []
        self._held: dict[int, Control] = {}
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    def spots(self) -> Sequence[Spot]:
        """Return also the controls."""
        return [*super().spots(), *(each.spot() for each in self.controls)]

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
