"""Right side of the Jog page: tool setting on a lathe; tool, preset and 3D-ROT on a mill."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.status.formats import format_length
from app.desk.translation import tr
from app.jog.jog_model import JogModel
from app.jog.tilted_jog import LINEAR_AXES
from app.jog.tool_setting import TOOL_QUESTION
from app.jog.tool_touch_off import TOUCH_X, TOUCH_Z
from app.jog.touch_off_picture import TouchOffPicture
from app.jog.touch_off_scene_view import draw_touch_off_picture
from app.offsets.offset_values import (
    UnitMode,
    describe_missing_offset,
    find_x_symbol,
    format_signed_length,
    format_value,
    translate_field_name,
)
from app.screen.drawings import draw_tool_tip
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_LEFT, ALIGN_RIGHT, ScreenTheme, ThemedPainter
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.tool_edges import format_edge_name

# Field, and the key that asks for its value.
DISPLAYED_TOOL_FIELDS = (
    ("x", "X"),
    ("z", "Z"),
    ("wear_x", "W"),
    ("wear_z", "W"),
    ("nose_radius", "N"),
    ("quadrant", "Q"),
    ("remark", "K"),
    ("master", "M"),
)
COLUMN_COUNT, LOW_COLUMN_COUNT = 2, 4  # Columns of the fields, and those of a low panel.
_FIELD_QUESTIONS = {"x": TOUCH_X, "z": TOUCH_Z}


class ToolSettingPanel(Panel):
    """Panel of tool setting, in which every field is a touch target."""

    _shown: RedrawingAttribute[object] = RedrawingAttribute(None)
    _tip: RedrawingAttribute[tuple[float, float] | None] = RedrawingAttribute(None)
    _mode = RedrawingAttribute(UnitMode())
    _picture: RedrawingAttribute[TouchOffPicture | None] = RedrawingAttribute(None)

    def __init__(self, theme: ScreenTheme, model: JogModel, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._model = model

    def show_tool(self, snapshot: Snapshot) -> None:
        """Show the selected tool and the position of its tip."""
        tool = self._model.tool_setting
        self._mode = tool.offset_history.unit_mode
        self._tip = tool.find_tip_position(snapshot)
        self._picture = self._model.touch_off_pictures.picture
        self._shown = (
            tool.tool_number,
            tool.tool_row,
            tool.question_name,
            tool.find_master_difference(),
            tool.offset_book.master_tool_number,
        )

    @property
    def displayed_unit_mode(self) -> UnitMode:
        """Return the unit of length of the position display, and whether X is a diameter.

        The panel uses this unit, so the page never shows positions in two units.
        """
        return UnitMode(
            self._model.desk.settings_store.display_units.metric(self._mode.is_metric), self._mode.is_diameter
        )

    @property
    def tip_position_heading(self) -> str:
        """Return the heading of the tip position.

        The heading contains the unit if it differs from the unit of the control.
        """
        if self.displayed_unit_mode.is_metric == self._mode.is_metric:
            return tr("TIP POSITION FROM PART ZERO")
        return (
            tr("TIP POSITION FROM PART ZERO, MM")
            if self.displayed_unit_mode.is_metric
            else tr("TIP POSITION FROM PART ZERO, INCH")
        )

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the tool setting panel in mm or inches, and make each field a touch target."""
        unit = tr("MM") if self._mode.is_metric else tr("INCH")
        self.frame(painter, join_messages("  ·  ", (tr("TOOL SETTING"), unit)))
        u = self.theme.unit_px
        room = self.inside().adjusted(-0.3 * u, 0, 0.3 * u, 0.3 * u)
        cells = self._find_row_count(room) * (FINGERTIP_PX + 0.5 * u)  # Each cell is a touch target.
        lines = 2 * self.theme.find_line_height(2.0)
        high = min(max(10.5 * u, lines), 0.36 * room.height(), max(room.height() - cells, lines))
        if self._picture is not None:
            high = max(lines, float(FINGERTIP_PX), 6.0 * u)
        head = QRectF(room.x(), room.y(), room.width(), high)
        self._draw_head(painter, head)
        rest = QRectF(
            room.x(), head.bottom() + 0.5 * u, room.width(), room.bottom() - head.bottom() - 0.5 * u
        )
        if self._picture is None:
            self._cells(painter, rest)
        else:
            draw_touch_off_picture(painter, rest, self._picture)

    def _find_row_count(self, room: QRectF) -> int:
        """Return the number of rows of fields, which is smaller in a low panel."""
        rows = len(DISPLAYED_TOOL_FIELDS) // COLUMN_COUNT
        low = room.height() < rows * FINGERTIP_PX + self.theme.find_line_height(7.0)
        return len(DISPLAYED_TOOL_FIELDS) // LOW_COLUMN_COUNT if low else rows

    def _draw_head(self, painter: ThemedPainter, area: QRectF) -> None:
        """Draw the tool number, the tip quadrant and the tip position."""
        u, tool = self.theme.unit_px, self._model.tool_setting
        box = QRectF(area.x(), area.y(), 13 * u, area.height())
        self._target(
            painter,
            box,
            partial(self._model.ask_tool_value, TOOL_QUESTION),
            lit=tool.question_name == TOOL_QUESTION,
        )
        name = format_edge_name(tool.tool_number) if tool.tool_number else "T–"
        painter.draw_text_line(box.adjusted(0, 0.6 * u, 0, 0), name, 5.0, "text", at=ALIGN_CENTER)
        self._key(painter, box, "T")
        side = area.height()
        tip = QRectF(box.right() + 0.8 * u, area.y(), side, side)
        quadrant = tool.tool_row.quadrant if tool.tool_row else 0
        name = f"{translate_field_name('quadrant')} {quadrant or ''}"
        self._target(painter, tip, partial(self._model.ask_tool_value, "quadrant"), name, lit=False)
        draw_tool_tip(painter, tip.adjusted(0.6 * u, 0.6 * u, -0.6 * u, -0.6 * u), quadrant)
        self._stands(painter, area.adjusted(tip.right() + 1.2 * u - area.x(), 0, 0, 0))

    def _stands(self, painter: ThemedPainter, room: QRectF) -> None:
        u, mode, line = self.theme.unit_px, self.displayed_unit_mode, self.theme.find_line_height(2.0)
        painter.draw_text_line(
            QRectF(room.x(), room.y(), room.width(), line), self.tip_position_heading, 1.5, "soft"
        )
        rows = 1 if self._picture is not None else 2  # X and Z are in one row above a picture.
        high, wide = (room.height() - line) / rows, room.width() * rows / 2
        if self._tip is None:
            painter.draw_text_line(
                room.adjusted(0, line, 0, 0),
                describe_missing_offset(is_unreadable=self._model.tool_setting.offset_book.has_read_failed),
                2.8,
                "soft",
            )
            return
        x, z = self._tip
        axis_texts = (
            (
                f"X {'Ø' if mode.is_diameter else 'R'}",
                format_length(2 * x if mode.is_diameter else x, mode.is_metric),
            ),
            ("Z", format_length(z, mode.is_metric)),
        )
        for number, (name, figure) in enumerate(axis_texts):
            down, across = divmod(number, 3 - rows)
            row = QRectF(room.x() + across * wide, room.y() + line + down * high, wide, high)
            painter.draw_text_line(row.adjusted(across * u, 0, 0, 0), name, 2.2, "accent")
            painter.draw_text_line(row.adjusted(5 * u, 0, 0, 0), figure, 3.4, "text", at=ALIGN_RIGHT)

    def _cells(self, painter: ThemedPainter, room: QRectF) -> None:
        u = self.theme.unit_px
        rows = self._find_row_count(self.inside())
        columns = len(DISPLAYED_TOOL_FIELDS) // rows
        high, wide = (room.height() + 0.5 * u) / rows, (room.width() + 0.6 * u) / columns
        for number, (name, key) in enumerate(DISPLAYED_TOOL_FIELDS):
            row, column = divmod(number, columns)
            box = QRectF(room.x() + column * wide, room.y() + row * high, wide - 0.6 * u, high - 0.5 * u)
            self._cell(painter, box, name, key)

    def _cell(self, painter: ThemedPainter, box: QRectF, name: str, key: str) -> None:
        u, mode = self.theme.unit_px, self._mode
        model, tool = self._model, self._model.tool_setting
        asks = _FIELD_QUESTIONS.get(name, name)
        press: Callable[[], None] = (
            model.ask_to_toggle_master if name == "master" else partial(model.ask_tool_value, asks)
        )
        self._target(painter, box, press, lit=tool.question_name == asks)
        mark = find_x_symbol(name, mode)
        label = {"x": tr("TOUCH OFF X"), "z": tr("TOUCH OFF Z")}.get(name, translate_field_name(name)) + (
            f" {mark}" if mark else ""
        )
        self._key(painter, box, key)
        line = self.theme.find_line_height(2.2)
        half = min(line, 0.5 * box.height())
        upper = QRectF(box.x() + 3.4 * u, box.y() + 0.1 * u, box.width() - 3.6 * u, half)
        room = QRectF(box.x() + u, upper.bottom(), box.width() - 2 * u, box.bottom() - upper.bottom())
        if box.height() < 1.9 * line and box.width() > 22 * u:  # The value is on the right of the label.
            upper = QRectF(upper.x(), box.y(), 0.5 * box.width() - 3.4 * u, box.height())
            room = QRectF(upper.right() + 0.3 * u, box.y(), 0.5 * box.width() - 0.8 * u, box.height())
        painter.draw_text_line(upper, label, 1.5, "soft")
        text = self._text(name)
        at = ALIGN_LEFT if name in {"remark", "master"} else ALIGN_RIGHT
        painter.draw_text_line(room, text, 2.5, "text", at=at, raw=name == "remark")

    def _text(self, name: str) -> str:
        tool, mode = self._model.tool_setting, self._mode
        if name == "master":
            return self._describe_master()
        return format_value(name, getattr(tool.tool_row, name), mode) if tool.tool_row else ""

    def _describe_master(self) -> str:
        """Return a text with the master tool and the offset of the selected tool relative to it."""
        tool, mode = self._model.tool_setting, self._mode
        master = tool.offset_book.master_tool_number
        if not master:
            return tr("none")
        if master == tool.tool_number:
            return tr("THIS TOOL")
        apart = tool.find_master_difference()
        if apart is None:
            return f"T{master}"
        x = format_signed_length(2 * apart[0] if mode.is_diameter else apart[0], mode.is_metric)
        return f"T{master}   X {x}  Z {format_signed_length(apart[1], mode.is_metric)}"

    def _target(
        self, painter: ThemedPainter, box: QRectF, press: Callable[[], None], name: str = "", *, lit: bool
    ) -> None:
        painter.draw_box(box, "lit" if lit else "frame", 0.24 if lit else 0.12, "here" if lit else "key")
        self.add_target(box, press, name)

    def _key(self, painter: ThemedPainter, box: QRectF, key: str) -> None:
        u = self.theme.unit_px
        painter.draw_text_line(
            QRectF(
                box.x() + 0.7 * u,
                box.y() + 0.2 * u,
                2.7 * u,
                min(self.theme.find_line_height(2.2), box.height() - 0.4 * u),
            ),
            key,
            1.7,
            "accent",
        )


