"""MDI page (F4) with the input line, its history and the modal state."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QFontMetricsF, QPolygonF, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.code_help import make_code_blocks
from app.desk.pages.guide_text import GuideBlock
from app.desk.programs.program_loading import LoadedProgram
from app.desk.programs.start_watch import make_drawn_legs
from app.desk.status.machine_status import MachineStatus
from app.desk.status.modal_rows import ModalRow, make_modal_rows
from app.desk.status.prompt_line import MOVING_STATES
from app.desk.translation import tr
from app.mdi.mdi_model import MdiModel
from app.path.path_aspects import find_tip_position
from app.path.path_view import PathView
from app.screen import page_table
from app.screen.code_choices_view import CodeChoiceList
from app.screen.entry_panel import LINE_KEYS, LetterPad
from app.screen.page_base import KeyActions, ModelPage, PageHost
from app.screen.panel import OnPress, Panel, RedrawingAttribute
from app.screen.screen_theme import ALIGN_RIGHT, ScreenTheme, ThemedPainter
from app.screen.table_panel import RowPanel
from core.executor.snapshot import CYCLE_STATES, MachineState, Snapshot, StartAction
from core.interpreter.shared.checkpoint import Checkpoint
from core.language.diagnostics import Diagnostic, Severity

# --- the line -----------------------------------------------------------------------------------------


class MdiLinePanel(Panel):
    """Panel with the input line, its cursor and its proof findings, highlighted if the line is ready.

    A touch shows or hides the letter keyboard.
    """

    text, at = RedrawingAttribute(""), RedrawingAttribute(0)
    diagnostics: RedrawingAttribute[tuple[Diagnostic, ...]] = RedrawingAttribute(())
    is_ready = RedrawingAttribute(False)

    def __init__(self, theme: ScreenTheme, on_touch: OnPress, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._touched = on_touch

    @property
    def finding_text(self) -> str:
        """Return the first proof finding as text, or an empty string if there are no findings.

        Errors come before warnings.
        """
        return f"{self._first.message} {self._first.hint}".strip() if self._first else ""

    @property
    def _first(self) -> Diagnostic | None:
        errors = (each for each in self.diagnostics if each.severity is Severity.ERROR)
        return next(errors, self.diagnostics[0] if self.diagnostics else None)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the input line with its cursor and the first error or warning of its proof.

        If the line is ready for Cycle Start, its frame is highlighted.
        """
        look, u = self.theme, self.theme.unit_px
        title = tr("LINE  ·  READY FOR CYCLE START") if self.is_ready else tr("LINE")
        self.frame(painter, title, "lit" if self.is_ready else "frame", 0.3 if self.is_ready else 0.16)
        room = self.inside()
        self.add_target(self.find_full_area(), self._touched)
        font = look.fit_font(self.text, 4.4, room.width() - 2 * u, is_bold=True)
        metrics = QFontMetricsF(font)
        row = QRectF(room.x(), room.y(), room.width(), 5.6 * u)
        painter.draw_text_line(row, self.text, 4.4, "text", raw=True, margin=2.0)
        at = row.x() + metrics.horizontalAdvance(self.text[: self.at])
        painter.fill_rect(QRectF(at, row.center().y() - 2.2 * u, 0.35 * u, 4.4 * u), "accent")
        if self._first is not None:
            self._finding(painter, room, metrics, self._first)

    def _finding(
        self, painter: ThemedPainter, room: QRectF, metrics: QFontMetricsF, found: Diagnostic
    ) -> None:
        look, u = self.theme, self.theme.unit_px
        ink = "alarm" if found.severity is Severity.ERROR else "accent"
        if found.column > 0:
            at = room.x() + metrics.horizontalAdvance(self.text[: found.column - 1]) + 0.9 * u
            top = room.y() + 5.4 * u
            tip = QPolygonF(
                [QPointF(at, top), QPointF(at - u, top + 1.6 * u), QPointF(at + u, top + 1.6 * u)]
            )
            painter.setPen(look.get_color(ink))
            painter.setBrush(look.get_color(ink))
            painter.drawPolygon(tip)
        box = QRectF(room.x(), room.y() + 7.2 * u, room.width(), 2.9 * u)
        painter.draw_text_line(box, found.message, 2.3, ink)
        painter.draw_text_line(box.translated(0, box.height()), found.hint, 1.9, "soft", bold=False)


