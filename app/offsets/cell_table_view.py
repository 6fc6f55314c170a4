"""Views of tables that are edited cell by cell: zero offsets of a lathe, tools and presets of a mill."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus, Tone
from app.offsets.cell_table import CellTable
from app.offsets.mill_tools import MillTools
from app.offsets.offset_values import cell_text
from app.offsets.offsets_view import OffsetPage
from app.offsets.zero_offsets import Presets, ZeroOffsets
from app.screen import page_table
from app.screen.look import CENTRE, RIGHT, Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Shown
from app.screen.sheet_panel import RowPanel
from app.screen.window_layout import FINGER
from core.executor.snapshot import Snapshot
from core.production.tool_life import ToolLife
from core.store.store_rows import Row

HEAD, HIGH = 4.0, 8.0  # Units: maximum height of the head line, and height of a row.
_NAME = 0.07  # Fraction of the width for the row number.


class CellPanel(RowPanel):
    """A table whose cells are touch targets. The selected cell is filled, and the active row has a bar.

    On a small screen with the number pad, only the columns that fit are shown, including the selected one.
    """

    stored: Shown[Mapping[int, Row]] = Shown({})
    lives: Shown[Mapping[int, ToolLife]] = Shown({})  # Tool life of a mill's tools.
    cell = Shown((0, 0))
    in_force = Shown(0)  # Number of the active row, or 0.

    def __init__(self, look: Look, table: CellTable, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._heading, self._words, self._model = table.title, table.words, table
        self._kind, self._numbers, self._columns = table.kind, table.numbers, table.columns
        self._choose: Callable[[int, int], None] = table.choose
        self._wide = [_WIDE.get(name, 1.0) for name in table.columns]

    def draw(self, painter: Painter) -> None:
        self.frame(painter, self._heading)
        room, u, count = self.inside(), self.look.u, len(self._numbers)
        least = self.look.row(HIGH, 10.0, touch=True) + 0.5 * u
        head = min(HEAD * u, least)
        body = room.adjusted(0, head, 0, 0)
        fits = min(self.fitting(body, least, count), count)
        body = self.scrolled(painter, body, fits, count, self.cell[0])
        high = min(body.height() / fits, max(least, HIGH * u))
        self._head(painter, QRectF(body.x(), room.y(), body.width(), head))
        for number, row in self.boxes(body, high):
            self._row(painter, row.adjusted(0, 0, 0, -0.5 * u), number)

    def _cells(self, row: QRectF) -> Iterator[tuple[int, QRectF]]:
        """Yield the visible columns with their rectangles in this row."""
        room, gap = row.width() * (1.0 - _NAME), 0.5 * self.look.u
        shown = self._in_sight(room * min(self._wide) / (FINGER + gap))
        one = room / sum(self._wide[column] for column in shown)
        left = row.x() + row.width() * _NAME
        for column in shown:
            wide = self._wide[column] * one
            yield column, QRectF(left, row.y(), wide - gap, row.height())
            left += wide

    def _in_sight(self, room: float) -> range:
        """Return the visible columns, from the first one, or so that the selected one is the last.

        ``room`` is in the units of the column widths.
        """
        first, end, used = 0, 0, 0.0
        while end < len(self._wide) and (used + self._wide[end] <= room or end <= self.cell[1]):
            used, end = used + self._wide[end], end + 1
            while used > room and first < end - 1:
                used, first = used - self._wide[first], first + 1
        return range(first, end)

    def _head(self, painter: Painter, row: QRectF) -> None:
        for column, cell in self._cells(row):
            painter.write(cell, self._words[column], 2.2, "soft", at=CENTRE)

    def _row(self, painter: Painter, box: QRectF, row: int) -> None:
        u, number = self.look.u, self._numbers[row]
        if number == self.in_force:
            painter.fill(QRectF(box.x(), box.y(), 0.6 * u, box.height()), "lit")
        painter.write(box.adjusted(1.6 * u, 0, 0, 0), f"{_LETTER[self._kind]}{number}", 2.4, "accent")
        offset, size = self.stored.get(number), min(3.0, 0.5 * box.height() / u)
        for nth, (column, cell) in enumerate(self._cells(box)):
            name = self._columns[column]
            here = (row, column) == self.cell
            painter.fill(cell, "here" if here else "key")
            text, tone = name in _TEXTS, self._model.tone_at(number, name)
            if tone is not Tone.OFF:
                painter.box(cell, tone.value, 0.3, "here" if here else "key")
            value = self._model.value_at(number, name)
            ink = "text" if offset is not None or here else "soft"
            place = cell.adjusted(0.6 * u, 0, -0.8 * u, 0)
            at = CENTRE if text else RIGHT
            painter.write(
                place,
                cell_text(self._model.field_of(name), value),
                size,
                ink,
                at=at,
                bold=offset is not None,
                raw=text,
            )
            spot = cell.united(box.adjusted(0, 0, cell.left() - box.right(), 0)) if nth == 0 else cell
            # The number belongs to the first cell, so that touching the number selects the row.
            words = f"{_LETTER[self._kind]}{number} {self._words[column]}"
            self.place(spot, partial(self._choose, row, column), words, kind="row", on=here)


# Relative widths of columns.
_WIDE = {"name": 1.5, "remark": 2.0, "length": 1.25, "teeth": 0.92, "point": 0.92, "stops": 0.92}
_TEXTS = frozenset({"name", "remark"})
_LETTER = {ZeroOffsets.kind: "G", MillTools.kind: "T", Presets.kind: ""}


class CellTablePage(OffsetPage):
    """Base class of the three pages. F2 touches off. These pages do not draw the effect of a change."""

    model: CellTable
    table: CellPanel

    def __init__(self, host: Host, parent: QWidget, model: CellTable) -> None:
        super().__init__(host, parent, model)
        self.table = CellPanel(self.look, model, self)
        if not model.own_key:
            # Selects the next cell, even if the pad leaves no room for its column.
            self.pad.own = ("Tab", "→")

    def key_actions(self) -> KeyActions:
        """Return the actions of the keys, without F6 and F10."""
        return {key: act for key, act in super().key_actions().items() if key not in {"F6", "F10"}}

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """Show the present state of the table."""
        super().refresh(snapshot, status, loaded)
        model = self.model
        self.table.stored, self.table.cell = model.book.of(model.kind), (model.row, model.column)
        self.table.in_force = model.in_force(snapshot)


class ZeroOffsetsPage(CellTablePage):
    """The page of the zero offsets G54 to G59, with one row for each."""

    NAME = page_table.ZERO
    LABELS = ("MENU", "SET POS.", "", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "SECCMP", "")
    model: ZeroOffsets

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, ZeroOffsets(host.desk))

    def labels(self) -> tuple[str, ...]:
        """Return the key labels. A SINUMERIK lathe has no secondary offsets."""
        return (*self.LABELS[:8], "", "") if self.desk.machine.language == "sinumerik" else self.LABELS

    def barred_by(self) -> dict[str, object]:
        """Return the reasons why keys are disabled, including F2 for setting the position."""
        return {**super().barred_by(), "F2": self.model.here_barred()}

    def key_actions(self) -> KeyActions:
        """Return the key actions, including F2 for setting the position."""
        return {**super().key_actions(), "F2": self.model.here}


class MillToolsPage(CellTablePage):
    """The tool table of a mill (TOOL.T), with one row for each tool."""

    NAME = page_table.MILL_TOOLS
    LABELS = ("MENU", "TOUCH L", "", "UNDO", "HISTORY", "", "ALARMS", "", "PRESETS", "")
    model: MillTools

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, MillTools(host.desk))

    def barred_by(self) -> dict[str, object]:
        """Return the reasons why keys are disabled, including F2 for touching off the length."""
        return {**super().barred_by(), "F2": self.model.here_barred()}

    def key_actions(self) -> KeyActions:
        """Return the key actions, including F2 for touching off the length."""
        rest = {key: act for key, act in super().key_actions().items() if key not in {"F8", "F9"}}
        return {**rest, "F2": self.model.here, "F9": partial(self._go, page_table.PRESETS)}

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """Show the present table and the tool life, which changes while the page is open."""
        super().refresh(snapshot, status, loaded)
        self.table.lives = self.model.lives.lives()


class PresetsPage(CellTablePage):
    """The page of the presets of a mill, with one row for each."""

    NAME = page_table.PRESETS
    LABELS = ("MENU", "TOUCH", "ACTIVATE", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "", "")
    model: Presets

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, Presets(host.desk))

    def barred_by(self) -> dict[str, object]:
        """Return the reasons why keys are disabled, including F2 for touching off and F3 for activating."""
        model = self.model
        return {**super().barred_by(), "F2": model.here_barred(), "F3": model.activate_barred()}

    def key_actions(self) -> KeyActions:
        """Return the key actions, including F2 for touching off and F3 for activating a preset."""
        rest = {key: act for key, act in super().key_actions().items() if key not in {"F8", "F9"}}
        own = {"F2": self.model.here, "F3": self.model.activate}
        return {**rest, **own, "F8": partial(self._go, page_table.MILL_TOOLS)}
