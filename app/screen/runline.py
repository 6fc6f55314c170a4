"""What of the run stays in sight on pages other than Automatic: comment, line and block, parts, times."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.view import Tone, View
from app.desk.words import tr
from app.screen.look import LEFT, RIGHT, Look, put, put_raw
from app.screen.panel import Panel
from app.screen.shapes import draw_sign

Times = Sequence[tuple[str, str]]
COMMENT, BLOCK = 0.38, 0.24  # shares of the width; parts and times have the rest


class RunLine(Panel):
    """One low row at the lower left, where the Automatic page has its comment."""

    ground = "panel"

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.comment, self.block, self.message = "", "", ""
        self.times: Times = ()
        self.stop = ""  # number and words of what stopped the machine
        self._tone = ""

    def show_run(self, view: View, times: Times) -> None:
        """Redraw when something of it has changed."""
        block = f"L{view.line}  {view.block_text}" if view.line else ""
        shown = (view.comment, block, view.message, times, stop_words(view), view.tone.value)
        if shown != (self.comment, self.block, self.message, self.times, self.stop, self._tone):
            self.comment, self.block, self.message, self.times, self.stop, self._tone = shown
            self.update()

    def draw(self, painter: QPainter) -> None:
        u, wide, high = self.look.u, float(self.width()), float(self.height())
        if self.stop:
            self._alarm(painter)
            return
        comment = QRectF(1.4 * u, 0, COMMENT * wide - 2 * u, high)
        block = QRectF(COMMENT * wide, 0, BLOCK * wide - u, high)
        if self.message:
            self._stop(painter, comment.united(block))
        else:
            self._text(painter, comment, "accent", self.comment)
            self._text(painter, block, "text", self.block)
        self._times(painter, QRectF((COMMENT + BLOCK) * wide, 0, (1 - COMMENT - BLOCK) * wide - u, high))

    def _alarm(self, painter: QPainter) -> None:
        """Over all of it: nothing runs, and this has to be read from where the machine is."""
        look, u = self.look, self.look.u
        painter.fillRect(self.area(), look.colour(self._tone))
        ink = look.colour("on_state")
        draw_sign(painter, QRectF(u, 0.3 * u, 2.2 * u, 2.2 * u), Tone(self._tone), ink)
        painter.setPen(ink)
        room = self.area().adjusted(4.4 * u, 0, -u, 0)
        painter.setFont(look.fit(self.stop, 2.5, room.width(), bold=True))
        put(painter, room, LEFT, self.stop)

    def _text(self, painter: QPainter, box: QRectF, ink: str, text: str) -> None:
        painter.setPen(self.look.colour(ink))
        painter.setFont(self.look.fit(text, 2.0, box.width(), bold=ink == "text"))
        put_raw(painter, box, LEFT, text)

    def _stop(self, painter: QPainter, box: QRectF) -> None:
        """What the operator must do now: filled, over comment and block, as long as an M00 or M01 lasts."""
        painter.fillRect(box.adjusted(-1.4 * self.look.u, 0, 0, 0), self.look.colour("pause"))
        painter.setPen(self.look.colour("on_state"))
        painter.setFont(self.look.fit(self.message, 2.4, box.width(), bold=True))
        put_raw(painter, box, LEFT, self.message)

    def _times(self, painter: QPainter, room: QRectF) -> None:
        """Name and figure beside each other, each in a column of its own."""
        u, share = self.look.u, room.width() / max(1, len(self.times))
        for number, (name, figure) in enumerate(self.times):
            box = QRectF(room.x() + number * share, 0, share - 0.8 * u, room.height())
            half = 0.46 * box.width()
            painter.setPen(self.look.colour("soft"))
            painter.setFont(self.look.fit(tr(name), 1.5, half, bold=True))
            put(painter, QRectF(box.x(), 0, half, box.height()), RIGHT, name)
            painter.setPen(self.look.colour("text"))
            painter.setFont(self.look.fit(figure, 2.0, box.width() - half - u, bold=True))
            put_raw(
                painter, QRectF(box.x() + half + u, 0, box.width() - half - u, box.height()), LEFT, figure
            )


def stop_words(view: View) -> str:
    """Number and words of the alarm that came first, of the E-stop, or of a hold that nobody pressed."""
    first = view.alarms[0] if view.alarms else view.stop
    if first is None:
        return ""
    parts = [f"ALARM {first.number}: {first.text}" if view.alarms else f"STOP {first.number}: {first.text}"]
    if first.line:
        parts.append(f"LINE {first.line}")
    if len(view.alarms) > 1:
        parts.append(f"AND {len(view.alarms) - 1} MORE")
    return "  ·  ".join(parts)
