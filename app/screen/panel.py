"""Base classes of the custom-painted parts of the screen, with a titled frame and touch targets."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Generic, Literal, NamedTuple, TypeVar

from PySide6.QtCore import QEvent, QObject, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QEventPoint,
    QFontMetricsF,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QTouchEvent,
)
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.stop_keys.stop_records import StopKind
from app.desk.translation import tr
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_LEFT, ScreenTheme, ThemedPainter, draw_text
from app.screen.text_sizes import TextRole

OnPress = Callable[[], None]
T = TypeVar("T")


class RedrawingAttribute(Generic[T]):
    """A descriptor for an attribute of a panel.

    The panel is redrawn when the value changes.
    """

    def __init__(self, initial: T) -> None:
        self._first = initial

    def __set_name__(self, _owner: type, name: str) -> None:
        self._name = name

    def __get__(self, panel: QWidget, _owner: type | None = None) -> T:
        value: T = vars(panel).get(self._name, self._first)
        return value

    def __set__(self, panel: QWidget, value: T) -> None:
        if value != self.__get__(panel):
            vars(panel)[self._name] = value
            panel.update()


class FocusHolder(QObject):
    """Holder of the keyboard focus while a panel covers the input fields of a page.

    While the panel is visible, the window has the focus. A covered field that requests the focus, because of
    Tab or because its text was loaded late, gets it only after the panel is closed. No typed text changes it
    unseen.
    """

    def __init__(self, panel: QWidget) -> None:
        super().__init__(panel)
        self._panel = panel
        self.covered_field: QWidget | None = None
        application = QApplication.instance()
        if isinstance(application, QApplication):
            application.focusChanged.connect(self._hold_again)

    def hold_focus(self) -> None:
        """Move the focus from an input field to the window. It stays there while the panel is visible."""
        self.covered_field = QApplication.focusWidget()
        self._panel.window().setFocus()

    def return_focus(self) -> None:
        """Give the focus to the covered input field if it is visible, after the panel was hidden."""
        field, self.covered_field = self.covered_field, None
        if field is not None and field.isVisible():
            field.setFocus()

    def _hold_again(self, _before: QWidget | None, field: QWidget | None) -> None:
        window = self._panel.window()
        if field is None or field is window or not self._panel.isVisible():
            return
        if window.isAncestorOf(field):
            self.covered_field = field
            window.setFocus()


def ignore_press() -> None:
    """Do nothing when a drag target is pressed by assistive technology, which cannot drag it."""


class TouchTarget(NamedTuple):
    """Touch target of a panel.

    The accessible name of the target consists of ``name``, followed by the painted texts. See
    ``Panel.describe_target``.
    """

    box: QRectF
    on_press: OnPress
    name: str = ""
    kind: Literal["key", "row", "lamp", "slider"] = "key"
    is_on: bool = False  # The lamp is lit, or the row is selected.
    is_disabled: bool = False  # Pressing the target would be rejected now.


class Panel(QWidget):
    """A painted part of the screen, which is redrawn only when its content changes.

    A panel never has the focus.
    """

    title = ""
    accessible_name = ""  # For assistive technology, if the panel has no title.
    is_list = False  # The targets are the rows of a list.
    background_color = "ground"
    paint_count: ClassVar[int] = 0  # Number of paint events of all panels.

    def __init__(self, theme: ScreenTheme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.theme = theme
        self._places: list[TouchTarget] = []
        self._written: list[tuple[QRectF, str]] | None = None
        self._titled = ""
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Paint the panel.

        The painter is always ended, because an active painter would crash the process.
        """
        Panel.paint_count += 1
        with ThemedPainter(self, self.theme) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.fill_rect(self.find_full_area(), self.background_color)
            self._places.clear()
            if self.title:
                self.frame(painter, self.title)
            self.draw(painter)
            self._written = painter.drawn_texts if ThemedPainter.records_texts else None

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the content of the panel inside its frame.

        Subclasses override this.
        """

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Press the target as soon as the mouse button is pressed or a touch begins."""
        self.press_target_at(event.position())

    def press_target_at(self, position: QPointF) -> bool:
        """Press the target at this position.

        Return False if there is no target.
        """
        for spot in self._places:
            if spot.box.contains(position):
                spot.on_press()
                return True
        return False

    def add_target(
        self,
        rect: QRectF,
        press: OnPress,
        name: str = "",
        *,
        kind: Literal["key", "row", "lamp"] = "key",
        is_on: bool = False,
        is_disabled: bool = False,
    ) -> None:
        """Register a target inside ``rect`` while the panel is being drawn.

        See ``TouchTarget``.
        """
        self._places.append(TouchTarget(rect, press, name, kind, is_on, is_disabled))

    # --- for assistive technology ---------------------------------------------------------------------

    def list_targets(self) -> Sequence[TouchTarget]:
        """Return the targets as they were last painted."""
        return self._places

    def read_painted_texts(self) -> list[tuple[QRectF, str]]:
        """Return the texts that were last painted, with their rectangles.

        Painters record no texts before the first call, because recording takes 5 % of their time.
        """
        ThemedPainter.records_texts = True
        if self._written is None and self.isVisible():
            self.grab()
        return [(box, text) for box, text in self._written or () if text]

    def describe_target(self, target: TouchTarget) -> str:
        """Return the accessible name of a target: its name, and the texts that are painted on it."""
        texts = (text for box, text in self.read_painted_texts() if target.box.contains(box.center()))
        return "  ".join((*([tr(target.name)] if target.name else ()), *texts))

    def describe_content(self) -> str:
        """Return all painted texts outside the touch targets, without the title."""
        return "  ".join(
            text
            for box, text in self.read_painted_texts()
            if text != self._titled
            and not any(each.box.contains(box.center()) for each in self.list_targets())
        )

    def find_accessible_name(self) -> str:
        """Return the title of the panel.

        Without a title, return ``accessible_name``. Without either, return the painted texts.
        """
        shown = self.describe_content() or "  ".join(text for _box, text in self.read_painted_texts())
        return self._titled or tr(self.accessible_name) or shown

    def key(
        self,
        painter: ThemedPainter,
        box: QRectF,
        label: str,
        size: float,
        press: OnPress,
        *,
        color: str = "text",
        is_raw: bool = False,
        margin: float = 0.0,
    ) -> None:
        """Draw a touch key with a centered label, and register the key as a target."""
        painter.fill_rect(box, "key")
        painter.draw_text_line(box, label, size, color, at=ALIGN_CENTER, raw=is_raw, margin=margin)
        self.add_target(box, press)

    def find_full_area(self) -> QRectF:
        """Return the rectangle of the whole widget in pixels."""
        return QRectF(self.rect())

    def inside(self) -> QRectF:
        """Return the rectangle inside the frame and below its title, in pixels."""
        u = self.theme.unit_px
        return self.find_full_area().adjusted(
            1.2 * u, (self.theme.title_height + 0.6) * u, -1.2 * u, -0.9 * u
        )

    def frame(
        self,
        painter: ThemedPainter,
        title: str,
        color: str = "frame",
        width: float = 0.16,
        *,
        reserved_px: float = 0.0,
    ) -> None:
        """Draw a frame with a title in its top edge, as in text-mode programs.

        ``reserved_px`` is the width at the right end of the edge that the title must leave free.
        """
        look, u, title = self.theme, self.theme.unit_px, tr(title)
        self._titled = title
        high = look.title_height * u
        top = 0.5 * high
        pen = look.make_pen(color, width)
        half = pen.widthF() / 2
        box = self.find_full_area().adjusted(half, top, -half, -half)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.get_color("panel"))
        painter.drawRect(box)
        painter.setPen(QPen(pen))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(box)
        size = look.find_em_height(1.7, TextRole.TABLE, high)
        font = look.fit_font(title, size, self.width() - 4 * u - reserved_px, is_bold=True)
        painter.setFont(font)
        wide = QFontMetricsF(font).horizontalAdvance(title)
        patch = QRectF(1.6 * u, 0.0, wide + 1.2 * u, high)
        painter.fillRect(
            QRectF(patch.x(), top - half - 1, patch.width(), 2 * half + 2), look.get_color("ground")
        )
        painter.fill_rect(QRectF(patch.x(), top, patch.width(), 0.5 * high), "panel")
        painter.setPen(look.get_color("soft"))
        draw_text(painter, patch.adjusted(0.6 * u, 0, 0, 0), ALIGN_LEFT, title)


