"""Views of the offset tables that are edited cell by cell.

These are the zero offsets of a lathe, and the tools and presets of a mill.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus, StatusTone
from app.offsets.cell_table import CellTable
from app.offsets.mill_tools import MillToolTable
from app.offsets.offset_values import format_cell
from app.offsets.offsets_view import OffsetPage
from app.offsets.zero_offsets import PresetTable, ZeroOffsetTable
from app.screen import page_table
from app.screen.page_base import KeyActions, PageHost
from app.screen.panel import RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_RIGHT, ScreenTheme, ThemedPainter
from app.screen.table_panel import RowPanel
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import Snapshot
from core.production.tool_life import ToolLife
from core.store.store_rows import OffsetRow

HEAD, HIGH = 4.0, 8.0  # Units: maximum height of the head line, and height of a row.
_NUMBER_SHARE = 0.07  # Fraction of the width for the row number.


class CellPanel(RowPanel):
    """Panel with a table whose cells are touch targets.

    The selected cell is filled, and the active row has a bar. On a small screen with the number pad, only
    the columns that fit are shown, including the selected column.
    """

    is_searchable = True
    stored_rows: RedrawingAttribute[Mapping[int, OffsetRow]] = RedrawingAttribute({})
    tool_lives: RedrawingAttribute[Mapping[int, ToolLife]] = RedrawingAttribute(
        {}
    )  # Tool life of a mill's tools.
    selected_cell = RedrawingAttribute((0, 0))
    active_row = RedrawingAttribute(0)  # Number of the active row, or 0.

    def __init__(self, theme: ScreenTheme, cell_table: CellTable, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._heading, self._words, self._model = cell_table.title, cell_table.words, cell_table
        self._kind, self._numbers, self._columns = cell_table.kind, cell_table.numbers, cell_table.columns
        self._choose: Callable[[int, int], None] = cell_table.choose
        self._wide = [_COLUMN_SHARES.get(name, 1.0) for name in cell_table.columns]

    def list_row_texts(self) -> Sequence[str]:
        """Return the number and the values of each row as they are displayed."""
        model = self._model
        fields = [(name, model.field_of(name)) for name in self._columns]
        return [
            f"{_ROW_LETTERS[self._kind]}{number} "
            + " ".join(format_cell(field, model.value_at(number, name)) for name, field in fields)
            for number in self._numbers
        ]

    @property
    def selected_row(self) -> int:
        """Return the index of the selected row."""
        return self.selected_cell[0]

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the title, the column headings and the visible rows of the table."""
        self.frame(painter, self._heading)
        room, u, count = self.inside(), self.theme.unit_px, len(self._numbers)
        least = self.theme.find_row_height(HIGH, 10.0, is_touchable=True) + 0.5 * u
        head = min(HEAD * u, least)
        body = room.adjusted(0, head, 0, 0)
        fits = min(self.count_fitting_rows(body, least, count), count)
        body = self.draw_scroll_keys(painter, body, fits, count, self.selected_cell[0])
        high = min(body.height() / fits, max(least, HIGH * u))
        self._head(painter, QRectF(body.x(), room.y(), body.width(), head))
        for number, row in self.find_row_boxes(body, high):
            self._row(painter, row.adjusted(0, 0, 0, -0.5 * u), number)

    def _find_cells(self, row: QRectF) -> Iterator[tuple[int, QRectF]]:
        """Yield the column index and the rectangle of each visible cell in a row."""
        room, gap = row.width() * (1.0 - _NUMBER_SHARE), 0.5 * self.theme.unit_px
        shown = self._find_visible_columns(room * min(self._wide) / (FINGERTIP_PX + gap))
        one = room / sum(self._wide[column] for column in shown)
        left = row.x() + row.width() * _NUMBER_SHARE
        for column in shown:
            wide = self._wide[column] * one
            yield column, QRectF(left, row.y(), wide - gap, row.height())
            left += wide

    def _find_visible_columns(self, available_width: float) -> range:
        """Return the indices of the visible columns.

        They begin with the first column if the selected column then also fits. Otherwise they end with the
        selected column. ``available_width`` is in the units of the column widths.
        """
        first, end, used = 0, 0, 0.0
        while end < len(self._wide) and (
            used + self._wide[end] <= available_width or end <= self.selected_cell[1]
        ):
            used, end = used + self._wide[end], end + 1
            while used > available_width and first < end - 1:
                used, first = used - self._wide[first], first + 1
        return range(first, end)

    def _head(self, painter: ThemedPainter, row: QRectF) -> None:
        for column, cell in self._find_cells(row):
            painter.draw_text_line(cell, self._words[column], 2.2, "soft", at=ALIGN_CENTER)

    def _row(self, painter: ThemedPainter, box: QRectF, row: int) -> None:
        u, number = self.theme.unit_px, self._numbers[row]
        if number == self.active_row:
            painter.fill_rect(QRectF(box.x(), box.y(), 0.6 * u, box.height()), "lit")
        painter.draw_text_line(
            box.adjusted(1.6 * u, 0, 0, 0), f"{_ROW_LETTERS[self._kind]}{number}", 2.4, "accent"
        )
        offset, size = self.stored_rows.get(number), min(3.0, 0.5 * box.height() / u)
        for nth, (column, cell) in enumerate(self._find_cells(box)):
            name = self._columns[column]
            here = (row, column) == self.selected_cell
            painter.fill_rect(cell, "here" if here else "key")
            text, tone = name in _TEXT_COLUMNS, self._model.tone_at(number, name)
            if tone is not StatusTone.OFF:
                painter.draw_box(cell, tone.value, 0.3, "here" if here else "key")
            value = self._model.value_at(number, name)
            ink = "text" if offset is not None or here else "soft"
            place = cell.adjusted(0.6 * u, 0, -0.8 * u, 0)
            at = ALIGN_CENTER if text else ALIGN_RIGHT
            painter.draw_text_line(
                place,
                format_cell(self._model.field_of(name), value),
                size,
                ink,
                at=at,
                bold=offset is not None,
                raw=text,
            )
            spot = cell.united(box.adjusted(0, 0, cell.left() - box.right(), 0)) if nth == 0 else cell
            # The number belongs to the first cell, so that touching the number selects the row.
            words = f"{_ROW_LETTERS[self._kind]}{number} {self._words[column]}"
            press = partial(self.press_row, row, partial(self._choose, row, column))
            self.add_target(spot, press, words, kind="row", is_on=here)


