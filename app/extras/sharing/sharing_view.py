"""Page SHARED PROGRAMS (X), with the programs above and the changes in the selected version below."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.table_content import FunctionKey
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.editor.versions_view import VersionList
from app.extras.sharing.sharing_model import SharingModel
from app.screen.page_base import KeyActions, PageHost
from app.screen.table_panel import ListPage, TablePanel
from core.executor.snapshot import Snapshot

LIST_HEIGHT_RATIO = 0.5  # ratio of the height


class SharedProgramsPage(ListPage):
    """Screen page for shared programs. The page passes key presses to its model."""

    NAME = "SHARED PROGRAMS"
    model: SharingModel

    def __init__(self, host: PageHost, model: SharingModel, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.table = TablePanel(self.theme, self._chosen, self)
        self.table.on_select = model.select_row
        self.versions = VersionList(self.theme, model.remote_versions, self)
        self.versions.title = "VERSIONS ON OTHER CONTROLS"
        self.versions.show()

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys that the model provides."""
        return self.model.make_function_keys()

    def make_key_labels(self) -> tuple[str, ...]:
        """Return the labels of the model's function keys and of the scroll keys."""
        return self.make_function_key_labels({"F6": "UP", "F8": "DOWN"}, self.make_function_keys())

    def make_key_actions(self) -> KeyActions:
        """Return the actions of the function keys."""
        keys = self.make_function_keys()
        scroll = {"F6": partial(self._scroll, -1), "F8": partial(self._scroll, 1)}
        return {**scroll, **{name: partial(self._do, name) for name in keys}}

    def _do(self, name: str) -> None:
        self.make_function_keys()[name].action()

    def _scroll(self, pages: int) -> None:
        self.versions.scroll_by(pages * self.versions.rows)

    def _chosen(self, row: int) -> None:
        self.model.select_row(row)

    def find_list(self) -> TablePanel:
        """Return the list of shared programs."""
        return self.table

    def refresh(self, _snapshot: Snapshot, _view: MachineStatus, _loaded: LoadedProgram) -> None:
        """Update the list of programs and the comparison of versions."""
        self.model.update()
        self.table.show_table(self.model.make_table())
        self.versions.refresh()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the list of programs above the comparison of versions."""
        gap = max(4, round(0.7 * self.theme.unit_px))
        high = self.height() if self.is_searching else round(LIST_HEIGHT_RATIO * (self.height() - gap))
        self.table.setGeometry(0, 0, self.width(), high)
        self.versions.setGeometry(0, high + gap, self.width(), self.height() - high - gap)
