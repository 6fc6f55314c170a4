"""Panels with rows: a scrolling list, and a table with a head line, notes and an entry line; their page."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Protocol

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPolygonF, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.sheet import Key, Row, Sheet
from app.screen import page_table
from app.screen.entry_panel import draw_entry_box
from app.screen.look import LEFT, RIGHT, Look, Painter
from app.screen.page_base import Host, ModelPage, PageModel
from app.screen.panel import Panel, Shown
from app.screen.window_layout import FINGER

KEY = 5.0  # Units: size of the two scroll keys, at least a fingertip.
NARROW = 50.0  # Units: a narrower list uses its full width for rows.


class RowPanel(Panel):
    """A list of rows of equal height.

    A subclass gets the rectangle for its rows from ``scrolled``, and each visible row from ``boxes``. The
    selected row stays visible when the selection or the size changes. Scrolling does not move the selection,
    except in a ``centred`` list.
    """

    lists = True
    notch = 3  # Rows that one notch of the wheel scrolls.
    margin = 0  # Rows that remain visible on both sides of the selection.
    centred = False  # The selection is in the middle, and ``scroll_by`` of the subclass moves it.
    keyed = True  # Two scroll keys are drawn if not all rows fit.

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.top = 0  # Index of the first visible row.
        self.rows = 1  # Number of rows that fit.
        self._count = 0
        # Selection and number of visible rows when the list last followed the selection.
        self._followed = (-1, 0)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Scroll by ``notch`` rows for each notch of the wheel."""
        self.scroll_by(-round(event.angleDelta().y() * self.notch / 120))

    def scroll_by(self, rows: int) -> None:
        """Scroll down by a number of rows. A negative number scrolls up."""
        self.top = self._limited(self.top + rows)
        self.update()

    def _limited(self, top: int) -> int:
        return max(0, min(top, self._count - self.rows))

    def scrolled(self, painter: Painter, room: QRectF, fits: int, count: int, marked: int = -1) -> QRectF:
        """Draw the scroll keys if ``count`` rows do not fit, and return the rectangle for the rows.

        ``fits`` is the number of rows that fit. ``marked`` is the index of the selected row, or -1.
        """
        self.rows, self._count = fits, count
        if self.centred:
            self.top = marked - fits // 2
        elif (marked, fits) != self._followed and marked >= 0 and fits:
            lowest, highest = marked - fits + 1 + self.margin, max(0, marked - self.margin)
            self.top = min(max(self.top, lowest), highest)
        self._followed = (marked, fits)
        self.top = self._limited(self.top)
        return self._with_keys(painter, room) if self.keyed and 0 < fits < count else room

    def boxes(self, room: QRectF, high: float) -> Iterator[tuple[int, QRectF]]:
        """Yield the index and box of each visible row. ``high`` is the height of a row in pixels."""
        for number in range(self.top, min(self._count, self.top + self.rows)):
            yield number, QRectF(room.x(), room.y() + (number - self.top) * high, room.width(), high)

    def fitting(self, room: QRectF, high: float, count: int) -> int:
        """Return how many rows of this height fit, at least one.

        The scroll keys of a narrow list are below its rows and use some of the height.
        """
        fits = int(room.height() / high)
        if self.keyed and fits < count and self.is_narrow(room.width()):
            fits = int((room.height() - self.key_size[1] - 0.6 * self.look.u) / high)
        return max(1, fits)

    @property
    def key_size(self) -> tuple[float, float]:
        """The width and minimum height of a scroll key in pixels."""
        size = max(KEY * self.look.u, float(FINGER))
        return size, size

    def is_narrow(self, width: float) -> bool:
        """Return whether a list of this width has its scroll keys below the rows, not to their right."""
        return width < NARROW * self.look.u

    def _with_keys(self, painter: Painter, room: QRectF) -> QRectF:
        """Draw the scroll keys and the scroll bar, and return the rectangle that remains for the rows.

        The keys are at the right, or below the rows of a narrow list. They are side by side if there is
        little height.
        """
        gap, (wide, high) = 0.6 * self.look.u, self.key_size
        foot = self.is_narrow(room.width())
        beside = foot or room.height() < 2 * high + gap
        strip = QRectF(room.right() - wide - beside * (wide + gap), room.y(), wide, room.height())
        if foot:
            wide = (room.width() - gap) / 2
            strip = QRectF(room.x(), room.bottom() - high, wide, high)
        right, down = (wide + gap, 0.0) if beside else (0.0, (strip.height() + gap) / 2)
        for number, sign in enumerate((-1, 1)):
            box = QRectF(strip.x(), strip.y(), wide, strip.height() if beside else down - gap)
            self._scroll_key(painter, box.translated(number * right, number * down), sign)
        left = room.adjusted(0, 0, -2 * gap, -high - gap)
        if not foot:
            left = room.adjusted(0, 0, strip.x() - 2 * gap - room.right(), 0)
        self._scroll_bar(painter, QRectF(left.right() + gap, left.y(), 0.6 * gap, left.height()))
        return left

    def _scroll_key(self, painter: Painter, box: QRectF, sign: int) -> None:
        at, size = box.center(), 1.2 * self.look.u
        ends = self.top <= 0 if sign < 0 else self.top + self.rows >= self._count
        painter.fill(box, "key")
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self.look.colour("ghost" if ends else "accent"))
        tip, foot = QPointF(at.x(), at.y() + sign * size), at.y() - sign * size
        painter.drawPolygon(QPolygonF([tip, QPointF(at.x() - size, foot), QPointF(at.x() + size, foot)]))
        name = "PREVIOUS ROWS" if sign < 0 else "NEXT ROWS"
        self.place(box, partial(self.scroll_by, sign * self.rows), name)

    def _scroll_bar(self, painter: Painter, track: QRectF) -> None:
        painter.fill(track, "key")
        part = QRectF(track.x(), 0, track.width(), track.height() * self.rows / self._count)
        part.moveTop(track.y() + track.height() * self.top / self._count)
        painter.fill(part, "accent")


