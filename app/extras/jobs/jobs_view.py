"""Page JOBS (J or Shift+F6), with the job queue above and the setup of the selected job below."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.table_content import FunctionKey
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.extras.jobs.jobs_model import JobsModel
from app.screen import page_table
from app.screen.entry_panel import LetterPad, NumberPad
from app.screen.page_base import KeyActions, PageHost
from app.screen.table_panel import ListPage, TablePanel
from core.executor.snapshot import Snapshot

PAD, LETTERS, QUEUE = 28.4, 24.0, 0.5  # units; ratio of the height


class JobsPage(ListPage):
    """Screen page for the job queue. The page passes key presses to its model."""

    NAME = "JOBS"
    model: JobsModel

    def __init__(self, host: PageHost, model: JobsModel, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.table = TablePanel(self.theme, self._chosen, self)
        self.table.on_select = model.select_row
        self.setup_table = TablePanel(self.theme, lambda _row: None, self)
        self.number_pad = NumberPad(self.theme, self.handle_touched_key, page_key=None, parent=self)
        self.letter_pad = LetterPad(self.theme, self.handle_touched_key, self)
        self._asked = ""

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the disabled function keys, including F2 if the selected job cannot be loaded."""
        return super().find_disabled_keys() | ({"F2"} if self.model.load_refusal_reason else set())

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys that the model provides."""
        return self.model.make_function_keys()

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the labels of all function keys: F2 from the page and the others from its model."""
        return self.make_function_key_labels({"F2": "LOAD"}, self.make_function_keys())

    def make_key_actions(self) -> KeyActions:
        """Return the actions of the function keys."""
        keys = self.make_function_keys()
        return {"F2": self._load, **{name: partial(self._do, name) for name in keys}}

    def _do(self, name: str) -> None:
        self.make_function_keys()[name].action()

    def _load(self) -> None:
        """Open the Automatic page and load the selected job.

        The Automatic page is opened first because loading can show a question about an interrupted job.
        """
        model = self.model
        if model.can_load_job() and self.host.open_page(page_table.AUTOMATIC):
            model.load_job()

    def _chosen(self, row: int) -> None:
        self.model.select_row(row)

    def find_list(self) -> TablePanel | None:
        """Return the queue, unless the operator is typing a count or a note."""
        return None if self.model.entry_kind else self.table

    def has_text_field(self) -> bool:
        """Return whether the operator is typing a count or a note."""
        return bool(self.model.entry_kind)

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: LoadedProgram) -> None:
        """Update the queue and the setup of the selected job."""
        model = self.model
        model.update()
        self.table.show_table(model.make_table(snapshot))
        self.setup_table.show_table(model.make_setup_table())
        if model.entry_kind != self._asked:
            self._asked = model.entry_kind
            self._lay_out()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the queue, the setup and the on-screen keyboards."""
        self._lay_out()

    def _lay_out(self) -> None:
        u = self.theme.unit_px
        gap = max(4, round(0.7 * u))
        self.number_pad.setVisible(self._asked == "count")
        self.letter_pad.setVisible(self._asked == "note")
        low = max(round(LETTERS * u), self.letter_pad.min_height_px)
        high = self.height() if self.is_searching else round(QUEUE * (self.height() - gap))
        if self._asked == "note":  # the keyboard covers the setup
            high = min(high, self.height() - low - gap)
        pad = round(PAD * u) + gap if self._asked == "count" else 0
        wide = self.width() - pad
        self.table.setGeometry(0, 0, wide, high)
        self.setup_table.setGeometry(0, high + gap, wide, self.height() - high - gap)
        self.number_pad.setGeometry(wide + gap, 0, max(0, pad - gap), self.height())
        self.letter_pad.setGeometry(0, self.height() - low, self.width(), low)
        self.letter_pad.raise_()
