"""An operator who has nothing but the keyboard and his eyes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.automatic.automatic_view import AutomaticPage
from app.desk.desk import Desk
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window.main_window import MainWindow
from app.screen.window.window_frame import WindowFrame
from core.executor.snapshot import MachineState
from tests.screen.fake import FakeMachine
from tests.texts import text as wording

Key = Qt.Key
LIMIT = 60_000  # ms after which what should have happened has not


@contextmanager
def window_on(qtbot: QtBot, desk: Desk, machine: FakeMachine) -> Iterator[MainWindow]:
    """The window with a desk open in it; both are put away at the end, whatever the machine was at."""
    window = MainWindow(ScreenTheme(DARK_PALETTE))
    window.resize(1024, 600)
    with qtbot.waitExposed(window, timeout=LIMIT):
        window.show()
    window.show_model(desk)
    window.activateWindow()
    yield window
    machine.idle()
    window.close()
    desk.close()
    window.deleteLater()


@dataclass
class Hands:
    """Presses keys where the keyboard is, and waits for what is to be seen."""

    qtbot: QtBot
    window: MainWindow
    desk: Desk
    machine: FakeMachine

    @property
    def page(self) -> AutomaticPage:
        """The Automatic page."""
        return self.frame.automatic_page

    @property
    def frame(self) -> WindowFrame:
        """What he looks at."""
        assert self.window.frame is not None
        return self.window.frame

    def key(self, key: Key, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
        """Press and release one key."""
        QTest.keyClick(QApplication.focusWidget() or self.window, key, modifier)

    def type(self, text: str) -> None:
        """Type a name."""
        QTest.keyClicks(QApplication.focusWidget() or self.window, text)

    def down(self, key: Key) -> None:
        """Press a key and keep it."""
        QTest.keyPress(QApplication.focusWidget() or self.window, key)

    def up(self, key: Key) -> None:
        """Let it go."""
        QTest.keyRelease(QApplication.focusWidget() or self.window, key)

    def both_palms(self) -> None:
        """Cycle start as it is meant."""
        self.down(Key.Key_F11)
        self.down(Key.Key_F12)
        self.up(Key.Key_F11)
        self.up(Key.Key_F12)

    def sees(self, true: Callable[[], bool]) -> None:
        """Wait until something is to be seen."""
        self.qtbot.waitUntil(true, timeout=LIMIT)

    def sees_state(self, state: MachineState) -> None:
        """Wait for a state in the title line."""
        self.sees(lambda: self.frame.title_line.state_text.startswith(state.value))

    def prompt(self) -> str:
        """The prompt line."""
        return self.frame.prompt_line.main_text

    def load(self, name: str) -> None:
        """Pick a program by its name and wait until it may start."""
        self.key(Key.Key_F2)
        self.type(name)
        self.key(Key.Key_Return)
        self.sees(lambda: self.prompt().startswith(wording("screen.to-start")))
