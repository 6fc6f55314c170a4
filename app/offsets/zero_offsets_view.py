"""The page of G54 to G59: the table, the cell that is typed over, a pad of keys, and the history."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QPainter, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.machine_status import MachineStatus
from app.desk.program_loading import Loaded
from app.desk.translation import tr
from app.offsets.offset_history_view import HistoryList
from app.offsets.offset_values import shown_zero, zero_change_in_words
from app.offsets.secondary_dialogue import CHARACTERS
from app.offsets.zero_offsets import ZeroDesk
from app.screen import page_table
from app.screen.entry_panel import Asked, AskedPanel, KeyPad
from app.screen.look import CENTRE, LEFT, RIGHT, Look, put
from app.screen.page_base import Doings, Host, Page
from app.screen.panel import Panel
from core.executor.snapshot import Snapshot
from core.store.zero_offset_table import ZERO_CODES, ZERO_FIELDS, ZeroRow

# --- G54 to G59, a row each: X, Z and C.


_NAME = 0.16  # share of the width for the code


class ZeroTable(Panel):
    """Each cell is a target for a finger. The chosen one is filled, the offset in force has a bar."""

    def __init__(self, look: Look, choose: Callable[[int, int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose
        self.rows: Mapping[int, ZeroRow] = {}
        self.cell = (0, 0)
        self.in_force = 0

    def show_rows(self, rows: Mapping[int, ZeroRow], cell: tuple[int, int], in_force: int) -> None:
        """The table, the chosen cell, and the code in force (0: none)."""
        if (rows, cell, in_force) != (self.rows, self.cell, self.in_force):
            self.rows, self.cell, self.in_force = rows, cell, in_force
            self.update()

    def draw(self, painter: QPainter) -> None:
        self.frame(painter, tr("SETTABLE OFFSETS  ·  X IS A RADIUS  ·  MM AND DEGREES"))
        room, u = self.inside(), self.look.u
        high = min(room.height() / (len(ZERO_CODES) + 1), 8.0 * u)
        self._head(painter, QRectF(room.x(), room.y(), room.width(), high))
        for row in range(len(ZERO_CODES)):
            self._row(
                painter, QRectF(room.x(), room.y() + (row + 1) * high, room.width(), high - 0.5 * u), row
            )

    def _cells(self, row: QRectF) -> list[QRectF]:
        wide = row.width() * (1.0 - _NAME) / len(ZERO_FIELDS)
        left = row.x() + row.width() * _NAME
        return [
            QRectF(left + n * wide, row.y(), wide - 0.5 * self.look.u, row.height())
            for n in range(len(ZERO_FIELDS))
        ]

    def _head(self, painter: QPainter, row: QRectF) -> None:
        painter.setPen(self.look.colour("soft"))
        painter.setFont(self.look.font(2.4, bold=True))
        for name, cell in zip(ZERO_FIELDS, self._cells(row), strict=True):
            put(painter, cell, CENTRE, name.upper())

    def _row(self, painter: QPainter, box: QRectF, row: int) -> None:
        look, u, code = self.look, self.look.u, ZERO_CODES[row]
        if code == self.in_force:
            painter.fillRect(QRectF(box.x(), box.y(), 0.6 * u, box.height()), look.colour("lit"))
        painter.setPen(look.colour("accent"))
        painter.setFont(look.font(2.8, bold=True))
        put(painter, box.adjusted(1.6 * u, 0, 0, 0), LEFT, f"G{code}")
        offset = self.rows.get(code)
        for column, (name, cell) in enumerate(zip(ZERO_FIELDS, self._cells(box), strict=True)):
            here = (row, column) == self.cell
            painter.fillRect(cell, look.colour("here" if here else "key"))
            painter.setPen(look.colour("text" if offset is not None or here else "soft"))
            figure = shown_zero(getattr(offset or ZeroRow(), name))
            painter.setFont(look.fit(figure, 3.0, cell.width() - 2.4 * u, bold=offset is not None))
            put(painter, cell.adjusted(0, 0, -1.2 * u, 0), RIGHT, figure)
            self.place(cell, partial(self._choose, row, column))


PAD, ASKED = 28.4, 12.4  # units: width of the pad, height of the entry


class ZeroPage(Page):
    """The model decides, this only shows it and hands the keys on."""

    NAME = page_table.ZERO
    LABELS = ("MENU", "HERE", "", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "SECCMP", "")

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = ZeroDesk(host.desk)
        self.table = ZeroTable(self.look, self.model.choose, self)
        self.history = HistoryList(self.look, self)
        self.asked = AskedPanel(self.look, self)
        self.pad = KeyPad(self.look, self._touched, own=("C", "C"), parent=self)

    def doings(self) -> Doings:
        """The position of the machine, undo, history, and the other tables."""
        return {
            "F2": self.model.here,
            "F4": self.model.undo,
            "F5": self._toggle,
            "F8": lambda: self._go(page_table.TOOLS),
            "F9": lambda: self._go(page_table.SECCMP),
        }

    def _go(self, name: str) -> None:
        self.host.go(name)

    def _toggle(self) -> None:
        self.model.ledger.toggle_history()
        self.history.look_at(0)

    def typed(self, key: str) -> bool:
        """Figures and signs are the entry's; letters stay what they are everywhere, but for C."""
        if self.history.isVisible() and key in {"Page up", "Page down"}:
            self.history.look_at(self.history.top + (1 if key == "Page down" else -1) * self.history.rows)
            return True
        return self.model.typed(key)

    def takes(self, key: str) -> bool:
        """Figures, signs, and C."""
        return key in CHARACTERS or key == "C"

    def has_field(self) -> bool:
        """Figures are always typed here."""
        return True

    def _touched(self, key: str) -> None:
        if key == "Esc":
            self.host.press(key)
        else:
            self.typed(key)

    def prompt(self) -> str:
        """From the model."""
        return self.model.prompt(self.desk.snapshot())

    def opened(self) -> None:
        """What was changed elsewhere is no news here."""
        self.model.ledger.opened()

    def leave(self) -> bool:
        """Nothing stays half entered."""
        self.model.leave()
        return True

    def escape(self) -> bool:
        """Esc goes one step back, and then to the Automatic page."""
        if not self.model.escape():
            self.host.go(page_table.AUTOMATIC)
        return True

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """The table as the store has it, and the entry."""
        model = self.model
        model.ledger.look()
        changes = model.ledger.looking_back
        self.history.setVisible(changes is not None)
        self.table.setVisible(changes is None)
        if changes is not None:
            self.history.show_entries(tuple(zero_change_in_words(change) for change in changes))
        self.table.show_rows(model.book.rows, (model.row, model.column), snapshot.modal.settable)
        foot = tr(
            "F2: where the machine stands reads what is typed        C: clear G54 to G59        Esc: exit"
        )
        self.asked.show_asked(Asked("", model.question, model.text, model.old_to_new, foot))

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Table over entry, the pad at their right."""
        u = self.look.u
        pad, high, gap = round(PAD * u), round(ASKED * u), max(4, round(0.7 * u))
        wide, table = self.width() - pad - gap, self.height() - high - gap
        for part in (self.table, self.history):
            part.setGeometry(0, 0, wide, table)
        self.asked.setGeometry(0, table + gap, wide, high)
        self.pad.setGeometry(wide + gap, 0, pad, self.height())
