"""Scope page: curves over time with their values, and zoom, pan and measuring."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QBuffer, QByteArray, QEvent, QIODevice, QPointF, QRectF, Qt
from PySide6.QtGui import QImage, QImageWriter, QMouseEvent, QResizeEvent, QTouchEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.sheet import Key
from app.desk.programs.program_loading import Loaded
from app.desk.status import formats
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.scope.scope_curves import Sight
from app.scope.scope_model import NO_SAMPLES, Scope, Side
from app.scope.scope_readings_view import Readings
from app.scope.scope_sheets import ScopeSheets
from app.screen import page_table
from app.screen.entry_panel import KeyPad
from app.screen.look import Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Panel, Shown
from app.screen.sheet_panel import ListPage, SheetPanel
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages

if TYPE_CHECKING:
    from app.scope.scope_chart_view import ScopeChart

_READINGS, _TABLE, _PAD, _HEAD = 34.0, 56.0, 28.4, 3.4  # units: widths of the areas, height of the head line
_NOTCH = 120  # wheel angle of one notch in Qt
_NEAR, _STILL = 22.0, 6.0  # pixels: distance for touching a cursor, and travel before a press becomes a drag
_LEAST = 24.0  # pixels: minimum finger distance
_LANES = 4  # lanes created in advance: following error, velocity, spindle and one more


def _chart_class() -> type[ScopeChart]:
    """Import the chart class on a worker, because importing pyqtgraph takes 0.3 s."""
    from app.scope.scope_chart_view import ScopeChart

    return ScopeChart


class HeadLine(Panel):
    """Head line with sample rate, window, displayed data and trigger."""

    ground = "panel"
    words: Shown[tuple[str, str, bool]] = Shown(("", "", False))

    def draw(self, painter: Painter) -> None:
        u = self.look.u
        left, right, warn = self.words
        room = self.area().adjusted(0.8 * u, 0, -0.8 * u, 0)
        half = room.width() * (0.66 if right else 1.0)
        painter.write(QRectF(room.x(), room.y(), half, room.height()), left, 1.8, "text", raw=True)
        rest = QRectF(room.x() + half, room.y(), room.width() - half, room.height())
        painter.write(rest, right, 1.8, "pause" if warn else "soft", raw=True)


class CurveRoom(QWidget):
    """Area that handles touch, wheel and mouse. Its chart only draws."""

    part_name = "CHART"

    def __init__(self, look: Look, scope: Scope, parent: QWidget) -> None:
        super().__init__(parent)
        self.look, self.scope = look, scope
        self.chart: ScopeChart | None = None
        self._down: QPointF | None = None
        self._last = QPointF()
        self._dragging = False
        self._cursor = -1  # index of the cursor that is being dragged
        self._spread: tuple[float, float] | None = None
        self.setAttribute(Qt.WidgetAttribute.WA_AcceptTouchEvents)

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Resize the chart to the area."""
        if self.chart is not None:
            self.chart.setGeometry(self.rect())

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom the time around the pointer, or with Shift the lane under the pointer."""
        notches = event.angleDelta().y() or event.angleDelta().x()
        steps = round(notches / _NOTCH) or (1 if notches > 0 else -1)
        if self.chart is None:
            return
        at = event.position()
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self.scope.stretch(steps, self.chart.quantity_at(at))
        else:
            self.scope.zoom(steps, self.chart.time_at(at))
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
        """Handle one finger like the mouse, and two fingers as a zoom."""
        if not isinstance(event, QTouchEvent):
            return super().event(event)
        spots = [point.position() for point in event.points()]
        if event.type() in {QEvent.Type.TouchEnd, QEvent.Type.TouchCancel}:
            self._down, self._spread = None, None
        elif len(spots) > 1:
            self._two(spots[0], spots[1])
        elif spots and event.type() == QEvent.Type.TouchBegin:
            self._press(spots[0])
        elif spots and self._spread is None:
            self._move(spots[0])
        event.accept()
        return True

    def _press(self, at: QPointF) -> None:
        self._down = self._last = at
        self._dragging, self._cursor = False, -1
        cursors = self.scope.cursors
        if cursors.shown and self.chart is not None:
            away = [abs(self.chart.across(time) - at.x()) for time in cursors.times]
            nearest = away.index(min(away))
            if away[nearest] < _NEAR:
                self._cursor = cursors.at = nearest

    def _move(self, at: QPointF) -> None:
        chart = self.chart
        if self._down is None or chart is None:
            return
        if self._cursor >= 0:
            self.scope.cursors.move(chart.time_at(at), self._cursor)
            return
        self._dragging = self._dragging or (at - self._down).manhattanLength() > _STILL
        if self._dragging:
            by = at - self._last
            self._last = at
            if by.x():
                self.scope.pan(chart.time_at(QPointF(0, 0)) - chart.time_at(QPointF(by.x(), 0)))

    def _two(self, one: QPointF, other: QPointF) -> None:
        """Zoom the time by horizontal finger motion, or the lane by vertical finger motion."""
        self._down = None
        way = (abs(one.x() - other.x()), abs(one.y() - other.y()))
        before, self._spread = self._spread, way
        chart = self.chart
        if before is None or chart is None:
            return
        middle = (one + other) / 2
        if way[0] >= way[1]:
            self.scope.magnify(max(way[0], _LEAST) / max(before[0], _LEAST), chart.time_at(middle))
        else:
            factor = max(way[1], _LEAST) / max(before[1], _LEAST)
            self.scope.stretch_by(factor, chart.quantity_at(middle))


class ScopePage(ListPage):
    """Scope page: shows its model and passes the keys to it."""

    NAME = page_table.SCOPE
    model: _ScopeKeys

    def __init__(self, host: Host, scope: Scope, parent: QWidget) -> None:
        self.scope = scope
        self.sheets = ScopeSheets(scope)
        super().__init__(host, _ScopeKeys(scope, self.sheets), parent)
        self.head = HeadLine(self.look, self)
        self.curves = CurveRoom(self.look, scope, self)
        self.readings = Readings(self.look, scope, self._marked, self)
        self.table = SheetPanel(self.look, self.sheets.choose, self)
        self.pad = KeyPad(self.look, self.touched, own=None, parent=self)
        self._laid: object = None
        self._drawn: object = None
        self._undrawn = True  # the present picture is not drawn yet
        scope.filing.queue(_chart_class, self._chart_there, self.desk.say)

    def _chart_there(self, chart_class: type[ScopeChart]) -> None:
        """Insert the chart after its class was loaded."""
        chart = chart_class(self.look, self.curves)
        self.curves.chart = chart
        chart.setGeometry(self.curves.rect())
        chart.show()

    def ahead(self) -> bool:
        """Create the chart and its lanes in steps, before the page is first shown."""
        self.scope.filing.poll()
        chart = self.curves.chart
        return chart is None or not chart.ready(_LANES)

    def _marked(self, number: int) -> None:
        self.scope.mark(number)

    # --- keys ----------------------------------------------------------------------------------------

    def labels(self) -> tuple[str, ...]:
        """Return the labels of the displayed table."""
        return self.labels_of({}, self.page_keys())

    def page_keys(self) -> Mapping[str, Key]:
        scope, open_ = self.scope, self.sheets.open
        if scope.side is Side.FILES:
            pictured = {"F6": Key("PICTURE", self._picture), "F9": Key("BACK", partial(open_, Side.FILES))}
            return {**self.sheets.keys(), **pictured}
        return {
            "F2": Key("FREEZE" if scope.is_live else "LIVE", scope.freeze_key, barred=not scope.has_samples),
            "F3": Key("TRIGGER", partial(open_, Side.TRIGGER)),
            "F4": Key("CURVES", partial(open_, Side.CURVES)),
            "F5": Key("CURSORS", scope.cursors_key, barred=scope.is_live),
            "F6": Key("FIT", scope.fit),
            **({"F8": Key("ANALYZE", self._analyse)} if page_table.has_page(page_table.ANALYSES) else {}),
            "F9": Key("RECORDS", partial(open_, Side.FILES)),
        }

    def key_actions(self) -> KeyActions:
        """Return the actions of the function keys and of zoom and pan."""
        scope = self.scope
        return {
            **{name: key.action for name, key in self.page_keys().items()},
            "Zoom in": partial(scope.zoom, 1),
            "Zoom out": partial(scope.zoom, -1),
            "Pan left": partial(scope.pan_steps, -1),
            "Pan right": partial(scope.pan_steps, 1),
            "Pan up": partial(scope.stretch, 1),
            "Pan down": partial(scope.stretch, -1),
            "Page up": partial(scope.shift, 1),
            "Page down": partial(scope.shift, -1),
            "Follow": scope.fit,
        }

    def lively(self) -> bool:
        """Return whether the picture changes: live curves that are not constant, or unfinished lanes."""
        return self._undrawn or (self.scope.is_live and self.scope.sight.level is None)

    def has_field(self) -> bool:
        """Return whether a level or a line number is to be entered."""
        return self.sheets.asks

    def escape(self) -> bool:
        """Go back one step. Return False from the curves."""
        return self.sheets.escape()

    def _analyse(self) -> None:
        self.host.go(page_table.ANALYSES)

    def _picture(self) -> None:
        """Save a picture of the page. A worker encodes it."""
        image = self.grab().toImage()
        self.scope.write_picture(partial(_png, image))

    # --- every frame ---------------------------------------------------------------------------------

    def refresh(self, _snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Draw the last finished picture and request the next one."""
        scope, chart = self.scope, self.curves.chart
        if chart is not None and chart.room.width() > 1.0:
            scope.pixels = round(chart.room.width())
        scope.look()
        self._lay_out_if()
        self.head.words = self._words()
        if not self.readings.isHidden():
            self.readings.show_sight(scope.sight)
        if not self.table.isHidden():
            self.table.show_sheet(self.sheets.sheet())
        shown = (_seen(scope.sight), scope.cursors.times, scope.cursors.at)
        if chart is not None and shown != self._drawn and chart.show_sight(scope.sight, scope.cursors):
            self._drawn = shown
        self._undrawn = chart is None or shown != self._drawn

    def _words(self) -> tuple[str, str, bool]:
        scope, sight = self.scope, self.scope.sight
        if scope.live is None and scope.is_live:
            return NO_SAMPLES, "", True
        if self.curves.chart is None:
            return tr("OPENING …"), "", False
        rate = tr(Message("{rate} samples per second", rate=f"{sight.rate:g}"))
        span = tr(Message("window {span}", span=span_words(scope.window.span)))
        what = tr("LIVE") if scope.is_live else scope.name or tr("FROZEN")
        over = "  ·  " + tr(Message("overlay: {name}", name=scope.over_name)) if scope.over_name else ""
        return join_messages("  ·  ", (what, rate, span, over)), scope.trigger_words, scope.armed

    def dress(self) -> None:
        """Apply the present colors."""
        if self.curves.chart is not None:
            self.curves.chart.dress()
        self._drawn = None

    # --- layout --------------------------------------------------------------------------------------

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Lay out and draw everything again."""
        self._laid = None
        self._lay_out_if()
        self.dress()

    def _lay_out_if(self) -> None:
        known = (self.size(), self.scope.side, self.sheets.asks)
        if known != self._laid:
            self._laid = known
            self._lay_out()

    def _lay_out(self) -> None:
        u, reading = self.look.u, self.scope.side is Side.READINGS
        gap, asks = max(4, round(0.7 * u)), self.sheets.asks
        side = round((_READINGS if reading else _TABLE) * u)
        left = self.width() - side - gap
        self.readings.setVisible(reading)
        self.table.setVisible(not reading)
        self.pad.setVisible(asks)
        for part in (self.readings, self.table):
            part.setGeometry(left + gap, 0, side, self.height())
        pad = round(_PAD * u) if asks else 0
        self.pad.setGeometry(left - pad, 0, pad, self.height())
        left -= pad + (gap if asks else 0)
        high = round(_HEAD * u)
        self.head.setGeometry(0, 0, left, high)
        self.curves.setGeometry(0, high, left, self.height() - high)


class _ScopeKeys:
    """Adapter between the page and its models."""

    def __init__(self, scope: Scope, sheets: ScopeSheets) -> None:
        self._scope, self._sheets = scope, sheets

    def typed(self, key: str) -> bool:
        """Pass a key to the cursors or to the table."""
        scope = self._scope
        if scope.cursors.shown and scope.side is Side.READINGS and key in {"Left", "Right"}:
            scope.step_cursor(1 if key == "Right" else -1)
            return True
        if scope.cursors.shown and key == "Tab":
            scope.cursors.other()
            return True
        if scope.side is Side.READINGS and key in {"Page up", "Page down"}:
            return False  # These keys shift the lane.
        return self._sheets.typed(key)

    def takes(self, key: str) -> bool:
        """Return whether a character is part of the value to be entered."""
        return self._sheets.takes(key)

    def opened(self) -> None:
        """Do nothing, because the page reopens as it was left."""

    def escape(self) -> bool:
        """Go back one step, and return whether there was a step."""
        return self._sheets.escape()

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        return self._sheets.prompt()

    def leave(self) -> None:
        """Clear the entry."""
        self._sheets.entry.text = ""


def _seen(sight: Sight) -> object:
    """Return a value that is equal for pictures that look the same."""
    if sight.level is None:
        return sight
    figures = [(each.signal.key, f"{level!r}") for each, level in zip(sight.curves, sight.level, strict=True)]
    return figures, dict(sight.ranges), sight.begin, sight.end, sight.metric


def span_words(seconds: float) -> str:
    """Return a duration as text with a suitable unit."""
    if seconds < 1.0:
        return Message("{seconds} ms", seconds=formats.fixed(1000.0 * seconds, 0 if seconds >= 0.01 else 1))
    return f"{formats.fixed(seconds, 0 if math.isclose(seconds, round(seconds)) else 1)} s"


def _png(image: QImage) -> bytes:
    """Encode an image as PNG; runs on a worker."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    QImageWriter(buffer, QByteArray(b"png")).write(image)
    return bytes(buffer.data().data())
