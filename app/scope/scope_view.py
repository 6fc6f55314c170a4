"""The scope page, with curves over time and their values, and with zoom, pan and measuring."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QBuffer, QByteArray, QEvent, QIODevice, QPointF, QRectF, Qt
from PySide6.QtGui import QImage, QImageWriter, QMouseEvent, QResizeEvent, QTouchEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.table_content import FunctionKey
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status import formats
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.scope.scope_curves import ScopePicture
from app.scope.scope_model import NO_SAMPLES_MESSAGE, ScopeModel, SidePanel
from app.scope.scope_readings_view import ScopeReadings
from app.scope.scope_tables import ScopeTables
from app.screen import page_table
from app.screen.entry_panel import NumberPad
from app.screen.page_base import KeyActions, PageHost
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ScreenTheme, ThemedPainter
from app.screen.table_panel import ListPage, TablePanel
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages

if TYPE_CHECKING:
    from app.scope.scope_chart_view import ScopeChart

_READINGS, _TABLE, _PAD, _HEAD = 34.0, 56.0, 28.4, 3.4  # units: widths of the areas, height of the head line
_WHEEL_NOTCH = 120  # wheel angle of one notch in Qt
_NEAR, _STILL = 22.0, 6.0  # pixels: distance for touching a cursor, and travel before a press becomes a drag
_MIN_FINGER_PX = 24.0  # pixels: minimum finger distance
_LANES_AHEAD = 4  # lanes created in advance: following error, velocity, spindle and one more


def _import_chart_class() -> type[ScopeChart]:
    """Import the chart class on a worker, because importing pyqtgraph takes 0.3 s."""
    from app.scope.scope_chart_view import ScopeChart

    return ScopeChart


class ScopeHeader(Panel):
    """Header line with the sample rate, the time window, the data source and the trigger."""

    background_color = "panel"
    header_texts: RedrawingAttribute[tuple[str, str, bool]] = RedrawingAttribute(("", "", False))

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the texts of the header line, with a warning in a different color."""
        u = self.theme.unit_px
        left, right, warn = self.header_texts
        room = self.find_full_area().adjusted(0.8 * u, 0, -0.8 * u, 0)
        half = room.width() * (0.66 if right else 1.0)
        painter.draw_text_line(QRectF(room.x(), room.y(), half, room.height()), left, 1.8, "text", raw=True)
        rest = QRectF(room.x() + half, room.y(), room.width() - half, room.height())
        painter.draw_text_line(rest, right, 1.8, "pause" if warn else "soft", raw=True)