# --- multi-touch --------------------------------------------------------------------------------------


MOUSE_TOUCH_ID = -1  # Touch number of the mouse.


@dataclass(frozen=True, slots=True)
class TouchControl:
    """Touch control with actions for pressing it, moving the finger and releasing it."""

    box: QRectF
    on_press: Callable[[QPointF], None]
    on_move: Callable[[QPointF], None] | None = None
    on_release: Callable[[], None] | None = None
    stops_machine: bool = False  # The control stops the machine, so it also acts on a late press.
    watched_stop: StopKind | None = None  # The stop that the key watcher sends while the screen is stalled.
    name: str = ""  # See ``TouchTarget``.
    kind: Literal["key", "slider"] = "key"

    def make_target(self) -> TouchTarget:
        """Return the control as a target for assistive technology."""
        return TouchTarget(
            self.box, ignore_press if self.on_move else self.press_and_release, self.name, self.kind
        )

    def press_and_release(self) -> None:
        """Press the control at its center, and release it."""
        self.on_press(self.box.center())
        if self.on_release:
            self.on_release()

    def make_stop_control(self) -> TouchControl:
        """Return a copy of the control that is marked as stopping the machine."""
        return replace(self, stops_machine=True)


def make_press_control(box: QRectF, press: OnPress, name: str = "") -> TouchControl:
    """Return a control that acts when it is pressed anywhere in its box."""
    return TouchControl(box, lambda _at: press(), name=name)