_COSINE_DECIMALS = 4  # Decimals of a direction cosine.
_ROW_HEIGHT = 6.0  # Units: height of a row.


class MillJogPanel(Panel):
    """Panel on the Jog page of a mill, with touch targets for tool, preset and 3D-ROT."""

    _shown: RedrawingAttribute[object] = RedrawingAttribute(None)
    _tip: RedrawingAttribute[tuple[float, ...] | None] = RedrawingAttribute(None)

    def __init__(
        self,
        theme: ScreenTheme,
        model: JogModel,
        open_tools: Callable[[], None],
        open_presets: Callable[[], None],
        parent: QWidget,
    ) -> None:
        super().__init__(theme, parent)
        self._model, self._tools, self._presets = model, open_tools, open_presets

    def show_state(self, snapshot: Snapshot) -> None:
        """Show the active tool, the active preset, the tip position and the tilted frame."""
        book, tilt, tool = self._model.desk.offset_book, self._model.tilted_jog, snapshot.modal.tool
        swivel = snapshot.swivel
        self._tip = (
            swivel.system.transform.convert_to_frame_point(_slides(snapshot)) if swivel is not None else None
        )
        self._shown = (
            tool,
            book.mill_tools.get(tool),
            book.active_preset,
            tilt.is_on,
            tilt.jog_frame,
            tilt.refusal_reason,
        )

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the tool, the preset, the tilted plane and the axis positions of the mill in mm."""
        self.frame(painter, tr("TOOL, PRESET, TILTED PLANE  ·  MM"))
        u, room = self.theme.unit_px, self.inside()
        row = QRectF(room.x(), room.y(), room.width(), _ROW_HEIGHT * u - 0.6 * u)
        self._tool(painter, row)
        row.translate(0, _ROW_HEIGHT * u)
        self._preset(painter, row)
        row.translate(0, _ROW_HEIGHT * u)
        self._tilted(painter, row)
        self._draw_axes(
            painter, QRectF(room.x(), row.bottom() + u, room.width(), room.bottom() - row.bottom() - u)
        )

    def _tool(self, painter: ThemedPainter, row: QRectF) -> None:
        book, number = self._model.desk.offset_book, self._model.desk.read_snapshot().modal.tool
        tool = book.mill_tools.get(number)
        words = tr("no tool active; run TOOL CALL in MDI")
        if tool is not None:
            words = f"{tool.name}   L {tool.length + tool.dl:.3f}   R {tool.radius + tool.dr:.3f}"
        self._key(painter, row, "F8", f"T{number}" if number else tr("TOOL"), words, self._tools)

    def _preset(self, painter: ThemedPainter, row: QRectF) -> None:
        book = self._model.desk.offset_book
        preset = book.presets.get(book.active_preset)
        words = tr("zero point from the machine file")
        if preset is not None:
            words = Message(
                "X {x}   Y {y}   Z {z}   ROT {rotation}",
                x=f"{preset.x:.3f}",
                y=f"{preset.y:.3f}",
                z=f"{preset.z:.3f}",
                rotation=f"{preset.rotation:.3f}",
            )
        self._key(
            painter,
            row,
            "F9",
            tr(Message("PRESET {number}", number=book.active_preset)),
            words,
            self._presets,
        )

    def _tilted(self, painter: ThemedPainter, row: QRectF) -> None:
        tilt = self._model.tilted_jog
        state = tr("ON") if tilt.is_on else tr("OFF")
        tilted = self._model.desk.read_snapshot().swivel
        words = (
            tr("not tilted")
            if tilted is None or not tilted.system.is_tilted
            else tr("rotary axes are not at the angles of the tilted plane")
        )
        words = tilt.jog_frame.frame_name if tilt.jog_frame is not None else words
        self._key(
            painter,
            row,
            "F5",
            Message("3D-ROT {state}", state=state),
            words,
            self._model.toggle_tilted_jog,
            lit=tilt.is_on,
        )

    def _key(
        self,
        painter: ThemedPainter,
        row: QRectF,
        key: str,
        name: str,
        words: str,
        press: Callable[[], None],
        *,
        lit: bool = False,
    ) -> None:
        u = self.theme.unit_px
        painter.draw_box(row, "lit" if lit else "frame", 0.24 if lit else 0.12, "here" if lit else "key")
        painter.draw_text_line(QRectF(row.x() + 0.8 * u, row.y() + 0.2 * u, 4 * u, 2 * u), key, 1.6, "accent")
        left = QRectF(row.x() + 4 * u, row.y(), 13.5 * u, row.height())
        painter.draw_text_line(left, name, 2.5, "text")
        painter.draw_text_line(row.adjusted(18 * u, 0, -0.8 * u, 0), words, 2.0, "soft")
        self.add_target(row, press)

    def _draw_axes(self, painter: ThemedPainter, area: QRectF) -> None:
        """Draw the tip position in the active coordinate system and the machine direction of each jog key."""
        u, tilt = self.theme.unit_px, self._model.tilted_jog
        head = QRectF(area.x(), area.y(), area.width(), 2.2 * u)
        painter.draw_text_line(head, tr("TIP POSITION"), 1.5, "soft")
        if tilt.jog_frame is not None:
            painter.draw_text_line(
                head, tr("JOG KEY DIRECTION IN MACHINE COORDINATES X Y Z"), 1.5, "soft", at=ALIGN_RIGHT
            )
        high = min(4.4 * u, (area.height() - 2.4 * u) / len(LINEAR_AXES))
        for place, name in enumerate(LINEAR_AXES):
            row = QRectF(area.x(), head.bottom() + place * high, area.width(), high)
            mark = "'" if tilt.is_on else ""
            painter.draw_text_line(row, f"{name}{mark}", 2.6, "accent")
            if self._tip is not None:
                at = QRectF(row.x() + 4 * u, row.y(), 13 * u, high)
                painter.draw_text_line(
                    at, format_length(self._tip[place], is_metric=True), 2.8, "text", at=ALIGN_RIGHT
                )
            direction = (
                tilt.find_direction(name)
                if tilt.is_on
                else tilt.jog_frame.find_direction(name)
                if tilt.jog_frame
                else None
            )
            if direction is not None:
                words = "   ".join(f"{share + 0.0:+.{_COSINE_DECIMALS}f}" for share in direction)
                painter.draw_text_line(row, words, 2.2, "text" if tilt.is_on else "soft", at=ALIGN_RIGHT)
        if self._tip is None:
            painter.draw_text_line(
                area, tr("position unknown until a program line has run"), 2.2, "soft", at=ALIGN_CENTER
            )


def _slides(snapshot: Snapshot) -> tuple[float, float, float]:
    x, y, z = snapshot.actual[:3]
    return x, y, z
