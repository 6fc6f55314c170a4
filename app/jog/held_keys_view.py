"""Base class of pages with keys and touch targets that move an axis only while they are held down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QKeyEvent, QPolygonF
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.translation import tr
from app.jog.held_jog import HeldJog, JogDirection
from app.screen.page_base import ModelPage, PageHost, PageModel
from app.screen.panel import TouchControl, TouchPanel
from app.screen.screen_theme import ALIGN_CENTER, ScreenTheme, ThemedPainter

_LOW_CROSS_HEIGHT = 9.0  # Units.
TouchHandler = Callable[[str, str, int], None]  # Arguments: source, axis, sign.


def draw_arrow(painter: ThemedPainter, box: QRectF, direction: tuple[int, int], color: str) -> None:
    """Draw an arrow in a touch target, near the edge toward which the arrow points."""
    size = 0.16 * min(box.width(), box.height())
    centre = box.center() + QPointF(direction[0] * 0.30 * box.width(), direction[1] * 0.28 * box.height())
    forward, side = (
        QPointF(direction[0] * size, direction[1] * size),
        QPointF(direction[1] * size, direction[0] * size),
    )
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(painter.theme.get_color(color))
    painter.drawPolygon(QPolygonF([centre + forward, centre - forward + side, centre - forward - side]))


def draw_jog_mode(painter: ThemedPainter, box: QRectF, mode_labels: tuple[str, str, str]) -> None:
    """Draw the current jog mode in the middle of the cross of arrow keys.

    ``mode_labels`` are the name of the mode, its value and the unit.
    """
    kind, figure, unit = mode_labels
    high = painter.theme.find_line_height(2.2)
    if box.height() < 3 * high:  # The value and its unit share a line.
        figure, unit = f"{figure} {unit}", ""
    lines = [(kind, 1.6, "soft"), (figure, 3.2 if unit else 2.2, "text"), (unit, 1.6, "soft")]
    lines = [line for line in lines if line[0]]
    row = QRectF(box.x(), box.y(), box.width(), box.height() / len(lines))
    for number, (text, size, ink) in enumerate(lines):
        at = row.translated(0, number * row.height())
        painter.draw_text_line(at, text, size, ink, at=ALIGN_CENTER, margin=0.4)


class JogCross(TouchPanel):
    """Cross of touch targets, one for each jog direction.

    An axis moves while its target is touched.
    """

    def __init__(
        self,
        theme: ScreenTheme,
        held_jog: HeldJog,
        directions: Sequence[JogDirection],
        on_direction_touch: TouchHandler,
        parent: QWidget,
    ) -> None:
        super().__init__(theme, parent)
        self._hold, self._directions, self._finger_on = held_jog, directions, on_direction_touch
        self.axis_suffix = ""  # Mark that follows X, Y and Z in a tilted plane.

    def draw_cross(self, painter: ThemedPainter, area: QRectF) -> QRectF:
        """Draw the touch targets in a rectangle, and return the free area in the middle of the cross."""
        for each in self._directions:
            box = self.find_cell(area, each.cell_column, each.cell_row)
            self._target(painter, box, each)
        return self.find_cell(area, 1, 1)

    def find_cell(self, area: QRectF, column: int, row: int) -> QRectF:
        """Return the rectangle of a cell of the cross, which has three rows."""
        u, wide, high = self.theme.unit_px, area.width() / self.column_count, area.height() / 3
        return QRectF(area.x() + column * wide, area.y() + row * high, wide - 0.8 * u, high - 0.6 * u)

    @property
    def column_count(self) -> int:
        """Return the number of columns of the cross."""
        return 1 + max(2, *(each.cell_column for each in self._directions))

    @property
    def has_free_top_corners(self) -> bool:
        """Return whether no axis uses the upper left and the upper right cell of the cross."""
        corners = {(0, 0), (self.column_count - 1, 0)}
        return not corners & {(each.cell_column, each.cell_row) for each in self._directions}

    def _target(self, painter: ThemedPainter, box: QRectF, direction: JogDirection) -> None:
        u, held = self.theme.unit_px, self._hold.active_jog
        axis, sign, arrow = direction.axis_name, direction.direction_sign, direction.arrow_direction
        moving = held is not None and held.axis_name == axis and held.velocity * sign > 0
        painter.draw_box(
            box.adjusted(0.1 * u, 0.1 * u, -0.1 * u, -0.1 * u),
            "run" if moving else "accent",
            0.24,
            "run" if moving else "key",
        )
        low = (
            box.height() < _LOW_CROSS_HEIGHT * u and arrow[0] == 0
        )  # Too low for an arrow above the name, so the arrow is next to the name.
        at = box.adjusted(0.12 * box.width(), 0, -0.62 * box.width(), 0) if low else box
        if arrow != (0, 0):
            draw_arrow(painter, at, arrow, "on_state" if moving else "accent")
        up = 0.0 if low else 0.16
        aside = box.translated(-arrow[0] * 0.16 * box.width(), -arrow[1] * up * box.height())
        mark = self.axis_suffix if axis in "XYZ" else ""
        name = f"{direction.displayed_axis_name or axis}{mark}{'+' if sign > 0 else '−'}"
        painter.draw_text_line(aside, name, 3.4, "on_state" if moving else "text", at=ALIGN_CENTER)
        corner = QRectF(box.x() + 0.5 * u, box.y() + 0.2 * u, box.width(), self.theme.find_line_height(2.1))
        painter.draw_text_line(corner, direction.label, 1.5, "on_state" if moving else "soft")
        self.controls.append(self._make_control(box, axis, sign))

    def _make_control(self, box: QRectF, axis: str, sign: int) -> TouchControl:
        """Return the touch control for a jog direction.

        The control is active until the touch ends or leaves the target.
        """
        hold = self._hold
        source = f"finger {axis}{sign}"

        def follow_touch(at: QPointF) -> None:
            if not box.contains(at):
                hold.release_key(source)

        return TouchControl(
            box,
            lambda _at: self._finger_on(source, axis, sign),
            follow_touch,
            lambda: hold.release_key(source),
        )


Key = Qt.Key
CHORD_MODIFIERS = (
    Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier | Qt.KeyboardModifier.MetaModifier
)


class HeldKeysModel(PageModel, Protocol):
    """Interface of the model of a page with keys that are held down.

    ``is_active`` is True while a key is held down or the handwheel is selected.
    """

    @property
    def held_jog(self) -> HeldJog:
        """Return the jog that runs while a key or touch is held down."""
        ...

    @property
    def directions(self) -> Sequence[JogDirection]:
        """Return the jog directions of the page."""
        ...

    @property
    def is_active(self) -> bool:
        """Return whether a key is held down or the handwheel is selected."""
        ...

    def release_all_keys(self) -> None:
        """Stop the motion, because the page will not receive the key releases."""
        ...


class HeldKeysPage(ModelPage):
    """Page with keys that act only while they are held down.

    The page detects presses and releases, and the model moves the axes. ``jog_cross`` is the cross of touch
    targets.
    """

    model: HeldKeysModel
    jog_cross: JogCross

    def __init__(self, host: PageHost, model: HeldKeysModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model
        self._arrows = {
            Key.__members__[f"Key_{each.key_name}"]: (each.axis_name, each.direction_sign)
            for each in model.directions
        }
        self._was_active = False  # Whether the window was active before a key was pressed.

    # --- keys ----------------------------------------------------------------------------------------

    def handle_key_press(self, event: QKeyEvent) -> bool:
        """Handle a direction key, which moves an axis.

        Any other key stops the motion and then has its usual function.
        """
        key, model = Key(event.key()), self.model
        if key not in self._arrows:
            if not event.isAutoRepeat():
                model.held_jog.stop_for_other_key()
            return self.handle_other_key(event)
        if event.isAutoRepeat():
            model.held_jog.record_key_repeat(key.name)
        elif event.modifiers() & CHORD_MODIFIERS:
            model.held_jog.stop_for_other_key()
        elif event.modifiers() & Qt.KeyboardModifier.KeypadModifier:
            model.held_jog.stop_for_other_key()
            self.desk.say(tr("NUM LOCK IS OFF. NUMBER PAD ARROWS DO NOT JOG"))
        else:
            axis, sign = self._arrows[key]
            rapid = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            model.held_jog.handle_direction_press(key.name, axis, sign, is_rapid=rapid)
        return True

    def handle_other_key(self, _event: QKeyEvent) -> bool:
        """Handle a key that is not a direction key, and return whether it was used."""
        return False

    def handle_key_release(self, event: QKeyEvent) -> None:
        """Handle the release of a direction key or of Shift.

        Release events that belong to key repeat are ignored.
        """
        if event.isAutoRepeat():
            return
        key = Key(event.key())
        if key in self._arrows:
            self.model.held_jog.release_key(key.name)
        elif key == Key.Key_Shift:
            self.model.held_jog.release_shift_key()

    def stop_held_key_actions(self) -> None:
        """Stop the motion because another key or touch was pressed."""
        self.model.held_jog.stop_for_other_key()

    def release_all_keys(self) -> None:
        """Release all keys and touches because the window has lost the keyboard focus."""
        self.jog_cross.release_all_controls()
        self.model.release_all_keys()

    def _has_keyboard(self) -> bool:
        """Return whether this page has the keyboard focus, and not a dialog, a menu or another window.

        Without a window manager, the window is never active. Focus then counts as lost only if the window
        was active before.
        """
        active = self.window().isActiveWindow()
        if not self.model.is_active:
            self._was_active = active
        covered = QApplication.activeModalWidget() or QApplication.activePopupWidget()
        return covered is None and (active or not self._was_active)

    def stop_if_active(self) -> None:
        """Stop the motion if a key is held down or the handwheel is selected.

        Another window could receive the release event of the key, and the motion would then not stop.
        """
        if self.model.is_active:
            self.release_all_keys()
