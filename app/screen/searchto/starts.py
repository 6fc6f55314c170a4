"""What will start, how the tool comes in, and what is still to be confirmed."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QWidget

from app.desk.words import tr
from app.screen.look import LEFT, Look, put
from app.screen.panel import Panel

ROW = 2.7  # units
ACROSS = 40  # characters of a line of trouble


class StartsPanel(Panel):
    """``choices`` are told with their keys; ``trouble`` keeps it from starting, or has to be looked at."""

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.starts: tuple[str, ...] = ()
        self.choices: tuple[str, ...] = ()
        self.trouble = ""
        self.confirmed = False

    def show_starts(
        self, starts: Sequence[str], choices: Sequence[str], trouble: str, confirmed: bool
    ) -> None:
        """The list of this instant."""
        shown = (tuple(starts), tuple(choices), trouble, confirmed)
        if shown != (self.starts, self.choices, self.trouble, self.confirmed):
            self.starts, self.choices, self.trouble, self.confirmed = shown
            self.update()

    def draw(self, painter: QPainter) -> None:
        title = tr("CONFIRMED: CYCLE START BEGINS IT") if self.confirmed else tr("WILL START")
        self.frame(painter, title, "lit" if self.confirmed else "frame", 0.3 if self.confirmed else 0.16)
        look, u, room = self.look, self.look.u, self.inside()
        lines = [(text, "text", True) for text in self.starts]
        lines += [(text, "soft", False) for text in self.choices]
        lines += [(text, "alarm", True) for text in wrap(self.trouble, ACROSS)]
        high = min(ROW * u, room.height() / max(1, len(lines)))
        for number, (text, colour, bold) in enumerate(lines):
            row = QRectF(room.x(), room.y() + number * high, room.width(), high)
            painter.setPen(look.colour(colour))
            painter.setFont(look.fit(text, min(1.9, high / u * 0.75), row.width(), bold=bold))
            put(painter, row, LEFT, text)
