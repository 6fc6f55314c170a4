"""What is switched by hand on the Jog page, drawn: spindle, coolant, collet; and the steps of a skim cut."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.jog.hand_functions import (
    CLOSE,
    COOLANT_OFF,
    COOLANT_ON,
    FORWARD,
    OPEN,
    REVERSE,
    SPEED,
    STOP,
)
from app.jog.jog_model import JogModel
from app.jog.skim_and_setter import CutStep
from app.jog.tool_setting import TOUCH_X, TOUCH_Z
from app.screen.look import CENTRE, LEFT, Look, Painter
from app.screen.panel import FingerPanel, Shown, pressed
from app.screen.window_layout import FINGER
from core.executor.snapshot import Snapshot
from core.message import Message

KEY = 4.5  # units: height of a key of the strip
Key = tuple[str, str, Callable[[], object]]  # letter, words, what it does


def draw_key(painter: Painter, box: QRectF, letter: str, words: str, *, chosen: bool, on: bool) -> None:
    """A key with its letter: filled when what it switches is on, framed when it is chosen."""
    u = painter.look.u
    ground, ink = ("run", "on_state") if on else ("here" if chosen else "key", "text")
    painter.box(box, "lit" if chosen else "frame", 0.3 if chosen else 0.16, ground)
    painter.write(
        QRectF(box.x() + 0.8 * u, box.y(), 2.6 * u, box.height()), letter, 1.9, ink if on else "accent"
    )
    painter.write(box.adjusted(3.2 * u, 0, -0.6 * u, 0), words, 2.1, ink, at=CENTRE)


class HandPanel(FingerPanel):
    """Each target chooses; both palms switch on. STOP acts at once, however late the finger is seen."""

    _shown: Shown[object] = Shown(None)

    def __init__(self, look: Look, model: JogModel, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model

    def show_hand(self, snapshot: Snapshot) -> None:
        """What is chosen, ready and on."""
        hand = self._model.hand
        self._shown = (
            hand.chosen,
            hand.line.ready is not None,
            hand.speed,
            (round(snapshot.rpm_actual), snapshot.rpm_command, snapshot.outputs),
            snapshot.state,
        )

    def draw(self, painter: Painter) -> None:
        self.controls.clear()
        self.frame(painter, tr("MANUAL FUNCTIONS  ·  PICK, THEN CYCLE START"))
        u, room, hand = self.look.u, self.inside(), self._model.hand
        rows = 4 if CLOSE in hand.there else 3
        high = (room.height() + 0.6 * u) / rows
        row = QRectF(room.x(), room.y(), room.width(), high - 0.6 * u)
        self._spindle(painter, row)
        on = hand.desk.snapshot()
        turns = on.rpm_command
        row.translate(0, high)
        speed = f"S {hand.speed:g} {tr('RPM')}" if hand.speed else tr("SPEED …")
        self._keys(
            painter,
            row,
            (SPEED, speed, "", False),
            ("1", tr("FORWARD"), FORWARD, turns > 0),
            ("2", tr("REVERSE"), REVERSE, turns < 0),
        )
        row.translate(0, high)
        if COOLANT_ON in hand.there:
            wet = "coolant" in on.outputs
            self._keys(
                painter,
                row,
                ("3", tr("COOLANT ON"), COOLANT_ON, wet),
                ("4", tr("COOLANT OFF"), COOLANT_OFF, False),
            )
        if CLOSE in hand.there:
            row.translate(0, high)
            closed = "collet" in on.outputs
            self._keys(
                painter,
                row,
                ("5", tr("CLOSE COLLET"), CLOSE, closed),
                ("6", tr("OPEN COLLET"), OPEN, not closed),
            )

    def _spindle(self, painter: Painter, row: QRectF) -> None:
        """What the spindle does now, and the key that stops it."""
        u, hand, snapshot = self.look.u, self._model.hand, self._model.desk.snapshot()
        words = tr("SPINDLE STOPPED")
        if hand.turns(snapshot):
            words = tr(Message("SPINDLE TURNING AT {rpm:.0f} RPM", rpm=abs(snapshot.rpm_actual)))
        left = QRectF(row.x(), row.y(), 0.56 * row.width(), row.height())
        painter.write(left, words, 2.4, "pause" if hand.turns(snapshot) else "text", at=LEFT)
        box = QRectF(left.right() + 0.6 * u, row.y(), row.right() - left.right() - 0.6 * u, row.height())
        painter.box(box, "alarm", 0.3, "key")
        painter.write(QRectF(box.x() + 0.8 * u, box.y(), 2.6 * u, box.height()), "0", 1.9, "accent")
        painter.write(box.adjusted(3.2 * u, 0, -0.6 * u, 0), tr("SPINDLE STOP"), 2.4, "alarm", at=CENTRE)
        stop = pressed(box, partial(self._model.press_hand, STOP))
        self.controls.append(stop.stopping())

    def _keys(self, painter: Painter, row: QRectF, *keys: tuple[str, str, str, bool]) -> None:
        u, hand = self.look.u, self._model.hand
        wide = (row.width() + 0.6 * u) / len(keys)
        for number, (letter, words, name, on) in enumerate(keys):
            box = QRectF(row.x() + number * wide, row.y(), wide - 0.6 * u, row.height())
            chosen = hand.chosen == (name or SPEED)
            draw_key(painter, box, letter, words, chosen=chosen, on=on)
            press = partial(self._model.press_hand, name) if name else self._model.ask_speed
            self.controls.append(pressed(box, press))


def strip_keys(look: Look) -> float:
    """Height of the keys of the strip, pixels: a fingertip, and room for their words on a large glass."""
    return max(float(FINGER), KEY * look.u)


class HandStrip(FingerPanel):
    """Under tool setting while nothing is asked: what leads to functions by hand and to the skim cut."""

    _shown: Shown[object] = Shown(None)
    change, foot = Shown(""), Shown("")

    def __init__(self, look: Look, model: JogModel, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._model = model

    def show_strip(self, snapshot: Snapshot, change: str, foot: str) -> None:
        """What can be pressed now, the last change, and what other keys do."""
        skim, hand = self._model.skim, self._model.hand
        self.change, self.foot = change, foot
        self._shown = (skim.step, skim.axis, hand.shown, hand.turns(snapshot))

    def draw(self, painter: Painter) -> None:
        self.controls.clear()
        u = self.look.u
        painter.fill(self.area(), "ground")
        keys = self._keys()
        room = self.area()
        low = self.height() - strip_keys(self.look)
        wide = (room.width() + 0.6 * u) / len(keys)
        for number, (letter, words, press) in enumerate(keys):
            box = QRectF(room.x() + number * wide, low, wide - 0.6 * u, room.bottom() - low)
            draw_key(painter, box, letter, words, chosen=False, on=False)
            self.controls.append(pressed(box, partial(self._press, press)))
        text = QRectF(room.x() + u, room.y(), room.width() - 2 * u, low - 0.3 * u)
        if self._model.skim.open or not self.change:
            painter.write(text, self.foot, 1.8, "soft", bold=False)
        else:
            painter.write(text, self.change, 1.8, "accent")

    def _press(self, press: Callable[[], object]) -> None:
        self._model.hold.other_key()
        press()

    def _keys(self) -> tuple[Key, ...]:
        model, skim = self._model, self._model.skim
        leave: Key = ("Esc", tr("CANCEL"), skim.escape)
        hand: Key = ("B", tr("TOOL SETTING") if model.hand.shown else tr("MANUAL FUNCTIONS"), model.show_hand)
        if skim.step is CutStep.AXIS:
            return (
                ("X", tr("DIAMETER"), partial(skim.choose, TOUCH_X)),
                ("Z", tr("FACE"), partial(skim.choose, TOUCH_Z)),
                leave,
            )
        if skim.step is CutStep.CUT:
            return (hand, ("↵", tr("CUT DONE"), skim.made), leave)
        if skim.step is CutStep.AWAY:
            return (hand, ("0", tr("SPINDLE STOP"), partial(model.press_hand, STOP)), leave)
        return (hand,) if model.on_mill else (hand, ("C", tr("SKIM CUT"), skim.begin))
