"""The jog pad: directions that move an axis while touched, with steps, speeds and homing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.jog.held_jog import CONTINUOUS, rapid_word, speed_words, step_words, turn_words
from app.jog.held_keys_view import JogCross, draw_middle
from app.jog.jog_homing import AxisState
from app.jog.jog_model import JogModel
from app.offsets.offset_values import Mode
from app.screen.look import CENTRE, Look, Painter
from app.screen.panel import Control, Shown, pressed
from app.screen.window_layout import FINGER
from core.executor.snapshot import Snapshot
from core.message import Message

# --- rows of tiles ------------------------------------------------------------------------------------


NAME = 8.4  # Units: width of the row name.
SHORT = 4  # Letters: a longer word gets a wider tile.


@dataclass(frozen=True, slots=True)
class Tiles:
    """A row of touch tiles.

    ``name`` is the row name with its key. ``warn`` colors the selected tile as a warning, and ``alarmed`` are
    tiles in the alarm color.
    """

    name: tuple[str, str]
    words: tuple[str, ...]
    presses: Sequence[Callable[[], None]]
    chosen: int = -1
    warn: bool = False
    alarmed: frozenset[int] = frozenset()


def draw_tiles(painter: Painter, row: QRectF, tiles: Tiles) -> list[tuple[QRectF, Callable[[], None]]]:
    """Draw a row of tiles, and return the rectangle and action of each tile."""
    u, left = painter.look.u, row.x()
    if tiles.name[0]:
        left += NAME * u
        _name(painter, QRectF(row.x(), row.y(), (NAME - 0.6) * u, row.height()), tiles.name)
    shares = [1.0 + 0.11 * max(0, len(word) - SHORT) for word in tiles.words]
    part = (row.right() - left + 0.6 * u) / sum(shares)
    boxes = []
    for number, (word, share) in enumerate(zip(tiles.words, shares, strict=True)):
        box = QRectF(left, row.y(), share * part - 0.6 * u, row.height())
        left += share * part
        _tile(painter, box, word, tiles, number)
        boxes.append(box)
    return list(zip(boxes, tiles.presses, strict=True))


def _name(painter: Painter, box: QRectF, name: tuple[str, str]) -> None:
    half = box.height() / 2
    painter.write(QRectF(box.x(), box.y(), box.width(), half), name[0], 1.5, "soft")
    painter.write(QRectF(box.x(), box.y() + half, box.width(), half), name[1], 1.6, "accent")


def _tile(painter: Painter, box: QRectF, word: str, tiles: Tiles, number: int) -> None:
    """Draw one tile, filled if it is selected, and in a warning color if necessary."""
    ink, ground, line = "text", "key", "frame"
    if number in tiles.alarmed:
        ink = line = "alarm"
    if number == tiles.chosen:
        ground = line = "pause" if tiles.warn else "lit"
        ink = "on_state" if tiles.warn else "on_lit"
    painter.box(box, line, 0.16, ground)
    painter.write(box, word, 2.1, ink, at=CENTRE, margin=0.8)


# --- the drawn handwheel ------------------------------------------------------------------------------


CLICK = 3.6  # Degrees per click: 100 clicks per revolution.
_NOTCH = 120  # One notch of the mouse wheel in Qt's unit.
_SPOKES = 24


class Dial:
    """The handwheel on the screen. ``turned`` gets the number of clicks, clockwise positive."""

    def __init__(self, turned: Callable[[int], None]) -> None:
        self._turned = turned
        self._angle = 0.0  # Drawn angle in degrees.
        self._at = 0.0  # Angle of the touch in degrees.
        self._rest = 0.0  # Remaining degrees of an incomplete click.

    def control(self, box: QRectF) -> Control:
        """Return the control that turns the handwheel by touch."""

        def bearing(at: QPointF) -> float:
            away = at - box.center()
            return math.degrees(math.atan2(away.y(), away.x()))

        def down(at: QPointF) -> None:
            self._at, self._rest = bearing(at), 0.0

        def along(at: QPointF) -> None:
            here = bearing(at)
            self._turn((here - self._at + 180.0) % 360.0 - 180.0)
            self._at = here

        return Control(box, down, along, name="HANDWHEEL", kind="slider")

    def notches(self, delta: int) -> None:
        """Turn the handwheel by the mouse wheel. ``delta`` is in Qt's unit; positive turns clockwise."""
        self._turn(CLICK * delta / _NOTCH)

    def draw(self, painter: Painter, box: QRectF, click: str) -> None:
        """Draw the handwheel at its present angle, with the distance per click."""
        size = 0.5 * min(box.width(), box.height()) - 0.4 * painter.look.u
        painter.setPen(painter.look.pen("accent", 0.24))
        painter.drawEllipse(box.center(), size, size)
        for spoke in range(_SPOKES):
            angle = math.radians(self._angle + 360.0 * spoke / _SPOKES)
            out = QPointF(math.cos(angle), math.sin(angle))
            inner = 0.72 if spoke == 0 else 0.88
            painter.drawLine(box.center() + out * (inner * size), box.center() + out * size)
        inside = QRectF(box.center().x() - 0.6 * size, box.y(), 1.2 * size, box.height())
        painter.write(inside, click, 2.4, "text", at=CENTRE)

    def _turn(self, degrees: float) -> None:
        self._rest += degrees
        clicks = int(self._rest / CLICK)  # Rounded toward 0.
        if clicks:
            self._rest -= clicks * CLICK
            self._angle += clicks * CLICK
            self._turned(clicks)


