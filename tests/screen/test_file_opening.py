"""Files that are dropped on the window, and those that another start of TurnDesk hands over."""

from __future__ import annotations

import os
import subprocess
import sys
from argparse import Namespace
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent
from PySide6.QtNetwork import QLocalServer, QLocalSocket
from pytestqt.qtbot import QtBot

from app.cli import main as command_line
from app.screen.page_table import AUTOMATIC
from app.screen.window import running_screen
from app.screen.window.file_opening import FileOpener
from app.screen.window.main_window import MainWindow
from app.screen.window.running_screen import (
    ACCEPTED_REPLY,
    MAX_REQUEST_BYTES,
    OpenProgramReceiver,
    find_socket_name,
    hand_over_program,
)
from core.executor.snapshot import MachineState
from tests.screen.desks import SAMPLES
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands

EITHER = Qt.DropAction.CopyAction | Qt.DropAction.MoveAction
PIN = SAMPLES / "pin.nc"
ROOT = Path(__file__).parents[2]


def drop(
    opening: FileOpener, window: MainWindow, *paths: Path, offered: Qt.DropAction = EITHER
) -> Qt.DropAction:
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    event = QDropEvent(
        QPointF(100, 100),
        offered,
        data,
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
    )
    assert opening.eventFilter(window, event)
    return event.dropAction()


@pytest.fixture
def window(hands: Hands) -> MainWindow:
    return hands.window


@pytest.fixture
def opening(window: MainWindow) -> FileOpener:
    return FileOpener(window)


def test_dropped_program_is_loaded_and_file_is_not_moved(opening: FileOpener, window: MainWindow) -> None:
    assert drop(opening, window, PIN) == Qt.DropAction.CopyAction
    assert window.frame is not None
    assert window.frame.desk.program_loader.loaded_program.name == "pin.nc"
    assert window.frame.current_page.NAME == AUTOMATIC


def test_a_drop_that_can_only_move_the_file_is_rejected(opening: FileOpener, window: MainWindow) -> None:
    assert window.frame is not None
    before = window.frame.desk.program_loader.loaded_program.name
    drop(opening, window, PIN, offered=Qt.DropAction.MoveAction)
    assert window.frame.desk.program_loader.loaded_program.name == before


@pytest.mark.parametrize("paths", [(PIN, SAMPLES / "knob.nc"), (SAMPLES,)])
def test_several_files_and_folders_are_rejected(
    opening: FileOpener, window: MainWindow, paths: tuple[Path, ...]
) -> None:
    assert window.frame is not None
    before = window.frame.desk.program_loader.loaded_program.name
    drop(opening, window, *paths)
    assert window.frame.desk.program_loader.loaded_program.name == before
    assert window.frame.desk.prompt_notice


def test_no_program_is_loaded_while_one_runs(
    opening: FileOpener, window: MainWindow, machine: FakeMachine
) -> None:
    machine.now = replace(machine.now, state=MachineState.HOLD)
    assert window.frame is not None
    before = window.frame.desk.program_loader.loaded_program.name
    drop(opening, window, PIN)
    assert window.frame.desk.program_loader.loaded_program.name == before
    assert window.frame.desk.prompt_notice


@pytest.fixture
def received(window: MainWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    found: list[Path] = []
    assert OpenProgramReceiver(found.append, window).start_listening()
    return found


def ask(request: bytes, qtbot: QtBot) -> bytes:
    """Send a request and return the reply, or nothing if the screen closes the connection."""
    socket = QLocalSocket()
    socket.connectToServer(find_socket_name())
    assert socket.waitForConnected(5000)
    socket.write(request)
    socket.flush()
    ended = QLocalSocket.LocalSocketState.UnconnectedState
    qtbot.waitUntil(lambda: socket.canReadLine() or socket.state() is ended)
    return bytes(socket.readAll().data())


def test_second_instance_passes_its_program_to_first(received: list[Path], qtbot: QtBot) -> None:
    assert ask(os.fsencode(PIN) + b"\n", qtbot) == ACCEPTED_REPLY
    assert received == [PIN]


@pytest.mark.parametrize(
    "request_", [b"pin.nc\n", b"/nowhere/pin.nc\n", b"\n", b"x" * (MAX_REQUEST_BYTES + 1)]
)
def test_a_request_that_is_not_an_existing_file_is_rejected(
    request_: bytes, received: list[Path], qtbot: QtBot
) -> None:
    assert ask(request_, qtbot) == b""
    assert received == []


def test_a_second_screen_does_not_replace_the_first(received: list[Path], window: MainWindow) -> None:
    assert not OpenProgramReceiver(received.append, window).start_listening()


def test_stale_socket_of_killed_screen_is_replaced(
    window: MainWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    Path(find_socket_name()).touch()
    assert OpenProgramReceiver(lambda _path: None, window).start_listening()


def start_again(program: Path, qtbot: QtBot) -> subprocess.CompletedProcess[str]:
    """Start TurnDesk with a program in a second process, while the running screen handles events."""
    words = [sys.executable, "-m", "app.cli.main", str(program)]
    with subprocess.Popen(
        words, env={**os.environ, "PYTHONPATH": str(ROOT)}, stdout=subprocess.PIPE, text=True
    ) as started:
        qtbot.waitUntil(lambda: started.poll() is not None, timeout=60_000)
        shown, _ = started.communicate()
    return subprocess.CompletedProcess(words, started.returncode, shown)


@pytest.mark.long
def test_second_start_hands_its_program_to_the_running_screen(
    received: list[Path], qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(PIN.parent)
    done = start_again(Path(PIN.name), qtbot)
    assert (done.returncode, done.stdout) == (0, "pin.nc: opened in the TurnDesk that is already running\n")
    assert received == [PIN]


def test_program_is_not_handed_over_without_a_running_screen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    assert not hand_over_program(str(PIN))


@pytest.mark.parametrize("program", [SAMPLES, SAMPLES / "missing.nc"])
def test_only_existing_files_are_handed_over(program: Path, received: list[Path]) -> None:
    assert not hand_over_program(str(program))
    assert received == []


def test_program_without_a_reply_is_not_handed_over(
    window: MainWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    monkeypatch.setattr(running_screen, "TIMEOUT_MS", 50)
    server = QLocalServer(window)  # its events are not handled, as in a screen that hangs
    assert server.listen(find_socket_name())
    assert not hand_over_program(str(PIN))


@pytest.mark.parametrize("option", ["machine", "offsets", "kiosk"])
def test_second_start_with_its_own_settings_opens_its_own_screen(
    option: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[object] = []

    def run_screen(**words: object) -> int:
        opened.append(words["program_file"])
        return 0

    monkeypatch.setattr("app.screen.window.running_screen.hand_over_program", lambda _path: True)
    monkeypatch.setattr("app.screen.screen_startup.run_screen", run_screen)
    words = {"program": str(PIN), "machine": None, "offsets": None, "kiosk": False}
    assert command_line._screen(Namespace(**words)) == 0
    assert opened == []  # handed over
    assert command_line._screen(Namespace(**words | {option: "x"})) == 0
    assert opened == [str(PIN)]