class CurveArea(QWidget):
    """Area around the chart that handles touch, wheel and mouse. The chart itself only draws."""

    accessible_name = "CHART"

    def __init__(self, theme: ScreenTheme, scope: ScopeModel, parent: QWidget) -> None:
        super().__init__(parent)
        self.theme, self.scope_model = theme, scope
        self.chart: ScopeChart | None = None
        self._down: QPointF | None = None
        self._last = QPointF()
        self._dragging = False
        self._cursor = -1  # index of the cursor that is being dragged
        self._spread: tuple[float, float] | None = None
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Resize the chart so that it fills the area."""
        if self.chart is not None:
            self.chart.setGeometry(self.rect())

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom the time axis around the pointer or, with Shift, the lane under the pointer."""
        notches = event.angleDelta().y() or event.angleDelta().x()
        steps = round(notches / _WHEEL_NOTCH) or (1 if notches > 0 else -1)
        if self.chart is None:
            return
        at = event.position()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self.scope_model.zoom_lane(steps, self.chart.find_quantity(at))
        else:
            self.scope_model.zoom_window(steps, self.chart.find_time(at))
        event.accept()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Start a press on a cursor or on the curves."""
        self._press(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the cursor or the curves during a drag."""
        self._move(event.position())

    def mouseReleaseEvent(self, _event: QMouseEvent) -> None:
        """End a drag."""
        self._down = None

    def event(self, event: QEvent) -> bool:
        """Handle a single touch like the mouse, and two touches as a zoom."""
        if not isinstance(event, QTouchEvent):
            return super().event(event)
        spots = [point.position() for point in event.points()]
        if event.type() in {QEvent.Type.TouchEnd, QEvent.Type.TouchCancel}:
            self._down, self._spread = None, None
        elif len(spots) > 1:
            self._handle_two_touches(spots[0], spots[1])
        elif spots and event.type() == QEvent.Type.TouchBegin:
            self._press(spots[0])
        elif spots and self._spread is None:
            self._move(spots[0])
        event.accept()
        return True

    def _press(self, at: QPointF) -> None:
        self._down = self._last = at
        self._dragging, self._cursor = False, -1
        cursors = self.scope_model.cursors
        if cursors.shown and self.chart is not None:
            away = [abs(self.chart.find_column(time) - at.x()) for time in cursors.times_s]
            nearest = away.index(min(away))
            if away[nearest] < _NEAR:
                self._cursor = cursors.active_index = nearest

    def _move(self, at: QPointF) -> None:
        chart = self.chart
        if self._down is None or chart is None:
            return
        if self._cursor >= 0:
            self.scope_model.cursors.move_cursor(chart.find_time(at), self._cursor)
            return
        self._dragging = self._dragging or (at - self._down).manhattanLength() > _STILL
        if self._dragging:
            by = at - self._last
            self._last = at
            if by.x():
                self.scope_model.pan_window(
                    chart.find_time(QPointF(0, 0)) - chart.find_time(QPointF(by.x(), 0))
                )

    def _handle_two_touches(self, one: QPointF, other: QPointF) -> None:
        """Zoom the time axis if two fingers move horizontally, or the lane if they move vertically."""
        self._down = None
        spans_px = (abs(one.x() - other.x()), abs(one.y() - other.y()))
        before, self._spread = self._spread, spans_px
        chart = self.chart
        if before is None or chart is None:
            return
        middle = (one + other) / 2
        if spans_px[0] >= spans_px[1]:
            self.scope_model.magnify_window(
                max(spans_px[0], _MIN_FINGER_PX) / max(before[0], _MIN_FINGER_PX), chart.find_time(middle)
            )
        else:
            factor = max(spans_px[1], _MIN_FINGER_PX) / max(before[1], _MIN_FINGER_PX)
            self.scope_model.magnify_lane(factor, chart.find_quantity(middle))


