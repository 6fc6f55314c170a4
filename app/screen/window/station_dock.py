"""On-screen operator station of a simulated machine, for touch and keys."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.station_controls import OverridePot
from app.desk.status import formats
from app.desk.status.state_prompt import find_start_refusal
from app.desk.stop_keys.stop_records import StopKind
from app.desk.translation import tr
from app.screen.panel import RedrawingAttribute, TouchControl, TouchPanel, make_press_control
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_RIGHT, ScreenTheme, ThemedPainter
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import Snapshot

_ROUND_BUTTON_MARGIN = 0.8  # Units: height of a row above and below its round button together.
DESIGN_HEIGHT = 71.6  # Height in units for which the rows are designed. A taller dock scales them.


class DockRows(NamedTuple):
    """Rectangles of the controls of the operator station and of their labels, from top to bottom."""

    estop: QRectF
    switch_label: QRectF
    switch: QRectF
    spindle_label: QRectF
    spindle: QRectF
    feed_label: QRectF
    feed: QRectF
    hold: QRectF
    start_label: QRectF
    start: QRectF


class StationDock(TouchPanel):
    """On-screen operator station: E-stop, spindle switch, override pots, feed hold and start."""

    title = "OPERATOR STATION"
    _shown: RedrawingAttribute[object] = RedrawingAttribute(())
    _auto = RedrawingAttribute(True)
    hidden_keys: RedrawingAttribute[frozenset[str]] = RedrawingAttribute(
        frozenset()
    )  # Keys that have no function now and are not shown.
    is_start_disabled = RedrawingAttribute(False)  # Cycle Start would be rejected now.

    def __init__(self, theme: ScreenTheme, desk: Desk, parent: QWidget | None = None) -> None:
        super().__init__(theme, parent)
        self._desk = desk
        self._twisting = False

    def show_state(self, snapshot: Snapshot) -> None:
        """Show the current positions of the switches and buttons."""
        desk = self._desk
        self._auto, self.is_start_disabled = snapshot.spindle_auto, bool(find_start_refusal(desk, snapshot))
        palms = frozenset(desk.station_controls.palms.press_times)
        pots = (desk.station_controls.spindle_pot.wanted, desk.station_controls.feed_pot.wanted)
        latched = desk.settings_store.current_settings.latched and desk.machine.allows_one_hand_start
        self._shown = (
            desk.station_controls.is_estop_pressed,
            pots,
            palms,
            latched,
            desk.station_controls.update_latched_side(),
        )

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Turn the override pot under the pointer by one step."""
        steps = 1 if event.angleDelta().y() > 0 else -1
        if self._feed_box().contains(event.position()):
            self._desk.station_keys.step_feed_override(steps)
        elif self._spindle_box().contains(event.position()):
            self._desk.station_controls.turn_spindle_pot(steps)

    def _find_rows(self) -> DockRows:
        """Return the rectangles of the controls and of their labels from top to bottom.

        The labels are as high as their texts require. The other controls are as high as a fingertip at
        least, and the E-stop and the palm buttons share the remaining height. If this is less than a
        fingertip, the labels are less high.
        """
        u, scale = self.theme.unit_px, self.height() / DESIGN_HEIGHT
        label, control = self.theme.find_line_height(2.4 * scale / u), max(6.5 * scale, float(FINGERTIP_PX))
        top, gap = self.theme.title_height * u, 0.35 * scale
        room = self.height() - top - 4 * control - 6 * gap
        large = max(0.5 * (room - 4 * label), FINGERTIP_PX + _ROUND_BUTTON_MARGIN * u)
        label = 0.25 * max(0.0, room - 2 * large)
        pair = (label, control + gap)
        rows, y = list[QRectF](), top
        for high in (large + gap, *pair, *pair, *pair, control + gap, label, large):
            rows.append(QRectF(1.2 * u, y, self.width() - 2.4 * u, high - (gap if high > label + gap else 0)))
            y += high
        return DockRows(*rows)

    def _spindle_box(self) -> QRectF:
        return self._find_rows().spindle

    def _feed_box(self) -> QRectF:
        return self._find_rows().feed

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the controls of the operator station, and set their touch targets."""
        self.controls.clear()
        desk, rows = self._desk, self._find_rows()
        self._mushroom(painter)
        self._switch(painter)
        spindle, feed = desk.station_controls.spindle_pot, desk.station_controls.feed_pot
        self._label(
            painter, rows.spindle_label, "SPINDLE SPEED", formats.format_percent(spindle.wanted), "text"
        )
        keys = ("−", "+") if "," in self.hidden_keys else (",", ".")
        name = "SPINDLE SPEED"
        self._pot(painter, self._spindle_box(), name, keys, spindle, desk.station_controls.turn_spindle_pot)
        self._label(painter, rows.feed_label, "FEED RATE", formats.format_percent(feed.wanted), "text")
        self._pot(
            painter, self._feed_box(), "FEED RATE", ("−", "+"), feed, desk.station_keys.step_feed_override
        )
        self._hold(painter)
        self._start(painter)

    def _label(self, painter: ThemedPainter, at: QRectF, text: str, right: str, colour: str) -> None:
        split = (0.66 if len(right) > 1 else 0.84) * at.width()
        painter.draw_text_line(at.adjusted(0, 0, split - at.width(), 0), text, 1.6, "soft")
        painter.draw_text_line(at.adjusted(split, 0, 0, 0), right, 2.0, colour, at=ALIGN_RIGHT)

    def _mushroom(self, painter: ThemedPainter) -> None:
        look, u = self.theme, self.theme.unit_px
        box, pressed = self._find_rows().estop, self._desk.station_controls.is_estop_pressed
        painter.fill_rect(box, "estop_plate")
        side = min(box.width() - 8.0 * u, box.height() - _ROUND_BUTTON_MARGIN * u)
        head = QRectF(box.x() + 0.8 * u, box.center().y() - side / 2, side, side)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.get_color("estop_rim"))
        painter.drawEllipse(head)
        inset = (2.0 if pressed else 0.8) * u
        painter.setBrush(look.get_color("estop"))
        painter.drawEllipse(head.adjusted(inset, inset, -inset, -inset))
        for text, size, down in (("STOP", 2.2, -1.4), ("PRESSED" if pressed else "SCR LOCK", 1.6, 1.6)):
            painter.draw_text_line(
                head.translated(0, down * u), text, size, "estop_ink", at=ALIGN_CENTER, margin=2.4
            )
        self.controls.append(
            TouchControl(head, self._struck, stops_machine=True, watched_stop=StopKind.ESTOP)
        )
        out = QRectF(head.right() + 0.6 * u, box.y() + 0.8 * u, 0, box.height() - 1.6 * u)
        out.setRight(box.right() - 0.6 * u)
        self._release(painter, out, pressed)

    def _release(self, painter: ThemedPainter, box: QRectF, pressed: bool) -> None:
        painter.draw_box(box, "estop_ground", 0.14, "estop_ground" if pressed else "")
        ink, third = "estop_plate" if pressed else "estop_ground", QRectF(box)
        third.setHeight(box.height() / 3)
        for number, word in enumerate(("TWIST", "OUT", "" if "U" in self.hidden_keys else "U")):
            row = third.translated(0, number * third.height())
            painter.draw_text_line(row, word, 1.7, ink, at=ALIGN_CENTER, margin=0.6)
        self.controls.append(TouchControl(box, self._twist_begins, None, self._end_twist))

    def _struck(self, _at: QPointF) -> None:
        self._twisting = False
        self._desk.station_keys.press_estop()

    def _twist_begins(self, _at: QPointF) -> None:
        self._twisting = self.touch_count == 1

    def _end_twist(self) -> None:
        """Release the E-stop if a single touch began and ended on its twist field.

        A hand that hits the button touches both the button and the field, and therefore releases nothing.
        """
        if self._twisting and not self.touch_count:
            self._desk.station_controls.estop(is_pressed=False)

    def _switch(self, painter: ThemedPainter) -> None:
        self._label(
            painter,
            self._find_rows().switch_label,
            "SPINDLE SWITCH",
            "" if "A" in self.hidden_keys else "A",
            "accent",
        )
        box = self._find_rows().switch
        half = box.width() / 2
        for number, word in enumerate(("OFF", "AUTO")):
            on = self._auto is (word == "AUTO")
            at = QRectF(box.x() + number * half, box.y(), half, box.height())
            painter.draw_box(at, "frame", 0.14, "lit" if on else "panel")
            painter.draw_text_line(at, word, 2.2, "on_lit" if on else "soft", at=ALIGN_CENTER)
            press = partial(self._desk.station_controls.set_spindle_auto, word == "AUTO")
            self.controls.append(make_press_control(at, press))

    def _pot(
        self,
        painter: ThemedPainter,
        box: QRectF,
        name: str,
        keys: tuple[str, str],
        pot: OverridePot,
        turn: Callable[[int], None],
    ) -> None:
        u = self.theme.unit_px
        wide = max(4.6 * u, float(FINGERTIP_PX))
        less = QRectF(box.x(), box.y(), wide, box.height())
        more = QRectF(box.right() - wide, box.y(), wide, box.height())
        for at, key, steps in ((less, keys[0], -1), (more, keys[1], 1)):
            painter.fill_rect(at, "key")
            painter.draw_text_line(at, key, 2.8, "accent", at=ALIGN_CENTER)
            self.controls.append(make_press_control(at, partial(turn, steps), name))
        track = box.adjusted(wide + 0.5 * u, 0, -wide - 0.5 * u, 0)
        painter.draw_box(track, "frame", 0.14, "panel")
        self._slider(
            painter, track.adjusted(0.3 * u, 0.3 * u, -0.3 * u, -0.3 * u), pot.wanted / pot.max_fraction
        )

        def turn_pot_to(at: QPointF) -> None:
            pot.set(round((at.x() - track.x()) / track.width() * pot.max_fraction * 20) / 20)

        self.controls.append(TouchControl(track, turn_pot_to, turn_pot_to, name=name, kind="slider"))

    def _slider(self, painter: ThemedPainter, inner: QRectF, share: float) -> None:
        u = self.theme.unit_px
        filled = inner.width() * max(0.0, min(1.0, share))
        painter.fill_rect(QRectF(inner.x(), inner.y(), filled, inner.height()), "here")
        x = min(max(inner.x() + filled - 0.5 * u, inner.x()), inner.right() - u)
        painter.fill_rect(QRectF(x, inner.y(), u, inner.height()), "accent")

    def _hold(self, painter: ThemedPainter) -> None:
        u, desk = self.theme.unit_px, self._desk
        box = self._find_rows().hold
        painter.draw_box(box.adjusted(0.15 * u, 0.15 * u, -0.15 * u, -0.15 * u), "pause", 0.3, "panel")
        inner = box.adjusted(0.8 * u, 0, -0.8 * u, 0)
        room = inner.adjusted(0, 0, -0.42 * inner.width(), 0)
        lines = tr("FEED HOLD").split(" ", 1)
        high = room.height() / len(lines)
        for number, line in enumerate(lines):
            row = QRectF(room.x(), room.y() + number * high, room.width(), high)
            painter.draw_text_line(row, line, 2.3, "text")
        right = QRectF(room.right(), inner.y(), inner.right() - room.right(), 0.5 * inner.height())
        painter.draw_text_line(right, "" if "H" in self.hidden_keys else "H", 2.2, "accent", at=ALIGN_RIGHT)
        painter.draw_text_line(right.translated(0, right.height()), "PAUSE", 1.5, "accent", at=ALIGN_RIGHT)
        press, release = (
            partial(desk.station_controls.hold, is_down=True),
            partial(desk.station_controls.hold, is_down=False),
        )
        self.controls.append(
            TouchControl(
                box, lambda _at: press(), None, release, stops_machine=True, watched_stop=StopKind.HOLD
            )
        )

    def _start(self, painter: ThemedPainter) -> None:
        desk = self._desk
        head = self._find_rows().start_label
        text = "CYCLE START: BOTH BUTTONS" if desk.machine.has_two_hand_start else "CYCLE START"
        if self._is_latching:
            text = "CYCLE START: TAP F11, F12"
        painter.draw_text_line(head, text, 1.6, "pause" if self._is_latching else "soft")
        box = self._find_rows().start
        if not desk.machine.has_two_hand_start:
            self._palm(painter, box, "F12", down=False)
            self.controls.append(make_press_control(box, desk.station_keys.press_start))
            return
        half = box.width() / 2
        for number, (side, key) in enumerate((("left", "F11"), ("right", "F12"))):
            at = QRectF(box.x() + number * half, box.y(), half, box.height())
            waits = self._is_latching and desk.station_controls.update_latched_side() == side
            self._palm(
                painter, at, "…" if waits else key, waits or side in desk.station_controls.palms.press_times
            )
            self.controls.append(self._palm_control(at, side))

    @property
    def _is_latching(self) -> bool:
        """Return whether a touch latches a palm button, so that both can be pressed one after the other.

        They latch if this is selected with F10 7 and all axes are simulated.
        """
        return self._desk.settings_store.current_settings.latched and self._desk.machine.allows_one_hand_start

    def _palm_control(self, at: QRectF, side: str) -> TouchControl:
        hands = self._desk.station_controls
        if self._is_latching:
            return TouchControl(at, lambda _at: hands.latch(side), None, hands.release_palm_buttons)
        press, release = (partial(self._desk.station_controls.palm, side, down) for down in (True, False))
        return TouchControl(at, lambda _at: press(), None, release)

    def _palm(self, painter: ThemedPainter, box: QRectF, key: str, down: bool) -> None:
        look, u = self.theme, self.theme.unit_px
        size = min(box.width(), box.height()) - _ROUND_BUTTON_MARGIN * u
        head = QRectF(box.center().x() - size / 2, box.center().y() - size / 2, size, size)
        ink = "frame" if self.is_start_disabled else "run"
        painter.setPen(look.make_pen(ink, 0.3))
        painter.setBrush(look.get_color("key"))
        painter.drawEllipse(head)
        inset = (1.7 if down else 0.9) * u
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.get_color("lit" if down else ink))
        painter.drawEllipse(head.adjusted(inset, inset, -inset, -inset))
        painter.draw_text_line(head, key, 2.3, "on_lit" if down else "on_state", at=ALIGN_CENTER)
