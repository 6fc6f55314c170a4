"""Tables that are entered cell by cell: zero offsets of a lathe, tools and presets of a mill."""

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

HEAD, HIGH = 4.0, 8.0  # units: the line of words at most, and a row
_NAME = 0.07  # share of the width for the number


class CellPanel(RowPanel):
    """Each cell is a target for a finger. The chosen one is filled, the row in force has a bar.

    Beside the pad of a small screen stand as many columns as are wide enough, the chosen one among them.
    """

    stored: Shown[Mapping[int, Row]] = Shown({})
    lives: Shown[Mapping[int, ToolLife]] = Shown({})  # of the tools of a mill
    cell = Shown((0, 0))
    in_force = Shown(0)  # number of a row; 0: none

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
        """The columns that there is room for, and where they stand in this row."""
        room, gap = row.width() * (1.0 - _NAME), 0.5 * self.look.u
        shown = self._in_sight(room * min(self._wide) / (FINGER + gap))
        one = room / sum(self._wide[column] for column in shown)
        left = row.x() + row.width() * _NAME
        for column in shown:
            wide = self._wide[column] * one
            yield column, QRectF(left, row.y(), wide - gap, row.height())
            left += wide

    def _in_sight(self, room: float) -> range:
        """From the first column on, or so that the chosen one is the last; ``room`` in shares."""
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
            # The number is part of the first cell: pressing it chooses the row.
            words = f"{_LETTER[self._kind]}{number} {self._words[column]}"
            self.place(spot, partial(self._choose, row, column), words, kind="row", on=here)


_WIDE = {"name": 1.5, "remark": 2.0, "length": 1.25, "teeth": 0.92, "point": 0.92, "stops": 0.92}  # columns
_TEXTS = frozenset({"name", "remark"})
_LETTER = {ZeroOffsets.kind: "G", MillTools.kind: "T", Presets.kind: ""}


class CellTablePage(OffsetPage):
    """What the three pages have in common: F2 touches off, and no effect is drawn of these tables."""

    model: CellTable
    table: CellPanel

    def __init__(self, host: Host, parent: QWidget, model: CellTable) -> None:
        super().__init__(host, parent, model)
        self.table = CellPanel(self.look, model, self)
        if not model.own_key:
            self.pad.own = ("Tab", "→")  # to the next cell, also one that the pad has taken the room of

    def key_actions(self) -> KeyActions:
        """The other tables of this machine; F6 and F10 are none of its keys."""
        return {key: act for key, act in super().key_actions().items() if key not in {"F6", "F10"}}

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """The table as it is now."""
        super().refresh(snapshot, status, loaded)
        model = self.model
        self.table.stored, self.table.cell = model.book.of(model.kind), (model.row, model.column)
        self.table.in_force = model.in_force(snapshot)


class ZeroOffsetsPage(CellTablePage):
    """G54 to G59: a row each, X, Z and C."""

    NAME = page_table.ZERO
    LABELS = ("MENU", "SET POS.", "", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "SECCMP", "")
    model: ZeroOffsets

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, ZeroOffsets(host.desk))

    def labels(self) -> tuple[str, ...]:
        """A SINUMERIK lathe has no secondary offsets."""
        return (*self.LABELS[:8], "", "") if self.desk.machine.language == "sinumerik" else self.LABELS

    def barred_by(self) -> dict[str, object]:
        """Return also why the position of the machine is not taken."""
        return {**super().barred_by(), "F2": self.model.here_barred()}

    def key_actions(self) -> KeyActions:
        """The position of the machine."""
        return {**super().key_actions(), "F2": self.model.here}


class MillToolsPage(CellTablePage):
    """TOOL.T: a row a tool."""

    NAME = page_table.MILL_TOOLS
    LABELS = ("MENU", "TOUCH L", "", "UNDO", "HISTORY", "", "ALARMS", "", "PRESETS", "")
    model: MillTools

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, MillTools(host.desk))

    def barred_by(self) -> dict[str, object]:
        """Return also why no length is touched off."""
        return {**super().barred_by(), "F2": self.model.here_barred()}

    def key_actions(self) -> KeyActions:
        """The length of a tool whose tip touches."""
        rest = {key: act for key, act in super().key_actions().items() if key not in {"F8", "F9"}}
        return {**rest, "F2": self.model.here, "F9": partial(self._go, page_table.PRESETS)}

    def refresh(self, snapshot: Snapshot, status: MachineStatus, loaded: Loaded) -> None:
        """What the tools have cut counts on while the page is open."""
        super().refresh(snapshot, status, loaded)
        self.table.lives = self.model.lives.lives()


class PresetsPage(CellTablePage):
    """The workpiece's zero, a row each."""

    NAME = page_table.PRESETS
    LABELS = ("MENU", "TOUCH", "ACTIVATE", "UNDO", "HISTORY", "", "ALARMS", "TOOLS", "", "")
    model: Presets

    def __init__(self, host: Host, parent: QWidget) -> None:
        super().__init__(host, parent, Presets(host.desk))

    def barred_by(self) -> dict[str, object]:
        """Return also why the workpiece is not touched off, and why no preset comes into force."""
        model = self.model
        return {**super().barred_by(), "F2": model.here_barred(), "F3": model.activate_barred()}

    def key_actions(self) -> KeyActions:
        """Where the tip touches the workpiece, and which preset is in force."""
        rest = {key: act for key, act in super().key_actions().items() if key not in {"F8", "F9"}}
        own = {"F2": self.model.here, "F3": self.model.activate}
        return {**rest, **own, "F8": partial(self._go, page_table.MILL_TOOLS)}
