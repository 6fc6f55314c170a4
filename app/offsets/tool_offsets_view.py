"""The pages of the tool offsets and of a tool's shape (F8), with a drawing of insert, holder and tip."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import mark_untranslated, tr
from app.offsets.offset_values import describe_missing_offset, make_field_heading, translate_field_name
from app.offsets.offsets_view import OffsetPage
from app.offsets.tool_offsets import TABLE_COLUMNS, ToolOffsetTable
from app.offsets.tool_shapes import ToolShapeTable
from app.screen import page_table
from app.screen.drawings import draw_tool_outline, draw_tool_tip
from app.screen.page_base import KeyActions, PageHost
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_LEFT, ALIGN_RIGHT, ScreenTheme, ThemedPainter
from app.screen.table_panel import RowPanel
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import Snapshot
from core.message import Message, join_messages
from core.tool_edges import format_edge_suffix, get_edge_number, get_tool_number

NUMBER_WIDTH = 5.4  # Units: width of the number column.
HEADING_HEIGHT = 3.2  # Units: height of the column heads.
# Relative widths of the other columns.
COLUMN_WIDTHS = {
    "x": 15.0,
    "z": 14.0,
    "nose_radius": 11.5,
    "quadrant": 8.6,
    "wear_x": 14.0,
    "wear_z": 13.0,
    "master": 9.6,
    "remark": 17.0,
}


class ToolOffsetPanel(RowPanel):
    """The table of the tool offsets, which is redrawn when the model changes."""

    scroll_step = 1
    is_searchable = True
    _shown: RedrawingAttribute[object] = RedrawingAttribute(())

    def __init__(self, theme: ScreenTheme, model: ToolOffsetTable, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._model = model
        self.on_cell_touched: Callable[[int, int], None] = model.select_cell
        self.on_select = model.select_row
        self._heads: dict[str, str] = {}  # Column heads by field.

    def update_rows(self) -> None:
        """Update the rows from the model."""
        model = self._model
        self._shown = (
            model.offset_book.tool_offsets,
            (model.tool_number, model.column_index, model.is_relative, model.unit_mode, model.new_edge),
            dict(model.tool_fields.incomplete_tool.known_values),
            tuple(change.number for change in model.offset_history.last_changes),
        )

    def list_row_texts(self) -> Sequence[str]:
        """Return the number and the values of each row as they are displayed."""
        model = self._model
        return [
            f"T{format_edge_suffix(number)} "
            + " ".join(model.format_cell(number, name) for name in TABLE_COLUMNS)
            for number in model.row_numbers
        ]

    @property
    def selected_row(self) -> int:
        """Return the index of the cursor's row."""
        return self._model.row_index

    def scroll_by(self, rows: int) -> None:
        """Move the cursor, and scroll so that it remains visible."""
        self._model.select_row(self._model.row_index + rows)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the column heads and the visible rows of the tool offsets.

        The title shows the unit, and whether X is a diameter or a radius. If values are relative, it also
        shows the master tool.
        """
        u, model = self.theme.unit_px, self._model
        mode = model.unit_mode
        x = tr("X IS A DIAMETER") if mode.is_diameter else tr("X IS A RADIUS")
        title: str = join_messages(
            "  ·  ", (tr("TOOL OFFSETS"), tr("MM") if mode.is_metric else tr("INCH"), x)
        )
        if model.is_relative:
            title += "  ·  " + tr(
                Message("X AND Z RELATIVE TO MASTER T{number}", number=model.offset_book.master_tool_number)
            )
        self.frame(painter, title)
        room = self.inside().adjusted(-0.7 * u, -0.2 * u, 0.7 * u, 0.5 * u)
        body = room.adjusted(0, HEADING_HEIGHT * u, 0, 0)
        count = len(model.row_numbers)
        fits = min(
            count,
            self.count_fitting_rows(body, self.theme.find_row_height(7.0, 9.0, is_touchable=True), count),
        )
        body = self.draw_scroll_keys(painter, body, fits, count, model.row_index)
        head = QRectF(body.x(), room.y(), body.width(), HEADING_HEIGHT * u)
        columns = self._make_columns(head)
        self._head(painter, head, columns)
        high = body.height() / fits
        for place, row in self.find_row_boxes(body, high):
            self._row(painter, row, place, columns)

    def _head(self, painter: ThemedPainter, head: QRectF, columns: dict[str, tuple[float, float]]) -> None:
        u, mode = self.theme.unit_px, self._model.unit_mode
        for name, (left, wide) in columns.items():
            cell = QRectF(left, head.y(), wide - 0.4 * u, head.height())
            self._heads[name] = make_field_heading(name, mode)
            painter.draw_text_line(cell, self._heads[name], 1.5, "soft", at=ALIGN_CENTER, margin=0.2)

    def _make_columns(self, area: QRectF) -> dict[str, tuple[float, float]]:
        """Return the left edge and width of each column in pixels."""
        left = area.x() + NUMBER_WIDTH * self.theme.unit_px
        part = (area.right() - left) / sum(COLUMN_WIDTHS.values())
        columns = {}
        for name in TABLE_COLUMNS:
            columns[name] = (left, COLUMN_WIDTHS[name] * part)
            left += COLUMN_WIDTHS[name] * part
        return columns

    def _row(
        self, painter: ThemedPainter, row: QRectF, place: int, columns: dict[str, tuple[float, float]]
    ) -> None:
        u, model = self.theme.unit_px, self._model
        number = model.row_numbers[place]
        here = number == model.tool_number
        if here:
            painter.fill_rect(row, "here")
        if number in {change.number for change in model.offset_history.last_changes}:
            painter.fill_rect(QRectF(row.x(), row.y(), 0.5 * u, row.height()), "lit")
        margin = QRectF(row.x(), row.y(), (NUMBER_WIDTH - 0.8) * u, row.height())
        name = f"T{number}" if number == get_tool_number(number) else f"D{get_edge_number(number)}"
        painter.draw_text_line(margin, name, 2.2 * self._find_scale(row), "accent", at=ALIGN_RIGHT)
        unset = number not in model.offset_book.tool_offsets
        for at, (field, (left, wide)) in enumerate(columns.items()):
            cell = QRectF(left, row.y(), wide, row.height())
            self._cell(painter, cell, number, field)
            if here and at == model.column_index:
                painter.draw_box(cell.adjusted(0.2 * u, 0.1 * u, -0.2 * u, -0.1 * u), "accent", 0.24, "")
            spot = cell.united(margin) if at == 0 else cell  # A touch on the number selects the row.
            words = f"{name} {self._heads[field]}"
            self.add_target(
                spot,
                partial(self.press_row, place, partial(self.on_cell_touched, number, at)),
                words,
                kind="row",
                is_on=here and at == model.column_index,
            )
        if unset and number != model.tool_fields.incomplete_tool.tool_number:
            empty = QRectF(columns["x"][0] + u, row.y(), 14 * u, row.height())
            painter.draw_text_line(
                empty,
                describe_missing_offset(is_unreadable=model.offset_book.has_read_failed),
                1.9 * self._find_scale(row),
                "soft",
                bold=False,
            )

    def _find_scale(self, row: QRectF) -> float:
        """Return the text scale that suits the height of a row."""
        return min(1.0, row.height() / (4.2 * self.theme.unit_px))

    def _cell(self, painter: ThemedPainter, cell: QRectF, number: int, name: str) -> None:
        u = self.theme.unit_px
        text = self._model.format_cell(number, name)
        room = cell.adjusted(0.8 * u, 0, -0.9 * u, 0)
        if name == "quadrant" and text:
            wide = 2.6 * u * self._find_scale(cell)
            draw_tool_tip(painter, room.adjusted(room.width() - wide, 0.2 * u, 0, -0.2 * u), int(text))
            room.setRight(room.right() - wide - 0.4 * u)
        worn = name.startswith("wear") and text.strip("+0.") == ""
        ink, at = "soft" if worn else "text", ALIGN_LEFT if name == "remark" else ALIGN_RIGHT
        painter.draw_text_line(
            room,
            text,
            2.0 * self._find_scale(cell),
            ink,
            at=at,
            bold=not worn and name != "remark",
            raw=name == "remark",
        )


class ToolOffsetsPage(OffsetPage):
    """The page of the tool offsets (F8)."""

    NAME = page_table.TOOLS
    LABELS = ("MENU", "ADD", "MASTER", "UNDO", "HISTORY", "EFFECT", "ALARMS", "SHAPE", "SECCMP", "ZERO")
    model: ToolOffsetTable
    content_panel: ToolOffsetPanel

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        super().__init__(host, parent, ToolOffsetTable(host.desk))
        self.content_panel = ToolOffsetPanel(self.theme, self.model, self)

    def find_key_refusals(self) -> dict[str, object]:
        """Return why each key is disabled, including F2 (add) and F3 (relative to master)."""
        model = self.model
        return {
            **super().find_key_refusals(),
            "F2": model.find_add_refusal(),
            "F3": model.find_relative_display_refusal(),
        }

    def make_key_actions(self) -> KeyActions:
        """Return the key actions, including F2 (add), F3 (relative to master) and F8 (tool shape)."""
        own: KeyActions = {
            "F2": self.model.add_entered_value,
            "F3": self.model.toggle_relative_display,
            "F8": partial(self._go, page_table.SHAPE),
        }
        return {**super().make_key_actions(), **own}

    def has_unfinished_entry(self) -> bool:
        """Return whether a value, a remark or a new tool must be saved or discarded first."""
        return self.model.has_entry

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram) -> None:
        """Update the table from the model."""
        super().refresh(snapshot, status, loaded)
        self.content_panel.update_rows()


FIELD_ROWS, LOW_FIELD_ROWS = 6, 4  # Fields in each of two columns, and in each of three in a low panel.
FIELDS_WIDTH_FRACTION = 0.6  # Fraction of the width for all columns.


class ToolShapePanel(Panel):
    """Panel with two columns of touchable fields, and a drawing of the tool on their right."""

    _shown: RedrawingAttribute[object] = RedrawingAttribute(())

    def __init__(self, theme: ScreenTheme, model: ToolShapeTable, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._model = model

    def update_fields(self) -> None:
        """Update the fields from the model."""
        model = self._model
        last = tuple(change.number for change in model.offset_history.last_changes)
        self._shown = (model.tool_number, model.shape_row, model.tool_row, model.name, model.unit_mode, last)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the fields of the tool shape in two columns, and the drawing of the tool on the right."""
        u, model = self.theme.unit_px, self._model
        unit = tr("MM") if model.unit_mode.is_metric else tr("INCH")
        title: str = join_messages(
            "  ·  ", (tr(Message("SHAPE OF T{number}", number=format_edge_suffix(model.tool_number))), unit)
        )
        if model.tool_row is not None and model.tool_row.remark:
            title += f"  ·  {mark_untranslated(model.tool_row.remark)}"
        self.frame(painter, title)
        room = self.inside().adjusted(-0.7 * u, 0, 0.7 * u, 0.5 * u)
        fields = QRectF(room.x(), room.y(), FIELDS_WIDTH_FRACTION * room.width(), room.height())
        rows = FIELD_ROWS if fields.height() >= FIELD_ROWS * FINGERTIP_PX else LOW_FIELD_ROWS
        columns = 2 * FIELD_ROWS // rows
        wide, high = fields.width() / columns, fields.height() / rows
        for place, name in enumerate(model.field_names):
            column, row = divmod(place, rows)
            cell = QRectF(fields.x() + column * wide, fields.y() + row * high, wide, high)
            self._draw_field(painter, cell.adjusted(0, 0, -0.5 * u, -0.5 * u), name)
            self.add_target(cell, partial(model.select_field, place))
        self._draw_picture(
            painter,
            QRectF(
                fields.right() + 0.4 * u, room.y(), room.right() - fields.right() - 0.4 * u, room.height()
            ),
        )

    def _draw_field(self, painter: ThemedPainter, cell: QRectF, name: str) -> None:
        """Draw the name of a field above its value."""
        u, model = self.theme.unit_px, self._model
        here = name == model.name
        painter.fill_rect(cell, "here" if here else "key")
        head = cell.adjusted(0.6 * u, 0, -0.6 * u, 0)
        head.setHeight(min(self.theme.find_line_height(2.2), 0.5 * cell.height()))
        painter.draw_text_line(head, make_field_heading(name, model.unit_mode), 1.5, "soft")
        wrong = name in {
            "quadrant" if each.field_name == "tip" else each.field_name for each in model.shape_mistakes
        }
        foot = QRectF(head.x(), head.bottom(), head.width(), cell.bottom() - head.bottom())
        text = model.format_field(name)
        free = name in {"insert", "holder", "profile"}
        if name == "quadrant" and text:
            side = foot.height()
            draw_tool_tip(painter, QRectF(foot.x(), foot.y(), side, side), int(text))
        painter.draw_text_line(
            foot, text or "–", 2.0, "alarm" if wrong else "text", at=ALIGN_RIGHT, bold=bool(text), raw=free
        )

    # --- drawing -------------------------------------------------------------------------------------

    def _draw_picture(self, painter: ThemedPainter, area: QRectF) -> None:
        """Draw the tool outline with X+ down, as in the path view, above the assumed values."""
        u, model = self.theme.unit_px, self._model
        words = QRectF(area.x(), area.bottom() - 2.6 * u, area.width(), 2.4 * u)
        painter.fill_rect(area, "panel")
        outline = model.tool_outline
        if model.shape_row is None:
            text = tr("TOOL SHAPE NOT DEFINED: ONLY THE TOOL NOSE IS CHECKED")
            painter.draw_text_line(area, text, 1.8, "soft", at=ALIGN_CENTER, margin=1.0)
        elif outline is None:
            painter.draw_text_line(
                area, tr("IMPOSSIBLE TOOL SHAPE"), 1.8, "alarm", at=ALIGN_CENTER, margin=1.0
            )
        else:
            draw_tool_outline(painter, area.adjusted(0, 0, 0, -2.8 * u), outline)
            if outline.assumed_fields:
                names = ", ".join(
                    translate_field_name("quadrant" if name == "tip" else name)
                    for name in outline.assumed_fields
                )
                text = tr(Message("ASSUMED: {names}", names=names))
                painter.draw_text_line(words, text, 1.5, "soft", at=ALIGN_CENTER, bold=False, margin=1.0)