class TouchPanel(Panel):
    """A panel with controls that react to several simultaneous touches and to the mouse.

    ``draw`` creates the controls.
    """

    def __init__(self, theme: ScreenTheme, parent: QWidget | None = None) -> None:
        super().__init__(theme, parent)
        self.controls: list[TouchControl] = []
        self._held: dict[int, TouchControl] = {}
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    def list_targets(self) -> Sequence[TouchTarget]:
        """Return all touch targets of the panel, including one for each control."""
        return [*super().list_targets(), *(each.make_target() for each in self.controls)]

    def has_stop_control_at(self, position: QPointF) -> bool:
        """Return whether a control at this position stops the machine."""
        return any(control.stops_machine and control.box.contains(position) for control in self.controls)

    @property
    def touch_count(self) -> int:
        """Return the number of touches that are pressing a control, with the mouse counted as a touch."""
        return len(self._held)

    def release_mouse(self) -> None:
        """Release the control that the mouse has pressed, because the button's release event was lost."""
        self._up(MOUSE_TOUCH_ID)

    def release_all_controls(self) -> None:
        """Release all controls, because their release events will not arrive."""
        for finger in tuple(self._held):
            self._up(finger)

    def event(self, event: QEvent) -> bool:
        """Handle touch events, and pass all other events to Qt."""
        if not isinstance(event, QTouchEvent):
            return super().event(event)
        for point in event.points():
            self._finger(point)
        if event.type() == QEvent.Type.TouchCancel:
            self.release_all_controls()
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
        """Press a control with the left button.

        A control that stops the machine accepts any button.
        """
        if event.button() is Qt.MouseButton.LeftButton or self.has_stop_control_at(event.position()):
            self._up(MOUSE_TOUCH_ID)
            self._down(MOUSE_TOUCH_ID, event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the pointer within the control that the mouse has pressed."""
        self._along(MOUSE_TOUCH_ID, event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Release the control that the mouse has pressed, regardless of the pointer's position."""
        if not event.buttons() & Qt.MouseButton.LeftButton:
            self._up(MOUSE_TOUCH_ID)

    def _down(self, finger: int, at: QPointF) -> None:
        for control in self.controls:
            if control.box.contains(at):
                self._held[finger] = control
                control.on_press(at)
                return

    def _along(self, finger: int, at: QPointF) -> None:
        control = self._held.get(finger)
        if control and control.on_move:
            control.on_move(at)

    def _up(self, finger: int) -> None:
        control = self._held.pop(finger, None)
        if control and control.on_release:
            control.on_release()
