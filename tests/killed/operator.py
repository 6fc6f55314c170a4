"""An operator in a process of his own: the real window, driven by keys, and he tells what he sees.

``python -m tests.killed.operator MACHINE PROGRAM [--again|--idle|--reset]``: types tool 9's offset, makes
parts until he is killed. ``--again``: goes on with a program that the control has kept.
``--idle``: makes none. ``--reset``: presses R when the control is lost.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator, Sequence

from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.desk.status.prompt_line import RESTART_CONTROL
from app.screen.screen_startup import run_screen
from app.screen.window.main_window import MainWindow
from app.screen.window.window_frame import WindowFrame
from core.executor.snapshot import MachineState

LOOK = 20  # ms
Key = Qt.Key


class Operator:
    """Goes on a step whenever he sees what it waits for; a ``False`` is that he does not yet."""

    def __init__(self, words: Sequence[str]) -> None:
        self._again, self._idle = "--again" in words, "--idle" in words
        self._resets = "--reset" in words
        self._steps = self._day()
        self._told: dict[str, object] = {}

    def look(self) -> None:
        """Once in a while; his own timer brings him back."""
        next(self._steps)
        self._tell()
        QTimer.singleShot(LOOK, self.look)

    def _day(self) -> Iterator[bool]:
        while not (self._windows() and self._windows()[0].frame):
            yield False
        if self._again:  # the control goes on from before
            yield from self._until_drawn()
            yield from self._press_palms()
        else:
            yield from self._switch_on()
        while not self._idle:
            if self._resets and self._lost:
                yield from self._reset()
            elif self._asked:
                self._key(Key.Key_Y)  # he has read which job was interrupted, and means to begin anew
                yield from self._wait(1.2)  # an answer is no start: he looks before his hands come down
            elif self._state is MachineState.IDLE and self._checked:
                yield from self._press_palms()
            yield True
        while True:
            yield False

    def _until_drawn(self) -> Iterator[bool]:
        while self._frame.desk.program_loader.loaded_program.picture is None:
            yield False

    def _switch_on(self) -> Iterator[bool]:
        yield from self._until_drawn()
        while self._state is not MachineState.DISABLED:
            yield False
        self._key(Key.Key_D)
        while self._state is not MachineState.IDLE:
            yield False
        yield from self._set_tool_nine()

    def _press_palms(self) -> Iterator[bool]:
        for key in (Key.Key_F11, Key.Key_F12):
            QTest.keyPress(self._window, key)
        yield True
        for key in (Key.Key_F11, Key.Key_F12):
            QTest.keyRelease(self._window, key)
        yield from self._wait(0.6)  # the relay of the two buttons wants them up

    @staticmethod
    def _wait(seconds: float) -> Iterator[bool]:
        over = time.monotonic() + seconds
        while time.monotonic() < over:
            yield False

    def _set_tool_nine(self) -> Iterator[bool]:
        if 9 in self._frame.desk.offset_book.tool_offsets:
            return  # before he was killed
        self._key(Key.Key_F8)
        for _ in range(8):
            self._key(Key.Key_Down)
        for words in ("-.5", "-3.25"):
            yield True
            QTest.keyClicks(self._focus, words)
            self._key(Key.Key_Return)
        book = self._frame.desk.offset_book
        while book is None or 9 not in book.tool_offsets:
            yield False
        self._key(Key.Key_Escape)
        while self._frame.current_page is not self._frame.automatic_page or not self._ready:
            yield False

    def _reset(self) -> Iterator[bool]:
        self._key(Key.Key_R)
        while self._state is not MachineState.DISABLED:
            yield False
        yield from self._switch_on()

    @property
    def _lost(self) -> bool:
        return self._frame.prompt_line.main_text.startswith(RESTART_CONTROL)

    @property
    def _ready(self) -> bool:
        return self._frame.prompt_line.main_text.startswith(("TO START", "PRESS", "LINE"))

    @property
    def _checked(self) -> bool:
        watch = self._frame.desk.start_watch
        return watch is None or not watch.is_checking

    @property
    def _asked(self) -> bool:
        shot = self._frame.desk.read_snapshot()
        return shot.state is MachineState.IDLE and bool(shot.interrupted_line) and not shot.confirmed

    def _tell(self) -> None:
        """What has changed since the last time, as a line of JSON."""
        if not self._windows() or self._windows()[0].frame is None:
            return
        shot = self._frame.desk.read_snapshot()
        now: dict[str, object] = {
            "state": shot.state.value,
            "parts": shot.parts,
            "x": round(shot.actual[0]),  # mm
            # where the axes rest in a feed hold, mm
            "held_at": [round(each, 3) for each in shot.actual[:2] if shot.state is MachineState.HOLD],
            "prompt": self._frame.prompt_line.main_text,
            "alarms": [f"{alarm.text}: {alarm.cause}" for alarm in shot.alarms],
        }
        if now != self._told:
            self._told = now
            sys.stdout.write(json.dumps(now) + "\n")
            sys.stdout.flush()

    def _windows(self) -> list[MainWindow]:
        return [w for w in QApplication.topLevelWidgets() if isinstance(w, MainWindow) and w.isVisible()]

    @property
    def _window(self) -> MainWindow:
        return self._windows()[0]

    @property
    def _frame(self) -> WindowFrame:
        frame = self._window.frame
        assert frame is not None
        return frame

    @property
    def _focus(self) -> QWidget:
        return QApplication.focusWidget() or self._window

    @property
    def _state(self) -> MachineState:
        return self._frame.desk.read_snapshot().state

    def _key(self, key: Qt.Key) -> None:
        QTest.keyClick(self._focus, key)


def main(machine: str, program: str, *words: str) -> int:
    operator = Operator(words)  # Qt alone would let it go
    QTimer.singleShot(LOOK, operator.look)
    return run_screen(machine=machine, program_file=program)


if __name__ == "__main__":
    app = QApplication(sys.argv[:1])
    sys.exit(main(*sys.argv[1:]))
