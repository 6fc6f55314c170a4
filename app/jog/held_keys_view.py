"""A page on which keys and fingers are held to move a slide, and the cross of targets that they hold."""

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

_LOW = 9.0  # units
Finger = Callable[[str, str, int], None]  # what it is, axis, sign


def draw_arrow(painter: Painter, box: QRectF, to: tuple[int, int], colour: str) -> None:
    """At the side of its target to which it points."""
    size = 0.16 * min(box.width(), box.height())
    centre = box.center() + QPointF(to[0] * 0.30 * box.width(), to[1] * 0.28 * box.height())
    forward, side = QPointF(to[0] * size, to[1] * size), QPointF(to[1] * size, to[0] * size)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(painter.look.colour(colour))
    painter.drawPolygon(QPolygonF([centre + forward, centre - forward + side, centre - forward - side]))


def draw_middle(painter: Painter, box: QRectF, words: tuple[str, str, str]) -> None:
    """What an arrow does now: its kind, the figure, the unit."""
    kind, figure, unit = words
    high, edge = 2.2 * painter.look.u, 0.1 * box.height()
    painter.write(QRectF(box.x(), box.y() + edge, box.width(), high), kind, 1.6, "soft", at=CENTRE)
    put(painter, QRectF(box.x(), box.bottom() - edge - high, box.width(), high), CENTRE, unit)
    painter.write(box, figure, 3.2, "text", at=CENTRE, margin=1.0)


class JogCross(FingerPanel):
    """A slide moves while a finger is on one of its targets."""

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
        self.mark = ""  # behind X Y Z where they are those of a tilted plane

    def cross(self, painter: Painter, room: QRectF) -> QRectF:
        """Draw the targets into this room; where their middle is."""
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
        )  # too low for an arrow over its name: it stands beside
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
        """Held from the touch until the finger comes up, or leaves the target."""
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
    """What such a page asks of its model. ``active``: something is held, or may move by itself."""

    @property
    def hold(self) -> HeldJog: ...

    @property
    def directions(self) -> Sequence[JogDirection]: ...

    @property
    def active(self) -> bool: ...

    def let_go(self) -> None: ...


class HeldKeysPage(ModelPage):
    """The model decides what a press means; this knows whether it is one. ``pad`` is its cross."""

    model: HeldModel
    pad: JogCross

    def __init__(self, host: Host, model: HeldModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model
        self._arrows = {
            Key.__members__[f"Key_{each.key}"]: (each.axis, each.sign) for each in model.directions
        }
        self._was_active = False  # the window, before anything was held

    # --- keys ----------------------------------------------------------------------------------------

    def key_down(self, event: QKeyEvent) -> bool:
        """The arrows are this page's; any other key ends what is held and then means what it means."""
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
        """A key that is no direction; True takes it."""
        return False

    def key_up(self, event: QKeyEvent) -> None:
        """An arrow comes up, or the Shift of a rapid. Releases that a repeating key makes are none."""
        if event.isAutoRepeat():
            return
        key = Key(event.key())
        if key in self._arrows:
            self.model.hold.release(key.name)
        elif key == Key.Key_Shift:
            self.model.hold.shift_released()

    def pressed(self) -> None:
        """Whoever reaches for something else does not look at the slide."""
        self.model.hold.other_key()

    def let_go(self) -> None:
        """The keyboard or the window is gone."""
        self.pad.let_go()
        self.model.let_go()

    def _has_keyboard(self) -> bool:
        """Whether keys still come here: no dialog, no menu, no other window in front.

        A screen without a window manager never becomes active; there only the loss of it counts.
        """
        active = self.window().isActiveWindow()
        if not self.model.active:
            self._was_active = active
        covered = QApplication.activeModalWidget() or QApplication.activePopupWidget()
        return covered is None and (active or not self._was_active)

    def let_go_if_held(self) -> None:
        """Something lies in front that would take the release."""
        if self.model.active:
            self.let_go()
