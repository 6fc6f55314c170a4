"""Page JOBS (J or Shift+F6): queue above, setup of the selected job below."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.sheet import Key
from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.extras.jobs.jobs_model import JobsModel
from app.screen import page_table
from app.screen.entry_panel import KeyPad, LetterPad
from app.screen.page_base import Host, KeyActions
from app.screen.sheet_panel import ListPage, SheetPanel
from core.executor.snapshot import Snapshot

PAD, LETTERS, QUEUE = 28.4, 24.0, 0.5  # units; ratio of the height


class JobsPage(ListPage):
    """Page JOBS: shows its model and passes the keys to it."""

    NAME = "JOBS"
    model: JobsModel

    def __init__(self, host: Host, model: JobsModel, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.table = SheetPanel(self.look, self._chosen, self)
        self.setup = SheetPanel(self.look, lambda _row: None, self)
        self.pad = KeyPad(self.look, self.touched, own=None, parent=self)
        self.letters = LetterPad(self.look, self.touched, self)
        self._asked = ""

    def barred(self) -> frozenset[str]:
        """Return the barred keys of the model, and F2 while no job can be loaded."""
        return super().barred() | ({"F2"} if self.model.load_barred else set())

    def page_keys(self) -> Mapping[str, Key]:
        """Return the function keys of the model."""
        return self.model.keys()

    def labels(self) -> tuple[str, ...]:
        """Return the labels of F2 and of the model."""
        return self.labels_of({"F2": "LOAD"}, self.page_keys())

    def key_actions(self) -> KeyActions:
        """Return the actions of the function keys."""
        keys = self.page_keys()
        return {"F2": self._load, **{name: partial(self._do, name) for name in keys}}

    def _do(self, name: str) -> None:
        self.page_keys()[name].action()

    def _load(self) -> None:
        """Open the Automatic page, then load the job.

        A question about an interrupted job is then visible.
        """
        model = self.model
        if model.may_load() and self.host.go(page_table.AUTOMATIC):
            model.load()

    def _chosen(self, row: int) -> None:
        self.model.choose(row)

    def has_field(self) -> bool:
        """Return whether a count or a note is being typed."""
        return bool(self.model.asking)

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Update queue and setup."""
        model = self.model
        model.look()
        self.table.show_sheet(model.sheet(snapshot))
        self.setup.show_sheet(model.setup())
        if model.asking != self._asked:
            self._asked = model.asking
            self._lay_out()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange queue, setup and pads."""
        self._lay_out()

    def _lay_out(self) -> None:
        u = self.look.u
        gap = max(4, round(0.7 * u))
        self.pad.setVisible(self._asked == "count")
        self.letters.setVisible(self._asked == "note")
        low = max(round(LETTERS * u), self.letters.least)
        high = round(QUEUE * (self.height() - gap))
        if self._asked == "note":  # the keyboard covers the setup
            high = min(high, self.height() - low - gap)
        pad = round(PAD * u) + gap if self._asked == "count" else 0
        wide = self.width() - pad
        self.table.setGeometry(0, 0, wide, high)
        self.setup.setGeometry(0, high + gap, wide, self.height() - high - gap)
        self.pad.setGeometry(wide + gap, 0, max(0, pad - gap), self.height())
        self.letters.setGeometry(0, self.height() - low, self.width(), low)
        self.letters.raise_()