class ToolShapePage(OffsetPage):
    """The page of the shape of the selected tool."""

    NAME = page_table.SHAPE
    LABELS = ("MENU", "", "NONE", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "SECCMP", "ZERO")
    model: ToolShapeTable
    content_panel: ToolShapePanel

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        super().__init__(host, parent, ToolShapeTable(host.desk))
        self.content_panel = ToolShapePanel(self.theme, self.model, self)

    def find_key_refusals(self) -> dict[str, object]:
        """Return why each key is disabled, including F3 (delete the shape)."""
        return {**super().find_key_refusals(), "F3": self.model.find_deletion_refusal()}

    def make_key_actions(self) -> KeyActions:
        """Return the key actions, including F3 (delete the shape).

        This page does not show the effect on the path.
        """
        shared = {key: act for key, act in super().make_key_actions().items() if key != "F6"}
        return {**shared, "F3": self.model.delete_shape}

    def on_open(self) -> None:
        """Select the first field of the selected tool."""
        super().on_open()
        self.model.field_index = 0

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram) -> None:
        """Update the fields from the model."""
        super().refresh(snapshot, status, loaded)
        self.content_panel.update_fields()

    def handle_escape(self) -> bool:
        """Close the history, a question or an entry, or else open the tool table."""
        if not self.model.handle_escape():
            self.host.open_page(page_table.TOOLS)
        return True
