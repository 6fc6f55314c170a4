"""Timeline below the picture of the part, with play, pause, fast playback and single steps.

Errors are marked in red.
"""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter

from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.path.part_player import PartPlayer
from app.screen.panel import OnPress
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_LEFT, ScreenTheme, draw_state_symbol, draw_text
from core.message import Message

_KEY_WIDTH = 6.6  # units: width of a key
_STOCK_KEY_WIDTH = 9.0  # units: width of the STOCK key
_TEXT_WIDTH = 15.0  # units: width of the time and line number at the right
_MIN_TRACK_WIDTH = 8.0  # units: minimum width of the time line

AddTouchTarget = Callable[[QRectF, OnPress], None]


class PartTimeline:
    """Timeline of the part view, with its buttons and its touch handling."""

    def __init__(self, theme: ScreenTheme, player: PartPlayer, open_stock: OnPress | None = None) -> None:
        """Create the timeline.

        ``open_stock`` is the function that opens the entry of the stock.
        """
        self.theme, self.part_player, self._stock = theme, player, open_stock
        self._track = QRectF()
        self._at = 0.0  # touch position in pixels

    def handle_touch(self, position: QPointF) -> bool:
        """Seek to the touched time, and return whether the touch was on the active timeline.

        Return False while the part view follows the run.
        """
        u = self.theme.unit_px
        if self.part_player.follows_run or not self._track.adjusted(-u, -3 * u, u, 3 * u).contains(position):
            return False
        self.part_player.is_playing = False
        self._at = position.x()
        self._seek()
        return True

    def handle_drag(self, pixels: QPointF) -> None:
        """Change the displayed time by the horizontal distance of a drag in pixels."""
        self._at += pixels.x()
        self._seek()

    def _seek(self) -> None:
        share = (self._at - self._track.x()) / max(self._track.width(), 1.0)
        self.part_player.seek_time(min(max(share, 0.0), 1.0) * self.part_player.duration_s)

    def draw(self, painter: QPainter, area: QRectF, add_touch_target: AddTouchTarget) -> None:
        """Draw the buttons and the timeline within ``area``.

        ``add_touch_target`` registers the touch targets.
        """
        look, u, player = self.theme, self.theme.unit_px, self.part_player
        box = QRectF(area.x() + 0.6 * u, area.y() + 0.5 * u, _KEY_WIDTH * u, area.height() - u)
        self._sign(painter, box, StatusTone.PAUSE if player.is_playing else StatusTone.RUN)
        add_touch_target(box, player.toggle_playback)
        for word, press, lit in (
            ("×10", player.toggle_fast_playback, player.is_fast_playback),
            ("◀|", lambda: player.step_by_blocks(-1), False),
            ("|▶", lambda: player.step_by_blocks(1), False),
        ):
            box = box.translated((_KEY_WIDTH + 0.5) * u, 0)
            self._key(painter, box, word, lit=lit)
            add_touch_target(box, press)
        if self._stock is not None:
            box = QRectF(box.right() + 0.5 * u, box.y(), _STOCK_KEY_WIDTH * u, box.height())
            self._key(painter, box, tr("STOCK"), lit=False, size=1.7)
            add_touch_target(box, self._stock)
        left, right = box.right() + 2.2 * u, area.right() - (_TEXT_WIDTH + 1.0) * u
        self._track = QRectF()
        if right - left < _MIN_TRACK_WIDTH * u:
            return  # There is not enough room for a time line.
        self._track = QRectF(left, area.center().y() - 0.5 * u, right - left, u)
        self._draw_line(painter)
        painter.setFont(look.make_font(look.find_table_size(1.7), is_bold=True))
        painter.setPen(look.get_color("soft" if player.follows_run else "text"))
        words = QRectF(right + 1.6 * u, area.y(), _TEXT_WIDTH * u, area.height() / 2)
        draw_text(
            painter,
            words,
            ALIGN_LEFT,
            _format_time(player.program_time_s) + " / " + _format_time(player.duration_s),
        )
        shown = player.latest_result
        if shown is not None and shown.part_instant.line_number:
            painter.setFont(look.make_font(look.find_table_size(1.6)))
            text = tr(Message("LINE {line}", line=shown.part_instant.line_number))
            draw_text(painter, words.translated(0, area.height() / 2 - 0.4 * u), ALIGN_LEFT, text)

    def _draw_line(self, painter: QPainter) -> None:
        """Draw the track, the elapsed time, the error marks and the current position."""
        look, u, track, player = self.theme, self.theme.unit_px, self._track, self.part_player
        length = max(player.duration_s, 1e-9)
        at = track.x() + track.width() * min(player.program_time_s / length, 1.0)
        painter.fillRect(track, look.get_color("key"))
        painter.fillRect(
            QRectF(track.x(), track.y(), at - track.x(), track.height()),
            look.get_color("off" if player.follows_run else "lit"),
        )
        for t in player.find_error_times().tolist():
            mark = track.x() + track.width() * t / length
            painter.fillRect(
                QRectF(mark - 0.2 * u, track.y() - 1.0 * u, 0.4 * u, 3 * u), look.get_color("alarm")
            )
        painter.setPen(look.make_pen("panel", 0.2))
        painter.setBrush(look.get_color("text"))
        painter.drawEllipse(QPointF(at, track.center().y()), 1.3 * u, 1.3 * u)

    def _key(self, painter: QPainter, box: QRectF, word: str, *, lit: bool, size: float = 2.0) -> None:
        look = self.theme
        painter.fillRect(box, look.get_color("lit" if lit else "key"))
        dim = "soft" if self.part_player.follows_run else "text"
        painter.setPen(look.get_color("on_lit" if lit else dim))
        painter.setFont(look.make_font(look.find_table_size(size), is_bold=True))
        draw_text(painter, box, ALIGN_CENTER, word)

    def _sign(self, painter: QPainter, box: QRectF, tone: StatusTone) -> None:
        look, u = self.theme, self.theme.unit_px
        painter.fillRect(box, look.get_color("key"))
        sign = QRectF(box.center().x() - 1.1 * u, box.center().y() - 1.1 * u, 2.2 * u, 2.2 * u)
        draw_state_symbol(
            painter, sign, tone, look.get_color("soft" if self.part_player.follows_run else "text")
        )
        painter.setBrush(Qt.BrushStyle.NoBrush)


def _format_time(seconds: float) -> str:
    """Return a time as minutes and seconds."""
    minutes, rest = divmod(max(seconds, 0.0), 60.0)
    return f"{int(minutes)}:{rest:04.1f}"
