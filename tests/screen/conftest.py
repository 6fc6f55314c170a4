"""Screen tests run without a display, and leave nothing behind."""

from __future__ import annotations

import gc
import os
import threading
from collections.abc import Iterator
from pathlib import Path

os.environ["QT_QPA_PLATFORM"] = "offscreen"

import pytest
import shiboken6
from PySide6.QtCore import QCoreApplication, QEvent, Qt, QThread, QTimer
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.compose.runs.journal import Journal
from app.desk.desk import Desk
from app.desk.translation import ENGLISH_CODE
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts, set_language, style_application
from app.screen.window import input_times
from app.screen.window.main_window import MainWindow
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, window_on
from tests.screen.lathe import Operator
from tests.screen.pictures import Stage

STALL = input_times.STALL_TIME_S


def left_over(*, collect: bool) -> list[str]:
    """Return the windows, timers, threads and mouse buttons left over; without ``collect`` also garbage."""
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    if collect:
        gc.collect()
    names = [thread.name for thread in threading.enumerate()]
    found = [f"thread {name}" for name in names if name.startswith(("loading", "editing"))]
    if QApplication.mouseButtons() is not Qt.MouseButton.NoButton:
        found.append("a mouse button held down")
    found += [f"window {widget}" for widget in QApplication.topLevelWidgets() if widget.isVisible()]
    for thing in shiboken6.getAllValidWrappers():
        if not isinstance(thing, QTimer | QThread):
            continue  # nearly all of ten thousand colors, fonts and widgets
        if isinstance(thing, QTimer):
            if thing.isActive():
                found.append(f"timer of {thing.parent()}")
        elif thing.isRunning() and thing is not QThread.currentThread():
            found.append(f"thread {thing}")
    return found


@pytest.fixture(autouse=True)
def nothing_left(qapp: QApplication) -> Iterator[None]:
    """Fails a test that leaks; set up first, so that it looks last."""
    before = set(left_over(collect=False))
    yield
    leaked = [name for name in left_over(collect=True) if name not in before]
    set_language(
        ENGLISH_CODE
    )  # a window on the desk speaks its language in every picture, also in the last one
    assert not leaked, f"left over: {leaked}"


@pytest.fixture(autouse=True)
def never_late(monkeypatch: pytest.MonkeyPatch) -> None:
    """No key and no finger is late, however busy this computer is; ``stalls`` is for those that play it."""
    monkeypatch.setattr(input_times, "STALL_TIME_S", float("inf"))


@pytest.fixture
def stalls(monkeypatch: pytest.MonkeyPatch, never_late: None) -> None:
    """Who is late is late, as in the shop."""
    monkeypatch.setattr(input_times, "STALL_TIME_S", STALL)


@pytest.fixture(scope="session", autouse=True)
def dressed(qapp: QApplication) -> None:
    """Fonts and palette as in the product."""
    load_fonts()
    style_application(DARK_PALETTE)


@pytest.fixture
def machine() -> FakeMachine:
    """The scripted machine."""
    return FakeMachine()


@pytest.fixture
def journal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Journal]:
    """What is kept in an empty folder."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    journal = Journal.open_default()
    yield journal
    journal.close()


@pytest.fixture
def desk(machine: FakeMachine) -> Desk:
    """The desk that is open; a module that needs another one has its own."""
    return desk_on(machine)


@pytest.fixture
def hands(qtbot: QtBot, machine: FakeMachine, desk: Desk) -> Iterator[Hands]:
    """An operator in front of the open desk."""
    with window_on(qtbot, desk, machine) as window:
        yield Hands(qtbot, window, desk, machine)


@pytest.fixture
def operator(qapp: QApplication) -> Iterator[Operator]:
    """An operator in front of the simulated lathe."""
    stage = Stage()
    window = MainWindow(ScreenTheme(DARK_PALETTE))
    window.resize(1024, 600)
    window.show_model(stage.desk)
    window.show()
    yield Operator(stage, window)
    window.close_silently()
    stage.close()