# --- history ------------------------------------------------------------------------------------------


ROW_HEIGHT = 3.4  # Units.


class MdiHistoryPanel(RowPanel):
    """Panel with the history of input lines.

    ``recall_index`` is the position of the recalled line, counted from 1, or 0 if no line is recalled.
    """

    history_lines: RedrawingAttribute[tuple[str, ...]] = RedrawingAttribute(())  # Oldest line first.
    recall_index = RedrawingAttribute(0)
    error_columns: RedrawingAttribute[tuple[tuple[str, int], ...]] = RedrawingAttribute(
        ()
    )  # Rejected lines with the column of the error.

    def __init__(self, theme: ScreenTheme, select_cell: Callable[[int], None], parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._choose = select_cell
        # What was shown when the list last scrolled to its end or to the selection.
        self._placed: object = None

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the history of input lines, highlight the recalled line and mark rejected lines."""
        self.frame(painter, tr("HISTORY  ·  UP AND DOWN ARROWS"))
        u, room, count = self.theme.unit_px, self.inside(), len(self.history_lines)
        fits, refused = self.count_fitting_rows(room, ROW_HEIGHT * u, count), dict(self.error_columns)
        if (shown := (self.history_lines, self.recall_index, fits)) != self._placed:
            self.first_row, self._placed = count - max(fits, self.recall_index), shown
        room = self.draw_scroll_keys(painter, room, fits, count)
        for number, row in self.find_row_boxes(room, ROW_HEIGHT * u):
            back = count - number
            if back == self.recall_index:
                painter.fill_rect(row, "here")
            line, text = row.adjusted(0.8 * u, 0, -0.8 * u, 0), self.history_lines[number]
            if text in refused:
                self._draw_rejected(painter, line, text, refused[text])
            painter.draw_text_line(
                line, text, 2.2, "text", bold=back == self.recall_index, raw=True, fit=False
            )
            self.add_target(row, partial(self._choose, back), kind="row", is_on=back == self.recall_index)
        if not self.history_lines:
            empty = QRectF(room.x(), room.y(), room.width(), 3 * u)
            painter.draw_text_line(empty, tr("No lines run yet."), 2.0, "soft", bold=False)

    def _draw_rejected(self, painter: ThemedPainter, row: QRectF, text: str, column: int) -> None:
        """Underline the rejected word of a line, and draw the text REJECTED on the right."""
        u = self.theme.unit_px
        metrics = QFontMetricsF(self.theme.make_font(2.2))
        start = max(0, column - 1)
        left = row.x() + metrics.horizontalAdvance(text[:start])
        word = re.match(r"\s*[^\W\d_]*[^\sA-Za-z]*", text[start:]) if column else None
        wide = metrics.horizontalAdvance((word.group() if word else "") or text[start:])
        painter.fill_rect(QRectF(left, row.bottom() - 0.6 * u, wide, 0.35 * u), "alarm")
        painter.draw_text_line(row, tr("REJECTED"), 1.5, "alarm", at=ALIGN_RIGHT)


# --- modal state --------------------------------------------------------------------------------------


LABEL_WIDTH_RATIO = 0.44  # Fraction of a row for its label.


def count_modal_columns(theme: ScreenTheme, height_px: int, row_count: int) -> int:
    """Return the number of columns of the modal state, which is 2 if its rows would otherwise be too low."""
    return 2 if height_px - 4.0 * theme.unit_px < row_count * theme.find_line_height(0.0) else 1


class ModalStatePanel(Panel):
    """Panel with all rows of the modal state, which are as large as the available area permits."""

    rows: RedrawingAttribute[tuple[ModalRow, ...]] = RedrawingAttribute(())

    def draw(self, painter: ThemedPainter) -> None:
        """Draw a label and a value for each row of the modal state."""
        self.frame(painter, tr("MODAL STATE"))
        u, room = self.theme.unit_px, self.inside()
        columns = count_modal_columns(self.theme, self.height(), len(self.rows))
        count = max(1, math.ceil(len(self.rows) / columns))
        wide = (room.width() + u) / columns
        high = min(max(2.7 * u, self.theme.find_line_height(0.0)), room.height() / count)
        size = min(1.9, high / u * 0.78)
        left = LABEL_WIDTH_RATIO * wide
        for number, row in enumerate(self.rows):
            column, place = divmod(number, count)
            box = QRectF(room.x() + column * wide, room.y() + place * high, wide - u, high)
            painter.draw_text_line(
                QRectF(box.x(), box.y(), left - 0.4 * u, high), row.label, size, "soft", bold=False
            )
            painter.draw_text_line(box.adjusted(left, 0, 0, 0), row.active_code, size, "text")


# Units: height of the line, and widths of the modal state with one and two columns.
LINE, STATE, WIDE_STATE = 15.6, 46.0, 72.0


class MdiPage(ModelPage):
    """Screen page for MDI input.

    While no line is running, keys enter text. While a line is running, letters have their usual functions.
    """

    NAME = page_table.MDI
    LABELS = ("MENU", "AUTO", "CODES", "READOUT", "DRIVES", "RESET", "ALARMS", "SPN STOP", "SECCMP", "SCOPE")
    CAN_START_CYCLES = True
    model: MdiModel

    def __init__(self, host: PageHost, model: MdiModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model
        self.line_panel = MdiLinePanel(self.theme, self._toggle_letter_pad, self)
        self.history_panel = MdiHistoryPanel(self.theme, self._recall, self)
        self.code_list = CodeChoiceList(self.theme, model.line_completion.code_help, model.insert_code, self)
        self.letter_pad = LetterPad(self.theme, self.handle_touched_key, self, LINE_KEYS)
        self.path_view = PathView(self.theme, self)
        self.path_view.shows_whole_approach = True
        self.path_view.hide()
        self.modal_panel = ModalStatePanel(self.theme, self)

    def make_key_actions(self) -> KeyActions:
        """Return the key actions of the MDI page."""
        return {
            "F2": partial(self.host.open_page, page_table.AUTOMATIC),
            "F3": self.model.toggle_choices,
            "Codes": self.model.toggle_choices,
            "F4": self.desk.select_next_readout,
            "F5": self.desk.enable_drives,
            "F6": self.desk.reset_control,
            "F8": self.model.stop_spindle,
            "F9": partial(self.host.open_page, page_table.SECCMP),
            "F10": partial(self.host.press_key, "Scope"),
        }

    def find_disabled_keys(self) -> frozenset[str]:
        """Return those of the keys DRIVES (F5) and RESET (F6) that have no function in the current state."""
        state = self.desk.read_snapshot().state
        found = {"F5": state in {MachineState.ESTOP, MachineState.FAULT}, "F6": state in MOVING_STATES}
        return frozenset(key for key, refused in found.items() if refused)

    def _recall(self, back: int) -> None:
        if self.model.accepts_input:
            self.model.recall_line(back)

    def needs_height(self) -> bool:
        """Return whether the letter keyboard is shown."""
        return not self.letter_pad.isHidden()

    def _toggle_letter_pad(self) -> None:
        """Show the letter keyboard instead of the history, or the history instead of the letter keyboard."""
        self.letter_pad.setVisible(self.letter_pad.isHidden())
        self._arrange_parts()
        self.letter_pad.raise_()

    def has_text_field(self) -> bool:
        """Return whether the input line accepts text, which is the case while no line is running."""
        return self.model.accepts_input

    def find_marked_help(self) -> Sequence[GuideBlock]:
        """Return the explanation of the codes in the input line."""
        book = self.model.line_completion.read_code_book()
        return make_code_blocks(book, book.list_codes(self.model.mdi_input.text))

    def prompt_text(self) -> str:
        """Return the prompt of the model."""
        return self.model.prompt_text(self.desk.read_snapshot(), self.desk.start_instruction)

    def can_open(self) -> bool:
        """Return whether the page can open.

        The page cannot open while a program is running.
        """
        return self.model.can_open()

    def try_leave_page(self) -> bool:
        """Return whether the page can close.

        The page cannot close while a line is running.
        """
        return self.model.try_leave()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, loaded: LoadedProgram) -> None:
        """Show the input line, its proof findings and the current modal state."""
        model, typing = self.model, self.model.mdi_input
        model.update(snapshot)
        running = snapshot.state in CYCLE_STATES and snapshot.starts is StartAction.MDI_LINE
        text = snapshot.block_text if running and not typing.text else typing.text
        line, history = self.line_panel, self.history_panel
        line.text, line.at = text, len(text) if running else typing.cursor_index
        line.diagnostics, line.is_ready = (
            model.prepared_line.diagnostics,
            model.prepared_line.ready_job is not None,
        )
        history.history_lines, history.recall_index = tuple(typing.history_lines), typing.recall_index
        history.error_columns = tuple(typing.error_columns_by_line.items())
        self._show_first_move(snapshot, loaded)
        self.code_list.setVisible(model.line_completion.is_choice_list_open)
        self.code_list.refresh()
        angle = snapshot.demand[2] - snapshot.modal.offset_c
        point = Checkpoint(snapshot.modal, c=angle, kept=snapshot.kept)
        rows = make_modal_rows(point, self.desk.machine.program_language)
        if len(rows) != len(self.modal_panel.rows):
            self.modal_panel.rows = rows
            self._arrange_parts()
        self.modal_panel.rows = rows

    def _show_first_move(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Draw the first move of a prepared line over the program path, in place of the history."""
        legs = make_drawn_legs(self.model.prepared_line.first_move_result)
        if legs:
            self.path_view.show_picture(loaded.picture)
            self.path_view.show_tool_tip(
                find_tip_position(snapshot, loaded.job)._replace(active_block_number=0)
            )
            self.path_view.show_approach(legs)
            self.path_view.continue_drawing()
        self.path_view.setVisible(bool(legs))

    def apply_theme(self) -> None:
        """Draw the path again with the current colors."""
        self.path_view.redraw()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the parts of the page for its new size."""
        self._arrange_parts()

    def _arrange_parts(self) -> None:
        """Arrange the input line above the history on the left, and the modal state on the right."""
        u = self.theme.unit_px
        gap, high = max(4, round(0.7 * u)), round(min(LINE * u, 0.4 * self.height()))
        columns = count_modal_columns(self.theme, self.height(), len(self.modal_panel.rows))
        state = round((STATE if columns == 1 else WIDE_STATE) * u)
        if self.needs_height():  # The keys must be as large as a fingertip.
            high = max(round(6.5 * u), min(high, self.height() - self.letter_pad.min_height_px - gap))
            state = round(STATE * u) if columns == 1 else -gap
        self.modal_panel.setVisible(state > 0)
        wide = self.width() - state - gap
        self.line_panel.setGeometry(0, 0, wide, high)
        for part in (self.history_panel, self.path_view, self.code_list, self.letter_pad):
            part.setGeometry(0, high + gap, wide, self.height() - high - gap)
        self.modal_panel.setGeometry(wide + gap, 0, state, self.height())
