"""A day at the lathe: one operator, keys alone, an empty shop to begin with, the clock in the test's hand.

Everything is the product's: its desk, its executor, the simulated lathe, its store. Where the slides really
stand is asked of the lathe and of nobody else.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import read_stored_offsets
from app.desk.data_folder import find_data_folder
from app.desk.desk import Desk
from app.programs.atomic_files import write_program_file
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window.main_window import MainWindow
from app.screen.window.window_frame import WindowFrame
from core.executor.executor import Executor
from core.executor.snapshot import MachineState, Snapshot
from core.store.store import Store
from drivers.simulators.plant_controls import PlantControls
from drivers.wakeups import ManualClock

Key = Qt.Key
NONE, SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
INCH = 25.4
TICK = 0.01
NEAR = 0.0005  # inch: what a slide in position may be off, and more than any wrong figure here would be
PATIENCE = 60_000  # ms for workers that read, prove and draw


@dataclass
class Day:
    """Presses keys, lets the machine go on, and looks."""

    qtbot: QtBot
    window: MainWindow
    desk: Desk
    executor: Executor
    clock: ManualClock
    journal: Journal

    @property
    def frame(self) -> WindowFrame:
        """What is on the screen."""
        assert self.window.frame is not None
        return self.window.frame

    @property
    def page(self) -> str:
        """The page that the title line names."""
        self.window.refresh()
        return self.frame.title_line.page_title

    @property
    def prompt(self) -> str:
        """The prompt line."""
        self.window.refresh()
        return self.frame.prompt_line.main_text

    @property
    def shot(self) -> Snapshot:
        """The machine of now."""
        return self.executor.snapshot

    @property
    def slides(self) -> tuple[float, float]:
        """Where X and Z of the lathe really stand, inches from home."""
        assert isinstance(self.desk.desk_control.station_panel, PlantControls)
        x, z = self.desk.desk_control.station_panel.get_true_positions()[:2]
        return x / INCH, z / INCH

    # --- hands ---------------------------------------------------------------------------------------

    def key(self, *keys: Key, modifier: Qt.KeyboardModifier = NONE) -> None:
        """Press and let go, where the keyboard is."""
        for key in keys:
            QTest.keyClick(QApplication.focusWidget() or self.window, key, modifier)

    def type(self, text: str) -> None:
        """Type, without Return."""
        QTest.keyClicks(QApplication.focusWidget() or self.window, text)

    def enter(self, *texts: str) -> None:
        """Type each and press Return."""
        for text in texts:
            self.type(text)
            self.key(Key.Key_Return)
            self.run(0.05)

    def palms(self) -> None:
        """Both palm buttons and hands off; their relay wants them up for a while before it works again."""
        self.checks_start()
        self.run(0.9)  # what is started was read
        for press, pause in ((QTest.keyPress, 0.1), (QTest.keyRelease, 0.4)):
            for key in (Key.Key_F11, Key.Key_F12):
                press(QApplication.focusWidget() or self.window, key)
            self.run(pause)

    # --- time ----------------------------------------------------------------------------------------

    def run(self, seconds: float) -> None:
        """So much time on the machine and on the screen."""
        end = self.clock.now() + seconds
        while self.clock.now() < end - 1e-9:
            self._tick()

    def until(self, true: Callable[[], bool], limit: float = 60.0) -> None:
        """Let the machine go on until something is so."""
        end = self.clock.now() + limit
        while not true():
            assert self.clock.now() < end, f"not within {limit} s: {self.shot.state}, {self.prompt}"
            self._tick()

    def reaches(self, *states: MachineState) -> None:
        """Until the machine is in one of these states."""
        self.until(lambda: self.shot.state in states)

    def sees(self, true: Callable[[], bool]) -> None:
        """Wait for a worker: reading, proving, drawing and writing take their own time."""

        def look() -> bool:
            self._tick()
            return true()

        self.qtbot.waitUntil(look, timeout=PATIENCE)

    def checks_start(self) -> None:
        """The first move of the next start is checked, and the control knows it."""
        self.run(2 * TICK)
        self.sees(lambda: self.desk.start_watch is None or not self.desk.start_watch.is_checking)
        self.run(2 * TICK)

    def saved(self) -> None:
        """Wait for the disk, then look."""
        assert self.desk.offset_book.store is not None
        self.desk.offset_book.store.write(lambda _connection: None).result(60)
        self.run(2 * TICK)

    def _tick(self) -> None:
        self.clock.advance(TICK)
        self.executor.run_tick()
        self.window.refresh()

    # --- what is kept --------------------------------------------------------------------------------

    @property
    def store(self) -> Store:
        """What the lathe remembers."""
        assert self.desk.offset_book.store is not None
        return self.desk.offset_book.store

    def count(self, kind: str) -> int:
        """So many events of this kind are in the store."""
        self.saved()
        return len(self.journal.events("", [kind], 1000))


@contextmanager
def begun(qtbot: QtBot, name: str = "", program: str = "", machine: str | None = None) -> Iterator[Day]:
    """The desk is switched on, with a program in its folder or none; put away again afterwards.

    ``machine`` names another machine file than the lathe's.
    """
    if name:
        write_program_file(find_data_folder() / "programs" / name, program.encode())
    clock, journal = ManualClock(), Journal.open_default()
    desk, executor = create_desk_and_executor(machine, read_stored_offsets, clock, journal)
    desk.station_controls.clock = clock.now
    window = MainWindow(ScreenTheme(DARK_PALETTE))
    window.resize(1024, 600)
    executor.run_tick()
    window.show_model(desk)
    with qtbot.waitExposed(window, timeout=PATIENCE):
        window.show()
    window.activateWindow()
    try:
        yield Day(qtbot, window, desk, executor, clock, journal)
    finally:
        window.close_silently()
        desk.close()
        journal.close()
