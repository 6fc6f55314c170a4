"""A million blocks on the screen: loaded, run and drawn, and Feed Hold pressed meanwhile.

The simulated lathe runs by the real clock on its own thread, as in the shop; the window is drawn without a
display. Run with
``python -m tests.benchmarks.bench_screen [BLOCKS]``; the figures are kept for docs/speed.md.
"""

from __future__ import annotations

import math
import os
import random
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

os.environ["QT_QPA_PLATFORM"] = "offscreen"
os.environ["QT_NO_GLIB"] = "1"  # without glib Qt tells before it sleeps that all events are worked off

from PySide6.QtCore import QAbstractEventDispatcher, QEventLoop, QSize
from PySide6.QtWidgets import QApplication

from app.compose.screen_desk import build_desk
from app.compose.stored_offsets import read_offsets_file
from app.desk.programs.program_loading import LoadingPhase
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts, style_application
from app.screen.window.main_window import MainWindow
from core.executor.snapshot import MachineState
from tests.benchmarks.bench_hold import chords
from tests.benchmarks.footprint import keep_result

OFFSETS = "[tool.1]\nx = -1.0\nz = -1.5\n"  # so that four inches towards the chuck are within the travel
PRESSES = 10
LOADING = 900.0  # seconds
TOO_LONG = 0.033  # seconds: two frames of 60 a second


class Window(MainWindow):
    """Remembers when a frame began: by the clock, and by the processor time of this thread."""

    began: tuple[float, float] | None = None
    over: Callable[[], None] | None = None  # the frame before is, also where the thread had no time to sleep

    def _handle_tick(self) -> None:
        if self.over is not None:
            self.over()
        super()._handle_tick()

    def refresh(self) -> None:
        """Once a frame, and after a key."""
        self._begin()
        super().refresh()

    def press_key(self, key_name: str) -> None:
        """What a key does is part of its frame: a page that is opened is made there."""
        self._begin(anew=True)
        super().press_key(key_name)

    def press_to(self, page: str) -> None:
        """The key of a page, wherever it is a key."""
        self._begin(anew=True)
        if self.frame is not None:
            self.frame.open_page(page)
        super().refresh()

    def _begin(self, *, anew: bool = False) -> None:
        if anew and self.over is not None:
            self.over()
        if self.began is None:
            self.began = time.perf_counter(), time.thread_time()


class Frames:
    """How long each frame took, from taking the snapshot until the thread sleeps again, all drawn."""

    def __init__(self, window: Window) -> None:
        self._window = window
        self.times: list[float] = []
        self.cpu: list[float] = []
        self.kept: dict[str, dict[str, float]] = {}
        window.over = self._block
        QAbstractEventDispatcher.instance().aboutToBlock.connect(self._block)

    def _block(self) -> None:
        if self._window.began is not None:
            clock, cpu = self._window.began
            self.times.append(time.perf_counter() - clock)
            self.cpu.append(time.thread_time() - cpu)
            self._window.began = None

    def clear(self) -> None:
        """Forget them."""
        self.times, self.cpu = [], []

    def row(self, name: str) -> str:
        """The figures since the last row."""
        over = sum(value > TOO_LONG for value in self.times)
        self.kept[name] = {"frames": len(self.times), "over 33 ms": over} | {
            word: round(1000.0 * max(values, default=0.0), 1)
            for word, values in (
                ("longest by the clock, ms", self.times),
                ("of processor time, ms", self.cpu),
            )
        }
        shown = f"{name:28s}{_figures(self.times)}   {_figures(self.cpu)}   {over} of {len(self.times)}\n"
        self.clear()
        return shown


def _figures(values: list[float]) -> str:
    ordered = sorted(values) or [0.0]
    chosen = (statistics.median(ordered), ordered[int(len(ordered) * 0.99)], ordered[-1])
    return "".join(f"{value * 1000:7.1f}" for value in chosen)


