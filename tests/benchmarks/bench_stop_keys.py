"""How soon the control has a feed hold after the Pause key goes down, by the path that the key takes.

``python -m tests.benchmarks.bench_stop_keys [--presses 40] [PATH …]``: PATH is ``screen`` (Qt's event alone),
``thread`` (a thread of the screen with an X connection of its own, a trial) or ``watcher`` (the key watcher,
as in the product). The screen meanwhile is idle, repaints everything all the time, or is blocked for 2 s by a
Python loop or by one call that paints.
"""

from __future__ import annotations

import argparse
import os
import queue
import random
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any
from unittest import mock

from tests.stories.x11 import Server, server

PATHS = ("screen", "thread", "watcher")
LOADS = ("idle", "repaint", "python", "paint")
BLOCKED, ARRIVES, LIMIT = 2.0, 60.0, 30.0  # s
BLOCKS = 8  # of each kind


# --- the control, in its process --------------------------------------------------------------------------


def control(arguments: list[str]) -> int:
    """Run the control; the time of every feed hold goes to standard error."""
    from app.compose.control import control_process  # noqa: PLC0415
    from core.executor.commands import FeedHold  # noqa: PLC0415
    from core.executor.executor import Executor  # noqa: PLC0415

    post = Executor.post

    def stamped(executor: Executor, command: Any, *at: float) -> None:
        if isinstance(command, FeedHold):
            os.write(2, f"\nheld {time.monotonic()!r}\n".encode())
        post(executor, command, *at)

    with mock.patch.object(Executor, "post", stamped):
        return control_process.main(arguments)


# --- the screen, in its process ---------------------------------------------------------------------------


def screen(path: str, words: list[str]) -> int:
    """Run the screen; its load is read from standard input."""
    from PySide6.QtCore import QTimer  # noqa: PLC0415

    from app.cli.main import run_console  # noqa: PLC0415
    from app.screen.window.keyboard import KeyboardFilter  # noqa: PLC0415
    from app.screen.window.main_window import MainWindow  # noqa: PLC0415

    loads: list[_Loads] = []
    begin, opens, watches = subprocess.Popen, MainWindow.show_model, KeyboardFilter.start_key_watcher

    def started(command: list[str], *more: Any, **named: Any) -> Any:
        if "app.compose.control.control_process" in command:
            at = command.index("app.compose.control.control_process")
            command = [*command[:at], __spec__.name, "--control", *command[at + 1 :]]
        return begin(command, *more, **named)

    def opened(window: MainWindow, desk: Any) -> None:
        opens(window, desk)
        if path == "thread":
            threading.Thread(target=_watch, args=(desk,), daemon=True).start()
        loads.append(_Loads(window))
        QTimer.singleShot(3000, loads[0].begin)

    def watched(keyboard: KeyboardFilter, open_line: Any, report_end: Any) -> Any:
        return watches(keyboard, open_line, report_end) if path == "watcher" else None

    sys.argv = ["turndesk", *words]
    with (
        mock.patch("subprocess.Popen", started),
        mock.patch.object(MainWindow, "show_model", opened),
        mock.patch.object(KeyboardFilter, "start_key_watcher", watched),
    ):
        return run_console()


def _watch(desk: Any) -> None:
    """The trial: the same raw events, read by a thread of the screen."""
    import select  # noqa: PLC0415

    from app.desk.stop_keys.raw_keys import RawKeyReader  # noqa: PLC0415
    from core.executor.commands import FeedHold  # noqa: PLC0415

    keys = RawKeyReader()
    while True:
        select.select([keys], [], [])
        for _key in keys.read_key_presses():
            keys.find_focus_window()
            desk.post(FeedHold("thread"))


class _Loads:
    """What the screen does besides."""

    def __init__(self, window: Any) -> None:
        from PySide6.QtCore import QObject, Qt, QTimer, Signal  # noqa: PLC0415

        class Asked(QObject):
            asked = Signal(str)

        self._window, self._signal, self._timer = window, Asked(), QTimer()
        self._signal.asked.connect(self._do, Qt.ConnectionType.QueuedConnection)
        self._timer.timeout.connect(self._repaint)

    def begin(self) -> None:
        threading.Thread(target=self._read, daemon=True).start()
        self._say("ready")

    def _read(self) -> None:
        for line in sys.stdin:
            self._signal.asked.emit(line.strip())

    def _do(self, load: str) -> None:
        self._say("begins")
        if load == "repaint":
            self._timer.start(0)
        elif load == "idle":
            self._timer.stop()
        elif load == "python":
            end, value = time.monotonic() + BLOCKED, 0
            while time.monotonic() < end:
                value += 1
        else:
            _paint()
        self._say(f"done {load}")

    def _repaint(self) -> None:
        from PySide6.QtWidgets import QWidget  # noqa: PLC0415

        for part in self._window.frame.findChildren(QWidget):
            part.update()

    @staticmethod
    def _say(words: str) -> None:
        sys.stdout.write(words + "\n")
        sys.stdout.flush()


