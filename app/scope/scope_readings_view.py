"""Values next to the scope's curves: color, name and value now or at both cursors."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.status import formats
from app.scope.scope_curves import Sight
from app.scope.scope_model import Scope
from app.scope.signals import Signal
from app.screen.look import CENTRE, CURVES, RIGHT, Look, Painter
from app.screen.panel import Shown
from app.screen.sheet_panel import RowPanel
from app.screen.window_layout import FINGER
from core.message import Message

_ROW = 5.6  # units: maximum height of a row
_READ = 0.1  # seconds between two updates of a live value


class Readings(RowPanel):
    """List with one row per curve. A touch selects a row."""

    title = "VALUES"
    notch = 1
    mark: Shown[object] = Shown(None)

    def __init__(self, look: Look, scope: Scope, choose: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self.scope, self._choose = scope, choose
        self.sight = Sight()
        self._known: object = None
        self.figures: tuple[tuple[str, ...], ...] = ()

    def show_sight(self, sight: Sight) -> None:
        """Show the values of a picture. Live values change at most ten times per second."""
        scope = self.scope
        latest = {each.signal.key: each.latest for each in sight.curves}
        figures = tuple(self._words(each, latest, sight) for each in scope.shown)
        times = scope.cursors.times if scope.cursors.shown else None
        known = (
            scope.marked,
            times,
            tuple(each.key for each in scope.shown),
            self.look.palette,
            sight.metric,
        )
        if sight.live and known == self._known and abs(sight.zero - self.sight.zero) < _READ:
            return
        self.sight, self._known = sight, known
        self.mark = (figures, known)
        self.figures = figures

    def _words(self, signal: Signal, latest: dict[str, float], sight: Sight) -> tuple[str, ...]:
        places = signal.quantity.places(sight.metric)
        unit = signal.quantity.unit(sight.metric)
        if signal.key in sight.at:
            a, b = sight.at[signal.key]
            return tuple(formats.fixed(value, places) for value in (a, b, b - a))
        value = latest.get(signal.key, math.nan)
        return (f"{formats.fixed(value, places)} {unit}" if math.isfinite(value) else "",)

    def scroll_by(self, rows: int) -> None:
        """Select the curve a number of rows further down. Negative numbers go up."""
        self._choose(self.scope.marked + rows)

    @property
    def high(self) -> float:
        """Height of a row in pixels, at least that of a fingertip."""
        return max(float(FINGER), _ROW * self.look.u)

    def draw(self, painter: Painter) -> None:
        room, shown = self.inside(), self.scope.shown
        u = self.look.u
        if self.scope.cursors.shown:
            room = self._between(painter, room)
        if not shown:
            row = QRectF(room.x(), room.y(), room.width(), 3 * u)
            painter.write(row, "Press F4 to select curves.", 1.8, "soft", bold=False)
            return
        fits = self.fitting(room, self.high, len(shown))
        marked = min(self.scope.marked, len(shown) - 1)
        room = self.scrolled(painter, room, fits, len(shown), marked)
        for number, row in self.boxes(room, self.high):
            box = row.adjusted(0, 0, 0, -0.4 * u)
            self._row(painter, box, number, shown[number], here=number == marked)
            self.place(box, partial(self._choose, number), kind="row", on=number == marked)

    def _between(self, painter: Painter, room: QRectF) -> QRectF:
        """Draw the time between the cursors and return the area below."""
        u, apart = self.look.u, self.scope.cursors.apart
        hertz = Message("{item} Hz", item=f"{1.0 / abs(apart):.4g}") if apart else formats.NOTHING
        row = QRectF(room.x(), room.y(), room.width(), 2.6 * u)
        painter.write(
            row,
            Message("B − A   {apart} ms", apart=formats.fixed(1000.0 * apart, 2)),
            1.8,
            "accent",
            raw=True,
        )
        row.translate(0.0, 2.6 * u)
        painter.write(row, f"1 / (B − A)   {hertz}", 1.8, "soft", raw=True)
        return room.adjusted(0, 5.8 * u, 0, 0)

    def _row(self, painter: Painter, box: QRectF, number: int, signal: Signal, *, here: bool) -> None:
        u = self.look.u
        colours = CURVES[self.look.palette.name]
        painter.fill(box, "here" if here else "key")
        patch = QRectF(box.x(), box.y(), 2.4 * u, box.height())
        painter.fillRect(patch, colours[number % len(colours)])
        painter.write(patch, str(number + 1), 1.6, "panel", at=CENTRE)
        text = box.adjusted(3.0 * u, 0.06 * box.height(), -0.4 * u, -0.06 * box.height())
        upper = QRectF(text.x(), text.y(), text.width(), 0.48 * text.height())
        painter.write(upper, signal.title, 1.7, "text", raw=True)
        lower = upper.translated(0, upper.height())
        ink = "text" if here else "soft"
        words = self.figures[number] if number < len(self.figures) else ("",)
        if len(words) == 3:
            for place, (name, word) in enumerate(zip(("A", "B", "Δ"), words, strict=True)):
                cell = QRectF(
                    lower.x() + place * lower.width() / 3,
                    lower.y(),
                    lower.width() / 3 - 0.3 * u,
                    lower.height(),
                )
                painter.write(cell, f"{name} {word}", 1.6, ink, raw=True, bold=False)
            return
        painter.write(lower, words[0], 1.9, "text", at=RIGHT, raw=True)
        if signal.note:
            painter.write(lower, signal.note, 1.5, "soft", raw=True, bold=False)
