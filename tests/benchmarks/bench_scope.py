"""The scope at 1920×1080, eight live curves of 100 000 samples: ``python -m tests.benchmarks.bench_scope``.

Told is the time of the screen's thread a frame, from the picture of the machine until all is drawn: processor
time, and by the clock. The window is drawn without a display.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time

os.environ["QT_QPA_PLATFORM"] = "offscreen"

import numpy as np
from PySide6.QtCore import QCoreApplication
from PySide6.QtWidgets import QApplication

from app.scope.scope_model import Scope
from app.scope.scope_view import ScopePage
from app.screen import page_table
from app.screen.look import Look, dress, load_fonts
from app.screen.main_window import MainWindow
from app.screen.theme import DARK
from core.records.record import Record
from tests.scope.played_record import CHANNELS, RATE, PlayedSamples, record_of, seconds
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine

SHOWN = (
    *("X following error", "X velocity", "X actual", "Z following error"),
    *("Z velocity", "Z actual", "spindle command", "spindle speed"),
)
WINDOW = 100.0  # s: 100 000 samples a curve
FRAMES = 600


class LiveSamples(PlayedSamples):
    """Five minutes that were computed before; they go on with the clock."""

    def __init__(self) -> None:
        super().__init__()
        self.all = record_of(seconds(0.0, 400.0))
        noise = np.random.default_rng(7).normal(scale=1.5, size=len(self.all.times))
        self.all.columns["spindle speed"][:] += noise  # type: ignore[index]
        self.began = time.monotonic() - 110.0

    @property
    def last(self) -> float:
        """The newest sample."""
        return float(np.floor((time.monotonic() - self.began) * RATE) / RATE)

    def between(self, begin: float, end: float, _names: object = None) -> Record:
        """Out of what was computed."""
        return self.all.between(begin, min(end, self.last))


def main() -> int:
    """Say the figures; the exit status."""
    with tempfile.TemporaryDirectory() as home:
        os.environ["TURNDESK_HOME"] = home
        app = QApplication.instance() or QApplication(sys.argv[:1])
        load_fonts()
        dress(DARK)
        live = LiveSamples()
        desk = desk_on(FakeMachine(), live=live)
        window = MainWindow(Look(DARK))
        window.resize(1920, 1080)
        window.show()
        window.open_desk(desk)
        window._timer.stop()  # frames are made here, one by one
        assert window.frame is not None
        window.frame.go(page_table.SCOPE)
        page, scope = window.frame.page, desk.attached(Scope)
        assert isinstance(page, ScopePage)
        assert scope is not None
        scope.chosen = SHOWN
        scope.window.begin = -WINDOW
        _frames(window, page, 60)
        frames, drawn = _frames(window, page, FRAMES)
        _tell(frames, drawn)
        window.put_away()
        desk.close()
        app.processEvents()
    return 0


def _frames(window: MainWindow, page: ScopePage, count: int) -> tuple[np.ndarray, int]:
    """Processor time and time by the clock of so many frames, ms; how many showed another picture."""
    found, drawn, before = [], 0, None
    for _ in range(count):
        clock, cpu = time.perf_counter(), time.thread_time()
        window.refresh()
        QCoreApplication.processEvents()
        found.append((1e3 * (time.thread_time() - cpu), 1e3 * (time.perf_counter() - clock)))
        drawn += page.scope.sight is not before
        before = page.scope.sight
        time.sleep(max(0.0, 0.016 - (time.perf_counter() - clock)))
    return np.array(found), drawn


def _tell(frames: np.ndarray, drawn: int) -> None:
    out = sys.stdout.write
    out(f"{len(SHOWN)} curves of {WINDOW * RATE:.0f} samples, {len(CHANNELS)} channels, 1920×1080\n")
    for name, column in (("processor time", frames[:, 0]), ("by the clock", frames[:, 1])):
        middle, high = np.percentile(column, (50, 99))
        out(f"a frame, {name}: {middle:.1f} ms median, {high:.1f} p99, {column.max():.1f} at most\n")
    out(f"{drawn} of {len(frames)} frames showed a new picture; over 33 ms: {(frames[:, 1] > 33).sum()}\n")


if __name__ == "__main__":
    sys.exit(main())