class ScopePage(ListPage):
    """The scope page, which displays its model and passes key presses to it."""

    NAME = page_table.SCOPE
    model: _ScopeKeys

    def __init__(self, host: PageHost, scope: ScopeModel, parent: QWidget) -> None:
        self.scope_model = scope
        self.scope_tables = ScopeTables(scope)
        super().__init__(host, _ScopeKeys(scope, self.scope_tables), parent)
        self.head_line = ScopeHeader(self.theme, self)
        self.curve_area = CurveArea(self.theme, scope, self)
        self.readings = ScopeReadings(self.theme, scope, self._marked, self)
        self.table_panel = TablePanel(self.theme, self.scope_tables.handle_row_touch, self)
        self.table_panel.on_select = self.scope_tables.select_row
        self.number_pad = NumberPad(self.theme, self.handle_touched_key, page_key=None, parent=self)
        self._laid: object = None
        self._drawn: object = None
        self._undrawn = True  # the present picture is not drawn yet
        scope.file_worker.enqueue_work(_import_chart_class, self._create_chart, self.desk.say)

    def _create_chart(self, chart_class: type[ScopeChart]) -> None:
        """Create the chart after its class has been loaded."""
        chart = chart_class(self.theme, self.curve_area)
        self.curve_area.chart = chart
        chart.setGeometry(self.curve_area.rect())
        chart.show()

    def continue_preparation(self) -> bool:
        """Create the chart and its lanes in steps before the page is first shown.

        Return whether work remains.
        """
        self.scope_model.file_worker.deliver_results()
        chart = self.curve_area.chart
        return chart is None or not chart.prepare_plots(_LANES_AHEAD)

    def _marked(self, number: int) -> None:
        self.scope_model.mark(number)

    # --- keys ----------------------------------------------------------------------------------------

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the key labels of the displayed table."""
        return self.make_function_key_labels({}, self.make_function_keys())

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys of the scope, or of the list of recordings while it is open.

        F8 is included only if the ANALYSES page exists.
        """
        scope, open_ = self.scope_model, self.scope_tables.open_table
        if scope.side_panel is SidePanel.FILES:
            pictured = {
                "F6": FunctionKey("PICTURE", self._save_picture),
                "F9": FunctionKey("BACK", partial(open_, SidePanel.FILES)),
            }
            return {**self.scope_tables.make_function_keys(), **pictured}
        return {
            "F2": FunctionKey(
                "FREEZE" if scope.is_live else "LIVE", scope.toggle_freeze, barred=not scope.has_samples
            ),
            "F3": FunctionKey("TRIGGER", partial(open_, SidePanel.TRIGGER)),
            "F4": FunctionKey("CURVES", partial(open_, SidePanel.CURVES)),
            "F5": FunctionKey("CURSORS", scope.toggle_cursors, barred=scope.is_live),
            "F6": FunctionKey("FIT", scope.show_whole_record),
            **(
                {"F8": FunctionKey("ANALYZE", self._analyse)}
                if page_table.has_page(page_table.ANALYSES)
                else {}
            ),
            "F9": FunctionKey("RECORDS", partial(open_, SidePanel.FILES)),
        }

    def make_key_actions(self) -> KeyActions:
        """Return the key actions, including zoom and pan."""
        scope = self.scope_model
        return {
            **{name: key.action for name, key in self.make_function_keys().items()},
            "Zoom in": partial(scope.zoom_window, 1),
            "Zoom out": partial(scope.zoom_window, -1),
            "Pan left": partial(scope.pan_window_by_steps, -1),
            "Pan right": partial(scope.pan_window_by_steps, 1),
            "Pan up": partial(scope.zoom_lane, 1),
            "Pan down": partial(scope.zoom_lane, -1),
            "Page up": partial(scope.shift_lane, 1),
            "Page down": partial(scope.shift_lane, -1),
            "Follow": scope.show_whole_record,
        }

    def is_animating(self) -> bool:
        """Return whether the picture is changing.

        It changes while live curves are not constant or while lanes are being created.
        """
        return self._undrawn or (
            self.scope_model.is_live and self.scope_model.picture.constant_values is None
        )

    def find_list(self) -> TablePanel | None:
        """Return the table of curves, triggers or recordings while it is open."""
        return None if self.table_panel.isHidden() else self.table_panel

    def has_text_field(self) -> bool:
        """Return whether the operator has to enter a trigger level or a line number."""
        return self.scope_tables.needs_value

    def handle_escape(self) -> bool:
        """Go back one step, or return False if only the curves are shown."""
        return self.scope_tables.handle_escape()

    def _analyse(self) -> None:
        self.host.open_page(page_table.ANALYSES)

    def _save_picture(self) -> None:
        """Save a picture of the page.

        A worker encodes the picture.
        """
        image = self.grab().toImage()
        self.scope_tables.scope_files.write_picture(partial(_encode_png, image))

    # --- every frame ---------------------------------------------------------------------------------

    def refresh(self, _snapshot: Snapshot, _view: MachineStatus, _loaded: LoadedProgram) -> None:
        """Draw the last finished picture, and request the next picture."""
        scope, chart = self.scope_model, self.curve_area.chart
        if chart is not None and chart.curve_area.width() > 1.0:
            scope.chart_width_px = round(chart.curve_area.width())
        scope.poll()
        self._lay_out_if()
        self.head_line.header_texts = self._words()
        if not self.readings.isHidden():
            self.readings.show_picture(scope.picture)
        if not self.table_panel.isHidden():
            self.table_panel.show_table(self.scope_tables.make_table())
        shown = (_find_view_key(scope.picture), scope.cursors.times_s, scope.cursors.active_index)
        if chart is not None and shown != self._drawn and chart.show_picture(scope.picture, scope.cursors):
            self._drawn = shown
        self._undrawn = chart is None or shown != self._drawn

    def _words(self) -> tuple[str, str, bool]:
        scope, sight = self.scope_model, self.scope_model.picture
        if scope.live_samples is None and scope.is_live:
            return NO_SAMPLES_MESSAGE, "", True
        if self.curve_area.chart is None:
            return tr("OPENING …"), "", False
        rate = tr(Message("{rate} samples per second", rate=f"{sight.sample_rate_hz:g}"))
        span = tr(Message("window {span}", span=format_time_span(scope.time_window.window_span_s)))
        what = tr("LIVE") if scope.is_live else scope.recording_name or tr("FROZEN")
        over = "  ·  " + tr(Message("overlay: {name}", name=scope.overlay_name)) if scope.overlay_name else ""
        return join_messages("  ·  ", (what, rate, span, over)), scope.trigger_state_text, scope.is_armed

    def apply_theme(self) -> None:
        """Apply the current colors."""
        if self.curve_area.chart is not None:
            self.curve_area.chart.apply_theme()
        self._drawn = None

    # --- layout --------------------------------------------------------------------------------------

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange and draw all parts again."""
        self._laid = None
        self._lay_out_if()
        self.apply_theme()

    def _lay_out_if(self) -> None:
        known = (self.size(), self.scope_model.side_panel, self.scope_tables.needs_value)
        if known != self._laid:
            self._laid = known
            self._lay_out()

    def _lay_out(self) -> None:
        u, reading = self.theme.unit_px, self.scope_model.side_panel is SidePanel.READINGS
        gap, asks = max(4, round(0.7 * u)), self.scope_tables.needs_value
        side = round((_READINGS if reading else _TABLE) * u)
        left = self.width() - side - gap
        self.readings.setVisible(reading)
        self.table_panel.setVisible(not reading)
        self.number_pad.setVisible(asks)
        for part in (self.readings, self.table_panel):
            part.setGeometry(left + gap, 0, side, self.height())
        pad = round(_PAD * u) if asks else 0
        self.number_pad.setGeometry(left - pad, 0, pad, self.height())
        left -= pad + (gap if asks else 0)
        high = round(_HEAD * u)
        self.head_line.setGeometry(0, 0, left, high)
        self.curve_area.setGeometry(0, high, left, self.height() - high)


class _ScopeKeys:
    """Adapter that passes the page's keys to the cursors and the tables."""

    def __init__(self, scope: ScopeModel, sheets: ScopeTables) -> None:
        self._scope, self._sheets = scope, sheets

    def handle_key(self, key: str) -> bool:
        """Pass a key to the cursors if they use it, and otherwise to the table."""
        scope = self._scope
        if scope.cursors.shown and scope.side_panel is SidePanel.READINGS and key in {"Left", "Right"}:
            scope.step_cursor(1 if key == "Right" else -1)
            return True
        if scope.cursors.shown and key == "Tab":
            scope.cursors.activate_other_cursor()
            return True
        if scope.side_panel is SidePanel.READINGS and key in {"Page up", "Page down", "Home"}:
            return False  # These keys shift the lane and show everything.
        return self._sheets.handle_key(key)

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered as part of a value."""
        return self._sheets.accepts_key(key)

    def on_open(self) -> None:
        """Do nothing, because the page reopens in its last state."""

    def handle_escape(self) -> bool:
        """Go back one step, and return whether there was a step to go back."""
        return self._sheets.handle_escape()

    def prompt_text(self) -> str:
        """Return the prompt for the keys that are available now."""
        return self._sheets.prompt_text()

    def on_close(self) -> None:
        """Clear the entered value when the page closes."""
        self._sheets.input_field.text = ""


def _find_view_key(sight: ScopePicture) -> object:
    """Return a comparison key of a picture. Pictures with the same appearance have equal keys."""
    if sight.constant_values is None:
        return sight
    level_texts = [
        (each.signal.key, f"{level!r}")
        for each, level in zip(sight.curves, sight.constant_values, strict=True)
    ]
    return level_texts, dict(sight.lane_ranges), sight.begin_s, sight.end_s, sight.is_metric


def format_time_span(seconds: float) -> str:
    """Return a duration as text with a suitable unit."""
    if seconds < 1.0:
        return Message(
            "{seconds} ms", seconds=formats.format_fixed(1000.0 * seconds, 0 if seconds >= 0.01 else 1)
        )
    return f"{formats.format_fixed(seconds, 0 if math.isclose(seconds, round(seconds)) else 1)} s"


def _encode_png(image: QImage) -> bytes:
    """Encode an image as PNG.

    This runs on a worker.
    """
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    QImageWriter(buffer, QByteArray(b"png")).write(image)
    return bytes(buffer.data().data())
