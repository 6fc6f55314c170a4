"""Page with keys and touch targets that move an axis while they are held down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QKeyEvent, QPolygonF
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.translation import tr
from app.jog.held_jog import HeldJog, JogDirection
from app.screen.look import CENTRE, Look, Painter, put
from app.screen.page_base import Host, ModelPage, PageModel
from app.screen.panel import Control, FingerPanel

_LOW = 9.0  # Units.
Finger = Callable[[str, str, int], None]  # Arguments: source, axis, sign.


def draw_arrow(painter: Painter, box: QRectF, to: tuple[int, int], colour: str) -> None:
    """Draw an arrow at the side of its target to which the arrow points."""
    size = 0.16 * min(box.width(), box.height())
    centre = box.center() + QPointF(to[0] * 0.30 * box.width(), to[1] * 0.28 * box.height())
    forward, side = QPointF(to[0] * size, to[1] * size), QPointF(to[1] * size, to[0] * size)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(painter.look.colour(colour))
    painter.drawPolygon(QPolygonF([centre + forward, centre - forward + side, centre - forward - side]))


def draw_middle(painter: Painter, box: QRectF, words: tuple[str, str, str]) -> None:
    """Draw the present jog mode in the middle of the cross: its kind, value and unit."""
    kind, figure, unit = words
    high, edge = 2.2 * painter.look.u, 0.1 * box.height()
    painter.write(QRectF(box.x(), box.y() + edge, box.width(), high), kind, 1.6, "soft", at=CENTRE)
    put(painter, QRectF(box.x(), box.bottom() - edge - high, box.width(), high), CENTRE, unit)
    painter.write(box, figure, 3.2, "text", at=CENTRE, margin=1.0)


class JogCross(FingerPanel):
    """Cross of touch targets. An axis moves while one of its targets is touched."""

    def __init__(
        self,
        look: Look,
        hold: HeldJog,
        directions: Sequence[JogDirection],
        finger: Finger,
        parent: QWidget,
    ) -> None:
        super().__init__(look, parent)
        self._hold, self._directions, self._finger_on = hold, directions, finger
        self.mark = ""  # Mark that follows X, Y and Z in a tilted plane.

    def cross(self, painter: Painter, room: QRectF) -> QRectF:
        """Draw the targets in this rectangle, and return the rectangle in their middle."""
        u = self.look.u
        columns = 1 + max(2, *(each.column for each in self._directions))
        wide, high = room.width() / columns, room.height() / 3
        for each in self._directions:
            x, y = room.x() + each.column * wide, room.y() + each.row * high
            self._target(painter, QRectF(x, y, wide - 0.8 * u, high - 0.6 * u), each)
        return QRectF(room.x() + wide, room.y() + high, wide - 0.8 * u, high - 0.6 * u)

    def _target(self, painter: Painter, box: QRectF, way: JogDirection) -> None:
        u, held = self.look.u, self._hold.held
        axis, sign, arrow = way.axis, way.sign, way.arrow
        moving = held is not None and held.axis == axis and held.velocity * sign > 0
        painter.box(
            box.adjusted(0.1 * u, 0.1 * u, -0.1 * u, -0.1 * u),
            "run" if moving else "accent",
            0.24,
            "run" if moving else "key",
        )
        low = (
            box.height() < _LOW * u and arrow[0] == 0
        )  # Too low for an arrow above the name, so the arrow is next to the name.
        at = box.adjusted(0.12 * box.width(), 0, -0.62 * box.width(), 0) if low else box
        if arrow != (0, 0):
            draw_arrow(painter, at, arrow, "on_state" if moving else "accent")
        up = 0.0 if low else 0.16
        aside = box.translated(-arrow[0] * 0.16 * box.width(), -arrow[1] * up * box.height())
        mark = self.mark if axis in "XYZ" else ""
        name = f"{way.shown or axis}{mark}{'+' if sign > 0 else '−'}"
        painter.write(aside, name, 3.4, "on_state" if moving else "text", at=CENTRE)
        corner = box.adjusted(0.8 * u, 0.3 * u, 0, 2.4 * u - box.height())
        painter.write(corner, way.label, 1.5, "on_state" if moving else "soft")
        self.controls.append(self._holder(box, axis, sign))

    def _holder(self, box: QRectF, axis: str, sign: int) -> Control:
        """Return the control of a target. It acts until the touch ends or leaves the target."""
        hold = self._hold
        source = f"finger {axis}{sign}"

        def along(at: QPointF) -> None:
            if not box.contains(at):
                hold.release(source)

        return Control(
            box, lambda _at: self._finger_on(source, axis, sign), along, lambda: hold.release(source)
        )


Key = Qt.Key
CHORDS = (
    Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier | Qt.KeyboardModifier.MetaModifier
)


class HeldModel(PageModel, Protocol):
    """Interface of the page's model. ``active``: a key is held down, or the handwheel is selected."""

    @property
    def hold(self) -> HeldJog: ...

    @property
    def directions(self) -> Sequence[JogDirection]: ...

    @property
    def active(self) -> bool: ...

    def let_go(self) -> None: ...