class Bench:
    """A window on the simulated lathe."""

    def __init__(self, home: Path, size: QSize) -> None:
        self.app = QApplication.instance() or QApplication(sys.argv[:1])
        load_fonts()
        style_application(DARK_PALETTE)
        offsets = home / "offsets.toml"
        offsets.write_text(OFFSETS)
        self.desk = build_desk(None, lambda: read_offsets_file(offsets))
        self.window = Window(ScreenTheme(DARK_PALETTE))
        self.window.resize(size)
        self.window.show()
        self.window.show_model(self.desk)
        self.window.activateWindow()
        self.frames = Frames(self.window)
        self.folder = home / "programs"

    def until(self, true: Callable[[], bool], most: float = 60.0) -> float:
        """Let the screen work until something is so; the seconds it took."""
        begun = time.perf_counter()
        while not true():
            self.app.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents)
            if time.perf_counter() - begun > most:
                raise TimeoutError(f"not so after {most:g} s: {self.desk.read_snapshot().state.value}")
        return time.perf_counter() - begun

    def rest(self, seconds: float) -> None:
        """Let the screen work for a while."""
        end = time.perf_counter() + seconds
        self.until(lambda: time.perf_counter() > end, seconds + 10)

    def say(self, text: str) -> None:
        """One row of the table."""
        sys.stdout.write(text)
        sys.stdout.flush()

    def load(self, blocks: int) -> None:
        """Write, choose, wait until it is proved and drawn."""
        self.folder.mkdir(exist_ok=True)
        (self.folder / "many.nc").write_text(chords(blocks))
        self.rest(0.5)  # the writing was no frame
        self.frames.clear()
        self.desk.program_choice.load_by_name("many")
        session = self.desk.program_loader
        self.until(
            lambda: session.loaded_program.phase in {LoadingPhase.READY, LoadingPhase.REFUSED}, LOADING
        )
        if session.loaded_program.blocking_errors:
            raise ValueError(session.loaded_program.blocking_errors[0].message)
        self.say(self.frames.row("loading"))
        path = self.window.frame.automatic_page.path_view if self.window.frame else None
        assert path is not None
        self.until(lambda: bool(path.panes) and all(pane.is_complete for pane in path.panes))
        self.say(self.frames.row("whole path drawn"))
        for key in ("Zoom in", "Zoom in", "Pan right", "Zoom out", "F5"):
            self.window.press_key(key)
            self.rest(0.3)
        self.say(self.frames.row("zoom, pan and fit"))

    def start(self) -> None:
        """Drives on, both palms."""
        desk = self.desk
        if desk.read_snapshot().state is MachineState.DISABLED:
            desk.enable_drives()
            self.until(lambda: desk.read_snapshot().state is MachineState.IDLE)
        desk.station_controls.palm("left", is_down=True)
        desk.station_controls.palm("right", is_down=True)
        self.until(lambda: desk.read_snapshot().state is MachineState.RUN, 10)
        desk.station_controls.release_all_buttons()

    def hold(self) -> tuple[float, float, float]:
        """Press H; seconds until the screen says so, until it stands, and what is allowed for that."""
        speed = self.desk.read_snapshot().velocity
        begun = time.perf_counter()
        self.window.press_key("H")
        told = self.until(lambda: self.desk.read_snapshot().state is not MachineState.RUN)
        while abs(self.desk.read_snapshot().velocity) > 0.5:
            self.app.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents)
        stood = time.perf_counter() - begun
        self.until(lambda: self.desk.read_snapshot().state is MachineState.HOLD)
        return told, stood, speed


def main() -> None:
    """Print the table."""
    blocks = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    chance = random.Random(1)
    with tempfile.TemporaryDirectory() as home:
        os.environ["TURNDESK_HOME"] = home
        bench = Bench(Path(home), QSize(1920, 1080))
        bench.say(
            f"{f'{blocks} blocks':28s} a frame by the clock, ms   its own processor time   over 33 ms\n"
        )
        bench.say(f"{'':28s}" + 2 * " median    p99   most   " + "\n")
        bench.load(blocks)
        bench.start()
        bench.rest(3)
        bench.say(bench.frames.row("running"))
        told, stood, speeds = [], [], []
        for _ in range(PRESSES):
            bench.rest(0.2 + chance.random())
            a, b, speed = bench.hold()
            told.append(a)
            stood.append(b)
            speeds.append(speed)
            bench.start()
        bench.say(bench.frames.row("running, held and started"))
        for name, values in (("hold told on the screen", told), ("hold: the slides stand", stood)):
            median, most = statistics.median(values) * 1000, max(values) * 1000
            bench.say(f"{name:28s}{median:8.1f} ms{'':11s}{most:8.1f} ms\n")
        bench.say(f"from {statistics.median(speeds):.0f} mm/s, {math.ceil(max(speeds))} at most\n")
        stands = [round(1000.0 * each, 1) for each in (statistics.median(stood), max(stood))]
        figures = {"blocks": blocks, "rows": bench.frames.kept, "a hold stands after, ms": stands}
        bench.say(f"{keep_result('frames', figures)}\n")
        bench.window.press_key("H")
        bench.rest(0.5)
        bench.window.close_silently()
        bench.app.processEvents()
        bench.desk.close()


if __name__ == "__main__":
    main()
