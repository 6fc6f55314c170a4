"""Page of the special functions (F10), with the list on the left and the displayed function on the right."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.guide_text import BlockKind, GuideBlock, read_function_help
from app.desk.pages.table_content import FunctionKey
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import get_language, tr
from app.screen import page_table
from app.screen.entry_panel import LetterPad, NumberPad
from app.screen.page_base import KeyActions, PageHost
from app.screen.panel import RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ScreenTheme, ThemedPainter
from app.screen.table_panel import ListPage, RowPanel, TablePanel
from app.screen.window_layout import FINGERTIP_PX
from app.special.special_functions import SpecialFunctionsModel
from core.executor.snapshot import Snapshot

# --- list of functions -------------------------------------------------------------------------------------


ROW, GAP = 7.0, 0.4  # units: height of a row and the gap below it


class FunctionListPanel(RowPanel):
    """Panel that lists the special functions.

    The displayed function is highlighted, with a wide bar while it receives the keys. Rows are at least as
    high as a fingertip. Two keys and the mouse wheel scroll the list if it does not fit.
    """

    title = "SPECIAL FUNCTIONS"
    scroll_step = 1
    is_searchable = True
    mark: RedrawingAttribute[object] = RedrawingAttribute(None)  # present position; a change redraws the list

    def __init__(
        self,
        theme: ScreenTheme,
        model: SpecialFunctionsModel,
        on_open: Callable[[int], None],
        parent: QWidget,
    ) -> None:
        super().__init__(theme, parent)
        self.model, self._enter = model, on_open

    @property
    def _high(self) -> float:
        """Return the row height in pixels, which is at least one fingertip plus the gap between rows."""
        return max(ROW * self.theme.unit_px, FINGERTIP_PX + GAP * self.theme.unit_px)

    def list_row_texts(self) -> Sequence[str]:
        """Return the number, name and description of each function."""
        return [
            f"{number} {tr(each.name)} {tr(each.use)}" for number, each in enumerate(self.model.functions, 1)
        ]

    @property
    def selected_row(self) -> int:
        """Return the index of the displayed function."""
        return self.model.at

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the name and description of each visible function, and make each row a touch target."""
        functions, high, room = self.model.functions, self._high, self.inside()
        fits = self.count_fitting_rows(room, high, len(functions))
        room = self.draw_scroll_keys(painter, room, fits, len(functions), self.model.at)
        for number, row in self.find_row_boxes(room, high):
            box = row.adjusted(0, 0, 0, -GAP * self.theme.unit_px)
            self._item(painter, box, number, functions[number].name, functions[number].use)
            press = partial(self.press_row, number, partial(self._enter, number))
            self.add_target(box, press, kind="row", is_on=number == self.model.at)

    def _item(self, painter: ThemedPainter, box: QRectF, number: int, name: str, use: str) -> None:
        u = self.theme.unit_px
        here = number == self.model.at
        painter.fill_rect(box, "here" if here else "key")
        if here:
            wide = (1.0 if self.model.inside else 0.4) * u
            painter.fill_rect(QRectF(box.x(), box.y(), wide, box.height()), "lit")
        figure = QRectF(box.x() + u, box.y(), 3.6 * u, box.height())
        painter.draw_text_line(figure, str(number + 1), 2.6, "accent", at=ALIGN_CENTER)
        text = box.adjusted(5.2 * u, 0.02 * box.height(), -0.6 * u, -0.02 * box.height())
        painter.draw_text_line(
            QRectF(text.x(), text.y(), text.width(), 0.5 * text.height()), name, 2.0, "text"
        )
        below = QRectF(text.x(), text.y() + 0.5 * text.height(), text.width(), 0.5 * text.height())
        painter.draw_text_line(below, use, 1.6, "text" if here else "soft", bold=False)


LIST, PAD = 34.0, 28.4  # units: widths of the list and the number pad
LETTER_PAD_HEIGHT = 24.0  # units: height of the letter pad


