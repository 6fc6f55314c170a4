"""A row of words to touch, one of them chosen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter

from app.screen.look import CENTRE, LEFT, Look, put

NAME = 8.4  # units: width of the row's name
SHORT = 4  # letters: a longer word gets a wider tile


@dataclass(frozen=True, slots=True)
class Tiles:
    """``name`` and the key that goes through the row; ``warn`` and ``alarmed`` colour what stands out."""

    name: tuple[str, str]
    words: tuple[str, ...]
    presses: Sequence[Callable[[], None]]
    chosen: int = -1
    warn: bool = False
    alarmed: frozenset[int] = frozenset()


def draw_tiles(
    painter: QPainter, look: Look, row: QRectF, tiles: Tiles
) -> list[tuple[QRectF, Callable[[], None]]]:
    """Draw the row; where each of its tiles stands and what it does."""
    u, left = look.u, row.x()
    if tiles.name[0]:
        left += NAME * u
        _name(painter, look, QRectF(row.x(), row.y(), (NAME - 0.6) * u, row.height()), tiles.name)
    shares = [1.0 + 0.11 * max(0, len(word) - SHORT) for word in tiles.words]
    part = (row.right() - left + 0.6 * u) / sum(shares)
    boxes = []
    for number, (word, share) in enumerate(zip(tiles.words, shares, strict=True)):
        box = QRectF(left, row.y(), share * part - 0.6 * u, row.height())
        left += share * part
        _tile(painter, look, box, word, tiles, number)
        boxes.append(box)
    return list(zip(boxes, tiles.presses, strict=True))


def _name(painter: QPainter, look: Look, box: QRectF, name: tuple[str, str]) -> None:
    half = box.height() / 2
    painter.setPen(look.colour("soft"))
    painter.setFont(look.fit(name[0], 1.5, box.width(), bold=True))
    put(painter, QRectF(box.x(), box.y(), box.width(), half), LEFT, name[0])
    painter.setPen(look.colour("accent"))
    painter.setFont(look.font(1.6, bold=True))
    put(painter, QRectF(box.x(), box.y() + half, box.width(), half), LEFT, name[1])


def _tile(painter: QPainter, look: Look, box: QRectF, word: str, tiles: Tiles, number: int) -> None:
    """Filled when it is chosen, and in the colour of a warning when that has to be seen."""
    ink, ground, line = "text", "key", "frame"
    if number in tiles.alarmed:
        ink = line = "alarm"
    if number == tiles.chosen:
        ground = line = "pause" if tiles.warn else "lit"
        ink = "on_state" if tiles.warn else "on_lit"
    painter.setPen(look.pen(line, 0.16))
    painter.setBrush(look.colour(ground))
    painter.drawRect(box)
    painter.setPen(look.colour(ink))
    painter.setFont(look.fit(word, 2.1, box.width() - 0.8 * look.u, bold=True))
    put(painter, box, CENTRE, word)
