"""Page of the drive test, with drawing, arrow pad, test settings and results."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QRect, QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.extras.analyses.analyses_view import DescriptionLine, DrawingArea
from app.extras.analyses.drive_test_model import DriveTestModel
from app.jog.held_keys_view import HeldKeysPage, JogCross
from app.screen import page_table
from app.screen.page_base import KeyActions, PageHost
from app.screen.panel import RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ScreenTheme, ThemedPainter
from app.screen.table_panel import TablePanel
from core.executor.snapshot import Snapshot
from core.message import Message

_TABLE, _HEAD, _PAD = 50.0, 3.4, 0.42  # units, units, ratio of the height


class DriveTestPad(JogCross):
    """Arrow pad of the drive test.

    The first press shows the travel. The next press runs the test while the key is held down.
    """

    displayed_state: RedrawingAttribute[object] = RedrawingAttribute(None)

    def __init__(self, theme: ScreenTheme, model: DriveTestModel, parent: QWidget) -> None:
        super().__init__(theme, model.held_jog, model.directions, model.handle_direction_press, parent)
        self._model = model

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the arrow keys, and label the direction key that the operator must hold down."""
        self.controls.clear()
        self.frame(painter, tr("DRIVE TEST  ·  PRESS ARROW, THEN HOLD IT"))
        asked = self._model.held_jog.requested_direction
        middle = self.draw_cross(painter, QRectF(self.inside()))
        if asked is not None:
            axis, sign = asked
            words = tr(Message("HOLD {direction}", direction=f"{axis}{'+' if sign > 0 else '−'}"))
            painter.draw_text_line(middle, words, 3.0, "pause", at=ALIGN_CENTER, margin=0.6)


class DriveTestPage(HeldKeysPage):
    """Page of the drive test.

    ``refresh`` renews the motion lease of a held key. If the screen freezes, the lease expires and the axis
    stops.
    """

    NAME = "DRIVE TEST"
    LABELS = ("MENU", "SHAPE", "SIZE", "SPEED", "VALUES", "", "ALARMS", "ANALYZE", "JOG", "")

    model: DriveTestModel

    def __init__(self, host: PageHost, model: DriveTestModel, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.description = DescriptionLine(self.theme, self)
        self.drawing = DrawingArea(self.theme, model.scope.file_worker, self.desk.say, self)
        self.jog_cross: DriveTestPad = DriveTestPad(self.theme, model, self)
        self.table = TablePanel(self.theme, model.change_setting, self)

    def continue_preparation(self) -> bool:
        """Create a part of the chart in advance, and return whether more parts must be created."""
        self.model.scope.file_worker.deliver_results()
        return not self.drawing.is_ready()

    def make_key_actions(self) -> KeyActions:
        """Return the actions of the keys for the selection, the results and related pages."""
        model = self.model
        return {
            "F2": model.select_next_shape,
            "F3": model.select_next_size,
            "F4": model.select_next_speed,
            "F5": model.show_next_results,
            "F8": partial(self.host.open_page, page_table.ANALYSES),
            "F9": partial(self.host.open_page, page_table.JOG),
        }

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the disabled keys: F5 (results) before the first test, and no keys afterward."""
        return frozenset() if self.model.results is not None else frozenset({"F5"})

    def find_pending_question(self) -> str:
        """Return the pending question about the travel of the next test, or else an empty string."""
        return self.model.make_travel_question()

    def prompt_text(self) -> str:
        """Return the prompt for the current state."""
        return self.model.prompt_text()

    def is_animating(self) -> bool:
        """Return whether the page shows live measurements because a test key is held down."""
        return self.model.is_active

    def try_leave_page(self) -> bool:
        """Stop all motion, and return True because the page can always close."""
        self.jog_cross.release_all_controls()
        self.model.stop_test()
        return True

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: LoadedProgram) -> None:
        """Renew the motion lease while a key is held down, and update the page."""
        if not self._has_keyboard():
            self.stop_if_active()
        model = self.model
        model.update(snapshot)
        self.description.description_text = model.describe_drawing()
        self.table.show_table(model.make_table())
        self.jog_cross.displayed_state = (
            model.held_jog.requested_direction,
            model.held_jog.active_jog and model.held_jog.active_jog.input_source,
            snapshot.state,
        )
        self.drawing.show_drawing(
            (model.results, model.is_metric), model.make_drawing, metric=model.is_metric
        )

    def apply_theme(self) -> None:
        """Apply the current colors and language."""
        self.drawing.apply_theme()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange the drawing and the arrow pad on the left, and the table on the right."""
        u = self.theme.unit_px
        gap, side, high = max(4, round(0.7 * u)), round(_TABLE * u), round(_HEAD * u)
        left, pad = self.width() - side - gap, round(_PAD * self.height())
        self.description.setGeometry(0, 0, left, high)
        self.drawing.lay_out(QRect(0, high, left, self.height() - high - pad - gap))
        self.jog_cross.setGeometry(0, self.height() - pad, left, pad)
        self.table.setGeometry(left + gap, 0, side, self.height())
