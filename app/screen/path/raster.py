"""Many short lines at once, set pixel by pixel in numpy: a million strokes in a few dozen milliseconds.

Qt's painter draws each change of pen as a call of its own; a program that rapids between all its cuts has
as many. Here every stretch is cut to the image, stepped along its longer side, and all pixels are set in one
assignment, where the later stretch wins.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt
from PySide6.QtGui import QColor, QImage

if TYPE_CHECKING:
    from app.screen.path.plot import Frame

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]


class Shape(NamedTuple):
    """Points in pixels, with the stroke that ends in each."""

    columns: Floats
    rows: Floats
    stroke: npt.NDArray[np.uint8]


class Ends(NamedTuple):
    """Where stretches begin and end: columns and rows, pixels."""

    c0: Floats
    r0: Floats
    c1: Floats
    r1: Floats


def pixels(image: QImage) -> npt.NDArray[np.uint32]:
    """The image's own memory (rows, columns), 32 bits a pixel; valid as long as the image."""
    stride = image.bytesPerLine() // 4
    memory = np.frombuffer(image.bits(), dtype=np.uint32)
    return memory.reshape(image.height(), stride)[:, : image.width()]


def draw(image: QImage, frame: Frame, shape: Shape, inks: dict[int, QColor]) -> None:
    """Draw the stretches that end in points 1… in the ink of their stroke; those without ink are skipped."""
    table = np.zeros(256, dtype=np.uint32)
    inked = np.zeros(256, dtype=np.bool_)
    for kind, ink in inks.items():
        table[kind], inked[kind] = ink.rgb() & 0xFFFFFFFF, True
    wanted = inked[shape.stroke[1:]]
    columns, rows, strokes = shape.columns, shape.rows, shape.stroke[1:][wanted]
    ends = Ends(columns[:-1][wanted], rows[:-1][wanted], columns[1:][wanted], rows[1:][wanted])
    cut, inside = clipped(ends, frame.width - 1, frame.height - 1)
    column, row, which = stepped(cut)
    pixels(image)[row, column] = table[strokes[inside]][which]


def clipped(ends: Ends, right: int, bottom: int) -> tuple[Ends, npt.NDArray[np.bool_]]:
    """The parts of stretches within 0…right, 0…bottom, and which stretches have one (Liang and Barsky)."""
    dc, dr = ends.c1 - ends.c0, ends.r1 - ends.r0
    enter, leave = np.zeros(len(dc)), np.ones(len(dc))
    inside = np.ones(len(dc), dtype=np.bool_)
    for towards, room in ((-dc, ends.c0), (dc, right - ends.c0), (-dr, ends.r0), (dr, bottom - ends.r0)):
        along = towards == 0
        inside &= ~(along & (room < 0))
        at = np.divide(room, towards, out=np.zeros(len(dc)), where=~along)
        enter = np.where(towards < 0, np.maximum(enter, at), enter)
        leave = np.where(towards > 0, np.minimum(leave, at), leave)
    inside &= enter <= leave
    c0, r0, dc, dr, enter, leave = (a[inside] for a in (ends.c0, ends.r0, dc, dr, enter, leave))
    return Ends(c0 + enter * dc, r0 + enter * dr, c0 + leave * dc, r0 + leave * dr), inside


def stepped(ends: Ends) -> tuple[Indices, Indices, Indices]:
    """Column, row and number of the stretch of every pixel of all stretches, in their order."""
    dc, dr = ends.c1 - ends.c0, ends.r1 - ends.r0
    steps = np.ceil(np.maximum(np.abs(dc), np.abs(dr))).astype(np.int64)
    count = steps + 1
    which = np.repeat(np.arange(len(count)), count)
    first = np.repeat(np.cumsum(count) - count, count)
    share = (np.arange(len(which)) - first) / np.maximum(steps, 1)[which]
    column = np.rint(ends.c0[which] + share * dc[which]).astype(np.int64)
    row = np.rint(ends.r0[which] + share * dr[which]).astype(np.int64)
    return column, row, which
