"""Colour, width and style of lines by their stroke; width and style tell it without the colour."""

from __future__ import annotations

from enum import Enum

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPen

from app.desk.drawing.trail import Stroke
from app.screen.look import Look

Line = Qt.PenStyle
BAND = 0.45  # how much of a band covers what it marks


class Ink(Enum):
    """What a trail is drawn as: colour of cuts, their width in units, line style."""

    TODO = ("todo", 0.15, Line.SolidLine)
    DONE = ("done", 0.26, Line.SolidLine)
    BEFORE = ("mark", 0.16, Line.DashLine)
    AFTER = ("accent", 0.24, Line.SolidLine)
    MARKED = ("lit", 1.2, Line.SolidLine)  # a band along the blocks of the line under the cursor

    def pens(self, look: Look) -> dict[int, QPen]:
        """The pen of each stroke; two programs are compared by their cuts alone."""
        colour, width, style = self.value
        cut = _round(look.pen(colour, width), style)
        if self is Ink.MARKED:
            band = cut.color()
            band.setAlphaF(BAND)
            cut.setColor(band)
        if self in {Ink.BEFORE, Ink.AFTER}:
            return {Stroke.TURN: cut, Stroke.MILL: cut}
        rapid = _round(look.pen("rapid", 0.10), Line.SolidLine if self is Ink.DONE else Line.DashLine)
        return {Stroke.RAPID: cut if self is Ink.MARKED else rapid, Stroke.TURN: cut, Stroke.MILL: cut}

    def colours(self, look: Look) -> dict[int, QColor]:
        """The same where lines are one pixel wide."""
        return {stroke: pen.color() for stroke, pen in self.pens(look).items()}


def _round(pen: QPen, style: Qt.PenStyle) -> QPen:
    pen.setStyle(style)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return pen