class HeldKeysPage(ModelPage):
    """A page with keys that act while they are held down. ``pad`` is its cross.

    The page detects presses and releases. The model decides what they do.
    """

    model: HeldModel
    pad: JogCross

    def __init__(self, host: Host, model: HeldModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model
        self._arrows = {
            Key.__members__[f"Key_{each.key}"]: (each.axis, each.sign) for each in model.directions
        }
        self._was_active = False  # Whether the window was active before a key was pressed.

    # --- keys ----------------------------------------------------------------------------------------

    def key_down(self, event: QKeyEvent) -> bool:
        """Handle a direction key. Any other key ends the motion and then has its usual function."""
        key, model = Key(event.key()), self.model
        if key not in self._arrows:
            if not event.isAutoRepeat():
                model.hold.other_key()
            return self.other_key(event)
        if event.isAutoRepeat():
            model.hold.repeated(key.name)
        elif event.modifiers() & CHORDS:
            model.hold.other_key()
        elif event.modifiers() & Qt.KeyboardModifier.KeypadModifier:
            model.hold.other_key()
            self.desk.say(tr("NUM LOCK IS OFF. NUMBER PAD ARROWS DO NOT JOG"))
        else:
            axis, sign = self._arrows[key]
            rapid = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            model.hold.press(key.name, axis, sign, rapid=rapid)
        return True

    def other_key(self, _event: QKeyEvent) -> bool:
        """Handle a key that is not a direction. Return True if the key was handled."""
        return False

    def key_up(self, event: QKeyEvent) -> None:
        """Handle the release of a direction key or Shift. Releases of a repeating key are ignored."""
        if event.isAutoRepeat():
            return
        key = Key(event.key())
        if key in self._arrows:
            self.model.hold.release(key.name)
        elif key == Key.Key_Shift:
            self.model.hold.shift_released()

    def pressed(self) -> None:
        """End the motion because another key or touch acts."""
        self.model.hold.other_key()

    def let_go(self) -> None:
        """Release all keys and touches, because the window has lost the keyboard."""
        self.pad.let_go()
        self.model.let_go()

    def _has_keyboard(self) -> bool:
        """Return whether keys still reach this page, and no dialog, menu or other window.

        Without a window manager, the window is never active. In this case, only a loss of the active state
        counts.
        """
        active = self.window().isActiveWindow()
        if not self.model.active:
            self._was_active = active
        covered = QApplication.activeModalWidget() or QApplication.activePopupWidget()
        return covered is None and (active or not self._was_active)

    def let_go_if_held(self) -> None:
        """End the motion if something is active, because another window would get the release event."""
        if self.model.active:
            self.let_go()
