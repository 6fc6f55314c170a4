"""The scope at 1920×1080, eight live curves of 100 000 samples: ``python -m tests.benchmarks.bench_scope``.

Words choose what is measured: ``played`` shows samples that were computed before, ``running`` those of a
program that the simulated lathe runs by the real clock, ``scope`` and ``analyses`` open the first chart of a
process on that page while the program runs, ``hurried`` the scope on a desk that had no time to make
anything ahead, ``pages`` every page once. Told is the time of the screen's thread a frame, from the key or
the picture of the machine until all is drawn, and by how much ticks of the control came late. The window is
drawn without a display.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from PySide6.QtCore import QCoreApplication, QSize
from PySide6.QtWidgets import QApplication

from app.desk.programs.program_loading import LoadingPhase
from app.scope.scope_model import ScopeModel
from app.scope.scope_view import ScopePage
from app.screen import page_table
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts, style_application
from app.screen.window.main_window import MainWindow
from core.executor.scope_recorder import ScopeRecorder
from core.records.record import ScopeRecord
from tests.benchmarks.bench_screen import Bench
from tests.scope.played_record import CHANNELS, RATE, PlayedSamples, record_of, seconds
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine

SHOWN = (
    *("X following error", "X velocity", "X actual", "Z following error"),
    *("Z velocity", "Z actual", "spindle command", "spindle speed"),
)
WINDOW = 100.0  # s: 100 000 samples a curve
FRAMES = 600
RUNS = 20.0  # s of a program with the scope open
OPENS = 4.0  # s from the key that opens the first chart
PASSES = 1000
SIZE = QSize(1920, 1080)


class LiveSamples(PlayedSamples):
    """Five minutes that were computed before; they go on with the clock."""

    def __init__(self) -> None:
        super().__init__()
        self.all = record_of(seconds(0.0, 400.0))
        noise = np.random.default_rng(7).normal(scale=1.5, size=len(self.all.times_s))
        self.all.values_by_channel["spindle speed"][:] += noise
        self.began = time.monotonic() - 110.0

    @property
    def newest_time_s(self) -> float:
        """The newest sample."""
        return float(np.floor((time.monotonic() - self.began) * RATE) / RATE)

    def read_samples_between(self, start_s: float, end_s: float, _names: object = None) -> ScopeRecord:
        """Out of what was computed."""
        return self.all.select_time_range(start_s, min(end_s, self.newest_time_s))


# --- samples that were computed ----------------------------------------------------------------------------


def played() -> None:
    """Frames of curves that are played."""
    with tempfile.TemporaryDirectory() as home:
        os.environ["TURNDESK_HOME"] = home
        app = QApplication.instance() or QApplication(sys.argv[:1])
        load_fonts()
        style_application(DARK_PALETTE)
        live = LiveSamples()
        desk = desk_on(FakeMachine(), live=live)
        window = MainWindow(ScreenTheme(DARK_PALETTE))
        window.resize(SIZE)
        window.show()
        window.show_model(desk)
        window._timer.stop()  # frames are made here, one by one
        assert window.frame is not None
        window.frame.open_page(page_table.SCOPE)
        page, scope = window.frame.current_page, desk.page_registry.find_model(ScopeModel)
        assert isinstance(page, ScopePage)
        assert scope is not None
        scope.selected_signal_keys = SHOWN
        scope.time_window.begin_s = -WINDOW
        _frames(window, page, 60)
        frames, drawn = _frames(window, page, FRAMES)
        _tell(frames)
        say(f"{drawn} of {len(frames)} frames showed a new picture; {len(CHANNELS)} channels\n")
        window.close_silently()
        desk.close()
        app.processEvents()


def _frames(window: MainWindow, page: ScopePage, count: int) -> tuple[np.ndarray, int]:
    """Processor time and time by the clock of so many frames, ms; how many showed another picture."""
    found, drawn, before = [], 0, None
    for _ in range(count):
        clock, cpu = time.perf_counter(), time.thread_time()
        window.refresh()
        QCoreApplication.processEvents()
        found.append((1e3 * (time.thread_time() - cpu), 1e3 * (time.perf_counter() - clock)))
        drawn += page.scope_model.picture is not before
        before = page.scope_model.picture
        time.sleep(max(0.0, 0.016 - (time.perf_counter() - clock)))
    return np.array(found), drawn


# --- a program that runs -----------------------------------------------------------------------------------


def program() -> str:
    """A long roughing: something changes in every sample."""
    lines = ["G90G94F300", "T1(TURNING TOOL)", "M03S1200", "X1.1Z.1"]
    for number in range(PASSES):
        lines += [f"G94F300X{1.0 - 0.0005 * number:.4f}", "G95F.02Z-1", "G94F300X1.1", "Z.1"]
    return "\n".join((*lines, "M30\n"))


def running() -> None:
    """Frames with the scope open, once its window is full of samples of the program."""
    with tempfile.TemporaryDirectory() as home:
        bench, _recorder = _on_a_run(Path(home))
        scope = bench.desk.page_registry.find_model(ScopeModel)
        assert scope is not None
        bench.window.press_key("Scope")
        scope.selected_signal_keys = SHOWN
        scope.time_window.begin_s = -WINDOW
        bench.rest(WINDOW + 5.0)
        bench.frames.clear()
        begun = scope.live_samples.newest_time_s if scope.live_samples is not None else 0.0
        bench.rest(RUNS)
        _tell(_of(bench))
        _late(_recorder, begun)
        _end(bench)


def opening(key: str, *then: str) -> None:
    """The first chart of this process is opened by a key while the program runs."""
    with tempfile.TemporaryDirectory() as home:
        bench, recorder = _on_a_run(Path(home))
        bench.rest(5.0)
        bench.frames.clear()
        bench.rest(OPENS)
        say("before\n")
        _tell(_of(bench))
        begun = recorder.ring.samples.last_time_s
        _late(recorder, begun - OPENS)
        _opened(bench, recorder, key, *then)
        _end(bench)


def hurried() -> None:
    """The scope is opened at once, in the first program, which is run before the desk has rested."""
    with tempfile.TemporaryDirectory() as home:
        bench, recorder = _on_a_run(Path(home), rested=False)
        _opened(bench, recorder, "Scope")
        _end(bench)


def _opened(bench: Bench, recorder: ScopeRecorder, *keys: str) -> None:
    begun = recorder.ring.samples.last_time_s
    bench.frames.clear()
    for each in keys:
        bench.window.press_key(each)
        bench.rest(OPENS / 2)
    bench.rest(OPENS / 2)
    say(f"{' '.join(keys)}\n")
    assert "pyqtgraph" in sys.modules
    _tell(_of(bench))
    _late(recorder, begun)


def pages() -> None:
    """Every page is opened for the first time while the program runs."""
    with tempfile.TemporaryDirectory() as home:
        bench, recorder = _on_a_run(Path(home))
        frame = bench.window.frame
        assert frame is not None
        begun = recorder.ring.samples.last_time_s
        for entry in page_table.list_pages(bench.desk.machine.program_language):
            bench.frames.clear()
            bench.window.press_to(entry.name)
            bench.rest(0.5)
            cpu, clock = _of(bench).max(axis=0)
            say(f"  {entry.name:20s} most {cpu:5.1f} ms of the processor, {clock:5.1f} by the clock\n")
        _late(recorder, begun)
        _end(bench)


def _on_a_run(home: Path, *, rested: bool = True) -> tuple[Bench, ScopeRecorder]:
    """A desk whose program has begun; ``rested``: all that is made ahead is there."""
    os.environ["TURNDESK_HOME"] = str(home)
    bench = Bench(home, SIZE)
    bench.folder.mkdir(exist_ok=True)
    (bench.folder / "fro.nc").write_text(program())
    bench.desk.program_choice.load_by_name("fro")
    session = bench.desk.program_loader
    bench.until(lambda: session.loaded_program.phase in {LoadingPhase.READY, LoadingPhase.REFUSED})
    assert not session.loaded_program.blocking_errors, session.loaded_program.blocking_errors[0].message
    if rested:
        bench.until(lambda: bench.window.page_preloader is not None and bench.window.page_preloader.is_done)
    bench.start()
    recorder = bench.desk.desk_control.recordings
    assert isinstance(recorder, ScopeRecorder)
    return bench, recorder


def _end(bench: Bench) -> None:
    bench.window.press_key("H")
    bench.rest(0.5)
    bench.window.close_silently()
    bench.app.processEvents()
    bench.desk.close()


def _of(bench: Bench) -> np.ndarray:
    return 1e3 * np.column_stack([bench.frames.cpu, bench.frames.times])


# --- the table ---------------------------------------------------------------------------------------------


def _tell(frames: np.ndarray) -> None:
    for name, column in (("processor time", frames[:, 0]), ("by the clock", frames[:, 1])):
        middle, high = np.percentile(column, (50, 99))
        over = f"{(column > 33).sum()} of {len(column)} over 33 ms"
        figures = f"{middle:5.1f} ms median, {high:5.1f} p99, {column.max():5.1f} most"
        say(f"  a frame, {name:14s}: {figures}; {over}\n")


def _late(recorder: ScopeRecorder, since: float) -> None:
    """By how much ticks came late since an instant of the record."""
    late = 1e3 * recorder.get_record_between(since, np.inf, {"lateness"}).values_by_channel["lateness"]
    late = late[np.isfinite(late)]
    say(f"  the control late: {np.percentile(late, 99):.1f} ms p99, {late.max(initial=0.0):.1f} most\n")


def say(text: str) -> None:
    """Part of the table."""
    sys.stdout.write(text)
    sys.stdout.flush()


CASES: dict[str, Callable[[], None]] = {
    "played": played,
    "running": running,
    "scope": partial(opening, "Scope"),
    "analyses": partial(opening, "Scope", "F8"),
    "hurried": hurried,
    "pages": pages,
}


def main() -> int:
    """Each case in a process of its own: the library that draws charts is loaded once in one."""
    names = sys.argv[1:] or list(CASES)
    if len(names) == 1:
        curves = f"{len(SHOWN)} curves of {WINDOW * RATE:.0f} samples"
        say(f"{names[0]}, load {os.getloadavg()[0]:.1f}; {curves} in played and running\n")
        CASES[names[0]]()
        return 0
    words = [sys.executable, "-m", "tests.benchmarks.bench_scope"]
    return max(subprocess.run([*words, name], check=False).returncode for name in names)


if __name__ == "__main__":
    sys.exit(main())