ROW, HEAD, ASKED, NOTE = 4.0, 2.6, 5.4, 2.4  # Units.
TALL = 6.0
LAMP = 3.2
_ROUNDING = 1e-6


class SheetPanel(RowPanel):
    """A panel that draws a table. A touch selects a row. The selected row stays visible."""

    sheet = Shown(Sheet("", (), (), ()))

    def __init__(self, look: Look, choose: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose
        self.touch_entry: Callable[[], None] | None = None  # Called for a touch on the entry line.

    def show_sheet(self, sheet: Sheet) -> None:
        """Show a table, and redraw it if it has changed. A table with another title begins at its top."""
        if sheet.title.split("  ·  ")[0] != self.sheet.title.split("  ·  ")[0]:
            self.top = 0
        self.sheet = sheet

    @property
    def _high(self) -> float:
        """The height of a row in units.

        A row is at least as high as a fingertip. On a large screen, a row has at most 9 mm, or 14 mm if it is
        tall. If there are few rows, their height follows the size of the window.
        """
        own, mm = (TALL, 14.0) if self.sheet.tall else (ROW, 9.0)
        share = self._room(len(self.sheet.notes)) / max(1, len(self.sheet.rows)) - _ROUNDING
        return max(self.look.row(own, mm, touch=True) / self.look.u, min(own, share))

    def _room(self, notes: int) -> float:
        """Return the height in units that is left for rows next to a number of note lines."""
        foot = notes * NOTE + (self._asked if self.sheet.question else 0.0)
        return self.height() / self.look.u - 4.0 - HEAD - foot

    @property
    def _asked(self) -> float:
        """The height of the entry line in units, at least a fingertip if it reacts to touch."""
        return ASKED if self.touch_entry is None else max(ASKED, FINGER / self.look.u + 0.6)

    @property
    def _letters(self) -> float:
        """The scale of the letters in a row, which depends on the row's height."""
        return min(1.0, self._high / (TALL if self.sheet.tall else 4.2))

    def _fits(self) -> int:
        """Return how many rows of the table fit. 0 if the entry line needs the whole panel."""
        fits = self._fit(len(self._notes))
        if fits < len(self.sheet.rows):
            fits = self._fit(len(self._notes), self._below)
        return max(0 if self.sheet.question else 1, fits)

    def _fit(self, notes: int, below: float = 0.0) -> int:
        return int((self._room(notes) - below) / self._high)

    @property
    def _below(self) -> float:
        """The height in units of the scroll keys below the rows of a narrow table, else 0."""
        return self.key_size[1] / self.look.u + 0.6 if self.is_narrow(self.inside().width()) else 0.0

    @property
    def _notes(self) -> tuple[str, ...]:
        """The notes. Empty if the entry line and the notes would leave no room for the selected row."""
        notes = self.sheet.notes
        return () if self.sheet.question and self._fit(len(notes)) < 1 else notes

    def draw(self, painter: Painter) -> None:
        u, sheet = self.look.u, self.sheet
        self.frame(painter, sheet.title)
        room, fits, high = self.inside(), self._fits(), self._high
        row = QRectF(room.x(), room.y(), room.width(), HEAD * u)
        below = self._below if fits < len(sheet.rows) else 0.0
        body = QRectF(room.x(), row.bottom(), room.width(), (fits * high + below) * u)
        left = self.scrolled(painter, body, fits, len(sheet.rows), sheet.marked)
        row.setWidth(left.width())
        self._head(painter, row)
        for number, box in self.boxes(left, high * u):
            self._row(painter, box, sheet.rows[number], number == sheet.marked)
            self.place(box, partial(self._choose, number), kind="row", on=number == sheet.marked)
        self._foot(painter, room)

    def _columns(self, box: QRectF) -> Iterator[tuple[int, QRectF]]:
        u = self.look.u
        lamp = LAMP * u if any(row.lit is not None for row in self.sheet.rows) else 0.8 * u
        x, wide = box.x() + lamp, box.width() - lamp - 0.6 * u
        for number, share in enumerate(self.sheet.shares):
            yield number, QRectF(x, box.y(), share * wide - 1.0 * u, box.height())
            x += share * wide

    def _head(self, painter: Painter, box: QRectF) -> None:
        for number, at in self._columns(box):
            painter.write(at, self.sheet.heads[number], 1.6, "soft", at=self._side(number))

    def _side(self, number: int) -> Qt.AlignmentFlag:
        return RIGHT if number in self.sheet.figures else LEFT

    def _row(self, painter: Painter, box: QRectF, row: Row, marked: bool) -> None:
        u = self.look.u
        if marked:
            painter.fill(box, "here")
            painter.fill(QRectF(box.x(), box.y(), 0.5 * u, box.height()), "lit")
        if row.lit is not None:
            side = min(1.6 * u, 0.5 * box.height())
            lamp = QRectF(box.x() + 1.0 * u, box.center().y() - side / 2, side, side)
            painter.box(lamp, row.tone.value, 0.2, row.tone.value if row.lit else "")
        for number, at in self._columns(box):
            if row.bar is not None and number == len(row.cells) - 1:
                self._filled(painter, at, row)
            side, bold, raw = self._side(number), number == 0 or marked, number in self.sheet.raw
            first, two, second = row.cells[number].partition("\n")
            if two:
                half = QRectF(at.x(), at.center().y(), at.width(), 0.44 * at.height())
                painter.write(half, second, 1.8 * self._letters, "soft", at=side, bold=False, raw=raw)
                at.setTop(at.y() + 0.06 * at.height())
                at.setHeight(half.height())
            painter.write(at, first, 2.1 * self._letters, "text", at=side, bold=bold, raw=raw)
            if row.outline is not None and number == len(row.cells) - 1:
                from app.screen.drawings import draw_outline

                draw_outline(painter, at.adjusted(0, 0.2 * u, 0, -0.2 * u), row.outline, small=True)

    def _filled(self, painter: Painter, at: QRectF, row: Row) -> None:
        """Draw a bar below the text of the last cell."""
        high = 0.5 * self.look.u
        track = QRectF(at.x(), at.bottom() - 2 * high, at.width(), high)
        painter.fill(track, "key")
        track.setWidth(track.width() * min(1.0, max(0.0, row.bar or 0.0)))
        painter.fill(track, row.tone.value)

    def _foot(self, painter: Painter, room: QRectF) -> None:
        u, sheet = self.look.u, self.sheet
        notes = self._notes
        y = room.bottom() - len(notes) * NOTE * u
        for number, note in enumerate(notes):
            row = QRectF(room.x(), y + number * NOTE * u, room.width(), NOTE * u)
            painter.write(row, note, 1.8, "soft", bold=False)
        if sheet.question:
            self._ask(painter, QRectF(room.x(), y - self._asked * u, room.width(), (self._asked - 0.6) * u))

    def _ask(self, painter: Painter, row: QRectF) -> None:
        u, sheet = self.look.u, self.sheet
        asked = QRectF(row.x(), row.y(), 0.5 * row.width(), row.height())
        painter.write(asked, sheet.question, 2.2, "text", margin=1.0)
        box = QRectF(asked.right(), row.y() + 0.2 * u, row.right() - asked.right(), row.height() - 0.4 * u)
        draw_entry_box(painter, box, sheet.text, 2.6)
        if self.touch_entry is not None:
            self.place(row, self.touch_entry)


# --- a page with a list ------------------------------------------------------------------------------------


class ListModel(PageModel, Protocol):
    """Interface of a list page's model. ``escape`` returns False if only the list is shown."""

    def prompt(self) -> str: ...

    def leave(self) -> None: ...


class ListPage(ModelPage):
    """A page with a list. It passes keys to its model. Esc leads from the list to the Automatic page."""

    model: ListModel

    def __init__(self, host: Host, model: ListModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model

    def labels_of(self, own: Mapping[str, str], keys: Mapping[str, Key]) -> tuple[str, ...]:
        """Return the ten labels from the common keys, the page's ``own`` labels and the model's ``keys``."""
        named = {"F1": "MENU", "F7": "ALARMS", **own}
        named.update((name, key.label) for name, key in keys.items())
        return tuple(named.get(f"F{number}", "") for number in range(1, 11))

    def page_keys(self) -> Mapping[str, Key]:
        """Return the function keys of the model."""
        return {}

    def barred(self) -> frozenset[str]:
        """Return the function keys of the model that are disabled now."""
        return frozenset(name for name, key in self.page_keys().items() if key.barred)

    def prompt(self) -> str:
        """Return the prompt of the model."""
        return self.model.prompt()

    def leave(self) -> bool:
        """Cancel unfinished entries and questions, and let the page close."""
        self.desk.clear()
        self.model.leave()
        return True

    def esc_holds(self) -> bool:
        """Return False, because Esc goes one step back even while the machine moves."""
        return False

    def escape(self) -> bool:
        """Go one step back, or from the list to the Automatic page."""
        if not self.model.escape():
            self.host.go(page_table.AUTOMATIC)
        return True
