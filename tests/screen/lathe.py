"""An operator with keys alone in front of the simulated lathe, on a clock that the test moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.mdi.mdi_model import MdiModel
from app.screen.window.main_window import MainWindow
from app.screen.window.window_frame import WindowFrame
from core.executor.snapshot import MachineState, Snapshot
from tests.attached import attached
from tests.screen.pictures import Stage

Key = Qt.Key
LIMIT = 60.0


@dataclass
class Operator:
    """Presses keys, lets the machine go on, and looks."""

    stage: Stage
    window: MainWindow

    @property
    def frame(self) -> WindowFrame:
        assert self.window.frame is not None
        return self.window.frame

    @property
    def shot(self) -> Snapshot:
        return self.stage.desk.read_snapshot()

    @property
    def mdi(self) -> MdiModel:
        return attached(self.stage.desk, MdiModel)

    def key(self, *keys: Key, shift: bool = False) -> None:
        modifier = Qt.KeyboardModifier.ShiftModifier if shift else Qt.KeyboardModifier.NoModifier
        for key in keys:
            QTest.keyClick(self.window, key, modifier)

    def type(self, text: str) -> None:
        QTest.keyClicks(self.window, text)

    def pause(self, seconds: float) -> None:
        later = self.stage.clock.now() + seconds
        self.until(lambda: self.stage.clock.now() >= later)

    def until(self, true: Callable[[], bool], limit: float = LIMIT) -> None:
        self.stage.tick(true, limit)
        self.window.refresh()

    def reaches(self, state: MachineState, limit: float = LIMIT) -> None:
        self.until(lambda: self.shot.state is state, limit)

    def prompt(self) -> str:
        self.window.refresh()
        return self.frame.prompt_line.main_text

    def drives_on(self) -> None:
        self.until(lambda: self.shot.state is MachineState.DISABLED)
        self.key(Key.Key_D)
        self.reaches(MachineState.IDLE)

    def palms(self) -> None:
        """Both palm buttons, and hands off; the relay wants them up for a while before it works again."""
        self.stage.checks_start()
        self.pause(0.9)  # what is started was read
        QTest.keyPress(self.window, Key.Key_F11)
        QTest.keyPress(self.window, Key.Key_F12)
        self.pause(0.1)
        QTest.keyRelease(self.window, Key.Key_F11)
        QTest.keyRelease(self.window, Key.Key_F12)
        self.pause(0.4)

    def line(self, text: str) -> None:
        """Type a line of MDI and have it proved."""
        self.type(text)
        self.key(Key.Key_Return)
        self.mdi.prepared_line.worker.wait_for_results(60.0)
        self.pause(0.02)

    def run(self, text: str) -> None:
        """Type a line, start it, and wait for its end."""
        self.line(text)
        assert self.mdi.prepared_line.ready_job is not None, self.mdi.prepared_line.diagnostics
        self.palms()
        self.reaches(MachineState.IDLE)
