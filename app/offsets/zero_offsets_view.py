"""Zero offsets, G54 to G59: a row each, X, Z and C."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.offsets.offset_values import signed_zero_offset
from app.offsets.offsets_view import OffsetPage
from app.offsets.zero_offsets import ZERO_FIELDS, ZeroOffsets
from app.screen import page_table
from app.screen.look import CENTRE, RIGHT, Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Panel, Shown
from core.executor.snapshot import Snapshot
from core.store.store_rows import ZERO_CODES, ZeroRow

_NAME = 0.16  # share of the width for the code


class ZeroTable(Panel):
    """Each cell is a target for a finger. The chosen one is filled, the offset in force has a bar."""

    rows: Shown[Mapping[int, ZeroRow]] = Shown({})
    cell = Shown((0, 0))
    in_force = Shown(0)  # 0: none

    def __init__(self, look: Look, choose: Callable[[int, int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose

    def draw(self, painter: Painter) -> None:
        self.frame(painter, tr("SETTABLE OFFSETS  ·  X IS A RADIUS  ·  MM AND DEGREES"))
        room, u = self.inside(), self.look.u
        high = min(room.height() / (len(ZERO_CODES) + 1), 8.0 * u)
        self._head(painter, QRectF(room.x(), room.y(), room.width(), high))
        for row in range(len(ZERO_CODES)):
            y = room.y() + (row + 1) * high
            self._row(painter, QRectF(room.x(), y, room.width(), high - 0.5 * u), row)

    def _cells(self, row: QRectF) -> list[QRectF]:
        wide = row.width() * (1.0 - _NAME) / len(ZERO_FIELDS)
        left = row.x() + row.width() * _NAME
        return [
            QRectF(left + n * wide, row.y(), wide - 0.5 * self.look.u, row.height())
            for n in range(len(ZERO_FIELDS))
        ]

    def _head(self, painter: Painter, row: QRectF) -> None:
        for name, cell in zip(ZERO_FIELDS, self._cells(row), strict=True):
            painter.write(cell, name.upper(), 2.4, "soft", at=CENTRE)

    def _row(self, painter: Painter, box: QRectF, row: int) -> None:
        u, code = self.look.u, ZERO_CODES[row]
        if code == self.in_force:
            painter.fill(QRectF(box.x(), box.y(), 0.6 * u, box.height()), "lit")
        painter.write(box.adjusted(1.6 * u, 0, 0, 0), f"G{code}", 2.8, "accent")
        offset = self.rows.get(code)
        for column, (name, cell) in enumerate(zip(ZERO_FIELDS, self._cells(box), strict=True)):
            here = (row, column) == self.cell
            painter.fill(cell, "here" if here else "key")
            figure = signed_zero_offset(getattr(offset or ZeroRow(), name))
            place, ink = cell.adjusted(0, 0, -1.2 * u, 0), "text" if offset is not None or here else "soft"
            painter.write(place, figure, 3.0, ink, at=RIGHT, bold=offset is not None, margin=1.2)
            self.place(cell, partial(self._choose, row, column))


class ZeroOffsetsPage(OffsetPage):
    """G54 to G59."""

    NAME = page_table.ZERO
    LABELS = ("MENU", "HERE", "", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "SECCMP", "")
    model: ZeroOffsets
    table: ZeroTable

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, ZeroOffsets(host.desk))
        self.table = ZeroTable(self.look, self.model.choose, self)

    def key_actions(self) -> KeyActions:
        """The position of the machine; no effect is drawn of these."""
        shared = {key: act for key, act in super().key_actions().items() if key not in {"F6", "F10"}}
        return {**shared, "F2": self.model.here}

    def show_table(self, snapshot: Snapshot) -> None:
        """The table as it is now, and which offset is in force."""
        model = self.model
        self.table.rows, self.table.cell = model.book.zero, (model.row, model.column)
        self.table.in_force = snapshot.modal.settable
