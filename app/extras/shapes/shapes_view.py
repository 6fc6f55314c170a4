"""Shapes panel in place of the editor's text: list of shapes, form and drawing."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.translation import spoken, tr
from app.extras.shapes.shape_form import COLUMNS, Cell, ShapeForm
from app.extras.shapes.shapes_model import Shapes, written_in
from app.screen.drawings import SketchPanel
from app.screen.entry_panel import KeyPad, draw_entry
from app.screen.look import CENTRE, LEFT, RIGHT, Look, Painter, width_of
from app.screen.page_base import EditorPanel, HeadKey, Host, Page
from app.screen.panel import Panel, Shown
from app.screen.sheet_panel import RowPanel
from core.extras.shapes.contour import row_word

ROW = 5.2  # units: height of a row, at least a fingertip
_LABEL = 0.56  # ratio of the width
_SHARE = 0.56  # ratio of the width for the fields
_PAD = 26.0  # units: height of the number pad, unless touch needs more
_TURN = "◂"  # sign before a choice, which is selected instead of typed and has no text cursor
_UNSAID = "?"  # sign for a required value
_SMALL = 1.6  # units: smallest font of a one-line label
_DRAWN = 12.0  # units: minimum useful height of the drawing


@dataclass(frozen=True, slots=True)
class _Line:
    """Row with a shape, a piece, a field or the ``cells`` of a point.

    ``tone`` is the color of its value.
    """

    label: str
    figure: str = ""
    tone: str = "text"
    word: str = ""
    cells: tuple[str, ...] = ()


class RowsPanel(RowPanel):
    """List with a selected row that remains visible. A touch selects a row or a cell."""

    margin = 1
    shown: Shown[tuple[_Line, ...]] = Shown(())
    marked = Shown(0)
    column = Shown(0)
    heading = Shown("")
    typing = Shown(False)

    def __init__(self, look: Look, choose: Callable[[int, int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose

    def draw(self, painter: Painter) -> None:
        self.frame(painter, self.heading)
        high, room, count = self.look.row(ROW, 9.0, touch=True), self.inside(), len(self.shown)
        room = self.scrolled(painter, room, self.fitting(room, high, count), count, self.marked)
        for number, box in self.boxes(room, high):
            self._row(painter, box, self.shown[number], number)

    def _row(self, painter: Painter, box: QRectF, line: _Line, number: int) -> None:
        u, marked = self.look.u, number == self.marked
        if marked:
            painter.fill(box, "here")
            painter.fill(QRectF(box.x(), box.y(), 0.5 * u, box.height()), "lit")
        room = box.adjusted(1.0 * u, 0, -0.4 * u, 0)
        if line.cells:
            self._cells(painter, room, line, number, marked=marked)
        else:
            self._words(painter, room, line, marked=marked)
        # The first matching touch target is used, so the row follows its cells.
        self.place(box, partial(self._choose, number, -1), kind="row", on=marked)

    def _words(self, painter: Painter, room: QRectF, line: _Line, *, marked: bool) -> None:
        label = QRectF(room.x(), room.y(), _LABEL * room.width(), room.height())
        self._label(painter, label, line, marked=marked)
        figure = QRectF(label.right(), room.y(), room.right() - label.right(), room.height())
        self._figure(painter, figure, line.figure, line.tone, marked=marked and self.typing)

    def _label(self, painter: Painter, box: QRectF, line: _Line, *, marked: bool) -> None:
        """Draw the label in two lines if one line would be too small or cut off."""
        label = tr(line.label)
        room = box.adjusted(0, 0, -0.6 * self.look.u, 0)
        cut = label.rfind(" ", 0, 2 + len(label) // 2 + 1)
        wide = width_of(label, self.look.font(_SMALL, bold=marked))
        parts = [label[:cut], label[cut + 1 :]] if wide > room.width() and cut > 0 else [label]
        high = min(room.height() / len(parts), 2.6 * self.look.u) if len(parts) > 1 else room.height()
        top = room.center().y() - high * len(parts) / 2
        for place, part in enumerate(parts):
            at = QRectF(room.x(), top + place * high, room.width(), high)
            painter.write(at, part, 1.9, "text", at=LEFT, bold=marked, raw=True)

    def _figure(self, painter: Painter, box: QRectF, figure: str, tone: str, *, marked: bool) -> None:
        u = self.look.u
        if marked:
            frame = box.adjusted(0, 0.5 * u, 0, -0.5 * u)
            painter.box(frame, "accent", 0.2, "ground")
            inside = frame.adjusted(0.6 * u, 0, -0.4 * u, 0)
            shown = "" if figure == _UNSAID else figure
            draw_entry(painter, inside, shown, size=2.2, cursor=not figure.startswith(_TURN))
        else:
            painter.write(box, figure, 2.1, tone, at=RIGHT, raw=True, bold=tone != "soft")

    def _cells(self, painter: Painter, room: QRectF, line: _Line, number: int, *, marked: bool) -> None:
        """Draw the number and the values of a point."""
        u = self.look.u
        first = QRectF(room.x(), room.y(), 2.4 * u, room.height())
        painter.write(first, line.label, 1.8, line.tone if line.tone == "alarm" else "soft", raw=True)
        wide = (room.width() - first.width()) / len(line.cells)
        for column, figure in enumerate(line.cells):
            box = QRectF(first.right() + column * wide, room.y(), wide, room.height())
            here = marked and column == self.column
            self.place(box, partial(self._choose, number, column), COLUMNS[column], kind="row", on=here)
            inner = box.adjusted(0.2 * u, 0, -0.2 * u, 0)
            if figure or here:
                self._figure(painter, inner, figure, line.tone, marked=here and self.typing)
            elif marked:  # the columns that can be typed
                painter.write(inner, COLUMNS[column], 1.7, "soft", at=CENTRE, raw=True, bold=False)


class LinesPanel(Panel):
    """Lines that the form writes, or its error."""

    title = "LINES"
    lines: Shown[tuple[str, ...]] = Shown(())
    trouble = Shown("")
    words: Shown[tuple[str, ...]] = Shown(())

    _page: Shown[int] = Shown(0)  # displayed page of remarks that are longer than the panel

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Show the next page of long remarks. The first page follows the last."""
        self._page += 1
        event.accept()

    def draw(self, painter: Painter) -> None:
        room, u = self.inside(), self.look.u
        high = 2.5 * u
        if self.trouble:
            self._trouble(painter, room)
            return
        room = self._say(painter, room)
        many = int(room.height() / high)  # 0 if the remarks fill the panel
        for place, line in enumerate(self.lines[:many]):
            more = place == many - 1 and len(self.lines) > many
            box = QRectF(room.x(), room.y() + place * high, room.width(), high)
            painter.write(
                box,
                f"… +{len(self.lines) - place}" if more else line,
                1.8,
                "text",
                raw=True,
                bold=False,
                fit=False,
            )

    def _say(self, painter: Painter, room: QRectF) -> QRectF:
        """Draw the remarks above the lines and return the remaining area."""
        if not self.words:
            return room
        painter.setFont(self.look.font(1.8, bold=True))
        painter.setPen(self.look.colour("text"))
        text = "\n".join(tr(each) for each in self.words)
        flags = Qt.TextFlag.TextWordWrap | Qt.AlignmentFlag.AlignTop
        used = painter.boundingRect(room, flags, text)
        if used.height() <= room.height():
            painter.wrap(room, flags, text)
            return room.adjusted(0, used.height() + self.look.u, 0, 0)
        self._say_page(painter, room, flags, text)
        return room.adjusted(0, room.height(), 0, 0)

    def _say_page(self, painter: Painter, room: QRectF, flags: Qt.TextFlag, text: str) -> None:
        """Draw one page of the remarks with whole lines, and the page number below."""
        line = painter.fontMetrics().lineSpacing()
        lines = max(1, int((room.height() - 2.0 * self.look.u) / line))
        whole = painter.boundingRect(QRectF(0, 0, room.width(), 0), flags, text).height()
        pages = math.ceil(whole / (lines * line))
        page = self._page % pages
        painter.save()
        painter.setClipRect(QRectF(room.x(), room.y(), room.width(), lines * line))
        painter.wrap(room.adjusted(0, -page * lines * line, 0, whole), flags, text)
        painter.restore()
        foot = QRectF(room.x(), room.bottom() - 2.0 * self.look.u, room.width(), 2.0 * self.look.u)
        painter.write(foot, f"{page + 1}/{pages} ▸", 1.7, "accent", at=RIGHT, raw=True)

    def _trouble(self, painter: Painter, room: QRectF) -> None:
        painter.setFont(self.look.font(2.0, bold=True))
        painter.setPen(self.look.colour("alarm"))
        painter.wrap(room, Qt.TextFlag.TextWordWrap, tr(self.trouble))


