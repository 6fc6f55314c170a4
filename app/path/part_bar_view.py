"""Time line below the part: play, pause, fast playback and single steps, with the errors marked in red."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter

from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.path.part_player import PartPlayer
from app.screen.look import CENTRE, LEFT, Look, draw_sign, put
from app.screen.panel import Press
from core.message import Message

_KEY = 6.6  # units: width of a key
_STOCK = 9.0  # units: width of the STOCK key
_WORDS = 15.0  # units: width of the time and line number at the right
_LEAST = 8.0  # units: minimum width of the time line

Place = Callable[[QRectF, Press], None]


class PartBar:
    """Time line of the part view, with its buttons and its touch handling."""

    def __init__(self, look: Look, player: PartPlayer, stock: Press | None = None) -> None:
        """Create the time line. ``stock`` opens the entry of the stock."""
        self.look, self.player, self._stock = look, player, stock
        self._track = QRectF()
        self._at = 0.0  # touch position in pixels

    def takes(self, at: QPointF) -> bool:
        """Return whether a touch is on the active time line, and seek to its time.

        Returns False while the player follows the run.
        """
        u = self.look.u
        if self.player.bound or not self._track.adjusted(-u, -3 * u, u, 3 * u).contains(at):
            return False
        self.player.playing = False
        self._at = at.x()
        self._seek()
        return True

    def drag(self, by: QPointF) -> None:
        """Seek by a horizontal drag, in pixels."""
        self._at += by.x()
        self._seek()

    def _seek(self) -> None:
        share = (self._at - self._track.x()) / max(self._track.width(), 1.0)
        self.player.seek(min(max(share, 0.0), 1.0) * self.player.duration)

    def draw(self, painter: QPainter, room: QRectF, place: Place) -> None:
        """Draw the buttons and the time line within ``room``.

        ``place`` registers the touch targets.
        """
        look, u, player = self.look, self.look.u, self.player
        box = QRectF(room.x() + 0.6 * u, room.y() + 0.5 * u, _KEY * u, room.height() - u)
        self._sign(painter, box, Tone.PAUSE if player.playing else Tone.RUN)
        place(box, player.play_or_pause)
        for word, press, lit in (
            ("×10", player.faster, player.fast),
            ("◀|", lambda: player.step(-1), False),
            ("|▶", lambda: player.step(1), False),
        ):
            box = box.translated((_KEY + 0.5) * u, 0)
            self._key(painter, box, word, lit=lit)
            place(box, press)
        if self._stock is not None:
            box = QRectF(box.right() + 0.5 * u, box.y(), _STOCK * u, box.height())
            self._key(painter, box, tr("STOCK"), lit=False, size=1.7)
            place(box, self._stock)
        left, right = box.right() + 2.2 * u, room.right() - (_WORDS + 1.0) * u
        self._track = QRectF()
        if right - left < _LEAST * u:
            return  # There is not enough room for a time line.
        self._track = QRectF(left, room.center().y() - 0.5 * u, right - left, u)
        self._line(painter)
        painter.setFont(look.font(1.7, bold=True))
        painter.setPen(look.colour("soft" if player.bound else "text"))
        words = QRectF(right + 1.6 * u, room.y(), _WORDS * u, room.height() / 2)
        put(painter, words, LEFT, _clock(player.t) + " / " + _clock(player.duration))
        shown = player.played
        if shown is not None and shown.instant.line:
            painter.setFont(look.font(1.6))
            text = tr(Message("LINE {line}", line=shown.instant.line))
            put(painter, words.translated(0, room.height() / 2 - 0.4 * u), LEFT, text)

    def _line(self, painter: QPainter) -> None:
        """Draw the track, the elapsed part, the error marks and the current position."""
        look, u, track, player = self.look, self.look.u, self._track, self.player
        length = max(player.duration, 1e-9)
        at = track.x() + track.width() * min(player.t / length, 1.0)
        painter.fillRect(track, look.colour("key"))
        painter.fillRect(
            QRectF(track.x(), track.y(), at - track.x(), track.height()),
            look.colour("off" if player.bound else "lit"),
        )
        for t in player.marks().tolist():
            mark = track.x() + track.width() * t / length
            painter.fillRect(
                QRectF(mark - 0.2 * u, track.y() - 1.0 * u, 0.4 * u, 3 * u), look.colour("alarm")
            )
        painter.setPen(look.pen("panel", 0.2))
        painter.setBrush(look.colour("text"))
        painter.drawEllipse(QPointF(at, track.center().y()), 1.3 * u, 1.3 * u)

    def _key(self, painter: QPainter, box: QRectF, word: str, *, lit: bool, size: float = 2.0) -> None:
        look = self.look
        painter.fillRect(box, look.colour("lit" if lit else "key"))
        dim = "soft" if self.player.bound else "text"
        painter.setPen(look.colour("on_lit" if lit else dim))
        painter.setFont(look.font(size, bold=True))
        put(painter, box, CENTRE, word)

    def _sign(self, painter: QPainter, box: QRectF, tone: Tone) -> None:
        look, u = self.look, self.look.u
        painter.fillRect(box, look.colour("key"))
        sign = QRectF(box.center().x() - 1.1 * u, box.center().y() - 1.1 * u, 2.2 * u, 2.2 * u)
        draw_sign(painter, sign, tone, look.colour("soft" if self.player.bound else "text"))
        painter.setBrush(Qt.BrushStyle.NoBrush)


def _clock(seconds: float) -> str:
    """Return a time as minutes and seconds."""
    minutes, rest = divmod(max(seconds, 0.0), 60.0)
    return f"{int(minutes)}:{rest:04.1f}"
