"""The operator station of a simulated machine on the screen, for touch and keys."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.station_hands import Pot
from app.desk.status import formats
from app.desk.status.standing_prompt import start_refusal
from app.desk.translation import tr
from app.screen.look import CENTRE, RIGHT, Look, Painter
from app.screen.panel import Control, FingerPanel, Shown, pressed
from app.screen.window_layout import FINGER
from core.executor.snapshot import Snapshot

DRAWN_FOR = 71.6  # Height in units for which the rows are designed. A taller dock scales them.


class StationDock(FingerPanel):
    """E-stop, spindle switch, two pots, feed hold and the start buttons."""

    title = "OPERATOR STATION"
    _shown: Shown[object] = Shown(())
    _auto = Shown(True)
    mute: Shown[frozenset[str]] = Shown(frozenset())  # Keys that have no function now and are not shown.
    barred = Shown(False)  # Cycle Start would be rejected now.

    def __init__(self, look: Look, desk: Desk, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self._desk = desk
        self._twisting = False

    def show_station(self, snapshot: Snapshot) -> None:
        """Show the present positions of the switches and buttons."""
        desk = self._desk
        self._auto, self.barred = snapshot.spindle_auto, bool(start_refusal(desk, snapshot))
        palms = frozenset(desk.hands.palms.down)
        pots = (desk.hands.spindle_pot.wanted, desk.hands.feed_pot.wanted)
        latched = desk.settings.now.latched and desk.machine.one_hand
        self._shown = (desk.hands.estop_pressed, pots, palms, latched, desk.hands.latch_now())

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Turn the pot under the pointer."""
        steps = 1 if event.angleDelta().y() > 0 else -1
        if self._feed_box().contains(event.position()):
            self._desk.station.step_override(steps)
        elif self._spindle_box().contains(event.position()):
            self._desk.hands.turn_spindle_pot(steps)

    def _row(self, y: float, high: float) -> QRectF:
        u = self.look.u
        scale = self.height() / DRAWN_FOR
        return QRectF(1.4 * u, y * scale, self.width() - 2.8 * u, high * scale)

    def _spindle_box(self) -> QRectF:
        return self._row(28.8, 6.5)

    def _feed_box(self) -> QRectF:
        return self._row(38.7, 6.5)

    def draw(self, painter: Painter) -> None:
        self.controls.clear()
        desk = self._desk
        self._mushroom(painter)
        self._switch(painter)
        spindle, feed = desk.hands.spindle_pot, desk.hands.feed_pot
        self._label(painter, self._row(26.2, 2.4), "SPINDLE SPEED", formats.percent(spindle.wanted), "text")
        keys = ("−", "+") if "," in self.mute else (",", ".")
        name = "SPINDLE SPEED"
        self._pot(painter, self._spindle_box(), name, keys, spindle, desk.hands.turn_spindle_pot)
        self._label(painter, self._row(36.1, 2.4), "FEED RATE", formats.percent(feed.wanted), "text")
        self._pot(painter, self._feed_box(), "FEED RATE", ("−", "+"), feed, desk.station.step_override)
        self._hold(painter)
        self._start(painter)

    def _label(self, painter: Painter, at: QRectF, text: str, right: str, colour: str) -> None:
        painter.write(at, text, 1.6, "soft", fit=False)
        painter.write(at, right, 2.0, colour, at=RIGHT)

    def _mushroom(self, painter: Painter) -> None:
        look, u = self.look, self.look.u
        box, pressed = self._row(2.6, 13.2), self._desk.hands.estop_pressed
        painter.fill(box, "estop_plate")
        side = min(box.width() - 8.0 * u, box.height() - 1.6 * u)
        head = QRectF(box.x() + 0.8 * u, box.center().y() - side / 2, side, side)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("estop_rim"))
        painter.drawEllipse(head)
        inset = (2.0 if pressed else 0.8) * u
        painter.setBrush(look.colour("estop"))
        painter.drawEllipse(head.adjusted(inset, inset, -inset, -inset))
        for text, size, down in (("STOP", 2.2, -1.4), ("PRESSED" if pressed else "SCR LOCK", 1.6, 1.6)):
            painter.write(head.translated(0, down * u), text, size, "estop_ink", at=CENTRE, margin=2.4)
        self.controls.append(Control(head, self._struck, always=True))
        out = QRectF(head.right() + 0.6 * u, box.y() + 0.8 * u, 0, box.height() - 1.6 * u)
        out.setRight(box.right() - 0.6 * u)
        self._release(painter, out, pressed)

    def _release(self, painter: Painter, box: QRectF, pressed: bool) -> None:
        painter.box(box, "estop_ground", 0.14, "estop_ground" if pressed else "")
        ink, third = "estop_plate" if pressed else "estop_ground", QRectF(box)
        third.setHeight(box.height() / 3)
        for number, word in enumerate(("TWIST", "OUT", "" if "U" in self.mute else "U")):
            row = third.translated(0, number * third.height())
            painter.write(row, word, 1.7, ink, at=CENTRE, margin=0.6)
        self.controls.append(Control(box, self._twist_begins, None, self._twist_ends))

    def _struck(self, _at: QPointF) -> None:
        self._twisting = False
        self._desk.station.press_estop()

    def _twist_begins(self, _at: QPointF) -> None:
        self._twisting = self.fingers == 1

    def _twist_ends(self) -> None:
        """Release the E-stop if one finger alone pressed and released the twist field.

        A hand that hits the plate touches both fields and releases nothing.
        """
        if self._twisting and not self.fingers:
            self._desk.hands.estop(pressed=False)

    def _switch(self, painter: Painter) -> None:
        self._label(
            painter, self._row(16.4, 2.4), "SPINDLE SWITCH", "" if "A" in self.mute else "A", "accent"
        )
        box = self._row(18.9, 6.5)
        half = box.width() / 2
        for number, word in enumerate(("OFF", "AUTO")):
            on = self._auto is (word == "AUTO")
            at = QRectF(box.x() + number * half, box.y(), half, box.height())
            painter.box(at, "frame", 0.14, "lit" if on else "panel")
            painter.write(at, word, 2.2, "on_lit" if on else "soft", at=CENTRE)
            press = partial(self._desk.hands.set_spindle_auto, word == "AUTO")
            self.controls.append(pressed(at, press))

    def _pot(
        self,
        painter: Painter,
        box: QRectF,
        name: str,
        keys: tuple[str, str],
        pot: Pot,
        turn: Callable[[int], None],
    ) -> None:
        u = self.look.u
        wide = max(4.6 * u, float(FINGER))
        less = QRectF(box.x(), box.y(), wide, box.height())
        more = QRectF(box.right() - wide, box.y(), wide, box.height())
        for at, key, steps in ((less, keys[0], -1), (more, keys[1], 1)):
            painter.fill(at, "key")
            painter.write(at, key, 2.8, "accent", at=CENTRE)
            self.controls.append(pressed(at, partial(turn, steps), name))
        track = box.adjusted(wide + 0.5 * u, 0, -wide - 0.5 * u, 0)
        painter.box(track, "frame", 0.14, "panel")
        self._slider(painter, track.adjusted(0.3 * u, 0.3 * u, -0.3 * u, -0.3 * u), pot.wanted / pot.most)

        def slide(at: QPointF) -> None:
            pot.set(round((at.x() - track.x()) / track.width() * pot.most * 20) / 20)

        self.controls.append(Control(track, slide, slide, name=name, kind="slider"))

    def _slider(self, painter: Painter, inner: QRectF, share: float) -> None:
        u = self.look.u
        filled = inner.width() * max(0.0, min(1.0, share))
        painter.fill(QRectF(inner.x(), inner.y(), filled, inner.height()), "here")
        x = min(max(inner.x() + filled - 0.5 * u, inner.x()), inner.right() - u)
        painter.fill(QRectF(x, inner.y(), u, inner.height()), "accent")

    def _hold(self, painter: Painter) -> None:
        look, u, desk = self.look, self.look.u, self._desk
        box = self._row(46.4, 7.0)
        painter.box(box.adjusted(0.15 * u, 0.15 * u, -0.15 * u, -0.15 * u), "pause", 0.3, "panel")
        inner = box.adjusted(1.4 * u, 0, -1.4 * u, 0)
        room = inner.adjusted(0, 0, -3.0 * u, 0)
        words = tr("FEED HOLD")
        wide = QFontMetricsF(look.font(2.3, bold=True)).horizontalAdvance(words) > room.width()
        lines = words.split(" ", 1) if wide else [words]
        high = min(room.height() / len(lines), 3.0 * u)
        top = room.center().y() - high * len(lines) / 2
        for number, line in enumerate(lines):
            row = QRectF(room.x(), top + number * high, room.width(), high)
            painter.write(row, line, 2.3, "text", fit=False)
        inner.setHeight(inner.height() / 2)
        painter.write(inner, "" if "H" in self.mute else "H", 2.2, "accent", at=RIGHT)
        painter.write(inner.translated(0, inner.height()), "PAUSE", 1.5, "accent", at=RIGHT, fit=False)
        press, release = partial(desk.hands.hold, down=True), partial(desk.hands.hold, down=False)
        self.controls.append(Control(box, lambda _at: press(), None, release, always=True))

    def _start(self, painter: Painter) -> None:
        desk = self._desk
        head = self._row(54.2, 2.4)
        text = "CYCLE START: BOTH BUTTONS" if desk.machine.two_hand else "CYCLE START"
        if self._latches:
            text = "CYCLE START: TAP F11, F12"
        painter.write(head, text, 1.6, "pause" if self._latches else "soft")
        box = self._row(56.8, 13.6)
        if not desk.machine.two_hand:
            self._palm(painter, box, "F12", down=False)
            self.controls.append(pressed(box, desk.station.press_start))
            return
        half = box.width() / 2
        for number, (side, key) in enumerate((("left", "F11"), ("right", "F12"))):
            at = QRectF(box.x() + number * half, box.y(), half, box.height())
            waits = self._latches and desk.hands.latch_now() == side
            self._palm(painter, at, "…" if waits else key, waits or side in desk.hands.palms.down)
            self.controls.append(self._palm_control(at, side))

    @property
    def _latches(self) -> bool:
        """Whether the palm buttons work with one finger: selected with F10 7, and all axes are simulated."""
        return self._desk.settings.now.latched and self._desk.machine.one_hand

    def _palm_control(self, at: QRectF, side: str) -> Control:
        hands = self._desk.hands
        if self._latches:
            return Control(at, lambda _at: hands.latch(side), None, hands.latch_up)
        press, release = (partial(self._desk.hands.palm, side, down) for down in (True, False))
        return Control(at, lambda _at: press(), None, release)

    def _palm(self, painter: Painter, box: QRectF, key: str, down: bool) -> None:
        look, u = self.look, self.look.u
        size = min(box.width(), box.height()) - 0.8 * u
        head = QRectF(box.center().x() - size / 2, box.center().y() - size / 2, size, size)
        ink = "frame" if self.barred else "run"
        painter.setPen(look.pen(ink, 0.3))
        painter.setBrush(look.colour("key"))
        painter.drawEllipse(head)
        inset = (1.7 if down else 0.9) * u
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("lit" if down else ink))
        painter.drawEllipse(head.adjusted(inset, inset, -inset, -inset))
        painter.write(head, key, 2.3, "on_lit" if down else "on_state", at=CENTRE)
