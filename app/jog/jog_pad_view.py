"""Jog pad with arrow keys that move an axis while touched, and with steps, speeds and homing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.jog.held_jog import (
    CONTINUOUS_STEP_INDEX,
    format_rapid_speed,
    make_rotary_speed_labels,
    make_speed_labels,
    make_step_labels,
)
from app.jog.held_keys_view import JogCross, draw_jog_mode
from app.jog.jog_homing import HomingState
from app.jog.jog_model import JogModel
from app.offsets.offset_values import UnitMode
from app.screen.panel import RedrawingAttribute, TouchControl, make_press_control
from app.screen.screen_theme import ALIGN_CENTER, ScreenTheme, ThemedPainter, measure_text
from app.screen.text_sizes import MIN_STRETCH, TextRole
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import Snapshot
from core.message import Message

# --- rows of tiles ------------------------------------------------------------------------------------


NAME_WIDTH = 8.4  # Units: width of the row name.
SHORT_LABEL_LENGTH = 4  # Letters: a longer word gets a wider tile.


@dataclass(frozen=True, slots=True)
class TileRow:
    """Row of touch keys (tiles).

    - ``name_and_key`` contains the name of the row and its key.
    - ``is_warning`` means that the selected tile has the warning color.
    - ``alarmed_indices`` are the indices of the tiles with the alarm color.
    """

    name_and_key: tuple[str, str]
    tile_labels: tuple[str, ...]
    tile_actions: Sequence[Callable[[], None]]
    selected_index: int = -1
    is_warning: bool = False
    alarmed_indices: frozenset[int] = frozenset()


def draw_tiles(
    painter: ThemedPainter, row: QRectF, tiles: TileRow
) -> list[tuple[QRectF, Callable[[], None]]]:
    """Draw a row of tiles and return the rectangle and the action of each tile."""
    u, left = painter.theme.unit_px, row.x()
    if tiles.name_and_key[0]:
        wide = _find_name_width(painter, row, tiles.name_and_key[0])
        left += wide
        _name(painter, QRectF(row.x(), row.y(), wide - 0.6 * u, row.height()), tiles.name_and_key)
    shares = [1.0 + 0.11 * max(0, len(word) - SHORT_LABEL_LENGTH) for word in tiles.tile_labels]
    part = (row.right() - left + 0.6 * u) / sum(shares)
    boxes = []
    for number, (word, share) in enumerate(zip(tiles.tile_labels, shares, strict=True)):
        box = QRectF(left, row.y(), share * part - 0.6 * u, row.height())
        left += share * part
        _draw_tile(painter, box, word, tiles, number)
        boxes.append(box)
    return list(zip(boxes, tiles.tile_actions, strict=True))


def _find_name_width(painter: ThemedPainter, row: QRectF, name: str) -> float:
    """Return the width for the name of a row, so that a long name is neither cut off nor too small."""
    look = painter.theme
    size = look.find_em_height(1.5, TextRole.TABLE, row.height() / 2)
    needed = measure_text(name, look.make_font(size, is_bold=True)) * MIN_STRETCH / 100 + look.unit_px
    return min(0.3 * row.width(), max(NAME_WIDTH * look.unit_px, needed))


def _name(painter: ThemedPainter, box: QRectF, name: tuple[str, str]) -> None:
    half = box.height() / 2
    painter.draw_text_line(QRectF(box.x(), box.y(), box.width(), half), name[0], 1.5, "soft")
    painter.draw_text_line(QRectF(box.x(), box.y() + half, box.width(), half), name[1], 1.6, "accent")


def _draw_tile(painter: ThemedPainter, box: QRectF, word: str, tiles: TileRow, number: int) -> None:
    """Draw one tile. A selected tile is filled, and a tile can have the warning or alarm color."""
    ink, ground, line = "text", "key", "frame"
    if number in tiles.alarmed_indices:
        ink = line = "alarm"
    if number == tiles.selected_index:
        ground = line = "pause" if tiles.is_warning else "lit"
        ink = "on_state" if tiles.is_warning else "on_lit"
    painter.draw_box(box, line, 0.16, ground)
    painter.draw_text_line(box, word, 2.1, ink, at=ALIGN_CENTER, margin=0.8)


# --- the drawn handwheel ------------------------------------------------------------------------------


DEGREES_PER_CLICK = 3.6  # Degrees per click: 100 clicks per revolution.
_WHEEL_NOTCH = 120  # One notch of the mouse wheel in Qt's unit.
_SPOKE_COUNT = 24


class HandwheelDial:
    """Handwheel on the screen.

    ``turn_handwheel`` is called with the number of clicks. Clockwise rotation is positive.
    """

    def __init__(self, turn_handwheel: Callable[[int], None]) -> None:
        self._turned = turn_handwheel
        self._angle = 0.0  # Drawn angle in degrees.
        self._at = 0.0  # Angle of the touch in degrees.
        self._rest = 0.0  # Remaining degrees of an incomplete click.

    def make_touch_control(self, box: QRectF) -> TouchControl:
        """Return the touch control that turns the handwheel."""

        def calculate_touch_angle(at: QPointF) -> float:
            away = at - box.center()
            return math.degrees(math.atan2(away.y(), away.x()))

        def start_touch(at: QPointF) -> None:
            self._at, self._rest = calculate_touch_angle(at), 0.0

        def follow_touch(at: QPointF) -> None:
            here = calculate_touch_angle(at)
            self._turn((here - self._at + 180.0) % 360.0 - 180.0)
            self._at = here

        return TouchControl(box, start_touch, follow_touch, name="HANDWHEEL", kind="slider")

    def turn_by_mouse_wheel(self, delta: int) -> None:
        """Turn the handwheel with the mouse wheel.

        ``delta`` is in the unit of Qt, 120 per notch. A positive value turns the handwheel clockwise.
        """
        self._turn(DEGREES_PER_CLICK * delta / _WHEEL_NOTCH)

    def draw(self, painter: ThemedPainter, box: QRectF, click_text: str) -> None:
        """Draw the handwheel at its current angle, with ``click_text`` as the distance per click."""
        size = 0.5 * min(box.width(), box.height()) - 0.4 * painter.theme.unit_px
        painter.setPen(painter.theme.make_pen("accent", 0.24))
        painter.drawEllipse(box.center(), size, size)
        for spoke in range(_SPOKE_COUNT):
            angle = math.radians(self._angle + 360.0 * spoke / _SPOKE_COUNT)
            out = QPointF(math.cos(angle), math.sin(angle))
            inner = 0.72 if spoke == 0 else 0.88
            painter.drawLine(box.center() + out * (inner * size), box.center() + out * size)
        inside = QRectF(box.center().x() - 0.6 * size, box.y(), 1.2 * size, box.height())
        painter.draw_text_line(inside, click_text, 2.4, "text", at=ALIGN_CENTER)

    def _turn(self, degrees: float) -> None:
        self._rest += degrees
        clicks = int(self._rest / DEGREES_PER_CLICK)  # Rounded toward 0.
        if clicks:
            self._rest -= clicks * DEGREES_PER_CLICK
            self._angle += clicks * DEGREES_PER_CLICK
            self._turned(clicks)


ROW, HELD = 5.0, 9.4  # Minimum height in units of a row of tiles and of a jog target.
CROSS_ROW_COUNT = 3  # Rows of jog targets.
DrawTileRow = Callable[[ThemedPainter, QRectF], None]


class JogPad(JogCross):
    """Pad of touch targets for jogging, which are as large as the available area permits."""

    _shown: RedrawingAttribute[object] = RedrawingAttribute(None)
    _known: RedrawingAttribute[Mapping[str, HomingState]] = RedrawingAttribute({})

    def __init__(self, theme: ScreenTheme, model: JogModel, parent: QWidget) -> None:
        super().__init__(theme, model.held_jog, model.directions, model.handle_direction_press, parent)
        self._model = model
        self._dial = HandwheelDial(model.turn_handwheel)

    def show_state(self, snapshot: Snapshot) -> None:
        """Show the selected step and speed, the active target and the homing states."""
        model = self._model
        self._known = model.homing_question.find_homing_states(snapshot)
        held = model.held_jog.active_jog
        self._shown = (
            (
                model.jog_speeds.step_index,
                model.jog_speeds.speed_index,
                model.held_jog.is_rapid_armed,
                model.held_jog.value_mode,
            ),
            (held.axis_name, held.velocity) if held else None,
            (model.handwheel.wheel_choice, model.homing_question.is_open, snapshot.state),
            (model.tool_setter_touch_off.is_armed, snapshot.touch_phase, model.tilted_jog.is_on),
        )
        self.axis_suffix = "'" if model.tilted_jog.is_on else ""

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the rows of touch keys, the arrow keys and the homing keys, and set their touch targets."""
        self.controls.clear()
        self.frame(painter, tr("JOG  ·  HOLD TO MOVE"))
        u = self.theme.unit_px
        room = self.inside().adjusted(-0.4 * u, 0, 0.4 * u, 0.3 * u)
        rows = self._make_row_drawers(room)
        high = self._tile_height(room, len(rows) + 1) + 0.6 * u
        row = QRectF(room.x(), room.y(), room.width(), high - 0.6 * u)
        foot = QRectF(room.x(), room.bottom() - high + 0.6 * u, room.width(), high - 0.6 * u)
        top = room.y() + len(rows) * high
        cross = QRectF(room.x(), top, room.width(), foot.y() - top - 0.6 * u)
        if not self._has_step_rows(room) and self.has_free_top_corners:
            self._draw_corner_keys(painter, cross)
        for draw in rows:
            draw(painter, row)
            row = row.translated(0, high)
        self._homing(painter, foot)
        self._draw_middle(painter, self.draw_cross(painter, cross))

    def _make_row_drawers(self, area: QRectF) -> list[DrawTileRow]:
        """Return the functions that draw the rows above the cross of arrow keys.

        If the height is small, steps and speeds share one row, or are in the free corners of the cross.
        """
        wheel: list[DrawTileRow] = [self._draw_wheel] if self._model.handwheel.is_available else []
        if self._has_step_rows(area):
            return [self._steps, self._speeds, *wheel]
        return [*([] if self.has_free_top_corners else [self._draw_steps_and_speeds]), *wheel]

    def _has_step_rows(self, area: QRectF) -> bool:
        """Return whether steps and speeds have their own rows, each as high as a fingertip."""
        rows = 2 + self._model.handwheel.is_available + 1 + CROSS_ROW_COUNT
        return area.height() >= self.theme.find_key_rows_height(rows) + 0.6 * self.theme.unit_px

    def _draw_corner_keys(self, painter: ThemedPainter, cross: QRectF) -> None:
        """Draw the jog step, the jog speed and RAPID in the free upper corners of the cross."""
        step, speed, rapid = self._list_step_and_speed_tiles()
        self._tiles(painter, self.find_cell(cross, 0, 0), step)
        right = self.find_cell(cross, self.column_count - 1, 0)
        half = 0.5 * right.width()
        self._tiles(painter, right.adjusted(0, 0, -half - 0.2 * self.theme.unit_px, 0), speed)
        self._tiles(painter, right.adjusted(half, 0, 0, 0), rapid)

    def _tile_height(self, area: QRectF, rows: int) -> float:
        """Return the height of a tile row in pixels.

        A row is at least as high as a fingertip if enough height remains for the jog targets.
        """
        u = self.theme.unit_px
        finger = self.theme.find_row_height(ROW, 9.0, is_touchable=True)
        left = area.height() - CROSS_ROW_COUNT * (HELD * u + 0.6 * u) - u
        return max(min(finger, float(FINGERTIP_PX)), ROW * u, min(finger, left / rows - 0.6 * u))

    def _draw_steps_and_speeds(self, painter: ThemedPainter, row: QRectF) -> None:
        """Draw the jog step, the jog speed and RAPID in one row."""
        step, speed, rapid = self._list_step_and_speed_tiles()
        labels = (*step.tile_labels, *speed.tile_labels, *rapid.tile_labels)
        actions = (*step.tile_actions, *speed.tile_actions, *rapid.tile_actions)
        chosen = 2 if rapid.selected_index == 0 else -1
        self._tiles(painter, row, TileRow(("", ""), labels, actions, chosen, is_warning=True))

    def _list_step_and_speed_tiles(self) -> tuple[TileRow, TileRow, TileRow]:
        """Return the tiles for the jog step, the jog speed and RAPID.

        The step and speed tiles have the functions of F2 and F3.
        """
        model, mode = self._model, self._model.held_jog.value_mode
        step = model.jog_speeds.step_index
        said = tr("CONT")
        if step != CONTINUOUS_STEP_INDEX:
            turning = self._active_rotary_axis
            said = (
                model.jog_speeds.format_step(turning, mode, step) if turning else make_step_labels(mode)[step]
            )
        speeds = make_rotary_speed_labels() if self._active_rotary_axis else make_speed_labels(mode)
        speed = f"F3 {speeds[model.jog_speeds.speed_index]}"
        chosen = 0 if model.held_jog.is_rapid_armed else -1
        return (
            TileRow(("", ""), (f"F2 {said}",), [model.select_next_step]),
            TileRow(("", ""), (speed,), [model.select_next_speed]),
            TileRow(("", ""), (tr("RAPID"),), [model.toggle_rapid], chosen, is_warning=True),
        )

    def _steps(self, painter: ThemedPainter, row: QRectF) -> None:
        model = self._model
        unit = tr("STEP MM") if model.held_jog.value_mode.is_metric else tr("STEP IN")
        words = (tr("CONT"), *make_step_labels(model.held_jog.value_mode))
        if self._active_rotary_axis:
            unit = tr("STEP °")
            words = (
                tr("CONT"),
                *(
                    model.jog_speeds.format_step(self._active_rotary_axis, model.held_jog.value_mode, n)
                    for n in range(len(words) - 1)
                ),
            )
        chosen = model.jog_speeds.step_index - CONTINUOUS_STEP_INDEX
        presses = [partial(model.select_step, step) for step in range(CONTINUOUS_STEP_INDEX, len(words) - 1)]
        self._tiles(painter, row, TileRow((unit, "F2"), words, presses, chosen))

    def _speeds(self, painter: ThemedPainter, row: QRectF) -> None:
        model, mode = self._model, self._model.held_jog.value_mode
        unit = tr("MM/MIN") if mode.is_metric else tr("IN/MIN")
        rapid = f"{tr('RAPID')} {format_rapid_speed(model.machine, mode)}"
        words = (*make_speed_labels(mode), rapid)
        if self._active_rotary_axis:
            unit, rapid = tr("°/MIN"), f"{tr('RAPID')} {self._turning_rapid}"
            words = (*make_rotary_speed_labels(), rapid)
        chosen = len(words) - 1 if model.held_jog.is_rapid_armed else model.jog_speeds.speed_index
        presses: list[Callable[[], None]] = [
            *(partial(model.select_speed, speed) for speed in range(len(words) - 1)),
            model.toggle_rapid,
        ]
        self._tiles(
            painter,
            row,
            TileRow((unit, "F3"), words, presses, chosen, is_warning=model.held_jog.is_rapid_armed),
        )

    @property
    def _active_rotary_axis(self) -> str:
        """Return the rotary axis that is jogged or selected for the handwheel, or else an empty string.

        The steps and speeds of a rotary axis are in degrees.
        """
        held, wheel = self._model.held_jog.active_jog, self._model.handwheel.wheel_choice
        axis = held.axis_name if held else wheel[0] if wheel else ""
        return axis if axis and self._model.machine.find_axis(axis).is_rotary else ""

    @property
    def _turning_rapid(self) -> str:
        model = self._model
        mode = model.held_jog.value_mode
        velocity = model.jog_speeds.find_continuous_speed(self._active_rotary_axis, mode, is_rapid=True)
        return f"{60 * velocity:.0f}"

    def _draw_wheel(self, painter: ThemedPainter, row: QRectF) -> None:
        """Draw the row of keys that select the axis of the handwheel."""
        wheel = self._model.handwheel
        axis = wheel.wheel_choice[0] if wheel.wheel_choice else ""
        presses = [partial(wheel.select_axis, name) for name in ("", *wheel.axis_names)]
        chosen = ("", *wheel.axis_names).index(axis)
        words = (tr("OFF"), *wheel.axis_names)
        self._tiles(
            painter, row, TileRow((tr("HANDWHEEL"), "V"), words, presses, chosen, is_warning=bool(axis))
        )

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Turn the handwheel on the screen with the mouse wheel."""
        if self._model.is_handwheel_shown:
            self._dial.turn_by_mouse_wheel(event.angleDelta().y())
            self.update()
        event.accept()

    def _homing(self, painter: ThemedPainter, row: QRectF) -> None:
        model = self._model
        words = [tr("HOME")]
        presses: list[Callable[[], None]] = [model.handle_home_key]
        for axis in model.homing_question.homing_axes:
            name = model.machine.get_displayed_axis_name(axis.name)
            words.append(f"{name} {self._known[axis.name].state_name}" if self._known else name)
            presses.append(partial(model.handle_home_touch, axis.name))
        lost = frozenset(
            i
            for i, known in enumerate(self._known.values(), 1)
            if known in {HomingState.NOT_HOMED, HomingState.HOMING}
        )
        chosen = 0 if model.homing_question.is_open else -1
        armed = model.tool_setter_touch_off.is_armed
        if model.tool_setter_touch_off.tool_setter is not None:
            words.append(tr("SETTER (P)"))
            presses.append(model.toggle_setter_touch_off)
            chosen = len(words) - 1 if armed else chosen
        self._tiles(painter, row, TileRow(("", ""), tuple(words), presses, chosen, armed, lost))

    def _tiles(self, painter: ThemedPainter, row: QRectF, tiles: TileRow) -> None:
        for box, press in draw_tiles(painter, row, tiles):
            self.controls.append(make_press_control(box, press))

    def _draw_middle(self, painter: ThemedPainter, box: QRectF) -> None:
        """Draw the current jog mode with its values in the middle of the cross."""
        model = self._model
        mode: UnitMode = model.held_jog.value_mode
        step = model.jog_speeds.step_index
        words = (
            (tr("STEP"), make_step_labels(mode)[step])
            if step != CONTINUOUS_STEP_INDEX
            else (tr("CONTINUOUS"), self._speed(mode))
        )
        if model.handwheel.wheel_choice is not None:
            axis, step = model.handwheel.wheel_choice
            words = (
                tr(Message("HANDWHEEL {axis}", axis=axis)),
                model.jog_speeds.format_step(axis, mode, step),
            )
        if model.is_handwheel_shown:
            self._dial.draw(painter, box, words[1])
            self.controls.append(self._dial.make_touch_control(box))
            return
        if model.tool_setter_touch_off.is_armed:
            draw_jog_mode(
                painter,
                box,
                (tr("TOUCH OFF"), f"T{model.tool_setting.tool_number}", tr("at the tool setter")),
            )
            return
        unit = tr("mm") if mode.is_metric else tr("in")
        if self._active_rotary_axis:
            unit = "°"
            if step != CONTINUOUS_STEP_INDEX:
                words = (tr("STEP"), model.jog_speeds.format_step(self._active_rotary_axis, mode, step))
        draw_jog_mode(painter, box, (*words, unit if step != CONTINUOUS_STEP_INDEX else f"{unit}/min"))

    def _speed(self, mode: UnitMode) -> str:
        model = self._model
        held = model.held_jog.active_jog
        rapid = held.is_rapid if held else model.held_jog.is_rapid_armed
        if self._active_rotary_axis:
            return self._turning_rapid if rapid else make_rotary_speed_labels()[model.jog_speeds.speed_index]
        return (
            format_rapid_speed(model.machine, mode)
            if rapid
            else make_speed_labels(mode)[model.jog_speeds.speed_index]
        )
