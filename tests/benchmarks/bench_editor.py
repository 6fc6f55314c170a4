"""The editor on 2 000 lines: how long after a key its findings are on the screen, and how long a key takes.

A line in the middle is typed wrong and mended, key by key, with the window at 60 frames a second and no rest
between the keys but a typist's. Run with ``python -m tests.benchmarks.bench_editor``; it needs no display.
"""

from __future__ import annotations

import math
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

os.environ["QT_QPA_PLATFORM"] = "offscreen"

from PySide6.QtCore import QEventLoop, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.compose.program_proving import get_samples_folder
from app.compose.screen_desk import build_desk
from app.compose.stored_offsets import read_offsets_file
from app.editor.editor_view import EditorPage
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts, style_application
from app.screen.window.main_window import MainWindow

LINES = 2000
KEYS = "X9.Y\b\b\b\b"  # each leaves another text; the Y is refused
ROUNDS = 12
TYPIST = 0.12  # seconds from key to key: 100 words a minute


def program() -> str:
    """Finishing passes along a wave: moves, arcs and comments, as long as programs of the trade get."""
    lines = ["G90G94G72F300", "T1", "M03S2000", "X1Z.1", "F5"]
    for k in range(LINES - 8):
        if k % 100 == 99:
            lines.append(f"(PASS {k // 100})")
        else:
            lines.append(f"X{1 + 0.2 * math.sin(k / 9):.4f}Z{-0.01 * (k % 100):.3f}")
    return "\n".join([*lines, "M05", "X2Z1", "M30", ""])


def main() -> None:
    """Print the table."""
    app = QApplication(sys.argv[:1])
    load_fonts()
    style_application(DARK_PALETTE)
    with tempfile.TemporaryDirectory() as home:
        os.environ["TURNDESK_HOME"] = home
        folder = Path(home) / "programs"
        folder.mkdir()
        (folder / "long.nc").write_text(program())
        desk = build_desk(None, lambda: read_offsets_file(get_samples_folder() / "offsets.toml"))
        window = MainWindow(ScreenTheme(DARK_PALETTE))
        window.resize(1920, 1080)
        window.show()
        window.show_model(desk)
        window.activateWindow()
        _measured(app, window)
        window.close_silently()
        app.processEvents()
        desk.close()


def _measured(app: QApplication, window: MainWindow) -> None:
    assert window.frame is not None
    desk = window.frame.desk
    desk.program_choice.load_by_name("long")
    desk.program_loader.wait_until_loaded(60)
    window.press_key("F3")
    page = window.frame.current_page
    assert isinstance(page, EditorPage)
    _until(
        app,
        lambda: (
            page.editor.live_proof.current_findings.picture is not None
            and page.text_field.blockCount() > LINES - 5
        ),
    )
    page.move_cursor_to(LINES // 2, 1)
    keys, found, drawn = [], [], []
    for _ in range(ROUNDS):
        for key in KEYS:
            took, at, path = _key(app, page, key)
            keys.append(took)
            found.append(at)
            drawn.append(path)
    for name, values in (("a key", keys), ("findings shown", found), ("path shown", drawn)):
        _row(name, values)


def _key(app: QApplication, page: EditorPage, key: str) -> tuple[float, float, float]:
    """Press a key; seconds it took, until its findings and until its path were on the screen."""
    checker = page.editor.live_proof
    before, old = checker.current_findings.number, page.path_view.picture
    begun = time.perf_counter()
    if key == "\b":
        QTest.keyClick(page.text_field, Qt.Key.Key_Backspace)
    else:
        QTest.keyClicks(page.text_field, key)
    took = time.perf_counter() - begun
    _until(app, lambda: page.finding_list.findings.number > before)
    at = time.perf_counter() - begun
    _until(app, lambda: page.path_view.picture is not old)
    path = time.perf_counter() - begun
    _until(app, lambda: time.perf_counter() - begun > TYPIST)
    return took, at, path


def _until(app: QApplication, true: Callable[[], bool]) -> None:
    """Sleep from event to event: whoever polls takes the time from the worker that he waits for."""
    while not true():
        app.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents)


def _row(name: str, values: list[float]) -> None:
    ordered = sorted(values)
    figures = (statistics.median(ordered), ordered[int(len(ordered) * 0.99)], ordered[-1])
    shown = "".join(f"{value * 1000:8.1f} ms" for value in figures)
    sys.stdout.write(f"{name:16s}{shown}  (median, p99, most of {len(values)})\n")


if __name__ == "__main__":
    main()
