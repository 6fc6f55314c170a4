"""The Jog page on the executor and the simulated lathe: keys from Qt, time from the test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.stored_offsets import read_store_offsets
from app.desk.desk import Desk
from app.jog.jog_view import JogPage
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme
from app.screen.window.main_window import MainWindow
from app.screen.window.window_frame import WindowFrame
from core.executor.executor import Executor
from core.executor.snapshot import MachineState, Snapshot
from core.store.store import Store
from drivers.wakeups import ManualClock
from tests.offset_store import use_store
from tests.screen.yes import yes

Key = Qt.Key
TICK = 0.01
TICKS_PER_PICTURE = 3
INCH = 25.4
NONE = Qt.KeyboardModifier.NoModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier


# A tool setter, and one tool that stands with its tip on part zero where X is .15 and Z -1.6.
SETTER = """[setter]
x = 0.5
z = 1.0
width = 0.25
overtravel = 0.15
speed = 20
slow = 3
back_off = 0.03

[io.in]
probe = { at = "IN-7" }
jog_x_minus = { at = "IN-8" }
jog_z_plus = { at = "IN-9" }
jog_rapid = { at = "IN-10" }
"""
TIP = "[sim]\ntips = [{ x = 0.15, z = -1.6 }]\n"


def shipped(
    folder: Path, *, absolute: bool, with_c: bool = True, wheel: bool = False, setter: bool = False
) -> str:
    """The shipped machine file; not ``absolute``: its slides only count, and Z is homed before X."""
    text = files("resources").joinpath("machines", "gt75.toml").read_text(encoding="utf-8")
    if not absolute:
        parts = text.split("absolute = true", 2)
        homes = [f"absolute = false\nhome = {{ order = {order}, speed = 60 }}" for order in (2, 1)]
        text = parts[0] + homes[0] + parts[1] + homes[1] + parts[2]
    if not with_c:
        before, c_axis = text.split("[axis.C]", 1)
        text = f"{before}[axis.C]{c_axis.replace('enabled = true', 'enabled = false', 1)}"
    if wheel:
        text += '\n[io.analog]\nhandwheel = { at = "wheel", counts_per_click = 4 }\n'
    if setter:
        text = text.replace("[io.in]\n", SETTER).replace("[sim]\n", TIP)
    path = folder / "lathe.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


@dataclass
class JogBench:
    """One window in front of one lathe."""

    window: MainWindow
    desk: Desk
    executor: Executor
    clock: ManualClock
    store: Store

    @property
    def frame(self) -> WindowFrame:
        """What the operator looks at."""
        assert self.window.frame is not None
        return self.window.frame

    @property
    def page(self) -> JogPage:
        """The Jog page in front."""
        page = self.frame.current_page
        assert isinstance(page, JogPage)
        return page

    @property
    def shot(self) -> Snapshot:
        """The machine of now."""
        return self.executor.snapshot

    def run(self, seconds: float, *, screen: bool = True) -> None:
        """Advance the machine. The screen shows it every 30 ms and at the end."""
        end = self.clock.now() + seconds
        while self.clock.now() < end - 1e-9:
            self._tick(screen=screen)
        if screen:
            self.window.refresh()

    def _tick(self, *, screen: bool = True) -> None:
        self.clock.advance(TICK)
        self.executor.run_tick()
        if screen and self.executor.tick_count % TICKS_PER_PICTURE == 0:
            self.window.refresh()

    def until(self, true: Callable[[], bool], limit: float = 20.0) -> None:
        """Run until something is so."""
        end = self.clock.now() + limit
        while not true():
            assert self.clock.now() < end, f"not within {limit} s: {self.shot.state}, {self.prompt}"
            self._tick()
        self.window.refresh()

    def rests(self) -> None:
        """Run until the machine is ready again."""
        self.until(lambda: self.shot.state is MachineState.IDLE and not self.page.model.held_jog.active_jog)

    def saved(self) -> None:
        """Wait for the disk, then look."""
        self.store.write(lambda _connection: None).result(60)
        self.run(2 * TICK)

    # --- hands ---------------------------------------------------------------------------------------

    def key(self, key: Key, modifier: Qt.KeyboardModifier = NONE) -> None:
        """Press and let go."""
        QTest.keyClick(self.window, key, modifier)

    def down(self, key: Key, modifier: Qt.KeyboardModifier = NONE) -> None:
        """Press and keep."""
        QTest.keyPress(self.window, key, modifier)

    def up(self, key: Key, modifier: Qt.KeyboardModifier = NONE) -> None:
        """Let go."""
        QTest.keyRelease(self.window, key, modifier)

    def repeats(self, key: Key) -> None:
        """What X11 makes of a key that is held: a release and a press, both marked as repeats."""
        for kind in (QEvent.Type.KeyRelease, QEvent.Type.KeyPress):
            QApplication.sendEvent(self.window, QKeyEvent(kind, key, NONE, "", autorep=True))

    def type(self, text: str) -> None:
        """Type, without Return."""
        QTest.keyClicks(self.window, text)

    def enter(self, text: str) -> None:
        """Type and press Return."""
        self.type(text)
        self.key(Key.Key_Return)

    def confirm(self) -> None:
        """Press Y to the question that is asked now, and wait until the change is saved."""
        yes(self.window)
        self.saved()

    @property
    def prompt(self) -> str:
        """The prompt line."""
        self.window.refresh()
        return self.frame.prompt_line.main_text


def bench_on(folder: Path, *, absolute: bool = True, **more: bool) -> JogBench:
    """Desk, lathe and window; the drives are on and the Jog page is open. ``more`` as ``shipped`` has it."""
    clock = ManualClock()
    store = Store.open(folder / "home")
    file = shipped(folder, absolute=absolute, **more)
    desk, executor = create_desk_and_executor(file, lambda: read_store_offsets(store), clock)
    use_store(desk, store)
    desk.station_controls.clock = clock.now
    window = MainWindow(ScreenTheme(DARK_PALETTE))
    window.resize(1024, 600)
    bench = JogBench(window, desk, executor, clock, store)
    bench.executor.run_tick()
    window.show_model(desk)
    window.show()
    return bench


def opened(bench: JogBench) -> None:
    """Drives on, Jog page in front."""
    bench.window.activateWindow()
    bench.run(2 * TICK)
    bench.key(Key.Key_D)
    bench.run(5 * TICK)
    bench.key(Key.Key_F1)
    bench.key(Key.Key_F5)
    bench.run(TICK)