ROW, HELD = 5.0, 9.4  # Minimum height in units of a row of tiles and of a jog target.
CROSS = 3  # Rows of jog targets.
DrawRow = Callable[[Painter, QRectF], None]


class JogPad(JogCross):
    """The jog pad with all its targets, which are as large as the room allows."""

    _shown: Shown[object] = Shown(None)
    _known: Shown[Mapping[str, AxisState]] = Shown({})

    def __init__(self, look: Look, model: JogModel, parent: QWidget) -> None:
        super().__init__(look, model.hold, model.directions, model.finger, parent)
        self._model = model
        self._dial = Dial(model.turn_wheel)

    def show_jog(self, snapshot: Snapshot) -> None:
        """Show the selected step and speed, the active target and the homing states."""
        model = self._model
        self._known = model.home.known(snapshot)
        held = model.hold.held
        self._shown = (
            (model.speeds.step, model.speeds.speed, model.hold.rapid_armed, model.hold.mode),
            (held.axis, held.velocity) if held else None,
            (model.wheel.choice, model.home.asking, snapshot.state),
            (model.setter.armed, snapshot.touching, model.tilt.on),
        )
        self.mark = "'" if model.tilt.on else ""

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: Painter) -> None:
        self.controls.clear()
        self.frame(painter, tr("JOG  ·  HOLD TO MOVE"))
        u = self.look.u
        room = self.inside().adjusted(-0.4 * u, 0, 0.4 * u, 0.3 * u)
        rows = self._rows(room)
        high = self._tile_height(room, len(rows) + 1) + 0.6 * u
        row = QRectF(room.x(), room.y(), room.width(), high - 0.6 * u)
        for draw in rows:
            draw(painter, row)
            row = row.translated(0, high)
        foot = QRectF(room.x(), room.bottom() - high + 0.6 * u, room.width(), high - 0.6 * u)
        self._homing(painter, foot)
        middle = self.cross(painter, QRectF(room.x(), row.y(), room.width(), foot.y() - row.y() - 0.6 * u))
        self._middle(painter, middle)

    def _rows(self, room: QRectF) -> list[DrawRow]:
        """Return the rows above the cross. Steps and speeds share one row if there is little height."""
        wheel: list[DrawRow] = [self._wheel] if self._model.wheel.there else []
        both: list[DrawRow] = [self._steps, self._speeds]
        needed = self.look.keys_high(len(both) + len(wheel) + 1 + CROSS) + 0.6 * self.look.u
        return [*(both if room.height() >= needed else [self._steps_and_speeds]), *wheel]

    def _tile_height(self, room: QRectF, rows: int) -> float:
        """Return the height of a tile row: a fingertip, if this leaves enough height for the jog targets."""
        u = self.look.u
        finger = self.look.row(ROW, 9.0, touch=True)
        left = room.height() - CROSS * (HELD * u + 0.6 * u) - u
        return max(min(finger, float(FINGER)), ROW * u, min(finger, left / rows - 0.6 * u))

    def _steps_and_speeds(self, painter: Painter, row: QRectF) -> None:
        """Draw step and speed in one row, with the functions of F2 and F3, and RAPID."""
        model, mode = self._model, self._model.hold.mode
        step = model.speeds.step
        said = tr("CONT")
        if step != CONTINUOUS:
            turning = self._turning
            said = model.speeds.step_word(turning, mode, step) if turning else step_words(mode)[step]
        speeds = turn_words() if self._turning else speed_words(mode)
        words = (f"F2 {said}", f"F3 {speeds[model.speeds.speed]}", tr("RAPID"))
        chosen = 2 if model.hold.rapid_armed else -1
        tiles = Tiles(("", ""), words, [model.next_step, model.next_speed, model.arm], chosen, warn=True)
        self._tiles(painter, row, tiles)

    def _steps(self, painter: Painter, row: QRectF) -> None:
        model = self._model
        unit = tr("STEP MM") if model.hold.mode.metric else tr("STEP IN")
        words = (tr("CONT"), *step_words(model.hold.mode))
        if self._turning:
            unit = tr("STEP °")
            words = (
                tr("CONT"),
                *(model.speeds.step_word(self._turning, model.hold.mode, n) for n in range(len(words) - 1)),
            )
        chosen = model.speeds.step - CONTINUOUS
        presses = [partial(model.choose_step, step) for step in range(CONTINUOUS, len(words) - 1)]
        self._tiles(painter, row, Tiles((unit, "F2"), words, presses, chosen))

    def _speeds(self, painter: Painter, row: QRectF) -> None:
        model, mode = self._model, self._model.hold.mode
        unit = tr("MM/MIN") if mode.metric else tr("IN/MIN")
        rapid = f"{tr('RAPID')} {rapid_word(model.machine, mode)}"
        words = (*speed_words(mode), rapid)
        if self._turning:
            unit, rapid = tr("°/MIN"), f"{tr('RAPID')} {self._turning_rapid}"
            words = (*turn_words(), rapid)
        chosen = len(words) - 1 if model.hold.rapid_armed else model.speeds.speed
        presses: list[Callable[[], None]] = [
            *(partial(model.choose_speed, speed) for speed in range(len(words) - 1)),
            model.arm,
        ]
        self._tiles(painter, row, Tiles((unit, "F3"), words, presses, chosen, warn=model.hold.rapid_armed))

    @property
    def _turning(self) -> str:
        """The rotary axis that is jogged or that the handwheel moves, else empty. It has its own units."""
        held, wheel = self._model.hold.held, self._model.wheel.choice
        axis = held.axis if held else wheel[0] if wheel else ""
        return axis if axis and self._model.machine.axis(axis).rotary else ""

    @property
    def _turning_rapid(self) -> str:
        model = self._model
        return f"{60 * model.speeds.velocity(self._turning, model.hold.mode, rapid=True):.0f}"

    def _wheel(self, painter: Painter, row: QRectF) -> None:
        """Draw the row that selects the handwheel axis."""
        wheel = self._model.wheel
        axis = wheel.choice[0] if wheel.choice else ""
        presses = [partial(wheel.choose, name) for name in ("", *wheel.names)]
        chosen = ("", *wheel.names).index(axis)
        words = (tr("OFF"), *wheel.names)
        self._tiles(painter, row, Tiles((tr("HANDWHEEL"), "V"), words, presses, chosen, warn=bool(axis)))

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Turn the handwheel on the screen by the mouse wheel."""
        if self._model.wheel_drawn:
            self._dial.notches(event.angleDelta().y())
            self.update()
        event.accept()

    def _homing(self, painter: Painter, row: QRectF) -> None:
        model = self._model
        words = [tr("HOME")]
        presses: list[Callable[[], None]] = [model.home_key]
        for axis in model.home.axes:
            name = model.machine.shown(axis.name)
            words.append(f"{name} {self._known[axis.name].words}" if self._known else name)
            presses.append(partial(model.home_one, axis.name))
        lost = frozenset(
            i
            for i, known in enumerate(self._known.values(), 1)
            if known in {AxisState.LOST, AxisState.LOOKING}
        )
        chosen = 0 if model.home.asking else -1
        armed = model.setter.armed
        if model.setter.model is not None:
            words.append(tr("SETTER (P)"))
            presses.append(model.touch_at_setter)
            chosen = len(words) - 1 if armed else chosen
        self._tiles(painter, row, Tiles(("", ""), tuple(words), presses, chosen, armed, lost))

    def _tiles(self, painter: Painter, row: QRectF, tiles: Tiles) -> None:
        for box, press in draw_tiles(painter, row, tiles):
            self.controls.append(pressed(box, press))

    def _middle(self, painter: Painter, box: QRectF) -> None:
        """Draw the present jog mode with its values in the middle of the cross."""
        model = self._model
        mode: Mode = model.hold.mode
        step = model.speeds.step
        words = (
            (tr("STEP"), step_words(mode)[step])
            if step != CONTINUOUS
            else (tr("CONTINUOUS"), self._speed(mode))
        )
        if model.wheel.choice is not None:
            axis, step = model.wheel.choice
            words = (tr(Message("HANDWHEEL {axis}", axis=axis)), model.speeds.step_word(axis, mode, step))
        if model.wheel_drawn:
            self._dial.draw(painter, box, words[1])
            self.controls.append(self._dial.control(box))
            return
        if model.setter.armed:
            draw_middle(painter, box, (tr("TOUCH OFF"), f"T{model.tool.number}", tr("at the tool setter")))
            return
        unit = tr("mm") if mode.metric else tr("in")
        if self._turning:
            unit = "°"
            if step != CONTINUOUS:
                words = (tr("STEP"), model.speeds.step_word(self._turning, mode, step))
        draw_middle(painter, box, (*words, unit if step != CONTINUOUS else f"{unit}/min"))

    def _speed(self, mode: Mode) -> str:
        model = self._model
        held = model.hold.held
        rapid = held.rapid if held else model.hold.rapid_armed
        if self._turning:
            return self._turning_rapid if rapid else turn_words()[model.speeds.speed]
        return rapid_word(model.machine, mode) if rapid else speed_words(mode)[model.speeds.speed]
