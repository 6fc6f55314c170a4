"""Base classes of the painted parts of the screen: a frame with a title, and targets to press."""

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
    """A descriptor for an attribute of a panel. The panel is redrawn when its value changes."""

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
    """Do nothing, because assistive technology does not press a control that can be dragged."""


class Spot(NamedTuple):
    """A target of a panel. ``name`` precedes the painted texts in the accessible name, see ``words_on``."""

    box: QRectF
    press: Press
    name: str = ""
    kind: Literal["key", "row", "lamp", "slider"] = "key"
    on: bool = False  # The lamp is lit, or the row is selected.
    barred: bool = False  # Pressing the target would be rejected now.


class Panel(QWidget):
    """A painted part of the screen, which is redrawn only when its content changes.

    A panel never has the focus.
    """

    title = ""
    part_name = ""  # For assistive technology, if the panel has no title.
    lists = False  # The targets are the rows of a list.
    ground = "ground"
    paints: ClassVar[int] = 0  # Number of paint events of all panels.

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.look = look
        self._places: list[Spot] = []
        self._written: list[tuple[QRectF, str]] | None = None
        self._titled = ""
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Paint the panel. The painter always ends, because an active painter would crash the process."""
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
        """Draw the content of the panel inside its frame. Subclasses override this."""

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Press the target at once, when the mouse button or finger goes down."""
        self.touch(event.position())

    def touch(self, at: QPointF) -> bool:
        """Press the target at this position. Return False if there is no target."""
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
        """Register a target inside ``rect`` while drawing. See ``Spot``."""
        self._places.append(Spot(rect, press, name, kind, on, barred))

    # --- for assistive technology ---------------------------------------------------------------------

    def spots(self) -> Sequence[Spot]:
        """Return the targets as they were last painted."""
        return self._places

    def written(self) -> list[tuple[QRectF, str]]:
        """Return the texts that were last painted, with their rectangles.

        Painters record no texts before the first call, because recording takes 5 % of their time.
        """
        Painter.notes = True
        if self._written is None and self.isVisible():
            self.grab()
        return [(box, text) for box, text in self._written or () if text]

    def words_on(self, spot: Spot) -> str:
        """Return the accessible name of a target: its name, and the texts that are painted on it."""
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
        """Return the title, or else ``part_name``, or else the painted texts."""
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
        """Draw a touch key with its label in the center, and register it as a target."""
        painter.fill(box, "key")
        painter.write(box, word, size, ink, at=CENTRE, raw=raw, margin=margin)
        self.place(box, press)

    def area(self) -> QRectF:
        """Return the rectangle of the whole widget in pixels."""
        return QRectF(self.rect())

    def inside(self) -> QRectF:
        """Return the rectangle inside a frame with a title, in pixels."""
        u = self.look.u
        return self.area().adjusted(1.2 * u, 2.6 * u, -1.2 * u, -0.9 * u)

    def frame(self, painter: Painter, title: str, colour: str = "frame", width: float = 0.16) -> None:
        """Draw a frame with its title in the top line, as on text screens."""
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


# --- multi-touch --------------------------------------------------------------------------------------


MOUSE = -1  # Touch number of the mouse.


@dataclass(frozen=True, slots=True)
class Control:
    """A target with actions for pressing, moving and releasing."""

    box: QRectF
    down: Callable[[QPointF], None]
    along: Callable[[QPointF], None] | None = None
    up: Callable[[], None] | None = None
    always: bool = False  # The control stops the machine, so it also acts on a late press.
    name: str = ""  # See ``Spot``.
    kind: Literal["key", "slider"] = "key"

    def spot(self) -> Spot:
        """Return the control as a target for assistive technology."""
        return Spot(self.box, no_press if self.along else self.tap, self.name, self.kind)

    def tap(self) -> None:
        """Press the control at its center and release it."""
        self.down(self.box.center())
        if self.up:
            self.up()

    def stopping(self) -> Control:
        """Return a copy of the control that stops the machine."""
        return replace(self, always=True)


def pressed(box: QRectF, press: Press, name: str = "") -> Control:
    """Return a control that acts when it is pressed anywhere in its box."""
    return Control(box, lambda _at: press(), name=name)


class FingerPanel(Panel):
    """A panel with controls that react to several touches and the mouse. ``draw`` creates the controls."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.controls: list[Control] = []
        self._held: dict[int, Control] = {}
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    def spots(self) -> Sequence[Spot]:
        """Return the targets and the controls."""
        return [*super().spots(), *(each.spot() for each in self.controls)]

    def stops_at(self, at: QPointF) -> bool:
        """Return whether a control at this position stops the machine."""
        return any(control.always and control.box.contains(at) for control in self.controls)

    @property
    def fingers(self) -> int:
        """The number of touches that hold a control, including the mouse."""
        return len(self._held)

    def mouse_is_up(self) -> None:
        """Release the control of the mouse, because the release event of its button was lost."""
        self._up(MOUSE)

    def let_go(self) -> None:
        """Release all controls, because their release events will not arrive."""
        for finger in tuple(self._held):
            self._up(finger)

    def event(self, event: QEvent) -> bool:
        """Handle touch events. Pass all other events to Qt."""
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
        """Press a control with the left button. A control that stops the machine accepts any button."""
        if event.button() is Qt.MouseButton.LeftButton or self.stops_at(event.position()):
            self._up(MOUSE)
            self._down(MOUSE, event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move along the control that the mouse has pressed."""
        self._along(MOUSE, event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Release the control that the mouse has pressed, wherever the pointer is."""
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
