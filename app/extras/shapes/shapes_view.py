"""Shapes panel with the list of shapes, a form and a sketch. It replaces the text in the editor."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QWidget

from app.desk.desk import Desk
from app.desk.translation import get_language, tr
from app.extras.shapes.shape_form import POINT_COLUMNS, FormCell, ShapeForm
from app.extras.shapes.shape_places import supports_shapes
from app.extras.shapes.shapes_model import ShapesModel
from app.screen.drawings import SketchPanel
from app.screen.entry_panel import NumberPad, draw_entry_text
from app.screen.page_base import EditorPanel, HeaderKey, Page, PageHost
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import (
    ALIGN_CENTER,
    ALIGN_LEFT,
    ALIGN_RIGHT,
    ScreenTheme,
    ThemedPainter,
    measure_text,
)
from app.screen.table_panel import RowPanel
from core.extras.shapes.contour import make_point_label

ROW_HEIGHT = 5.2  # units: height of a row, at least a fingertip
_LABEL = 0.56  # ratio of the width
_SHARE = 0.56  # ratio of the width for the fields
_PAD = 26.0  # units: height of the number pad, unless touch needs more
_TURN = "◂"  # sign before a choice, which is selected instead of typed and has no text cursor
_UNSAID = "?"  # sign for a required value
_SMALL = 1.6  # units: smallest font of a one-line label
_DRAWN = 12.0  # units: minimum useful height of the drawing


@dataclass(frozen=True, slots=True)
class _Line:
    """Row of the shapes panel: a shape, a form field, or a contour point.

    ``point_cells`` are the values of a contour point. ``text_tone`` is the color of the value.
    """

    label: str
    value_text: str = ""
    text_tone: str = "text"
    field_name: str = ""
    point_cells: tuple[str, ...] = ()


class ShapeRowsPanel(RowPanel):
    """List of shapes or form fields that scrolls so that the selected row is always visible.

    A touch selects a row or a cell.
    """

    row_margin = 1
    displayed_rows: RedrawingAttribute[tuple[_Line, ...]] = RedrawingAttribute(())
    selected_row = RedrawingAttribute(0)
    selected_column = RedrawingAttribute(0)
    heading = RedrawingAttribute("")
    is_entry_open = RedrawingAttribute(False)

    def __init__(self, theme: ScreenTheme, select_cell: Callable[[int, int], None], parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._choose = select_cell

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the rows of the list, and scroll the list so that the selected row is visible."""
        self.frame(painter, self.heading)
        high, room, count = (
            self.theme.find_row_height(ROW_HEIGHT, 9.0, is_touchable=True),
            self.inside(),
            len(self.displayed_rows),
        )
        room = self.draw_scroll_keys(
            painter, room, self.count_fitting_rows(room, high, count), count, self.selected_row
        )
        for number, box in self.find_row_boxes(room, high):
            self._row(painter, box, self.displayed_rows[number], number)

    def _row(self, painter: ThemedPainter, box: QRectF, line: _Line, number: int) -> None:
        u, marked = self.theme.unit_px, number == self.selected_row
        if marked:
            painter.fill_rect(box, "here")
            painter.fill_rect(QRectF(box.x(), box.y(), 0.5 * u, box.height()), "lit")
        room = box.adjusted(1.0 * u, 0, -0.4 * u, 0)
        if line.point_cells:
            self._cells(painter, room, line, number, marked=marked)
        else:
            self._words(painter, room, line, marked=marked)
        # The first matching touch target is used, so the row follows its cells.
        self.add_target(box, partial(self._choose, number, -1), kind="row", is_on=marked)

    def _words(self, painter: ThemedPainter, room: QRectF, line: _Line, *, marked: bool) -> None:
        label = QRectF(room.x(), room.y(), _LABEL * room.width(), room.height())
        self._label(painter, label, line, marked=marked)
        figure = QRectF(label.right(), room.y(), room.right() - label.right(), room.height())
        self._figure(painter, figure, line.value_text, line.text_tone, marked=marked and self.is_entry_open)

    def _label(self, painter: ThemedPainter, box: QRectF, line: _Line, *, marked: bool) -> None:
        """Draw the label of a row, in two lines if it does not fit in one line."""
        label = tr(line.label)
        room = box.adjusted(0, 0, -0.6 * self.theme.unit_px, 0)
        cut = label.rfind(" ", 0, 2 + len(label) // 2 + 1)
        wide = measure_text(label, self.theme.make_font(_SMALL, is_bold=marked))
        parts = [label[:cut], label[cut + 1 :]] if wide > room.width() and cut > 0 else [label]
        high = min(room.height() / len(parts), 2.6 * self.theme.unit_px) if len(parts) > 1 else room.height()
        top = room.center().y() - high * len(parts) / 2
        for place, part in enumerate(parts):
            at = QRectF(room.x(), top + place * high, room.width(), high)
            painter.draw_text_line(at, part, 1.9, "text", at=ALIGN_LEFT, bold=marked, raw=True)

    def _figure(self, painter: ThemedPainter, box: QRectF, figure: str, tone: str, *, marked: bool) -> None:
        u = self.theme.unit_px
        if marked:
            frame = box.adjusted(0, 0.5 * u, 0, -0.5 * u)
            painter.draw_box(frame, "accent", 0.2, "ground")
            inside = frame.adjusted(0.6 * u, 0, -0.4 * u, 0)
            shown = "" if figure == _UNSAID else figure
            draw_entry_text(painter, inside, shown, height_units=2.2, has_cursor=not figure.startswith(_TURN))
        else:
            painter.draw_text_line(box, figure, 2.1, tone, at=ALIGN_RIGHT, raw=True, bold=tone != "soft")

    def _cells(self, painter: ThemedPainter, area: QRectF, line: _Line, number: int, *, marked: bool) -> None:
        """Draw the number and the values of one contour point."""
        u = self.theme.unit_px
        first = QRectF(area.x(), area.y(), 2.4 * u, area.height())
        painter.draw_text_line(
            first, line.label, 1.8, line.text_tone if line.text_tone == "alarm" else "soft", raw=True
        )
        wide = (area.width() - first.width()) / len(line.point_cells)
        for column, figure in enumerate(line.point_cells):
            box = QRectF(first.right() + column * wide, area.y(), wide, area.height())
            here = marked and column == self.selected_column
            self.add_target(
                box, partial(self._choose, number, column), POINT_COLUMNS[column], kind="row", is_on=here
            )
            inner = box.adjusted(0.2 * u, 0, -0.2 * u, 0)
            if figure or here:
                self._figure(painter, inner, figure, line.text_tone, marked=here and self.is_entry_open)
            elif marked:  # the columns that can be typed
                painter.draw_text_line(
                    inner, POINT_COLUMNS[column], 1.7, "soft", at=ALIGN_CENTER, raw=True, bold=False
                )


class ShapeLinesPanel(Panel):
    """Panel with the program lines that the form writes, or with the error of the form."""

    title = "LINES"
    displayed_lines: RedrawingAttribute[tuple[str, ...]] = RedrawingAttribute(())
    error_text = RedrawingAttribute("")
    remarks: RedrawingAttribute[tuple[str, ...]] = RedrawingAttribute(())

    _page: RedrawingAttribute[int] = RedrawingAttribute(
        0
    )  # displayed page of remarks that are longer than the panel

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Show the next page of long remarks, or the first page again after the last page."""
        self._page += 1
        event.accept()

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the remarks and the program lines, or the error of the form.

        If the panel is too small for all lines, its last row shows the number of lines that do not fit.
        """
        room, u = self.inside(), self.theme.unit_px
        high = 2.5 * u
        if self.error_text:
            self._trouble(painter, room)
            return
        room = self._draw_remarks(painter, room)
        many = int(room.height() / high)  # 0 if the remarks fill the panel
        for place, line in enumerate(self.displayed_lines[:many]):
            more = place == many - 1 and len(self.displayed_lines) > many
            box = QRectF(room.x(), room.y() + place * high, room.width(), high)
            painter.draw_text_line(
                box,
                f"… +{len(self.displayed_lines) - place}" if more else line,
                1.8,
                "text",
                raw=True,
                bold=False,
                fit=False,
            )

    def _draw_remarks(self, painter: ThemedPainter, area: QRectF) -> QRectF:
        """Draw the remarks above the program lines, and return the remaining area."""
        if not self.remarks:
            return area
        painter.setFont(self.theme.make_font(1.8, is_bold=True))
        painter.setPen(self.theme.get_color("text"))
        text = "\n".join(tr(each) for each in self.remarks)
        flags = Qt.TextFlag.TextWordWrap | Qt.AlignmentFlag.AlignTop
        used = painter.boundingRect(area, flags, text)
        if used.height() <= area.height():
            painter.draw_wrapped_text(area, flags, text)
            return area.adjusted(0, used.height() + self.theme.unit_px, 0, 0)
        self._draw_remark_page(painter, area, flags, text)
        return area.adjusted(0, area.height(), 0, 0)

    def _draw_remark_page(self, painter: ThemedPainter, area: QRectF, flags: Qt.TextFlag, text: str) -> None:
        """Draw one page of the remarks with the page number below. The page contains only whole lines."""
        line = painter.fontMetrics().lineSpacing()
        lines = max(1, int((area.height() - 2.0 * self.theme.unit_px) / line))
        whole = painter.boundingRect(QRectF(0, 0, area.width(), 0), flags, text).height()
        pages = math.ceil(whole / (lines * line))
        page = self._page % pages
        painter.save()
        painter.setClipRect(QRectF(area.x(), area.y(), area.width(), lines * line))
        painter.draw_wrapped_text(area.adjusted(0, -page * lines * line, 0, whole), flags, text)
        painter.restore()
        foot = QRectF(
            area.x(), area.bottom() - 2.0 * self.theme.unit_px, area.width(), 2.0 * self.theme.unit_px
        )
        painter.draw_text_line(foot, f"{page + 1}/{pages} ▸", 1.7, "accent", at=ALIGN_RIGHT, raw=True)

    def _trouble(self, painter: ThemedPainter, room: QRectF) -> None:
        painter.setFont(self.theme.make_font(2.0, is_bold=True))
        painter.setPen(self.theme.get_color("alarm"))
        painter.draw_wrapped_text(room, Qt.TextFlag.TextWordWrap, tr(self.error_text))


class ShapesView(EditorPanel):
    """Shapes panel with the rows on the left, and the sketch and the program lines on the right.

    While the number pad is shown, it replaces the program lines.
    """

    accessible_name = "SHAPES"
    KEYS = ("Shapes", "Calculators")
    model: ShapesModel

    def __init__(self, host: PageHost, editor_page: Page) -> None:
        super().__init__(host, editor_page)
        look, model = host.theme, _find_shapes_model(host.desk)
        self.theme, self.model = look, model
        self.rows_panel = ShapeRowsPanel(look, self._choose, self)
        self.sketch_panel = SketchPanel(look, model.select_touched_field, model.handle_touch, self)
        self.lines_panel = ShapeLinesPanel(look, self)
        self.number_pad = NumberPad(look, editor_page.handle_touched_key, page_key=None, parent=self)
        self._seen: tuple[object, ...] = ()

    def make_header_keys(self, program_name: str) -> Sequence[HeaderKey]:
        """Return the header keys that open the calculators and, if the program supports them, the shapes."""
        calculators = HeaderKey(tr("CALCULATOR ⇧F4"), "Calculators")
        return (
            (HeaderKey(tr("SHAPES ⇧F3"), "Shapes"), calculators)
            if supports_shapes(program_name)
            else (calculators,)
        )

    def open_for_text(self, key_name: str, program_name: str, text: str, line_number: int) -> str:
        """Open the list of shapes, or the list of calculators if ``key_name`` is Calculators.

        Returns an empty string, or the reason if the list cannot be opened.
        """
        return self.model.open_program_text(
            program_name, text, line_number, lists_helpers=key_name == "Calculators"
        )

    def needs_height(self) -> bool:
        """Return whether the number pad is shown."""
        return self.isVisible() and self.model.is_number_pad_visible

    def refresh(self) -> None:
        """Update the panel if the model has changed.

        This method is called once per frame.
        """
        model = self.model
        form = model.form
        now: tuple[object, ...] = (
            form is None,
            model.is_listing_shapes,
            tuple(model.listed_pieces),
            model.selected_row,
            model.text_number,
            model.write_count,
            model.is_number_pad_visible,
            get_language(),
        )
        if form is not None:
            now = (*now, id(form), form.selected_row, form.selected_column, form.calculation_count)
        if now == self._seen:
            return
        self._seen = now
        self.rows_panel.is_entry_open = form is not None
        if form is None:
            self._show_list()
        else:
            self._show_form(form)
        self.lines_panel.setVisible(not model.is_number_pad_visible)
        self.number_pad.setVisible(model.is_number_pad_visible)
        self.sketch_panel.setVisible(True)  # hidden later if the pad needs the space
        self.lay_out()

    def _show_list(self) -> None:
        model = self.model
        table, keys = model.shape_table, model.form_keys
        shapes = [_Line(f"{key}   {tr(table[key].name)}", "", field_name=key) for key in keys]
        there = [
            _Line(
                each.shape_instance.shape.name,
                f"{each.first_line + 1}",
                "alarm" if each.edited_line >= 0 else "text",
            )
            for each in model.listed_pieces
        ]
        self.rows_panel.heading = tr(
            "SHAPES  ·  IN THIS PROGRAM, BY LINE" if model.is_listing_shapes else "CALCULATORS AND TEMPLATES"
        )
        self.rows_panel.displayed_rows, self.rows_panel.selected_row, self.rows_panel.selected_column = (
            (*shapes, *there),
            model.selected_row,
            0,
        )
        place = model.selected_row
        shape = (
            table[keys[place]]
            if place < len(keys)
            else model.listed_pieces[place - len(keys)].shape_instance.shape
        )
        form = ShapeForm(shape, model.initial_settings)
        self.sketch_panel.displayed_sketch = shape.make_sketch(form.filled_shape), (), "", frozenset()
        self.lines_panel.error_text, self.lines_panel.displayed_lines, self.lines_panel.remarks = (
            "",
            (),
            (shape.summary,),
        )

    def _show_form(self, form: ShapeForm) -> None:
        lines = [_line_of(cell) for cell in form.make_cells()]
        if form.shape.has_point_table:
            lines += [_point(form, number) for number in range(len(form.point_texts) + 1)]
        self.rows_panel.heading = tr(form.shape.name) + (
            "" if form.replaced_piece is None else f"  ·  {form.replaced_piece.first_line + 1}"
        )
        self.rows_panel.displayed_rows, self.rows_panel.selected_row, self.rows_panel.selected_column = (
            tuple(lines),
            form.selected_row,
            form.selected_column,
        )
        drawn = form.current_sketch
        labels = tuple(
            (dim.field_label, form.get_dimension_text(dim.field_label)) for dim in drawn.dimensions
        )
        self.sketch_panel.displayed_sketch = (
            drawn,
            labels,
            form.selected_field_name,
            frozenset(form.error_texts),
        )
        self.lines_panel.error_text, self.lines_panel.displayed_lines = (
            form.current_error,
            tuple(form.program_lines),
        )
        self.lines_panel.remarks = form.remarks

    def _choose(self, row: int, column: int) -> None:
        model = self.model
        form = model.form
        if form is None:
            if row == model.selected_row:
                model.open_selected_row()
            else:
                model.select_row(row)
        elif row < len(form.fields):
            model.select_touched_field(form.fields[row].name)
        else:
            model.select_touched_cell(row - len(form.fields), max(0, column))

    def sizeHint(self) -> QSize:
        """Return an empty size, because the editor page determines the size of the panel."""
        return QSize()

    def lay_out(self) -> None:
        """Arrange all areas of the shapes panel."""
        u = self.theme.unit_px
        gap, left = max(4, round(0.7 * u)), round(_SHARE * self.width())
        right, x = self.width() - left - gap, left + gap
        low = self._pad_height() if self.model.is_number_pad_visible else round(0.4 * self.height())
        self.rows_panel.setGeometry(0, 0, left, self.height())
        self.sketch_panel.setGeometry(x, 0, right, self.height() - low - gap)
        for part in (self.lines_panel, self.number_pad):
            part.setGeometry(x, self.height() - low, right, low)

    def _pad_height(self) -> int:
        """Return the height of the number pad in pixels.

        The sketch is hidden if the remaining height is too small for it.
        """
        high = max(self.number_pad.min_height_px, round(min(_PAD * self.theme.unit_px, 0.6 * self.height())))
        drawn = self.height() - high >= _DRAWN * self.theme.unit_px
        self.sketch_panel.setVisible(drawn)
        return high if drawn else self.height()

    def resizeEvent(self, _event: object) -> None:
        """Arrange the areas of the panel again after it is resized."""
        self.lay_out()


def _find_shapes_model(desk: Desk) -> ShapesModel:
    """Return the shapes model of TurnDesk. If it is missing, attach a new model without machine data."""
    found = desk.page_registry.find_model(ShapesModel)
    if found is None:
        found = ShapesModel()
        desk.page_registry.attach_model(found)
    return found


def _line_of(cell: FormCell) -> _Line:
    tone = "alarm" if cell.error_text else "text" if cell.is_typed else "soft"
    figure = cell.value_text or (_UNSAID if cell.error_text else "")
    return _Line(
        cell.label,
        f"{_TURN} {figure} ▸" if cell.is_choice and figure != _UNSAID else figure,
        tone,
        cell.field_name,
    )


def _point(form: ShapeForm, number: int) -> _Line:
    said = form.point_texts[number] if number < len(form.point_texts) else {}
    word = make_point_label(number + 1)
    cells = tuple(said.get(column, "") for column in POINT_COLUMNS)
    return _Line(f"{number + 1}", "", "alarm" if word in form.error_texts else "text", word, cells)