class SpecialFunctionsPage(ListPage):
    """Page that displays the special functions and passes keys to them."""

    NAME = page_table.SPECIAL
    model: SpecialFunctionsModel

    def __init__(self, host: PageHost, model: SpecialFunctionsModel, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.function_list = FunctionListPanel(self.theme, model, self._enter, self)
        self.function_list.on_select = model.show_function
        self.table_panel = TablePanel(self.theme, self._chosen, self)
        self.number_pad = NumberPad(self.theme, self.handle_touched_key, page_key=None, parent=self)
        self.letter_pad = LetterPad(self.theme, self.handle_touched_key, self)

    def _enter(self, number: int) -> None:
        self.model.open_function(number)
        self._page_instead()

    def handle_key(self, key: str) -> bool:
        """Handle a key as on other list pages.

        If the selected function has its own page, Enter opens that page.
        """
        taken = super().handle_key(key)
        if taken:
            self._page_instead()
        return taken

    def _page_instead(self) -> None:
        shown = self.model.shown_function
        if self.model.inside and shown.page:
            self.model.inside = False
            self.host.open_page(shown.page)

    def _chosen(self, row: int) -> None:
        self.model.inside = True
        self.model.shown_function.choose(row)
        self._page_instead()

    def handle_touched_key(self, key: str) -> None:
        """Open the displayed function, and pass the touched key to it."""
        self.model.inside = True
        super().handle_touched_key(key)

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys of the displayed function."""
        return self.model.shown_function.make_function_keys()

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the key labels of the displayed function and of the page."""
        return self.make_function_key_labels({}, self.make_function_keys())

    def make_key_actions(self) -> KeyActions:
        """Return the key actions of the displayed function.

        Pressing one of these keys opens the function.
        """
        keys = self.model.shown_function.make_function_keys()
        return {name: partial(self._do, name) for name in keys}

    def find_list(self) -> RowPanel | None:
        """Return the table of an open function or the list of functions, unless a text is being typed."""
        if not self.model.inside:
            return self.function_list
        return None if self.model.shown_function.accepts_key("a") else self.table_panel

    def has_text_field(self) -> bool:
        """Return whether an open function has a text entry."""
        return self.model.inside and self.model.shown_function.accepts_key("1")

    def find_marked_help(self) -> Sequence[GuideBlock]:
        """Return the guide's section about the displayed function, or its description."""
        shown = self.model.shown_function
        section = read_function_help(shown.name, get_language())
        return (
            GuideBlock(BlockKind.HEADING, tr(shown.name)),
            *(section or (GuideBlock(BlockKind.TEXT, tr(shown.use)),)),
        )

    def _do(self, name: str) -> None:
        self.model.inside = True
        self.model.shown_function.make_function_keys()[name].action()

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: LoadedProgram) -> None:
        """Show the tables for a snapshot."""
        self.model.process_worker_results()
        shown = self.model.shown_function
        sheet = shown.make_table(snapshot)
        self.function_list.mark = (self.model.at, self.model.inside)
        self.table_panel.show_table(sheet)
        self.table_panel.on_select = shown.select_row if shown.row_count else None
        self.table_panel.on_search = shown.find_row_search()
        is_asking = bool(sheet.entry_prompt) and not self.is_searching
        letters = is_asking and shown.accepts_key("a")
        has_number_pad = is_asking and shown.accepts_key("1") and not letters
        if (has_number_pad, letters) != (not self.number_pad.isHidden(), not self.letter_pad.isHidden()):
            self.number_pad.setVisible(has_number_pad)
            self.letter_pad.setVisible(letters)
            self._lay_out()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the list, the table and the touch keypads after a size change."""
        self._lay_out()

    def _lay_out(self) -> None:
        u = self.theme.unit_px
        gap, left = max(4, round(0.7 * u)), round(LIST * u)
        pad = 0 if self.number_pad.isHidden() else round(PAD * u) + gap
        self.function_list.setGeometry(0, 0, left, self.height())
        letters = max(round(LETTER_PAD_HEIGHT * u), self.letter_pad.min_height_px)
        low = 0 if self.letter_pad.isHidden() else letters + gap
        right = self.width() - left - gap
        self.table_panel.setGeometry(left + gap, 0, right - pad, self.height() - low)
        self.letter_pad.setGeometry(left + gap, self.height() - low + gap, right, max(0, low - gap))
        self.number_pad.setGeometry(self.width() - pad + gap, 0, max(0, pad - gap), self.height())
