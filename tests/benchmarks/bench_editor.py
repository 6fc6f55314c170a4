"""The editor on 2 000 lines: how long after a key its findings are on the screen, and how long a key takes.

A line in the middle is typed wrong and mended, key by key, with the window at 60 frames a second and no rest
between the keys but a typist's. Then a program of 1 000 000 lines is opened, typed in, searched and saved.
Run with ``python -m tests.benchmarks.bench_editor``; it needs no display.
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
from app.editor.editor_model import EditorStage
from app.editor.editor_view import EditorPage
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts, style_application
from app.screen.window.main_window import MainWindow

LINES = 2000
KEYS = "X9.Y\b\b\b\b"  # each leaves another text; the Y is refused
ROUNDS = 12
LONG_LINES = 1_000_000
LONG_PROOF_LIMIT_S = 600.0
TYPIST = 0.12  # seconds from key to key: 100 words a minute


def program(line_count: int = LINES) -> str:
    """Finishing passes along a wave: moves, arcs and comments, as long as programs of the trade get."""
    lines = ["G90G94G72F300", "T1", "M03S2000", "X1Z.1", "F5"]
    for k in range(line_count - 8):
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
        (folder / "million.nc").write_text(program(LONG_LINES))
        desk = build_desk(None, lambda: read_offsets_file(get_samples_folder() / "offsets.toml"))
        window = MainWindow(ScreenTheme(DARK_PALETTE))
        window.resize(1920, 1080)
        window.show()
        window.show_model(desk)
        window.activateWindow()
        _measured(app, window)
        window.press_key("F10")
        _until(app, lambda: window.frame is not None and window.frame.current_page.NAME != EditorPage.NAME)
        _measure_long_program(app, window, folder)
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


def _measure_long_program(app: QApplication, window: MainWindow, folder: Path) -> None:
    """Open a long loaded program in the editor, and print how long each action takes."""
    assert window.frame is not None
    desk = window.frame.desk
    desk.program_choice.load_by_name("million")
    desk.program_loader.wait_until_loaded(LONG_PROOF_LIMIT_S)
    memory_mb = _read_memory_mb()
    begun = time.perf_counter()
    window.press_key("F3")
    page = window.frame.current_page
    assert isinstance(page, EditorPage)
    frames = _watch_frames(app, lambda: page.text_field.blockCount() > LONG_LINES - 5)
    _row("open, 10^6 lines", [time.perf_counter() - begun])
    _row("  frames", frames)
    for name, line in (("start", 1), ("middle", LONG_LINES // 2), ("end", LONG_LINES - 20)):
        page.move_cursor_to(line, 1)
        _type_in_long_program(app, page, name)
    begun = time.perf_counter()
    frames = _watch_frames(
        app, lambda: not page.text_synchronizer.is_stale and not page.editor.live_proof.is_outdated
    )
    _row("proof of all lines", [time.perf_counter() - begun])
    _row("  frames", frames)
    sys.stdout.write(f"memory of the editor {_read_memory_mb() - memory_mb:8.0f} MB\n")
    _find_and_save(app, window, page, folder)


def _type_in_long_program(app: QApplication, page: EditorPage, name: str) -> None:
    """Type and erase at one place. Each key waits for the next frame."""
    keys, frames = [], []
    for _ in range(ROUNDS):
        for key in KEYS:
            begun = time.perf_counter()
            if key == "\b":
                QTest.keyClick(page.text_field, Qt.Key.Key_Backspace)
            else:
                QTest.keyClicks(page.text_field, key)
            keys.append(time.perf_counter() - begun)
            end = begun + TYPIST
            frames += _watch_frames(app, lambda end=end: time.perf_counter() > end)  # type: ignore[misc]
    _row(f"a key at the {name}", keys)
    _row("  frames", frames)


def _find_and_save(app: QApplication, window: MainWindow, page: EditorPage, folder: Path) -> None:
    window.press_key("F4")
    page.question_line.first_field.setText("Z-0.980")
    for name, direction in (("find first", 1), ("find next", 1), ("find previous", -1)):
        begun = time.perf_counter()
        page.text_finder.select_match(direction)
        _row(name, [time.perf_counter() - begun])
    page.question_line.second_field.setText("Z-0.981")
    begun = time.perf_counter()
    page.text_finder.replace_all_matches()
    _row("replace all", [time.perf_counter() - begun])
    begun = time.perf_counter()
    page.text_field.undo()
    _row("undo", [time.perf_counter() - begun])
    page.return_to_text()
    before = (folder / "million.nc").stat().st_mtime_ns
    page.text_field.insert_text(" ")
    begun = time.perf_counter()
    page.save_text()
    frames = _watch_frames(app, lambda: page.editor.stage is EditorStage.OPEN)
    assert (folder / "million.nc").stat().st_mtime_ns != before
    _row("save", [time.perf_counter() - begun])
    _row("  frames", frames)


def _watch_frames(app: QApplication, is_done: Callable[[], bool]) -> list[float]:
    """Return the durations of the passes of the event loop until ``is_done`` is true."""
    frames = []
    end = time.perf_counter() + LONG_PROOF_LIMIT_S
    while not is_done() and time.perf_counter() < end:
        begun = time.perf_counter()
        app.processEvents()
        frames.append(time.perf_counter() - begun)
        time.sleep(0.002)
    return frames


def _read_memory_mb() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


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