# Relative widths of columns.
_COLUMN_SHARES = {"name": 1.5, "remark": 2.0, "length": 1.25, "teeth": 0.92, "point": 0.92, "stops": 0.92}
_TEXT_COLUMNS = frozenset({"name", "remark"})
_ROW_LETTERS = {ZeroOffsetTable.kind: "G", MillToolTable.kind: "T", PresetTable.kind: ""}


class CellTablePage(OffsetPage):
    """Base class of the three pages whose tables are edited cell by cell.

    F2 sets the selected field from the current position (touch-off). These pages do not show how a change
    affects the tool path.
    """

    model: CellTable
    content_panel: CellPanel

    def __init__(self, host: PageHost, parent: QWidget, model: CellTable) -> None:
        super().__init__(host, parent, model)
        self.content_panel = CellPanel(self.theme, model, self)
        self.content_panel.on_select = model.select_row
        if not model.page_key:
            # Selects the next cell, even if the pad leaves no room for its column.
            self.number_pad.selected_page_key = ("Tab", "→")

    def make_key_actions(self) -> KeyActions:
        """Return the key actions that all offset pages share, without F6 and F10."""
        return {key: act for key, act in super().make_key_actions().items() if key not in {"F6", "F10"}}

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram) -> None:
        """Update the table from the model."""
        super().refresh(snapshot, status, loaded)
        model = self.model
        self.content_panel.stored_rows, self.content_panel.selected_cell = (
            model.offset_book.get_rows(model.kind),
            (model.row_index, model.column_index),
        )
        self.content_panel.active_row = model.find_active_row(snapshot)


class ZeroOffsetsPage(CellTablePage):
    """Screen page of the zero offsets G54 to G59, with one row for each offset."""

    NAME = page_table.ZERO
    LABELS = ("MENU", "SET POS.", "", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "SECCMP", "")
    model: ZeroOffsetTable

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        super().__init__(host, parent, ZeroOffsetTable(host.desk))

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the labels of the function keys.

        A SINUMERIK lathe has no key for secondary offsets.
        """
        return (
            (*self.LABELS[:8], "", "") if self.desk.machine.program_language == "sinumerik" else self.LABELS
        )

    def find_key_refusals(self) -> dict[str, object]:
        """Return the reason why each function key is disabled, including F2 (set from position)."""
        return {**super().find_key_refusals(), "F2": self.model.find_touch_off_refusal()}

    def make_key_actions(self) -> KeyActions:
        """Return the key actions, including F2 (set from position)."""
        return {**super().make_key_actions(), "F2": self.model.set_value_from_position}


class MillToolsPage(CellTablePage):
    """Screen page of the tool table of a mill (TOOL.T), with one row for each tool."""

    NAME = page_table.MILL_TOOLS
    LABELS = ("MENU", "TOUCH L", "", "UNDO", "HISTORY", "", "ALARMS", "", "PRESETS", "")
    model: MillToolTable

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        super().__init__(host, parent, MillToolTable(host.desk))

    def find_key_refusals(self) -> dict[str, object]:
        """Return the reason why each function key is disabled, including F2 (touch off the length)."""
        return {**super().find_key_refusals(), "F2": self.model.find_position_refusal()}

    def make_key_actions(self) -> KeyActions:
        """Return the key actions, including F2 (touch off the length)."""
        rest = {key: act for key, act in super().make_key_actions().items() if key not in {"F8", "F9"}}
        return {**rest, "F2": self.model.set_value_from_position, "F9": partial(self._go, page_table.PRESETS)}

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: LoadedProgram) -> None:
        """Update the table, and the used tool life, which can change while the page is open."""
        super().refresh(snapshot, status, loaded)
        self.content_panel.tool_lives = self.model.mill_tool_lives.read_lives()


class PresetsPage(CellTablePage):
    """Screen page of the presets of a mill, with one row for each preset."""

    NAME = page_table.PRESETS
    LABELS = ("MENU", "TOUCH", "ACTIVATE", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "", "")
    model: PresetTable

    def __init__(self, host: PageHost, parent: QWidget) -> None:
        super().__init__(host, parent, PresetTable(host.desk))

    def find_key_refusals(self) -> dict[str, object]:
        """Return the reason why each function key is disabled, including F2 and F3.

        F2 touches off, and F3 activates the selected preset.
        """
        model = self.model
        return {
            **super().find_key_refusals(),
            "F2": model.find_touch_off_refusal(),
            "F3": model.find_activation_refusal(),
        }

    def make_key_actions(self) -> KeyActions:
        """Return the key actions, including F2 (touch off) and F3 (activate a preset)."""
        rest = {key: act for key, act in super().make_key_actions().items() if key not in {"F8", "F9"}}
        own = {"F2": self.model.set_value_from_position, "F3": self.model.activate_preset}
        return {**rest, **own, "F8": partial(self._go, page_table.MILL_TOOLS)}
