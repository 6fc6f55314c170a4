"""Page of the drive tests: drawing, arrow pad, selection and results."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QRect, QRectF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.programs.program_loading import Loaded
from app.desk.status.machine_status import MachineStatus
from app.desk.translation import tr
from app.extras.analyses.analyses_view import Above, DrawingRoom
from app.extras.analyses.drive_test_model import DriveTests
from app.jog.held_keys_view import HeldKeysPage, JogCross
from app.screen import page_table
from app.screen.look import CENTRE, Look, Painter
from app.screen.page_base import Host, KeyActions
from app.screen.panel import Shown
from app.screen.sheet_panel import SheetPanel
from core.executor.snapshot import Snapshot
from core.message import Message

_TABLE, _HEAD, _PAD = 50.0, 3.4, 0.42  # units, units, ratio of the height


class DriveTestPad(JogCross):
    """Arrow pad of the drive test.

    The first press requests a direction. The next press runs the test while the key is held down.
    """

    shown: Shown[object] = Shown(None)

    def __init__(self, look: Look, model: DriveTests, parent: QWidget) -> None:
        super().__init__(look, model.hold, model.directions, model.finger, parent)
        self._model = model

    def draw(self, painter: Painter) -> None:
        self.controls.clear()
        self.frame(painter, tr("DRIVE TEST  ·  PRESS ARROW, THEN HOLD IT"))
        asked = self._model.hold.asked
        middle = self.cross(painter, QRectF(self.inside()))
        if asked is not None:
            axis, sign = asked
            words = tr(Message("HOLD {direction}", direction=f"{axis}{'+' if sign > 0 else '−'}"))
            painter.write(middle, words, 3.0, "pause", at=CENTRE, margin=0.6)


class DriveTestPage(HeldKeysPage):
    """Page of the drive tests.

    ``refresh`` renews the motion while a key is held down, so that a frozen screen stops the axis.
    """

    NAME = "DRIVE TEST"
    LABELS = ("MENU", "SHAPE", "SIZE", "SPEED", "VALUES", "", "ALARMS", "ANALYZE", "JOG", "")

    model: DriveTests

    def __init__(self, host: Host, model: DriveTests, parent: QWidget) -> None:
        super().__init__(host, model, parent)
        self.above = Above(self.look, self)
        self.drawing = DrawingRoom(self.look, model.scope.filing, self.desk.say, self)
        self.pad: DriveTestPad = DriveTestPad(self.look, model, self)
        self.table = SheetPanel(self.look, model.choose, self)

    def ahead(self) -> bool:
        """Create the chart and its plots in steps, before the page is first shown."""
        self.model.scope.filing.poll()
        return not self.drawing.ready()

    def key_actions(self) -> KeyActions:
        """Return the actions for the selection, the results and the related pages."""
        model = self.model
        return {
            "F2": model.next_shape,
            "F3": model.next_size,
            "F4": model.next_speed,
            "F5": model.toggle_figures,
            "F8": partial(self.host.go, page_table.ANALYSES),
            "F9": partial(self.host.go, page_table.JOG),
        }

    def barred(self) -> frozenset[str]:
        """Return the key of the results as barred until a test has run."""
        return frozenset() if self.model.found is not None else frozenset({"F5"})

    def asks(self) -> str:
        """Return the question about the travel of the next press."""
        return self.model.asks()

    def prompt(self) -> str:
        """Return the prompt for the present state."""
        return self.model.prompt()

    def lively(self) -> bool:
        """Return whether a key is held down."""
        return self.model.active

    def leave(self) -> bool:
        """Stop all motion, and return True."""
        self.pad.let_go()
        self.model.leave()
        return True

    def refresh(self, snapshot: Snapshot, _view: MachineStatus, _loaded: Loaded) -> None:
        """Renew the motion while a key is held down, and update the page."""
        if not self._has_keyboard():
            self.let_go_if_held()
        model = self.model
        model.look(snapshot)
        self.above.words = model.words()
        self.table.show_sheet(model.sheet())
        self.pad.shown = (model.hold.asked, model.hold.held and model.hold.held.source, snapshot.state)
        self.drawing.show_drawing((model.found, model.metric), model.drawing, metric=model.metric)

    def dress(self) -> None:
        """Apply the present colors and language."""
        self.drawing.dress()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Arrange drawing and arrow pad on the left, and the table on the right."""
        u = self.look.u
        gap, side, high = max(4, round(0.7 * u)), round(_TABLE * u), round(_HEAD * u)
        left, pad = self.width() - side - gap, round(_PAD * self.height())
        self.above.setGeometry(0, 0, left, high)
        self.drawing.lay_out(QRect(0, high, left, self.height() - high - pad - gap))
        self.pad.setGeometry(0, self.height() - pad, left, pad)
        self.table.setGeometry(left + gap, 0, side, self.height())