def _paint() -> None:
    """One call that paints for about two seconds."""
    from PySide6.QtCore import QPointF  # noqa: PLC0415
    from PySide6.QtGui import QImage, QPainter  # noqa: PLC0415

    chance, image = random.Random(1), QImage(3000, 2000, QImage.Format.Format_RGB32)
    points = [QPointF(chance.random() * 3000, chance.random() * 2000) for _ in range(30_000)]
    with QPainter(image) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.drawPolyline(points)


# --- measuring --------------------------------------------------------------------------------------------


class Bench:
    """A screen that is measured."""

    def __init__(self, stage: Server, home: Path, path: str) -> None:
        self.stage = stage
        self._screen = subprocess.Popen(
            [sys.executable, "-m", __spec__.name, "--screen", path],
            env=stage.environment | {"TURNDESK_HOME": str(home)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._said: queue.Queue[str] = queue.Queue()
        self._held: queue.Queue[float] = queue.Queue()
        for read in (self._hear, self._hear_control):
            threading.Thread(target=read, daemon=True).start()
        self._until("ready", ARRIVES)
        time.sleep(1.0)

    def _hear(self) -> None:
        for line in self._screen.stdout or ():
            self._said.put(line.strip())

    def _hear_control(self) -> None:
        for line in self._screen.stderr or ():
            if line.startswith("held "):
                self._held.put(float(line.split()[1]))
            elif line.strip():
                sys.stderr.write(line)

    def _until(self, words: str, limit: float = LIMIT) -> None:
        while self._said.get(timeout=limit) != words:
            pass

    def load(self, name: str) -> None:
        assert self._screen.stdin is not None
        self._screen.stdin.write(name + "\n")
        self._screen.stdin.flush()
        self._until("begins")

    def press(self) -> float:
        """Press Pause; the seconds until the control has the hold."""
        while not self._held.empty():
            self._held.get()
        begun = time.monotonic()
        self.stage.down("Pause")
        held = self._held.get(timeout=LIMIT)
        self.stage.up("Pause")
        return held - begun

    def presses(self, count: int) -> list[float]:
        """Press so often, at any time."""
        found = []
        for _ in range(count):
            time.sleep(0.1 + random.random() * 0.3)
            found.append(self.press())
        return found

    def blocked(self, load: str) -> list[float]:
        """Press once in each block."""
        found = []
        for _ in range(BLOCKS):
            self.load(load)
            time.sleep(0.2 + random.random() * 0.6)
            found.append(self.press())
            self._until(f"done {load}")
            time.sleep(1.0)
        return found

    def close(self) -> None:
        self._screen.terminate()
        self._screen.wait(LIMIT)


def measure(path: str, presses: int) -> None:
    """Print a row for each load."""
    with tempfile.TemporaryDirectory() as folder, server(Path(folder) / "x") as stage:
        bench = Bench(stage, Path(folder) / "home", path)
        for load in LOADS:
            if load in {"idle", "repaint"}:
                bench.load(load)
                found = bench.presses(presses)
                bench.load("idle")
            else:
                found = bench.blocked(load)
            sys.stdout.write(
                f"{path:8} {load:8} {len(found):3} presses, median {statistics.median(found) * 1e3:7.1f} ms, "
                f"worst {max(found) * 1e3:7.1f} ms\n"
            )
            sys.stdout.flush()
        bench.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--presses", type=int, default=40)
    parser.add_argument("paths", nargs="*", default=list(PATHS))
    chosen = parser.parse_args()
    for path in chosen.paths:
        measure(path, chosen.presses)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--control"]:
        sys.exit(control(sys.argv[2:]))
    if sys.argv[1:2] == ["--screen"]:
        sys.exit(screen(sys.argv[2], sys.argv[3:]))
    main()
