"""Row below the readouts that shows the progress of a running program."""

from __future__ import annotations

from PySide6.QtCore import QRectF

from app.desk.status.machine_status import MachineStatus, StatusTone
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import (
    ALIGN_RIGHT,
    ThemedPainter,
    draw_state_symbol,
)
from app.screen.window.readout_panels import TimeTexts
from core.message import Message, join_messages

_COMMENT_WIDTH, _BLOCK_WIDTH = 0.38, 0.24  # Fractions of the width. Parts and times use the rest.


class RunStatusRow(Panel):
    """Row with comment, block, parts and times, at the position of the Automatic page's comment line."""

    background_color = "panel"
    comment_text, block_text, message_text = (
        RedrawingAttribute(""),
        RedrawingAttribute(""),
        RedrawingAttribute(""),
    )
    time_texts: RedrawingAttribute[TimeTexts] = RedrawingAttribute(())
    stop_text = RedrawingAttribute("")  # Number and text of the alarm or stop.
    _tone = RedrawingAttribute("")

    def show_status(self, status: MachineStatus, time_texts: TimeTexts) -> None:
        """Show a status and times, and redraw the panel if a value has changed."""
        self.comment_text, self.message_text, self.time_texts = status.comment, status.message, time_texts
        self.block_text = f"L{status.line_number}  {status.block_text}" if status.line_number else ""
        self.stop_text, self._tone = describe_stop(status), status.state_tone.value

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the comment, the block, the parts and the times, or the alarm or stop.

        A message of M00 or M01 replaces the comment and the block.
        """
        u, wide, high = self.theme.unit_px, float(self.width()), float(self.height())
        if self.stop_text:
            self._draw_alarm(painter)
            return
        comment = QRectF(1.4 * u, 0, _COMMENT_WIDTH * wide - 2 * u, high)
        block = QRectF(_COMMENT_WIDTH * wide, 0, _BLOCK_WIDTH * wide - u, high)
        if self.message_text:
            self._draw_stop(painter, comment.united(block))
        else:
            self._text(painter, comment, "accent", self.comment_text)
            self._text(painter, block, "text", self.block_text)
        self._draw_times(
            painter,
            QRectF(
                (_COMMENT_WIDTH + _BLOCK_WIDTH) * wide,
                0,
                (1 - _COMMENT_WIDTH - _BLOCK_WIDTH) * wide - u,
                high,
            ),
        )

    def _draw_alarm(self, painter: ThemedPainter) -> None:
        """Draw the alarm over the whole row, large enough to read while standing at the machine."""
        look, u = self.theme, self.theme.unit_px
        painter.fill_rect(self.find_full_area(), self._tone)
        sign = QRectF(u, self.height() / 2 - 1.1 * u, 2.2 * u, 2.2 * u)
        draw_state_symbol(painter, sign, StatusTone(self._tone), look.get_color("on_state"))
        painter.draw_text_line(
            self.find_full_area().adjusted(4.4 * u, 0, -u, 0), self.stop_text, 2.5, "on_state"
        )

    def _text(self, painter: ThemedPainter, box: QRectF, ink: str, text: str) -> None:
        painter.draw_text_line(box, text, 2.0, ink, bold=ink == "text", raw=True)

    def _draw_stop(self, painter: ThemedPainter, box: QRectF) -> None:
        """Draw the message of M00 or M01 over comment and block while the stop lasts."""
        painter.fill_rect(box.adjusted(-1.4 * self.theme.unit_px, 0, 0, 0), "pause")
        painter.draw_text_line(box, self.message_text, 2.4, "on_state", raw=True)

    def _draw_times(self, painter: ThemedPainter, area: QRectF) -> None:
        """Draw the times in columns, each with its name and value side by side."""
        u, share = self.theme.unit_px, area.width() / max(1, len(self.time_texts))
        for number, (name, figure) in enumerate(self.time_texts):
            box = QRectF(area.x() + number * share, 0, share - 0.8 * u, area.height())
            half = 0.5 * box.width()
            painter.draw_text_line(QRectF(box.x(), 0, half, box.height()), name, 1.5, "soft", at=ALIGN_RIGHT)
            painter.draw_text_line(box.adjusted(half + 0.6 * u, 0, 0, 0), figure, 2.0, "text", raw=True)


def describe_stop(status: MachineStatus) -> str:
    """Return the text of the most important stop.

    This is the number and text of the first alarm, the E-stop, or an unrequested feed hold.
    """
    first = status.alarms[0] if status.alarms else status.stop_cause
    if first is None:
        return ""
    parts = [
        Message("ALARM {number}: {alarms}", number=first.number, alarms=first.text)
        if status.alarms
        else Message("STOP {number}: {first}", number=first.number, first=first.text)
    ]
    if first.line:
        parts.append(Message("LINE {line}", line=first.line))
    if len(status.alarms) > 1:
        parts.append(Message("AND {alarms_count} MORE", alarms_count=len(status.alarms) - 1))
    return join_messages("  ·  ", parts)
