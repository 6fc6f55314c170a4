"""Files that are dropped on the window, and those that another start of TurnDesk hands over."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent
from PySide6.QtNetwork import QLocalSocket
from pytestqt.qtbot import QtBot

from app.screen.page_table import AUTOMATIC
from app.screen.window.file_opening import FileOpener
from app.screen.window.main_window import MainWindow
from app.screen.window.running_screen import (
    ACCEPTED_REPLY,
    MAX_REQUEST_BYTES,
    OpenProgramReceiver,
    find_socket_name,
)
from core.executor.snapshot import MachineState
from tests.screen.desks import SAMPLES
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands

EITHER = Qt.DropAction.CopyAction | Qt.DropAction.MoveAction
PIN = SAMPLES / "pin.nc"


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
