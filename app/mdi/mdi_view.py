"""The MDI page (F4): the input line, its history, and the modal state."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QFontMetricsF, QPolygonF, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.programs.start_watch import drawn
from app.desk.status.machine_status import MachineStatus
from app.desk.status.modal_rows import ModalRow, rows_of
from app.desk.status.prompt_line import MOVING
from app.desk.translation import tr
from app.mdi.mdi_model import MdiModel
from app.path.path_aspects import tip_of
from app.path.path_view import PathView
from app.screen import page_table
from app.screen.code_choices_view import CodeChoices
from app.screen.entry_panel import LINES, LetterPad
from app.screen.look import RIGHT, Look, Painter
from app.screen.page_base import Host, KeyActions, ModelPage
from app.screen.panel import Panel, Press, Shown
from app.screen.sheet_panel import RowPanel
from core.executor.snapshot import CYCLE, Snapshot, Starts, State
from core.interpreter.shared.checkpoint import Checkpoint
from core.language.diagnostics import Diagnostic, Severity

# --- the line -----------------------------------------------------------------------------------------


class LinePanel(Panel):
    """The input line with its cursor, the findings of its proof, and a mark when the line is prepared.

    A touch toggles the letter keyboard.
    """

    text, at = Shown(""), Shown(0)
    found: Shown[tuple[Diagnostic, ...]] = Shown(())
    ready = Shown(False)

    def __init__(self, look: Look, touched: Press, parent: QWidget) -> None:
        super().__init__(look, parent)
        self._touched = touched

    @property
    def message(self) -> str:
        """The first finding, errors before warnings."""
        return f"{self._first.message} {self._first.hint}".strip() if self._first else ""

    @property
    def _first(self) -> Diagnostic | None:
        errors = (each for each in self.found if each.severity is Severity.ERROR)
        return next(errors, self.found[0] if self.found else None)

    def draw(self, painter: Painter) -> None:
        look, u = self.look, self.look.u
        title = tr("LINE  ·  READY FOR CYCLE START") if self.ready else tr("LINE")
        self.frame(painter, title, "lit" if self.ready else "frame", 0.3 if self.ready else 0.16)
        room = self.inside()
        self.place(self.area(), self._touched)
        font = look.fit(self.text, 4.4, room.width() - 2 * u, bold=True)
        metrics = QFontMetricsF(font)
        row = QRectF(room.x(), room.y(), room.width(), 5.6 * u)
        painter.write(row, self.text, 4.4, "text", raw=True, margin=2.0)
        at = row.x() + metrics.horizontalAdvance(self.text[: self.at])
        painter.fill(QRectF(at, row.center().y() - 2.2 * u, 0.35 * u, 4.4 * u), "accent")
        if self._first is not None:
            self._finding(painter, room, metrics, self._first)

    def _finding(self, painter: Painter, room: QRectF, metrics: QFontMetricsF, found: Diagnostic) -> None:
        look, u = self.look, self.look.u
        ink = "alarm" if found.severity is Severity.ERROR else "accent"
        if found.column > 0:
            at = room.x() + metrics.horizontalAdvance(self.text[: found.column - 1]) + 0.9 * u
            top = room.y() + 5.4 * u
            tip = QPolygonF(
                [QPointF(at, top), QPointF(at - u, top + 1.6 * u), QPointF(at + u, top + 1.6 * u)]
            )
            painter.setPen(look.colour(ink))
            painter.setBrush(look.colour(ink))
            painter.drawPolygon(tip)
        box = QRectF(room.x(), room.y() + 7.2 * u, room.width(), 2.9 * u)
        painter.write(box, found.message, 2.3, ink)
        painter.write(box.translated(0, box.height()), found.hint, 1.9, "soft", bold=False)


# --- history ------------------------------------------------------------------------------------------


ROW = 3.4  # Units.


class HistoryPanel(RowPanel):
    """The history of lines. ``back`` is the position of the recalled line, 0 for none."""

    lines: Shown[tuple[str, ...]] = Shown(())  # Oldest line first.
    back = Shown(0)
    refused: Shown[tuple[tuple[str, int], ...]] = Shown(())  # Rejected lines with the column of the error.

    def __init__(self, look: Look, choose: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._choose = choose
        # What was shown when the list last scrolled to its end or to the selection.
        self._placed: object = None

    def draw(self, painter: Painter) -> None:
        self.frame(painter, tr("HISTORY  ·  UP AND DOWN ARROWS"))
        u, room, count = self.look.u, self.inside(), len(self.lines)
        fits, refused = self.fitting(room, ROW * u, count), dict(self.refused)
        if (shown := (self.lines, self.back, fits)) != self._placed:
            self.top, self._placed = count - max(fits, self.back), shown
        room = self.scrolled(painter, room, fits, count)
        for number, row in self.boxes(room, ROW * u):
            back = count - number
            if back == self.back:
                painter.fill(row, "here")
            line, text = row.adjusted(0.8 * u, 0, -0.8 * u, 0), self.lines[number]
            if text in refused:
                self._refused(painter, line, text, refused[text])
            painter.write(line, text, 2.2, "text", bold=back == self.back, raw=True, fit=False)
            self.place(row, partial(self._choose, back), kind="row", on=back == self.back)
        if not self.lines:
            empty = QRectF(room.x(), room.y(), room.width(), 3 * u)
            painter.write(empty, tr("No lines run yet."), 2.0, "soft", bold=False)

    def _refused(self, painter: Painter, row: QRectF, text: str, column: int) -> None:
        """Underline the rejected word of a line, and write REJECTED at the right."""
        u = self.look.u
        metrics = QFontMetricsF(self.look.font(2.2))
        start = max(0, column - 1)
        left = row.x() + metrics.horizontalAdvance(text[:start])
        word = re.match(r"\s*[^\W\d_]*[^\sA-Za-z]*", text[start:]) if column else None
        wide = metrics.horizontalAdvance((word.group() if word else "") or text[start:])
        painter.fill(QRectF(left, row.bottom() - 0.6 * u, wide, 0.35 * u), "alarm")
        painter.write(row, tr("REJECTED"), 1.5, "alarm", at=RIGHT)


# --- modal state --------------------------------------------------------------------------------------


SHARE = 0.4  # Fraction of a row for its label.


class ModalPanel(Panel):
    """All rows of the modal state, as large as the room allows."""

    rows: Shown[tuple[ModalRow, ...]] = Shown(())

    def draw(self, painter: Painter) -> None:
        self.frame(painter, tr("MODAL STATE"))
        u, room = self.look.u, self.inside()
        high = min(2.7 * u, room.height() / max(1, len(self.rows)))
        size = min(1.9, high / u * 0.78)
        left = SHARE * room.width()
        for number, row in enumerate(self.rows):
            box = QRectF(room.x(), room.y() + number * high, room.width(), high)
            painter.write(QRectF(box.x(), box.y(), left - u, high), row.label, size, "soft", bold=False)
            painter.write(box.adjusted(left, 0, 0, 0), row.value, size, "text")


LINE, STATE = 15.6, 46.0  # Units: height of the line, width of the modal state.


class MdiPage(ModelPage):
    """The MDI page. At rest, keys are text input. While a line runs, letters have their usual functions."""

    NAME = page_table.MDI
    LABELS = ("MENU", "AUTO", "CODES", "READOUT", "DRIVES", "RESET", "ALARMS", "SPN STOP", "SECCMP", "SCOPE")
    STARTS = True
    model: MdiModel

    def __init__(self, host: Host, model: MdiModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model
        self.line = LinePanel(self.look, self._other_hand, self)
        self.history = HistoryPanel(self.look, self._recall, self)
        self.codes = CodeChoices(self.look, model.completion.codes, model.take_code, self)
        self.letters = LetterPad(self.look, self.touched, self, LINES)
        self.path = PathView(self.look, self)
        self.path.shows_whole_approach = True
        self.path.hide()
        self.inforce = ModalPanel(self.look, self)

    def key_actions(self) -> KeyActions:
        """Return the key actions of this page."""
        return {
            "F2": partial(self.host.go, page_table.AUTOMATIC),
            "F3": self.model.complete,
            "Codes": self.model.complete,
            "F4": self.desk.next_readout,
            "F5": self.desk.enable,
            "F6": self.desk.reset,
            "F8": self.model.stop_spindle,
            "F9": partial(self.host.go, page_table.SECCMP),
            "F10": partial(self.host.press, "Scope"),
        }

    def barred(self) -> frozenset[str]:
        """Return the keys DRIVES and RESET while they would be rejected."""
        state = self.desk.snapshot().state
        found = {"F5": state in {State.ESTOP, State.FAULT}, "F6": state in MOVING}
        return frozenset(key for key, refused in found.items() if refused)

    def _recall(self, back: int) -> None:
        if self.model.has_keyboard:
            self.model.recall(back)

    def _other_hand(self) -> None:
        """Show the letter keyboard in place of the history, or the history again."""
        self.letters.setVisible(self.letters.isHidden())
        self.letters.raise_()

    def has_field(self) -> bool:
        """Return whether the input line accepts text, which is so while no line runs."""
        return self.model.has_keyboard

    def prompt(self) -> str:
        """Return the prompt of the model."""
        return self.model.prompt(self.desk.snapshot(), self.desk.start_words)

    def opens(self) -> bool:
        """Return whether the page can be opened, which is not possible while a program runs."""
        return self.model.opens()

    def leave(self) -> bool:
        """Return whether the page can close, which is not possible while a line runs."""
        return self.model.leave()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, loaded: Loaded) -> None:
        """Show the line, its findings and the modal state of this instant."""
        model, typing = self.model, self.model.typing
        model.look(snapshot)
        running = snapshot.state in CYCLE and snapshot.starts is Starts.LINE
        text = snapshot.block_text if running and not typing.text else typing.text
        line, history = self.line, self.history
        line.text, line.at = text, len(text) if running else typing.at
        line.found, line.ready = model.line.found, model.line.ready is not None
        history.lines, history.back = tuple(typing.history), typing.back
        history.refused = tuple(typing.refused.items())
        self._show_first_move(snapshot, loaded)
        self.codes.setVisible(model.completion.open)
        self.codes.refresh()
        angle = snapshot.demand[2] - snapshot.modal.offset_c
        point = Checkpoint(snapshot.modal, c=angle, kept=snapshot.kept)
        self.inforce.rows = rows_of(point, self.desk.machine.language)

    def _show_first_move(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Draw the first move of a prepared line over the program's path, in place of the history."""
        legs = drawn(self.model.line.first_move)
        if legs:
            self.path.show_picture(loaded.picture)
            self.path.show_tip(tip_of(snapshot, loaded.job)._replace(block=0))
            self.path.show_approach(legs)
            self.path.advance()
        self.path.setVisible(bool(legs))

    def dress(self) -> None:
        """Redraw the path in the present colors."""
        self.path.restart()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Lay out the line above the history, and the modal state at their right."""
        u = self.look.u
        gap, high, state = max(4, round(0.7 * u)), round(LINE * u), round(STATE * u)
        wide = self.width() - state - gap
        self.line.setGeometry(0, 0, wide, high)
        for part in (self.history, self.path, self.codes, self.letters):
            part.setGeometry(0, high + gap, wide, self.height() - high - gap)
        self.inforce.setGeometry(wide + gap, 0, state, self.height())