class ShapesView(EditorPanel):
    """Shapes panel: rows on the left, drawing and lines on the right.

    The number pad replaces the lines.
    """

    part_name = "SHAPES"
    KEYS = ("Shapes", "Calculators")
    model: Shapes

    def __init__(self, host: Host, page: Page) -> None:
        super().__init__(host, page)
        look, model = host.look, _shapes_of(host.desk)
        self.look, self.model = look, model
        self.rows = RowsPanel(look, self._choose, self)
        self.sketch = SketchPanel(look, model.touch, model.touch_at, self)
        self.lines = LinesPanel(look, self)
        self.pad = KeyPad(look, page.touched, own=None, parent=self)
        self._seen: tuple[object, ...] = ()

    def head_keys(self, name: str) -> Sequence[HeadKey]:
        """Return the keys for shapes, if the program supports them, and for calculators."""
        calculators = HeadKey(tr("CALCULATOR ⇧F4"), "Calculators")
        return (HeadKey(tr("SHAPES ⇧F3"), "Shapes"), calculators) if written_in(name) else (calculators,)

    def open_at(self, key: str, name: str, text: str, line: int) -> str:
        """Open the shapes or the calculators."""
        return self.model.open(name, text, line, helpers=key == "Calculators")

    def refresh(self) -> None:
        """Update the panel if the model has changed; called once per frame."""
        model = self.model
        form = model.form
        now: tuple[object, ...] = (
            form is None,
            model.of_shapes,
            tuple(model.listed),
            model.marked,
            model.number,
            model.written,
            model.padded,
            spoken(),
        )
        if form is not None:
            now = (*now, id(form), form.marked, form.column, form.worked)
        if now == self._seen:
            return
        self._seen = now
        self.rows.typing = form is not None
        if form is None:
            self._show_list()
        else:
            self._show_form(form)
        self.lines.setVisible(not model.padded)
        self.pad.setVisible(model.padded)
        self.sketch.setVisible(True)  # hidden later if the pad needs the space
        self.lay_out()

    def _show_list(self) -> None:
        model = self.model
        table, keys = model.table, model.keys_of_list
        shapes = [_Line(f"{key}   {tr(table[key].name)}", "", word=key) for key in keys]
        there = [
            _Line(each.filled.shape.name, f"{each.first + 1}", "alarm" if each.foreign >= 0 else "text")
            for each in model.listed
        ]
        self.rows.heading = tr(
            "SHAPES  ·  IN THIS PROGRAM, BY LINE" if model.of_shapes else "CALCULATORS AND TEMPLATES"
        )
        self.rows.shown, self.rows.marked, self.rows.column = (*shapes, *there), model.marked, 0
        place = model.marked
        shape = table[keys[place]] if place < len(keys) else model.listed[place - len(keys)].filled.shape
        form = ShapeForm(shape, model.new)
        self.sketch.shown = shape.sketch(form.one), (), "", frozenset()
        self.lines.trouble, self.lines.lines, self.lines.words = "", (), (shape.use,)

    def _show_form(self, form: ShapeForm) -> None:
        lines = [_line_of(cell) for cell in form.cells()]
        if form.shape.contour:
            lines += [_point(form, number) for number in range(len(form.rows) + 1)]
        self.rows.heading = tr(form.shape.name) + (
            "" if form.instead is None else f"  ·  {form.instead.first + 1}"
        )
        self.rows.shown, self.rows.marked, self.rows.column = tuple(lines), form.marked, form.column
        drawn = form.sketch
        figures = tuple((dim.word, form.dimension(dim.word)) for dim in drawn.dims)
        self.sketch.shown = drawn, figures, form.word, frozenset(form.troubles)
        self.lines.trouble, self.lines.lines = form.trouble, tuple(form.lines)
        self.lines.words = form.words

    def _choose(self, row: int, column: int) -> None:
        model = self.model
        form = model.form
        if form is None:
            if row == model.marked:
                model.open_marked()
            else:
                model.choose(row)
        elif row < len(form.fields):
            model.touch(form.fields[row].word)
        else:
            model.touch_cell(row - len(form.fields), max(0, column))

    def sizeHint(self) -> QSize:
        """Return an empty size, because the page determines the size."""
        return QSize()

    def lay_out(self) -> None:
        """Arrange all parts."""
        u = self.look.u
        gap, left = max(4, round(0.7 * u)), round(_SHARE * self.width())
        right, x = self.width() - left - gap, left + gap
        low = self._pad_height() if self.model.padded else round(0.4 * self.height())
        self.rows.setGeometry(0, 0, left, self.height())
        self.sketch.setGeometry(x, 0, right, self.height() - low - gap)
        for part in (self.lines, self.pad):
            part.setGeometry(x, self.height() - low, right, low)

    def _pad_height(self) -> int:
        """Return the height of the pad.

        The drawing is hidden if its remaining height is too small.
        """
        high = max(self.pad.least, round(min(_PAD * self.look.u, 0.6 * self.height())))
        drawn = self.height() - high >= _DRAWN * self.look.u
        self.sketch.setVisible(drawn)
        return high if drawn else self.height()

    def resizeEvent(self, _event: object) -> None:
        """Lay out the panel again after a change of size."""
        self.lay_out()


def _shapes_of(desk: Desk) -> Shapes:
    """Return the shapes model of TurnDesk, or a new one without machine data."""
    found = desk.pages.find(Shapes)
    if found is None:
        found = Shapes()
        desk.pages.attach(found)
    return found


def _line_of(cell: Cell) -> _Line:
    tone = "alarm" if cell.trouble else "text" if cell.typed else "soft"
    figure = cell.figure or (_UNSAID if cell.trouble else "")
    return _Line(
        cell.label, f"{_TURN} {figure} ▸" if cell.choice and figure != _UNSAID else figure, tone, cell.word
    )


def _point(form: ShapeForm, number: int) -> _Line:
    said = form.rows[number] if number < len(form.rows) else {}
    word = row_word(number + 1)
    cells = tuple(said.get(column, "") for column in COLUMNS)
    return _Line(f"{number + 1}", "", "alarm" if word in form.troubles else "text", word, cells)
